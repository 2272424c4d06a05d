"""How errors of edge lengths, independent of each other, reach averages of angle defects."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.waves import Waves, passed, window
from rinow.kernels import smoothing

__all__ = ["LengthNoise"]

Floats = NDArray[np.float64]

GAUSSIAN = 3.0 / (16.0 * np.pi)
"""Integral of the squared second derivative across any line of a Gaussian density of variance 1 in the plane."""

NOISE_PROBES = ((2, 2), (4, 2), (8, 2), (8, 3))
"""Scale and order of the fits whose residuals tell the noise; the smallest residual counts."""
TIMES, STARTS = np.geomspace(1e-5, 1e4, 500), np.geomspace(1e-2, 1e2, 25)
"""Squared frequencies times σ² that the noise is integrated over, and s0² over σ² that this is done for."""
UNEVEN = 1.1e-3
"""What weights that vary from vertex to vertex add: the columns of S sum to the areas up to a few percent, and errors
of lengths cancel up to that share of them, so that their variance falls like 1/m instead of 1/m³ in the end.  Measured
on irregular meshes, where it doubles the variance at the scale 43."""
LEVEL_PASSES = 6
"""Repetitions of the mean over a ring that average squared residuals."""


@dataclass(frozen=True)
class LengthNoise:
    r"""Variances of windows of waves for edge lengths of standard deviation 1.

    The weights c of the defects in :math:`S^m K` are nearly those of a Gaussian of variance :math:`s^2 = m\sigma^2`
    along each axis.  An error of a length changes the sum of defects by the jump of the slope of c across that edge,
    which is the second derivative of c times half the heights over the edge, whence the variance
    :math:`\rho \, 3 / (16\pi s^6)` with the sum ρ of the squares of half heights per area.  A variance
    :math:`s_0^2` is added to :math:`s^2` that makes it right for m = 0 as well, where the sum of squared derivatives of
    the defect is known.  A window that passes the share q of the frequency k has, likewise,
    :math:`\rho \, 3 / (16\pi) \int q^2 e^{-s_0^2 k^2} k^5 dk`.
    To :math:`k^5` the share of k is added that uneven weights have.

    Attributes
    ----------
    density, start, step : (n_vertices,) ndarray of float
        ρ (no unit), :math:`s_0^2` and :math:`\sigma^2`, in length².
    """

    density: Floats
    start: Floats
    step: Floats
    sensitivity: Floats

    @classmethod
    def of(cls, flow: CurvatureFlow) -> LengthNoise:
        """The model of a mesh."""
        n = flow.mesh.n_vertices
        squares, density = np.empty(n), np.empty(n)
        smoothing.defect_sensitivities(flow.metric, flow.mesh.face_areas, squares, density)
        columns = np.column_stack([density, flow.step_variances])
        columns[~flow.has_data] = np.nan
        density, step = flow.means(columns, 4).T
        with np.errstate(all="ignore"):
            start = (GAUSSIAN * density * flow.areas**2 / squares) ** (1.0 / 3.0)
        start[~(flow.has_data & np.isfinite(start))] = 0.0
        return cls(np.ascontiguousarray(density), start, np.ascontiguousarray(step), squares)

    def variance(self, coefficients: Floats) -> Floats:
        """(n_vertices,): variance of the sum of coefficient times wave."""
        return GAUSSIAN * self.density * self._integrals(coefficients, 3, UNEVEN)

    def variance_by_jumps(self, coefficients: Floats, squares: Floats) -> Floats:
        """(n_vertices,): the same by jumps of the weights, of which these are the squares per area: see `Margins`."""
        return squares * self._integrals(coefficients, 1, 0.0) / (2.0 * np.pi)

    def _integrals(self, coefficients: Floats, power: int, uneven: float) -> Floats:
        r"""(n_vertices,): :math:`\int q^2 e^{-s_0^2 k^2} (k^{2p-1} + u k / \sigma^4) dk`."""
        squares = passed(coefficients, np.exp(-0.5 * TIMES)) ** 2 * (TIMES**power + uneven * TIMES)
        integrals = 0.5 * np.exp(-np.multiply.outer(STARTS, TIMES)) @ squares * np.log(TIMES[1] / TIMES[0])
        with np.errstate(all="ignore"):
            at_start = np.log(self.start / self.step)
            smoothing.interpolate(at_start, np.log(STARTS), np.log(integrals))
            return np.exp(at_start) / self.step**power

    def level(self, flow: CurvatureFlow, waves: Waves) -> Floats:
        """(n_vertices,): variance of the edge lengths that the residuals of smooth fits show around each vertex."""
        least = np.full(len(flow.areas), np.nan)
        for fit in waves.sums([window(*probe) for probe in NOISE_PROBES]):
            with np.errstate(all="ignore"):
                squares = np.where(flow.has_data, (flow.areas * (waves.start - fit)) ** 2 / self.sensitivity, np.nan)
            np.fmin(least, flow.means(squares, LEVEL_PASSES), out=least)
        return least
