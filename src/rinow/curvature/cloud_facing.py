"""Points that are near to each other across a wall: the surface faces the other way there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.cloud_signs import outward
from rinow.curvature.cloud_stars import agreement, links_of, normals_of, stars_over
from rinow.kernels import clouds

__all__ = ["FEW", "facing"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FEW = 12
"""Points to which the first plane is fitted: two rings would see around edges."""
SIDEWAYS = 0.2
"""Cosine of two normals below which points are on different sides."""


def facing(points: Floats, near: Indices) -> tuple[Indices, Floats]:
    """The nearest points that face the way of their owners, the others replaced by these; how far stars agree then.

    Notes
    -----
    Normals of the planes through few points, with the signs of mirror images, do it a first time; those of the stars
    that follow, a second time.
    """
    normals = np.empty_like(points)
    clouds.plane_normals(points, near, FEW, normals)
    stars = stars_over(points, normals, near)
    normals = outward(points, normals, links_of(stars))
    stars = stars_over(points, normals, _ahead(normals, near), stars)
    normals = normals_of(points, normals, stars, links_of(stars), 1)
    near = _ahead(normals, near)
    return near, agreement(stars_over(points, normals, near, stars))


def _ahead(normals: Floats, near: Indices) -> Indices:
    is_ahead = np.einsum("ikj,ij->ik", normals[near], normals) > SIDEWAYS
    return np.where(is_ahead, near, np.arange(len(near))[:, None])
