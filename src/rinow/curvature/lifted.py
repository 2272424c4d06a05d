"""Curvature from edges lifted to the lengths of the arcs they stand for."""

from __future__ import annotations

import numpy as np

from rinow.curvature.angle_defect import longest_edges, ring_deviations
from rinow.curvature.estimate import Estimate, Floats
from rinow.curvature.stencils import N_BLOCKS, empty_frames, stencil_surface
from rinow.kernels import curves, quadrics, stars, triangles
from rinow.mesh import TriangleMesh

__all__ = ["lifted"]

SWEEPS = 2
"""Corrections towards Gauss's weights: the first two halve the error each, a third changes little."""


def lifted(mesh: TriangleMesh) -> Estimate:
    r"""Gaussian curvature from the angles of triangles whose sides are arcs instead of chords.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    estimate : Estimate
        `gaussian` from the metric of the lifted edges; `mean` and the directions from a quadric fitted to two
        rings; `k1` and `k2` from both, :math:`H \pm \sqrt{\max(H^2 - K, 0)}`.  At the boundary and where the
        star is not one closed fan everything comes from the quadric.  `radius` and `spread` as for `angle_defect`.

    Notes
    -----
    A chord of length c of an arc of curvature κ is shorter than the arc by κ²c³/24 (Haantjes), an error as large
    as the effect of K on a triangle; this is why the angle defect does not converge.  Here κ of an edge is the
    turning of the normal along it, :math:`(n_j - n_i) \cdot (p_j - p_i) / c^2`, with the normals of the quadrics.
    A geodesic triangle exceeds the angles of its comparison triangle so that the defect at i is
    :math:`\sum (2 K_i + K_j + K_k) A / 12` over its faces [1]_; two sweeps of iterative refinement solve this.
    On smooth surfaces the error falls like the edge length or faster on any mesh.  Noise of 1 % of the edge length is
    already too much: use `sectional`.

    References
    ----------
    .. [1] C. F. Gauss, "Disquisitiones generales circa superficies curvas", 1828, art. 26-28.
    """
    t = mesh.topology
    surface = stencil_surface(mesh)
    frames = empty_frames(mesh.n_vertices)
    quadrics.ring_quadrics(np.arange(mesh.n_vertices), surface, False, N_BLOCKS, frames)
    is_closed = t.vertex_is_manifold & ~t.vertex_is_boundary
    gaussian = _metric_curvature(mesh, frames.normals, is_closed, frames.k1 * frames.k2)
    mean = 0.5 * (frames.k1 + frames.k2)
    gaussian[np.isnan(mean)] = np.nan
    half = np.sqrt(np.maximum(mean * mean - gaussian, 0.0))
    return Estimate(
        gaussian, ring_deviations(mesh, gaussian), longest_edges(mesh),
        mean, mean + half, mean - half, frames.direction1, frames.direction2,
    )  # fmt: skip


def _metric_curvature(mesh: TriangleMesh, normals: Floats, is_closed: np.ndarray, elsewhere: Floats) -> Floats:
    """Curvature of the lifted metric where the star is closed, the given one elsewhere."""
    t = mesh.topology
    lengths, angles, areas = np.empty((mesh.n_faces, 3)), np.empty((mesh.n_faces, 3)), np.empty(mesh.n_faces)
    curves.lifted_edge_lengths(mesh.vertices, mesh.faces, normals, mesh.edge_lengths, lengths)
    triangles.face_angles(lengths, angles)
    triangles.face_areas(lengths, areas)
    total, area = np.empty(mesh.n_vertices), np.empty(mesh.n_vertices)
    triangles.vertex_sums_of_corners(angles, t.corner_offsets, t.vertex_corners, total)
    triangles.vertex_sums_of_faces(areas, t.corner_offsets, t.vertex_corners, area)
    defects = 2.0 * np.pi - total
    gaussian = elsewhere.copy()
    np.divide(3.0 * defects, area, out=gaussian, where=is_closed & (area > 0.0))
    for _ in range(SWEEPS):
        swept = np.empty_like(gaussian)
        stars.gauss_sweep(gaussian, defects, areas, t.faces, t.corner_offsets, t.vertex_corners, is_closed, swept)
        gaussian = swept
    return gaussian
