"""Lower bounds of the distance of two meshes from the eccentricities of all vertices, most of which are only bounded.

A vertex of the one mesh with a known eccentricity e has a partner in the other one, whose eccentricity differs by the
distortion at most.  So rows are found where the bounds of an eccentricity come nearest to e.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow import tolerances
from rinow.comparison.clock import Clock
from rinow.comparison.edge_metric import EdgeMetric
from rinow.comparison.surfaces import Sample
from rinow.comparison.whole_meshes import FALL, GROUPS, Chooser
from rinow.kernels import distortion_bounds
from rinow.kernels.edge_rows import LANES

__all__ = ["Eccentricities", "gap_of_eccentricities"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FINER = 0.25
"""Levels that the bounds shall not exceed, as shares of their distance from what is hoped for."""

PROVED = 0.98
"""Share of a gap that is worth no more rows."""


class Eccentricities:
    """Eccentricities of some vertices of a mesh, and bounds of those of all."""

    def __init__(self, metric: EdgeMetric, known: Floats, low: Floats, high: Floats) -> None:
        self.metric, self.known = metric, known
        self.low, self.high = low, high
        self._chooser: Chooser | None = None

    @classmethod
    def of(cls, sample: Sample, metric: EdgeMetric) -> Eccentricities:
        """What a net says."""
        low, high = sample.eccentricity_bounds
        return cls(metric, sample.rows.max(axis=1), low[metric.order], high[metric.order])

    def from_value(self, e: float) -> Floats:
        """(n,): how far each eccentricity is from a value, at least; negative where the bounds contain it."""
        return np.maximum(self.low - e, e - self.high)

    def hole(self, other: Eccentricities) -> tuple[float, float]:
        """The value of the other mesh that is farthest from the known ones of this mesh, and how far it is."""
        values = np.sort(self.known)
        after = np.searchsorted(values, other.known).clip(1, len(values) - 1)
        apart = np.minimum(np.abs(other.known - values[after - 1]), np.abs(values[after] - other.known))
        best = int(apart.argmax())
        return float(other.known[best]), float(apart[best])

    def look_near(self, e: float, apart: float) -> None:
        """Rows where the bounds come nearest to a value that is so far from all known eccentricities."""
        if self._chooser is None:
            self._chooser = Chooser(self.metric)
        bounds = -self.from_value(e)
        target = FINER * (float(bounds.max()) + apart) - apart
        groups: list[Indices] = []
        while len(groups) < GROUPS and float(bounds.max()) > target:
            below = FALL * (target + apart) - apart
            groups.append(self._chooser.group(int(bounds.argmax()), bounds, below, -apart, 1.0))
        chosen, k = np.array(groups, np.intp).reshape(-1, LANES), len(groups)
        found, low, high = np.empty(chosen.shape), np.repeat(self.low[None], k, 0), np.repeat(self.high[None], k, 0)
        distortion_bounds.bound_eccentricities(chosen, self.metric.graph, self.metric.step, found, low, high)
        low.max(axis=0, out=self.low)
        high.min(axis=0, out=self.high)
        self.known = np.append(self.known, found)


def gap_of_eccentricities(
    X: Eccentricities, Y: Eccentricities, least: float, clock: Clock, beyond: tuple[float, float] = (0.0, 0.0)
) -> float:
    """Lower bound of the distortion of spaces within some radii of the meshes; looked for above `least` only."""
    best, rounding = 0.0, tolerances.COMPARISON * float(max(X.known.max(), Y.known.max()))
    sides = (X, Y, beyond[0]), (Y, X, beyond[1])
    while True:
        holes = [(*A.hole(B), A, own) for A, B, own in sides]
        e, apart, A, r = max(holes, key=lambda hole: hole[1])
        proved = float(A.from_value(e).min())
        best = max(best, proved - rounding - max(sum(beyond), 2.0 * r))
        if clock.over or apart <= least or proved >= PROVED * apart:
            return best
        A.look_near(e, apart)
