"""Curvature of few points: space forms, determinants, metric quadruples."""
