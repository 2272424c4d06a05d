"""What dives and repairs of large spaces share: single precision copies, and relations measured in double."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import RELATION
from rinow.kernels import distortion, polish
from rinow.kernels import dives as dive_kernels
from rinow.kernels.dives import ABSENT, LEFT_OVER, UNDECIDED

__all__ = ["Work", "farthest_points"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

TRIES = 8
"""Dives that begin a relation at the same time; the best one goes on."""

NET = 300
"""Farthest points of each space for which these dives look for partners."""

MOST_ORPHANS = 0.05
"""Share of the points that such a dive may leave over."""

FIRST = 1e6
"""Weight of the place that gets its partner first."""

NEAR, MOVES = 24, 3000
"""Points near a partner that a polish tries in its place, and its moves."""

BALLS = 4
"""Pairs in conflict around which a repair takes out others too."""

EXAMINED = 100_000_000
"""Distances that may be examined between two looks at the clock; most partners are given up after a few."""


class Work:
    """Two spaces, their weights and random numbers.

    A relation is an array of n + m partners: of the points of X among those of Y, then of those of Y among X.  Points
    that take no part have the mark ABSENT.
    """

    def __init__(self, DX: Floats, DY: Floats) -> None:
        self.DX, self.DY = DX, DY
        self.scale = float(max(DX.max(), DY.max())) or 1.0
        self.X, self.Y = (DX / self.scale).astype(np.float32), (DY / self.scale).astype(np.float32)
        self._eccentricities = self.X.max(axis=1), self.Y.max(axis=1)
        n, m = len(DX), len(DY)
        self._order = farthest_points(DX, n), n + farthest_points(DY, m)
        self._near_x, self._near_y = (np.argsort(D, axis=1)[:, :NEAR].astype(np.int32) for D in (self.X, self.Y))
        self._lists, k = np.empty((n + m, max(n, m)), np.int32), len(self.net(NET))
        self._counts = np.empty(0, np.int64)
        self._room = (
            np.empty((TRIES, k, max(n, m)), np.int32), np.empty((TRIES, k), np.int64), np.empty((TRIES, k), np.int64)
        )  # fmt: skip
        self._weights = np.ones(n + m)
        self._random = np.array([0x2545F4914F6CDD1D], np.uint64)
        self._rng = np.random.default_rng(21)

    def net(self, size: int) -> Indices:
        """The first farthest points of both spaces."""
        return np.concatenate([order[:size] for order in self._order])

    def pairs(self, partners: Indices) -> tuple[Indices, Indices, Indices]:
        """The places that have a partner, and the pairs of these as points of X and of Y."""
        n, places = len(self.X), np.flatnonzero(partners >= 0)
        own, other = places, partners[places]
        return places, np.where(own < n, own, other), np.where(own < n, other, own - n)

    def measured(self, partners: Indices) -> tuple[Indices, float]:
        """The pairs and their distortion."""
        _, xs, ys = self.pairs(partners)
        pairs = np.unique(np.stack([xs, ys], axis=1), axis=0)
        values, worst = np.empty(len(pairs)), np.empty(len(pairs), np.intp)
        xs, ys = np.ascontiguousarray(pairs[:, 0]), np.ascontiguousarray(pairs[:, 1])
        distortion.worst_partners(RELATION, self.DX, self.DY, xs, ys, values, worst)
        return pairs, float(values.max())

    def conflicts(self, partners: Indices, level: float) -> Indices:
        """The places whose pairs disagree with some other pair."""
        places, xs, ys = self.pairs(partners)
        wrong = np.empty(len(places), np.bool_)
        dive_kernels.disagreements(self.X, self.Y, xs, ys, np.float32(level / self.scale), wrong)
        return places[wrong]

    def begun(self, level: float, clock: Clock) -> tuple[Indices, bool] | None:
        """The best of some dives for a net, and whether it left few points over; None if the time is over before."""
        places, n_points = self.net(NET), len(self._weights)
        if not self._list(places, np.full(n_points, ABSENT), level, clock):
            return None
        k, t, most = len(places), np.float32(level / self.scale), int(MOST_ORPHANS * len(places))
        lists, counts, undecided = self._room
        lists[:], counts[:] = self._lists[:k], self._counts
        partners = np.full((TRIES, n_points), ABSENT)
        partners[:, places] = UNDECIDED
        weights, numbers = self._rng.uniform(1.0, 2.0, (TRIES, n_points)), np.zeros((TRIES, 2), np.int64)
        weights[np.arange(TRIES), self._rng.choice(places, TRIES)] = FIRST
        random = self._rng.integers(1, 1 << 63, size=(TRIES, 1)).astype(np.uint64)
        for dive in zip(lists, counts, undecided, partners, weights, random, numbers, strict=True):
            dive_kernels.begin(dive_kernels.Dive(self.X, self.Y, places, *dive))
        on = np.ones(TRIES, np.bool_)
        while on.any():
            if clock.over:
                return None
            step = max(1, EXAMINED // (dive_kernels.TRIALS * int(counts[on].sum()) + 1))
            dive_kernels.many_descents(
                self.X, self.Y, places, t, step, most, lists, counts, undecided, partners, weights, random, numbers, on
            )
        orphans, still_open = numbers.T
        best = np.lexsort((orphans, still_open))[0]
        partners = partners[best]
        partners[partners == UNDECIDED] = LEFT_OVER
        begun = self.completed(partners, clock)
        return None if begun is None else (begun, bool(orphans[best] <= most))

    def extended(self, partners: Indices, size: int, level: float, clock: Clock) -> Indices | None:
        """The relation with partners for a larger net; None if the time is over before."""
        places, partners = self.net(size), partners.copy()
        partners[places[partners[places] < 0]] = UNDECIDED
        return self._finished(partners, level, clock)

    def repaired(self, partners: Indices, wrong: Indices, level: float, radius: float, clock: Clock) -> Indices | None:
        """A dive for the places in conflict and those near a few of them, while the rest stays."""
        again, (places, xs, ys) = partners.copy(), self.pairs(partners)
        again[wrong] = UNDECIDED
        for v in self._rng.choice(wrong, min(BALLS, len(wrong)), replace=False):
            p = np.searchsorted(places, v)
            again[places[(self.X[xs[p], xs] < radius) | (self.Y[ys[p], ys] < radius)]] = UNDECIDED
        return self._finished(again, level, clock)

    def polished(self, partners: Indices, level: float) -> Indices:
        """The relation with partners moved to points near them where pairs disagree."""
        places, xs, ys = self.pairs(partners)
        t, n_free_y = np.float32(level / self.scale), int(np.searchsorted(places, len(self.X)))
        state = polish.Polish(
            self.X, self.Y, self._near_x, self._near_y, xs, ys, np.array([n_free_y]), np.empty(len(xs), np.float32),
            np.zeros(len(xs), np.int64), self._random,
        )  # fmt: skip
        best_xs, best_ys = xs.copy(), ys.copy()
        total = polish.renew(state, t)
        if total > 0.0:
            polish.search(state, t, MOVES, total, best_xs, best_ys)
        moved = partners.copy()
        moved[places] = np.concatenate([best_ys[:n_free_y], best_xs[n_free_y:]])
        return moved

    def _list(self, places: Indices, partners: Indices, level: float, clock: Clock) -> bool:
        """List the possible partners of some places; whether the time sufficed."""
        _, xs, ys = self.pairs(partners)
        order = self._rng.permutation(len(xs))
        xs, ys, t = xs[order], ys[order], np.float32(level / self.scale)
        self._counts = np.empty(len(places), np.int64)
        for part in self._parts(len(places), len(xs), clock):
            dive_kernels.list_partners(
                places[part], self.X, self.Y, *self._eccentricities, xs, ys, t, self._lists[part], self._counts[part]
            )
        return not clock.over

    def _finished(self, partners: Indices, level: float, clock: Clock) -> Indices | None:
        """The relation after a dive for all undecided places."""
        places = np.flatnonzero(partners == UNDECIDED)
        if not self._list(places, partners, level, clock):
            return None
        k, t, step = len(places), np.float32(level / self.scale), 1
        dive = dive_kernels.Dive(
            self.X, self.Y, places, self._lists[:k], self._counts, np.empty(k, np.int64), partners, self._weights,
            self._random, np.zeros(2, np.int64),
        )  # fmt: skip
        dive_kernels.begin(dive)
        while dive_kernels.descend(dive, t, step, len(partners)):
            if clock.over:
                return None
            step = 8 if self._counts.sum() < 40 * len(partners) else 1
        return self.completed(partners, clock)

    def completed(self, partners: Indices, clock: Clock) -> Indices | None:
        """The relation with a partner for each point that was left over: the one that agrees best with the pairs.

        None if the time is over before.
        """
        places, (_, xs, ys) = np.flatnonzero(partners == LEFT_OVER), self.pairs(partners)
        found, partners = np.empty(len(places), np.int64), partners.copy()
        for part in self._parts(len(places), len(xs), clock):
            dive_kernels.complete(places[part], self.X, self.Y, xs, ys, found[part])
        partners[places] = found
        return None if clock.over else partners

    def _parts(self, n_places: int, n_pairs: int, clock: Clock) -> Iterator[slice]:
        """Parts of so many places, to be held against so many pairs, until the time is over."""
        step = max(2, EXAMINED // (self._lists.shape[1] * n_pairs + 1))
        for start in range(0, n_places, step):
            if clock.over:
                return
            yield slice(start, start + step)


def farthest_points(D: Floats, k: int) -> Indices:
    """A farthest-point sequence from a point of the greatest eccentricity."""
    chosen = [int(D.max(axis=1).argmax())]
    nearest = D[chosen[0]].copy()
    while len(chosen) < min(k, len(D)):
        chosen.append(int(nearest.argmax()))
        np.minimum(nearest, D[chosen[-1]], out=nearest)
    return np.array(chosen, np.int64)
