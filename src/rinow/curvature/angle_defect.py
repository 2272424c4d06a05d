"""Angle defect over area: the first-order embedding curvature of the star of a vertex, and the usual formula."""

from __future__ import annotations

import numpy as np

from rinow.curvature.estimate import Estimate, Floats
from rinow.kernels import stars
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["angle_defect", "longest_edges", "ring_deviations"]


def angle_defect(mesh: TriangleMesh | IntrinsicMesh) -> Estimate:
    r"""Gaussian curvature of each vertex as its angle defect over a third of the area around it.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface; only edge lengths are used.

    Returns
    -------
    estimate : Estimate
        `gaussian` is nan at the boundary and for a star of area 0.  `radius` is the longest edge of the star.
        `spread` is the standard deviation of the values over the vertex and its neighbours, so it measures
        the scatter of irregular meshes and, besides, how much the curvature itself varies over the star; errors
        that neighbours have in common it does not show.

    Notes
    -----
    The comparison angles of the star in S_k grow at k = 0 by one third of the area, so
    :math:`K = (2\pi - \sum \alpha) / (A/3)` solves :math:`\sum \alpha_k = 2\pi` to first order; `wald` solves it.
    Summed with the areas the values give :math:`2\pi\chi` on a closed surface.  They do not converge on
    irregular meshes: edges are chords, shorter than the geodesics they stand for (see `lifted`).
    """
    area = mesh.vertex_areas
    defined = (area > 0.0) & ~mesh.topology.vertex_is_boundary
    gaussian = np.divide(mesh.vertex_angle_defects, area, out=np.full(mesh.n_vertices, np.nan), where=defined)
    return Estimate(gaussian, ring_deviations(mesh, gaussian), longest_edges(mesh))


def longest_edges(mesh: TriangleMesh | IntrinsicMesh) -> Floats:
    """(n_vertices,): the longest edge at each vertex, nan without a face."""
    t = mesh.topology
    longest = np.empty(mesh.n_vertices)
    stars.longest_edges(mesh.edge_lengths, t.corner_offsets, t.vertex_corners, longest)
    return longest


def ring_deviations(mesh: TriangleMesh | IntrinsicMesh, values: Floats) -> Floats:
    """(n_vertices,): standard deviation of the values at a vertex and its neighbours; a value itself if alone."""
    t = mesh.topology
    deviations = np.empty(mesh.n_vertices)
    stars.ring_deviations(values, t.faces, t.corner_offsets, t.vertex_corners, deviations)
    is_known = np.isfinite(values)
    is_alone = is_known & np.isnan(deviations)
    deviations[is_alone] = np.abs(values[is_alone])
    deviations[~is_known] = np.nan
    return deviations
