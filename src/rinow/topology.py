"""The combinatorics of a triangle mesh: what its faces say before any length is known."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import read_only
from rinow.kernels import adjacency, edge_numbers

__all__ = ["Topology", "clusters"]

Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]

PIECES = 64
"""Parts that half-edges are counted in, by any thread."""


@dataclass(frozen=True, eq=False)
class Topology:
    """Adjacency of a list of triangles; everything is computed once, on first use, in linear time.

    Corner ``3 f + k`` is corner k of face f; the same number names the half-edge from corner k to corner k + 1.

    Attributes
    ----------
    faces : (n_faces, 3) ndarray of intp
        Vertex indices, checked to lie in ``range(n_vertices)``.
    n_vertices : int
        Number of vertices, those without a face included.
    face_used : (n_faces,) ndarray of bool
        Faces that take part.  Left out are faces with a repeated vertex or with an undefined length.
    """

    faces: Indices
    n_vertices: int
    face_used: Bools

    @cached_property
    def _corner_rows(self) -> tuple[Indices, Indices]:
        offsets, corners = adjacency.corners_of_vertices(self.faces, self.face_used, self.n_vertices)
        return read_only(offsets), read_only(corners)

    @property
    def corner_offsets(self) -> Indices:
        """(n_vertices + 1,): corners of vertex v are ``vertex_corners[corner_offsets[v]:corner_offsets[v + 1]]``."""
        return self._corner_rows[0]

    @property
    def vertex_corners(self) -> Indices:
        """Corners in the order of their vertices."""
        return self._corner_rows[1]

    @cached_property
    def _corner_neighbours(self) -> tuple[Indices, Indices]:
        after, before = np.empty_like(self.vertex_corners), np.empty_like(self.vertex_corners)
        adjacency.neighbours_of_corners(self.faces, self.vertex_corners, after, before)
        return read_only(after), read_only(before)

    @cached_property
    def _halfedge_edges(self) -> tuple[Indices, Indices]:
        partners = np.full(3 * len(self.faces), adjacency.UNUSED, np.intp)
        first = partners.copy()
        adjacency.edges_of_halfedges(*self._corner_rows, *self._corner_neighbours, partners, first)
        return read_only(partners), read_only(first)

    @property
    def partners(self) -> Indices:
        """(3 n_faces,): the other half-edge of the same edge, or a negative code.

        The codes are -1 at the boundary, -2 where more than two faces meet and -3 for faces that take no part.
        Partners of misoriented faces run the same way.
        """
        return self._halfedge_edges[0]

    @cached_property
    def edge_halfedges(self) -> Indices:
        """(n_edges,): the first half-edge of each edge."""
        first, starts = self._halfedge_edges[1], np.zeros(PIECES + 1, np.intp)
        edge_numbers.count_edges(first, starts[1:])
        np.cumsum(starts, out=starts)
        halfedges = np.empty(starts[-1], np.intp)
        edge_numbers.list_edges(first, starts, halfedges)
        return read_only(halfedges)

    def edge_of_halfedge(self) -> Indices:
        """(3 n_faces,): number of the edge of each half-edge; -1 for faces that take no part.  It is not kept."""
        first, numbers = self._halfedge_edges[1], np.empty(3 * len(self.faces), np.intp)
        edge_numbers.number_first_halfedges(self.edge_halfedges, numbers)
        edge_numbers.number_other_halfedges(first, numbers)
        return read_only(numbers)

    @property
    def n_edges(self) -> int:
        """Number of edges."""
        return len(self.edge_halfedges)

    @cached_property
    def edges(self) -> Indices:
        """(n_edges, 2): the end points of each edge, in the direction of its first half-edge."""
        ends = np.empty((self.n_edges, 2), np.intp)
        edge_numbers.ends_of_edges(self.faces, self.edge_halfedges, ends)
        return read_only(ends)

    def halfedge_ends(self, halfedges: Indices) -> Indices:
        """(k, 2): start and end vertex of half-edges."""
        f, k = np.divmod(halfedges, 3)
        return np.stack([self.faces[f, k], self.faces[f, (k + 1) % 3]], axis=1)

    @cached_property
    def boundary_halfedges(self) -> Indices:
        """(k,): the half-edges of edges with one face, ascending."""
        return read_only(np.flatnonzero(self.partners == adjacency.BOUNDARY))

    @cached_property
    def edge_is_boundary(self) -> Bools:
        """(n_edges,): the edge has one face."""
        return read_only(self.partners[self.edge_halfedges] == adjacency.BOUNDARY)

    @cached_property
    def edge_is_manifold(self) -> Bools:
        """(n_edges,): the edge has at most two faces."""
        return read_only(self.partners[self.edge_halfedges] != adjacency.NONMANIFOLD)

    @cached_property
    def _vertex_kinds(self) -> tuple[Bools, Bools, Bools]:
        kinds = tuple(np.empty(self.n_vertices, np.bool_) for _ in range(3))
        adjacency.vertex_manifoldness(self.faces, *self._corner_rows, self.partners, *kinds)
        return kinds[0], kinds[1], kinds[2]

    @property
    def vertex_is_manifold(self) -> Bools:
        """(n_vertices,): the faces around the vertex form one fan, open or closed; false without a face."""
        return self._vertex_kinds[0]

    @property
    def vertex_is_boundary(self) -> Bools:
        """(n_vertices,): a boundary edge ends at the vertex."""
        return self._vertex_kinds[1]

    @property
    def vertex_is_on_nonmanifold_edge(self) -> Bools:
        """(n_vertices,): an edge with three or more faces ends at the vertex."""
        return self._vertex_kinds[2]

    @cached_property
    def vertex_is_used(self) -> Bools:
        """(n_vertices,): some face that takes part has the vertex."""
        return read_only(np.diff(self.corner_offsets) > 0)

    @cached_property
    def _components(self) -> tuple[Indices, int]:
        labels, count = adjacency.vertex_components(self.faces, self.face_used, self.n_vertices)
        return read_only(labels), int(count)

    @property
    def components(self) -> Indices:
        """(n_vertices,): number of the connected component, counted from 0; -1 for a vertex without a face."""
        return self._components[0]

    @property
    def n_components(self) -> int:
        """Number of connected components of the surface."""
        return self._components[1]

    @cached_property
    def euler_characteristic(self) -> int:
        """Vertices minus edges plus faces, of the part that has faces."""
        return int(self.vertex_is_used.sum()) - self.n_edges + int(self.face_used.sum())

    @property
    def is_closed(self) -> bool:
        """Whether the surface is non-empty and no edge has just one face."""
        return self.n_edges > 0 and not len(self.boundary_halfedges)

    @cached_property
    def _orientation(self) -> tuple[Bools, bool]:
        flip, consistent = adjacency.face_orientations(self.faces, self.face_used, self.partners)
        return read_only(flip), bool(consistent)

    @property
    def face_flips(self) -> Bools:
        """(n_faces,): faces to turn so that neighbours agree; the minority of each patch of manifold edges."""
        return self._orientation[0]

    @property
    def is_orientable(self) -> bool:
        """Whether all neighbours agree after the flips (a Möbius strip has no such choice)."""
        return self._orientation[1]

    @cached_property
    def _neighbour_rows(self) -> tuple[Indices, Indices]:
        starts = np.zeros(self.n_vertices + 1, np.intp)
        adjacency.count_neighbours(self.corner_offsets, *self._corner_neighbours, starts[1:])
        np.cumsum(starts, out=starts)
        neighbours = np.empty(starts[-1], np.intp)
        adjacency.neighbours_of_vertices(self.corner_offsets, *self._corner_neighbours, starts, neighbours)
        return read_only(starts), read_only(neighbours)

    @property
    def neighbour_offsets(self) -> Indices:
        """(n_vertices + 1,): neighbours of v are ``neighbours[neighbour_offsets[v]:neighbour_offsets[v + 1]]``."""
        return self._neighbour_rows[0]

    @property
    def neighbours(self) -> Indices:
        """Vertices joined by an edge, each once, row after row."""
        return self._neighbour_rows[1]


def clusters(n: int, pairs: Indices) -> tuple[Indices, Indices]:
    """Clusters of n vertices joined by pairs (k, 2): the first vertex of each, and for each vertex its cluster."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    links = coo_array((np.ones(len(pairs), np.bool_), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    labels = connected_components(links, directed=False)[1]
    first = np.empty(int(labels.max(initial=-1)) + 1, np.intp)
    first[labels[::-1]] = np.arange(n)[::-1]  # of several vertices the last one that is written stays
    order = np.argsort(first, kind="stable")  # fast, for they often are in order
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[labels]
