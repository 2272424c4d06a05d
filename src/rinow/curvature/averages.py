"""The averages of angle defects that compete, with what is known of their errors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.length_noise import LengthNoise
from rinow.curvature.margins import SUPPORT, Margins, growth
from rinow.curvature.waves import ORDER, REFERENCE, Waves, window

__all__ = ["SUPPORT", "Averages", "Candidate", "squared_bias"]

Floats = NDArray[np.float64]

PASSES = 5, 16
"""Repetitions of the mean over a ring that average squared errors: least and most, a third of the scale between."""
VARIANCE_PASSES = 3
"""The same for the mean that a variance is raised to."""
FADING = 2, 16
"""Scales from which on weights fade out towards boundaries, in averages of their own, and after which all do."""
FLOOR = 0.1
"""Share of the variance of a comparison that its square cannot be told from: least squared bias."""
WITHIN = 3.0
"""Differences of a value from its reference over the root of its squared bias, at most, so that two spreads hold them.
S is not symmetric, and waves may grow somewhere: they do so in these differences as well."""
Candidate = tuple[Floats, Floats, Floats, Floats]
"""Values, variances, squared biases, radii."""


@dataclass(frozen=True)
class Averages:
    """The averages of a mesh.

    Attributes
    ----------
    flow, noise, waves : CurvatureFlow, LengthNoise, Waves
        The mesh, what noise of its lengths does, and what is averaged.
    level : (n_vertices,) ndarray of float
        Variance of the lengths.
    margins : Margins
        Its boundaries.
    """

    flow: CurvatureFlow
    noise: LengthNoise
    waves: Waves
    level: Floats
    margins: Margins

    def of_scale(self, m: int) -> Iterator[Candidate]:
        """The averages of one scale, of all orders."""
        fades = self.margins.exist and m >= FADING[0]
        if not fades or m <= FADING[1]:
            yield from self._even(m)
        if fades:
            yield from self._faded(m)

    def _even(self, m: int) -> Iterator[Candidate]:
        """Those with weights that end at boundaries, where they have to."""
        orders = range(1, ORDER + 1 if m else 2)
        windows = [window(m, order) for order in orders]
        differences = (
            [_difference(_reference(m, order), c) for order, c in zip(orders, windows, strict=True)] if m else []
        )
        sums, jumps, radius = self.waves.sums(windows + differences), self.margins.jumps(m), self.radius(m)
        for i, c in enumerate(windows):
            values = sums[i] if m else np.where(self.flow.has_data, sums[i], np.nan)
            bias = np.zeros(len(radius))
            if m:
                bias = squared_bias(m, sums[len(windows) + i], self.flow, self._variance(differences[i], jumps))
            yield values, self._raised(self._variance(c, jumps), values), bias, radius

    def _faded(self, m: int) -> Iterator[Candidate]:
        """Those with weights that fade out towards boundaries."""
        radius = self.radius(m)
        found = self.margins.averages(m, radius)
        for order, (values, left) in enumerate(found, 1):
            reference, beside = self.margins.reference(m, order)
            c, more = window(m, order), growth(left, order)
            difference = self._variance(_difference(_reference(m, order), c), None)
            seen = difference * np.fmax(more, growth(beside, order + 1))
            bias = squared_bias(m, reference - values, self.flow, seen)
            yield values, self._raised(self._variance(c, None) * more, values), bias, radius

    def radius(self, m: int) -> Floats:
        """(n_vertices,): radius of the ball averaged over."""
        return np.sqrt(np.fmax(SUPPORT * m * self.noise.step, self.flow.spacing**2))

    def _variance(self, coefficients: Floats, jumps: Floats | None) -> Floats:
        """Variance of a sum of waves; nan, so that no candidate wins, where it is 0 times infinity."""
        variance = self.noise.variance(coefficients)
        if jumps is not None:
            variance += self.noise.variance_by_jumps(coefficients, jumps)
        with np.errstate(invalid="ignore"):
            return self.level * variance

    def _raised(self, variance: Floats, values: Floats) -> Floats:
        """Variance, no less than its mean around; nan where there is no value."""
        variance = np.fmax(variance, self.flow.means(variance, VARIANCE_PASSES))
        variance[~np.isfinite(values)] = np.nan
        return variance


def squared_bias(m: int, difference: Floats, flow: CurvatureFlow, seen: Floats) -> Floats:
    """What an average of scale m differs by from its reference, squared, less the noise of that."""
    excess = difference**2 - seen
    seen = np.fmax(seen, flow.means(seen, VARIANCE_PASSES))
    least = np.fmax(FLOOR * seen, (difference / WITHIN) ** 2)
    return np.fmax(flow.means(excess, int(np.clip(m // 3, *PASSES))), least)


def _reference(m: int, order: int) -> Floats:
    """What the candidate of this scale and order is compared with: half the scale, an order more if there is one."""
    half = REFERENCE[m]
    return window(half, order + 1 if half == m else min(order + 1, ORDER))


def _difference(a: Floats, b: Floats) -> Floats:
    """Coefficients of a minus those of b."""
    n = max(len(a), len(b))
    return np.pad(a, (0, n - len(a))) - np.pad(b, (0, n - len(b)))
