"""Curvature of curves in exact fractions and 50 decimal digits."""

from decimal import Decimal, localcontext
from fractions import Fraction
from itertools import combinations, pairwise
from math import sqrt


def squared_distance(p, q):
    """Exact for the given floats."""
    return sum((Fraction(x) - Fraction(y)) ** 2 for x, y in zip(p, q, strict=True))


def menger_square(aa, bb, cc):
    """Square of the curvature from exact squared sides: the law of cosines, 4 sin^2(opposite a) / a^2."""
    return (4 * bb * cc - (bb + cc - aa) ** 2) / (aa * bb * cc)


def menger(p, q, r):
    """Curvature of three points given by coordinates."""
    return sqrt(menger_square(squared_distance(p, q), squared_distance(q, r), squared_distance(r, p)))


def menger_of_sides(a, b, c):
    """Curvature of three lengths; None where they are not those of three different points."""
    a, b, c = sorted((Fraction(a), Fraction(b), Fraction(c)))
    return sqrt(menger_square(a * a, b * b, c * c)) if 0 < a and c <= a + b else None


def haantjes(points):
    """Curvature of a polyline: each side an arc of it."""
    with localcontext() as context:
        context.prec = 60
        sides = [_distance(p, q) for p, q in pairwise(points)]
        arc, chord = sum(sides), _distance(points[0], points[-1])
        return sqrt(24 * (arc - chord) / (arc**3 - sum(c**3 for c in sides)))


def alt(points, i):
    """Curvature at point i: the constant of a polynomial fitted to all triples by the normal equations."""
    rows, values = [], []
    for q, r in combinations([j for j in range(len(points)) if j != i], 2):
        x, y = (_position(points, i, j) for j in (q, r))
        rows.append([Fraction(1), x + y, (x + y) ** 2, x * y])
        values.append(Fraction(menger(points[q], points[i], points[r]) ** 2))
    system = [
        [sum(row[a] * row[b] for row in rows) for b in range(4)]
        + [sum(row[a] * v for row, v in zip(rows, values, strict=True))]
        for a in range(4)
    ]
    return sqrt(max(_solve(system)[0], 0))


def _position(points, i, j):
    """Distance of j from i, negative before it."""
    return (1 if j > i else -1) * Fraction(sqrt(squared_distance(points[i], points[j])))


def _distance(p, q):
    square = squared_distance(p, q)
    return (Decimal(square.numerator) / Decimal(square.denominator)).sqrt()


def _solve(system):
    """Gauss-Jordan elimination in fractions, the last column the right side."""
    n = len(system)
    for k in range(n):
        pivot = next(row for row in range(k, n) if system[row][k] != 0)
        system[k], system[pivot] = system[pivot], system[k]
        for row in range(n):
            if row != k:
                factor = system[row][k] / system[k][k]
                system[row] = [x - factor * y for x, y in zip(system[row], system[k], strict=True)]
    return [system[k][n] / system[k][k] for k in range(n)]
