"""The steps of an exact comparison; each improves an interval and stops with the clock."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from rinow.comparison.clock import Clock
from rinow.comparison.engine import BIJECTION, RELATION, Engine, Search
from rinow.comparison.interval import Interval
from rinow.comparison.level_search import LevelSearch
from rinow.comparison.persistence import raise_by_persistence
from rinow.comparison.relaxation import relaxed_maps
from rinow.comparison.satisfiability import Satisfiability, solver_installed
from rinow.comparison.symmetry import Isometries, isometries
from rinow.comparison.warm_start import BijectionTabu, RelationTabu, TabuSearch

__all__ = ["close", "warm_start"]

Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]
Symmetries = tuple[Isometries, Isometries]

STARTS, MOVES = 12, 40
"""Tabu searches before the exact one, and moves of each for every point."""

RELAXATION = 0.3
"""Most of the time of the tabu searches for relaxed maps."""

PROOF = 0.25
"""Share of the time of the tabu searches for a proof that the first one found the best."""

WARM, LONGEST_WARM, WARM_SPEED = 0.15, 0.6, 130_000
"""Share of the time for tabu search; more, up to another share, where many points need it: so many pairs a second."""

CLIMB, INSISTENCE = 0.7, 0.7
"""Shares of the time for levels from below, where they are few, and of what is left then for long tabu searches."""

LONG_SEARCHES = 7
"""Number of these, the last one 64 times as long as the first."""

LEARNING = 0.4
"""Share of the time for a clause-learning solver; the share of what is left, anew, with each relation that it finds."""

SYMMETRY = 0.1
"""Share of the time for finding isometries of both spaces."""

BISECTION = 2e-3
"""The bound of arc consistency is found to this share of itself."""


def close(engine: Engine, interval: Interval, clock: Clock) -> None:
    """All steps in turn, until the interval is closed or the time is over."""
    n_points = sum(engine.shape)
    warm = max(WARM * clock.left, min(LONGEST_WARM * clock.left, n_points * n_points / WARM_SPEED))
    warm_start(engine, interval, clock.part(warm))
    if interval.closed or clock.over:
        return
    listing = clock.part(SYMMETRY * clock.left)
    symmetries = isometries(engine.DX, listing), isometries(engine.DY, listing)
    if engine.kind == BIJECTION:
        symmetries = symmetries[0].exact(), symmetries[1].exact()
    _close_with(engine, interval, clock, symmetries)
    if not interval.closed and any(symmetric.error > 0.0 for symmetric in symmetries):  # it may have hidden the rest
        _close_with(engine, interval, clock, (symmetries[0].exact(), symmetries[1].exact()))


def _close_with(engine: Engine, interval: Interval, clock: Clock, symmetries: Symmetries) -> None:
    """The exact steps with some isometries: until the interval is closed up to their error, or the time is over."""
    if clock.over:
        return
    homogeneous = any(symmetric.transitive for symmetric in symmetries)
    share, climbing, insistence = (0.05, 0.05, 0.05) if homogeneous else (0.2, CLIMB, INSISTENCE)
    if engine.kind == RELATION and engine.levels.few:
        climb(engine, interval, clock.part(climbing * clock.left), symmetries)
        insist(engine, interval, clock.part(insistence * clock.left))
        if interval.closed:
            return
    possible = branch_and_bound(engine, interval, clock.part(share * clock.left), None, symmetries)
    if possible is not None and not interval.closed:
        satisfiability(engine, interval, clock, possible, symmetries)
    if possible is not None and not interval.closed:
        if engine.kind == RELATION:
            raise_by_persistence(engine.DX, engine.DY, interval, clock)
        bisect_by_consistency(engine, interval, clock.part(0.4 * clock.left))
        branch_and_bound(engine, interval, clock, possible, symmetries)


def warm_start(engine: Engine, interval: Interval, clock: Clock, *, target: float = 0.0) -> None:
    """Tabu search from several starts: rows that agree best, the best relation so far, relaxed maps, then random ones.

    Nearly isometric spaces are done after the first: arc consistency refutes what is below.  Where levels are few they
    are met one by one afterwards.
    """
    if clock.over:
        return
    rng = np.random.default_rng(20)
    for k, search in enumerate(_searches(engine, rng, interval, clock)):
        search.run(MOVES * sum(engine.shape), clock, max(target, interval.lower))
        interval.offer(search.pairs, search.best)
        if interval.upper <= target:
            return
        if k == 0 and not interval.closed and not engine.levels.few:
            level = interval.wanted
            if engine.consistent(level, clock.part(PROOF * clock.left)) is None:
                interval.refuted(level, engine, "arc consistency")
        if interval.closed or clock.over or k + 1 == STARTS:
            return


def insist(engine: Engine, interval: Interval, clock: Clock) -> None:
    """Tabu searches from random maps, each twice as long as the last one: few levels are hard to meet."""
    (n, m), rng, n_moves = engine.shape, np.random.default_rng(21), MOVES * sum(engine.shape)
    for seed in range(STARTS, STARTS + LONG_SEARCHES):
        if interval.closed or clock.over:
            return
        search = RelationTabu(engine.DX, engine.DY, rng.integers(m, size=n), rng.integers(n, size=m), seed)
        search.run(n_moves, clock, interval.lower)
        interval.offer(search.pairs, search.best)
        n_moves *= 2


def _searches(engine: Engine, rng: np.random.Generator, interval: Interval, clock: Clock) -> Iterator[TabuSearch]:
    """Tabu searches without end."""
    (n, m), levels, DX, DY = engine.shape, engine.row_levels, engine.DX, engine.DY
    relaxed = relaxed_maps(DX, DY, np.minimum(levels, 1e100), clock.part(RELAXATION * clock.left))
    if engine.kind == BIJECTION:
        maps = [linear_sum_assignment(np.log(np.minimum(levels, 1e100)))[1], *(f for f, _ in relaxed)]
        yield from _best_first([BijectionTabu(DX, DY, f, seed) for seed, f in enumerate(maps)])
        for seed in itertools.count(len(maps)):
            yield BijectionTabu(DX, DY, rng.permutation(n), seed)
    starts = [(levels.argmin(axis=1), levels.argmin(axis=0)), _maps(engine, interval), *relaxed]
    yield from _best_first([RelationTabu(DX, DY, f, g, seed) for seed, (f, g) in enumerate(starts)])
    for seed in itertools.count(len(starts)):
        yield RelationTabu(DX, DY, rng.integers(m, size=n), rng.integers(n, size=m), seed)


def _best_first(searches: Sequence[TabuSearch]) -> list[TabuSearch]:
    """In the order of the values of their starts."""
    return sorted(searches, key=lambda search: search.best)


def _maps(engine: Engine, interval: Interval) -> tuple[Indices, Indices]:
    """An image of each point in the best relation."""
    n, m = engine.shape
    f, g = np.zeros(n, np.intp), np.zeros(m, np.intp)
    f[interval.pairs[:, 0]] = interval.pairs[:, 1]
    g[interval.pairs[:, 1]] = interval.pairs[:, 0]
    return f, g


def polish(engine: Engine, interval: Interval, clock: Clock) -> None:
    """Tabu search from the best relation, in the hope of leaving out many small improvements."""
    n, m = engine.shape
    f, g = _maps(engine, interval)
    seed = len(interval.pairs)
    bijective = engine.kind == BIJECTION
    search = (
        BijectionTabu(engine.DX, engine.DY, f, seed) if bijective else RelationTabu(engine.DX, engine.DY, f, g, seed)
    )
    search.run(8 * (n + m), clock, interval.lower)
    interval.offer(search.pairs, search.best)


def climb(engine: Engine, interval: Interval, clock: Clock, symmetries: Symmetries) -> None:
    """Refute the levels one by one from the lowest that is open, until one is attained or the time is over.

    Low levels leave less to search than those just below the upper bound.
    """
    last = -math.inf
    while not interval.closed and not clock.over:
        level = engine.levels.above(float(np.nextafter(interval.lower, -math.inf)))
        if level >= interval.upper:
            interval.raise_lower(interval.upper, interval.by)
        if level >= interval.upper or level <= last:  # the error of isometries may hide the next level
            return
        last = level
        search = LevelSearch(engine, level, symmetries)
        if not search.consistent:
            interval.refuted(level, engine, "arc consistency")
            continue
        exhausted, pairs = search.run(clock)
        if exhausted:
            interval.refuted(level, engine, "search", search.error)
        elif pairs is None:
            return
        else:
            interval.offer(pairs, engine.worst_of(pairs))


def branch_and_bound(
    engine: Engine, interval: Interval, clock: Clock, possible: Flags | None, symmetries: Symmetries
) -> Flags | None:
    """Search below the upper bound until it is proved or the time is over; the pairs still possible below it."""
    level = interval.wanted
    possible = engine.consistent(level, clock, possible)
    if possible is None:
        interval.refuted(level, engine, "arc consistency")
        return None
    if not engine.fits(possible):
        return possible
    search = Search(engine, possible, level, clock, (symmetries[0].images, symmetries[1].images))
    while not interval.closed:
        exhausted, pairs = search.run(clock)
        if exhausted:
            error = symmetries[0].error + symmetries[1].error
            interval.refuted(level, engine, "search", error * search.depth_of_proof)
            return None
        if pairs is None:
            break
        interval.offer(pairs, engine.worst_of(pairs))
        polish(engine, interval, clock)
        level = interval.wanted
        search.lower_level(level, clock)
    return search.possible()


def satisfiability(engine: Engine, interval: Interval, clock: Clock, possible: Flags, symmetries: Symmetries) -> None:
    """Let a clause-learning solver search below the upper bound until it is proved or its share of the time is over.

    What it learned would be lost with it: while it finds better relations it goes on.
    """
    level, solving = interval.wanted, clock.part(LEARNING * clock.left)
    left = engine.consistent(level, solving, possible)
    if left is None:
        interval.refuted(level, engine, "arc consistency")
        return
    if not solver_installed():
        return
    with Satisfiability(engine, left, level, solving, symmetries, verify=interval.verify) as solver:
        while solver.ready and not interval.closed:
            refuted, pairs = solver.run(solving)
            if refuted:
                solver.refutes(interval, clock)
            if refuted or pairs is None:
                return
            interval.offer(pairs, engine.worst_of(pairs))
            solving = clock.part(LEARNING * clock.left)
            polish(engine, interval, solving)
            solver.lower_level(interval.wanted, solving)


def bisect_by_consistency(engine: Engine, interval: Interval, clock: Clock, possible: Flags | None = None) -> None:
    """Raise the lower bound to the highest level that arc consistency refutes."""
    low, high = interval.lower, interval.wanted
    while high - low > BISECTION * high and not interval.closed and not clock.over:
        middle = 0.5 * (low + high)
        if engine.kind != BIJECTION and engine.levels.few:
            middle = max(engine.levels.up_to(middle), low)
        left = engine.consistent(middle, clock, possible)
        if left is None:
            interval.refuted(middle, engine, "arc consistency")
            low = max(middle, interval.lower)
        elif not clock.over:
            high, possible = float(np.nextafter(middle, -math.inf)), left
