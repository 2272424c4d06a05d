"""The curvature of a cloud of points as users want to read it."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.point_cloud import point_cloud_curvature
from rinow.study.surface import CurvatureStudy

__all__ = ["PointStudy", "point_counts", "study_points"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PointStudy(CurvatureStudy):
    """Curvature at the points of a cloud, and the points.

    Attributes
    ----------
    points : (n_points, 3) ndarray of float
        The points, unchanged.
    """

    points: Floats = field(kw_only=True)
    places: ClassVar[str] = "points"


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
    return PointStudy(curvature, unit, {"curvature": time.perf_counter() - start}, points=points)
