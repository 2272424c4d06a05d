"""Points of a cloud that lie beside the surface, such as stray returns of a scanner."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.cloud_sheet import NEAREST
from rinow.curvature.stencils import N_BLOCKS
from rinow.kernels import cloud_strays, clouds

__all__ = ["stray_points"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FAR = 3.0
"""Distance of the nearest points, over the same of these, from which a point is far from everything."""
N_NEAR, ALONE = 8, 2
"""Points whose mean distance that is, and how many of them may lie beside the surface as well: more are a sheet of
their own, at a crease or beside another one."""
DEVIATIONS, SPACINGS = 14.0, 0.3
"""Offset from the surface that is no noise: in median residuals (eight standard deviations of noise), in spacings."""


def stray_points(points: Floats, distances: Floats, near: Indices) -> Bools:
    """(n_points,): the point is far from all others, or alone beside the quadric that fits those around it.

    Parameters
    ----------
    points : (n_points, 3) ndarray of float
        Positions.
    distances, near : (n_points, k) ndarray of float, intp
        Distances and indices of the points nearest to each one, itself not among them.

    Notes
    -----
    The quadric is that of least moduli, which a few strays do not bend, through the nearest points without the
    point itself.  A curved surface of few points leaves residuals too; their median, over the points around, raises
    the limit.  None is called stray where fewer than 36 points are looked at.
    """
    n, k = near.shape
    if k < NEAREST:
        return np.zeros(n, np.bool_)
    close = distances[:, :N_NEAR].mean(axis=1)
    is_far = close > FAR * np.median(close[near[:, :N_NEAR]], axis=1)
    normals, offsets, middles = np.empty_like(points), np.empty(n), np.empty(n)
    clouds.plane_normals(points, near, normals)
    cloud_strays.offsets(points, normals, near, distances[:, -1], N_BLOCKS, offsets, middles)
    spacing = np.sqrt(np.pi / (k + 0.5)) * distances[:, -1]
    is_beside = offsets > np.maximum(DEVIATIONS * np.median(middles[near], axis=1), SPACINGS * spacing)
    return is_far | (is_beside & (np.count_nonzero(is_beside[near[:, :N_NEAR]], axis=1) <= ALONE))
