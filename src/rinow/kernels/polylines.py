"""Curvature of curves given by points in order: Menger (Math. Ann. 103, 1930) and Haantjes (Indag. Math. 9, 1947).

The `data` of a curve are its coordinates (n, d) or, where `are_distances`, all its distances (n, n).  Squares of
curvatures are computed: they are smooth where the curvature is 0, and keep the sign of a rounding error, so that
means and extrapolations of them have no bias.
"""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.tolerances import TRIANGLE_INEQUALITY


@kernel
def chord_length(data, are_distances, i, j):
    """Distance of the points i and j."""
    if are_distances:
        return data[i, j]
    total = 0.0
    for x in range(data.shape[1]):
        total += (data[i, x] - data[j, x]) ** 2
    return math.sqrt(total)


@kernel
def menger_square_of_sides(a, b, c):
    """Square 16 area^2/(abc)^2 by Heron's product in Kahan's order, below 0 by rounding only.

    nan where two points coincide or the triangle inequality fails.
    """
    if c < b:
        b, c = c, b
    if b < a:
        a, b = b, a
        if c < b:
            b, c = c, b
    excess = a - (c - b)
    if a == 0.0 or excess < -TRIANGLE_INEQUALITY * c:
        return np.nan
    return (excess / a / b) * ((a + (b + c)) / c) * ((a + (c - b)) / a) * ((c + (b - a)) / b) / c


@kernel
def menger_square_of_points(points, i, j, k):
    """Square of 2 sin(angle at j)/|ik|, with sin = |e - f| |e + f| / 2 for the unit vectors e, f from j to i and k.

    Rounding eps costs eps/x of the curvature, x = curvature times side; from the sides it costs eps/x^2.
    """
    a, b, c = chord_length(points, False, i, j), chord_length(points, False, j, k), chord_length(points, False, i, k)
    if a == 0.0 or b == 0.0 or c == 0.0:
        return np.nan
    minus = plus = 0.0
    for x in range(points.shape[1]):
        e, f = (points[i, x] - points[j, x]) / a, (points[k, x] - points[j, x]) / b
        minus += (e - f) ** 2
        plus += (e + f) ** 2
    return (minus / c) * (plus / c)


@parallel_kernel
def menger_squares(data, are_distances, triples, out):
    """Write to out[t] the square of the Menger curvature of the points triples[t]."""
    for t in prange(triples.shape[0]):
        i, j, k = triples[t, 0], triples[t, 1], triples[t, 2]
        if are_distances:
            out[t] = menger_square_of_sides(data[i, j], data[j, k], data[k, i])
        else:
            out[t] = menger_square_of_points(data, i, j, k)


@kernel
def arc_excess_of_points(points, arc, chord):
    """Sum of the sides of a polyline minus its chord, without cancellation.

    It is the sum of c |e - f|^2 / 2 over the sides, c the length and e the direction of a side, f that of the chord.
    """
    first, last = arc[0], arc[-1]
    total = 0.0
    for t in range(arc.shape[0] - 1):
        i, j = arc[t], arc[t + 1]
        c = chord_length(points, False, i, j)
        if c != 0.0:
            square = 0.0
            for x in range(points.shape[1]):
                e, f = (points[j, x] - points[i, x]) / c, (points[last, x] - points[first, x]) / chord
                square += (e - f) ** 2
            total += 0.5 * c * square
    return total


@kernel
def haantjes_square(data, are_distances, arc):
    """Square 24 (L - d)/(L^3 - sum of c^3) from the sides c of a polyline, their sum L and its chord d.

    A side stands for an arc of length c + kappa^2 c^3/24 of the same curvature: hence the sum of cubes.  nan where
    fewer than two sides are not 0 or the chord is longer than L.
    """
    chord = chord_length(data, are_distances, arc[0], arc[-1])
    total = cubes = 0.0
    excess = -chord
    for t in range(arc.shape[0] - 1):
        c = chord_length(data, are_distances, arc[t], arc[t + 1])
        total += c
        cubes += c * c * c
        excess += c
    if not are_distances and chord > 0.0:
        excess = arc_excess_of_points(data, arc, chord)
    rest = total * total * total - cubes
    if rest <= 0.0 or excess < -TRIANGLE_INEQUALITY * chord:
        return np.nan
    return 24.0 * excess / rest


@parallel_kernel
def haantjes_squares(data, are_distances, arcs, out):
    """Write to out[t] the square of the Haantjes curvature of the polyline through the points arcs[t]."""
    for t in prange(arcs.shape[0]):
        out[t] = haantjes_square(data, are_distances, arcs[t])
