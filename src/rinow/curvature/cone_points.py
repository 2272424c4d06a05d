"""Cone points: vertices where a finite curvature sits at one point, found from edge lengths alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.stencils import N_BLOCKS
from rinow.kernels import cone_points
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["LEAST_DEFECT", "cone_defects"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

LEAST_DEFECT = 0.08
"""Defect in radians below which nothing is called a cone point: half-angles up to 81°."""
DEFECT_NOISE = 12.0
"""The same in standard deviations of the defects around: the tails of noise beside a crease are long."""
OWN_SHARE, RIVAL_SHARE = 0.6, 2.0
"""Least share of the defect of the disc that is at the vertex itself, and how far it exceeds any other one there.
A tip rounded over two edge lengths has a fifth of it."""


def cone_defects(mesh: TriangleMesh | IntrinsicMesh, closed: Bools) -> tuple[Indices, Floats]:
    """Cone points away from closed vertices, ascending, and the defects concentrated at them.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface.
    closed : (n_vertices,) ndarray of bool
        Vertices whose defect belongs to a boundary or a crease.  Discs do not grow onto them.

    Returns
    -------
    points : (k,) ndarray of intp
        The cone points.
    defects : (k,) ndarray of float
        2π minus the cone angle: what a disc of two rings has beyond the curvature of the surface around.
    """
    t, defects = mesh.topology, mesh.vertex_angle_defects
    candidates = np.flatnonzero((np.abs(defects) > LEAST_DEFECT) & ~closed)
    excess, noise, rival = (np.empty(len(candidates)) for _ in range(3))
    cone_points.cone_defects(
        candidates,
        t.neighbour_offsets,
        t.neighbours,
        closed,
        defects,
        mesh.scaled_vertex_areas,
        N_BLOCKS,
        excess,
        noise,
        rival,
    )
    own = defects[candidates]
    found = (np.abs(excess) > np.maximum(LEAST_DEFECT, DEFECT_NOISE * noise)) & (own * excess > 0.0)
    found &= (np.abs(own) > OWN_SHARE * np.abs(excess)) & (np.abs(own) > RIVAL_SHARE * rival)
    return candidates[found], excess[found]
