"""Distances between metric spaces."""
