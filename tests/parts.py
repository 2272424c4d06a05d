"""Generated solids whose creases, corners and cone points are known: the features of every mesh, by its indices.

Each side of a solid is a polygon in the plane, or a piece of a cylinder or cone that is unrolled into one.  Its border
is sampled evenly, its inside filled with a jittered lattice, and both are triangulated; then the sides are welded.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Map = Callable[[Floats], Floats]

WELD_DECIMALS = 9
APEX_FACES = 6
"""Faces around the apex of a cone: two or three would fold flat or hide its angle."""


class Part(NamedTuple):
    """A closed mesh and its features: creases as sorted pairs of vertices, corners, and cone points with angles."""

    vertices: Floats
    faces: Indices
    creases: Indices
    corners: Indices
    cone_points: Indices
    cone_angles: Floats


# ------------------------------------------------------------------ solids


def box(h: float = 0.2, size: tuple[float, float, float] = (1.0, 1.3, 0.8), seed: int = 7) -> Part:
    """A box: twelve creases of a right angle, eight corners of cone angle 3π/2."""
    x, y, z = size
    return prism(np.array([(0, 0), (x, 0), (x, y), (0, y)]), z, h, seed)


def l_shape(h: float = 0.2, seed: int = 7) -> Part:
    """A thick L: eighteen creases, one of them concave, twelve corners, two of them of cone angle 5π/2."""
    return prism(np.array([(0, 0), (1.6, 0), (1.6, 0.7), (0.7, 0.7), (0.7, 1.5), (0, 1.5)]), 0.8, h, seed)


def regular_prism(n_sides: int, h: float = 0.2, height: float = 1.2, seed: int = 7) -> Part:
    """A right prism over a regular polygon of circumradius 1."""
    t = 2 * np.pi * np.arange(n_sides) / n_sides
    return prism(np.stack([np.cos(t), np.sin(t)], axis=1), height, h, seed)


def prism(polygon: Floats, height: float, h: float, seed: int = 7) -> Part:
    """A right prism over a polygon given counter-clockwise."""
    rng = np.random.default_rng(seed)
    n = len(polygon)
    lid = _fill(polygon, [True] * n, h, rng)
    sides = [_placed(_plane((0, 0, height), (1, 0, 0), (0, 1, 0)), lid)]
    sides.append(_placed(_plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), _fill(polygon, [True] * n, h, rng), turn=True))
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        length = np.linalg.norm(b - a)
        wall = np.array([(0, 0), (length, 0), (length, height), (0, height)])
        along = np.append((b - a) / length, 0.0)
        sides.append(_placed(_plane((*a, 0), along, (0, 0, 1)), _fill(wall, [True] * 4, h, rng)))
    corners = np.concatenate([np.column_stack([polygon, np.full(n, z)]) for z in (0.0, height)])
    before, after = np.roll(polygon, 1, axis=0) - polygon, np.roll(polygon, -1, axis=0) - polygon
    inner = np.arctan2(_det(after, before), (after * before).sum(axis=1)) % (2 * np.pi)
    return _welded(sides, corners=corners, cones=corners, angles=np.tile(inner + np.pi, 2))


def cylinder(h: float = 0.2, radius: float = 1.0, height: float = 1.5, seed: int = 7) -> Part:
    """A cylinder with flat lids: two circular creases and no corner."""
    rng = np.random.default_rng(seed)
    wall = np.array([(0, 0), (2 * np.pi * radius, 0), (2 * np.pi * radius, height), (0, height)])

    def roll(p: Floats) -> Floats:
        t = p[:, 0] / radius
        return np.stack([radius * np.cos(t), radius * np.sin(t), p[:, 1]], axis=1)

    n = len(_line(wall[0], wall[1], h)) - 1
    sides = [_placed(roll, _fill(wall, [True, False, True, False], h, rng))]
    for z in (0.0, height):
        sides.append(_placed(_plane((0, 0, z), (1, 0, 0), (0, 1, 0)), _disk(n, radius, h, rng), turn=z == 0.0))
    return _welded(sides)


def cone(h: float = 0.2, slope: float = 1.0, radius: float = 1.0, seed: int = 7) -> Part:
    """A cone on a flat lid: one circular crease, no corner, and an apex of cone angle 2π sin(half-angle)."""
    rng = np.random.default_rng(seed)
    flank = radius * np.hypot(1.0, slope)
    opening = 2 * np.pi * radius / flank  # of the unrolled sector
    n = max(12, round(2 * np.pi * radius / h))
    t = opening * np.arange(n + 1) / n
    rim = flank * np.stack([np.cos(t), np.sin(t)], axis=1)
    down = _line(np.zeros(2), rim[0], h)
    back = _line(rim[-1], np.zeros(2), h)
    border = np.concatenate([down[:-1], rim[:-1], back[:-1]])
    marked = np.zeros(len(border), bool)
    marked[len(down) - 1 : len(down) - 1 + n] = True

    def roll(p: Floats) -> Floats:
        s, angle = np.linalg.norm(p, axis=1), np.arctan2(p[:, 1], p[:, 0]) % (2 * np.pi)
        a = 2 * np.pi / opening * np.where(angle > opening + 1e-6, 0.0, angle)
        r = s * radius / flank
        return np.stack([r * np.cos(a), r * np.sin(a), slope * (radius - r)], axis=1)

    t = opening * np.arange(1, APEX_FACES) / APEX_FACES
    around_apex = np.linalg.norm(down[1]) * np.stack([np.cos(t), np.sin(t)], axis=1)
    sides = [_placed(roll, _triangulated(border, marked, h, rng, around_apex))]
    sides.append(_placed(_plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), _disk(n, radius, h, rng), turn=True))
    apex = np.array([(0.0, 0.0, slope * radius)])
    return _welded(sides, cones=apex, angles=np.array([opening]))


def rounded_box(n: int = 24, fillet: float = 0.35, seed: int = 7) -> Part:
    """A box of half side 1 with round edges: no crease and no corner, but jumps of curvature."""
    from shapes import box as grid_box

    V, F = grid_box(n)[:2]
    V = 2.0 * V - 1.0
    core = np.clip(V, fillet - 1.0, 1.0 - fillet)
    # Even angles on the fillets: the offset from the core is stretched by tan(π/4 · offset).
    offset = np.sign(V - core) * np.tan(np.pi / 4 * np.abs(V - core) / fillet)
    offset /= np.maximum(np.linalg.norm(offset, axis=1), 1e-12)[:, None]
    rng = np.random.default_rng(seed)
    V = core + fillet * offset
    return _without_features(V, _some_diagonals_turned(F, rng))


# ------------------------------------------------------------------ changes


def noisy(part: Part, amount: float, seed: int = 11) -> Part:
    """Gaussian noise of `amount` times the mean edge length on every coordinate; the features stay."""
    ends = part.vertices[part.faces]
    h = np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2).mean()
    noise = np.random.default_rng(seed).normal(size=part.vertices.shape)
    return part._replace(vertices=part.vertices + amount * h * noise)


def with_features() -> dict[str, Callable[[float], Part]]:
    """Solids by name, as functions of the spacing."""
    return {
        "box": box,
        "triangular prism": lambda h: regular_prism(3, h),
        "pentagonal prism": lambda h: regular_prism(5, h),
        "hexagonal prism": lambda h: regular_prism(6, h),
        "L-shape": l_shape,
        "cylinder": cylinder,
        "cone": cone,
        "flat cone": lambda h: cone(h, slope=0.5),
        "steep cone": lambda h: cone(h, slope=2.0),
    }


# ------------------------------------------------------------------ sides


class _Side(NamedTuple):
    points: Floats
    faces: Indices
    creases: Indices


def _det(a: Floats, b: Floats) -> Floats:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _line(a: Floats, b: Floats, h: float) -> Floats:
    n = max(1, round(float(np.linalg.norm(b - a)) / h))
    return a + (b - a) * (np.arange(n + 1) / n)[:, None]


def _fill(polygon: Floats, is_crease: list[bool], h: float, rng: np.random.Generator) -> _Side:
    """A polygon; `is_crease` tells for each of its sides whether the solid has a crease there."""
    pieces = [_line(a, b, h)[:-1] for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True)]
    marked = np.repeat(is_crease, [len(p) for p in pieces])
    return _triangulated(np.concatenate(pieces), marked, h, rng)


def _disk(n: int, radius: float, h: float, rng: np.random.Generator) -> _Side:
    t = 2 * np.pi * np.arange(n) / n
    rim = radius * np.stack([np.cos(t), np.sin(t)], axis=1)
    return _triangulated(rim, np.ones(n, bool), h, rng)


def _triangulated(
    border: Floats, marked: NDArray[np.bool_], h: float, rng: np.random.Generator, more: Floats | None = None
) -> _Side:
    """Delaunay triangles inside a sampled border; point i and the next one bound a crease where `marked[i]`."""
    fixed = border if more is None else np.concatenate([border, more])
    low, high = border.min(axis=0), border.max(axis=0)
    i, j = np.mgrid[0 : int((high[0] - low[0]) / h) + 2, 0 : int((high[1] - low[1]) / (0.866 * h)) + 2]
    lattice = low + h * np.stack([i + 0.5 * (j % 2), 0.866 * j], axis=-1).reshape(-1, 2)
    lattice += 0.25 * h * rng.uniform(-1, 1, lattice.shape)
    clear = np.linalg.norm(lattice[:, None] - fixed, axis=2).min(axis=1) > 0.6 * h
    points = np.concatenate([fixed, lattice[_inside(lattice, border) & clear]])
    F = Delaunay(points).simplices.astype(np.intp)
    F = F[_inside(points[F].mean(axis=1), border)]
    a, b, c = points[F[:, 0]], points[F[:, 1]], points[F[:, 2]]
    area = _det(b - a, c - a)
    F = F[np.abs(area) > 1e-9 * h * h]
    area = area[np.abs(area) > 1e-9 * h * h]
    F[area < 0] = F[area < 0][:, ::-1]
    k = np.flatnonzero(marked)
    return _Side(points, F, np.stack([k, (k + 1) % len(border)], axis=1))


def _inside(points: Floats, border: Floats) -> NDArray[np.bool_]:
    """Even-odd rule."""
    a, b = border, np.roll(border, -1, axis=0)
    x, y = points[:, :1], points[:, 1:]
    spans = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = a[:, 0] + (y - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return (spans & (x < crossing)).sum(axis=1) % 2 == 1


def _plane(origin: object, e1: object, e2: object) -> Map:
    o, a, b = (np.asarray(v, np.float64) for v in (origin, e1, e2))
    return lambda p: o + p[:, :1] * a + p[:, 1:] * b


def _placed(into_space: Map, side: _Side, *, turn: bool = False) -> _Side:
    F = side.faces[:, ::-1] if turn else side.faces
    return _Side(into_space(side.points), F, side.creases)


def _welded(
    sides: list[_Side], *, corners: Floats | None = None, cones: Floats | None = None, angles: Floats | None = None
) -> Part:
    start = np.cumsum([0, *(len(s.points) for s in sides)])
    rounded = np.round(np.concatenate([s.points for s in sides]), WELD_DECIMALS) + 0.0
    V, index = np.unique(rounded, axis=0, return_inverse=True)
    index = index.ravel()
    F = index[np.concatenate([s.faces + k for s, k in zip(sides, start, strict=False)])]
    creases = index[np.concatenate([s.creases + k for s, k in zip(sides, start, strict=False)])]
    empty = np.empty((0, 3))
    return Part(
        V,
        F[(F[:, 0] != F[:, 1]) & (F[:, 1] != F[:, 2]) & (F[:, 2] != F[:, 0])],
        np.unique(np.sort(creases, axis=1), axis=0),
        _nearest(V, empty if corners is None else corners),
        _nearest(V, empty if cones is None else cones),
        np.empty(0) if angles is None else angles,
    )


def _nearest(V: Floats, points: Floats) -> Indices:
    return np.array([np.argmin(np.linalg.norm(V - p, axis=1)) for p in points], np.intp)


def _without_features(V: Floats, F: Indices) -> Part:
    none = np.empty(0, np.intp)
    return Part(V, F, np.empty((0, 2), np.intp), none, none, np.empty(0))


def _some_diagonals_turned(F: Indices, rng: np.random.Generator) -> Indices:
    """Half of the squares, given as two triangles abc and acd in blocks, cut along the other diagonal."""
    n = len(F) // 12  # squares of one side: its first triangles, then its second ones
    blocks = F.reshape(6, 2, n, 3).copy()
    for block in blocks:
        for q in np.flatnonzero(rng.random(n) < 0.5):
            first, second = block[0, q].copy(), block[1, q].copy()
            shared = [v for v in first if v in second]
            p = next(v for v in first if v not in shared)
            k = list(first).index(p)
            b, d = first[(k + 1) % 3], first[(k + 2) % 3]
            r = next(v for v in second if v not in shared)
            block[0, q], block[1, q] = (p, b, r), (p, r, d)
    return blocks.reshape(-1, 3)
