"""Lower bounds of the distortion of large spaces: few points of one, and all possible partners in the other.

A correspondence of distortion t gives some points of X partners in Y; their eccentricities and distances differ from
those of the points by at most t.  The points of both spaces farthest from these have partners too.  Where a search
through all partners finds none, the distortion is more than t.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.interval import Interval
from rinow.kernels import subset_maps

__all__ = ["FewPoints", "raise_by_few_points"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

POINTS = 12
"""Points whose partners are searched for at first."""

STEP, LEAST_STEP = 0.004, 0.002
"""Shares of the open interval by which the next level is higher, at first and at least: doubled by success, halved by
failure."""

DECISIONS, MORE = 2000, 4
"""Decisions after which a branch is given up at first; how many times as many when all steps have failed."""

EXAMINED = 160_000_000
"""Decisions times points between two looks at the clock: some tenths of a second."""


class FewPoints:
    """Two spaces, their eccentricities, and how often each point had no partner left."""

    def __init__(self, DX: Floats, DY: Floats) -> None:
        self.spaces = DX, DY
        self.eccentricities = DX.max(axis=1), DY.max(axis=1)
        self._farthest = DX.argmax(axis=1), DY.argmax(axis=1)
        self._failures = np.ones(len(DX) + len(DY))

    def outcome(self, level: float, most: int, clock: Clock) -> int:
        """What becomes of a level within so many decisions for each partner of the first point."""
        counts = self._partner_counts(level)
        way = int(counts[1].min() < counts[0].min())
        if counts[way].min() == 0:
            return subset_maps.REFUTED
        chosen = _informative_points(self.spaces[way], counts[way] / len(self.spaces[1 - way]))
        own, other = self.eccentricities[way], self.eccentricities[1 - way]
        partners = np.zeros((len(chosen), max(map(len, self.spaces))), np.int32)
        for row, a in zip(partners, chosen, strict=True):
            row[: counts[way][a]] = np.flatnonzero(np.abs(own[a] - other) <= level)
        places, listed = chosen + way * len(self.spaces[0]), counts[way][chosen]
        first, limit = int(listed.argmin()), EXAMINED // partners.shape[1]
        values, step = partners[first, : listed[first]].astype(np.intp), max(1, limit // most)
        for start in range(0, len(values), step):
            if clock.over:
                return subset_maps.GIVEN_UP
            part = values[start : start + step]
            outcomes = np.empty(len(part), np.intp)
            failures = np.repeat(self._failures[None], len(part), axis=0)
            subset_maps.branches(
                *self.spaces, *self.eccentricities, *self._farthest, places, partners, listed, failures, first, part,
                level, min(most, limit), outcomes,
            )  # fmt: skip
            self._failures += (failures - self._failures).sum(axis=0)
            if outcomes.any():
                return int(outcomes.max())
        return subset_maps.REFUTED

    def _partner_counts(self, level: float) -> tuple[Indices, Indices]:
        """For each point of both spaces the number of points of the other one whose eccentricity agrees."""
        ex, ey = self.eccentricities
        return _counts_within(ex, ey, level), _counts_within(ey, ex, level)


def raise_by_few_points(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """Refute rising levels: smaller steps after a failure, and more decisions when the smallest one fails."""
    search, step, most = FewPoints(DX, DY), STEP, DECISIONS
    while not (clock.over or interval.closed):
        level = interval.lower + step * (interval.upper - interval.lower)
        outcome = search.outcome(level, most, clock)
        if outcome == subset_maps.REFUTED:
            interval.raise_lower(level, "maps of subsets")
            step = min(2.0 * step, 0.5)
        elif step > LEAST_STEP:
            step *= 0.5
        elif outcome == subset_maps.FITS:
            return
        else:
            step, most = step * MORE, most * MORE


def _counts_within(a: Floats, b: Floats, level: float) -> Indices:
    return np.array([np.count_nonzero(np.abs(value - b) <= level) for value in a])


def _informative_points(D: Floats, shares: Floats) -> Indices:
    """Points that are far from each other and agree with a small share of the other space."""
    information = 0.05 - np.log(shares)
    nearest, chosen = np.full(len(D), D.max()), []
    while len(chosen) < min(POINTS, len(D)):
        chosen.append(int((nearest * information).argmax()))
        np.minimum(nearest, D[chosen[-1]], out=nearest)
    return np.array(chosen, np.intp)
