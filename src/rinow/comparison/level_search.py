"""Exact search at one level between spaces with few distances: graphs with their numbers of steps, for instance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import Engine
from rinow.comparison.symmetry import Isometries
from rinow.kernels import correspondences, level_search
from rinow.kernels.correspondence_search import EXHAUSTED, FOUND

__all__ = ["LevelSearch"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

FIRST_LIMIT = 500
"""Nodes of a search before its first restart; each run is half as long again."""

SLICE = 30_000_000
"""Words of sets compared between two looks at the clock: some tenths of a second at most."""


class LevelSearch:
    """Search for a relation within a level; `consistent` is false if arc consistency alone refutes it."""

    def __init__(self, engine: Engine, level: float, isometries: tuple[Isometries, Isometries]) -> None:
        n, m = engine.shape
        X, Y = _sides(engine.DX, engine.DY, level)
        self._problem = level_search.Problem(X, Y, isometries[0].images, isometries[1].images)
        self._error = isometries[0].error + isometries[1].error
        depth = n + m + 1
        self._stack = level_search.Stack(
            np.zeros((depth, n, -(-m // 64)), np.uint64),
            np.zeros((depth, m, -(-n // 64)), np.uint64),
            np.zeros((depth, n), np.int64),
            np.zeros((depth, m), np.int64),
            np.zeros((depth, 2), np.int64),
            np.zeros(n, np.bool_),
            np.zeros(m, np.bool_),
            np.empty(Y.near.shape[1], np.uint64),
            np.empty(X.near.shape[1], np.uint64),
        )
        root = correspondences.Relation(*(copies[0] for copies in self._stack[:4]))
        possible = engine.row_levels <= level
        correspondences.fill(possible, root)
        self._weights = np.ones(n + m)
        self._progress = np.array([0, 0, FIRST_LIMIT, 0])
        self.consistent = engine.covers(possible) and level_search.begin(self._problem, self._stack, self._weights)

    def run(self, clock: Clock) -> tuple[bool, Indices | None]:
        """Search until the time is over; whether the level is refuted, and a relation that fits it."""
        while not clock.over:
            status = level_search.search(self._problem, self._stack, self._progress, self._weights, SLICE)
            if status == EXHAUSTED:
                return True, None
            if status == FOUND:
                decisions = self._stack.decisions[: self._progress[level_search.DEPTH]]
                return False, np.unique(decisions, axis=0).astype(np.intp)
        return False, None

    def possible(self) -> Flags:
        """The pairs that are not refuted at the root."""
        out = np.empty((self._stack.rows.shape[1], self._stack.columns.shape[1]), np.bool_)
        correspondences.unpack(correspondences.Relation(*(copies[0] for copies in self._stack[:4])), out)
        return out

    @property
    def error(self) -> float:
        """Rounding of the isometries that a proof used: each leads to a deeper decision, or at the root on."""
        n_points = sum(table.shape[1] for table in self._problem[2:])
        return self._error * (n_points + int(self._progress[level_search.REFUTED]))


def _sides(DX: Floats, DY: Floats, level: float) -> tuple[level_search.Side, level_search.Side]:
    """Both spaces with the sets of points at a distance that agrees with a distance of the other one."""
    values, codes = zip(*(np.unique(D, return_inverse=True) for D in (DX, DY)), strict=True)
    sides: list[level_search.Side] = []
    for D, own, others in ((DX, codes[0], values[1]), (DY, codes[1], values[0])):
        near = np.empty((len(D), len(others), -(-len(D) // 64)), np.uint64)
        level_search.agreeing(D, others, level, near)
        sides.append(level_search.Side(own.reshape(D.shape), near.reshape(len(D), -1)))
    return sides[0], sides[1]
