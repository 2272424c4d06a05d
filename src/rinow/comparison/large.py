"""Spaces of thousands of points, such as the vertices of meshes: dives, repair and polish with measured distortion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import RELATION
from rinow.comparison.interval import Interval
from rinow.comparison.large_work import Maps, Work, farthest_points
from rinow.kernels import compatibility

__all__ = ["LARGE", "approach"]

Floats = NDArray[np.float64]

LARGE = 400_000_000
"""n m (n + m) from which the tables of the exact search take too long to fill."""

TIGHT, LOOSE = (1.0005, 1.01, 1.02, 1.05), (0.2, 0.4, 0.6, 0.8)
"""Levels of the dives: as multiples of a tight lower bound, as shares of the gap above a loose one."""

LOOSENESS = 2.0
"""The lower bound is called tight when the upper one is below this multiple of it, or little was tried yet."""

FIRST_POINTS = (6, 12)
"""Farthest points that get their partners first."""

REPAIRS = 16
"""Repairs without progress before the next dive begins."""

BALLS = (0.0, 0.05, 0.1, 0.15, 0.2)
"""Radii, in diameters, of the balls around a pair in conflict that a repair takes out."""

ROWS = 48
"""Points of each space whose sorted distances are compared with those of all points of the other one."""

SHARES = (0.93, 0.96, 0.98, 0.99, 0.995)
"""Targets of polish as shares of the distortion; the next one after a failure."""


def approach(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """Improve the upper bound until it meets the lower one or the time is over."""
    _bound_by_rows(DX, DY, interval, clock.part(0.1 * clock.left))
    work = Work(DX, DY)
    for level, n_first in _levels(interval):
        if interval.closed or clock.over:
            return
        maps = work.dive(level, n_first, clock)
        if maps is None:
            continue
        maps = _repair(work, maps, level, interval, clock)
        _polish(work, maps, interval, clock.part(0.2 * clock.left))


def _bound_by_rows(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """The bound by sorted distances for some farthest points of each space against all of the other one."""
    sorted_x, sorted_y = np.sort(DX, axis=1), np.sort(DY, axis=1)
    for D, own, other in ((DX, sorted_x, sorted_y), (DY, sorted_y, sorted_x)):
        for chosen in np.array_split(farthest_points(D, ROWS), -(-min(ROWS, len(D)) // 4)):
            if clock.over or interval.closed:
                return
            levels = np.empty((len(chosen), len(other)))
            compatibility.many_row_discrepancies(RELATION, True, own[chosen], other, levels)
            interval.raise_lower(float(levels.min(axis=1).max()), "sorted distances")


def _levels(interval: Interval) -> Iterator[tuple[float, int]]:
    """Levels for dives in turn, and how many farthest points come first."""
    k = 0
    while True:
        tight = interval.lower > 0 and (k < 40 or interval.upper < LOOSENESS * interval.lower)
        if tight:
            level = TIGHT[k % len(TIGHT)] * interval.lower
        else:
            level = interval.lower + LOOSE[k % len(LOOSE)] * (interval.upper - interval.lower)
        yield level, FIRST_POINTS[k // len(TIGHT) % len(FIRST_POINTS)]
        k += 1


def _repair(work: Work, maps: Maps, level: float, interval: Interval, clock: Clock) -> Maps:
    """Take the pairs in conflict out, with some others, and dive for them again; the best maps."""
    best = work.conflicts(maps, level)
    stalled = 0
    while stalled < REPAIRS and best.any() and not clock.over:
        again = work.dive_again(maps, best, level, BALLS[stalled % len(BALLS)], clock)
        stalled += 1
        if again is None:
            continue
        conflicts = work.conflicts(again, level)
        if conflicts.sum() < best.sum():
            stalled = 0
        if conflicts.sum() <= best.sum():
            maps, best = again, conflicts
    interval.offer(*work.measured(maps))
    return maps


def _polish(work: Work, maps: Maps, interval: Interval, clock: Clock) -> None:
    """Move images to neighbours while that lowers the distortion."""
    _, best = work.measured(maps)
    k = 0
    while k < len(SHARES) and not interval.closed and not clock.over:
        maps = work.polished(maps, max(interval.lower, best * SHARES[k]), clock)
        pairs, value = work.measured(maps)
        interval.offer(pairs, value)
        if value < best:
            best = value
        else:
            k += 1
