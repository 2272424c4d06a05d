"""Triangles of a point cloud: those on which the stars of its points agree."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.cloud_holes import taken
from rinow.curvature.cloud_stars import Stars
from rinow.kernels import clouds

__all__ = ["agreed_triangles"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def agreed_triangles(points: Floats, stars: Stars, reach: Floats) -> Indices:
    """Triangles of the stars of points, as many as fit together.

    Parameters
    ----------
    points : (n, 3) ndarray of float
        Positions.
    stars : Stars
        Their stars.
    reach : (n,) ndarray of float
        Distance up to which the points around each one were looked at.

    Returns
    -------
    faces : (n_faces, 3) ndarray of intp
        No directed side is in two of them, so each edge is in two at most and these agree in orientation; where those
        of a point close around it there are no others.

    Notes
    -----
    A triangle of two successive neighbours is known to be Delaunay's if its circle, which may extend to its diameter
    from the point, lies within the reach.  Triangles in the stars of all three corners are taken first, then those of
    two, then of one, small circles before large ones, see `taken`: stars laid over different planes disagree about four
    points on a circle.
    """
    star, counts, n = stars.points, stars.counts, len(points)
    owner, place = np.nonzero(np.arange(star.shape[1]) < counts[:, None])
    corners = np.stack([owner, star[owner, place], star[owner, (place + 1) % counts[owner]]], axis=1)
    diameters = np.empty(len(corners))
    clouds.circle_diameters(points, corners, diameters)
    known = diameters < reach[owner]
    corners, diameters = corners[known], diameters[known]
    first = corners.argmin(axis=1)
    corners = np.take_along_axis(corners, (first[:, None] + np.arange(3)) % 3, axis=1)
    sides = np.unique(corners[:, 0] * n + corners[:, 1], return_inverse=True)[1]
    _, one, votes = np.unique(sides * n + corners[:, 2], return_index=True, return_counts=True)
    return taken(n, corners[one[np.lexsort((diameters[one], -votes))]])
