"""A mesh as the fits see it: positions, smoothed normals, neighbours, and the spacing of the vertices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.kernels import balls, monge, stencils
from rinow.mesh import TriangleMesh
from rinow.topology import Topology

__all__ = ["NEEDLES", "N_BLOCKS", "empty_frames", "local_spacing", "ring_means", "rings_around", "stencil_surface"]

N_BLOCKS = 16
"""Pieces a kernel cuts its work into; each has scratch of its own."""
NEEDLES = 3.0
"""Largest ratio of the mean edge to that of equilateral triangles of the same area that counts."""


def stencil_surface(mesh: TriangleMesh) -> stencils.Surface:
    """Positions, neighbours, and area-weighted normals averaged over each ring (0 where there is no face).

    Area vectors, unlike angles and unit normals, are not upset by slivers.  Fits correct the remaining tilt.
    Without a consistent orientation the faces of each star are made to agree among themselves.
    """
    t = mesh.topology
    vectors, normals = np.empty_like(mesh.vertices), np.empty_like(mesh.vertices)
    stencils.vertex_area_vectors(
        mesh.vertices, mesh.faces, mesh.outward_flips, not t.is_orientable, t.corner_offsets, t.vertex_corners, vectors
    )
    stencils.ring_directions(vectors, not t.is_orientable, t.neighbour_offsets, t.neighbours, normals)
    return stencils.Surface(mesh.vertices, normals, t.neighbour_offsets, t.neighbours, t.is_orientable)


def local_spacing(mesh: TriangleMesh) -> NDArray[np.float64]:
    """(n_vertices,): distance of neighbours, averaged around each vertex; 0 without a face.

    It is the larger of the mean edge over one ring and the edge of equilateral triangles with the mean area per
    vertex over two rings.  The first sees to it that a stretched mesh has enough rows of vertices in a ball
    of a few spacings, the second that a mesh with slivers and tiny triangles has enough vertices.  Needles count
    up to three times the second only, or balls on them would hold any number of vertices.
    """
    t = mesh.topology
    edges = np.empty(mesh.n_vertices)
    stencils.mean_edge_lengths(mesh.vertices, t.neighbour_offsets, t.neighbours, edges)
    edges = _ring_sums(mesh, edges) / (np.diff(t.neighbour_offsets) + 1)
    shares = np.where(t.vertex_is_boundary, 0.5, 1.0)
    areas = _ring_sums(mesh, _ring_sums(mesh, mesh.vertex_areas)) / _ring_sums(mesh, _ring_sums(mesh, shares))
    even = np.sqrt(2.0 / np.sqrt(3.0) * areas)
    return np.clip(edges, even, NEEDLES * even)


def empty_frames(n: int) -> monge.PrincipalFrames:
    """Room for the principal frames of n vertices."""
    return monge.PrincipalFrames(np.empty(n), np.empty(n), np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3)))


def _ring_sums(mesh: TriangleMesh, values: NDArray[np.float64]) -> NDArray[np.float64]:
    sums = np.empty(mesh.n_vertices)
    stencils.ring_sums(values, mesh.topology.neighbour_offsets, mesh.topology.neighbours, sums)
    return sums


def ring_means(
    mesh: TriangleMesh, values: NDArray[np.float64], passes: int, *, itself: bool = True
) -> NDArray[np.float64]:
    """Means over each vertex and its neighbours, or the neighbours alone, taken `passes` times."""
    t, room = mesh.topology, np.empty((2, mesh.n_vertices))  # twice the same memory is faster than new one
    for i in range(passes):
        stencils.ring_averages(values, itself, t.neighbour_offsets, t.neighbours, room[i % 2])
        values = room[i % 2]
    return values


def rings_around(graph: Topology | balls.Sheet, marked: NDArray[np.bool_], n_rings: int) -> NDArray[np.bool_]:
    """(n_vertices,): a marked vertex is at most so many edges away."""
    offsets = graph.neighbour_offsets if isinstance(graph, Topology) else graph.offsets
    count = marked.astype(np.float64)
    if marked.any():
        for _ in range(n_rings):
            sums = np.empty_like(count)
            stencils.ring_sums(np.minimum(count, 1.0), offsets, graph.neighbours, sums)
            count = sums
    return count > 0.0
