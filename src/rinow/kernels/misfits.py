"""The curvature in which each of many point sets comes closest, as `rinow.embedding.misfit` finds it for one."""

import math

import numpy as np

from rinow.kernels._jit import inner, parallel_kernel, prange
from rinow.kernels.point_sets import squared_chords


@inner
def misfit_at(D, k, E, dE, gram, slope):
    """Sums of squares and products of what the Gram matrix and its derivative in k have beyond two dimensions.

    These are of the matrix, of the matrix and its derivative, and of the derivative.
    """
    squared_chords(D, k, E, dE)
    n = len(D) - 1
    for i in range(n):
        e, de = E[0, i + 1], dE[0, i + 1]
        for j in range(n):
            f, df = E[0, j + 1], dE[0, j + 1]
            gram[i, j] = 0.5 * (e + f - E[i + 1, j + 1]) - 0.25 * k * (e * f)
            slope[i, j] = 0.5 * (de + df - dE[i + 1, j + 1]) - 0.25 * (e * f) - 0.25 * k * (de * f + e * df)
    values, vectors = np.linalg.eigh(gram)
    rest = np.ascontiguousarray(vectors[:, : n - 2])
    turned = rest.T @ (slope @ rest)
    squares = along = steep = 0.0
    for i in range(n - 2):
        squares += values[i] * values[i]
        along += values[i] * turned[i, i]
        for j in range(n - 2):
            steep += turned[i, j] * turned[i, j]
    return squares, along, steep


@inner
def closest_curvature(D, bounds, most, work):
    """The curvature of the least misfit near that of the linearised equation at 0, by damped steps; nan for none.

    `bounds` has the smallest curvature, the square of a derivative that is rounding, as for points of a line, the
    smallest step, by what factor the squares may grow in a step, and the largest curvature over that of a great circle
    around the largest triple.
    """
    smallest, small_slope, small_step, slack, beyond = bounds
    diameter, perimeter = 0.0, 0.0
    for i in range(len(D)):
        for j in range(len(D)):
            if D[i, j] > diameter:
                diameter, perimeter = D[i, j], D[i, j] + (D[i] + D[j]).max()
    largest = beyond * (2.0 * math.pi / perimeter) ** 2
    k, last = 0.0, np.inf
    squares, along, steep = misfit_at(D, k, *work)
    for _ in range(most):
        if not steep > small_slope:
            return np.nan
        step = -along / steep
        if abs(step) <= small_step * max(1.0, abs(k)) and (step == 0.0 or abs(step) >= 0.5 * last):
            return k if smallest < k < largest else np.nan
        last = abs(step)
        there = min(max(k + step, smallest), largest)
        new, along, steep = misfit_at(D, there, *work)
        while not new <= slack * squares and abs(step) > small_step:
            step *= 0.25
            there = min(max(k + step, smallest), largest)
            new, along, steep = misfit_at(D, there, *work)
        if there == k and last > small_step * max(1.0, abs(k)):
            return np.nan  # at a bound, where it would stay
        k, squares = there, new
    return np.nan


@parallel_kernel
def closest_curvatures(distances, bounds, most, n_blocks, out):
    """Write the curvature of the least misfit of each set of distances, the first point its base."""
    for block in prange(n_blocks):
        m, n = distances.shape[0], distances.shape[1]
        work = np.empty((n, n)), np.empty((n, n)), np.empty((n - 1, n - 1)), np.empty((n - 1, n - 1))
        for i in range(m * block // n_blocks, m * (block + 1) // n_blocks):
            out[i] = closest_curvature(distances[i], bounds, most, work)
