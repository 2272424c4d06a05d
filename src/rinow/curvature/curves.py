"""Curvature along a curve in any metric space."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow.curvature.alt import alt_of_polyline
from rinow.curvature.polyline import Polyline, as_polyline
from rinow.errors import InvalidInputError
from rinow.kernels import polylines

__all__ = ["curve_curvature"]

_REACH = {"menger": 1, "haantjes": 1, "alt": 2}


def curve_curvature(
    points: ArrayLike,
    *,
    kind: Literal["menger", "haantjes", "alt"] = "menger",
    closed: bool = False,
    distances: bool | None = None,
    reach: int | None = None,
) -> NDArray[np.float64]:
    r"""Curvature at every point of a curve, from distances alone.

    - "menger": the circle through the point and the two in reach on either side;
    - "haantjes": by how much the arc between those two is longer than its chord;
    - "alt": circles through the point and any two in reach, extrapolated to the point.

    All three approach the curvature of a smooth curve.

    Parameters
    ----------
    points : (n_points, dimension) or (n_points, n_points) array_like of float, or MetricSpace
        The points in order along the curve, or all their distances.
    kind : {"menger", "haantjes", "alt"}, default "menger"
        Which definition.
    closed : bool, default False
        Whether the last point is followed by the first, which must not be repeated.
    distances : bool, optional
        Whether `points` holds distances.  By default it does if it is square and
        symmetric with zero diagonal.
    reach : int, optional
        Number of points on either side, 1 by default and 2 for "alt"; on a curve too
        short for it, as many as fit.

    Returns
    -------
    curvature : (n_points,) ndarray of float
        In 1/length, never negative, 0 on a straight piece.  It is nan on a curve of fewer
        than 3 points, where a point in use is not finite, and where two points of a
        circle coincide or an arc has fewer than two sides of positive length.  Near the
        ends of an open curve the points in use are the last 2 `reach` + 1.

    Raises
    ------
    InvalidInputError
        If a shape, a type, `kind` or `reach` is wrong.
    NotAMetricError
        If the distances are not finite, non-negative and symmetric with zero diagonal.

    See Also
    --------
    alt_curvature : The same at chosen points.
    menger_curvature, haantjes_curvature : The curvature of given triples and arcs.

    Notes
    -----
    On a curve of geodesic curvature :math:`\kappa` in a Riemannian manifold two points
    at distance s along it are :math:`s - \kappa^2 s^3/24 + O(s^4)` apart; the curvature of
    the manifold enters at :math:`s^5`.  All three kinds follow from the first two terms.

    Error where points lie at smoothly varying spacing h (in brackets at random spacing):

    ============  ==============  ========  =====================
    kind          inside          ends      exact for
    ============  ==============  ========  =====================
    menger        O(h²) (O(h))    O(h)      circles of the plane
    haantjes      O(h²) (O(h))    O(h)      straight lines
    alt           O(h⁴) (O(h³))   O(h³)     circles of the plane
    ============  ==============  ========  =====================

    "haantjes" differs from Definition 5.5 of [1]_ in that the length of the arc is not
    known.  With the sides :math:`c_i` of the polyline, their sum :math:`L` and the chord
    :math:`d`, each side is replaced by an arc of the curvature sought:

    .. math:: \kappa^2 = 24 (L - d) / (L^3 - \sum c_i^3).

    :math:`24(L-d)/L^3` itself tends to :math:`\tfrac34\kappa^2` for two equal sides.

    With :math:`x = \kappa h` and :math:`\epsilon = 10^{-16}` the arithmetic costs
    :math:`\epsilon/x` of the curvature from points and :math:`10\epsilon/x^2` from
    distances, since these are rounded; the rounding of coordinates of size :math:`|p|`
    changes it by :math:`\epsilon|p|/h^2`.  A straight line given by distances gets up to
    :math:`4 \cdot 10^{-8}/h`.  If the data have a larger error :math:`\epsilon`, raise
    `reach`, which acts as a larger h.  The cost is O(n_points reach²) for points and
    O(n_points²), the check, for distances.

    References
    ----------
    .. [1] E. Saucan, "Surface triangulation: the metric approach", 2004, section 5.

    Examples
    --------
    Four corners of a square lie on a circle of radius √½:

    >>> import rinow
    >>> rinow.curve_curvature([[0, 0], [1, 0], [1, 1], [0, 1]], closed=True)
    array([1.41421356, 1.41421356, 1.41421356, 1.41421356])
    """
    if kind not in _REACH:
        raise InvalidInputError(f"kind = {kind!r} is unknown; give one of {', '.join(_REACH)}.")
    polyline = as_polyline(points, distances=distances, closed=closed)
    windows = polyline.windows(_REACH[kind] if reach is None else reach)
    if windows.shape[1] < 3:
        return np.full(len(windows), np.nan)
    at = np.arange(len(windows))
    if kind == "alt":
        return alt_of_polyline(polyline, windows, at)
    return _menger(polyline, windows, at) if kind == "menger" else _haantjes(polyline, windows)


def _menger(polyline: Polyline, windows: NDArray[np.intp], at: NDArray[np.intp]) -> NDArray[np.float64]:
    """Curvature of the ends of each window and its point, or the point next to it if it is an end."""
    place = np.argmax(windows == at[:, None], axis=1)
    middle = windows[at, np.clip(place, 1, windows.shape[1] - 2)]
    return polyline.roots(polyline.menger_squares(np.stack([windows[:, 0], middle, windows[:, -1]], axis=-1)))


def _haantjes(polyline: Polyline, windows: NDArray[np.intp]) -> NDArray[np.float64]:
    """Curvature of the arc through each window."""
    squares = np.empty(len(windows))
    polylines.haantjes_squares(polyline.data, polyline.are_distances, windows, squares)
    return polyline.roots(squares)
