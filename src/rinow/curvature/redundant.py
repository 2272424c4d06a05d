"""Redundant vertices, without which the polyhedral surface is the same: amid a face, or amid an edge."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.caps import ON_EDGE, AmidEdge
from rinow.kernels import stencils
from rinow.mesh import TriangleMesh

__all__ = ["CREASED", "has_continuation", "redundant_vertices"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

CURVED = 1e-7
"""Angle defect of all neighbours from which on the surface around is none that can be developed: facets and cylinders
are full of such vertices, and no harm comes of them."""
IN_PLANE = 1e-8
"""Height of a vertex over the triangle of its three neighbours, over the longest side, where it is in it: rounding.
Where a surface bends to both sides that of others is 0 as well by chance, but not so exactly."""
CREASED = 0.5
"""Angle in radians between two faces from which on they meet at a crease: rims of cylinders are full of such vertices,
too, where all that is known of the cylinder lies."""
EVEN = 1e-3
"""Share of the tilts of the normals at the ends of an edge against it that differ where the surface has its point of
inflection in the middle, as symmetric surfaces on symmetric grids do: there a vertex on the chord is on the surface."""
OPPOSITE = 1e-4
"""Angle in radians by which an edge may miss the continuation of another one."""


def redundant_vertices(mesh: TriangleMesh) -> list[AmidEdge]:
    """Vertices with four neighbours two of which are the ends of an edge it lies on, or with three in a plane with it.

    The latter are as if on an edge from the nearest of the three to itself.  A vertex on a line that goes on beyond
    both ends, or to the boundary, is one of a ruled surface, and is left alone.
    """
    t = mesh.topology
    degree = np.diff(t.corner_offsets)
    few = np.flatnonzero((degree == 3) | (degree == 4))
    few = few[t.vertex_is_manifold[few] & ~t.vertex_is_boundary[few]]
    found: list[AmidEdge] = []
    for n, places in ((3, _in_triangles), (4, _on_edges)):
        rows = few[degree[few] == n]
        if len(rows):
            around = t.neighbours[t.neighbour_offsets[rows][:, None] + np.arange(n)]
            found += places(mesh, rows, around)
    return found


def _is_curved(mesh: TriangleMesh, around: Indices) -> NDArray[np.bool_]:
    """The surface bends at all of the neighbours, without a crease; at the boundary nobody can tell."""
    curved = (np.abs(mesh.vertex_angle_defects[around]) > CURVED) & ~mesh.topology.vertex_is_boundary[around]
    bends = np.all(curved, axis=1)
    for row in np.flatnonzero(bends):
        bends[row] = not any(_has_crease(mesh, v) for v in around[row])
    return bends


def _has_crease(mesh: TriangleMesh, vertex: int) -> bool:
    """Two faces that meet at an edge of those around a vertex differ by more than `CREASED`."""
    t = mesh.topology
    faces = t.vertex_corners[t.corner_offsets[vertex] : t.corner_offsets[vertex + 1]] // 3
    beyond = t.partners[3 * faces[:, None] + np.arange(3)] // 3
    normals, others = _normals(mesh, faces), _normals(mesh, beyond)
    cosines = np.sum(normals[:, None] * others, axis=2)
    return bool((cosines[beyond >= 0] < np.cos(CREASED)).any())


def _normals(mesh: TriangleMesh, faces: Indices) -> Floats:
    """(..., 3): unit normals of some faces; 0 without an area."""
    p, q, r = np.moveaxis(mesh.vertices[mesh.faces[faces]], -2, 0)
    normals = np.cross(q - p, r - p)
    sizes = np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.divide(normals, sizes, out=np.zeros_like(normals), where=sizes > 0.0)


def _in_triangles(mesh: TriangleMesh, vertices: Indices, around: Indices) -> list[AmidEdge]:
    """Those that lie in the triangle of their three neighbours."""
    V = mesh.vertices
    p, q, r = np.moveaxis(V[around] - V[vertices][:, None], 1, 0)
    normals = np.cross(q - p, r - p)
    areas = np.linalg.norm(normals, axis=1)
    longest = np.sqrt(np.max([np.sum(x * x, axis=1) for x in (q - p, r - q, p - r)], axis=0))
    with np.errstate(all="ignore"):
        heights = np.abs(np.sum(p * normals, axis=1)) / areas
    inside = np.all([np.sum(np.cross(a, b) * normals, axis=1) > 0.0 for a, b in ((p, q), (q, r), (r, p))], axis=0)
    flat = np.flatnonzero(inside & (heights <= IN_PLANE * longest))
    if not len(flat):
        return []
    flat = flat[_is_curved(mesh, around[flat])]
    near = np.argmin([np.sum(x[flat] ** 2, axis=1) for x in (p, q, r)], axis=0)
    ends = around[flat, near].tolist()
    return [AmidEdge(v, end, end) for v, end in zip(vertices[flat].tolist(), ends, strict=True)]


def _on_edges(mesh: TriangleMesh, vertices: Indices, around: Indices) -> list[AmidEdge]:
    """Those that lie between two of their four neighbours, on a line that ends there."""
    found, is_between = list[AmidEdge](), np.empty((6, len(vertices)), np.bool_)
    stencils.between_neighbours(mesh.vertices, vertices, around, ON_EDGE, is_between)
    for (i, j), between in zip(((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)), is_between, strict=True):
        rows = np.flatnonzero(between)
        if len(rows):
            rows = rows[_is_curved(mesh, around[rows])]
        places = np.stack([vertices[rows], around[rows, i], around[rows, j]], axis=1).tolist()
        found += [AmidEdge(*place) for place in places if not (_goes_on(mesh, *place) or _is_inflection(mesh, *place))]
    return list({place.vertex: place for place in found}.values())


def _goes_on(mesh: TriangleMesh, vertex: int, a: int, b: int) -> bool:
    """The line from the vertex to both ends of its edge goes on beyond them, along edges, or ends at the boundary."""
    ends = np.array([a, b])
    goes_on = mesh.topology.vertex_is_boundary[ends] | has_continuation(mesh, ends, np.full(2, vertex))
    return bool(goes_on.all())


def _is_inflection(mesh: TriangleMesh, vertex: int, a: int, b: int) -> bool:
    """The vertex is in the middle of its edge, and the surface bends as much to one side at a as to the other at b."""
    along = mesh.vertices[b] - mesh.vertices[a]
    middle = np.linalg.norm(mesh.vertices[[a, b]].mean(axis=0) - mesh.vertices[vertex])
    first, second = mesh.vertex_normals[[a, b]] @ along
    is_even = 0.0 < abs(first) + abs(second) and abs(second - first) <= EVEN * (abs(first) + abs(second))
    return bool(is_even and middle <= EVEN * np.linalg.norm(along))


def has_continuation(mesh: TriangleMesh, ends: Indices, others: Indices) -> NDArray[np.bool_]:
    """(k,): some edge at a vertex of `ends` goes on where the one from the neighbour in `others` arrives."""
    V, t = mesh.vertices, mesh.topology
    counts = t.neighbour_offsets[ends + 1] - t.neighbour_offsets[ends]
    start = np.repeat(t.neighbour_offsets[ends] - np.cumsum(counts) + counts, counts)
    dart = np.repeat(np.arange(len(ends)), counts)
    spokes = V[t.neighbours[start + np.arange(counts.sum())]] - V[ends[dart]]
    back = V[others[dart]] - V[ends[dart]]
    across = np.linalg.norm(np.cross(spokes, back), axis=1)
    opposite = across <= -OPPOSITE * np.sum(spokes * back, axis=1)
    return np.bincount(dart[opposite], minlength=len(ends)) > 0
