"""Curves as lists of points: what the curvatures of curves have in common."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow import tolerances
from rinow._arrays import as_distance_matrix, as_distances, as_points, in_safe_unit, in_unit
from rinow.errors import InvalidInputError
from rinow.kernels import polylines

__all__ = ["Polyline", "as_polyline"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class Polyline:
    """Points in order along a curve, known by coordinates or by all their distances."""

    data: Floats
    """(n_points, dimension) coordinates, finite or nan, or (n_points, n_points) distances."""
    are_distances: bool
    """What `data` holds."""
    closed: bool
    """Whether the last point is followed by the first."""
    exponent: int = 0
    """`data` are in the unit 2^exponent: their squares neither overflow nor vanish."""

    def windows(self, reach: int) -> Indices:
        """(n_points, 2 m + 1) consecutive points around each point, m = `reach` or less on a short curve.

        Near the ends of an open curve the window is moved inwards, so that it still holds the point.
        """
        if reach < 1:
            raise InvalidInputError(f"reach = {reach} leaves no neighbours; give the number of points on either side.")
        n = len(self.data)
        m = max(min(reach, (n - 1) // 2), 0)
        start = np.arange(n) - m
        if not self.closed:
            start = np.clip(start, 0, max(n - 1 - 2 * m, 0))
        return (start[:, None] + np.arange(2 * m + 1)) % max(n, 1)

    def menger_squares(self, triples: Indices) -> Floats:
        """Squares of the Menger curvature of triples (..., 3) of points."""
        squares = np.empty(triples.shape[:-1])
        polylines.menger_squares(self.data, self.are_distances, triples.reshape(-1, 3), squares.reshape(-1))
        return squares

    def roots(self, squares: Floats) -> Floats:
        """Curvatures in the user's unit from their squares; 0 if rounding or extrapolation has made one negative."""
        return np.asarray(in_unit(np.sqrt(np.maximum(squares, 0.0)), -self.exponent))

    def chords(self, i: Indices, j: Indices) -> Floats:
        """Distances of the points i and j."""
        return self.data[i, j] if self.are_distances else np.linalg.norm(self.data[i] - self.data[j], axis=-1)


def as_polyline(points: ArrayLike, *, distances: bool | None, closed: bool) -> Polyline:
    """Points or, if `distances`, their distance matrix; if None, a matrix that can be one is one."""
    data = as_distances(points, "points")
    if distances is None:
        distances = _may_be_distances(data)
    if distances:
        data, exponent = in_safe_unit(as_distance_matrix(data, name="points"))
        return Polyline(data, True, closed, exponent)
    data = as_points(data)
    data, exponent = in_safe_unit(np.where(np.isfinite(data), data, np.nan))
    return Polyline(data, False, closed, exponent)


def _may_be_distances(data: Floats) -> bool:
    """Whether a matrix is square and symmetric with zero diagonal; nan passes, to be refused as a distance."""
    if data.ndim != 2 or data.shape[0] != data.shape[1] or not len(data):
        return False
    tolerance = tolerances.METRIC_TRIANGLE_INEQUALITY * np.abs(data[np.isfinite(data)]).max(initial=0.0)
    with np.errstate(invalid="ignore"):
        differs = np.abs(data - data.T) > tolerance
    return not (differs.any() or (np.abs(np.diagonal(data)) > tolerance).any())
