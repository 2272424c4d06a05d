"""Bijections of thousands of points: those of a few points, matched by search, lead to those of all.

A point is known by its distances from some anchors.  The map that sends each point to one at nearly the same distances
from the images of the anchors is found by linear assignment; then more points of it become anchors.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rinow.comparison import steps
from rinow.comparison.alignment import align
from rinow.comparison.assignment import assigned
from rinow.comparison.clock import Clock
from rinow.comparison.engine import BIJECTION, RELATION, Engine, worst_of
from rinow.comparison.interval import Interval
from rinow.comparison.large_work import farthest_points

__all__ = ["offer_bijections"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

ANCHORS = 100
"""Farthest points of either space that are matched by search; twice as many anchors each time after that."""

SEARCH = 0.2
"""Share of the time for this search."""

CLOSE = 0.02
"""Share of the mean distance that is added to each one before its logarithm is taken: of short ones little is known."""


def offer_bijections(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """Offer bijections of two spaces of equally many points, as far as the time reaches."""
    X, Y = (D / (D.mean() or 1.0) for D in (DX, DY))
    for anchors, images in _anchors(X, Y, interval, clock):
        if clock.over or interval.closed:
            return
        features_x, features_y = np.log(X[:, anchors] + CLOSE), np.log(Y[:, images] + CLOSE)
        costs = (features_x**2).sum(axis=1)[:, None] + (features_y**2).sum(axis=1) - 2.0 * features_x @ features_y.T
        pairs = np.stack([np.arange(len(X)), assigned(costs, clock)], axis=1)
        interval.offer(pairs, worst_of(BIJECTION, DX, DY, pairs))


def _anchors(X: Floats, Y: Floats, interval: Interval, clock: Clock) -> Iterator[tuple[Indices, Indices]]:
    """Points of X and points of Y that correspond to them: of nets, then of the best bijection so far."""
    xs, ys = farthest_points(X, ANCHORS), farthest_points(Y, ANCHORS)
    pairs = _matched(X[np.ix_(xs, xs)], Y[np.ix_(ys, ys)], clock.part(SEARCH * clock.left))
    yield xs[pairs[:, 0]], ys[pairs[:, 1]]
    order = farthest_points(X, len(X))
    size = 2 * ANCHORS
    while size < 2 * len(X):
        f = np.empty(len(X), np.intp)
        f[interval.pairs[:, 0]] = interval.pairs[:, 1]
        yield order[:size], f[order[:size]]
        size *= 2


def _matched(X: Floats, Y: Floats, clock: Clock) -> Indices:
    """A relation of two small spaces of small distortion."""
    n = np.arange(len(X))
    pairs = np.stack([n, n], axis=1)
    interval = Interval(pairs, worst_of(RELATION, X, Y, pairs))
    align(X, Y, interval, clock)
    steps.warm_start(Engine(X, Y), interval, clock)
    return interval.pairs
