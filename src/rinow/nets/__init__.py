"""Finite nets in a space, and graphs that approximate it."""
