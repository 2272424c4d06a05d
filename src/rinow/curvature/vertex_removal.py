"""Vertex removal: vertices that tell nothing about a surface leave its mesh, and get the values of their neighbours.

Those amid an edge lie on the chord, not on the surface (`caps`, `cracks`); others are `redundant` or `outliers`.
"""

from __future__ import annotations

from collections.abc import Iterable
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

BETWEEN = 0.5
"""Share of the mean difference of the ends from their mean that counts as the error of the latter."""


class Removed(NamedTuple):
    """A vertex that was taken out, and those whose values it has in the mean, or without weights those of the first.

    Without weights the last end is the farthest of all around: what it differs by from the first counts half.
    """

    vertex: int
    ends: tuple[int, ...]
    weights: tuple[float, ...] = ()

    @classmethod
    def amid(cls, vertex: int, start: int, end: int, share: float) -> Removed:
        """A vertex between the ends of an edge, at this share of its length from the first."""
        return cls(vertex, (start, end), (1.0 - share, share))


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
            around = sorted({v for number in edited.star(t) for v in edited.face(number)} - {t})
            if _remove_from_triangle(edited, t):
                removed.append(_with_weights(t, zip(around, _shares(edited.positions, t, around), strict=True)))
        elif edited.on_edge(a, t) and edited.on_edge(t, b):
            at, tb = edited.length(a, t), edited.length(t, b)
            if _remove(edited, place):
                removed.append(Removed.amid(*place, at / (at + tb)))
    return edited.result(), [*_on_whole_edges(removed[::-1]), *split]


def _without_splits(mesh: TriangleMesh) -> tuple[TriangleMesh, list[Removed]]:
    """The mesh whose faces were not split in their plane, and the vertices that it is without."""
    found = coarser(mesh)
    if found is None:
        return mesh, []
    rows = zip(found.vertices.tolist(), found.corners.tolist(), found.weights.tolist(), strict=True)
    return found.mesh, [_with_weights(t, zip(ends, weights, strict=True)) for t, ends, weights in rows]


def _with_weights(vertex: int, parts: Iterable[tuple[int, float]]) -> Removed:
    """A vertex whose values are a mean, each vertex once."""
    total: dict[int, float] = {}
    for v, weight in parts:
        if weight != 0.0:
            total[v] = total.get(v, 0.0) + weight
    return Removed(vertex, tuple(total), tuple(total.values()))


def _on_whole_edges(removed: list[Removed]) -> list[Removed]:
    """The vertices between others that were taken out, as between the ends of the edge that these are on."""
    found: dict[int, Removed] = {}
    for t, ends, weights in removed:
        parts = list[tuple[int, float]]()
        for v, weight in zip(ends, weights, strict=False):
            whole = found.get(v, Removed(v, ()))
            parts += [(u, weight * x) for u, x in zip(whole.ends, whole.weights, strict=False)] or [(v, weight)]
        found[t] = _with_weights(t, parts) if weights else Removed(t, ends)
    return list(found.values())


def give_values(estimate: Estimate, status: NDArray[np.uint8], removed: list[Removed]) -> None:
    """Give the vertices that were taken out the values of the nearest of their ends, and the worst status of all.

    Between ends that are all known the curvatures are the means of theirs.  The spread also holds what the ends differ
    by: that of a surface whose curvature changes along an edge as much as it may.
    """
    for t, ends, weights in removed:
        nearest = ends[int(np.argmax(weights))] if weights else ends[0]
        estimate.put(np.array([t]), np.array([nearest]))
        status[t] = max(status[v] for v in ends)
        around = estimate.gaussian[list(ends)]
        if weights and np.isfinite(around).all():
            _put_mean(estimate, t, list(ends), np.array(weights))
        else:
            step = 0.5 * float(around[-1] - around[0])
            estimate.spread[t] = hypot(estimate.spread[t], step if isfinite(step) else 0.0)


def _put_mean(estimate: Estimate, vertex: int, ends: list[int], weights: Floats) -> None:
    """The weighted mean of the curvatures of some ends, to which a vertex has the values of the nearest."""
    values = estimate.gaussian[ends]
    estimate.gaussian[vertex] = gaussian = float(weights @ values)
    error = BETWEEN * float(np.abs(weights) @ np.abs(values - gaussian))
    estimate.spread[vertex] = hypot(float(weights @ estimate.spread[ends]), error)
    if estimate.mean is not None and estimate.k1 is not None and estimate.k2 is not None:
        estimate.mean[vertex] = mean = float(weights @ estimate.mean[ends])
        half = max(mean * mean - gaussian, 0.0) ** 0.5
        estimate.k1[vertex], estimate.k2[vertex] = mean + half, mean - half


def _beside(edited: EditedFaces, vertex: int, around: set[int]) -> Removed:
    """A vertex beside the nearest of those around, and the one farthest from that."""
    near = min(sorted(around), key=lambda v: edited.length(vertex, v))
    return Removed(vertex, (near, max(sorted(around), key=lambda v: edited.length(near, v))))


def _shares(positions: Floats, vertex: int, corners: list[int]) -> list[float]:
    """The parts of the area of a triangle opposite to its corners, as seen from a vertex in it."""
    spokes: Floats = positions[corners] - positions[vertex]
    areas = np.linalg.norm(np.cross(spokes[[1, 2, 0]], spokes[[2, 0, 1]]), axis=1)
    return (areas / areas.sum()).tolist()


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
