"""Single vertices far beside a surface, told by angles: without them the surface goes on as it is around."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.edits import EditedFaces, Face
from rinow.curvature.polygons import Place, triangulated
from rinow.curvature.stencils import ring_means
from rinow.mesh import TriangleMesh

__all__ = ["fill_without", "outlying_vertices"]

Floats = NDArray[np.float64]

LEAST = 0.25
"""Angle defect in radians from which on a vertex is looked at: that of one 0.3 spacings beside the surface."""
PEAK, PASSES = 6.0, 3
"""Squared defect over its mean over so many rings: one that stands alone has ten times it, noise rarely five times."""
CLEAR = 8.0
"""Largest defect around before over that afterwards, over that farther away, and over the sum around, which stays: a
tip or a corner has all of its defect as a sum."""


def outlying_vertices(mesh: TriangleMesh) -> list[int]:
    """Vertices that the surface is better without, no two of them beside each other.

    A vertex that was moved has a defect of one sign, its neighbours have as much of the other one, and nobody farther
    away has any to speak of.  It is that of these whose removal leaves the least.
    """
    t = mesh.topology
    inner = t.vertex_is_manifold & ~t.vertex_is_boundary
    defects = np.where(inner, mesh.vertex_angle_defects, 0.0)
    peaks = np.abs(defects) >= LEAST
    if not peaks.any():
        return []
    peaks &= defects**2 >= PEAK * ring_means(mesh, defects**2, PASSES)
    found, touched = list[int](), set[int]()
    edited = EditedFaces(mesh)
    rows = np.flatnonzero(peaks)
    for v in rows[np.argsort(-np.abs(defects[rows]), kind="stable")].tolist():
        zone = {v, *_neighbours(mesh, v)}
        around = {w for u in zone for w in _neighbours(mesh, u)}
        before = abs(float(defects[v]))
        left = before / CLEAR
        members = list(zone)
        if touched & around or not inner[members].all() or abs(float(defects[members].sum())) > left:
            continue
        if any(abs(defects[w]) > left for w in around - zone):
            continue
        trials = {u: max(_defects_without(edited, defects, u, zone), default=np.inf) for u in sorted(zone)}
        best = min(trials, key=lambda u: trials[u])
        if trials[best] <= left:
            found.append(best)
            touched |= around
    return found


def _neighbours(mesh: TriangleMesh, vertex: int) -> list[int]:
    t = mesh.topology
    return t.neighbours[t.neighbour_offsets[vertex] : t.neighbour_offsets[vertex + 1]].tolist()


def _defects_without(edited: EditedFaces, defects: Floats, vertex: int, zone: set[int]) -> Iterator[float]:
    """Sizes of the defects around when the star of a vertex is filled; none if it cannot be."""
    new = fill_without(edited, vertex)
    if new is None:
        return
    star = [edited.face(number) for number in edited.star(vertex)]
    ring = {v for face in star for v in face} - {vertex}
    for v in (zone | ring) - {vertex}:
        change = sum(_angle_at(edited, face, v) for face in star) - sum(_angle_at(edited, face, v) for face in new)
        yield abs(float(defects[v]) + change)


def _angle_at(edited: EditedFaces, face: Face, vertex: int) -> float:
    if vertex not in face:
        return 0.0
    i = face.index(vertex)
    p, q, r = edited.positions[list(face[i:] + face[:i])]
    u, w = q - p, r - p
    return float(np.arctan2(np.linalg.norm(np.cross(u, w)), u @ w))


def fill_without(edited: EditedFaces, vertex: int) -> list[Face] | None:
    """Triangles of the neighbours of a vertex in the place of its star; None where that is no simple polygon."""
    after: dict[int, int] = {}
    for number in edited.star(vertex):
        face = edited.face(number)
        i = face.index(vertex)
        after[face[(i + 1) % 3]] = face[(i + 2) % 3]
    ring = [min(after)] if after else []
    while ring and after.get(ring[-1], ring[0]) != ring[0] and len(ring) <= len(after):
        ring.append(after[ring[-1]])
    if len(ring) < 3 or len(ring) != len(after) or after.get(ring[-1]) != ring[0]:
        return None
    p = edited.positions[ring]
    p = p - p.mean(axis=0)
    normal = np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)
    across = np.cross(normal, p[0])
    size = np.linalg.norm(across)
    if not size > 0.0:
        return None
    across /= size
    along = np.cross(across, normal / np.linalg.norm(normal))
    flat: dict[int, Place] = dict(zip(ring, zip((p @ along).tolist(), (p @ across).tolist(), strict=True), strict=True))
    return triangulated(edited, flat, ring)
