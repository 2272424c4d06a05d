"""The curvature of a cloud of points as users want to read it."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from rinow.curvature.point_cloud import point_cloud_curvature
from rinow.study.surface import CurvatureStudy

__all__ = ["PointStudy", "point_counts", "study_points"]

Floats = NDArray[np.float64]

N_AROUND = 8
"""Points around each one whose farthest tells how densely they lie."""


@dataclass(frozen=True, slots=True)
class PointStudy(CurvatureStudy):
    """Curvature at the points of a cloud, and the points.

    Attributes
    ----------
    points : (n_points, 3) ndarray of float
        The points, unchanged.
    """

    points: Floats = field(kw_only=True)
    place: ClassVar[str] = "point"
    places: ClassVar[str] = "points"

    @property
    def positions(self) -> Floats:
        """(n_points, 3): the points."""
        return self.points

    @property
    def areas(self) -> Floats:
        """(n_points,): area around each point, by the circle that reaches to its eighth neighbour.

        Repeated points share one; those without a value, which may be far from all others, have the median at most.
        """
        areas, finite = np.zeros(len(self.points)), np.isfinite(self.points).all(axis=1)
        distinct, place, counts = np.unique(self.points[finite], axis=0, return_inverse=True, return_counts=True)
        if len(distinct) < 2:
            return areas
        k = min(N_AROUND, len(distinct) - 1)
        farthest = np.asarray(KDTree(distinct).query(distinct, k + 1)[0])[:, -1]
        areas[finite] = (np.pi / (k + 0.5) * farthest**2 / counts)[place.ravel()]
        is_unknown = np.isnan(self.curvature.gaussian)
        areas[is_unknown] = np.minimum(areas[is_unknown], np.median(areas[finite]))
        return areas


def point_counts(points: Floats) -> dict[str, int]:
    """Counts that describe a cloud and its faults."""
    finite = points[np.isfinite(points).all(axis=1)]
    return {
        "points": len(points),
        "faces": 0,
        "repeated_points": len(finite) - len(np.unique(finite, axis=0)),
        "nonfinite_points": len(points) - len(finite),
    }


def study_points(points: Floats, *, radius: float | None = None, unit: str = "length") -> PointStudy:
    """Compute the curvature of a cloud of points and time it.

    Parameters
    ----------
    points : (n_points, 3) ndarray of float
        Positions.
    radius : float, optional
        As for `rinow.point_cloud_curvature`.
    unit : str, optional
        Name of the unit of length of the positions.

    Returns
    -------
    study : PointStudy
        The curvature and what is needed to read it.
    """
    start = time.perf_counter()
    curvature = point_cloud_curvature(points, radius=radius)
    settings: dict[str, str | float | None] = {"radius": radius}
    return PointStudy(curvature, unit, {"curvature": time.perf_counter() - start}, settings, points=points)
