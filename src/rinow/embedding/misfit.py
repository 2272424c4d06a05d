"""What keeps the distances of n points from those of points of a surface S_k, and the curvature that leaves least."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.optimize import minimize_scalar

from rinow.kernels import misfits, point_sets

__all__ = ["Misfit", "least_misfit", "least_misfits", "noise_at", "quietest_curvature", "quietest_near"]

Floats = NDArray[np.float64]

N_BLOCKS = 16
"""Pieces into which many sets are cut."""
MAX_STEPS = 100
SMALL_STEP = 1e-6
"""Steps below this are taken as they are, as long as each is less than half the last one: then they are rounding."""
SLACK = 1.0 + 1e-10
"""The sum of squares may grow by this factor in a step: near the minimum it is flat to the square root of rounding."""
SMALL_SLOPE = 1e-25
"""Square of the derivative of a Gram matrix that is rounding, in units of the diameter: points of a line."""
SMALLEST = -1e4
"""At a smaller curvature rounding hides the second dimension, in units of 1/diameter²."""
BEYOND = 1.5
"""Steps may exceed by this factor the largest curvature that the perimeter of a triple allows."""
RATIO, N_RUNGS = 1.5, 20
"""Curvatures at which the noise is looked at: -1, -1.5, -2.25, ..., -2217 in units of 1/diameter²."""
ROUNDED = 1e-12
"""Noise below this is rounding, unless the curvature is exact, which a rung is not."""
PRECISION = 1e-6
"""Of a minimum of the noise, in curvatures."""


@dataclass(frozen=True, slots=True, eq=False)
class Misfit:
    """What is left of the Gram matrix and of its derivative in k beyond the two dimensions of the surface."""

    k: float
    chords: Floats
    projector: Floats
    rest: Floats
    slope: Floats

    @classmethod
    def at(cls, D: Floats, k: float) -> Misfit:
        """For distances and a curvature; the first point is the base."""
        E, dE = np.empty_like(D), np.empty_like(D)
        point_sets.squared_chords(D, k, E, dE)
        e, de = E[0, 1:], dE[0, 1:]
        gram = (e[:, None] + e - E[1:, 1:]) / 2 - k / 4 * np.outer(e, e)
        slope = (de[:, None] + de - dE[1:, 1:]) / 2 - np.outer(e, e) / 4 - k / 4 * (np.outer(de, e) + np.outer(e, de))
        plane = eigh(gram, subset_by_index=[len(e) - 2, len(e) - 1])[1]
        projector = np.eye(len(e)) - plane @ plane.T
        return cls(k, E, projector, projector @ gram @ projector, projector @ slope @ projector)

    @property
    def squares(self) -> float:
        """Sum of the squares of the eigenvalues beyond the second."""
        return float(np.vdot(self.rest, self.rest))

    @property
    def step(self) -> float:
        """Step of the Gauss-Newton method; nan for points of a line."""
        square = float(np.vdot(self.slope, self.slope))
        return -float(np.vdot(self.rest, self.slope)) / square if square > SMALL_SLOPE else math.nan

    def coordinates(self) -> Floats:
        """(n - 1, 2): the other points around the base, up to a turn; plane where k is 0."""
        e = self.chords[0, 1:]
        gram = (e[:, None] + e - self.chords[1:, 1:]) / 2 - self.k / 4 * np.outer(e, e)
        squares, axes = eigh(gram, subset_by_index=[len(e) - 2, len(e) - 1])
        return axes * np.sqrt(np.maximum(squares, 0.0))

    def errors(self) -> tuple[float, float]:
        """Standard deviations of k and of the distances, from the effects of an error in each distance."""
        variance = self.noise(self.squares, 1)
        effect = self.effect_on(self.slope / np.vdot(self.slope, self.slope))
        return (math.sqrt(variance * effect) if len(self.chords) > 4 else math.nan), math.sqrt(variance)

    def effect_on(self, weights: Floats) -> float:
        """Variance of the sum of weight times entry of `rest` for distances with independent errors of variance 1."""
        pairs, spokes, u = self._derivatives()
        return float((pairs * weights**2).sum() / 2 + (spokes * (2 * weights @ u) ** 2).sum())

    def noise(self, squares: float, n_unknowns: int) -> float:
        """Variance of the distances if they leave this sum of squares of `rest` after a fit of so many numbers."""
        n, P = len(self.chords), self.projector
        pairs, spokes, u = self._derivatives()
        Pu, diagonal = P @ u, np.diag(P)
        effect = (pairs * (np.outer(diagonal, diagonal) + P**2)).sum() / 4
        effect += 2 * (spokes * (Pu @ Pu * diagonal + Pu**2)).sum()
        n_conditions = (n - 2) * (n - 3) // 2
        return float(squares / effect * n_conditions / max(n_conditions - n_unknowns, 1))

    def _derivatives(self) -> tuple[Floats, Floats, Floats]:
        """Squared derivatives of the squared chords in the distances, of pairs and from the base, and a factor."""
        E = self.chords
        dE = 2 * np.sqrt(E * np.maximum(1 - self.k * E / 4, 0))
        return dE[1:, 1:] ** 2, dE[0, 1:] ** 2, 0.5 - self.k / 4 * E[0, 1:]


def least_misfit(D: Floats, start: float = 0.0) -> Misfit | None:
    """The least misfit near that of the linearised equation, by damped steps; None if none is found in the bounds."""
    i, j = np.unravel_index(D.argmax(), D.shape)
    largest = BEYOND * (2 * math.pi / (D[i, j] + float((D[i] + D[j]).max()))) ** 2
    here, last = Misfit.at(D, start), math.inf
    for _ in range(MAX_STEPS):
        step = here.step
        if math.isnan(step):
            return None
        if abs(step) <= SMALL_STEP * max(1.0, abs(here.k)) and (step == 0 or abs(step) >= last / 2):
            return here if SMALLEST < here.k < largest else None
        last = abs(step)
        there = Misfit.at(D, min(max(here.k + step, SMALLEST), largest))
        while not there.squares <= SLACK * here.squares and abs(step) > SMALL_STEP:
            step /= 4
            there = Misfit.at(D, min(max(here.k + step, SMALLEST), largest))
        if there.k == here.k and last > SMALL_STEP * max(1.0, abs(here.k)):
            return None  # at a bound, where it would stay
        here = there
    return None


def least_misfits(distances: Floats) -> Floats:
    """(m,): curvatures of the least misfits of m sets of distances, as of each alone; nan where none is found."""
    out = np.empty(len(distances))
    bounds = SMALLEST, SMALL_SLOPE, SMALL_STEP, SLACK, BEYOND
    misfits.closest_curvatures(distances, bounds, MAX_STEPS, N_BLOCKS, out)
    return out


def quietest_curvature(D: Floats, least: float) -> float:
    """The largest negative curvature for which the noise of the distances is a minimum below `least`; nan without one.

    Of points of a line, which fit any curvature, there is none.

    Squared chords grow like exp(√-k d), and with them the effect of an error: far below 0 the long distances alone
    make the sum of squares, and it has its minima elsewhere.  The noise that explains the sum has one at the curvature
    of the points, and falls again towards -inf, where every space is a tree; the first one counts.
    """
    if math.isnan(Misfit.at(D, 0.0).step):
        return math.nan
    rungs = -(RATIO ** np.arange(N_RUNGS))
    noise = np.array([noise_at(D, k) for k in rungs])
    low = np.flatnonzero((noise[1:-1] < noise[:-2]) & (noise[1:-1] < noise[2:])) + 1
    low = low[(ROUNDED < noise[low]) & (noise[low] < least)]
    return quietest_near(D, float(rungs[low[0]]), 1) if len(low) else math.nan


def quietest_near(D: Floats, k: float, n_rungs: int) -> float:
    """The curvature of least noise within so many rungs of k."""
    bounds = k * RATIO**n_rungs, k / RATIO**n_rungs
    found: Any = minimize_scalar(partial(noise_at, D), bounds=bounds, options={"xatol": -PRECISION * k})
    return float(found.x)


def noise_at(D: Floats, k: float) -> float:
    """Standard deviation of the distances that explains the misfit at k."""
    misfit = Misfit.at(D, k)
    return math.sqrt(misfit.noise(misfit.squares, 1))
