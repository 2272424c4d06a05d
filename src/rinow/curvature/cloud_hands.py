"""Which hand a part of a cloud has: its mirror image has the other one, so that a choice by it is no choice of ours."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from rinow.kernels import cloud_hands

__all__ = ["hands"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FEWER = 20
"""Points around each one that tell."""
SYMMETRIC = 1e-9
"""Share of the terms of a sum that do not cancel below which a part is its own mirror image up to rounding."""


def hands(points: Floats, normals: Floats, near: Indices, links: csr_array) -> Floats:
    r"""1 or -1 for each point, the same over a connected part, and the other one in the mirror image of a cloud.

    Parameters
    ----------
    points, normals : (n, 3) ndarray of float
        Positions, and unit normals that agree between neighbours.
    near : (n, k) ndarray of intp
        The points nearest to each one.
    links : (n, n) csr_array
        Which points are neighbours: these make a part.

    Returns
    -------
    hands : (n,) ndarray of float
        As seen against the normals: opposite normals have opposite hands.  A part that is its own mirror image has 1.

    Notes
    -----
    With the nearest twenty points at z = x + iy in the tangent plane and weights w that vanish at the last one, the
    sign is that of the sum of the imaginary parts of :math:`\sum w z^4\,(\sum w \bar z^2)^2` over the part: how the
    axes of order 4 of the points around are turned against those of order 2.
    """
    terms = np.empty((len(points), 2))
    cloud_hands.turns(points, normals, near[:, :FEWER], terms)
    labels = connected_components(links, directed=False)[1]
    sums, sizes = np.bincount(labels, terms[:, 0]), np.bincount(labels, terms[:, 1])
    return np.where(sums < -SYMMETRIC * sizes, -1.0, 1.0)[labels]
