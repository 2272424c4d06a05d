"""Curvature at points, of curves and of surfaces."""
