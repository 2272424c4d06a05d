"""Wald's embedding curvature of the star of a vertex."""

from __future__ import annotations

import numpy as np

from rinow.curvature.angle_defect import longest_edges, ring_deviations
from rinow.curvature.estimate import Estimate
from rinow.kernels import stars
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["wald"]

N_BLOCKS = 64


def wald(mesh: TriangleMesh | IntrinsicMesh) -> Estimate:
    r"""Curvature k of the surface S_k in which the star of each vertex closes up.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface; only edge lengths are used.

    Returns
    -------
    estimate : Estimate
        `gaussian` is nan at the boundary, at vertices that are not manifold, and where no S_k closes the star
        (a spike too sharp, or two triangles that are segments through the vertex).  `radius` and `spread` as for
        `angle_defect`.

    Notes
    -----
    The value is the only k with :math:`\sum \alpha_k = 2\pi`, the sum over the angles at the vertex of triangles
    with the given sides in S_k [1]_.  Each angle increases with k.  The bracket is :math:`(2\pi/P)^2`, P the largest
    perimeter, where a triangle becomes a great circle, and on the other side -1, -4, -16, ... over P².
    The cost is about five angles and derivatives for each corner.

    References
    ----------
    .. [1] A. Wald, "Begründung einer koordinatenlosen Differentialgeometrie der Flächen", Ergebnisse eines
       mathematischen Kolloquiums 7 (1936).
    """
    t = mesh.topology
    gaussian = np.empty(mesh.n_vertices)
    is_closed = t.vertex_is_manifold & ~t.vertex_is_boundary
    stars.vertex_star_curvatures(mesh.edge_lengths, t.corner_offsets, t.vertex_corners, is_closed, N_BLOCKS, gaussian)
    return Estimate(gaussian, ring_deviations(mesh, gaussian), longest_edges(mesh))
