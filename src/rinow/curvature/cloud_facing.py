"""Points that are near to each other across a wall: the surface faces the other way there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.cloud_signs import outward
from rinow.curvature.cloud_stars import agreement, first_stars, links_of, normals_of, stars_over
from rinow.kernels import clouds

__all__ = ["facing"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

SIDEWAYS = 0.2
"""Cosine of two normals below which points are on different sides."""


def facing(points: Floats, near: Indices) -> tuple[Indices, Floats]:
    """The nearest points that face the way of their owners, the others replaced by these; how far stars agree then.

    Notes
    -----
    Normals of the planes through few points, with the signs of mirror images, do it a first time; those of the stars
    that follow, a second time.
    """
    normals, stars = first_stars(points, near)
    normals, ahead = outward(points, normals, links_of(stars)), np.empty_like(near)
    clouds.keep_ahead(normals, near, SIDEWAYS, ahead)
    stars = stars_over(points, normals, ahead, stars)
    normals = normals_of(points, normals, stars, links_of(stars), 1)
    clouds.keep_ahead(normals, near, SIDEWAYS, ahead)
    return ahead, agreement(stars_over(points, normals, ahead, stars))
