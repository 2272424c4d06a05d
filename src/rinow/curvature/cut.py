"""A mesh cut open along its creases, so that curvature on each side is taken from that side alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.creases import EdgeTurnings, crease_barriers
from rinow.kernels import cuts
from rinow.mesh import TriangleMesh

__all__ = ["cut_along_creases", "largest_copies"]


def cut_along_creases(
    mesh: TriangleMesh, is_crease: NDArray[np.bool_] | None = None
) -> tuple[TriangleMesh, NDArray[np.intp]]:
    """The mesh with a copy of each crease vertex for every side, and the vertex that each one is a copy of.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    is_crease : (n_edges,) ndarray of bool, optional
        Edges to cut, in the order of ``mesh.topology.edges``; by default `crease_barriers`.

    Returns
    -------
    cut : TriangleMesh
        The first n_vertices vertices are those of `mesh`; the creases are boundaries.
    origin : (n_cut_vertices,) ndarray of intp
        Vertex of `mesh` of each vertex of `cut`.
    """
    creased = crease_barriers(mesh) if is_crease is None else is_crease
    origin = np.arange(mesh.n_vertices)
    if not creased.any():
        return mesh, origin
    t, n_corners = mesh.topology, 3 * mesh.n_faces
    edge_of = EdgeTurnings(mesh).edge_of_halfedge
    labels, numbers, faces = np.empty(n_corners, np.intp), np.empty(n_corners, np.intp), mesh.faces.copy()
    cuts.sectors(mesh.faces, t.corner_offsets, t.vertex_corners, t.partners, creased[edge_of], labels)
    origin = np.resize(origin, mesh.n_vertices + n_corners)
    n = cuts.number_sectors(mesh.n_vertices, t.corner_offsets, t.vertex_corners, labels, faces, origin, numbers)
    origin = origin[:n].copy()
    return TriangleMesh(mesh.vertices[origin], faces), origin


def largest_copies(cut: TriangleMesh, origin: NDArray[np.intp], n_vertices: int) -> NDArray[np.intp]:
    """(n_vertices,): of the copies of each vertex the one with the largest area around it, the first of equal ones."""
    order = np.lexsort((np.arange(len(origin)), -cut.vertex_areas, origin))
    first = np.searchsorted(origin[order], np.arange(n_vertices))
    return order[first]
