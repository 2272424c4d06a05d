"""Determinants by elimination in exact fractions, and what they say about simplices."""

import math
from fractions import Fraction


def determinant(rows):
    """Exact determinant by elimination."""
    if not rows:
        return Fraction(1)
    pivot = next((i for i, row in enumerate(rows) if row[0]), None)
    if pivot is None:
        return Fraction(0)
    top, *rest = [rows[pivot], *rows[:pivot], *rows[pivot + 1 :]]
    reduced = [[x - row[0] / top[0] * t for x, t in zip(row[1:], top[1:], strict=True)] for row in rest]
    return (-1) ** pivot * top[0] * determinant(reduced)


def squared(D):
    """Squared distances as fractions."""
    return [[Fraction(x) ** 2 for x in row] for row in D]


def bordered(D):
    """Bordered determinant of the squared distances."""
    n = len(D)
    return determinant([[Fraction(0)] + [Fraction(1)] * n] + [[Fraction(1), *row] for row in squared(D)])


def volume(D):
    """From the bordered determinant."""
    n = len(D)
    return math.sqrt((-1) ** n * bordered(D) / 2 ** (n - 1)) / math.factorial(n - 1)


def circumradius(D):
    """From the quotient of the determinants without and with border."""
    return math.sqrt(-determinant(squared(D)) / (2 * bordered(D)))


def is_simplex(D):
    """By the signs of the bordered determinants of the first 2, 3, ... points."""
    return all((-1) ** k * bordered([row[:k] for row in D[:k]]) > 0 for k in range(2, len(D) + 1))
