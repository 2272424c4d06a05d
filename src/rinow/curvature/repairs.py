"""A mesh as the curvature methods take it: one vertex at one place, each face once, and sheets that meet apart."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.caps import AmidEdge, without_caps
from rinow.curvature.cracks import closed_cracks, lie_on_each_other
from rinow.curvature.crossings import partners_across
from rinow.curvature.estimate import Estimate
from rinow.curvature.notes import crack_notes, merge_notes, repeat_notes, sheet_notes, weld_notes
from rinow.kernels import cuts, triangles
from rinow.kernels.adjacency import BOUNDARY, NONMANIFOLD
from rinow.mesh import IntrinsicMesh, TriangleMesh
from rinow.topology import clusters

__all__ = ["Repair", "Sheets", "repair", "repaired", "sheets_of", "without_repeats"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Mesh = TriangleMesh | IntrinsicMesh

POINT = 1e-6
"""An edge this short beside the other sides of its faces is a point, and so are ends of two seams this near each other
beside the shortest edge of both: far above rounding, far below what anybody models."""


class Repair(NamedTuple):
    """The surface that a mesh stands for."""

    mesh: Mesh
    """The mesh itself if there is nothing to do."""
    vertex_map: Indices | None
    """(n_vertices,): the vertex of the surface for each one of the mesh, if they are other ones."""
    notes: tuple[str, ...]
    """What was done."""
    amid: list[AmidEdge]
    """Vertices of the surface that lie on an edge, since a face was split there."""


def repaired(mesh: Mesh) -> tuple[Mesh, Indices | None, tuple[str, ...]]:
    """`repair` without the vertices amid an edge."""
    return repair(mesh)[:3]


def repair(mesh: Mesh) -> Repair:
    """The surface that a mesh stands for.

    Vertices of a soup are welded, the ends of edges without length and the two sides of a seam are taken as one vertex,
    and each face once.  A seam is a pair of boundary edges at the same place, as the edges of a texture leave it; two
    sheets that lie on each other are none.  Cracks, where vertices lie on an edge of the other side, are closed, and
    faces without area are joined to their neighbours.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface; seams and cracks are seen by positions only.
    """
    n, index, notes = mesh.n_vertices, None, ()
    if isinstance(mesh, TriangleMesh) and mesh.is_soup:
        mesh, index = mesh.welded()
        notes = weld_notes(n, mesh.n_vertices)
    before = mesh.n_vertices
    for pairs_of in (_edges_without_length, _seams):
        mesh, index = _joined(mesh, pairs_of(mesh), index)
    mesh, index, amid, n_cracks = _without_cracks(mesh, index)
    notes += merge_notes(before - mesh.n_vertices)
    mesh, n_repeated = without_repeats(mesh)
    mesh, on_caps = without_caps(mesh)
    return Repair(mesh, index, notes + crack_notes(n_cracks) + repeat_notes(n_repeated), [*amid, *on_caps])


def _without_cracks(mesh: Mesh, index: Indices | None) -> tuple[Mesh, Indices | None, list[AmidEdge], int]:
    """The mesh with its cracks closed, the new index, the vertices amid an edge, and the number of cracks."""
    ends = mesh.topology.halfedge_ends(mesh.topology.boundary_halfedges)
    if len(ends) < 3 or isinstance(mesh, IntrinsicMesh):
        return mesh, index, [], 0
    closed = closed_cracks(mesh, _places(mesh.vertices, ends, _distances(mesh.vertices, ends)))
    if not closed.n_cracks:
        return mesh, index, [], 0
    if not len(closed.pairs):
        return closed.mesh, index, closed.amid, closed.n_cracks
    mesh, new = _merged(closed.mesh, closed.pairs)
    amid = [AmidEdge(*new[list(place)].tolist()) for place in closed.amid]
    return mesh, new if index is None else new[index], amid, closed.n_cracks


def _joined(mesh: Mesh, pairs: Indices, index: Indices | None) -> tuple[Mesh, Indices | None]:
    """The mesh with the vertices of each pair as one, and the new index."""
    if not len(pairs):
        return mesh, index
    mesh, new = _merged(mesh, pairs)
    return mesh, new if index is None else new[index]


def _merged(mesh: Mesh, pairs: Indices) -> tuple[Mesh, Indices]:
    """The mesh with the vertices of each pair (k, 2) as one, at the place of the first, and the new index of each."""
    vertices, vertex_map = clusters(mesh.n_vertices, pairs)
    if isinstance(mesh, IntrinsicMesh):
        return IntrinsicMesh(vertex_map[mesh.faces], mesh.edge_lengths, len(vertices)), vertex_map
    return TriangleMesh(mesh.vertices[vertices], vertex_map[mesh.faces]), vertex_map


def _edges_without_length(mesh: Mesh) -> Indices:
    """(k, 2): ends of edges that are points beside the other sides of all their faces."""
    t, share = mesh.topology, POINT if isinstance(mesh, TriangleMesh) else 0.0
    short = np.empty((mesh.n_faces, 3), np.bool_)
    triangles.short_sides(mesh.edge_lengths, share, t.face_used, short)
    h = np.flatnonzero(short)  # in the order of the half-edges
    other = t.partners[h]
    return t.halfedge_ends(h[(other < 0) | short.ravel()[other]])


def _seams(mesh: Mesh) -> Indices:
    """(k, 2): vertices of two boundary edges that lie on each other."""
    h = mesh.topology.boundary_halfedges
    if len(h) < 2 or isinstance(mesh, IntrinsicMesh):
        return np.empty((0, 2), np.intp)
    V, ends = mesh.vertices, mesh.topology.halfedge_ends(h)
    lengths = _distances(V, ends)
    place = _places(V, ends, lengths)
    _, group, size = np.unique(np.sort(place[ends], axis=1), axis=0, return_inverse=True, return_counts=True)
    group = group.ravel()
    order = np.argsort(group, kind="stable")
    i, j = order[size[group[order]] == 2].reshape(-1, 2).T
    apexes = V[mesh.faces[h // 3, (h % 3 + 2) % 3]]
    starts = V[ends[i, 0]]
    apart = ~lie_on_each_other(V[ends[i, 1]] - starts, apexes[i] - starts, apexes[j] - starts)
    i, j = i[apart], j[apart]
    turned = place[ends[i, 0]] != place[ends[j, 0]]
    theirs = np.where(turned[:, None], ends[j, ::-1], ends[j])
    pairs = np.stack([ends[i], theirs], axis=2).reshape(-1, 2)
    return pairs[pairs[:, 0] != pairs[:, 1]]


def _distances(vertices: Floats, ends: Indices) -> Floats:
    return np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1)


def _places(vertices: Floats, ends: Indices, lengths: Floats) -> Indices:
    """(n_vertices,): the same number for vertices of edges at the same place."""
    from scipy.spatial import KDTree

    n, rows = len(vertices), np.unique(ends)
    least = np.full(n, np.inf)
    np.minimum.at(least, ends.ravel(), np.repeat(lengths, 2))
    pairs = rows[KDTree(vertices[rows]).query_pairs(POINT * float(np.median(lengths)), output_type="ndarray")]
    gaps = np.linalg.norm(vertices[pairs[:, 0]] - vertices[pairs[:, 1]], axis=1)
    return clusters(n, pairs[gaps <= POINT * least[pairs].min(axis=1)])[1]


def without_repeats(mesh: Mesh) -> tuple[Mesh, int]:
    """The mesh with one of all faces that have the same vertices, and how many were left out."""
    if not mesh.topology.vertex_is_on_nonmanifold_edge.any():
        return mesh, 0
    first = np.sort(np.unique(np.sort(mesh.faces, axis=1), axis=0, return_index=True)[1])
    return (mesh, 0) if len(first) == mesh.n_faces else (_with_faces(mesh, first), mesh.n_faces - len(first))


def _with_faces(mesh: Mesh, rows: Indices) -> Mesh:
    """The mesh with some of its faces."""
    if isinstance(mesh, IntrinsicMesh):
        return IntrinsicMesh(mesh.faces[rows], mesh.edge_lengths[rows], mesh.n_vertices)
    return TriangleMesh(mesh.vertices, mesh.faces[rows])


class Sheets(NamedTuple):
    """A mesh whose vertices have one fan of faces each, and the vertex that each of them is a copy of."""

    mesh: Mesh
    origin: Indices | None
    """None if each is itself."""
    notes: tuple[str, ...]

    def largest(self, estimate: Estimate, is_special: Bools, n: int) -> tuple[Estimate, Bools]:
        """The values, and a mark, at each of n vertices, of one of the sheets that have a value.

        It is one that goes on beyond the vertex, of several the one with the largest area.
        """
        if self.origin is None:
            return estimate, is_special
        ends = self.mesh.topology.vertex_is_boundary
        order = np.lexsort((-self.mesh.vertex_areas, ends, ~np.isfinite(estimate.gaussian), self.origin))
        rows = order[np.searchsorted(self.origin[order], np.arange(n))]
        return estimate.at(rows), is_special[rows]


def sheets_of(mesh: Mesh) -> Sheets:
    """The sheets of a surface that meet at edges with three or more faces, or at single vertices, each by itself.

    A sheet goes on beyond an edge on which others stand (`partners_across`).  A fin, a face that stands on such an edge
    and is joined to nothing else, is left out.
    """
    if not _meet(mesh).any():
        return Sheets(mesh, None, ())
    fins = _fins(mesh)
    if fins.any():
        mesh = _with_faces(mesh, np.flatnonzero(~fins))
    notes = sheet_notes(int(fins.sum()), int(_meet(mesh).sum()))
    t, n_corners, origin = mesh.topology, 3 * mesh.n_faces, np.arange(mesh.n_vertices)
    labels, numbers, faces = np.empty(n_corners, np.intp), np.empty(n_corners, np.intp), mesh.faces.copy()
    rows = t.corner_offsets, t.vertex_corners
    cuts.sectors(mesh.faces, *rows, partners_across(mesh), np.zeros(n_corners, np.bool_), labels)
    origin = np.resize(origin, mesh.n_vertices + n_corners)
    n = cuts.number_sectors(mesh.n_vertices, *rows, labels, faces, origin, numbers)
    if isinstance(mesh, IntrinsicMesh):
        return Sheets(IntrinsicMesh(faces, mesh.edge_lengths, n), origin[:n], notes)
    faces[mesh.outward_flips] = faces[mesh.outward_flips, ::-1]
    return Sheets(TriangleMesh(mesh.vertices[origin[:n]], faces), origin[:n], notes)


def _meet(mesh: Mesh) -> Bools:
    """(n_vertices,): sheets meet at the vertex."""
    return mesh.topology.vertex_is_used & ~mesh.topology.vertex_is_manifold


def _fins(mesh: Mesh) -> Bools:
    """(n_faces,): the face stands on an edge of others and is joined to nothing else."""
    t = mesh.topology
    partners = t.partners.reshape(-1, 3)
    alone = ((partners == NONMANIFOLD).sum(axis=1) == 1) & ((partners == BOUNDARY).sum(axis=1) == 2)
    stands = np.where(partners == NONMANIFOLD, t.edge_of_halfedge().reshape(-1, 3), -1)
    counts = np.bincount(stands[~alone & t.face_used].ravel() + 1, minlength=t.n_edges + 1)
    counts[0] = 0
    return alone & (counts[stands.max(axis=1) + 1] > 0)
