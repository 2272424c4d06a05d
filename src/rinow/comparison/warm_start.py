"""Upper bounds: relations of small distortion found by tabu search from several starts."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import RELATION, worst_of
from rinow.kernels import correspondence_tabu as tabu_search

__all__ = ["TabuSearch", "graphs"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

GAP, LEAST_GAP, RESET_GAP = 0.03, 0.001, 0.02
"""The target lies this share below the best distortion; it shrinks when it is missed, and starts anew."""

STALL = 600
"""Moves without progress before the search returns to its best maps and perturbs them."""


def graphs(f: Indices, g: Indices) -> Indices:
    """The union of the graphs of f: X → Y and g: Y → X as pairs (x, y)."""
    forward = np.stack([np.arange(len(f)), f], axis=1)
    backward = np.stack([g, np.arange(len(g))], axis=1)
    return np.unique(np.concatenate([forward, backward]), axis=0)


class TabuSearch:
    """One tabu search from given maps; `best` is the least distortion measured so far, `pairs` its relation."""

    def __init__(self, DX: Floats, DY: Floats, f: Indices, g: Indices, seed: int) -> None:
        n, m = len(DX), len(DY)
        self.DX, self.DY = DX, DY
        self.scale = float(max(DX.max(), DY.max())) or 1.0
        self._tabu = tabu_search.Tabu(
            (DX / self.scale).astype(np.float32),
            (DY / self.scale).astype(np.float32),
            np.empty((n, m), np.float32),
            f.astype(np.int64),
            g.astype(np.int64),
            np.zeros((n, m), np.int64),
            np.zeros((m, n), np.int64),
            np.array([0x9E3779B97F4A7C15 ^ (seed + 1)], np.uint64),
            np.zeros(2, np.int64),
            np.zeros(2),
        )
        self.pairs = graphs(f, g)
        self.best = worst_of(RELATION, DX, DY, self.pairs)
        self._gap, self._least = GAP, (f.copy(), g.copy())
        self._aim()

    @property
    def moves(self) -> int:
        """Moves made so far."""
        return int(self._tabu.counters[tabu_search.MOVE])

    def run(self, n_moves: int, clock: Clock, target: float = 0.0) -> None:
        """Make so many moves, unless the time is over or the target is met before."""
        end = self.moves + n_moves
        block = max(32, 40_000_000 // (self._tabu.table.size + 1000))
        while self.moves < end and self.best > target and not clock.over:
            t = np.float32(self._target / self.scale)
            met = tabu_search.descend(self._tabu, t, min(block, STALL, end - self.moves), *self._least)
            if met:
                self._measure()
            elif self._tabu.counters[tabu_search.TOTAL_STALL] >= STALL:
                self._perturb()

    def _aim(self) -> None:
        """Set a new target below the best distortion."""
        self._target = self.best * (1.0 - self._gap)
        self._reset()

    def _reset(self) -> None:
        """Rebuild the table at the target and forget the totals."""
        tabu_search.rebuild(self._tabu, np.float32(self._target / self.scale))
        self._tabu.totals[1] = math.inf
        self._tabu.counters[tabu_search.TOTAL_STALL] = 0

    def _measure(self) -> None:
        pairs = graphs(self._tabu.f, self._tabu.g)
        value = worst_of(RELATION, self.DX, self.DY, pairs)
        if value < self.best:
            self.best, self.pairs = value, pairs
            self._gap = GAP
        else:
            self._gap *= 0.7
        self._aim()

    def _perturb(self) -> None:
        """Return to the maps nearest to the target, change up to 5 % of the images, and aim less high."""
        self._tabu.f[:], self._tabu.g[:] = self._least
        n_changes = 1 + int(tabu_search.random_below(self._tabu.random, max(1, sum(self._tabu.table.shape) // 20)))
        tabu_search.perturb(self._tabu, n_changes)
        self._gap = self._gap * 0.7 if self._gap > LEAST_GAP else RESET_GAP
        self._aim()
