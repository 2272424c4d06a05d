"""Simplices from their edge lengths: determinant, volume, circumradius, and the tests they give."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow import tolerances
from rinow._arrays import as_distances
from rinow.errors import InvalidInputError
from rinow.kernels import determinants

__all__ = [
    "cayley_menger_determinant",
    "circumradius",
    "is_cospherical",
    "is_euclidean_simplex",
    "simplex_volume",
]

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


def cayley_menger_determinant(distances: ArrayLike) -> Floats:
    r"""Bordered determinant of the squared distances of n points.

    Parameters
    ----------
    distances : (..., n, n) array_like of float
        Symmetric matrices of lengths with zero diagonal; the triangle inequality is not needed.

    Returns
    -------
    determinant : (...) ndarray of float
        In length^(2n - 2): :math:`(-1)^n 2^{n-1} ((n-1)!\,V)^2` for a simplex of volume V, so 2d² for two points,
        -16 area² for three and 288 V² for four; inf of its sign or 0 where it leaves the range of numbers, as for
        four points beyond lengths of 1e51 or below 1e-54.  It is nan for a matrix with a negative, undefined or
        asymmetric entry or a diagonal that is not 0.

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong.

    See Also
    --------
    simplex_volume : The volume itself, where there is a simplex.

    Notes
    -----
    The border is a row and a column of ones with a 0 in the corner [1]_.  The value is computed as
    :math:`(-1)^n 2^{n-1} L^2 \det h` from the inner products h perpendicular to the longest edge L, whose error is a
    few roundings of L².  The paper this package follows states the sign conditions reversed: a simplex exists if the
    determinant of every k of its points has the sign :math:`(-1)^k`.

    References
    ----------
    .. [1] L. M. Blumenthal, "Theory and Applications of Distance Geometry", 1953, chapter IV.

    Examples
    --------
    The regular tetrahedron of edge 1:

    >>> float(round(cayley_menger_determinant(1 - np.eye(4)), 12))
    4.0
    """
    shape, D, exponents = _as_simplices(distances)
    n = D.shape[1]
    if n == 4:
        out = np.empty(len(D))
        determinants.cayley_menger_4s(D, out)
    else:
        length, H, _ = _perpendicular_parts(D)
        border = length**2 if n > 1 else 1.0 + length
        out = (-1.0) ** n * 2.0 ** (n - 1) * border * np.linalg.det(H)
    return _in_unit(out, 2 * (n - 1) * exponents).reshape(shape)[()]


def simplex_volume(distances: ArrayLike) -> Floats:
    r"""Volume of the Euclidean simplex with given edge lengths.

    Parameters
    ----------
    distances : (..., n, n) array_like of float
        Distances of the n corners.

    Returns
    -------
    volume : (...) ndarray of float
        In length^(n - 1): the length of two points, the area of three; 0 for a flat simplex, 1 for one point, nan
        where no simplex has these edges.

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong.

    See Also
    --------
    cayley_menger_determinant, is_euclidean_simplex

    Notes
    -----
    Its square is :math:`|D| / (2^{n-1} (n-1)!^2)` with the bordered determinant D, in range also where D is not.

    Examples
    --------
    >>> float(round(simplex_volume([[0, 3, 4], [3, 0, 5], [4, 5, 0]]), 12))
    6.0
    """
    shape, D, exponents = _as_simplices(distances)
    length, H, _ = _perpendicular_parts(D)
    if D.shape[1] == 1:
        return (1.0 + length).reshape(shape)[()]
    squared = np.maximum(np.linalg.det(H), 0.0)
    volume = length * np.sqrt(squared) / math.factorial(D.shape[1] - 1)
    is_simplex = _least_height(H) >= -_flatness(D, length)
    volume = _in_unit(volume, (D.shape[1] - 1) * exponents)
    return np.where(is_simplex, volume, np.nan).reshape(shape)[()]


def circumradius(distances: ArrayLike) -> Floats:
    r"""Radius of the sphere through the corners of a Euclidean simplex.

    Parameters
    ----------
    distances : (..., n, n) array_like of float
        Distances of the n corners.

    Returns
    -------
    radius : (...) ndarray of float
        Half the length for two points, 0 for one; inf for a flat simplex (of height below 5e-8 of the longest edge,
        where rounding hides it), nan where no simplex has these edges.

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong.

    See Also
    --------
    is_cospherical : Whether one point more lies on the sphere.

    Notes
    -----
    Its square is -Δ/(2D) [1]_, with the determinant Δ of the squared distances and the bordered determinant D, in every
    dimension; computed as :math:`L^2/4 + r^T h^{-1} r` without cancellation, where the longest edge L and the
    perpendicular inner products h fix the centre.

    References
    ----------
    .. [1] E. Saucan, "Surface Triangulation - the Metric Approach", 2004, Theorem 7.1.

    Examples
    --------
    >>> float(circumradius([[0, 3, 4], [3, 0, 5], [4, 5, 0]]))
    2.5
    """
    shape, D, exponents = _as_simplices(distances)
    length, H, moments = _perpendicular_parts(D)
    least, flat = _least_height(H), _flatness(D, length)
    H[~(least > flat)] = np.eye(H.shape[1])
    centre = np.linalg.solve(H, moments[..., None])[..., 0]
    radius = _in_unit(np.sqrt(length**2 / 4 + (moments * centre).sum(axis=1)), exponents)
    return np.select([least > flat, least >= -flat], [radius, np.inf], np.nan).reshape(shape)[()]


def is_euclidean_simplex(distances: ArrayLike) -> Flags:
    """Whether n points with these distances span a simplex of dimension n - 1.

    Parameters
    ----------
    distances : (..., n, n) array_like of float
        Distances of the n points.

    Returns
    -------
    is_simplex : (...) ndarray of bool
        False for a flat simplex (of height below 5e-8 of the longest edge) and for a matrix that is no symmetric
        matrix of lengths.

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong.

    Notes
    -----
    For four points that satisfy the triangle inequality this is a positive `cayley_menger_determinant`.  Theorem 4.3 of
    the paper prints the signs the other way round and leaves out the determinant of all four points.

    Examples
    --------
    Corners of a square span no tetrahedron; three branches from one point fit into no Euclidean space:

    >>> r = 2**0.5
    >>> bool(is_euclidean_simplex([[0, 1, r, 1], [1, 0, 1, r], [r, 1, 0, 1], [1, r, 1, 0]]))
    False
    >>> bool(is_euclidean_simplex([[0, 1, 1, 1], [1, 0, 2, 2], [1, 2, 0, 2], [1, 2, 2, 0]]))
    False
    """
    shape, D, _ = _as_simplices(distances)
    length, H, _ = _perpendicular_parts(D)
    if D.shape[1] == 1:
        return np.isfinite(length).reshape(shape)[()]
    return ((_least_height(H) > _flatness(D, length)) & (length > 0)).reshape(shape)[()]


def is_cospherical(distances: ArrayLike, rtol: float = 1e-9) -> Flags:
    r"""Whether n points of a Euclidean space of dimension n - 2 lie on a sphere or a hyperplane.

    Parameters
    ----------
    distances : (..., n, n) array_like of float
        Distances of n >= 3 points.
    rtol : float, default 1e-9
        Rounding allowed in the distances, relative to the largest one.

    Returns
    -------
    is_cospherical : (...) ndarray of bool
        False also for points that need n - 1 dimensions or fit into no Euclidean space.

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong or n < 3.

    Notes
    -----
    Four points are on a circle or a line, five on a sphere or a plane, if the determinant Δ of their squared
    distances is 0.  That determinant is the square of the quantity of interest, and hides half the digits; tested
    here is :math:`\sum u_i d_{0i}^2 = 0` for the affine dependence u of the points (:math:`\sum u_i p_i = 0`,
    :math:`\sum u_i = 0`), a null vector of the Gram matrix.

    Examples
    --------
    The square is on a circle, a triangle with its centre is not:

    >>> r, s = 2**0.5, 3**-0.5
    >>> square = [[0, 1, r, 1], [1, 0, 1, r], [r, 1, 0, 1], [1, r, 1, 0]]
    >>> centred = [[0, 1, 1, s], [1, 0, 1, s], [1, 1, 0, s], [s, s, s, 0]]
    >>> is_cospherical([square, centred])
    array([ True, False])
    """
    shape, D, _ = _as_simplices(distances)
    if D.shape[1] < 3:
        raise InvalidInputError(f"distances has shape {shape + D.shape[1:]}; give at least 3 points.")
    length, _, _ = _perpendicular_parts(D)
    proper = length > 0
    E = np.square(np.where(proper[:, None, None], D, 0.0) / np.where(proper, length, 1.0)[:, None, None])
    gram = (E[:, 1:, :1] + E[:, :1, 1:] - E[:, 1:, 1:]) / 2
    values, vectors = np.linalg.eigh(gram)
    dependence = vectors[:, :, 0]
    power = np.abs((dependence * E[:, 0, 1:]).sum(axis=1)) / np.abs(dependence).sum(axis=1)
    flat = (length >= 0) & (np.abs(values[:, 0]) <= rtol)
    return (flat & ((values[:, 1] <= rtol) | (power <= rtol))).reshape(shape)[()]


def _as_simplices(distances: ArrayLike) -> tuple[tuple[int, ...], Floats, NDArray[np.intc]]:
    """Leading shape, the matrices as one stack, each over a power of two near its largest entry, and the exponents.

    So scaled, products of lengths are numbers; no bit of a length changes, but for those lost in the scale of others.
    """
    D = as_distances(distances)
    if D.ndim < 2 or D.shape[-1] != D.shape[-2] or D.shape[-1] == 0:
        raise InvalidInputError(f"distances has shape {D.shape}; give square matrices, shape (..., n, n) with n >= 1.")
    shape, D = D.shape[:-2], D.reshape(-1, *D.shape[-2:])
    largest = np.max(np.abs(D), axis=(1, 2), initial=0.0, where=np.isfinite(D))
    exponents = np.frexp(largest)[1]
    return shape, np.ldexp(D, -exponents[:, None, None]), exponents


def _in_unit(values: Floats, exponents: NDArray[np.intc]) -> Floats:
    """Values computed from scaled lengths, in the unit of the given ones."""
    with np.errstate(over="ignore", under="ignore"):
        return np.ldexp(values, exponents)


def _perpendicular_parts(D: Floats) -> tuple[Floats, Floats, Floats]:
    """Longest edge (nan for a wrong matrix), inner products perpendicular to it, and the moments of the centre."""
    m = max(D.shape[1] - 2, 0)
    length, H, moments = np.empty(len(D)), np.empty((len(D), m, m)), np.empty((len(D), m))
    determinants.perpendicular_grams(D, length, H, moments)
    return length, H, moments


def _least_height(H: Floats) -> Floats:
    """Smallest eigenvalue: squared height of the simplex in its flattest direction; inf where it has none."""
    return np.asarray(np.linalg.eigvalsh(H)[:, 0], np.float64) if H.shape[1] else np.full(len(H), np.inf)


def _flatness(D: Floats, length: Floats) -> Floats:
    """Squared height up to which a simplex is flat; a triangle may be a needle, its heights keep their digits."""
    shortest = np.minimum(D[:, 1:, 0].min(axis=1), D[:, 1, 2]) if D.shape[1] == 3 else length
    return tolerances.FLAT_SIMPLEX * length * shortest
