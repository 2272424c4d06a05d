"""The limit at a point of curvatures of quadruples around it: a robust fit of a curvature that varies."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.embedding.quadruple import EmbeddingCurvatures

__all__ = ["Limit", "limit_at_first"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FEWEST_POINTS = 6
"""Points that can tell a gradient of curvature from scatter."""
STEPS = 8
"""Rounds of choosing values and weights; the choice is settled after three or four."""
NORMAL = 1.4826
"""Standard deviation of a normal variable over its median absolute value."""
HUBER = 2.0
"""Residuals beyond this many standard deviations weigh less."""


class Limit(NamedTuple):
    """The limit with what decides whether it exists."""

    value: float
    standard_error: float
    scatter: float
    contrast: float
    """Difference of the middle convex quadrilateral and the middle triangle with an inner point, over the scatter."""


def limit_at_first(D: Floats, Q: Indices, found: EmbeddingCurvatures, errors: Floats) -> Limit:
    """The curvature at point 0 from quadruples of points that have one.

    Parameters
    ----------
    D : (n, n) ndarray of float
        Distances of the points.
    Q : (m, 4) ndarray of intp
        The quadruples.
    found : EmbeddingCurvatures
        Their values, at least one each.
    errors : (m, 2) ndarray of float
        What the errors of the distances make of each value, in 1/length².

    Returns
    -------
    limit : Limit
        See `rinow.wald_curvature` for the model and its standard error.
    """
    design = _design(_chart(D)[Q])
    coefficients, nearest = _robust_fit(found.values, errors, design)
    chosen = (np.arange(len(Q)), nearest)
    error, kind = errors[chosen], found.kind[chosen]
    residual, weight = found.values[chosen] - design @ coefficients, 1 / error
    noise, typical = _weighted_median(error, weight), NORMAL * _weighted_median(np.abs(residual), weight)
    squares = 1 / (error**2 + typical**2)
    largest = max(typical, float((squares @ residual**2 / squares.sum()) ** 0.5))
    n_points, n_coefficients = len(np.unique(Q)), len(coefficients)
    known = 0.5 * (n_points - 2) * (n_points - 3)  # distances less the coordinates of plane points, up to motions
    free = max(known - n_coefficients, 0.0)
    unbiased = (known / max(free, 0.5)) ** 0.5
    measured = unbiased * largest
    scatter = ((noise**2 + free * measured**2) / (1 + free)) ** 0.5  # the expected errors count as one measurement
    middles = [_weighted_median(residual[kind == k], weight[kind == k]) for k in ("planar", "nonplanar")]
    contrast = abs(middles[0] - middles[1]) / (unbiased * np.hypot(typical, noise))
    standard_error = float(np.hypot(measured, noise)) * (n_coefficients / max(n_points - 3, 1)) ** 0.5
    return Limit(float(coefficients[0]), standard_error, float(scatter), float(np.nan_to_num(contrast)))


def _robust_fit(values: Floats, errors: Floats, design: Floats) -> tuple[Floats, Indices]:
    """Coefficients of a linear model of one value of each row, and which; outliers weigh less (Huber)."""
    rows = np.arange(len(values))
    nearest: Indices = np.nanargmin(np.abs(values), axis=1)
    expected: Floats = np.full(len(values), _weighted_median(values[rows, nearest], 1 / errors[rows, nearest]))
    coefficients: Floats = np.zeros(design.shape[1])
    for _ in range(STEPS):
        nearest = np.nanargmin(np.abs(values - expected[:, None]), axis=1)
        value, error = values[rows, nearest], errors[rows, nearest]
        scatter = NORMAL * _weighted_median(np.abs(value - expected), 1 / error)
        weights = 1 / np.hypot(error, scatter)
        weights *= np.sqrt(HUBER / np.maximum(np.abs(value - expected) * weights, HUBER))
        coefficients = np.asarray(np.linalg.lstsq(design * weights[:, None], value * weights)[0], np.float64)
        expected = design @ coefficients
    return coefficients, nearest


def _design(X: Floats) -> Floats:
    """(n, 1) or (n, 4): 1, centroid and mean square of quadruples of plane points, each column scaled to 1."""
    columns = [np.ones(len(X))]
    if len(np.unique(X.reshape(-1, 2), axis=0)) >= FEWEST_POINTS:
        columns += [*X.mean(axis=1).T, (X**2).sum(axis=2).mean(axis=1)]
    design = np.column_stack(columns)
    return design / np.maximum(np.abs(design).max(axis=0), np.finfo(np.float64).tiny)


def _chart(D: Floats) -> Floats:
    """(n, 2): coordinates of the points around the first one, by classical scaling."""
    gram = 0.5 * (D[0][:, None] ** 2 + D[0] ** 2 - D**2)
    squares, axes = np.linalg.eigh(gram)
    return axes[:, -2:] * np.sqrt(np.maximum(squares[-2:], 0.0))


def _weighted_median(x: Floats, weights: Floats) -> float:
    """The value that half of the weight is below; nan for none."""
    if not len(x):
        return np.nan
    order = np.argsort(x, kind="stable")
    below = np.cumsum(weights[order])
    return float(x[order[np.searchsorted(below, 0.5 * below[-1])]])
