"""A mesh prepared for unfolding: oriented half-edges with their shapes and what lies across, fans, bends."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow import tolerances
from rinow.kernels import adjacency, fans, patch_order, unfolding
from rinow.kernels.geodesic_balls import Surface
from rinow.mesh import IntrinsicMesh, TriangleMesh
from rinow.topology import Topology

__all__ = ["UnfoldedMesh", "unfold"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Records = NDArray[Any]
Shapes = NDArray[np.complex128]

_PATCH_SIZE = 200
_SHELL_WIDTH = 8.0  # in units of the square root of the area per vertex


@dataclass(frozen=True, slots=True)
class UnfoldedMesh:
    """Half-edges, fans and vertices for the kernels, in an order in which neighbours lie close together.

    Attributes
    ----------
    surface : Surface
        What the kernels read.
    order : (n_vertices,) ndarray of intp
        The user's number of each vertex.
    rank : (n_vertices,) ndarray of intp
        The number here of each of the user's vertices.
    unit : float
        Unit of length of `surface`: the power of two below the longest edge, so that scaling loses no digit.
    """

    surface: Surface
    order: Indices
    rank: Indices
    unit: float


def unfold(mesh: TriangleMesh | IntrinsicMesh) -> UnfoldedMesh:
    """Prepare a mesh for geodesics, in linear time.

    Faces are turned so that neighbours agree.  Where that is impossible (a Möbius strip, an edge of three faces), the
    half-edges come twice, the second time seen from behind.
    """
    t = _without_repeated_faces(mesh.topology)
    order = patch_order.patch_order(t.neighbour_offsets, t.neighbours, _PATCH_SIZE)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    corners = _oriented_corners(t.face_flips)
    F = rank[mesh.faces.ravel()[corners]]
    used = np.flatnonzero(t.face_used)
    used = used[np.argsort(F[used].min(axis=1), kind="stable")]
    F, corners = F[used], corners[used]
    unit = _power_of_two_below(float(mesh.edge_lengths[used].max(initial=0.0)))
    lengths = mesh.edge_lengths.ravel()[corners] / unit
    shapes = _shapes(mesh, order, F, corners, lengths, unit)
    topology = Topology(F, mesh.n_vertices, np.ones(len(F), np.bool_))
    halfedges = _halfedges(topology, shapes, two_sided=not (t.is_orientable and bool(t.edge_is_manifold.all())))
    component_sizes = np.bincount(t.components + 1, minlength=1)
    component_sizes[0] = 1  # vertices without a face
    surface = _surface(topology, halfedges, lengths, component_sizes[t.components[order] + 1])
    return UnfoldedMesh(surface, order, rank, unit)


def _without_repeated_faces(t: Topology) -> Topology:
    """Leave out faces at edges of three or more whose vertices are those of an earlier one: no path needs both."""
    forked = np.flatnonzero((t.partners.reshape(-1, 3) == adjacency.NONMANIFOLD).any(axis=1))
    first = np.unique(np.sort(t.faces[forked], axis=1), axis=0, return_index=True)[1]
    if len(first) == len(forked):
        return t
    used = t.face_used.copy()
    used[np.delete(forked, first)] = False
    return Topology(t.faces, t.n_vertices, used)


def _oriented_corners(flips: Bools) -> Indices:
    """(n_faces, 3): the corners of each face, the last two exchanged where the face is to be turned."""
    columns = np.where(flips[:, None], [0, 2, 1], [0, 1, 2])
    return 3 * np.arange(len(flips))[:, None] + columns


def _power_of_two_below(length: float) -> float:
    return 2.0 ** math.floor(math.log2(length)) if length > 0.0 else 1.0


def _shapes(
    mesh: TriangleMesh | IntrinsicMesh, order: Indices, F: Indices, corners: Indices, lengths: Floats, unit: float
) -> Shapes:
    """(3 n_faces, 2): shape of each half-edge; positions serve where there are any and no edge has length 0."""
    shapes = np.empty((F.size, 2), np.complex128)
    from_lengths = np.ones(len(F), np.bool_)
    if isinstance(mesh, TriangleMesh):
        unfolding.triangle_shapes(mesh.vertices[order] / unit, F, shapes)
        from_lengths = lengths.min(axis=1, initial=np.inf) < tolerances.ZERO_EDGE
    if from_lengths.any():
        angles = mesh.corner_angles.ravel()[corners[from_lengths]]
        shapes[np.repeat(from_lengths, 3)] = _shapes_from_lengths(lengths[from_lengths], angles)
    return shapes


def _shapes_from_lengths(lengths: Floats, angles: Floats) -> Shapes:
    """Shapes (ca / ab) e^{iA} and -(bc / ab) e^{-iB}; an edge of length 0 counts as `tolerances.ZERO_EDGE`."""
    opposite = np.maximum(lengths, tolerances.ZERO_EDGE)
    ab, ca, bc = opposite[:, [2, 0, 1]], opposite[:, [1, 2, 0]], opposite
    A, B = angles, angles[:, [1, 2, 0]]
    shapes = np.stack([ca / ab * np.exp(1j * A), -bc / ab * np.exp(-1j * B)], axis=-1)
    return shapes.reshape(-1, 2).astype(np.complex128)


def _halfedges(topology: Topology, shapes: Shapes, *, two_sided: bool) -> Records:
    """Records of all half-edges: row c of corner c, row n + c the same edge of the face seen from behind, then copies.

    The copies stand for an edge of three or more faces: a chain of siblings for each way to come to it.
    """
    n, start = topology.faces.size, topology.faces.ravel()
    corner = np.arange(n)
    following, previous = corner + 1 - 3 * (corner % 3 == 2), corner - 1 + 3 * (corner % 3 == 0)
    rows = np.zeros(2 * n if two_sided else n, unfolding.HALFEDGE)
    front = rows[:n]
    front["from_start"], front["from_end"] = shapes.T
    front["end"], front["apex"], front["previous"] = start[following], start[previous], previous
    partners = topology.partners
    same_way = (partners >= 0) & (start[partners] == start)
    across = np.where(partners >= 0, partners, -1)
    if two_sided:
        back = rows[n:]
        back["from_start"], back["from_end"] = -shapes[:, 1].conj(), -shapes[:, 0].conj()
        back["end"], back["apex"], back["previous"] = start, start[previous], following + n
        across = np.concatenate([across + n * same_way, np.where(partners >= 0, across + n * ~same_way, -1)])
        following, previous = np.append(following, previous + n), np.append(previous, following + n)
    rows["sibling"] = -1
    copied, sibling = _fork(topology, across) if two_sided else (corner[:0], corner[:0])
    rows["left"], rows["right"] = across[previous], across[following]
    copies = rows[copied]
    copies["sibling"] = sibling
    return np.concatenate([rows, copies])


def _fork(topology: Topology, across: Indices) -> tuple[Indices, Indices]:
    """Rows to copy for edges of three or more faces, and the siblings of the copies, to which `across` is pointed."""
    start = topology.faces.ravel()
    n = len(start)
    forked = np.flatnonzero(topology.partners == adjacency.NONMANIFOLD)
    ends = np.sort(topology.halfedge_ends(forked), axis=1)
    edge = np.unique(ends, axis=0, return_inverse=True)[1].ravel()
    by_edge = np.argsort(edge, kind="stable")
    forked, edge = forked[by_edge], edge[by_edge]
    n_faces = np.bincount(edge)
    first = np.cumsum(n_faces) - n_faces
    n_ways = n_faces[edge]
    i = np.repeat(np.arange(len(forked)), n_ways)
    j = first[edge[i]] + np.arange(len(i)) - np.repeat(np.cumsum(n_ways) - n_ways, n_ways)
    leave, enter = forked[i[i != j]], forked[j[i != j]]
    same_way = start[leave] == start[enter]
    leave = np.concatenate([leave, leave + n])
    copied = np.concatenate([enter + n * same_way, enter + n * ~same_way])
    begins = np.append(True, leave[1:] != leave[:-1])[: len(leave)]
    sibling = 2 * n + 1 + np.arange(len(leave))
    sibling[np.append(begins[1:], True)[: len(leave)]] = -1
    across[leave[begins]] = 2 * n + np.flatnonzero(begins)
    return copied, sibling


def _surface(topology: Topology, halfedges: Records, lengths: Floats, component_sizes: Indices) -> Surface:
    """Fans, kinds of vertices and the width of a shell."""
    n = topology.faces.size
    angles = np.angle(halfedges["from_start"])  # also of rows seen from behind: fans of a Möbius strip run through them
    is_manifold = topology.vertex_is_manifold
    corners, vertices = np.zeros(n, fans.FAN), np.zeros(topology.n_vertices, fans.VERTEX)
    fans.order_fans(topology.corner_offsets, topology.vertex_corners, is_manifold, angles, halfedges, corners, vertices)
    row = corners["row"]
    sides = np.maximum(lengths, tolerances.ZERO_EDGE)[:, [2, 0, 1]].ravel()
    corners["first_length"], corners["last_length"] = sides[row % n], sides[halfedges["previous"][row] % n]
    fans.write_clearances(halfedges, corners, vertices)
    vertices["component_size"] = component_sizes
    is_saddle = vertices["total_angle"] > 2.0 * np.pi + tolerances.SADDLE_ANGLE
    vertices["kind"] = np.select(
        [~is_manifold, topology.vertex_is_boundary, is_saddle], [fans.SINGULAR, fans.BOUNDARY, fans.SADDLE], fans.PLAIN
    )
    area = 0.5 * float(np.sum(sides[::3] ** 2 * np.imag(halfedges["from_start"][:n:3])))
    n_used = max(int(topology.vertex_is_used.sum()), 1)
    stride = _SHELL_WIDTH * max(math.sqrt(area / n_used), float(sides.mean()) if len(sides) else 1.0)
    return Surface(halfedges, corners, vertices, stride, not bool(topology.edge_is_manifold.all()))
