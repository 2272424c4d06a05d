"""Spaces of thousands of points, such as the vertices of meshes: dives and polish with measured distortion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import RELATION
from rinow.comparison.interval import Interval
from rinow.kernels import compatibility, distortion, dives, polish

__all__ = ["LARGE", "approach"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

LARGE = 400_000_000
"""n m (n + m) from which the tables of the exact search take too long to fill."""

TIGHT, LOOSE = (1.0005, 1.01, 1.02, 1.05), (0.2, 0.4, 0.6, 0.8)
"""Levels of the dives: as multiples of a tight lower bound, as shares of the gap above a loose one."""

LOOSENESS = 2.0
"""The lower bound is called tight when the upper one is below this multiple of it, or nothing was tried yet."""

FIRST_POINTS = (6, 12)
"""Farthest points that get their images first."""

MOST_ORPHANS = 70
"""Points a dive may leave over."""

ROWS = 48
"""Points of each space whose sorted distances are compared with those of all points of the other one."""

NEIGHBOURS = 24
"""Nearest points to which polish may move an image."""

SHARES = (0.93, 0.96, 0.98, 0.99, 0.995)
"""Targets of polish as shares of the distortion; the next one after a failure."""


def approach(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """Improve the upper bound until it meets the lower one or the time is over."""
    _bound_by_rows(DX, DY, interval, clock.part(0.1 * clock.left))
    scale = float(max(DX.max(), DY.max())) or 1.0
    work = _Work(DX, DY, scale)
    for level, n_first in _levels(interval):
        if interval.closed or clock.over:
            return
        maps = work.dive(level, n_first, clock)
        if maps is None:
            continue
        interval.offer(*work.measured(*maps))
        work.polish(*maps, interval, clock)


def _bound_by_rows(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """The bound by sorted distances for some farthest points of each space against all of the other one."""
    sorted_x, sorted_y = np.sort(DX, axis=1), np.sort(DY, axis=1)
    for D, own, other in ((DX, sorted_x, sorted_y), (DY, sorted_y, sorted_x)):
        for chosen in np.array_split(_farthest_points(D, ROWS), -(-min(ROWS, len(D)) // 4)):
            if clock.over or interval.closed:
                return
            levels = np.empty((len(chosen), len(other)))
            compatibility.many_row_discrepancies(RELATION, True, own[chosen], other, levels)
            interval.raise_lower(float(levels.min(axis=1).max()), "sorted distances")


def _levels(interval: Interval) -> Iterator[tuple[float, int]]:
    """Levels for dives in turn, and how many farthest points come first."""
    k = 0
    while True:
        tight = interval.lower > 0 and (k < len(TIGHT) or interval.upper < LOOSENESS * interval.lower)
        if tight:
            level = TIGHT[k % len(TIGHT)] * interval.lower
        else:
            level = interval.lower + LOOSE[k % len(LOOSE)] * (interval.upper - interval.lower)
        yield level, FIRST_POINTS[k // len(TIGHT) % len(FIRST_POINTS)]
        k += 1


class _Work:
    """Single precision copies of two spaces, and what dives and polish need."""

    def __init__(self, DX: Floats, DY: Floats, scale: float) -> None:
        self.DX, self.DY, self.scale = DX, DY, scale
        self.X, self.Y = (DX / scale).astype(np.float32), (DY / scale).astype(np.float32)
        self.ecc_x, self.ecc_y = DX.max(axis=1), DY.max(axis=1)
        self.weights = np.ones(len(DX))
        self.random = np.array([0x2545F4914F6CDD1D], np.uint64)
        self._near: tuple[Indices, Indices] | None = None

    def measured(self, f: Indices, g: Indices) -> tuple[Indices, float]:
        """The union of two graphs and its distortion."""
        forward = np.stack([np.arange(len(f)), f], axis=1)
        backward = np.stack([g, np.arange(len(g))], axis=1)
        pairs = np.unique(np.concatenate([forward, backward]), axis=0)
        values, places = np.empty(len(pairs)), np.empty(len(pairs), np.intp)
        xs, ys = np.ascontiguousarray(pairs[:, 0]), np.ascontiguousarray(pairs[:, 1])
        distortion.worst_partners(RELATION, self.DX, self.DY, xs, ys, values, places)
        return pairs, float(values.max())

    def dive(self, level: float, n_first: int, clock: Clock) -> tuple[Indices, Indices] | None:
        """One dive at a level, completed to two maps; None if it left too many points over or the time is up."""
        n, m = len(self.X), len(self.Y)
        state = dives.Dive(
            self.X, self.Y, np.empty((n, m), np.int32), np.empty(n, np.int64), np.empty(n, np.int64),
            _farthest_points(self.DX, n_first), self.weights, self.random, np.zeros(2, np.int64),
        )  # fmt: skip
        dives.begin(state, np.abs(self.ecc_x[:, None] - self.ecc_y) <= level)
        if not state.counts.all():
            return None
        t, step = np.float32(level / self.scale), 1
        while dives.descend(state, t, step, MOST_ORPHANS):
            if clock.over:
                return None
            step = 8 if state.counts.sum() < 20 * n else 1
        if state.counters[dives.ORPHANS] > MOST_ORPHANS:
            return None
        f, g = state.f, np.empty(m, np.int64)
        dives.complete(self.X, self.Y, f, g)
        return f, g

    def polish(self, f: Indices, g: Indices, interval: Interval, clock: Clock) -> None:
        """Move images to neighbours while that lowers the distortion."""
        n, m = len(f), len(g)
        xs, ys = np.concatenate([np.arange(n), g]), np.concatenate([f, np.arange(m)])
        if self._near is None:
            self._near = _nearest(self.DX), _nearest(self.DY)
        state = polish.Polish(
            self.X, self.Y, xs, ys, *self._near, np.empty(n + m), np.zeros(n + m, np.int64), self.random,
            np.zeros(1, np.int64),
        )  # fmt: skip
        _, best = self.measured(f, g)
        for_share = 0
        while for_share < len(SHARES) and not interval.closed and not clock.over:
            target = max(interval.lower, best * SHARES[for_share])
            met = self._improve(state, np.float32(target / self.scale), clock)
            pairs, value = self.measured(ys[:n], xs[n:])
            interval.offer(pairs, value)
            if value < best:
                best, for_share = value, 0 if met else for_share
            else:
                for_share += 1

    def _improve(self, state: polish.Polish, t: np.float32, clock: Clock) -> bool:
        """Polish towards one target for a while; whether it was met."""
        polish.write_costs(state, t, state.costs)
        for _ in range(20):
            if polish.improve(state, t, 200):
                return True
            if clock.over:
                break
        return False


def _farthest_points(D: Floats, k: int) -> Indices:
    """A farthest-point sequence from a point of the greatest eccentricity."""
    nearest = D[int(D.max(axis=1).argmax())].copy()
    chosen = [int(D.max(axis=1).argmax())]
    while len(chosen) < min(k, len(D)):
        chosen.append(int(nearest.argmax()))
        np.minimum(nearest, D[chosen[-1]], out=nearest)
    return np.array(chosen, np.int64)


def _nearest(D: Floats) -> Indices:
    """The nearest points of each point."""
    k = min(NEIGHBOURS, len(D) - 1)
    masked = D.copy()
    np.fill_diagonal(masked, np.inf)
    return np.argpartition(masked, k - 1, axis=1)[:, :k]
