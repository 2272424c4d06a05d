"""Which pairs of points may stand together in a relation between two metric spaces, without an n²m² table.

Pairs (x, y) and (x', y') are compatible at a level t if |d(x, x') - d(y, y')| <= t, or for bijections if the ratio of
the two distances is at most t both ways.  For fixed (x, y) and x' the compatible y' are neighbours in the row of y
sorted by distance: a run [low, high).  The level is compared by the float operations of the final measure, so that a
search proves statements about exactly that measure.
"""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange

RELATION, BIJECTION, MAP = 0, 1, 2
"""Kinds: a relation by differences, a bijection by ratios, a map X → Y by differences."""


class SortedRows(NamedTuple):
    """A distance matrix with each row sorted; point i comes first in row i."""

    distances: Any  # (n, n)
    order: Any  # (n, n) of int
    prefixes: Any  # (n, n + 1, n_words) of uint64: the set of the first k points of each row


class Runs(NamedTuple):
    """Compatible sets of the listed pairs at one level."""

    slot: Any  # (n, m) int32: place of a pair in the two tables, -1 if it has none
    over_x: Any  # (n_slots, n, 2) uint16: for each x' the run in the sorted row of y
    over_y: Any  # (n_slots, m, 2) uint16: for each y' the run in the sorted row of x


@kernel
def discrepancy(kind, a, b):
    """How badly two distances agree: difference, or for bijections the larger ratio."""
    if kind != BIJECTION:
        return abs(a - b)
    if a == b:
        return 1.0
    if a == 0.0 or b == 0.0:
        return np.inf
    return b / a if b > a else a / b


@kernel
def _too_small(kind, a, b, t):
    """Whether b is too small beside a."""
    if kind != BIJECTION:
        return a - b > t
    return a > b and (b == 0.0 or a / b > t)


@kernel
def _too_large(kind, a, b, t):
    """Whether b is too large beside a."""
    if kind != BIJECTION:
        return b - a > t
    return b > a and (a == 0.0 or b / a > t)


@kernel
def merge(kind, a, order, b, t, onto, out):
    """Write to out[order[i]] the run of the sorted values b that agree with a[i], for ascending a.

    The first entry of `order` is x itself; `onto` tells that b are distances in Y: a map or bijection takes x to y
    alone.
    """
    low, high, m = 0, 0, b.shape[0]
    for i in range(a.shape[0]):
        while low < m and _too_small(kind, a[i], b[low], t):
            low += 1
        high = max(low, high)
        while high < m and not _too_large(kind, a[i], b[high], t):
            high += 1
        first, last = low, high
        if i == 0 and (kind == BIJECTION or (kind == MAP and onto)):
            first, last = 0, 1
        elif i > 0 and (kind == BIJECTION or (kind == MAP and not onto)):
            first, last = max(low, 1), max(high, 1)
        out[order[i], 0] = first
        out[order[i], 1] = last


@kernel
def write_run(kind, X, Y, t, pairs, s, over_x, over_y):
    """Write the runs of pair s both ways."""
    x, y = pairs[s, 0], pairs[s, 1]
    merge(kind, X.distances[x], X.order[x], Y.distances[y], t, True, over_x[s])
    merge(kind, Y.distances[y], Y.order[y], X.distances[x], t, False, over_y[s])


@kernel
def write_runs(kind, X, Y, t, pairs, over_x, over_y):
    """Write the runs of the pairs (x, y), one slot each, on one thread: for small spaces."""
    for s in range(pairs.shape[0]):
        write_run(kind, X, Y, t, pairs, s, over_x, over_y)


@parallel_kernel
def write_many_runs(kind, X, Y, t, pairs, over_x, over_y):
    """Write the runs of the pairs (x, y), one slot each."""
    for s in prange(pairs.shape[0]):
        write_run(kind, X, Y, t, pairs, s, over_x, over_y)


@kernel
def sorted_discrepancy(a, b):
    """Hausdorff distance of two ascending lists of numbers."""
    worst, j, m = 0.0, 0, b.shape[0]
    for i in range(a.shape[0]):
        while j + 1 < m and b[j + 1] <= a[i]:
            j += 1
        gap = abs(a[i] - b[j])
        if j + 1 < m:
            gap = min(gap, abs(b[j + 1] - a[i]))
        worst = max(worst, gap)
    return worst


@kernel
def sorted_ratio(a, b):
    """Least worst ratio between two ascending lists of one length, matched one to one."""
    worst = 1.0
    for i in range(a.shape[0]):
        worst = max(worst, discrepancy(BIJECTION, a[i], b[i]))
    return worst


@kernel
def row_discrepancy(kind, both, a, b):
    """Least level at which the ascending distances a have partners among b, with `both` those b among a too."""
    if kind == BIJECTION:
        return sorted_ratio(a, b)
    return max(sorted_discrepancy(a, b), sorted_discrepancy(b, a)) if both else sorted_discrepancy(a, b)


@kernel
def row_discrepancies(kind, both, X, Y, out):
    """Write the discrepancy of every two rows, on one thread: for small spaces."""
    for x in range(X.shape[0]):
        for y in range(Y.shape[0]):
            out[x, y] = row_discrepancy(kind, both, X[x], Y[y])


@parallel_kernel
def many_row_discrepancies(kind, both, X, Y, out):
    """Write the discrepancy of every two rows."""
    for x in prange(X.shape[0]):
        for y in range(Y.shape[0]):
            out[x, y] = row_discrepancy(kind, both, X[x], Y[y])
