"""Greedy dives for relations between spaces of thousands of points: give partners one by one and look ahead.

Every point of either space has a list of partners that agree to the level with all pairs made so far.  A dive takes the
point with the shortest list for its weight, tries some partners, keeps the one that leaves the most to the others, and
shortens the lists.  Points whose list runs empty are left over; too many of them end the dive.  Distances are in single
precision: what a dive finds is measured in double.

Place v < n stands for point v of X, place n + y for point y of Y.
"""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.correspondence_tabu import random_below

TRIALS = 16
"""Partners tried for each point."""

WEIGHTED_ORPHANS = 8
"""Points left over whose weight grows for the next dive."""

UNDECIDED, LEFT_OVER = -1, -2
"""Marks in place of a partner."""


class Dive(NamedTuple):
    """State of a dive."""

    X: Any  # (n, n) float32
    Y: Any  # (m, m) float32
    lists: Any  # (n + m, max(n, m)) int32: the first counts[v] entries of row v are possible partners
    counts: Any  # (n + m,)
    partners: Any  # (n + m,)
    first: Any  # places to begin with
    weights: Any  # (n + m,) float64
    random: Any  # (1,) uint64
    orphans: Any  # (1,): number of points left over


@kernel
def _list_partners_of(v, X, Y, possible, xs, ys, t, out):
    """Write the partners of place v that are possible and agree with the given pairs; their number."""
    n, m = possible.shape
    k = 0
    for w in range(m if v < n else n):
        x, y = (v, w) if v < n else (w, v - n)
        if possible[x, y] and _agrees(X[x], Y[y], xs, ys, t):
            out[k] = w
            k += 1
    return k


@parallel_kernel
def list_partners(places, X, Y, possible, xs, ys, t, lists, counts):
    """Fill the lists of the given places."""
    for i in prange(places.shape[0]):
        v = places[i]
        counts[v] = _list_partners_of(v, X, Y, possible, xs, ys, t, lists[v])


@kernel
def begin(dive):
    """Leave over the undecided points with an empty list."""
    dive.orphans[0] = 0
    for v in range(dive.partners.shape[0]):
        if dive.partners[v] == UNDECIDED and dive.counts[v] == 0:
            _leave_over(dive, v)


@kernel
def _agrees(row_x, row_y, xs, ys, t):
    """Whether the pair of points with these distances agrees with all given ones."""
    for p in range(xs.shape[0]):
        if abs(row_x[xs[p]] - row_y[ys[p]]) > t:
            return False
    return True


@kernel
def _leave_over(dive, v):
    """Mark a point without possible partner."""
    dive.partners[v] = LEFT_OVER
    dive.orphans[0] += 1
    if dive.orphans[0] <= WEIGHTED_ORPHANS:
        dive.weights[v] += 1.0


@kernel
def descend(dive, t, n_decisions, most_orphans):
    """Give partners to up to so many points; whether the dive goes on."""
    n, values = dive.X.shape[0], np.empty(TRIALS, np.int64)
    for _ in range(n_decisions):
        v = _next_place(dive)
        if v < 0:
            return False
        n_values = _draw(dive, v, values)
        best, best_wiped, best_score = values[0], dive.partners.shape[0] + 1, -1.0
        if n_values > 1:
            for k in range(n_values):
                x, y = (v, values[k]) if v < n else (values[k], v - n)
                wiped, score = _look_ahead(dive, x, y, t, best_wiped)
                if wiped < best_wiped or (wiped == best_wiped and score > best_score):
                    best, best_wiped, best_score = values[k], wiped, score
        x, y = (v, best) if v < n else (best, v - n)
        dive.partners[v] = best
        for place, partner in ((x, y), (n + y, x)):
            if dive.partners[place] == UNDECIDED:
                dive.partners[place] = partner
        _shorten(dive, x, y, t)
        if dive.orphans[0] > most_orphans:
            return False
    return True


