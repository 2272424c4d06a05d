"""Many points at once: the surface of constant curvature that fits their distances best."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import eigh

from rinow._arrays import as_distance_matrix, as_distances
from rinow._printing import OneLine
from rinow.errors import InvalidInputError, NotAMetricError
from rinow.kernels import point_sets

__all__ = ["LARGEST_DIAMETER", "CurvatureFit", "Misfit", "closest_curvatures", "fit_curvature", "least_misfit"]

Floats = NDArray[np.float64]

LARGEST_DIAMETER = 2.0**505
"""Distances beyond this, or below its inverse, have a curvature that is no number."""
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
N_COPIES, SMALL_NOISE = 8, 1e-7
"""Pairs of disturbed copies that show the bias of noise, and the noise, in diameters, below which it has none."""
UNSURE = 0.25
"""Share of the bias that stays uncertain: what is taken off is the first term of a series in the variance."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CurvatureFit(OneLine):
    """Curvature that fits a batch of point sets.

    Attributes
    ----------
    value : (...) ndarray of float
        Curvature in 1/length².
    standard_error : (...) ndarray of float
        Of the value, if the distances have independent errors of one size; nan for four points, which fit exactly, and
        where these errors are so large that more of them would leave no fit: then nothing is known of the value.
    residual : (...) ndarray of float
        That size, in the unit of length: the standard deviation of the errors of the distances.
    """

    value: Floats
    standard_error: Floats
    residual: Floats


def fit_curvature(distances: ArrayLike) -> CurvatureFit:
    r"""Curvature k for which n points come closest to a configuration in the surface S_k.

    Parameters
    ----------
    distances : (..., n, n) array_like of float, or MetricSpace
        Distances of n >= 4 points.

    Returns
    -------
    CurvatureFit
        `value`, `standard_error` and `residual`; nan for a matrix that is not symmetric with zero diagonal, finite
        and non-negative, for diameters below 1e-152 or above 1e152, and where the iteration finds no minimum (points of
        a line or a tree).

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong or n < 4.

    See Also
    --------
    embedding_curvatures : All exact values for four points.

    Notes
    -----
    In S_k the vectors from a base point, the most central one, have the Gram matrix
    :math:`H_{ij} = (E_{i0} + E_{j0} - E_{ij})/2 - k E_{i0} E_{j0}/4` with the squared chords
    :math:`E = 4 s_k(d/2)^2`, and it has rank 2.  Minimised is the sum of squares of its other eigenvalues, by the
    Gauss-Newton method from the solution of the linearised equation at k = 0.  Points of S_k are fitted to
    rounding; on another surface the value tends to the curvature at the point to which the set shrinks, like the
    diameter, or like its square for sets symmetric about that point.  Each step costs O(n³).

    Errors ε of the distances add to the least value a bias of the order of their variance, many standard errors for
    many points.  It is what the least value grows by if errors of the size of the residuals are added once more, the
    mean over eight copies and their opposites, and it is taken off; a quarter of it counts as uncertain.

    References
    ----------
    .. [1] L. M. Blumenthal, "Theory and Applications of Distance Geometry", 1953, chapter VII.

    Examples
    --------
    Ten points of a sphere of radius 2:

    >>> from rinow import SpaceForm
    >>> sphere = SpaceForm(0.25)
    >>> points = sphere.sample(10, 1.0, np.random.default_rng(5))
    >>> fit = fit_curvature(sphere.distance(points[:, None], points))
    >>> round(float(fit.value), 10)
    0.25
    """
    D = as_distances(distances)
    if D.ndim < 2 or D.shape[-1] != D.shape[-2] or D.shape[-1] < 4:
        raise InvalidInputError(f"distances has shape {D.shape}; give square matrices of at least 4 points.")
    flat = D.reshape(-1, *D.shape[-2:])
    fits = np.array([_fit(matrix) for matrix in flat]).reshape(-1, 3)
    value, error, residual = (column.reshape(D.shape[:-2])[()] for column in fits.T)
    return CurvatureFit(value, error, residual)


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


def _fit(distances: Floats) -> tuple[float, float, float]:
    """Value, standard error and residual of one matrix."""
    D, diameter = _from_the_middle(distances)
    misfit = None if D is None else least_misfit(D)
    if D is None or misfit is None:
        return math.nan, math.nan, math.nan
    error, residual = misfit.errors()
    bias = _bias(D, misfit.k, residual)
    value = misfit.k - np.nan_to_num(bias)
    return value / diameter**2, math.hypot(error, UNSURE * bias) / diameter**2, residual * diameter


def closest_curvatures(distances: Floats) -> Floats:
    """(m,): the curvatures in which m sets of points come closest, with whatever noise adds to them."""
    values = np.full(len(distances), math.nan)
    for i, matrix in enumerate(distances):
        D, diameter = _from_the_middle(matrix)
        misfit = None if D is None else least_misfit(D)
        if misfit is not None:
            values[i] = misfit.k / diameter**2
    return values


def _from_the_middle(distances: Floats) -> tuple[Floats | None, float]:
    """The matrix in units of its diameter, the most central point first, and the diameter; None if it is no metric."""
    try:
        D = as_distance_matrix(distances)
    except NotAMetricError:
        return None, math.nan
    diameter = float(D.max())
    if not 1.0 / LARGEST_DIAMETER < diameter < LARGEST_DIAMETER:
        return None, math.nan
    order = np.lexsort((D.sum(axis=1), D.max(axis=1)))
    return D[np.ix_(order, order)] / diameter, diameter


def _bias(D: Floats, k: float, noise: float) -> float:
    """Mean growth of the least value with errors of this size; nan where some leave no fit, and for four points 0."""
    if len(D) == 4 or noise < SMALL_NOISE:
        return 0.0
    rng, values = np.random.default_rng(0), []
    for _ in range(N_COPIES):
        signs = np.triu(rng.choice((-1.0, 1.0), D.shape), 1)
        for errors in (noise * signs, -noise * signs):
            misfit = least_misfit(np.abs(D + errors + errors.T), k)
            values.append(math.nan if misfit is None else misfit.k)
    return float(np.mean(values)) - k


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
        here = there
    return None
