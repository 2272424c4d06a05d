"""What dives and repairs of large spaces share: single precision copies, and maps measured in double."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import RELATION
from rinow.kernels import distortion
from rinow.kernels import dives as dive_kernels

__all__ = ["Maps", "Work", "farthest_points"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

BALLS = 4
"""Pairs in conflict around which a repair takes out others too."""

EXAMINED = 100_000_000
"""Distances that may be examined between two looks at the clock; most partners are given up after a few."""

MOST_ORPHANS = 700
"""Points a dive may leave over."""


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

    def measured(self, maps: Maps) -> tuple[Indices, float]:
        """The union of two graphs and its distortion."""
        pairs = np.unique(np.stack([maps.xs, maps.ys], axis=1), axis=0)
        values, places = np.empty(len(pairs)), np.empty(len(pairs), np.intp)
        xs, ys = np.ascontiguousarray(pairs[:, 0]), np.ascontiguousarray(pairs[:, 1])
        distortion.worst_partners(RELATION, self.DX, self.DY, xs, ys, values, places)
        return pairs, float(values.max())

    def conflicts(self, maps: Maps, level: float) -> Flags:
        """Which pairs of the two graphs disagree with some other one."""
        wrong = np.empty(len(maps.xs), np.bool_)
        dive_kernels.disagreements(self.X, self.Y, maps.xs, maps.ys, np.float32(level / self.scale), wrong)
        return wrong

    def dive(self, level: float, n_first: int, clock: Clock) -> Maps | None:
        """One dive at a level, completed to two maps; None if it left too many points over or the time is up."""
        partners = np.full(len(self._weights), dive_kernels.UNDECIDED)
        nothing = np.empty(0, np.int64)
        return self._finished(partners, farthest_points(self.DX, n_first), nothing, nothing, level, clock)

    def dive_again(self, maps: Maps, wrong: Flags, level: float, radius: float, clock: Clock) -> Maps | None:
        """A dive for the pairs in conflict and those near a few of them, while the rest stays."""
        free, xs, ys = wrong.copy(), maps.xs, maps.ys
        for p in self._rng.choice(np.flatnonzero(wrong), min(BALLS, int(wrong.sum())), replace=False):
            free |= (self.X[xs[p], xs] < radius) | (self.Y[ys[p], ys] < radius)
        partners = np.concatenate([maps.f, maps.g])
        partners[free] = dive_kernels.UNDECIDED
        kept = self._rng.permutation(np.flatnonzero(~free))
        nothing = np.empty(0, np.int64)
        return self._finished(partners, nothing, maps.xs[kept], maps.ys[kept], level, clock)

    def _finished(
        self, partners: Indices, first: Indices, xs: Indices, ys: Indices, level: float, clock: Clock
    ) -> Maps | None:
        state = self._state(partners, first)
        t, step = np.float32(level / self.scale), 1
        possible, places = self._apart <= level, np.flatnonzero(partners == dive_kernels.UNDECIDED)
        for part in self._parts(places, len(xs), clock):
            dive_kernels.list_partners(part, self.X, self.Y, possible, xs, ys, t, self._lists, self._counts)
        if clock.over:
            return None
        dive_kernels.begin(state)
        while dive_kernels.descend(state, t, step, MOST_ORPHANS):
            if clock.over:
                return None
            step = 8 if self._counts.sum() < 40 * len(partners) else 1
        if state.orphans[0] > MOST_ORPHANS:
            return None
        return self._completed(state, clock)

    def extended(self, xs: Indices, ys: Indices, clock: Clock) -> Maps | None:
        """Some pairs, completed to two maps: other points get the partner that agrees best with the pairs.

        None if the time is over before.
        """
        n, m = len(self.X), len(self.Y)
        partners = np.full(n + m, dive_kernels.LEFT_OVER)
        partners[xs], partners[n + ys] = ys, xs
        return self._completed(self._state(partners, np.empty(0, np.int64)), clock)

    def _state(self, partners: Indices, first: Indices) -> dive_kernels.Dive:
        return dive_kernels.Dive(
            self.X, self.Y, self._lists, self._counts, partners, first, self._weights, self._random,
            np.zeros(1, np.int64),
        )  # fmt: skip

    def _completed(self, state: dive_kernels.Dive, clock: Clock) -> Maps | None:
        n, most = len(self.X), len(state.partners)
        xs, ys = np.empty(most, np.int64), np.empty(most, np.int64)
        n_pairs = dive_kernels.pairs_made(state, xs, ys)
        partners = state.partners.astype(np.int64)
        for part in self._parts(np.flatnonzero(partners < 0), n_pairs, clock):
            found = np.empty(len(part), np.int64)
            dive_kernels.complete(part, self.X, self.Y, xs[:n_pairs], ys[:n_pairs], found)
            partners[part] = found
        return Maps(partners[:n], partners[n:]) if (partners >= 0).all() else None

    def _parts(self, places: Indices, n_pairs: int, clock: Clock) -> Iterator[Indices]:
        """Parts of the places, to be held against so many pairs, until the time is over."""
        step = max(2, EXAMINED // (self._lists.shape[1] * n_pairs + 1))
        for start in range(0, len(places), step):
            if clock.over:
                return
            yield places[start : start + step]


def farthest_points(D: Floats, k: int) -> Indices:
    """A farthest-point sequence from a point of the greatest eccentricity."""
    chosen = [int(D.max(axis=1).argmax())]
    nearest = D[chosen[0]].copy()
    while len(chosen) < min(k, len(D)):
        chosen.append(int(nearest.argmax()))
        np.minimum(nearest, D[chosen[-1]], out=nearest)
    return np.array(chosen, np.int64)