@kernel
def _next_place(dive):
    """A point without partner: the first ones as listed, then the one with the shortest list for its weight; or -1."""
    for k in range(dive.first.shape[0]):
        if dive.partners[dive.first[k]] == UNDECIDED:
            return dive.first[k]
    best, chosen = np.inf, -1
    for v in range(dive.partners.shape[0]):
        if dive.partners[v] == UNDECIDED and dive.counts[v] / dive.weights[v] < best:
            best, chosen = dive.counts[v] / dive.weights[v], v
    return chosen


@kernel
def _draw(dive, v, values):
    """Draw different partners from the list of a place; their number."""
    count = dive.counts[v]
    n_values = min(count, values.shape[0])
    for k in range(n_values):
        other = k + random_below(dive.random, count - k)
        dive.lists[v, k], dive.lists[v, other] = dive.lists[v, other], dive.lists[v, k]
        values[k] = dive.lists[v, k]
    return n_values


@kernel
def _look_ahead(dive, x, y, t, most_wiped):
    """How many lists the pair (x, y) would empty, and the sum of the logarithms of the other lengths."""
    n, wiped, score = dive.X.shape[0], 0, 0.0
    for v in range(dive.partners.shape[0]):
        if dive.partners[v] != UNDECIDED or v == x or v == n + y:
            continue
        d, row = (dive.X[x, v], dive.Y[y]) if v < n else (dive.Y[y, v - n], dive.X[x])
        left, listed = 0, dive.lists[v]
        for k in range(dive.counts[v]):
            left += 1 if abs(d - row[listed[k]]) <= t else 0
        if left > 0:
            score += np.log(left)
        else:
            wiped += 1
            if wiped > most_wiped:
                break
    return wiped, score


@kernel
def _shorten(dive, x, y, t):
    """Keep the partners that agree with the pair (x, y); points without any are left over."""
    n = dive.X.shape[0]
    for v in range(dive.partners.shape[0]):
        if dive.partners[v] != UNDECIDED:
            continue
        d, row = (dive.X[x, v], dive.Y[y]) if v < n else (dive.Y[y, v - n], dive.X[x])
        left, listed = 0, dive.lists[v]
        for k in range(dive.counts[v]):
            if abs(d - row[listed[k]]) <= t:
                listed[left] = listed[k]
                left += 1
        dive.counts[v] = left
        if left == 0:
            _leave_over(dive, v)


@kernel
def best_partner(row, other, own_places, other_places, n_pairs):
    """Point of the other space with the least worst discrepancy to the given pairs, for the distances `row`."""
    best, chosen = np.float32(np.inf), 0
    for w in range(other.shape[0]):
        worst = np.float32(0.0)
        for p in range(n_pairs):
            gap = abs(row[own_places[p]] - other[w, other_places[p]])
            if gap > worst:
                worst = gap
                if worst >= best:
                    break
        if worst < best:
            best, chosen = worst, w
    return chosen


@kernel
def pairs_made(dive, xs, ys):
    """Write the pairs of the points that have a partner; their number."""
    n, n_pairs = dive.X.shape[0], 0
    for v in range(dive.partners.shape[0]):
        if dive.partners[v] >= 0:
            xs[n_pairs], ys[n_pairs] = (v, dive.partners[v]) if v < n else (dive.partners[v], v - n)
            n_pairs += 1
    return n_pairs


@parallel_kernel
def complete(places, X, Y, xs, ys, out):
    """Write for each listed place the partner with the least worst discrepancy to the given pairs."""
    n = X.shape[0]
    for i in prange(places.shape[0]):
        v = places[i]
        if v < n:
            out[i] = best_partner(X[v], Y, xs, ys, xs.shape[0])
        else:
            out[i] = best_partner(Y[v - n], X, ys, xs, xs.shape[0])


@kernel
def _disagrees(X, Y, xs, ys, t, p):
    """Whether a pair disagrees with some other one."""
    row_x, row_y = X[xs[p]], Y[ys[p]]
    for q in range(xs.shape[0]):
        if abs(row_x[xs[q]] - row_y[ys[q]]) > t:
            return True
    return False


@parallel_kernel
def disagreements(X, Y, xs, ys, t, out):
    """Write for each pair whether it disagrees with some other one."""
    for p in prange(xs.shape[0]):
        out[p] = _disagrees(X, Y, xs, ys, t, p)
