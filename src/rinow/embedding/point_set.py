"""Many points at once: the surface of constant curvature that fits their distances best."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import as_distance_matrix, as_distances
from rinow._printing import OneLine
from rinow.embedding.misfit import least_misfit, least_misfits, noise_at, quietest_curvature, quietest_near
from rinow.errors import InvalidInputError, NotAMetricError

__all__ = ["LARGEST_DIAMETER", "CurvatureFit", "closest_curvatures", "fit_curvature", "many_closest_curvatures"]

Floats = NDArray[np.float64]

LARGEST_DIAMETER = 2.0**505
"""Distances beyond this, or below its inverse, have a curvature that is no number."""
N_COPIES, SMALL_NOISE = 8, 1e-7
"""Pairs of disturbed copies that show the bias of noise, and the noise, in diameters, below which it has none."""
NOISY, DOUBTFUL, QUIETER = 0.01, 0.1, 0.5
"""Noise of a least misfit, in diameters, from which on it may be that of a wrong curvature, and noise that is hardly
less than the distances; a curvature counts instead whose noise is at most so large a share of the one or the other."""
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

    In units of the curvature, points of a hyperbolic plane farther apart than four or so have minima elsewhere, for
    their squared chords grow exponentially with the distance, and so do the effects of errors.  So where the least
    misfit takes errors of more than a hundredth of the diameter, or there is none, it is also asked for which negative
    curvature, down to -1500 in units of 1/diameter², the misfit takes the least errors; if they are half as large, that
    is the value, with its bias and standard error from such copies.

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


def _fit(distances: Floats) -> tuple[float, float, float]:
    """Value, standard error and residual of one matrix."""
    D, diameter = _from_the_middle(distances)
    misfit = None if D is None else least_misfit(D)
    if D is None:
        return math.nan, math.nan, math.nan
    noise = DOUBTFUL if misfit is None else misfit.errors()[1]
    quiet = quietest_curvature(D, QUIETER * noise) if noise > NOISY else math.nan
    if not math.isnan(quiet):
        misfit = least_misfit(D, quiet)
        if misfit is None or misfit.errors()[1] > SMALL_NOISE:
            value, error, residual = _quietest(D, quiet)
            return value / diameter**2, error / diameter**2, residual * diameter
    if misfit is None:
        return math.nan, math.nan, math.nan
    error, residual = misfit.errors()
    bias = _bias(D, misfit.k, residual)
    value = misfit.k - np.nan_to_num(bias)
    return value / diameter**2, math.hypot(error, UNSURE * bias) / diameter**2, residual * diameter


def _quietest(D: Floats, k: float) -> tuple[float, float, float]:
    """Value, standard error and noise where the noise has its minimum, by copies to which that noise is added."""
    noise = noise_at(D, k)
    values = np.array([quietest_near(copy, k, 2) for copy in _disturbed_copies(D, noise)])
    bias = float(values.mean()) - k
    return k - bias, math.hypot(float(values.std()), UNSURE * bias), noise


def closest_curvatures(distances: Floats) -> Floats:
    """(m,): the curvatures in which m sets of points come closest, with whatever noise adds to them."""
    values = np.full(len(distances), math.nan)
    for i, matrix in enumerate(distances):
        D, diameter = _from_the_middle(matrix)
        misfit = None if D is None else least_misfit(D)
        if misfit is not None:
            values[i] = misfit.k / diameter**2
    return values


def many_closest_curvatures(distances: Floats) -> Floats:
    """(m,): the same up to rounding, but quickly, for metrics of safe size with two different points."""
    diameters = distances.max(axis=(1, 2))
    order = np.lexsort((distances.sum(axis=2), distances.max(axis=2)), axis=-1)
    rows = np.arange(len(distances))[:, None, None]
    from_the_middle = distances[rows, order[:, :, None], order[:, None, :]] / diameters[:, None, None]
    return least_misfits(from_the_middle) / diameters**2


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
    fits = (least_misfit(copy, k) for copy in _disturbed_copies(D, noise))
    return float(np.mean([math.nan if misfit is None else misfit.k for misfit in fits])) - k


def _disturbed_copies(D: Floats, noise: float) -> Iterator[Floats]:
    """Copies of the distances with errors of this size, each followed by that with the opposite ones."""
    rng = np.random.default_rng(0)
    for _ in range(N_COPIES):
        signs = np.triu(rng.choice((-1.0, 1.0), D.shape), 1)
        for errors in (noise * signs, -noise * signs):
            yield np.abs(D + errors + errors.T)
