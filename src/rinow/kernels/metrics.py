"""The triangle inequality in a distance matrix."""

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange

BLOCK, TILE = 16, 256
"""Rows and columns treated together, so that the lengths of their detours stay in the fastest cache."""


@kernel
def shortest_detours(D, rows, columns, detours):
    """Write to detours[i, j] the length of the shortest way between two points by at most one other point.

    The points are the i-th of the range rows and the j-th of the range columns.
    """
    for i in range(rows[1] - rows[0]):
        for j in range(columns[1] - columns[0]):
            detours[i, j] = D[rows[0] + i, columns[0] + j]
    for k in range(D.shape[0]):
        onward = D[k, columns[0] : columns[1]]
        for i in range(rows[1] - rows[0]):
            _shorten(detours[i], D[rows[0] + i, k], onward)


@kernel
def _shorten(lengths, step, onward):
    """Replace each length by step + onward where that is less; a loop the compiler turns into vector instructions."""
    for j in range(onward.shape[0]):
        length = step + onward[j]
        lengths[j] = length if length < lengths[j] else lengths[j]


@kernel
def worst_excess(D, start, detours):
    """Largest excess d(i, j) - d(i, k) - d(k, j) over the rows i of a block, j >= start and all k; its i, j."""
    n = D.shape[0]
    rows = (start, min(start + BLOCK, n))
    worst, at, to = 0.0, start, start
    for first in range(start, n, TILE):
        columns = (first, min(first + TILE, n))
        shortest_detours(D, rows, columns, detours)
        for i in range(rows[0], rows[1]):
            for j in range(columns[0], columns[1]):
                excess = D[i, j] - detours[i - rows[0], j - columns[0]]
                if excess > worst:
                    worst, at, to = excess, i, j
    return worst, at, to


@parallel_kernel
def worst_excesses(D, excesses, pairs):
    """Write the largest excess and the pair (i, j) of each block of rows; 0 where the triangle inequality holds."""
    n_blocks = excesses.shape[0]
    for b in prange(n_blocks):
        block = b // 2 if b % 2 == 0 else n_blocks - 1 - b // 2  # long and short blocks in turn, for equal shares
        detours = np.empty((BLOCK, TILE))
        excesses[b], pairs[b, 0], pairs[b, 1] = worst_excess(D, block * BLOCK, detours)
