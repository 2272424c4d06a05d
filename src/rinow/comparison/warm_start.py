"""Upper bounds: relations and bijections found by tabu search."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import BIJECTION, RELATION, worst_of
from rinow.comparison.levels import Levels
from rinow.kernels import bijection_tabu, correspondence_tabu

__all__ = ["BijectionTabu", "RelationTabu", "TabuSearch", "graphs"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

GAP, LARGEST_GAP, LEAST_GAP, RESET_GAP = 0.03, 0.25, 0.001, 0.02
"""The target lies this share below the best value.

The share grows when the target is met, shrinks when it is missed, and starts anew.
"""

STALL, STALL_OF_FEW = 600, 3000
"""Moves without progress before the search returns to its best maps and perturbs them; where levels are few, so that
every step down is a large one."""

COINCIDENT = -1e3
"""Logarithm of distance 0: two such distances agree, and one of them with nothing else."""


def graphs(f: Indices, g: Indices) -> Indices:
    """The union of the graphs of f: X → Y and g: Y → X as pairs (x, y)."""
    forward = np.stack([np.arange(len(f)), f], axis=1)
    backward = np.stack([g, np.arange(len(g))], axis=1)
    return np.unique(np.concatenate([forward, backward]), axis=0)


class TabuSearch(ABC):
    """A tabu search from given maps; `best` is the least value measured so far, `pairs` its relation."""

    kind: int
    _stall = STALL

    def __init__(self, DX: Floats, DY: Floats, X: Floats, Y: Floats, f: Indices, g: Indices, seed: int) -> None:
        self._DX, self._DY = DX, DY
        n, m = len(X), len(Y)
        self._tabu = correspondence_tabu.Tabu(
            X.astype(np.float32),
            Y.astype(np.float32),
            np.empty((n, m), np.float32),
            f.astype(np.int64),
            g.astype(np.int64),
            np.zeros((n, m), np.int64),
            np.zeros((m, n), np.int64),
            np.array([0x9E3779B97F4A7C15 ^ (seed + 1)], np.uint64),
            np.zeros(2, np.int64),
            np.zeros(2),
        )
        self.pairs = self._current_pairs()
        self.best = worst_of(self.kind, DX, DY, self.pairs)
        self._gap, self._least = GAP, (f.astype(np.int64), g.astype(np.int64))
        self._aim()

    @property
    def moves(self) -> int:
        """Moves made so far."""
        return int(self._tabu.counters[correspondence_tabu.MOVE])

    def run(self, n_moves: int, clock: Clock, target: float = 0.0) -> None:
        """Make so many moves, unless the time is over or the target is met before.

        Less where single precision cannot tell the best relation from a better one.
        """
        end = self.moves + n_moves
        block = min(self._stall, max(32, 40_000_000 // (self._tabu.table.size + 1000)))
        while self.moves < end and self.best > target and not clock.over:
            before, gap = self.moves, self._gap
            if self._descend(min(block, end - self.moves)):
                if not self._measure() and self.moves == before:  # the table shows no conflict, but there is one
                    if gap >= GAP:
                        return
                    self._gap = GAP
                    self._aim()
            elif self._tabu.counters[correspondence_tabu.TOTAL_STALL] >= self._stall:
                self._perturb()

    def _level_below(self, level: float) -> float:
        """The level itself, or the last below it that counts."""
        return level

    @abstractmethod
    def _threshold(self) -> np.float32:
        """The target in the unit of the table."""

    @abstractmethod
    def _descend(self, n_moves: int) -> bool:
        """Make moves; whether the target is met."""

    @abstractmethod
    def _rebuild(self) -> None:
        """Compute the table for the target."""

    @abstractmethod
    def _shake(self, n_changes: int) -> None:
        """Change some images at random."""

    @abstractmethod
    def _current_pairs(self) -> Indices:
        """The relation of the present maps."""

    def _aim(self) -> None:
        """Set a new target below the best value and forget the totals."""
        self._target = self._level_below(self.best * (1.0 - self._gap))
        self._rebuild()
        self._tabu.totals[1] = math.inf
        self._tabu.counters[correspondence_tabu.TOTAL_STALL] = 0

    def _measure(self) -> bool:
        """Measure the present relation, and set a new target; whether it is the best one."""
        pairs = self._current_pairs()
        value = worst_of(self.kind, self._DX, self._DY, pairs)
        better = value < self.best
        if better:
            self.best, self.pairs = value, pairs
            self._gap = min(LARGEST_GAP, max(GAP, 2.0 * self._gap))
        else:
            self._gap *= 0.7
        self._aim()
        return better

    def _perturb(self) -> None:
        """Return to the maps nearest to the target, change up to 5 % of the images, and aim less high."""
        self._tabu.f[:], self._tabu.g[:] = self._least
        most = max(1, sum(self._tabu.table.shape) // 20)
        self._shake(1 + int(correspondence_tabu.random_below(self._tabu.random, most)))
        self._gap = self._gap * 0.7 if self._gap > LEAST_GAP else RESET_GAP
        self._aim()


class RelationTabu(TabuSearch):
    """Two maps f: X → Y and g: Y → X; the value is the distortion of the union of their graphs."""

    kind = RELATION

    def __init__(self, DX: Floats, DY: Floats, f: Indices, g: Indices, seed: int) -> None:
        self._scale = float(max(DX.max(), DY.max())) or 1.0
        self._levels = Levels(DX, DY)
        self._stall = STALL_OF_FEW if self._levels.few else STALL
        super().__init__(DX, DY, DX / self._scale, DY / self._scale, f, g, seed)

    def _level_below(self, level: float) -> float:
        return max(self._levels.up_to(level), 0.0) if self._levels.few else level

    def _threshold(self) -> np.float32:
        return np.float32(self._target / self._scale)

    def _descend(self, n_moves: int) -> bool:
        return correspondence_tabu.descend(self._tabu, self._threshold(), n_moves, *self._least)

    def _rebuild(self) -> None:
        correspondence_tabu.rebuild(self._tabu, self._threshold())

    def _shake(self, n_changes: int) -> None:
        correspondence_tabu.perturb(self._tabu, n_changes)

    def _current_pairs(self) -> Indices:
        return graphs(self._tabu.f, self._tabu.g)


class BijectionTabu(TabuSearch):
    """A bijection f; the value is the larger dilatation of f and its inverse."""

    kind = BIJECTION

    def __init__(self, DX: Floats, DY: Floats, f: Indices, seed: int) -> None:
        super().__init__(DX, DY, _logarithms(DX), _logarithms(DY), f, np.argsort(f), seed)

    def _threshold(self) -> np.float32:
        return np.float32(math.log(max(self._target, 1.0)) if math.isfinite(self._target) else -COINCIDENT / 2)

    def _descend(self, n_moves: int) -> bool:
        return bijection_tabu.descend(self._tabu, self._threshold(), n_moves, self._least[0])

    def _rebuild(self) -> None:
        bijection_tabu.rebuild(self._tabu, self._threshold())

    def _shake(self, n_changes: int) -> None:
        bijection_tabu.perturb(self._tabu, n_changes)

    def _current_pairs(self) -> Indices:
        return np.stack([np.arange(len(self._tabu.f)), self._tabu.f], axis=1)


def _logarithms(D: Floats) -> Floats:
    """Logarithms of the distances, 0 on the diagonal."""
    out = np.log(D, out=np.full_like(D, COINCIDENT), where=D > 0)
    np.fill_diagonal(out, 0.0)
    return out
