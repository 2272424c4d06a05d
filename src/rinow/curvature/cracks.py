"""Cracks and T-vertices: slits between faces, whose two sides have vertices on each other's edges."""

from __future__ import annotations

from collections import defaultdict
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.caps import AmidEdge
from rinow.curvature.edits import EditedFaces, apex
from rinow.mesh import TriangleMesh

__all__ = ["Closed", "closed_cracks", "lie_on_each_other"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

SLIT = 0.25
"""Largest angle between the sides of a slit at an end of an edge, in radians.  Vertices of the surface beside a chord
that turns by θ are seen from its ends under θ/2 at most; an edge that turns by more than half a radian is none of a
surface that is resolved.  A triangle that is missing has a larger angle at one of its corners at least."""
EXACT = 1e-5
"""Distance from an edge, over that to its nearer end, where a vertex is on it: as for `ON_EDGE`."""
FOLDED = 0.995
"""Cosine of the angle between the faces on both sides of an edge from which on they are sheets that lie on each other:
6 degrees, less than between the sides of a trailing edge, more than between two triangulations of a resolved sheet."""
CROWD = 8
"""Boundary edges at a place that are compared with each other."""


class Side(NamedTuple):
    """A boundary edge that leaves a place."""

    start: int
    end: int


class Closed(NamedTuple):
    """A mesh without its cracks."""

    mesh: TriangleMesh
    pairs: Indices
    """(k, 2): vertices that lie on each other at the ends of cracks or within them, and are still two."""
    amid: list[AmidEdge]
    """Vertices on the chord of the one edge that is the other side of their crack."""
    n_cracks: int


class _Cut(NamedTuple):
    """A step along a slit: the edge of one side, in a face with some apex, is cut at the end of that of the other."""

    edge: Side
    apex: int
    vertex: int
    is_exact: bool


def closed_cracks(mesh: TriangleMesh, place: Indices) -> Closed:
    """The mesh with the faces along cracks split at the vertices of the other side.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    place : (n_vertices,) ndarray of intp
        The same number for boundary vertices that lie on each other.

    Notes
    -----
    A crack begins where two boundary edges leave one place under a small angle, away from their faces.  It is followed:
    whichever of the two edges is longer is cut at the end of the other one, until both sides meet again.  If they do
    not, only vertices that lie on the other side exactly are joined to it.  A hole of another shape is left alone.
    """
    starts = _starts(mesh, place)
    if not len(starts):
        return Closed(mesh, np.empty((0, 2), np.intp), [], 0)
    zipper = _Zipper(mesh, place)
    for first, second in starts:
        zipper.close(Side(*first), Side(*second))
    pairs = np.array(sorted(zipper.pairs), np.intp).reshape(-1, 2)
    return Closed(zipper.result(), pairs, zipper.amid, zipper.n_cracks)


def _starts(mesh: TriangleMesh, place: Indices) -> list[list[list[int]]]:
    """Pairs of boundary edges that leave one place as the two sides of a slit."""
    t = mesh.topology
    ends = t.halfedge_ends(t.boundary_halfedges)
    sides = np.concatenate([ends, ends[:, ::-1]])
    sides = sides[np.argsort(place[sides[:, 0]], kind="stable")]
    at, found = place[sides[:, 0]], list[Indices]()
    for step in range(1, min(CROWD, len(at))):
        i = np.flatnonzero(at[step:] == at[:-step])
        found.append(np.stack([sides[i], sides[i + step]], axis=1))
    if not found:
        return []
    pairs = np.concatenate(found)
    V = mesh.vertices
    p, q = V[pairs[:, 0, 1]] - V[pairs[:, 0, 0]], V[pairs[:, 1, 1]] - V[pairs[:, 1, 0]]
    along, across = np.sum(p * q, axis=1), np.linalg.norm(np.cross(p, q), axis=1)
    thin = (along > 0.0) & (across <= SLIT * along)
    thin &= place[pairs[:, 0, 1]] != place[pairs[:, 1, 1]]
    return pairs[thin].tolist()


def lie_on_each_other(edges: Floats, first: Floats, second: Floats) -> NDArray[np.bool_]:
    """(k,): the faces between edges and two other sides at their starts, all (k, 3), lie on one side of the edge."""
    squares = np.sum(edges * edges, axis=1)
    with np.errstate(all="ignore"):
        u, w = (x - edges * (np.sum(x * edges, axis=1) / squares)[:, None] for x in (first, second))
        return np.sum(u * w, axis=1) >= FOLDED * np.sqrt(np.sum(u * u, axis=1) * np.sum(w * w, axis=1))


class _Zipper:
    """The cracks of a mesh while they are closed."""

    def __init__(self, mesh: TriangleMesh, place: Indices) -> None:
        self.edited, self.vertices, self.place = EditedFaces(mesh), mesh.vertices, place
        self.open: defaultdict[int, list[Side]] = defaultdict(list)
        t = mesh.topology
        for a, b in t.halfedge_ends(t.boundary_halfedges).tolist():
            self._put(a, b)
        self.pairs: set[tuple[int, int]] = set()
        self.amid: list[AmidEdge] = []
        self.n_cracks = 0

    def result(self) -> TriangleMesh:
        """The mesh as it is now."""
        mesh = self.edited.result()
        return mesh if isinstance(mesh, TriangleMesh) else TriangleMesh(self.vertices, mesh.faces)

    def _put(self, a: int, b: int) -> None:
        self.open[int(self.place[a])].append(Side(a, b))
        self.open[int(self.place[b])].append(Side(b, a))

    def _take(self, a: int, b: int) -> None:
        self.open[int(self.place[a])].remove(Side(a, b))
        self.open[int(self.place[b])].remove(Side(b, a))

    def close(self, first: Side, second: Side) -> None:
        """Follow a crack from its beginning and close it as far as it is one."""
        if not all(side in self.open[int(self.place[side.start])] for side in (first, second)):
            return  # it was closed from its other end
        cuts, pairs, is_closed = self._follow(first, second)
        if not is_closed:
            n = next((i for i, cut in enumerate(cuts) if not cut.is_exact), len(cuts))
            cuts, pairs = cuts[:n], pairs[: n + 1]
        if not cuts:
            return
        self.n_cracks += 1
        self.pairs.update((min(pair), max(pair)) for pair in pairs if pair[0] != pair[1])
        of_one_edge = len({cut.edge.end for cut in cuts}) == 1
        for cut in cuts:
            self._split(cut)
            if cut.is_exact and of_one_edge:
                self.amid.append(AmidEdge(cut.vertex, cut.edge.start, cut.edge.end))

    def _follow(self, first: Side, second: Side) -> tuple[list[_Cut], list[tuple[int, int]], bool]:
        """The cuts along a crack, the vertices of both sides at the beginning and after each, and whether they meet."""
        sides, apexes = [first, second], [self._apex(first), self._apex(second)]
        cuts, pairs, used = list[_Cut](), [(first.start, second.start)], {frozenset(first), frozenset(second)}
        while self.place[sides[0].end] != self.place[sides[1].end]:
            i = 0 if self._length(sides[0]) > self._length(sides[1]) else 1  # the longer one is cut
            edge, vertex = sides[i], sides[1 - i].end
            offset = self._offset(edge, vertex)
            if offset > SLIT or self._is_folded(edge, vertex, apexes[i], apexes[1 - i]):
                return cuts, pairs, False
            cuts.append(_Cut(edge, apexes[i], vertex, offset <= EXACT))
            rest = Side(vertex, edge.end)
            ahead = [s for s in self.open[int(self.place[vertex])] if frozenset(s) not in used]
            if not ahead:
                return cuts, [*pairs, (vertex, vertex)], False
            following = max(ahead, key=lambda side: self._cosine(side, rest))
            used.add(frozenset(following))
            pairs.append((vertex, following.start))
            sides[i], sides[1 - i], apexes[1 - i] = rest, following, self._apex(following)
        return cuts, [*pairs, (sides[0].end, sides[1].end)], True

    def _split(self, cut: _Cut) -> None:
        """Split the face of a boundary edge at a vertex, which is then at the end of an open edge."""
        (y, q), c, p = cut.edge, cut.apex, cut.vertex
        number = next(f for f in self.edited.on_edge(y, q) if c in self.edited.face(f))
        j, k, l = self.edited.face(number)
        halves = [(p if j == v else j, p if k == v else k, p if l == v else l) for v in (q, y)]
        self.edited.replace([number], halves, {})
        if Side(y, q) in self.open[int(self.place[y])]:
            self._take(y, q)
        if self.place[q] != self.place[p]:
            self._put(p, q)

    def _apex(self, side: Side) -> int:
        return apex(self.edited.face(min(self.edited.on_edge(*side))), *side)

    def _length(self, side: Side) -> float:
        return float(np.linalg.norm(self.vertices[side.end] - self.vertices[side.start]))

    def _cosine(self, side: Side, other: Side) -> float:
        u, w = (self.vertices[s.end] - self.vertices[s.start] for s in (side, other))
        return float(u @ w / np.sqrt((u @ u) * (w @ w)))

    def _offset(self, edge: Side, vertex: int) -> float:
        """Distance of a vertex from an edge, over the distance to the nearer end along it; inf beside it."""
        along, to = (
            self.vertices[edge.end] - self.vertices[edge.start],
            self.vertices[vertex] - self.vertices[edge.start],
        )
        square = along @ along
        share = to @ along / square
        if not 0.0 < share < 1.0:
            return np.inf
        return float(np.linalg.norm(to - share * along) / (min(share, 1.0 - share) * np.sqrt(square)))

    def _is_folded(self, edge: Side, vertex: int, beside: int, across: int) -> bool:
        """The faces of both sides lie on each other, or a half of the one that is cut would be turned over."""
        start, end, p, c, d = (self.vertices[v] for v in (*edge, vertex, beside, across))
        along = end - start
        if lie_on_each_other(along[None], (c - start)[None], (d - start)[None])[0]:
            return True
        normal = np.cross(along, c - start)
        halves = np.cross(p - start, c - start), np.cross(c - end, p - end)
        turned = any(half @ normal <= 0.0 for half in halves)
        return turned or bool(self.edited.on_edge(vertex, beside))
