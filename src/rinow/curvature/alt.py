"""Alt curvature: circles through a fixed point and two that approach it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import as_indices
from rinow.curvature.polyline import Polyline, as_polyline

__all__ = ["alt_curvature", "alt_of_polyline"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def alt_curvature(
    points: ArrayLike, index: ArrayLike, *, closed: bool = False, distances: bool | None = None, reach: int = 2
) -> NDArray[np.float64]:
    r"""Alt curvature of a curve at some of its points.

    It is the limit of the Menger curvature of the triples that contain the point,
    extrapolated from all such triples among the nearest points of the curve.

    Parameters
    ----------
    points : (n_points, dimension) or (n_points, n_points) array_like of float, or MetricSpace
        The points in order along the curve, or all their distances.
    index : (...) array_like of int
        The points asked for.
    closed : bool, default False
        Whether the last point is followed by the first, which must not be repeated.
    distances : bool, optional
        Whether `points` holds distances.  By default it does if it is square and
        symmetric with zero diagonal.
    reach : int, default 2
        Number of points on either side.  More average the noise of measured points.

    Returns
    -------
    curvature : (...) ndarray of float
        In 1/length, never negative; a float for one index.  It is nan on a curve of
        fewer than 3 points and where one of the points in reach is not finite or two of
        them coincide.

    Raises
    ------
    InvalidInputError
        If a shape, a type, an index or `reach` is wrong.
    NotAMetricError
        If the distances are not finite, non-negative and symmetric with zero diagonal.

    See Also
    --------
    curve_curvature : The same at every point, and by the other definitions.

    Notes
    -----
    In Definition 5.4 of [1]_ two points tend to the third; in that of Menger curvature
    all three tend to it, which needs more: a curve may have the first and not the second.
    The square of the Menger curvature of p, q, r is, up to third order, a symmetric
    polynomial of the positions x, y of q and r along the curve, p at 0:

    .. math:: K^2(x, y) = \kappa^2 + \alpha (x + y) + \beta (x + y)^2 + \gamma xy + \dots

    The value is the square root of :math:`\kappa^2` fitted to all pairs q, r in reach,
    0 if that is negative.  The error is O(h⁴) inside a curve of smoothly varying
    spacing h, O(h³) at its ends or if the spacing is irregular; noise of the
    :math:`K^2` grows by 1.3 inside, 6.8 at the ends.  With ``reach=1`` or fewer than 5
    points there is one triple and no extrapolation.  Data cannot show that a limit fails
    to exist: at a corner the values grow like 1/h as points are added.  The cost is
    O(n_points reach²) for points and O(n_points²), the check, for distances.

    References
    ----------
    .. [1] E. Saucan, "Surface triangulation: the metric approach", 2004, Definition 5.4.

    Examples
    --------
    A parabola y = x² has curvature 2 at its vertex:

    >>> import numpy as np, rinow
    >>> x = np.linspace(-0.5, 0.5, 21)
    >>> round(float(rinow.alt_curvature(np.column_stack([x, x**2]), 10)), 3)
    2.0
    """
    polyline = as_polyline(points, distances=distances, closed=closed)
    at = as_indices(index, len(polyline.data), "index")
    windows = polyline.windows(reach)[at.reshape(-1)]
    return alt_of_polyline(polyline, windows, at.reshape(-1)).reshape(at.shape)[()]


def alt_of_polyline(polyline: Polyline, windows: Indices, at: Indices) -> Floats:
    """Alt curvature at each of the points `at` from its window, (n, width)."""
    n_others = windows.shape[1] - 1
    if n_others < 2:
        return np.full(len(at), np.nan)
    here = windows == at[:, None]
    others = windows[~here].reshape(-1, n_others)
    side = np.where(np.arange(n_others) < np.argmax(here, axis=1)[:, None], -1.0, 1.0)
    positions = side * polyline.chords(at[:, None], others)
    q, r = np.triu_indices(n_others, 1)
    centre = np.broadcast_to(at[:, None], (len(at), len(q)))
    squares = polyline.menger_squares(np.stack([others[:, q], centre, others[:, r]], axis=-1))
    return polyline.roots(_value_at_zero(positions[:, q], positions[:, r], squares))


def _value_at_zero(x: Floats, y: Floats, values: Floats) -> Floats:
    """Constant term of 1, x + y, (x + y)², xy fitted to each row; the mean where a row has one value.

    With w the part of the constant 1 that is orthogonal to the other terms the constant term is <w, values>/<w, w>.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        scale = np.abs(x).max(axis=1, initial=0.0, keepdims=True)
        x, y = x / scale, y / scale
        terms = [x + y, (x + y) ** 2, x * y, np.ones_like(x)] if x.shape[1] > 1 else [np.ones_like(x)]
        for i, term in enumerate(terms):
            for later in range(i + 1, len(terms)):
                terms[later] = terms[later] - _dot(terms[later], term) / _dot(term, term) * term
        return (_dot(terms[-1], values) / _dot(terms[-1], terms[-1]))[:, 0]


def _dot(x: Floats, y: Floats) -> Floats:
    """Inner product of each row."""
    return np.sum(x * y, axis=1, keepdims=True)
