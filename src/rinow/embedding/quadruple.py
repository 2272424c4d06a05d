"""Metric quadruples: the surfaces of constant curvature they embed in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow import tolerances
from rinow._arrays import as_floats, as_quadruples
from rinow._printing import OneLine
from rinow.errors import InvalidInputError
from rinow.kernels import comparison_angles
from rinow.kernels import embedding_curvatures as kernels
from rinow.kernels import quadruples as relations

__all__ = ["EmbeddingCurvatures", "embedding_curvatures", "is_linear", "is_planar"]

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

KINDS = np.array(["", "nonplanar", "planar", "semidependent", "boundary"])


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EmbeddingCurvatures(OneLine):
    """All embedding curvatures of a batch of quadruples.

    Attributes
    ----------
    values : (..., 2) ndarray of float
        Curvatures in 1/length², ascending, padded with nan.
    count : (...) ndarray of int
        How many there are: 0, 1 or 2; -1 for a continuum, -2 for a row that is not a metric.
    kind : (..., 2) ndarray of str
        "nonplanar": the points are the corners of a convex quadrilateral.  "planar": the angles at one of them sum to
        2π.  "semidependent": one lies between two others.  "boundary": the largest curvature that the perimeters
        allow; a triple is a great circle, or two triples are linear with the same ends.  "" beside a nan.
    condition : (..., 2) ndarray of float
        Largest absolute derivative of the value in one of the distances, times diameter³: no unit.  Rounding the
        distances moves a value by about condition · 1e-16 / diameter².
    """

    values: Floats
    count: NDArray[np.intp]
    kind: NDArray[np.str_]
    condition: Floats


def embedding_curvatures(quadruples: ArrayLike) -> EmbeddingCurvatures:
    r"""All curvatures k such that four points with given distances exist in the surface S_k.

    S_k is the sphere, plane or hyperbolic plane of constant curvature k.  There are two values in general, a convex
    quadrilateral at the smaller and a triangle with a point inside at the larger one.

    Parameters
    ----------
    quadruples : (..., 6) array_like of float
        Distances d12, d13, d14, d23, d24, d34, in any unit of length.

    Returns
    -------
    EmbeddingCurvatures
        `values`, `count`, `kind` and `condition`.  One value: one or two triples are linear, or the two largest of the
        sums d12 + d34, d13 + d24, d14 + d23 are equal, as in a tree.  None: two linear triples branch off at
        their common middle point.  A continuum, every k up to a bound: the four points are on a line, or two coincide.
        Other rows are computed where one is not a metric (nan, inf, negative, or failing the triangle inequality by
        more than 1e-9 of the diameter).

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong.

    See Also
    --------
    robinson_curvature : A rational approximation for quadruples with a linear triple.

    Notes
    -----
    The larger value is where the three angles at some point, each increasing in k, sum to 2π; the smaller one where,
    at the same point, the angle between two neighbours equals the sum of its parts [1]_.  Both equations are
    solved by Newton's method, written in logarithms of the cotangents of half angles: they have simple
    roots wherever the values are, however near to each other, to 0 or to -inf.  The determinant
    :math:`\det\cos(\sqrt k d_{ij})` of the literature has double roots for linear triples.
    A triple is taken as linear if its excess is below 1e-13 of its shortest side, or of 1/100 of its longest one.
    Departure from [2]_: the embedding curvature is not unique, and a quadruple with a linear triple may have none.

    References
    ----------
    .. [1] L. M. Blumenthal, K. Menger, "Studies in Geometry", 1970, part 3.
    .. [2] E. Saucan, "Surface Triangulation - the Metric Approach", 2004, section 3.

    Examples
    --------
    The unit square is flat, and is also a triangle with an inner point on a sphere:

    >>> r = 2**0.5
    >>> result = embedding_curvatures([1, r, 1, 1, r, 1])
    >>> print(abs(result.values).round(8), result.kind)
    [0.         2.89244795] ['nonplanar' 'planar']

    Three branches from one point embed in no surface, four points on a line in many:

    >>> embedding_curvatures([[1, 1, 1, 2, 2, 2], [1, 2, 3, 1, 2, 1]]).count
    array([ 0, -1])
    """
    shape, Q = as_quadruples(quadruples)
    n = len(Q)
    values, condition = np.empty((n, 2)), np.empty((n, 2))
    count, kinds = np.empty(n, np.intp), np.empty((n, 2), np.int8)
    kernels.all_embedding_curvatures(Q, values, count, kinds, condition)
    return EmbeddingCurvatures(
        values.reshape(*shape, 2), count.reshape(shape), KINDS[kinds].reshape(*shape, 2), condition.reshape(*shape, 2)
    )


def is_linear(quadruples: ArrayLike) -> Flags:
    """Whether the four points of a quadruple lie on a line.

    Parameters
    ----------
    quadruples : (..., 6) array_like of float
        Distances d12, d13, d14, d23, d24, d34.

    Returns
    -------
    is_linear : (...) ndarray of bool
        False for a row that is not a metric, and for four points of a circle in which every triple is linear
        (d12 = d34, d23 = d14, d13 = d24 = d12 + d23).

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong.

    Examples
    --------
    >>> is_linear([[1, 2, 3, 1, 2, 1], [1, 3, 2, 2, 3, 1]])
    array([ True, False])
    """
    shape, Q = as_quadruples(quadruples)
    codes, orders = np.empty(len(Q), np.int8), np.empty((len(Q), 4), np.intp)
    relations.relations(Q, codes, orders)
    return (codes == relations.LINEAR).reshape(shape)[()]


def is_planar(quadruples: ArrayLike, curvature: ArrayLike, *, atol: float = tolerances.PLANAR_ANGLE) -> Flags:
    """Whether the angles at one point of a quadruple sum to 2π in the surface of constant curvature.

    A planar quadruple embeds in that surface and in none of larger curvature; one that embeds without being
    planar, embeds in none of smaller curvature.

    Parameters
    ----------
    quadruples : (..., 6) array_like of float
        Distances d12, d13, d14, d23, d24, d34.
    curvature : (...) array_like of float
        Curvature of the surface in 1/length²; its shape and that of the quadruples are broadcast.
    atol : float, default 1e-7
        Rounding allowed in the sum, in radians; angles near π have half of the digits of the distances.

    Returns
    -------
    is_planar : (...) ndarray of bool
        False for a row that is not a metric or does not fit into the surface, or with two points at distance 0.

    Raises
    ------
    InvalidInputError
        If a shape or a type is wrong.

    Examples
    --------
    The unit square at its two embedding curvatures:

    >>> r = 2**0.5
    >>> is_planar([1, r, 1, 1, r, 1], [0.0, 2.892447948459])
    array([False,  True])
    """
    head, Q = as_quadruples(quadruples)
    k = as_floats(curvature, "curvature")
    try:
        shape = np.broadcast_shapes(head, k.shape)
    except ValueError:
        raise InvalidInputError(f"quadruples and curvature have shapes {head} and {k.shape}; make them fit.") from None
    Q = np.broadcast_to(Q.reshape(*head, 6), (*shape, 6)).reshape(-1, 6)
    out = np.empty(len(Q), np.bool_)
    comparison_angles.planarities(np.ascontiguousarray(Q), np.broadcast_to(k, shape).ravel(), float(atol), out)
    return out.reshape(shape)[()]
