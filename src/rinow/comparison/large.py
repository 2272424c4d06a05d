"""Spaces of thousands of points, such as the vertices of meshes: dives and repair with measured distortion."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import RELATION
from rinow.comparison.interval import Interval
from rinow.comparison.large_work import Maps, Work, farthest_points
from rinow.comparison.warm_start import RelationTabu
from rinow.kernels import compatibility

__all__ = ["LARGE", "approach"]

Floats = NDArray[np.float64]

LARGE = 400_000_000
"""n m (n + m) from which the tables of the exact search take too long to fill."""

TIGHT, LOOSE = (1.0005, 1.01, 1.005, 1.02), (0.2, 0.4, 0.6, 0.8)
"""Levels of the dives: as multiples of a tight lower bound, as shares of the gap above a loose one."""

LOOSENESS = 2.0
"""The lower bound is called tight when the upper one is below this multiple of it."""

FIRST_POINTS = (6, 12)
"""Farthest points that get their partners first."""

REPAIRS = 20
"""Repairs without progress before a target is given up."""

WORSE = 1.1
"""Share of the fewest conflicts that the next repair may start from."""

BALLS = (0.0, 0.05, 0.1, 0.15, 0.2)
"""Radii, in diameters, of the balls around a pair in conflict that a repair takes out."""

STEPS = (0.97, 0.985, 0.993)
"""Targets of repair as shares of the distortion; the next one after a failure."""

TIGHT_DIVES = 40
"""Dives at tight levels before loose ones, whose long lists cost much, are tried where the lower bound is weak."""

DIVES_BEFORE_NETS = 8
"""Dives that are tried for nearly isometric spaces before maps are extended from nets."""

ABOVE = 1.0 + 1e-6
"""Targets stay above the lower bound by this factor: single precision."""

NET, NET_MOVES = 150, 4000
"""Points of the nets of the first relation, and moves of a tabu search between them."""

ROWS = 48
"""Points of each space whose sorted distances are compared with those of all points of the other one."""


def approach(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """Improve the upper bound until it meets the lower one or the time is over."""
    _bound_by_rows(DX, DY, interval, clock.part(0.1 * clock.left))
    if interval.closed or clock.over:
        return
    work = Work(DX, DY)
    for k, (level, n_first) in enumerate(_levels(interval)):
        if interval.closed or clock.over:
            return
        if k == DIVES_BEFORE_NETS and interval.upper > LOOSENESS * interval.lower:
            maps = _from_nets(work, interval, clock)
            if maps is not None:
                _tighten(work, maps, interval, clock)
        maps = work.dive(level, n_first, clock.part(0.2 * clock.left))
        if maps is None:
            continue
        better = _repair(work, maps, level, clock)
        interval.offer(*work.measured(better or maps))
        if better is not None or interval.upper > LOOSENESS * interval.lower:
            _tighten(work, better or maps, interval, clock)


def _from_nets(work: Work, interval: Interval, clock: Clock) -> Maps | None:
    """The best relation of two nets found by tabu search, extended to all points; None if the time does not suffice."""
    search_clock = clock.part(0.15 * clock.left)
    xs, ys = farthest_points(work.DX, NET), farthest_points(work.DY, NET)
    NX, NY = work.DX[np.ix_(xs, xs)], work.DY[np.ix_(ys, ys)]
    rng = np.random.default_rng(22)
    best = RelationTabu(NX, NY, rng.integers(len(ys), size=len(xs)), rng.integers(len(xs), size=len(ys)), 0)
    best.run(NET_MOVES, search_clock)
    for seed in range(1, 8):
        f, g = rng.integers(len(ys), size=len(xs)), rng.integers(len(xs), size=len(ys))
        search = RelationTabu(NX, NY, f, g, seed)
        search.run(NET_MOVES, search_clock, interval.lower)
        best = search if search.best < best.best else best
        if search_clock.over:
            break
    return work.extended(xs[best.pairs[:, 0]], ys[best.pairs[:, 1]], clock)


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
    for k in count():
        if interval.lower > 0 and (k < TIGHT_DIVES or k % 8 < 6 or interval.upper < LOOSENESS * interval.lower):
            level = TIGHT[k % len(TIGHT)] * interval.lower
        else:
            level = interval.lower + LOOSE[k % len(LOOSE)] * (interval.upper - interval.lower)
        yield level, FIRST_POINTS[k // len(TIGHT) % len(FIRST_POINTS)]


def _tighten(work: Work, maps: Maps, interval: Interval, clock: Clock) -> None:
    """Repair maps at falling targets while that succeeds."""
    pairs, value = work.measured(maps)
    interval.offer(pairs, value)
    step = 0
    while step < len(STEPS) and not interval.closed and not clock.over:
        target = max(ABOVE * interval.lower, STEPS[step] * value)
        repaired = _repair(work, maps, target, clock)
        if repaired is None:
            step += 1
            continue
        pairs, smaller = work.measured(repaired)
        interval.offer(pairs, smaller)
        if smaller >= value:
            return
        maps, value, step = repaired, smaller, 0


def _repair(work: Work, maps: Maps, target: float, clock: Clock) -> Maps | None:
    """Take the pairs in conflict out, with some others, and dive for them again, until none is left; None if one is."""
    wrong, stalled = work.conflicts(maps, target), 0
    fewest = wrong.sum()
    while wrong.any():
        if stalled == REPAIRS or clock.over:
            return None
        again = work.dive_again(maps, wrong, target, BALLS[stalled % len(BALLS)], clock)
        stalled += 1
        if again is None:
            continue
        conflicts = work.conflicts(again, target)
        if conflicts.sum() < fewest:
            fewest, stalled = conflicts.sum(), 0
        if conflicts.sum() <= WORSE * fewest:
            maps, wrong = again, conflicts
    return maps
