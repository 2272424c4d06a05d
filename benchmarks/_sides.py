"""Sides of generated parts and their meshes, remeshed or as CAD programs write them.

Each side is unrolled into a region of the plane between closed polylines.  Its border is sampled, its inside filled
with a jittered lattice, or left empty and cut into long triangles.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]
Map = Callable[[Floats], Floats]
Curvature = Callable[[Floats], Floats]


class Loop(NamedTuple):
    """A closed polyline of the plane; from point i to the next one lies a crease where `is_crease[i]`."""

    points: Floats
    is_crease: Bools


class Side(NamedTuple):
    """Loops of a region, the outer one first and counter-clockwise, its place in space, and mean curvature there."""

    loops: list[Loop]
    place: Map
    mean: Curvature
    more: Floats = np.empty((0, 2))
    """Points that its triangulation must have."""
    coarse: Indices | None = None
    """Triangles between the points of its border, if not any will do."""


class Sampling(NamedTuple):
    """Spacing of the vertices, or inf for borders of single edges, and the number of edges of a coarse circle."""

    spacing: float
    rng: np.random.Generator
    around: int = 24

    @property
    def is_coarse(self) -> bool:
        """Sides have no vertices inside."""
        return bool(np.isinf(self.spacing))

    def line(self, a: Floats, b: Floats) -> Floats:
        """Points from a to b, without b."""
        n = 1 if self.is_coarse else max(1, round(float(np.linalg.norm(np.subtract(b, a))) / self.spacing))
        return np.asarray(a) + np.subtract(b, a) * (np.arange(n) / n)[:, None]

    def arc(self, angle: float, radius: float) -> Floats:
        """Angles that divide an arc, with both ends."""
        whole = self.around if self.is_coarse else max(12.0, 2.0 * np.pi * radius / self.spacing)
        return np.linspace(0.0, angle, max(1, round(whole * abs(angle) / (2.0 * np.pi))) + 1)


def flat(points: Floats) -> Floats:
    """The mean curvature of a plane."""
    return np.zeros(len(points))


def plane(origin: object, e1: object, e2: object) -> Map:
    """The plane through a point along two unit vectors."""
    o, a, b = (np.asarray(v, np.float64) for v in (origin, e1, e2))
    return lambda p: o + p[:, :1] * a + p[:, 1:] * b


def all_creases(points: Floats) -> Loop:
    """A loop of creases."""
    return Loop(points, np.ones(len(points), np.bool_))


def closed_line(points: Floats, is_crease: list[bool], sampling: Sampling) -> Loop:
    """The polygon through the points, sampled; each of its sides is a crease or none."""
    pieces = [sampling.line(a, b) for a, b in zip(points, np.roll(points, -1, axis=0), strict=True)]
    return Loop(np.concatenate(pieces), np.repeat(is_crease, [len(p) for p in pieces]))


# ------------------------------------------------------------------ meshes of sides


def det(a: Floats, b: Floats) -> Floats:
    """Twice the area between vectors of the plane."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def inside(points: Floats, loops: list[Loop]) -> Bools:
    """Even-odd rule."""
    a = np.concatenate([loop.points for loop in loops])
    b = np.concatenate([np.roll(loop.points, -1, axis=0) for loop in loops])
    x, y = points[:, :1], points[:, 1:]
    spans = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = a[:, 0] + (y - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return (spans & (x < crossing)).sum(axis=1) % 2 == 1


def filled(side: Side, sampling: Sampling) -> tuple[Floats, Indices]:
    """Points and Delaunay triangles of a side with a jittered lattice inside."""
    h = sampling.spacing
    fixed = np.concatenate([*(loop.points for loop in side.loops), side.more])
    low, high = fixed.min(axis=0), fixed.max(axis=0)
    i, j = np.mgrid[0 : int((high[0] - low[0]) / h) + 2, 0 : int((high[1] - low[1]) / (0.866 * h)) + 2]
    lattice = low + h * np.stack([i + 0.5 * (j % 2), 0.866 * j], axis=-1).reshape(-1, 2)
    lattice += 0.25 * h * sampling.rng.uniform(-1, 1, lattice.shape)
    clear = np.linalg.norm(lattice[:, None] - fixed, axis=2).min(axis=1) > 0.6 * h
    points = np.concatenate([fixed, lattice[inside(lattice, side.loops) & clear]])
    F = Delaunay(points).simplices.astype(np.intp)
    F = F[inside(points[F].mean(axis=1), side.loops)]
    areas = det(points[F[:, 1]] - points[F[:, 0]], points[F[:, 2]] - points[F[:, 0]])
    F, areas = F[np.abs(areas) > 1e-9 * h * h], areas[np.abs(areas) > 1e-9 * h * h]
    return points, np.where(areas[:, None] < 0, F[:, ::-1], F)


def cut_up(side: Side) -> tuple[Floats, Indices]:
    """Points of the border alone and triangles between them, cut off one after the other if not given."""
    points = np.concatenate([loop.points for loop in side.loops])
    if side.coarse is not None:
        return points, side.coarse
    ring, start = list(range(len(side.loops[0].points))), len(side.loops[0].points)
    for loop in side.loops[1:]:
        hole = start + np.arange(len(loop.points))
        start += len(hole)
        if det(loop.points, np.roll(loop.points, -1, axis=0)).sum() > 0:
            hole = hole[::-1]
        gaps = np.linalg.norm(points[ring][:, None] - points[hole], axis=2)
        i, j = np.unravel_index(np.argmin(gaps), gaps.shape)
        ring = [*ring[: i + 1], *np.roll(hole, -j), hole[j], *ring[i:]]
    triangles = []
    while len(ring) > 3:
        ears = [k for k in range(len(ring)) if is_ear(points, ring, k)]
        k = min(ears, key=lambda k: np.linalg.norm(points[ring[k - 1]] - points[ring[(k + 1) % len(ring)]]))
        triangles.append((ring[k - 1], ring[k], ring[(k + 1) % len(ring)]))
        del ring[k]
    return points, np.array([*triangles, ring], np.intp)


def is_ear(points: Floats, ring: list[int], k: int) -> bool:
    """No other point of the ring lies in the triangle at its place k, which is convex there."""
    a, b, c = (points[ring[(k + i) % len(ring)]] for i in (-1, 0, 1))
    size = np.linalg.norm(c - a) ** 2
    if det(b - a, c - b) <= 1e-9 * size:
        return False
    others = points[[v for v in ring if v not in {ring[k - 1], ring[k], ring[(k + 1) % len(ring)]}]]
    edges = ((a, b), (b, c), (c, a))
    return not np.any(np.all([det(q - p, others - p) >= -1e-9 * size for p, q in edges], axis=0))
