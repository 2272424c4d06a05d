"""Points of a cloud as small squares in their tangent planes, for pictures that know triangles only."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.study.points import PointStudy

__all__ = ["framed", "normals", "squares"]

Floats = NDArray[np.float64]

OVERLAP = 1.8
"""Side of a square over the root of the area that its point stands for: a cloud without gaps."""


def framed(study: PointStudy) -> NDArray[np.bool_]:
    """(n_points,): finite points in the box of those that have a value, or all finite ones if none has.

    Strays far from everything would make the surface a dot.
    """
    points = study.points
    is_finite: NDArray[np.bool_] = np.all(np.isfinite(points), axis=1, keepdims=False)
    known = points[np.isfinite(study.curvature.gaussian)]
    if not len(known):
        return is_finite
    inside = (points >= known.min(axis=0)) & (points <= known.max(axis=0))
    return is_finite & inside.all(axis=1)


def normals(study: PointStudy) -> Floats:
    """(n_points, 3): unit normals, up to sign; 0 where no directions are known."""
    c = study.curvature
    return np.nan_to_num(np.cross(c.direction1, c.direction2))


def squares(study: PointStudy) -> tuple[Floats, NDArray[np.intp], NDArray[np.intp]]:
    """Squares around the points in the frame.

    Returns
    -------
    vertices : (4 n, 3) ndarray of float
        Corners; those of one point follow each other.
    faces : (2 n, 3) ndarray of intp
        Two triangles for each point.
    owner : (4 n,) ndarray of intp
        The point of each corner.
    """
    shown = np.flatnonzero(framed(study))
    half = 0.5 * OVERLAP * np.sqrt(study.areas[shown])[:, None]
    a, b = study.curvature.direction1[shown], study.curvature.direction2[shown]
    known = np.isfinite(a + b).all(axis=1, keepdims=True)
    a, b = half * np.where(known, a, (1.0, 0.0, 0.0)), half * np.where(known, b, (0.0, 1.0, 0.0))
    corners = study.points[shown, None] + np.stack([a + b, b - a, -a - b, a - b], axis=1)
    faces = 4 * np.arange(len(shown))[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])
    return corners.reshape(-1, 3), faces.reshape(-1, 3), np.repeat(shown, 4)
