"""Hull slivers: flat triangles that a triangulation of scattered points has over the dents of its boundary."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.creases import EdgeTurnings
from rinow.mesh import TriangleMesh
from rinow.topology import clusters

__all__ = ["without_hull_slivers"]

Indices = NDArray[np.intp]

OBTUSE = np.cos(np.radians(140.0))
"""Cosine of the least angle of a sliver: its apex is nearer to the boundary edge than a fifth of its length."""
SMOOTH = np.radians(12.0)
"""Turning up to which a sliver goes on into the face beside it: less than at any crease."""


def without_hull_slivers(mesh: TriangleMesh, is_crease: NDArray[np.bool_] | None = None) -> TriangleMesh:
    """The mesh without folded slivers at its boundary.

    A triangulation of scattered points, as Delaunay's, ends at their convex hull.  Over the dents of a set of points it
    has triangles as long as these and less high than the sagitta of the surface below, which therefore turn by any
    angle.  A sliver has an angle above 140° opposite to the boundary, or to another sliver.  The rim of a part may have
    slivers too, but these go on smoothly, over slivers, into a face that is none.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    is_crease : (n_edges,) ndarray of bool, optional
        Edges that seem to be creases, in the order of ``mesh.topology.edges``: without any at a sliver all stay.

    Returns
    -------
    mesh : TriangleMesh
        The same mesh if nothing goes; else each vertex keeps its number and a face.
    """
    if is_crease is not None and not is_crease.any():
        return mesh
    slivers = _slivers(mesh)
    slivers = slivers[_folds(mesh, slivers)]
    if is_crease is not None and not is_crease[mesh.topology.edge_of_halfedge().reshape(-1, 3)[slivers]].any():
        return mesh
    is_left = np.ones(mesh.n_faces, np.bool_)
    is_left[slivers] = False
    keeps_face = np.zeros(mesh.n_vertices, np.bool_)
    keeps_face[mesh.faces[is_left]] = True
    is_left |= ~keeps_face[mesh.faces].all(axis=1)
    return mesh if is_left.all() else TriangleMesh(mesh.vertices, mesh.faces[is_left])


def _slivers(mesh: TriangleMesh) -> Indices:
    """The numbers of all slivers, from the boundary inwards."""
    found, partners = np.empty(0, np.intp), mesh.topology.partners.reshape(-1, 3)
    waiting = mesh.topology.boundary_halfedges
    while len(waiting):
        f, k = np.divmod(waiting[_cosines_opposite(mesh, waiting) < OBTUSE], 3)
        found = np.union1d(found, f)
        behind = np.concatenate([partners[f, (k + 1) % 3], partners[f, (k + 2) % 3]])
        waiting = np.unique(behind[(behind >= 0) & ~np.isin(behind // 3, found)])
    return found


def _folds(mesh: TriangleMesh, slivers: Indices) -> NDArray[np.bool_]:
    """Which of some faces do not go on smoothly, over others of them, into a face that is none."""
    if not len(slivers):
        return np.zeros(0, np.bool_)
    t, turnings = mesh.topology, np.abs(EdgeTurnings(mesh).turnings)
    beside = t.partners.reshape(-1, 3)[slivers]
    goes_on = (turnings[t.edge_of_halfedge().reshape(-1, 3)[slivers]] < SMOOTH) & (beside >= 0)
    rows, columns = np.nonzero(goes_on)
    place = np.searchsorted(slivers, beside[rows, columns] // 3).clip(max=len(slivers) - 1)
    is_sliver = slivers[place] == beside[rows, columns] // 3
    _, label = clusters(len(slivers), np.stack([rows, place], axis=1)[is_sliver])
    return ~np.isin(label, label[rows[~is_sliver]])


def _cosines_opposite(mesh: TriangleMesh, halfedges: Indices) -> NDArray[np.float64]:
    """Cosines of the angles opposite to half-edges in their faces."""
    f, k = np.divmod(halfedges, 3)
    a, b, c = (mesh.edge_lengths[f, (k + j) % 3] for j in range(3))  # c is the side of the half-edge
    with np.errstate(divide="ignore", invalid="ignore"):
        return (a * a + b * b - c * c) / (2.0 * a * b)
