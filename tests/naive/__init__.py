"""Naive twins of the kernels: another formula, plain loops, standard library only."""
