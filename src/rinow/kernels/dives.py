"""Greedy dives for relations between spaces of thousands of points: give partners one by one and look ahead.

Every point of either space that takes part has a list of partners that agree to the level with all pairs made so far.
A dive takes the point with the shortest list for its weight, tries some partners, keeps the one that leaves the most to
the others, and shortens the lists.  Points whose list runs empty are left over; too many of them end the dive.
Distances are in single precision: what a dive finds is measured in double.

Place v < n stands for point v of X, place n + y for point y of Y.
"""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import inner, kernel, parallel_kernel, prange
from rinow.kernels.correspondence_tabu import random_below

TRIALS = 16
"""Partners tried for each point."""

WEIGHTED_ORPHANS = 8
"""Points left over whose weight grows for the next dive."""

UNDECIDED, LEFT_OVER, ABSENT = -1, -2, -3
"""Marks in place of a partner: not yet given one, none possible, takes no part."""

ORPHANS, OPEN = 0, 1
"""Places in the numbers of a dive: points left over, points undecided."""


class Dive(NamedTuple):
    """State of a dive."""

    X: Any  # (n, n) float32
    Y: Any  # (m, m) float32
    places: Any  # (k,): the places that look for a partner
    lists: Any  # (k, max(n, m)) int32: the first counts[i] entries of row i are possible partners of places[i]
    counts: Any  # (k,)
    undecided: Any  # (k,): the first numbers[OPEN] entries are the rows of the places without partner
    partners: Any  # (n + m,)
    weights: Any  # (n + m,) float64
    random: Any  # (1,) uint64
    numbers: Any  # (2,)


@inner
def _list_partners_of(v, X, Y, ex, ey, xs, ys, t, out):
    """Write the partners of place v that agree in eccentricity and with the given pairs; their number."""
    n, k = X.shape[0], 0
    for w in range(Y.shape[0] if v < n else n):
        x, y = (v, w) if v < n else (w, v - n)
        if abs(ex[x] - ey[y]) <= t and _agrees(X[x], Y[y], xs, ys, t):
            out[k] = w
            k += 1
    return k


@parallel_kernel
def list_partners(places, X, Y, ex, ey, xs, ys, t, lists, counts):
    """Fill the lists of the given places; ex and ey are the eccentricities."""
    for i in prange(places.shape[0]):
        counts[i] = _list_partners_of(places[i], X, Y, ex, ey, xs, ys, t, lists[i])


@inner
def _agrees(row_x, row_y, xs, ys, t):
    """Whether the pair of points with these distances agrees with all given ones."""
    for p in range(xs.shape[0]):
        if abs(row_x[xs[p]] - row_y[ys[p]]) > t:
            return False
    return True


@kernel
def begin(dive):
    """Mark all places as undecided, but leave over those with an empty list."""
    dive.numbers[ORPHANS], dive.numbers[OPEN] = 0, 0
    for i in range(dive.places.shape[0]):
        if dive.counts[i] == 0:
            _leave_over(dive, dive.places[i])
        else:
            dive.undecided[dive.numbers[OPEN]] = i
            dive.numbers[OPEN] += 1


@inner
def _leave_over(dive, v):
    """Mark a point without possible partner."""
    dive.partners[v] = LEFT_OVER
    dive.numbers[ORPHANS] += 1
    if dive.numbers[ORPHANS] <= WEIGHTED_ORPHANS:
        dive.weights[v] += 1.0


@kernel
def descend(dive, t, n_decisions, most_orphans):
    """Give partners to up to so many points; whether the dive goes on."""
    n, values = dive.X.shape[0], np.empty(TRIALS, np.int64)
    for _ in range(n_decisions):
        if dive.numbers[OPEN] == 0:
            return False
        i = _next_row(dive)
        v, n_values = dive.places[i], _draw(dive, i, values)
        best, best_wiped, best_score = values[0], dive.partners.shape[0] + 1, -1.0
        if n_values > 1:
            for k in range(n_values):
                x, y = (v, values[k]) if v < n else (values[k], v - n)
                wiped, score = _look_ahead(dive, x, y, t, best_wiped)
                if wiped < best_wiped or (wiped == best_wiped and score > best_score):
                    best, best_wiped, best_score = values[k], wiped, score
        _decide(dive, v, best, t)
        if dive.numbers[ORPHANS] > most_orphans:
            return False
    return True


@inner
def _decide(dive, v, partner, t):
    """Give a place its partner, and shorten the lists of the others."""
    n = dive.X.shape[0]
    x, y = (v, partner) if v < n else (partner, v - n)
    for place, other in ((x, y), (n + y, x)):
        if dive.partners[place] < 0:
            dive.partners[place] = other
    _shorten(dive, x, y, t)


@inner
def _next_row(dive):
    """The row of the place without partner that has the shortest list for its weight."""
    best, chosen = np.inf, -1
    for u in range(dive.numbers[OPEN]):
        i = dive.undecided[u]
        if dive.counts[i] / dive.weights[dive.places[i]] < best:
            best, chosen = dive.counts[i] / dive.weights[dive.places[i]], i
    return chosen


@inner
def _draw(dive, i, values):
    """Draw different partners from row i of the lists; their number."""
    count, listed = dive.counts[i], dive.lists[i]
    n_values = min(count, values.shape[0])
    for k in range(n_values):
        other = k + random_below(dive.random, count - k)
        listed[k], listed[other] = listed[other], listed[k]
        values[k] = listed[k]
    return n_values


@inner
def _look_ahead(dive, x, y, t, most_wiped):
    """How many lists the pair (x, y) would empty, and the sum of the logarithms of the other lengths."""
    n, wiped, score = dive.X.shape[0], 0, 0.0
    for u in range(dive.numbers[OPEN]):
        i = dive.undecided[u]
        v = dive.places[i]
        if v == x or v == n + y:
            continue
        d, row = (dive.X[x, v], dive.Y[y]) if v < n else (dive.Y[y, v - n], dive.X[x])
        left, listed = 0, dive.lists[i]
        for k in range(dive.counts[i]):
            left += 1 if abs(d - row[listed[k]]) <= t else 0
        if left > 0:
            score += np.log(left)
        else:
            wiped += 1
            if wiped > most_wiped:
                break
    return wiped, score


@inner
def _shorten(dive, x, y, t):
    """Keep the partners that agree with the pair (x, y); points without any are left over."""
    n, still = dive.X.shape[0], 0
    for u in range(dive.numbers[OPEN]):
        i = dive.undecided[u]
        v = dive.places[i]
        if dive.partners[v] != UNDECIDED:
            continue
        d, row = (dive.X[x, v], dive.Y[y]) if v < n else (dive.Y[y, v - n], dive.X[x])
        left, listed = 0, dive.lists[i]
        for k in range(dive.counts[i]):
            if abs(d - row[listed[k]]) <= t:
                listed[left] = listed[k]
                left += 1
        dive.counts[i] = left
        if left == 0:
            _leave_over(dive, v)
        else:
            dive.undecided[still] = i
            still += 1
    dive.numbers[OPEN] = still


@parallel_kernel
def many_descents(X, Y, places, t, n_decisions, most, lists, counts, undecided, partners, weights, random, numbers, on):
    """Go on with dives for the same places, each by up to so many decisions; write to on[k] whether it goes on."""
    for k in prange(lists.shape[0]):
        if on[k]:
            dive = Dive(X, Y, places, lists[k], counts[k], undecided[k], partners[k], weights[k], random[k], numbers[k])
            on[k] = descend(dive, t, n_decisions, most)


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
