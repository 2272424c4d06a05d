"""Edges that were split where they are straight, told by the lines that a mesh bends along."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.creases import EdgeTurnings
from rinow.curvature.redundant import CREASED, has_continuation
from rinow.curvature.rounding import coordinate_rounding
from rinow.mesh import TriangleMesh

__all__ = ["LONGEST", "SplitEdges"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FLAT = 1e-7
"""Turning of an edge and angle defect of a vertex, in radians, up to which they are 0 but for rounding: less than on
any mesh that shows a curvature."""
DEFECT = 64.0
"""Angle defect by rounding, in units of that of a position over the root of the area of a vertex: some vertex of a
split face has no more.  Of a million vertices of a curved surface hardly any has as little."""
ROUNDINGS = 4.0
"""Errors of positions, in units of their rounding, that are looked for: those of all ends of three edges."""
DOUBTFUL = 8.0
"""Turnings, in units of those of rounding, that may be rounding where all the others around say so."""
STRAIGHT = 1e-6
"""Angle in radians between two halves of an edge, but for rounding."""
LONGEST = 7
"""Vertices on an edge that was halved three times; longer rows are lines of a cone or of another ruled surface."""


class SplitEdges:
    """The straight lines that a mesh bends along, as far as they run between vertices that bend it to all sides.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    """

    def __init__(self, mesh: TriangleMesh) -> None:
        self.mesh = mesh
        n, t = mesh.n_vertices, mesh.topology
        self.ends, self.shares = np.full((n, 2), -1, np.intp), np.full(n, np.nan)
        self.on_edges, self.inside, self.corners = np.zeros((3, n), np.bool_)
        is_inner = t.vertex_is_manifold & ~t.vertex_is_boundary
        with np.errstate(divide="ignore", invalid="ignore"):
            least = np.minimum(FLAT, DEFECT * coordinate_rounding(mesh) / np.sqrt(mesh.vertex_areas))
        flat = is_inner & (np.abs(mesh.vertex_angle_defects) <= least)
        if self._rounding > 2.0**-50 * mesh.diagonal or flat.any():
            self._find(is_inner)

    @cached_property
    def _rounding(self) -> float:
        return ROUNDINGS * coordinate_rounding(self.mesh)

    @cached_property
    def bends(self) -> Bools:
        """(n_edges,): the faces on both sides differ by more than rounding, or there are no two of them.

        A line that bends by little more than rounding does not end where it bends a little less.
        """
        t, sizes = self.mesh.topology, np.abs(self._turnings.turnings)
        with np.errstate(invalid="ignore"):
            sizes = sizes / (FLAT + self._rounding * self._turnings.gains)
        bends, ends = ~(sizes <= 1.0), t.halfedge_ends(t.edge_halfedges)  # the mesh would keep `edges`
        for _ in range(LONGEST):
            counts = np.bincount(ends[bends].ravel(), minlength=self.mesh.n_vertices)
            loose = bends & (sizes <= DOUBTFUL) & (counts[ends] == 1).any(axis=1)
            if not loose.any():
                break
            bends[loose] = False
        return bends

    @cached_property
    def _turnings(self) -> EdgeTurnings:
        return EdgeTurnings(self.mesh)

    @property
    def nearest(self) -> Indices:
        """(n_vertices,): the nearer end of the edge that each vertex is on."""
        return np.where(self.shares <= 0.5, self.ends[:, 0], self.ends[:, 1])

    def _find(self, is_inner: Bools) -> None:
        """Look for vertices that the mesh bends at along two edges in one line, and follow these lines."""
        mesh, t = self.mesh, self.mesh.topology
        bent = t.halfedge_ends(t.edge_halfedges[self.bends])
        counts = np.bincount(bent.ravel(), minlength=mesh.n_vertices)
        self.inside = is_inner & (counts == 0)
        found = t.vertex_is_manifold & (counts == 2)  # at the boundary these are the two edges of it
        if not found.any():
            return
        at, other = bent.ravel(), bent[:, ::-1].ravel()
        here = np.flatnonzero(found[at])
        here = here[np.argsort(at[here], kind="stable")].reshape(-1, 2)
        middle, pairs = at[here[:, 0]], other[here]
        spokes = mesh.vertices[pairs] - mesh.vertices[middle][:, None]
        lengths = np.linalg.norm(spokes, axis=2)
        with np.errstate(all="ignore"):
            cosines = np.sum(spokes[:, 0] * spokes[:, 1], axis=1)
            across = np.linalg.norm(np.cross(spokes[:, 0], spokes[:, 1]), axis=1)
            limits = STRAIGHT + 2.0 * self._rounding / lengths.min(axis=1)
            straight = (cosines < 0.0) & (across <= limits * lengths.prod(axis=1))
        self._follow(middle[straight], pairs[straight], lengths[straight], is_inner)

    def _follow(self, middle: Indices, pairs: Indices, lengths: Floats, is_inner: Bools) -> None:
        """Follow the lines from vertices to both sides, and keep those that end as those of split edges do."""
        mesh, k = self.mesh, len(middle)
        row = np.full(mesh.n_vertices, -1, np.intp)
        row[middle] = np.arange(k)
        last, reach, steps = np.repeat(middle, 2), lengths.ravel().copy(), np.ones(2 * k, np.intp)
        end = pairs.ravel().copy()  # dart 2 i + j runs from middle i to its neighbour j
        for _ in range(LONGEST):
            on = np.flatnonzero(row[end] >= 0)
            if not len(on):
                break
            there = row[end[on]]
            j = np.where(pairs[there, 0] == last[on], 1, 0)
            last[on], end[on] = end[on], pairs[there, j]
            reach[on] += lengths[there, j]
            steps[on] += 1
        ends = end.reshape(-1, 2)
        is_whole = (row[ends] < 0).all(axis=1) & (steps.reshape(-1, 2).sum(axis=1) <= LONGEST + 1)
        is_longer = has_continuation(mesh, end, last).reshape(-1, 2)
        goes_on = is_longer | ~is_inner[ends]
        is_edge = is_whole & ~goes_on.all(axis=1) & self._is_corner[ends].all(axis=1)
        known = self._ends_whole_edges(row < 0)
        known[ends[is_edge]] = True
        to_rim = mesh.topology.vertex_is_boundary[ends]  # from an end that other edges tell to be one
        is_edge |= is_whole & ~goes_on.all(axis=1) & (to_rim.sum(axis=1) == 1) & (known[ends] | to_rim).all(axis=1)
        known[middle[is_edge]] = True
        is_edge |= is_whole & ~is_longer.any(axis=1) & self._beside(known, middle, ends)
        rows = np.flatnonzero(is_edge)
        self.on_edges[middle[rows]] = True
        self.ends[middle[rows]] = ends[rows]
        self.corners = self._is_corner.copy()
        self.corners[ends[rows]] = True
        self.shares[middle[rows]] = reach[2 * rows] / (reach[2 * rows] + reach[2 * rows + 1])

    def _ends_whole_edges(self, whole: Bools) -> Bools:
        """(n_vertices,): a corner that has an edge without vertices on it, as apexes of cones have none."""
        known, bent = np.zeros(self.mesh.n_vertices, np.bool_), self.mesh.topology.edges[self.bends]
        for u, v in (bent.T, bent.T[::-1]):
            known[u[whole[v]]] = True
        return known & self._is_corner

    def _beside(self, known: Bools, middle: Indices, ends: Indices) -> Bools:
        """(k,): the vertex is on an edge of the boundary beside a face with an edge or an end that is known."""
        t = self.mesh.topology
        rim = t.vertex_is_boundary
        at = t.edges[rim[t.edges].any(axis=1)]
        touches = np.zeros(self.mesh.n_vertices, np.bool_)
        for u, v in (at.T, at.T[::-1]):
            touches[v[known[u] & ~rim[u]]] = True
        _, line = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
        found = np.bincount(line.ravel(), touches[middle] & rim[middle]) > 0
        return found[line.ravel()] & rim[middle] & rim[ends].all(axis=1)

    @cached_property
    def _is_corner(self) -> Bools:
        """(n_vertices,): the surface bends to all sides there, without a crease around."""
        mesh, t = self.mesh, self.mesh.topology
        corner = t.vertex_is_manifold & ~t.vertex_is_boundary & (np.abs(mesh.vertex_angle_defects) > FLAT)
        with np.errstate(invalid="ignore"):
            creased = t.edge_halfedges[np.abs(self._turnings.turnings) > CREASED]
        corner[mesh.faces[creased // 3]] = False
        corner[mesh.faces[t.partners[creased] // 3]] = False
        return corner
