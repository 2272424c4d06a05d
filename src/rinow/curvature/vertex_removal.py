"""Vertex removal: vertices that tell nothing about a surface leave its mesh, and get the values of a neighbour.

Those amid an edge lie on the chord, not on the surface (`caps`, `cracks`); others are `redundant` or `outliers`.
"""

from __future__ import annotations

from math import cos, hypot, isfinite, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.caps import AmidEdge
from rinow.curvature.ear_clipping import angle_between, triangulated
from rinow.curvature.edits import EditedFaces, Face
from rinow.curvature.estimate import Estimate, Floats
from rinow.curvature.outliers import fill_without, outlying_vertices
from rinow.curvature.redundant import redundant_vertices
from rinow.curvature.subdivided import coarser
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["Removed", "give_values", "without_edge_points", "without_strays"]

Mesh = TriangleMesh | IntrinsicMesh

BEND = 0.75
"""Largest angle, in radians, between the faces on one side of the edge, and by which their angles at the vertex miss π:
less than at a chamfer, where the vertex may be a corner."""

MIDDLE = 1e-6
"""Share of the edge by which a vertex may miss its middle: far above rounding."""
BESIDE = 0.5 - 2.0 * MIDDLE
"""Share of a vertex that is on no edge: the first end is the nearer one, what both differ by counts half."""


class Removed(NamedTuple):
    """A vertex that was taken out, the ends of its edge, and its distance from the first over the whole length."""

    vertex: int
    start: int
    end: int
    share: float


def without_strays(mesh: Mesh, amid: list[AmidEdge]) -> tuple[Mesh, list[Removed]]:
    """`without_edge_points`, and with positions without vertices far beside the surface (`outlying_vertices`)."""
    mesh, removed = without_edge_points(mesh, amid)
    if isinstance(mesh, IntrinsicMesh):
        return mesh, removed
    edited, strays = EditedFaces(mesh), list[Removed]()
    for t in outlying_vertices(mesh):
        star, new = edited.star(t), fill_without(edited, t)
        if new is not None:
            place = _beside(edited, t, {v for face in new for v in face})
            edited.replace(star, new, {})
            strays.append(place)
    return edited.result(), [*strays, *removed]


def without_edge_points(mesh: Mesh, amid: list[AmidEdge]) -> tuple[Mesh, list[Removed]]:
    """The mesh with the stars of vertices amid an edge filled, where the surface is smooth, and those vertices.

    With positions it is also without other vertices that lie on a face or an edge of the rest (`coarser`,
    `redundant_vertices`).

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface.
    amid : list of AmidEdge
        Vertices on an edge, those that were put between others after these.

    Returns
    -------
    mesh : TriangleMesh or IntrinsicMesh
        The vertices are those of before; the ones in question have no face.
    removed : list of Removed
        Which ones, each after those that its values depend on.
    """
    split = list[Removed]()
    if isinstance(mesh, TriangleMesh):
        mesh, split = _without_splits(mesh)
        known = {place.vertex for place in amid}
        amid = [*amid, *(place for place in redundant_vertices(mesh) if place.vertex not in known)]
    if not amid:
        return mesh, split
    edited, removed = EditedFaces(mesh), list[Removed]()
    for place in reversed(amid):
        t, a, b = place
        if a == b:
            around = {v for number in edited.star(t) for v in edited.face(number)} - {t}
            if _remove_from_triangle(edited, t):
                removed.append(_beside(edited, t, around))
        elif edited.on_edge(a, t) and edited.on_edge(t, b):
            at, tb = edited.length(a, t), edited.length(t, b)
            if _remove(edited, place):
                removed.append(Removed(*place, at / (at + tb)))
    return edited.result(), [*_on_whole_edges(removed[::-1]), *split]


def _without_splits(mesh: TriangleMesh) -> tuple[TriangleMesh, list[Removed]]:
    """The mesh whose faces were not split in their plane, and the vertices that it is without."""
    found = coarser(mesh)
    if found is None:
        return mesh, []
    shares = np.where(np.isnan(found.shares), BESIDE, found.shares)
    rows = zip(found.vertices.tolist(), *found.ends.T.tolist(), shares.tolist(), strict=True)
    return found.mesh, [Removed(*row) for row in rows]


def _on_whole_edges(removed: list[Removed]) -> list[Removed]:
    """The vertices between others that were taken out, as between the ends of the edge that these are on."""
    found: dict[int, Removed] = {}
    for t, a, b, share in removed:
        whole = found.get(a) or found.get(b) or Removed(t, a, b, share)
        places = {whole.start: 0.0, whole.end: 1.0} | {x: found[x].share for x in (a, b) if x in found}
        place = (1.0 - share) * places[a] + share * places[b] if a in places and b in places else None
        found[t] = Removed(t, a, b, share) if place is None else Removed(t, whole.start, whole.end, place)
    return list(found.values())


