"""The constraint engine: relations between two spaces whose pairs agree to a level.

One engine serves the Gromov-Hausdorff distance (relations by differences), the Lipschitz distance (bijections by
ratios) and maps; only the compatibility of two pairs differs.  What it refutes is refuted for exactly the measure of
`worst_of`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.levels import Levels
from rinow.kernels import compatibility, correspondence_search, correspondences, distortion
from rinow.kernels.bitsets import prefixes
from rinow.kernels.compatibility import BIJECTION, MAP, RELATION

__all__ = ["BIJECTION", "MAP", "RELATION", "Engine", "Search", "worst_of"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

FIRST_LIMIT = 200
"""Nodes of a search before its first restart; each run is half as long again."""

SLICE = 20_000_000
"""Support tests between two looks at the clock: some tenths of a second."""

TABLE_BYTES = 3 << 29
"""Memory allowed for the runs of all possible pairs and the sets of sorted rows."""

UNLIMITED = 1 << 62
"""Work of a propagation that is small enough to be finished."""

BLOCK = 20_000_000
"""Distances compared or written between two looks at the clock: some tenths of a second."""

SERIAL_WORK = 2_000_000
"""Number of pairs times n + m below which a second thread costs more than it saves."""


def worst_of(kind: int, DX: Floats, DY: Floats, pairs: Indices) -> float:
    """Largest discrepancy between two pairs of a relation: its distortion, or for bijections the largest ratio."""
    xs, ys = np.ascontiguousarray(pairs[:, 0]), np.ascontiguousarray(pairs[:, 1])
    return float(distortion.largest_discrepancy(kind, DX, DY, xs, ys))


def blocks(n: int, work: int, clock: Clock) -> Iterator[slice]:
    """Parts of n items of so much work each, one after the other until the time is over."""
    step = max(1, BLOCK // work)
    for start in range(0, n, step):
        if clock.over:
            return
        yield slice(start, min(n, start + step))


def sorted_rows(D: Floats) -> compatibility.SortedRows:
    """The rows of a distance matrix in ascending order, each point first in its own row."""
    n = len(D)
    keys = D.copy()
    np.fill_diagonal(keys, -1.0)
    order = np.argsort(keys, axis=1, kind="stable")
    sets = np.empty((n, n + 1, -(-n // 64)), np.uint64)
    prefixes(order, sets)
    return compatibility.SortedRows(np.take_along_axis(D, order, axis=1), order, sets)


class Engine:
    """Two spaces, a kind of compatibility, and whether the points of Y must be covered too (`both`).

    When the time is over before all rows are compared, the levels of the rest are 0, which excludes nothing.
    """

    def __init__(
        self, DX: Floats, DY: Floats, kind: int = RELATION, *, both: bool = True, clock: Clock | None = None
    ) -> None:
        self.DX, self.DY, self.kind, self.both = DX, DY, kind, both
        self.shape = len(DX), len(DY)
        self.row_levels = np.full(self.shape, float(kind == BIJECTION))
        small = self.row_levels.size * sum(self.shape) < SERIAL_WORK
        write = compatibility.row_discrepancies if small else compatibility.many_row_discrepancies
        sorted_x, sorted_y = np.sort(DX, axis=1), np.sort(DY, axis=1)
        for part in blocks(len(DX), len(DY) * sum(self.shape), clock or Clock(math.inf)):
            write(kind, both, sorted_x[part], sorted_y, self.row_levels[part])

    @cached_property
    def rows_x(self) -> compatibility.SortedRows:
        """The rows of X with the sets of their first points, for searches."""
        return sorted_rows(self.DX)

    @cached_property
    def rows_y(self) -> compatibility.SortedRows:
        """The same of Y."""
        return sorted_rows(self.DY)

    @cached_property
    def levels(self) -> Levels:
        """The differences of distances of X and Y."""
        return Levels(self.DX, self.DY)

    @property
    def row_bound(self) -> float:
        """Least level at which every point has a partner whose sorted distances agree with its own."""
        bound = self.row_levels.min(axis=1).max()
        return float(max(bound, self.row_levels.min(axis=0).max()) if self.both else bound)

    def worst_of(self, pairs: Indices) -> float:
        """Least level that a relation fits."""
        return worst_of(self.kind, self.DX, self.DY, pairs)

    def covers(self, possible: Flags) -> bool:
        """Whether every point that must be covered has a possible pair."""
        return bool(possible.any(axis=1).all() and (not self.both or possible.any(axis=0).all()))

    def consistent(self, level: float, clock: Clock, start: Flags | None = None) -> Flags | None:
        """What arc consistency leaves of the pairs possible at a higher level; None if it refutes the level.

        When the time is over, or the tables would be too large, what is left by then.
        """
        possible = self.row_levels <= level
        if start is not None:
            possible &= start
        if not self.covers(possible):
            return None
        if not self.fits(possible) or clock.over:
            return possible
        state = State(self, possible, level, clock)
        return state.possible() if state.sweep(clock) else None

    def fits(self, possible: Flags) -> bool:
        """Whether the tables of the possible pairs, and the sets of sorted rows, fit into memory and index types."""
        sets = sum(n**3 // 8 for n in self.shape)
        return 4 * int(possible.sum()) * sum(self.shape) + sets <= TABLE_BYTES and max(self.shape) < 65536


class State:
    """Possible pairs as bitsets, with their runs at one level."""

    def __init__(self, engine: Engine, possible: Flags, level: float, clock: Clock) -> None:
        n, m = engine.shape
        self.engine, self.level = engine, level
        self.pairs = np.argwhere(possible)
        slot = np.full((n, m), -1, np.int32)
        slot[possible] = np.arange(len(self.pairs), dtype=np.int32)
        over_x = np.empty((len(self.pairs), n, 2), np.uint16)
        over_y = np.empty((len(self.pairs), m, 2), np.uint16)
        self.runs = compatibility.Runs(slot, over_x, over_y)
        rows, columns = np.zeros((n, -(-m // 64)), np.uint64), np.zeros((m, -(-n // 64)), np.uint64)
        self.relation = correspondences.Relation(rows, columns, np.zeros(n, np.int64), np.zeros(m, np.int64))
        correspondences.fill(possible, self.relation)
        self.queue = correspondences.Queue(
            np.ones(n, np.bool_), np.ones(m, np.bool_), np.empty(n, np.int64), np.empty(m, np.int64)
        )
        self.weights = np.ones(n + m)
        self._small = len(self.pairs) * (n + m) < SERIAL_WORK
        self.set_level(level, clock)

    def set_level(self, level: float, clock: Clock) -> None:
        """Write the runs for a level; deletions made at a higher one stay right.

        `ready` tells whether the time sufficed: without all runs nothing can be concluded.
        """
        e = self.engine
        self.level, written = level, 0
        write = compatibility.write_runs if self._small else compatibility.write_many_runs
        for part in blocks(len(self.pairs), sum(e.shape), clock):
            write(e.kind, e.rows_x, e.rows_y, level, self.pairs[part], self.runs.over_x[part], self.runs.over_y[part])
            written = part.stop
        self.ready = written == len(self.pairs)

    def possible(self) -> Flags:
        """The possible pairs as a matrix."""
        out = np.empty(self.engine.shape, np.bool_)
        correspondences.unpack(self.relation, out)
        return out

    def sweep(self, clock: Clock) -> bool:
        """Arc consistency of everything, or as far as the time reaches; whether it does not refute the level."""
        e, relation, queue = self.engine, self.relation, self.queue
        if not self.ready:
            return True
        if self._small:
            emptied, _ = correspondences.propagate(
                relation, queue, self.runs, e.rows_x, e.rows_y, e.both, self.weights, UNLIMITED
            )
            return emptied < 0
        doomed = np.empty_like(relation.rows)
        while not clock.over:
            n_rows = correspondences.listed(queue.rows, relation.row_counts, queue.row_list)
            n_columns = correspondences.listed(queue.columns, relation.column_counts, queue.column_list)
            n_columns = n_columns if e.both else 0
            if n_rows + n_columns == 0:
                break
            correspondences.sweep(relation, queue, n_rows, n_columns, self.runs, e.rows_x, e.rows_y, doomed)
            if not correspondences.delete_all(relation, queue, doomed, e.both):
                return False
        return True


class Search:
    """Branch and bound among the possible pairs, from a consistent state on."""

    def __init__(
        self,
        engine: Engine,
        possible: Flags,
        level: float,
        clock: Clock,
        isometries: tuple[Indices, Indices] | None = None,
    ) -> None:
        n, m = engine.shape
        self.state = State(engine, possible, level, clock)
        correspondences.clear(self.state.queue)
        self.engine, relation = engine, self.state.relation
        depth = n + m + 1
        rows, columns, row_counts, column_counts = (np.empty((depth, *a.shape), a.dtype) for a in relation)
        self._stack = correspondence_search.Stack(
            rows, columns, row_counts, column_counts, np.zeros((depth, 2), np.int64), np.zeros(depth, np.int64)
        )
        trivial = np.arange(n)[None], np.arange(m)[None]
        self._problem = correspondence_search.Problem(
            engine.rows_x, engine.rows_y, self.state.runs, engine.both, *(isometries or trivial)
        )
        self._progress = np.zeros(8, np.int64)
        self._progress[correspondence_search.DESCENDING] = 1
        self._progress[correspondence_search.LIMIT] = FIRST_LIMIT
        self._f, self._g = np.empty(n, np.int64), np.empty(m, np.int64)

    @property
    def nodes(self) -> int:
        """Decisions made so far."""
        return int(self._progress[correspondence_search.TOTAL])

    def run(self, clock: Clock) -> tuple[bool, Indices | None]:
        """Search on until the time is over; whether all is refuted at the level, and a relation that fits it."""
        s = self.state
        while s.ready and not clock.over:
            status = correspondence_search.search(
                self._problem, s.relation, s.queue, self._stack, self._progress, s.weights, self._f, self._g, SLICE
            )
            if status == correspondence_search.EXHAUSTED:
                return True, None
            if status == correspondence_search.FOUND:
                return False, self._pairs()
        return False, None

    @property
    def depth_of_proof(self) -> int:
        """How many isometries a chain of refutations may use one after the other.

        Each leads to a deeper decision, or at the root to an earlier refutation.
        """
        return sum(self.engine.shape) + int(self._progress[correspondence_search.REFUTED])

    def possible(self) -> Flags:
        """Pairs not refuted at the root: what a relation within the level may contain."""
        depth = int(self._progress[correspondence_search.DEPTH])
        root = correspondences.Relation(*(copies[0] for copies in self._stack[:4])) if depth else self.state.relation
        out = np.empty(self.engine.shape, np.bool_)
        correspondences.unpack(root, out)
        return out

    def lower_level(self, level: float, clock: Clock) -> None:
        """Go on at a lower level."""
        self.state.set_level(level, clock)
        self._progress[correspondence_search.VERSION] += 1

    def _pairs(self) -> Indices:
        forward = np.stack([np.arange(len(self._f)), self._f], axis=1)
        if not self.engine.both or self.engine.kind != RELATION:
            return forward
        backward = np.stack([self._g, np.arange(len(self._g))], axis=1)
        return np.unique(np.concatenate([forward, backward]), axis=0)
