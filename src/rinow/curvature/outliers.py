"""Outliers: single vertices far beside a surface, told by angle defects, which vanish around without them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.ear_clipping import Place, triangulated
from rinow.curvature.edits import EditedFaces, Face
from rinow.curvature.stencils import ring_means
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["fill_without", "outlying_vertices"]

Mesh = TriangleMesh | IntrinsicMesh
Floats = NDArray[np.float64]

LEAST = 0.25
"""Angle defect in radians from which on a vertex is looked at: that of one 0.3 spacings above the surface."""
FAR, ASIDE = 0.4, 0.1
"""Height over its neighbours, and distance from a place among them, over the mean edge around: below that a fill is no
better."""
NOISE = 4.5
"""Typical angle defect over the squared noise, in mean edges, of a surface with noise in all directions."""
HIGH, WIDE = 8.0, 4.0
"""The same two over the noise around: below that it may be noise, which fits are made for."""
PEAK, PASSES = 6.0, 3
"""Squared defect over its mean over so many rings: one that stands alone has ten times it, noise rarely five times."""
CLEAR = 8.0
"""Largest defect around before over that afterwards, over that farther away, and over the sum around, which stays: a
tip or a corner has all of its defect as a sum."""


def outlying_vertices(mesh: TriangleMesh) -> list[int]:
    """Vertices that the surface is better without, no two of them beside each other.

    A vertex that was moved has a defect of one sign, its neighbours have as much of the other one, and none beyond has
    any to speak of.  Of these the outlier is the one whose removal leaves the least defects, if it is far from the
    polygon of its neighbours.  None is looked for at a boundary, where half of that is not seen.
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
        total = abs(float(defects[list(zone)].sum()))
        if touched & around or not inner[list(around)].all() or total > left:
            continue
        if any(abs(defects[w]) > left for w in around - zone):
            continue
        trials = {u: _largest_without(edited, defects, u, zone, left) for u in sorted(zone)}
        best = min(trials, key=lambda u: trials[u])
        if trials[best] <= left and _is_far(edited, best, around - {best}, _noise(mesh, defects, around, zone)):
            found.append(best)
            touched |= around
    return found


def _neighbours(mesh: Mesh, vertex: int) -> list[int]:
    t = mesh.topology
    return t.neighbours[t.neighbour_offsets[vertex] : t.neighbour_offsets[vertex + 1]].tolist()


def _largest_without(edited: EditedFaces, defects: Floats, vertex: int, zone: set[int], most: float) -> float:
    """Largest defect around when the star of a vertex is filled; inf if it cannot be, or above `most`."""
    star = [edited.face(number) for number in edited.star(vertex)]
    ring = {v for face in star for v in face} - {vertex}
    if any(abs(defects[v]) > most for v in zone - ring - {vertex}):  # the fill does not touch these
        return np.inf
    new = fill_without(edited, vertex)
    if new is None:
        return np.inf
    largest = 0.0
    for v in (zone | ring) - {vertex}:
        change = sum(_angle_at(edited, face, v) for face in star) - sum(_angle_at(edited, face, v) for face in new)
        defect = abs(float(defects[v]) + change)
        if not defect <= most:
            return np.inf
        largest = max(largest, defect)
    return largest


def _angle_at(edited: EditedFaces, face: Face, vertex: int) -> float:
    if vertex not in face:
        return 0.0
    i = face.index(vertex)
    p, q, r = edited.positions[list(face[i:] + face[:i])]
    u, w = q - p, r - p
    return float(np.arctan2(np.linalg.norm(np.cross(u, w)), u @ w))


def _noise(mesh: TriangleMesh, defects: Floats, around: set[int], zone: set[int]) -> float:
    """Noise over the mean edge by how angle defects beside a zone scatter."""
    beside = {w for u in around for w in _neighbours(mesh, u)} - zone
    values = defects[sorted(beside)] if beside else np.zeros(1)
    return float(np.sqrt(np.median(np.abs(values - np.median(values))) / NOISE))


def _is_far(edited: EditedFaces, vertex: int, around: set[int], noise: float) -> bool:
    """The vertex is beside the polygon of its neighbours, above it or in its plane, by more than noise.

    In the plane that is by the height of a face that is turned over: so far a corner of it was moved at least.
    """
    ring = _ring(edited, vertex)
    polygon = None if ring is None else _flattened(edited.positions[ring], edited.positions[vertex])
    if polygon is None:
        return False
    corners, at, height = polygon
    spokes = corners - at
    following = np.roll(spokes, -1, axis=0)
    longest = np.max([np.hypot(*side.T) for side in (spokes, following, following - spokes)], axis=0)
    folded = spokes[:, 1] * following[:, 0] - spokes[:, 0] * following[:, 1]
    aside = max(0.0, float(np.max(folded / np.maximum(longest, np.finfo(float).tiny))))
    edges = [edited.length(u, w) for u in around for w in _neighbours(edited.mesh, u) if w in around]
    least = max(ASIDE, WIDE * noise), max(FAR, HIGH * noise)
    return bool(np.hypot(aside / least[0], height / least[1]) > np.mean(edges))


def _ring(edited: EditedFaces, vertex: int) -> list[int] | None:
    """The neighbours of a vertex in their order; None without a closed star of faces that agree."""
    after: dict[int, int] = {}
    for number in edited.star(vertex):
        face = edited.face(number)
        i = face.index(vertex)
        after[face[(i + 1) % 3]] = face[(i + 2) % 3]
    ring = [min(after)] if after else []
    while ring and after.get(ring[-1], ring[0]) != ring[0] and len(ring) <= len(after):
        ring.append(after[ring[-1]])
    closed = len(ring) >= 3 and len(ring) == len(after) and after.get(ring[-1]) == ring[0]
    return ring if closed else None


def _flattened(polygon: Floats, point: Floats) -> tuple[Floats, Floats, float] | None:
    """A polygon and a point in its mean plane, and the height of the point; None without a plane."""
    centre = polygon.mean(axis=0)
    p = polygon - centre
    normal = np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)
    across = np.cross(normal, p[0])
    size, area = np.linalg.norm(across), np.linalg.norm(normal)
    if not (size > 0.0 and area > 0.0):
        return None
    plane = np.stack([np.cross(across / size, normal / area), across / size], axis=1)
    return p @ plane, (point - centre) @ plane, abs(float((point - centre) @ normal / area))


def fill_without(edited: EditedFaces, vertex: int) -> list[Face] | None:
    """Triangles of the neighbours of a vertex in the place of its star; None where that is no simple polygon."""
    ring = _ring(edited, vertex)
    polygon = None if ring is None else _flattened(edited.positions[ring], edited.positions[vertex])
    if ring is None or polygon is None:
        return None
    flat: dict[int, Place] = {v: (x, y) for v, (x, y) in zip(ring, polygon[0].tolist(), strict=True)}
    return triangulated(edited, flat, ring)
