"""Distances within a surface or a graph."""
