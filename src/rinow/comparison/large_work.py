"""What dives, repair and polish of large spaces share: single precision copies, and maps measured in double."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import RELATION
from rinow.kernels import distortion, polish
from rinow.kernels import dives as dive_kernels

__all__ = ["Maps", "Work", "farthest_points"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

MOST_ORPHANS = 700
"""Points a dive may leave over."""

NEIGHBOURS = 24
"""Nearest points to which polish may move an image."""

POLISH_MOVES, POLISH_CALLS = 200, 20
"""Moves of polish between two looks at the clock, and calls for one target."""


class Maps(NamedTuple):
    """Maps f: X → Y and g: Y → X."""

    f: Indices
    g: Indices

    @property
    def xs(self) -> Indices:
        """Points of X of the pairs of both graphs, f before g."""
        return np.concatenate([np.arange(len(self.f)), self.g])

    @property
    def ys(self) -> Indices:
        """Points of Y of the pairs of both graphs, f before g."""
        return np.concatenate([self.f, np.arange(len(self.g))])


class Work:
    """Two spaces, their weights and random numbers."""

    def __init__(self, DX: Floats, DY: Floats) -> None:
        self.DX, self.DY = DX, DY
        self.scale = float(max(DX.max(), DY.max())) or 1.0
        self.X, self.Y = (DX / self.scale).astype(np.float32), (DY / self.scale).astype(np.float32)
        self._apart = np.abs(DX.max(axis=1)[:, None] - DY.max(axis=1))
        n, m = len(DX), len(DY)
        self._lists, self._counts = np.empty((n + m, max(n, m)), np.int32), np.empty(n + m, np.int64)
        self._weights = np.ones(n + m)
        self._random = np.array([0x2545F4914F6CDD1D], np.uint64)
        self._rng = np.random.default_rng(21)
        self._near: tuple[Indices, Indices] | None = None

    def measured(self, maps: Maps) -> tuple[Indices, float]:
        """The union of two graphs and its distortion."""
        pairs = np.unique(np.stack([maps.xs, maps.ys], axis=1), axis=0)
        values, places = np.empty(len(pairs)), np.empty(len(pairs), np.intp)
        xs, ys = np.ascontiguousarray(pairs[:, 0]), np.ascontiguousarray(pairs[:, 1])
        distortion.worst_partners(RELATION, self.DX, self.DY, xs, ys, values, places)
        return pairs, float(values.max())

    def conflicts(self, maps: Maps, level: float) -> Flags:
        """Which pairs of the two graphs disagree with some other one."""
        costs = np.empty(len(maps.xs))
        state = self._polish_state(maps)
        polish.write_costs(state, np.float32(level / self.scale), costs)
        return costs > 0

    def dive(self, level: float, n_first: int, clock: Clock) -> Maps | None:
        """One dive at a level, completed to two maps; None if it left too many points over or the time is up."""
        partners = np.full(len(self._weights), dive_kernels.UNDECIDED)
        nothing = np.empty(0, np.int64)
        return self._finished(partners, farthest_points(self.DX, n_first), nothing, nothing, level, clock)

    def dive_again(self, maps: Maps, wrong: Flags, level: float, radius: float, clock: Clock) -> Maps | None:
        """A dive for the pairs in conflict and those near a few of them, while the rest stays."""
        free, xs, ys = wrong.copy(), maps.xs, maps.ys
        for p in self._rng.choice(np.flatnonzero(wrong), min(4, int(wrong.sum())), replace=False):
            free |= (self.X[xs[p], xs] < radius) | (self.Y[ys[p], ys] < radius)
        partners = np.concatenate([maps.f, maps.g])
        partners[free] = dive_kernels.UNDECIDED
        kept = self._rng.permutation(np.flatnonzero(~free))
        nothing = np.empty(0, np.int64)
        return self._finished(partners, nothing, maps.xs[kept], maps.ys[kept], level, clock)

    def _finished(
        self, partners: Indices, first: Indices, xs: Indices, ys: Indices, level: float, clock: Clock
    ) -> Maps | None:
        state = dive_kernels.Dive(
            self.X, self.Y, self._lists, self._counts, partners, first, self._weights, self._random,
            np.zeros(1, np.int64),
        )  # fmt: skip
        t, step = np.float32(level / self.scale), 1
        dive_kernels.begin(state, self._apart <= level, xs, ys, t)
        while dive_kernels.descend(state, t, step, MOST_ORPHANS):
            if clock.over:
                return None
            step = 8 if self._counts.sum() < 40 * len(partners) else 1
        if state.orphans[0] > MOST_ORPHANS:
            return None
        maps = Maps(np.empty(len(self.X), np.int64), np.empty(len(self.Y), np.int64))
        dive_kernels.complete(state, maps.f, maps.g)
        return maps

    def polished(self, maps: Maps, target: float, clock: Clock) -> Maps:
        """The maps after local moves towards a target."""
        state, t = self._polish_state(maps), np.float32(target / self.scale)
        polish.write_costs(state, t, state.costs)
        for _ in range(POLISH_CALLS):
            if polish.improve(state, t, POLISH_MOVES) or clock.over:
                break
        n = len(maps.f)
        return Maps(state.ys[:n].copy(), state.xs[n:].copy())

    def _polish_state(self, maps: Maps) -> polish.Polish:
        if self._near is None:
            self._near = _nearest(self.DX), _nearest(self.DY)
        k = len(maps.xs)
        return polish.Polish(
            self.X, self.Y, maps.xs, maps.ys, *self._near, np.empty(k), np.zeros(k, np.int64), self._random,
            np.zeros(1, np.int64),
        )  # fmt: skip


def farthest_points(D: Floats, k: int) -> Indices:
    """A farthest-point sequence from a point of the greatest eccentricity."""
    chosen = [int(D.max(axis=1).argmax())]
    nearest = D[chosen[0]].copy()
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
