"""Bijections of spaces that are nearly sets of points of a space of few dimensions, one an affine image of the other.

A map that stretches directions differently moves points far, and nearest points then are no partners.  In coordinates
along principal axes, each over its spread, an affine map is a rotation; where the spreads differ it only changes signs.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree
from scipy.spatial.distance import cdist

from rinow.comparison.alignment import PLACED, coordinates
from rinow.comparison.assignment import assigned
from rinow.comparison.clock import Clock, TimeOver
from rinow.comparison.engine import BIJECTION, worst_of
from rinow.comparison.interval import Interval

__all__ = ["offer_affine_bijections"]

Floats = NDArray[np.float64]

ROUNDS, ASSIGNED = 10, 4
"""Rounds of matching nearest points and of fitting an affine map, from each choice of signs; choices whose points are
then assigned to each other, the nearest first."""


def offer_affine_bijections(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """Offer bijections that are near affine maps, as far as the time reaches."""
    if interval.closed or clock.over or DX.size + DY.size > PLACED * clock.left:
        return
    try:
        P, Q = (coordinates(D / (float(D.max()) or 1.0), clock) for D in (DX, DY))
    except TimeOver:
        return
    d = min(P.shape[1], Q.shape[1])
    P, Q = _over_spreads(P[:, -d:]), _over_spreads(Q[:, -d:])
    tree, fits = KDTree(Q), list[tuple[float, Floats]]()
    for signs in itertools.product((1.0, -1.0), repeat=d):
        fits.append(_fitted(P, P * signs, Q, tree))
        if clock.over:
            return
    for _, moved in sorted(fits, key=lambda fit: fit[0])[:ASSIGNED]:
        squares = np.asarray(cdist(moved, Q, "sqeuclidean"), np.float64)
        pairs = np.stack([np.arange(len(P)), assigned(squares, clock)], axis=1)
        interval.offer(pairs, worst_of(BIJECTION, DX, DY, pairs))
        if interval.closed or clock.over:
            return


def _over_spreads(P: Floats) -> Floats:
    """Coordinates around 0 with a mean square of 1 along every axis."""
    spreads = np.sqrt((P * P).mean(axis=0))
    return P / np.where(spreads > 0.0, spreads, 1.0)


def _fitted(P: Floats, moved: Floats, Q: Floats, tree: KDTree) -> tuple[float, Floats]:
    """The image of P under the affine map that brings it nearest to Q, and the mean square of what is left."""
    for _ in range(ROUNDS):
        f, g = np.asarray(tree.query(moved)[1]), np.asarray(KDTree(moved).query(Q)[1])
        last = moved
        moved = P @ np.linalg.lstsq(np.concatenate([P, P[g]]), np.concatenate([Q[f], Q]), rcond=None)[0]
        if np.abs(moved - last).max() < 1e-9:
            break
    return float((np.asarray(tree.query(moved)[0]) ** 2).mean()), moved
