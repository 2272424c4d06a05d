"""Menger curvature: the circle through three points."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import as_distance_matrix, as_index_tuples
from rinow.curvature.polyline import as_polyline

__all__ = ["menger_curvature"]


def menger_curvature(distances: ArrayLike, triples: ArrayLike) -> NDArray[np.float64]:
    r"""Menger curvature of triples of points of a finite metric space.

    Three points have an isometric copy in the Euclidean plane; their curvature is the
    inverse radius of the circle through it.

    Parameters
    ----------
    distances : (n_points, n_points) array_like of float, or MetricSpace
        All distances, in any unit of length.
    triples : (n_triples, 3) array_like of int
        The points of each triple, in any order.

    Returns
    -------
    curvature : (n_triples,) ndarray of float
        In 1/length, from 0 (one point between the two others) to 2/(longest side).  It is
        nan where two of the points are at distance 0 or the triangle inequality fails.

    Raises
    ------
    InvalidInputError
        If a shape, a type or an index is wrong.
    NotAMetricError
        If `distances` are not finite, non-negative and symmetric with zero diagonal.

    See Also
    --------
    curve_curvature : Menger curvature along a curve.

    Notes
    -----
    For the sides :math:`a, b, c` (Definition 5.1 of [1]_)

    .. math:: K = \sqrt{(a+b+c)(a+b-c)(a-b+c)(-a+b+c)} / (abc),

    each factor computed in the order of Kahan [2]_: the result is as exact as the given
    lengths allow.  Rounding these to 16 digits changes it by about
    :math:`10^{-15}/(Kc^2)`, :math:`c` the longest side of a triangle of three like
    sides or of a flat one with its middle point amidst, and by at most
    :math:`10^{-7}/c`.  A triple that misses the triangle inequality by less than a
    1e-9th of its longest side counts as linear.  The cost is O(n_triples) after an O(n_points²) check of `distances`.

    References
    ----------
    .. [1] E. Saucan, "Surface triangulation: the metric approach", 2004, section 5;
       K. Menger, "Untersuchungen über allgemeine Metrik IV", Math. Ann. 103 (1930).
    .. [2] W. Kahan, "Miscalculating area and angles of a needle-like triangle", 2014.

    Examples
    --------
    The sides 3, 4, 5 have a circle of radius 5/2:

    >>> import rinow
    >>> rinow.menger_curvature([[0, 3, 5], [3, 0, 4], [5, 4, 0]], [[0, 1, 2]])
    array([0.4])
    """
    curve = as_polyline(as_distance_matrix(distances), distances=True, closed=False)
    T = as_index_tuples(triples, width=3, n_points=len(curve.data), name="triples")
    return curve.roots(curve.menger_squares(T))
