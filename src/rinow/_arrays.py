"""The boundary: the only place that coerces and checks arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow import tolerances
from rinow.errors import InvalidInputError, InvalidMeshError, NotAMetricError

__all__ = [
    "as_distance_matrix",
    "as_distances",
    "as_faces",
    "as_floats",
    "as_index",
    "as_index_tuples",
    "as_indices",
    "as_points",
    "as_quadruples",
    "as_radius",
    "bounding_box",
    "in_safe_unit",
    "in_unit",
    "read_only",
    "rows_are_finite",
    "rows_in_own_unit",
]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    """The same array, marked so that nobody writes into it."""
    array.flags.writeable = False
    return array


def as_floats(values: ArrayLike, name: str) -> Floats:
    """Any real numbers as a C-ordered float64 array, masked ones as nan; refuses complex, text and ragged input."""
    given: Any = values
    if hasattr(given, "filled") and given.dtype.kind in "fiu":  # numpy.ma
        given = given.astype(np.float64).filled(np.nan)
    try:
        array = np.asarray(given)
    except (ValueError, TypeError) as error:
        raise InvalidInputError(f"{name} is not an array of numbers: {error}.") from None
    if array.dtype.kind not in "fiu":
        raise InvalidInputError(f"{name} has type {array.dtype}; give real numbers.")
    return np.ascontiguousarray(array, np.float64) if array.ndim else np.asarray(array, np.float64)


def rows_are_finite(rows: Floats) -> NDArray[np.bool_]:
    """(n,): all numbers of a row of an (n, m) array are finite; by columns, for reductions of short rows are slow."""
    finite = np.ones(len(rows), np.bool_)
    for column in rows.T:
        finite &= np.isfinite(column)
    return finite


def bounding_box(points: Floats) -> tuple[Floats, Floats]:
    """Least and greatest coordinates of points (n, d); inf and -inf without any."""
    low = [column.min(initial=np.inf) for column in points.T]
    return np.array(low), np.array([column.max(initial=-np.inf) for column in points.T])


def as_number(value: Any, name: str) -> float:
    """One real number; nan and inf are left to the caller."""
    number = as_floats(value, name)
    if number.ndim:
        raise InvalidInputError(f"{name} has shape {number.shape}; give one number.")
    return float(number)


def as_radius(radius: Any) -> float:
    """A positive length, where the caller may also leave the choice to the data."""
    value = as_floats(radius, "radius")
    if value.ndim or not 0.0 < value < np.inf:
        raise InvalidInputError(f"radius = {radius!r} is not a positive length; leave it out for the default.")
    return float(value)


def in_safe_unit(lengths: Floats) -> tuple[Floats, int]:
    """Lengths divided by a power of two, which is exact, where squares would overflow or vanish; and its exponent."""
    exponent = int(np.frexp(np.max(np.abs(lengths), initial=0.0, where=np.isfinite(lengths)))[1])
    return (lengths, 0) if abs(exponent) <= tolerances.SAFE_EXPONENT else (np.ldexp(lengths, -exponent), exponent)


def rows_in_own_unit(rows: Floats) -> tuple[Floats, NDArray[np.intc]]:
    """(n, m) lengths, each row divided by a power of two near its largest one, which is exact, and the exponents (n,).

    Of lengths far below the largest one of their row digits may be lost.
    """
    exponents = np.frexp(np.max(np.abs(rows), axis=1, initial=0.0, where=np.isfinite(rows)))[1]
    return np.ldexp(rows, -exponents[:, None]), exponents


def in_unit(values: Any, exponent: int | NDArray[np.intc]) -> Any:
    """The values times powers of two; inf where that is no number."""
    with np.errstate(over="ignore"):
        return np.ldexp(values, exponent) if np.any(exponent) else values


def as_points(points: ArrayLike, name: str = "points", dimension: int | None = None) -> Floats:
    """Points as rows of an (n, dimension) array; non-finite coordinates are left to the caller."""
    array = as_floats(points, name)
    if array.ndim != 2 or (dimension is not None and array.shape[1] != dimension):
        width = "d" if dimension is None else dimension
        raise InvalidInputError(f"{name} has shape {array.shape}; give one point per row, shape (n, {width}).")
    return array


def as_indices(values: ArrayLike, n: int, name: str) -> Indices:
    """Integers of any shape, each in [0, n)."""
    array = np.asarray(values)
    if array.size == 0 and array.dtype.kind == "f":
        array = array.astype(np.intp)
    if array.dtype.kind not in "iu":
        raise InvalidInputError(f"{name} has type {array.dtype}; give integer indices.")
    wrong = (array < 0) | (array >= n)
    if wrong.any():
        place = tuple(int(i) for i in np.argwhere(wrong)[0])
        where = f"[{', '.join(map(str, place))}]" if place else ""
        raise InvalidInputError(f"{name}{where} = {array[place]} is outside 0..{n - 1}; indices count from 0.")
    return np.ascontiguousarray(array, np.intp) if array.ndim else np.asarray(array, np.intp)


def as_index(value: Any, n: int, name: str) -> int:
    """One integer in [0, n)."""
    index = as_indices(value, n, name)
    if index.ndim:
        raise InvalidInputError(f"{name} has shape {index.shape}; give one index.")
    return int(index)


def as_index_tuples(values: ArrayLike, *, width: int, n_points: int, name: str) -> Indices:
    """Rows of `width` indices, each in [0, n_points)."""
    array = np.asarray(values)
    if array.size == 0:
        array = array.reshape(-1, width).astype(np.intp)
    if array.ndim != 2 or array.shape[1] != width:
        raise InvalidInputError(f"{name} has shape {array.shape}; give {width} indices per row, shape (n, {width}).")
    return as_indices(array, n_points, name)


def as_faces(faces: ArrayLike, n_vertices: int | None) -> Indices:
    """Faces as a private, read-only copy with every index in range."""
    n = np.iinfo(np.intp).max if n_vertices is None else n_vertices
    array = np.asarray(faces)
    if array.size == 0:
        raise InvalidMeshError(
            "faces is empty; a mesh has at least one face (point clouds have point_cloud_curvature)."
        )
    if array.ndim == 2 and array.shape[1] == 4:
        raise InvalidMeshError(f"faces has shape {array.shape}; split quadrilaterals into triangles first.")
    F = as_index_tuples(array, width=3, n_points=n, name="faces")
    return read_only(np.array(F, order="C"))


def as_quadruples(quadruples: ArrayLike) -> tuple[tuple[int, ...], Floats]:
    """Leading shape, and the distances d12, d13, d14, d23, d24, d34 as rows (n, 6); their values are not checked."""
    Q = as_floats(quadruples, "quadruples")
    if Q.shape[-1:] != (6,):
        raise InvalidInputError(
            f"quadruples has shape {Q.shape}; give d12, d13, d14, d23, d24, d34 in the last axis, shape (..., 6)."
        )
    return Q.shape[:-1], Q.reshape(-1, 6)


def as_distances(distances: Any, name: str = "distances") -> Floats:
    """Distances as numbers; a metric space stands for its matrix."""
    return as_floats(getattr(distances, "distances", distances), name)


def as_distance_matrix(
    distances: ArrayLike, *, rtol: float = tolerances.METRIC_TRIANGLE_INEQUALITY, name: str = "distances"
) -> Floats:
    """A square, finite, non-negative, exactly symmetric matrix with zero diagonal.

    The triangle inequality is left to `MetricSpace`, which has the compiled test and finds the worst triple.
    """
    D = as_distances(distances, name)
    if D.size == 0:
        raise InvalidInputError(f"{name} is empty; a metric space has at least one point.")
    if D.ndim != 2 or D.shape[0] != D.shape[1]:
        raise InvalidInputError(f"{name} has shape {D.shape}; give a square matrix (see MetricSpace.from_points).")
    _refuse(~np.isfinite(D), D, name, "is not finite; replace or remove the point")
    _refuse(D < 0, D, name, "is negative; distances are not")
    scale = float(D.max())
    _refuse(np.abs(D - D.T) > rtol * scale, D, name, "differs from its transpose; symmetrise the matrix or raise rtol")
    _refuse((np.abs(D) > rtol * scale) & np.eye(len(D), dtype=bool), D, name, "is on the diagonal and must be 0")
    D = np.where(D == D.T, D, 0.5 * D + 0.5 * D.T)  # halved first: a sum of the largest numbers is none
    np.fill_diagonal(D, 0.0)
    return D


def _refuse(wrong: NDArray[np.bool_], D: Floats, name: str, fault: str) -> None:
    """Raise `NotAMetricError` for the first wrong entry."""
    if wrong.any():
        i, j = (int(x) for x in np.argwhere(wrong)[0])
        raise NotAMetricError(f"{name}[{i}, {j}] = {D[i, j]:.17g} {fault}.", witness=(i, j))
