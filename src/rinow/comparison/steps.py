"""The steps of an exact comparison; each improves an interval and stops with the clock."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import Engine, Search
from rinow.comparison.interval import Interval
from rinow.comparison.warm_start import TabuSearch

__all__ = ["bisect_by_consistency", "branch_and_bound", "warm_start"]

Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

BISECTION = 2e-3
"""The bound of arc consistency is found to this share of itself."""


def starts(engine: Engine, rng: np.random.Generator) -> Iterator[tuple[Indices, Indices]]:
    """Maps both ways: by the rows that agree best, then random ones."""
    n, m = engine.shape
    yield engine.row_levels.argmin(axis=1), engine.row_levels.argmin(axis=0)
    while True:
        yield rng.integers(m, size=n), rng.integers(n, size=m)


def warm_start(engine: Engine, interval: Interval, clock: Clock, *, n_starts: int, n_moves: int) -> None:
    """Tabu search from several starts."""
    maps = starts(engine, np.random.default_rng(20))
    for seed in range(n_starts):
        if interval.closed or clock.over:
            return
        search = TabuSearch(engine.DX, engine.DY, *next(maps), seed)
        search.run(n_moves, clock, interval.lower)
        interval.offer(search.pairs, search.best)


def polish(engine: Engine, interval: Interval, clock: Clock) -> None:
    """Tabu search from the best relation, in the hope of leaving out many small improvements."""
    n, m = engine.shape
    f, g = np.zeros(n, np.intp), np.zeros(m, np.intp)
    f[interval.pairs[:, 0]] = interval.pairs[:, 1]
    g[interval.pairs[:, 1]] = interval.pairs[:, 0]
    search = TabuSearch(engine.DX, engine.DY, f, g, len(interval.pairs))
    search.run(8 * (n + m), clock, interval.lower)
    interval.offer(search.pairs, search.best)


def branch_and_bound(
    engine: Engine,
    interval: Interval,
    clock: Clock,
    possible: Flags | None = None,
    isometries: tuple[Indices, Indices] | None = None,
) -> Flags | None:
    """Search below the upper bound until it is proved or the time is over; the pairs still possible below it."""
    level = interval.wanted
    possible = engine.consistent(level, clock, possible)
    if possible is None:
        interval.refuted(level, engine, "arc consistency")
        return None
    if not engine.fits(possible):
        return possible
    search = Search(engine, possible, level, isometries)
    while not interval.closed:
        exhausted, pairs = search.run(clock)
        if exhausted:
            interval.refuted(level, engine, "search")
            return None
        if pairs is None:
            return search.possible()
        interval.offer(pairs, engine.worst_of(pairs))
        polish(engine, interval, clock)
        level = interval.wanted
        search.lower_level(level)
    return search.possible()


def bisect_by_consistency(engine: Engine, interval: Interval, clock: Clock, possible: Flags | None = None) -> None:
    """Raise the lower bound to the highest level that arc consistency refutes."""
    low, high = interval.lower, interval.wanted
    while high - low > BISECTION * high and not interval.closed and not clock.over:
        middle = 0.5 * (low + high)
        left = engine.consistent(middle, clock, possible)
        if left is None:
            interval.refuted(middle, engine, "arc consistency")
            low = max(middle, interval.lower)
        elif not clock.over:
            high, possible = middle, left
