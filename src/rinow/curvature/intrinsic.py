"""Gaussian curvature from edge lengths alone, its scale and order chosen at every vertex."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.estimate import Estimate
from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.length_noise import LengthNoise
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["IntrinsicCurvature", "intrinsic", "intrinsic_curvature"]

Floats = NDArray[np.float64]

LADDER = (0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)
"""Numbers of steps m that compete."""
REFERENCE = {1: 1, 2: 1, 3: 2} | {m: LADDER[LADDER.index(m) - 2] for m in LADDER[4:]}
"""The smaller number of steps that the bias is seen against: half of m."""
ORDER = 3
"""Highest order."""
NOISE_PROBES = ((2, 2), (4, 2), (8, 2), (8, 3))
"""Steps and order of the fits whose residuals tell the noise; the smallest residual counts."""
PASSES, SHRINK_PASSES = 10, 40
FLOOR = 0.1
"""Share of the variance of a comparison that its square cannot be told from: least squared bias."""


@dataclass(frozen=True, slots=True)
class IntrinsicCurvature:
    """Gaussian curvature at each vertex, with the two parts of its predicted squared error.

    Attributes
    ----------
    gaussian : (n_vertices,) ndarray of float
        In 1/length²; nan where no interior vertex is near.
    variance, squared_bias : (n_vertices,) ndarray of float
        Expected squared error by noise of the lengths, and by the average over a neighbourhood.
    radius : (n_vertices,) ndarray of float
        Radius of the ball averaged over.
    """

    gaussian: Floats
    variance: Floats
    squared_bias: Floats
    radius: Floats


def combination(m: int, order: int) -> dict[int, float]:
    """Coefficients of I - (I - S^m)^order as a polynomial in S: {m: order, 2m: -order(order-1)/2, ...}."""
    return {m * j: float((-1) ** (j + 1) * comb(order, j)) for j in range(1, order + 1)}


class Powers:
    """S^m K for the numbers of steps asked for in ascending order; what is no longer needed is forgotten."""

    def __init__(self, flow: CurvatureFlow) -> None:
        self._flow, self._last = flow, 0
        self._kept = {0: flow.start}

    def __getitem__(self, m: int) -> Floats:
        if m not in self._kept:
            current = self._kept[self._last]
            for i in range(self._last + 1, m + 1):
                current = self._flow.step(current)
                if i in NEEDED:
                    self._kept[i] = current
            self._kept[m], self._last = current, m
        return self._kept[m]

    def combined(self, coefficients: dict[int, float]) -> Floats:
        """Sum of coefficient times S^m K."""
        return sum((c * self[m] for m, c in sorted(coefficients.items())), np.zeros(1))

    def forget(self, below: int) -> None:
        """Drop powers that no candidate of at least `below` steps needs."""
        needed = {j * m for m in LADDER if m >= below for j in range(1, ORDER + 1)} | {self._last}
        needed |= {j * REFERENCE[m] for m in LADDER if m >= max(below, 1) for j in range(1, ORDER + 2)}
        self._kept = {m: values for m, values in self._kept.items() if m in needed}


NEEDED = frozenset(j * m for m in LADDER for j in range(1, ORDER + 2))


def intrinsic_curvature(mesh: TriangleMesh | IntrinsicMesh) -> IntrinsicCurvature:
    """Gaussian curvature from edge lengths, with variance and squared bias; see `intrinsic`."""
    flow = CurvatureFlow(mesh)
    noise = LengthNoise.of(flow)
    powers = Powers(flow)
    tau2 = _noise_level(flow, noise, powers)
    n = mesh.n_vertices
    best = IntrinsicCurvature(np.full(n, np.nan), np.full(n, np.inf), np.zeros(n), np.zeros(n))
    for m in LADDER:
        radius = np.sqrt(10.0 * m * noise.step)
        for order in range(1, (ORDER if m else 1) + 1):
            candidate = _candidate(m, order, flow, noise, powers, tau2, radius)
            _improve(best, candidate)
        powers.forget(m + 1)
    return best


def _noise_level(flow: CurvatureFlow, noise: LengthNoise, powers: Powers) -> Floats:
    """(n_vertices,): variance of the edge lengths that the residuals of smooth fits show around each vertex."""
    defects = flow.mesh.vertex_angle_defects
    columns = np.full((len(defects), len(NOISE_PROBES)), np.nan)
    for i, (m, order) in enumerate(NOISE_PROBES):
        residuals = defects - flow.areas * powers.combined(combination(m, order))
        with np.errstate(all="ignore"):
            columns[:, i] = np.where(flow.has_data, residuals**2 / noise.sensitivity, np.nan)
    return np.fmin.reduce(flow.means(columns, PASSES), axis=1)


def _candidate(
    m: int, order: int, flow: CurvatureFlow, noise: LengthNoise, powers: Powers, tau2: Floats, radius: Floats
) -> IntrinsicCurvature:
    """The estimate of one scale and order."""
    coefficients = combination(m, order)
    values = powers.combined(coefficients) if m else np.where(flow.has_data, powers[0], np.nan)
    variance = tau2 * noise.variance(coefficients if m else {0: 1.0})
    variance[~np.isfinite(values)] = np.nan
    variance = np.fmax(variance, flow.means(variance, 3))
    squared_bias = np.zeros(len(values))
    if m:
        half = REFERENCE[m]
        reference = combination(half, order + 1 if half == m else min(order + 1, ORDER))
        difference = {k: reference.get(k, 0.0) - coefficients.get(k, 0.0) for k in {*reference, *coefficients}}
        seen = tau2 * noise.variance(difference)
        excess = powers.combined(difference) ** 2 - seen
        passes = max(PASSES, m)
        squared_bias = np.fmax(flow.means(excess, passes), FLOOR * np.fmax(seen, flow.means(seen, PASSES)))
    return IntrinsicCurvature(values, variance, squared_bias, radius)


def _improve(best: IntrinsicCurvature, candidate: IntrinsicCurvature) -> None:
    """Take the candidate wherever its predicted squared error is smaller."""
    better = candidate.variance + candidate.squared_bias < best.variance + best.squared_bias
    for name in ("gaussian", "variance", "squared_bias", "radius"):
        getattr(best, name)[better] = getattr(candidate, name)[better]


def intrinsic(mesh: TriangleMesh | IntrinsicMesh) -> Estimate:
    """Gaussian curvature of a surface known by its edge lengths, the scale and order chosen at every vertex."""
    found = intrinsic_curvature(mesh)
    return Estimate(found.gaussian, np.sqrt(found.variance + found.squared_bias), found.radius)
