"""Refute that few points of two large spaces have partners that agree to a level: depth first, all partners tried.

Places are those of `dives`: v < n is point v of X, n + y is point y of Y.  Each has a list of possible partners among
*all* points of the other space.  A decision shortens the lists of the others, and the points farthest from the decided
pair look for partners too; an empty list refutes it.  Levels are compared by the float64 operations that measure a
distortion: no tables, no rounding to allow for.
"""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import inner, parallel_kernel, prange

REFUTED, FITS, GIVEN_UP = 0, 1, 2
"""Outcomes: no partners agree to the level, so many decisions agree, too many were tried."""

DEPTH = 24
"""Decisions that agree with each other after which a level counts as not refutable."""


class Spaces(NamedTuple):
    """The two spaces."""

    X: Any  # (n, n)
    Y: Any  # (m, m)
    ex: Any  # (n,) eccentricities
    ey: Any  # (m,)
    far_x: Any  # (n,): a farthest point of each
    far_y: Any  # (m,)


class Lists(NamedTuple):
    """The places that look for partners and these, after each number of decisions."""

    places: Any  # (k + 2 DEPTH,)
    partners: Any  # (DEPTH + 1, k + 2 DEPTH, max(n, m)) int32: the first counts[d, i] entries of row i
    counts: Any  # (DEPTH + 1, k + 2 DEPTH): 0 for decided places
    rows: Any  # (DEPTH + 1,): number of places
    decided: Any  # (DEPTH, 2): the pairs
    failures: Any  # (n + m,) float64: how often the list of a place ran empty, and 1


@inner
def _narrow(spaces, lists, depth, i, w, t):
    """Give row i the partner w, and write the lists after it; whether none is empty."""
    X, Y, n, before, after = spaces.X, spaces.Y, spaces.X.shape[0], lists.partners[depth], lists.partners[depth + 1]
    v = lists.places[i]
    x, y = (v, w) if v < n else (w, v - n)
    lists.decided[depth, 0], lists.decided[depth, 1] = x, y
    for j in range(lists.rows[depth]):
        lists.counts[depth + 1, j] = 0
        if j == i or lists.counts[depth, j] == 0:
            continue
        u, left = lists.places[j], 0
        d, row = (X[x, u], Y[y]) if u < n else (Y[y, u - n], X[x])
        for k in range(lists.counts[depth, j]):
            p = before[j, k]
            after[j, left] = p
            left += 1 if abs(d - row[p]) <= t else 0
        lists.counts[depth + 1, j] = left
        if left == 0:
            lists.failures[u] += 1.0
            return False
    lists.rows[depth + 1] = lists.rows[depth]
    if not _join(spaces, lists, depth + 1, n + spaces.far_y[y], t):
        return False
    return _join(spaces, lists, depth + 1, spaces.far_x[x], t)


@inner
def _join(spaces, lists, depth, u, t):
    """Let another place look for partners that agree with all decisions; whether there are any."""
    n, i = spaces.X.shape[0], lists.rows[depth]
    for j in range(i):
        if lists.places[j] == u:
            return True
    count, out = 0, lists.partners[depth, i]
    for w in range(spaces.Y.shape[0] if u < n else n):
        x, y = (u, w) if u < n else (w, u - n)
        if abs(spaces.ex[x] - spaces.ey[y]) <= t and _agrees(spaces, lists, depth, x, y, t):
            out[count] = w
            count += 1
    lists.places[i], lists.counts[depth, i], lists.rows[depth] = u, count, i + 1
    if count == 0:
        lists.failures[u] += 1.0
    return count > 0


@inner
def _agrees(spaces, lists, n_decisions, x, y, t):
    """Whether a pair agrees with all that were decided."""
    for p in range(n_decisions):
        if abs(spaces.X[lists.decided[p, 0], x] - spaces.Y[lists.decided[p, 1], y]) > t:
            return False
    return True


@inner
def _choose(lists, depth):
    """The row with the shortest list for its failures; -1 if all are decided."""
    best, chosen = np.inf, -1
    for i in range(lists.rows[depth]):
        if lists.counts[depth, i] > 0 and lists.counts[depth, i] < best * lists.failures[lists.places[i]]:
            best, chosen = lists.counts[depth, i] / lists.failures[lists.places[i]], i
    return chosen


@inner
def _search(spaces, lists, t, most):
    """What becomes of the lists after the first decision, within so many further ones."""
    depth, decisions = 1, 0
    tried, row = np.zeros(DEPTH + 1, np.int64), np.zeros(DEPTH + 1, np.int64)
    row[1] = _choose(lists, 1)
    while depth > 0:
        i = row[depth]
        if i < 0 or depth == DEPTH:
            return FITS
        if tried[depth] == lists.counts[depth, i]:
            depth -= 1
            continue
        if decisions == most:
            return GIVEN_UP
        decisions += 1
        w = lists.partners[depth, i, tried[depth]]
        tried[depth] += 1
        if _narrow(spaces, lists, depth, i, w, t):
            depth += 1
            tried[depth], row[depth] = 0, _choose(lists, depth)
    return REFUTED


@inner
def _branch(spaces, places, partners, counts, failures, first, w, t, most):
    """What becomes of one partner of the first place."""
    k = places.shape[0]
    n_rows = k + 2 * DEPTH
    lists = Lists(
        np.empty(n_rows, np.int64), np.empty((DEPTH + 1, n_rows, partners.shape[1]), np.int32),
        np.zeros((DEPTH + 1, n_rows), np.int64), np.zeros(DEPTH + 1, np.int64), np.empty((DEPTH, 2), np.int64),
        failures,
    )  # fmt: skip
    lists.rows[0] = k
    for i in range(k):
        lists.places[i], lists.counts[0, i] = places[i], counts[i]
        lists.partners[0, i, : counts[i]] = partners[i, : counts[i]]
    if not _narrow(spaces, lists, 0, first, w, t):
        return REFUTED
    return _search(spaces, lists, t, most)


@parallel_kernel
def branches(X, Y, ex, ey, far_x, far_y, places, partners, counts, failures, first, values, t, most, outcomes):
    """Write what becomes of each partner given to row `first` of the places; each has its own row of failures."""
    for b in prange(values.shape[0]):
        spaces = Spaces(X, Y, ex, ey, far_x, far_y)
        outcomes[b] = _branch(spaces, places, partners, counts, failures[b], first, values[b], t, most)
