"""Spaces of thousands of points, such as the vertices of meshes: dives and repair with measured distortion."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import RELATION
from rinow.comparison.interval import Interval
from rinow.comparison.large_subsets import raise_by_few_points
from rinow.comparison.large_work import NET, Work, farthest_points
from rinow.comparison.persistence import raise_by_persistence
from rinow.comparison.warm_start import RelationTabu
from rinow.kernels import compatibility
from rinow.kernels.dives import LEFT_OVER

__all__ = ["LARGE", "approach"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

LARGE = 400_000_000
"""n m (n + m) from which the tables of the exact search take too long to fill."""

TIGHT, LOOSE = (1.0005, 1.01, 1.005, 1.02), (0.2, 0.4, 0.6, 0.8)
"""Levels of the dives: as multiples of a tight lower bound, as shares of the gap above a loose one."""

LOOSENESS = 2.0
"""The lower bound is called tight when the upper one is below this multiple of it."""

TIGHT_LEVELS = 32
"""Tight levels that are tried before loose ones where the lower bound may be weak."""

OFFERED = 8
"""Relations that fit no level are measured for so many levels, then once in so many"""

REPAIRS = 20
"""Repairs without progress before a target is given up."""

GROWING_REPAIRS = 6
"""The same while a net grows: another beginning costs less."""

WORSE = 1.1
"""Share of the fewest conflicts that the next repair may start from."""

BALLS = (0.0, 0.05, 0.1, 0.15, 0.2)
"""Radii, in diameters, of the balls around a pair in conflict that a repair takes out."""

STEPS = (0.97, 0.985, 0.993)
"""Targets of repair as shares of the distortion; the next one after a failure."""

ABOVE = 1.0 + 1e-6
"""Targets stay above the lower bound by this factor: single precision."""

FAILED, FEW_POINTS = 4, 0.2
"""Levels that fail before a weak lower bound is raised by few points and their partners, in a share of the time left,
and an upper one is looked for between nets."""

TABU_NET, TABU_MOVES = 150, 4000
"""Points of the nets between which a tabu search finds a relation where the lower bound is weak, and its moves."""

FIRST_ROWS, ROWS = 4, 48
"""Points of each space whose sorted distances are compared with those of all points of the other one: before the dives,
and when these do not close the interval."""


def approach(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """Improve the upper bound until it meets the lower one or the time is over."""
    _bound_by_rows(DX, DY, FIRST_ROWS, interval, clock.part(0.1 * clock.left))
    if interval.closed or clock.over:
        return
    work = Work(DX, DY)
    for k, level in enumerate(_levels(interval)):
        if interval.closed or clock.over:
            return
        if k == TIGHT_LEVELS:
            _bound_by_rows(DX, DY, ROWS, interval, clock.part(0.1 * clock.left))
        if k == FAILED and interval.upper > LOOSENESS * interval.lower:
            raise_by_persistence(DX, DY, interval, clock)
            raise_by_few_points(DX, DY, interval, clock.part(FEW_POINTS * clock.left))
            relation = _from_nets(work, interval, clock)
            if relation is not None:
                _tighten(work, relation, interval, clock)
        relation, fits = _grown(work, level, clock)
        if relation is None:
            continue
        if fits:
            _tighten(work, relation, interval, clock)
        elif k < OFFERED or k % OFFERED == 0:
            whole = work.completed(np.where(relation < 0, LEFT_OVER, relation), clock)
            if whole is not None:
                interval.offer(*work.measured(whole))


def _grown(work: Work, level: float, clock: Clock) -> tuple[Indices | None, bool]:
    """A relation of all points that begins with a dive for a net, and whether it fits the level.

    The net grows while repair takes all conflicts out; then the rest gets the partners that agree best.
    """
    begun = work.begun(level, clock)
    if begun is None:
        return None, False
    relation, promising = begun
    size, largest = NET, max(len(work.X), len(work.Y))
    while promising:
        relation = work.polished(relation, level)
        repaired = _repair(work, relation, level, clock, GROWING_REPAIRS)
        if repaired is None:
            break
        relation = repaired
        if size >= largest:
            return relation, True
        size *= 2
        larger = work.extended(relation, size, level, clock)
        if larger is None:
            break
        relation = larger
    return relation, False


def _from_nets(work: Work, interval: Interval, clock: Clock) -> Indices | None:
    """The best relation of two nets found by tabu search, extended to all points; None if the time does not suffice."""
    search_clock = clock.part(0.15 * clock.left)
    xs, ys = farthest_points(work.DX, TABU_NET), farthest_points(work.DY, TABU_NET)
    NX, NY = work.DX[np.ix_(xs, xs)], work.DY[np.ix_(ys, ys)]
    rng = np.random.default_rng(22)
    best = RelationTabu(NX, NY, rng.integers(len(ys), size=len(xs)), rng.integers(len(xs), size=len(ys)), 0)
    best.run(TABU_MOVES, search_clock)
    for seed in range(1, 8):
        f, g = rng.integers(len(ys), size=len(xs)), rng.integers(len(xs), size=len(ys))
        search = RelationTabu(NX, NY, f, g, seed)
        search.run(TABU_MOVES, search_clock, interval.lower)
        best = search if search.best < best.best else best
        if search_clock.over:
            break
    partners = np.full(len(work.X) + len(work.Y), LEFT_OVER)
    partners[xs[best.pairs[:, 0]]] = ys[best.pairs[:, 1]]
    partners[len(work.X) + ys[best.pairs[:, 1]]] = xs[best.pairs[:, 0]]
    return work.completed(partners, clock)


def _bound_by_rows(DX: Floats, DY: Floats, n_rows: int, interval: Interval, clock: Clock) -> None:
    """The bound by sorted distances for some farthest points of each space against all of the other one."""
    sorted_x, sorted_y = np.sort(DX, axis=1), np.sort(DY, axis=1)
    for D, own, other in ((DX, sorted_x, sorted_y), (DY, sorted_y, sorted_x)):
        for chosen in np.array_split(farthest_points(D, n_rows), -(-min(n_rows, len(D)) // 4)):
            if clock.over or interval.closed:
                return
            levels = np.empty((len(chosen), len(other)))
            compatibility.many_row_discrepancies(RELATION, True, own[chosen], other, levels)
            interval.raise_lower(float(levels.min(axis=1).max()), "sorted distances")


def _levels(interval: Interval) -> Iterator[float]:
    """Levels for dives in turn."""
    for k in count():
        tight = interval.upper < LOOSENESS * interval.lower or k < TIGHT_LEVELS or k % 8 < 4
        if interval.lower > 0 and tight:
            yield TIGHT[k % len(TIGHT)] * interval.lower
        else:
            yield interval.lower + LOOSE[k % len(LOOSE)] * (interval.upper - interval.lower)


def _tighten(work: Work, relation: Indices, interval: Interval, clock: Clock) -> None:
    """Repair a relation at falling targets while that succeeds."""
    pairs, value = work.measured(relation)
    interval.offer(pairs, value)
    step = 0
    while step < len(STEPS) and not interval.closed and not clock.over:
        target = max(ABOVE * interval.lower, STEPS[step] * value)
        repaired = _repair(work, relation, target, clock)
        if repaired is None:
            step += 1
            continue
        pairs, smaller = work.measured(repaired)
        interval.offer(pairs, smaller)
        if smaller >= value:
            return
        relation, value, step = repaired, smaller, 0


def _repair(work: Work, relation: Indices, target: float, clock: Clock, most: int = REPAIRS) -> Indices | None:
    """Take the pairs in conflict out, with some others, and dive for them again, until none is left; None if one is."""
    wrong, stalled = work.conflicts(relation, target), 0
    fewest = len(wrong)
    while len(wrong):
        if stalled == most or clock.over:
            return None
        again = work.repaired(relation, wrong, target, BALLS[stalled % len(BALLS)], clock)
        stalled += 1
        if again is None:
            continue
        conflicts = work.conflicts(again, target)
        if len(conflicts) < fewest:
            fewest, stalled = len(conflicts), 0
        if len(conflicts) <= WORSE * fewest:
            relation, wrong = again, conflicts
    return relation