def give_values(estimate: Estimate, status: NDArray[np.uint8], removed: list[Removed]) -> None:
    """Give the vertices that were taken out the values of the nearer end of their edge, and the worse status of both.

    Of ends that are equally near it is the one with the smaller spread.  The spread also holds what the ends differ by,
    as far as the vertex is on the way.
    """
    for t, a, b, share in removed:
        is_first = share < 0.5 if abs(share - 0.5) > MIDDLE else estimate.spread[a] <= estimate.spread[b]
        near, far, part = (a, b, share) if is_first else (b, a, 1.0 - share)
        estimate.put(np.array([t]), np.array([near]))
        step = part * (estimate.gaussian[far] - estimate.gaussian[near])
        estimate.spread[t] = hypot(estimate.spread[near], step if isfinite(step) else 0.0)
        status[t] = max(status[a], status[b])


def _beside(edited: EditedFaces, vertex: int, around: set[int]) -> Removed:
    """A vertex beside the nearest of those around; what that and the one farthest from it differ by counts half."""
    near = min(sorted(around), key=lambda v: edited.length(vertex, v))
    return Removed(vertex, near, max(sorted(around), key=lambda v: edited.length(near, v)), BESIDE)


def _remove_from_triangle(edited: EditedFaces, vertex: int) -> bool:
    """Put one face in the place of the three around a vertex, if these are still what they were."""
    star = sorted(edited.star(vertex))
    corners = {v for number in star for v in edited.face(number)} - {vertex}
    if len(star) != 3 or len(corners) != 3:
        return False
    x, y, z = edited.face(star[0])
    third = next(v for v in corners if v not in (x, y, z))
    face = tuple(third if v == vertex else v for v in (x, y, z))
    edited.replace(star, [(face[0], face[1], face[2])], {})
    return True


def _remove(edited: EditedFaces, place: AmidEdge) -> bool:
    """Fill the star of a vertex with triangles of its neighbours; whether that can be done."""
    t, a, b = place
    star = edited.star(t)
    sides = _two_sides(edited, place)
    if sides is None:
        return False
    if len(edited.on_edge(a, b) - star) + sum(len(side) > 2 for side in sides) != 2:
        return False
    new, lengths = list[Face](), {frozenset((a, b)): edited.length(a, t) + edited.length(t, b)}
    for side in sides:
        filled = _filled(edited, t, side, lengths)
        if filled is None:
            return False
        new += filled
    edited.replace(star, new, lengths)
    return True


def _two_sides(edited: EditedFaces, place: AmidEdge) -> list[list[int]] | None:
    """The neighbours of a vertex from one end of its edge to the other on both sides; None without a closed star."""
    t, a, b = place
    links: dict[int, list[int]] = {}
    for number in edited.star(t):
        u, w = (v for v in edited.face(number) if v != t)
        links.setdefault(u, []).append(w)
        links.setdefault(w, []).append(u)
    if any(len(ends) != 2 for ends in links.values()) or a not in links or b not in links:
        return None
    sides = list[list[int]]()
    for following in links[a]:
        side = [a, following]
        while side[-1] not in (a, b):
            before, here = side[-2:]
            one, other = links[here]
            side.append(other if one == before else one)
        sides.append(side)
    if any(side[-1] == a for side in sides) or sum(map(len, sides)) != len(links) + 2:
        return None
    return sides


def _filled(edited: EditedFaces, t: int, side: list[int], lengths: dict[frozenset[int], float]) -> list[Face] | None:
    """Triangles of the neighbours on one side, and the lengths of new edges; None where the surface has a corner."""
    if len(side) == 2:
        return []
    radii = [edited.length(t, v) for v in side]
    angles = [angle_between(radii[i], radii[i + 1], edited.length(side[i], side[i + 1])) for i in range(len(side) - 1)]
    if abs(sum(angles) - pi) > BEND or _bends(edited.mesh, t, side):
        return None
    turns = np.cumsum([0.0, *angles]) * (pi / sum(angles))
    flat = {v: (r * cos(turn), r * sin(turn)) for v, r, turn in zip(side, radii, turns.tolist(), strict=True)}
    first = next(f for f in edited.on_edge(t, side[0]) if side[1] in edited.face(f))
    x, y, z = edited.face(first)
    is_left = (t, side[0], side[1]) in ((x, y, z), (y, z, x), (z, x, y))
    found = triangulated(edited, flat, side)
    for u, v, w in found or []:
        for p, q in ((u, v), (v, w), (w, u)):
            lengths.setdefault(frozenset((p, q)), hypot(flat[p][0] - flat[q][0], flat[p][1] - flat[q][1]))
    return found if is_left or found is None else [(w, v, u) for u, v, w in found]


def _bends(mesh: Mesh, t: int, side: list[int]) -> bool:
    """With positions: the faces on one side have normals that differ much."""
    if isinstance(mesh, IntrinsicMesh):
        return False
    spokes: Floats = mesh.vertices[side] - mesh.vertices[t]
    normals = np.cross(spokes[:-1], spokes[1:])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny)[:, None]
    return bool((normals @ normals.T).min() < cos(BEND))
