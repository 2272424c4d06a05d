"""Local polish of two maps between spaces of thousands of points: images move to neighbours while excesses fall."""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.correspondence_tabu import excess, random_below

UNCERTAIN = 8
"""One move in so many is taken although it makes things worse."""


class Polish(NamedTuple):
    """Pairs (xs[p], ys[p]): the first n are the graph of f, the others that of g."""

    X: Any  # (n, n) float32
    Y: Any  # (m, m) float32
    xs: Any  # (n + m,)
    ys: Any  # (n + m,)
    near_x: Any  # (n, k): nearest points, the point itself left out
    near_y: Any  # (m, k)
    costs: Any  # (n + m,) float64: sum of the excesses of a pair with all pairs
    until: Any  # (n + m,): move until which a pair rests
    random: Any  # (1,) uint64
    counters: Any  # (1,): moves


@kernel
def cost(polish, x, y, t, skipped):
    """Sum of the excesses of the pair (x, y) with all pairs but one."""
    total, row_x, row_y = 0.0, polish.X[x], polish.Y[y]
    for p in range(polish.xs.shape[0]):
        total += excess(row_x[polish.xs[p]], row_y[polish.ys[p]], t)
    if skipped >= 0:
        total -= excess(row_x[polish.xs[skipped]], row_y[polish.ys[skipped]], t)
    return total


@parallel_kernel
def write_costs(polish, t, out):
    """Write the costs of all pairs to out, an array of its own: numba loses writes to members of a tuple here."""
    for p in prange(out.shape[0]):
        out[p] = cost(polish, polish.xs[p], polish.ys[p], t, -1)


@kernel
def improve(polish, t, n_moves):
    """Make up to so many moves; whether no pair exceeds the target any more."""
    n, n_pairs = polish.X.shape[0], polish.xs.shape[0]
    for _ in range(n_moves):
        p, conflicts = _choose(polish)
        if conflicts == 0:
            return True
        polish.counters[0] += 1
        if p < 0:
            continue
        polish.until[p] = polish.counters[0] + 10 + random_below(polish.random, 20)
        x, y = polish.xs[p], polish.ys[p]
        near = polish.near_y[y] if p < n else polish.near_x[x]
        best, at = np.inf, -1
        for k in range(near.shape[0]):
            value = cost(polish, x, near[k], t, p) if p < n else cost(polish, near[k], y, t, p)
            if value < best:
                best, at = value, near[k]
        if at < 0 or (best > polish.costs[p] and random_below(polish.random, UNCERTAIN) > 0):
            continue
        new_x, new_y = (x, at) if p < n else (at, y)
        for q in range(n_pairs):
            a, b = polish.xs[q], polish.ys[q]
            polish.costs[q] += excess(polish.X[new_x, a], polish.Y[new_y, b], t)
            polish.costs[q] -= excess(polish.X[x, a], polish.Y[y, b], t)
        polish.xs[p], polish.ys[p] = new_x, new_y
        polish.costs[p] = best
    return False


@kernel
def _choose(polish):
    """A pair to move, as a rule the worst one that does not rest, or -1; the number of pairs in conflict."""
    conflicts, worst, chosen, other = 0, 0.0, -1, -1
    for p in range(polish.xs.shape[0]):
        if polish.costs[p] > 1e-6:
            conflicts += 1
            if random_below(polish.random, conflicts) == 0:
                other = p
            if polish.costs[p] > worst and polish.until[p] <= polish.counters[0]:
                worst, chosen = polish.costs[p], p
    if chosen >= 0 and random_below(polish.random, 4) == 0:
        chosen = other
    return chosen, conflicts
