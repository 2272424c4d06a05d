"""Compiled kernels: numbers and flat arrays only, no objects, no errors, no printing."""
