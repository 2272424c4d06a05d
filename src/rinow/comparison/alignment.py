"""Maps between spaces that are nearly sets of points of a space of few dimensions: placed there, turned, and matched.

Distances give coordinates up to an isometry by classical scaling; that they may fit badly costs nothing but quality: a
map is measured with the distances.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh
from scipy.spatial import KDTree

from rinow.comparison.clock import Clock, TimeOver
from rinow.comparison.engine import RELATION, worst_of
from rinow.comparison.interval import Interval
from rinow.comparison.warm_start import graphs

__all__ = ["align", "coordinates"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

DIMENSIONS, SMALL_SPREAD = 3, 0.05
"""Most dimensions, and share of the largest variance from which an axis counts."""

DENSE = 100
"""Points of a space up to which all of its matrix is transformed; of larger ones eigenvalues come by iteration, which
is faster, looks at the clock, and waits for other threads less often: on a busy machine that took seconds."""

PLACED = 2e7
"""Distances of spaces that are placed in a second: nothing is begun for which the time does not suffice."""

ANGLES, TURNS, RANKED = 24, 48, 500
"""Rotations of the plane, and of other spaces, from which matching starts, each with its mirror image; points by which
the best are chosen."""

TRIED, PATIENCE, MATCHES = 16, 4, 6
"""Rotations that bring the sets nearest to each other, those in a row that may gain nothing, and rounds of matching and
turning from each."""


def align(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """Offer maps f: X → Y and g: Y → X whose graphs together have the least distortion of those tried."""
    if clock.over or DX.size + DY.size > PLACED * clock.left:
        return
    scale = float(max(DX.max(), DY.max())) or 1.0  # squares neither overflow nor vanish
    try:
        P, Q = coordinates(DX / scale, clock), coordinates(DY / scale, clock)
    except TimeOver:
        return
    d = max(P.shape[1], Q.shape[1])
    P, Q = (np.pad(points, ((0, 0), (0, d - points.shape[1]))) for points in (P, Q))
    tree, (few_p, few_q) = KDTree(Q), (points[:: -(-len(points) // RANKED)] for points in (P, Q))
    few_tree = KDTree(few_q)
    turns = sorted(_turns(d), key=lambda turn: _farthest(few_p @ turn, few_q, few_tree))
    stalled = 0
    for turn in turns[:TRIED]:
        stalled += 1
        for f, g in _matched(P, P @ turn, Q, tree):
            pairs = graphs(f, g)
            if interval.offer(pairs, worst_of(RELATION, DX, DY, pairs)):
                stalled = 0
            if clock.over or interval.closed:
                return
        if stalled == PATIENCE:
            return


def coordinates(D: Floats, clock: Clock | None = None) -> Floats:
    """(n, d): coordinates around their mean by classical scaling, d at most 3.

    Raises
    ------
    TimeOver
        If the time is over before.
    """
    products = D * D
    means = products.mean(axis=1)
    products -= means[:, None]
    products -= means - means.mean()
    products *= -0.5
    values, vectors = _greatest_eigenvalues(products, clock or Clock(np.inf))
    keep = values >= SMALL_SPREAD * values[-1]
    keep[-1] = True
    return vectors[:, keep] * np.sqrt(np.maximum(values[keep], 0.0))


def _greatest_eigenvalues(products: Floats, clock: Clock) -> tuple[Floats, Floats]:
    """The greatest eigenvalues, ascending, and their vectors; of large matrices by iteration."""
    n = len(products)

    def times(vector: Floats) -> Floats:
        if clock.over:  # iterations may be hundreds where no few directions stand out
            raise TimeOver
        return products @ vector

    if n > DENSE:
        try:
            operator = cast(Any, LinearOperator)((n, n), matvec=times, dtype=products.dtype)
            found: Any = eigsh(operator, DIMENSIONS, which="LA", v0=np.linspace(1.0, 2.0, n))
            return found
        except ArpackNoConvergence:
            pass  # eigenvalues that lie close together, of a space that fits nowhere
    return eigh(products, subset_by_index=[max(n - DIMENSIONS, 0), n - 1])


def _turns(d: int) -> Iterator[Floats]:
    """Rotations and reflections: a grid in the plane, elsewhere half turns around the axes and random ones.

    The coordinates lie along principal axes, so that those of nearly isometric spaces differ by signs.
    """
    mirror = np.diag([-1.0] + [1.0] * (d - 1))
    rng = np.random.default_rng(23)
    for k in range(1 if d == 1 else ANGLES if d == 2 else TURNS):
        turn = np.eye(d)
        if d == 2:
            c, s = np.cos(2 * np.pi * k / ANGLES), np.sin(2 * np.pi * k / ANGLES)
            turn = np.array([[c, -s], [s, c]])
        elif 0 < k <= d:
            turn = -turn
            turn[k - 1, k - 1] = 1.0
        elif k > 0:
            turn = np.linalg.qr(rng.normal(size=(d, d)))[0]
        yield turn
        yield mirror @ turn


def _farthest(P: Floats, Q: Floats, tree: KDTree) -> float:
    """Hausdorff distance of two sets of points."""
    return float(max(tree.query(P)[0].max(), KDTree(P).query(Q)[0].max()))


def _matched(P: Floats, moved: Floats, Q: Floats, tree: KDTree) -> Iterator[tuple[Indices, Indices]]:
    """Nearest points both ways, again after each best motion for the last ones until they stay the same."""
    last = None
    for _ in range(MATCHES):
        f, g = np.asarray(tree.query(moved)[1]), np.asarray(KDTree(moved).query(Q)[1])
        if last is not None and np.array_equal(f, last[0]) and np.array_equal(g, last[1]):
            return
        yield f, g
        last = f, g
        A, B = np.concatenate([P, P[g]]), np.concatenate([Q[f], Q])
        a, b = A.mean(axis=0), B.mean(axis=0)
        U, _, V = np.linalg.svd((A - a).T @ (B - b))
        moved = (P - a) @ (U @ V) + b
