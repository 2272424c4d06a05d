"""Faces that were split in their plane, any number of them: the coarser mesh that is the same polyhedral surface."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.split_edges import LONGEST, SplitEdges
from rinow.mesh import TriangleMesh
from rinow.topology import clusters

__all__ = ["Coarser", "coarser"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FLAT_FACE = 1e-5
"""Height over a face, in units of its size, that is rounding."""
SAME_AREA = 1e-3
"""Share by which the area of a facet may change: by rounding of positions in slivers, less than by a face too many."""


class Coarser(NamedTuple):
    """A mesh whose faces were not split, and what became of the vertices of the finer one."""

    mesh: TriangleMesh
    vertices: Indices
    """(k,): those without a face now."""
    corners: Indices
    """(k, 4): the ends of the edge or the corners of the face that each is on, some more than once."""
    weights: Floats
    """(k, 4): shares of these corners whose mean is the vertex; 0 for those that are there again."""


class _Inner(NamedTuple):
    """Vertices in faces, the corners of these with weights as in `Coarser`, and the nearest of them."""

    vertices: Indices
    corners: Indices
    weights: Floats
    nearest: Indices


def coarser(mesh: TriangleMesh) -> Coarser | None:
    """The mesh without the vertices that lie on an edge or in a face of it; None if there are none.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Notes
    -----
    A vertex is on an edge if its faces bend along two opposite edges only, and in a face if they do not bend at all.
    Each goes to a corner of the edge or face that it is on.  By Sperner's lemma the triangles of a face that was split
    whose corners go to three different ones are, counted with their orientation, one.

    The ends of an edge bend the surface to all sides, without a crease: cylinders, cones and flat parts keep all their
    vertices, and so do the lines of ruled surfaces, which go on beyond an end.
    """
    split = SplitEdges(mesh)
    on_edge = split.on_edges
    if not on_edge.any():
        return None
    inside = split.inside & mesh.topology.vertex_is_manifold & ~mesh.topology.vertex_is_boundary
    facet = _facets(mesh, split.bends)
    rows = _vertices_of(facet, mesh.faces, on_edge)
    for _ in range(LONGEST):
        own = rows[~(on_edge | inside)[rows[:, 1]]]
        whole = _in_whole_facets(mesh, rows, split, on_edge, own)
        on_edge, inside = on_edge & whole, inside & whole
        own = rows[~(on_edge | inside)[rows[:, 1]]]
        new = np.arange(mesh.n_vertices)
        new[on_edge] = split.nearest[on_edge]
        near = _places_of_inner(mesh, rows, own, inside)
        new[near.vertices] = near.nearest
        faces, bad = _merged_faces(mesh, new[mesh.faces], facet)
        if not len(bad):
            break
        is_bad = np.isin(facet, bad)
        spoiled = np.isin(np.arange(mesh.n_vertices), mesh.faces[is_bad])
        on_edge, inside = on_edge & ~spoiled, inside & ~spoiled
    else:
        return None
    gone = np.flatnonzero(on_edge | inside)
    if not len(gone):
        return None
    corners, shares = split.ends[gone][:, [0, 1, 1, 1]], split.shares[gone]
    weights = np.column_stack([1.0 - shares, shares, np.zeros((len(gone), 2))])
    at = np.searchsorted(gone, near.vertices)
    corners[at], weights[at] = near.corners, near.weights
    return Coarser(TriangleMesh(mesh.vertices, faces), gone, corners, weights)


def _facets(mesh: TriangleMesh, bends: Bools) -> Indices:
    """(n_faces,): number of the plane part of each face; -1 for those that take no part."""
    t = mesh.topology
    h = t.edge_halfedges[~bends]
    facet = clusters(mesh.n_faces, np.stack([h // 3, t.partners[h] // 3], axis=1))[1]
    return np.where(t.face_used, facet, -1)


def _vertices_of(facet: Indices, faces: Indices, on_edge: Bools) -> Indices:
    """(k, 2): facets that have a vertex on an edge, ascending, with each of their vertices."""
    has_any = np.zeros(len(faces) + 1, np.bool_)
    has_any[facet[on_edge[faces].any(axis=1)]] = True
    concerned = has_any[facet] & (facet >= 0)
    keys = np.sort(facet[concerned, None] * len(on_edge) + faces[concerned], axis=None)
    return np.stack(np.divmod(keys[np.diff(keys, prepend=-1) > 0], len(on_edge)), axis=1)


def _in_whole_facets(mesh: TriangleMesh, rows: Indices, split: SplitEdges, on_edge: Bools, own: Indices) -> Bools:
    """(n_vertices,): on or in a triangle, or a quadrilateral with vertices on all of its sides: others are flat parts.

    `rows` are facets and vertices, and `own` those with their corners.  Without any such facet it is chance, as on
    coarsely rounded heights, that the faces beside a line are in a plane.
    """
    n, sides = int(rows[:, 0].max(initial=-1)) + 1, rows[on_edge[rows[:, 1]]]
    n_corners, n_bent = (np.bincount(own[:, 0], w, n) for w in (None, split.corners[own[:, 1]]))
    edges = np.unique(np.column_stack([sides[:, 0], np.sort(split.ends[sides[:, 1]], axis=1)]), axis=0)
    n_sides = np.bincount(edges[:, 0], minlength=n)
    whole = (n_bent == n_corners) & ((n_corners == 3) | ((n_corners == 4) & (n_sides == 4)))
    out = np.zeros(mesh.n_vertices, np.bool_)
    out[rows[whole[rows[:, 0]], 1]] = True
    return out


def _places_of_inner(mesh: TriangleMesh, rows: Indices, own: Indices, inside: Bools) -> _Inner:
    """Each vertex in a face among its corners; of four corners the weights are as even as can be."""
    inner = rows[inside[rows[:, 1]]]
    if not len(inner):
        return _Inner(inner[:, 1], np.empty((0, 4), np.intp), np.empty((0, 4)), inner[:, 1])
    start, stop = np.searchsorted(own[:, 0], inner[:, 0]), np.searchsorted(own[:, 0], inner[:, 0], side="right")
    place = start[:, None] + np.arange(4)
    corners, is_one = own[np.minimum(place, stop[:, None] - 1), 1], place < stop[:, None]
    spokes = (mesh.vertices[corners] - mesh.vertices[inner[:, 1]][:, None]) * is_one[:, :, None]
    distances = np.where(is_one, np.linalg.norm(spokes, axis=2), np.inf)
    size = np.linalg.norm(spokes, axis=(1, 2))[:, None, None]
    system = np.concatenate([np.swapaxes(spokes / size, 1, 2), is_one[:, None, :]], axis=1)
    weights = np.linalg.pinv(system, FLAT_FACE)[:, :, 3]
    return _Inner(
        inner[:, 1], corners, np.where(is_one, weights, 0.0), corners[np.arange(len(inner)), distances.argmin(axis=1)]
    )


def _merged_faces(mesh: TriangleMesh, new: Indices, facet: Indices) -> tuple[Indices, Indices]:
    """The faces after their corners have moved, each once, and the facets that they do not cover once."""
    a, b, c = new.T
    changed = (new != mesh.faces).any(axis=1) & (facet >= 0)
    rows = np.flatnonzero(changed & (a != b) & (b != c) & (c != a))
    moved = new[rows]
    order = np.argsort(moved, axis=1)
    is_even = np.isin(order @ [9, 3, 1], (5, 15, 19))  # 012, 120, 201
    turned = is_even == mesh.topology.face_flips[rows]
    key = np.column_stack([facet[rows], np.take_along_axis(moved, order, axis=1)])
    _, first, group = np.unique(key, axis=0, return_index=True, return_inverse=True)
    group = group.ravel()
    net = np.bincount(group, np.where(turned, -1.0, 1.0), len(first))
    sign = np.where(net[group] > 0, 1, -1)
    right = np.flatnonzero((net[group] != 0) & ((turned & (sign < 0)) | (~turned & (sign > 0))))
    _, pick = np.unique(group[right], return_index=True)
    kept = rows[np.sort(right[pick])]
    faces = np.flatnonzero(~changed)
    faces = np.sort(np.concatenate([faces, kept]))
    touched = np.unique(facet[changed])
    n = int(facet.max(initial=-1)) + 1
    before = np.bincount(facet[facet >= 0], _areas(mesh, mesh.faces)[facet >= 0], n)
    used = faces[facet[faces] >= 0]
    after = np.bincount(facet[used], _areas(mesh, new[used]), n)
    bad = touched[np.abs(after - before)[touched] > SAME_AREA * before[touched]]
    return new[faces], bad


def _areas(mesh: TriangleMesh, faces: Indices) -> Floats:
    p, q, r = (mesh.vertices[faces[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(q - p, r - p), axis=1)
