"""The averages of angle defects that compete, with what is known of their errors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

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
PROOF, PROVEN = 12.0, 32
"""Squared bias over the noise it is seen in from which on it is beyond doubt, and least scale for that."""
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
    proven : dict of (bool, int, int) to (n_vertices,) ndarray of float
        Squared biases beyond doubt, by whether weights fade, scale and order.

    Notes
    -----
    A scale and its reference, by which biases are seen, agree where both hold so much of the surface that what bends
    in it has the total curvature 0.  But the reference differs from its own, and what averages of growing scale lose
    has the same sign at each step: biases that are proven add up, in squares at least.
    """

    flow: CurvatureFlow
    noise: LengthNoise
    waves: Waves
    level: Floats
    margins: Margins
    proven: dict[tuple[bool, int, int], Floats] = field(default_factory=dict, init=False)

    def of_scale(self, m: int) -> Iterator[Candidate]:
        """The averages of one scale, of all orders; scales have to grow."""
        if m:
            for key in [key for key in self.proven if key[1] < REFERENCE[m]]:
                del self.proven[key]
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
                bias = self._bias((False, m, i + 1), sums[len(windows) + i], self._variance(differences[i], jumps))
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
            bias = self._bias((True, m, order), reference - values, seen)
            yield values, self._raised(self._variance(c, None) * more, values), bias, radius

    def _bias(self, key: tuple[bool, int, int], difference: Floats, seen: Floats) -> Floats:
        """Squared bias by the reference, and by those before as far as it is proven."""
        fades, m, order = key
        bias = squared_bias(m, difference, self.flow, seen)
        if m < PROVEN:
            return bias
        proven = np.where(bias > PROOF * seen, bias, 0.0)
        before = self.proven.get((fades, *_reference_of(m, order)))
        if before is not None:
            bias += before
            proven += before
        self.proven[key] = proven
        return bias

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


def _reference_of(m: int, order: int) -> tuple[int, int]:
    """What the candidate of this scale and order is compared with: half the scale, an order more if there is one."""
    half = REFERENCE[m]
    return half, order + 1 if half == m else min(order + 1, ORDER)


def _reference(m: int, order: int) -> Floats:
    """The coefficients of the reference."""
    return window(*_reference_of(m, order))


def _difference(a: Floats, b: Floats) -> Floats:
    """Coefficients of a minus those of b."""
    n = max(len(a), len(b))
    return np.pad(a, (0, n - len(a))) - np.pad(b, (0, n - len(b)))
