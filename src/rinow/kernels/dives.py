"""Greedy dives for maps between spaces of thousands of points: give images one by one and look ahead.

Every point of X has a list of images that agree to the level with all images given so far.  A dive takes the point
with the shortest list for its weight, tries some images, keeps the one that leaves the most to the others, and
shortens the lists. Points whose list runs empty are left over; too many of them end the dive.  Distances are in
single precision: what a dive finds is measured in double.
"""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import kernel
from rinow.kernels.correspondence_tabu import random_below

TRIALS = 16
"""Images tried for each point."""

WEIGHTED_ORPHANS = 8
"""Points left over whose weight grows for the next dive."""

DECIDED, ORPHANS = 0, 1
"""Places in the counters: points dealt with, points left over."""


class Dive(NamedTuple):
    """State of a dive."""

    X: Any  # (n, n) float32
    Y: Any  # (m, m) float32
    lists: Any  # (n, m) int32: the first counts[x] entries of row x are possible images of x
    counts: Any  # (n,)
    f: Any  # (n,): the image, -1 before, -2 for a point left over
    first: Any  # points to begin with
    weights: Any  # (n,) float64
    random: Any  # (1,) uint64
    counters: Any  # (2,)


@kernel
def begin(dive, possible):
    """Fill the lists from a matrix of bool and forget all images."""
    for x in range(dive.lists.shape[0]):
        k = 0
        for y in range(dive.lists.shape[1]):
            if possible[x, y]:
                dive.lists[x, k] = y
                k += 1
        dive.counts[x] = k
        dive.f[x] = -1
    dive.counters[:] = 0


@kernel
def descend(dive, t, n_decisions, most_orphans):
    """Give images to up to so many points; whether the dive goes on."""
    values = np.empty(TRIALS, np.int64)
    for _ in range(n_decisions):
        x = _next_point(dive)
        if x < 0:
            return False
        n_values = _draw(dive, x, values)
        best, best_wiped, best_score = values[0], dive.f.shape[0] + 1, -1.0
        if n_values > 1:
            for v in range(n_values):
                wiped, score = _look_ahead(dive, x, values[v], t, best_wiped)
                if wiped < best_wiped or (wiped == best_wiped and score > best_score):
                    best, best_wiped, best_score = values[v], wiped, score
        dive.f[x] = best
        dive.counters[DECIDED] += 1
        _shorten(dive, x, best, t)
        if dive.counters[ORPHANS] > most_orphans:
            return False
    return True


@kernel
def _next_point(dive):
    """A point without image: the first ones as listed, then the one with the shortest list for its weight; or -1."""
    for k in range(dive.first.shape[0]):
        if dive.f[dive.first[k]] == -1:
            return dive.first[k]
    best, chosen = np.inf, -1
    for x in range(dive.f.shape[0]):
        if dive.f[x] == -1 and dive.counts[x] / dive.weights[x] < best:
            best, chosen = dive.counts[x] / dive.weights[x], x
    return chosen


@kernel
def _draw(dive, x, values):
    """Draw different images from the list of x; their number."""
    count = dive.counts[x]
    n_values = min(count, values.shape[0])
    for v in range(n_values):
        k = v + random_below(dive.random, count - v)
        dive.lists[x, v], dive.lists[x, k] = dive.lists[x, k], dive.lists[x, v]
        values[v] = dive.lists[x, v]
    return n_values


@kernel
def _look_ahead(dive, x, y, t, most_wiped):
    """How many lists the pair (x, y) would empty, and the sum of the logarithms of the other lengths."""
    wiped, score, row = 0, 0.0, dive.Y[y]
    for other in range(dive.f.shape[0]):
        if dive.f[other] != -1 or other == x:
            continue
        d, left, images = dive.X[x, other], 0, dive.lists[other]
        for k in range(dive.counts[other]):
            left += 1 if abs(d - row[images[k]]) <= t else 0
        if left == 0:
            wiped += 1
            if wiped > most_wiped:
                return wiped, score
        else:
            score += np.log(left)
    return wiped, score


@kernel
def _shorten(dive, x, y, t):
    """Keep the images that agree with the pair (x, y); points without any are left over."""
    row = dive.Y[y]
    for other in range(dive.f.shape[0]):
        if dive.f[other] != -1:
            continue
        d, left, images = dive.X[x, other], 0, dive.lists[other]
        for k in range(dive.counts[other]):
            if abs(d - row[images[k]]) <= t:
                images[left] = images[k]
                left += 1
        dive.counts[other] = left
        if left == 0:
            dive.f[other] = -2
            dive.counters[DECIDED] += 1
            dive.counters[ORPHANS] += 1
            if dive.counters[ORPHANS] <= WEIGHTED_ORPHANS:
                dive.weights[other] += 1.0


@kernel
def best_image(row, Y, xs, ys, n_pairs):
    """Point y with the least worst discrepancy to the given pairs, for a point with the distances `row`."""
    best, chosen = np.float32(np.inf), 0
    for y in range(Y.shape[0]):
        worst = np.float32(0.0)
        for p in range(n_pairs):
            gap = abs(row[xs[p]] - Y[y, ys[p]])
            if gap > worst:
                worst = gap
                if worst >= best:
                    break
        if worst < best:
            best, chosen = worst, y
    return chosen


@kernel
def complete(X, Y, f, g):
    """Give an image to the points of X left over (f < 0), and one of X to every point of Y."""
    n, m = f.shape[0], g.shape[0]
    xs, ys, n_pairs = np.empty(n + m, np.int64), np.empty(n + m, np.int64), 0
    for x in range(n):
        if f[x] >= 0:
            xs[n_pairs], ys[n_pairs] = x, f[x]
            n_pairs += 1
    for x in range(n):
        if f[x] < 0:
            f[x] = best_image(X[x], Y, xs, ys, n_pairs)
            xs[n_pairs], ys[n_pairs] = x, f[x]
            n_pairs += 1
    g[:] = -1
    for x in range(n):
        g[f[x]] = x
    for y in range(m):
        if g[y] < 0:
            g[y] = best_image(Y[y], X, ys, xs, n_pairs)
            xs[n_pairs], ys[n_pairs] = g[y], y
            n_pairs += 1
