"""Generated test meshes: small, seeded, with the exact curvature where the surface is smooth."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

TORUS_RADII = (1.0, 0.4)
ELLIPSOID_AXES = (1.0, 0.7, 0.5)


class Shape(NamedTuple):
    """A mesh with outward counter-clockwise faces; curvatures are nan where the surface is not smooth."""

    vertices: Floats
    faces: Indices
    gaussian: Floats
    mean: Floats


def without_curvature(vertices: object, faces: object) -> Shape:
    V, F = np.asarray(vertices, np.float64), np.asarray(faces, np.intp)
    return Shape(V, F, np.full(len(V), np.nan), np.full(len(V), np.nan))


# ------------------------------------------------------------------ closed smooth surfaces


def icosphere(subdivisions: int = 2, radius: float = 1.0) -> Shape:
    """12, 42, 162, 642, 2562 ... vertices on a sphere."""
    t = (1 + 5**0.5) / 2
    V = np.array([(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0)], np.float64)
    V = np.concatenate([V, np.roll(V, 1, axis=1), np.roll(V, 2, axis=1)])
    V /= np.linalg.norm(V[0])
    F = _hull_faces(V)
    for _ in range(subdivisions):
        V, F = _split_edges(V, F)
        V /= np.linalg.norm(V, axis=1)[:, None]
    return Shape(radius * V, F, np.full(len(V), radius**-2), np.full(len(V), 1 / radius))


def irregular_sphere(n: int = 1000, radius: float = 1.0, seed: int = 7) -> Shape:
    """Random directions, evenly spread but without any pattern."""
    V = _directions(n, seed)
    return Shape(radius * V, _hull_faces(V), np.full(n, radius**-2), np.full(n, 1 / radius))


def irregular_ellipsoid(n: int = 1000, axes: tuple[float, float, float] = ELLIPSOID_AXES, seed: int = 7) -> Shape:
    """The irregular sphere, stretched along the coordinate axes."""
    D = _directions(n, seed)
    V, a2 = D * axes, np.square(axes)
    g = np.sum(V * V / a2**2, axis=1)
    volume = np.prod(axes)
    K = 1 / (volume * g) ** 2
    H = (a2.sum() - np.sum(V * V, axis=1)) / (2 * volume**2 * g**1.5)
    return Shape(V, _hull_faces(D), K, H)


def irregular_torus(n: int = 1000, seed: int = 7) -> Shape:
    """A jittered grid on the torus with radii 1 and 0.4, each square cut along a random diagonal."""
    R, r = TORUS_RADII
    nv = max(4, round((n * r / R) ** 0.5))
    nu = max(4, round(n / nv))
    rng = np.random.default_rng(seed)
    i, j = _grid(nu, nv) + rng.uniform(-0.25, 0.25, (2, nu * nv))
    u, v = 2 * np.pi * i / nu, 2 * np.pi * j / nv
    V = np.stack([(R + r * np.cos(v)) * np.cos(u), (R + r * np.cos(v)) * np.sin(u), r * np.sin(v)], axis=1)
    k = np.cos(v) / (R + r * np.cos(v))
    return Shape(V, _grid_faces(nu, nv, rng, closed=True), k / r, (1 / r + k) / 2)


# ------------------------------------------------------------------ open and singular surfaces


def open_patch(n: int = 1000, seed: int = 7) -> Shape:
    """The saddle z = (x² - y²)/2 over a square, jittered inside, normal upwards."""
    m = round(n**0.5)
    rng = np.random.default_rng(seed)
    ij = _grid(m, m)
    inside = ((ij > 0) & (ij < m - 1)).all(axis=0)
    x, y = 2 * (ij + np.where(inside, rng.uniform(-0.25, 0.25, ij.shape), 0)) / (m - 1) - 1
    w2 = 1 + x * x + y * y
    V = np.stack([x, y, (x * x - y * y) / 2], axis=1)
    return Shape(V, _grid_faces(m, m, rng, closed=False), -1 / w2**2, (x * x - y * y) / (2 * w2**1.5))


def bump_on_plane(n: int = 1444, seed: int = 7) -> Shape:
    """A Gaussian bump, 1/3 high and K = 28 on top, amid a jittered square of side 4, normal upwards."""
    square = open_patch(n, seed)
    x, y = 2 * square.vertices[:, :2].T
    z = np.exp(-8 * (x * x + y * y)) / 3
    zx, zy, xx, xy, yy = -16 * x * z, -16 * y * z, (256 * x * x - 16) * z, 256 * x * y * z, (256 * y * y - 16) * z
    w2 = 1 + zx * zx + zy * zy
    mean = (2 * zx * zy * xy - (1 + zy * zy) * xx - (1 + zx * zx) * yy) / (2 * w2**1.5)
    return Shape(np.stack([x, y, z], axis=1), square.faces, (xx * yy - xy * xy) / w2**2, mean)


def cone(n_around: int = 12, n_rings: int = 4, slope: float = 1.0) -> Shape:
    """An open circular cone; vertex 0 is the apex, height `slope` times the distance from the axis."""
    u = 2 * np.pi * np.arange(n_around) / n_around
    rings = [np.stack([s * np.cos(u), s * np.sin(u), np.full(n_around, -slope * s)], 1) for s in range(1, n_rings + 1)]
    V = np.concatenate([np.zeros((1, 3)), *rings])
    a = np.arange(n_around)
    b = (a + 1) % n_around
    F = [np.stack([np.zeros_like(a), 1 + a, 1 + b], 1)]
    for k in range(n_rings - 1):
        inner, outer = 1 + k * n_around, 1 + (k + 1) * n_around
        F += [np.stack([inner + a, outer + a, outer + b], 1), np.stack([inner + a, outer + b, inner + b], 1)]
    return without_curvature(V, np.concatenate(F))


def tetrahedron() -> Shape:
    return without_curvature(
        [(1, 1, 1), (-1, -1, 1), (-1, 1, -1), (1, -1, -1)], [(0, 1, 3), (0, 2, 1), (0, 3, 2), (1, 2, 3)]
    )


def cube() -> Shape:
    """8 vertices, 12 faces."""
    return box(1)


def box(n: int = 4, size: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Shape:
    """A box whose six sides are n x n grids, welded along its edges."""
    x = np.arange(n + 1)
    a, b = (g.ravel() for g in np.meshgrid(x, x, indexing="ij"))
    sides, faces = [], []
    for axis in range(3):
        for end, turn in ((n, False), (0, True)):
            side = np.empty((len(a), 3), np.intp)
            side[:, axis], side[:, (axis + 1) % 3], side[:, (axis + 2) % 3] = end, a, b
            F = _grid_faces(n + 1, n + 1, None, closed=False) + len(a) * len(sides)
            sides.append(side)
            faces.append(F[:, ::-1] if turn else F)
    corners, index = np.unique(np.concatenate(sides), axis=0, return_inverse=True)
    return without_curvature(corners / n * size, index.ravel()[np.concatenate(faces)])


def bow_tie() -> Shape:
    """Two triangles that share vertex 0 only."""
    return without_curvature([(0, 0, 0), (1, 1, 0), (1, -1, 0), (-1, 1, 0), (-1, -1, 0)], [(0, 2, 1), (0, 3, 4)])


def moebius_strip(n: int = 24, n_across: int = 5, half_width: float = 0.3) -> Shape:
    """A band with one half turn: no orientation fits all faces.  The curvature is that of the band."""
    u, w = 2 * np.pi * np.arange(n) / n, np.linspace(-half_width, half_width, n_across)[:, None]
    r = 1 + w * np.cos(u / 2)
    V = np.stack([r * np.cos(u), r * np.sin(u), w * np.sin(u / 2)], axis=2).reshape(-1, 3)
    K = -0.25 / (r * r + 0.25 * w * w) ** 2
    i, k = _grid(n, n_across - 1).astype(np.intp)
    j = (i + 1) % n
    here, there = np.stack([k, k + 1]), np.where(j == 0, n_across - 1 - np.stack([k, k + 1]), np.stack([k, k + 1]))
    (a, d), (b, c) = here * n + i, there * n + j
    F = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return Shape(V, F, K.ravel(), np.full(len(V), np.nan))


def two_components(n: int = 200) -> Shape:
    """Two separate spheres of radius 1 and 2."""
    return union(irregular_sphere(n), irregular_sphere(n, radius=2.0, seed=8), offset=(5.0, 0.0, 0.0))


# ------------------------------------------------------------------ changes of a mesh


def union(a: Shape, b: Shape, offset: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Shape:
    """The second shape, shifted, after the first one."""
    return Shape(
        np.concatenate([a.vertices, b.vertices + offset]),
        np.concatenate([a.faces, b.faces + len(a.vertices)]),
        np.concatenate([a.gaussian, b.gaussian]),
        np.concatenate([a.mean, b.mean]),
    )


def soup(shape: Shape) -> Shape:
    """Every face with three vertices of its own."""
    index = shape.faces.ravel()
    return Shape(shape.vertices[index], np.arange(len(index)).reshape(-1, 3), shape.gaussian[index], shape.mean[index])


def noisy(shape: Shape, amount: float, seed: int = 7) -> Shape:
    """Gaussian noise of `amount` times the mean edge length on every coordinate; the exact curvatures stay."""
    ends = shape.vertices[shape.faces]
    h = np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2).mean()
    noise = np.random.default_rng(seed).normal(size=shape.vertices.shape)
    return shape._replace(vertices=shape.vertices + amount * h * noise)


def closed_shapes() -> dict[str, Shape]:
    """One closed orientable surface of each kind."""
    return {
        "icosphere": icosphere(2),
        "irregular_sphere": irregular_sphere(400),
        "irregular_ellipsoid": irregular_ellipsoid(400),
        "irregular_torus": irregular_torus(400),
        "tetrahedron": tetrahedron(),
        "cube": cube(),
        "box": box(3, (1.0, 2.0, 3.0)),
        "two_components": two_components(),
    }


# ------------------------------------------------------------------ parts


def _grid(nu: int, nv: int) -> Floats:
    return np.indices((nu, nv), np.float64).reshape(2, -1)


def _grid_faces(nu: int, nv: int, rng: np.random.Generator | None, *, closed: bool) -> Indices:
    i, j = _grid(nu if closed else nu - 1, nv if closed else nv - 1).astype(np.intp)
    i2, j2 = (i + 1) % nu, (j + 1) % nv
    a, b, c, d = i * nv + j, i2 * nv + j, i2 * nv + j2, i * nv + j2
    turn = np.zeros(len(a), bool) if rng is None else rng.random(len(a)) < 0.5
    first = np.where(turn, [a, b, d], [a, b, c]).T
    second = np.where(turn, [b, c, d], [a, c, d]).T
    return np.concatenate([first, second])


def _directions(n: int, seed: int) -> Floats:
    """Unit vectors of a Fibonacci lattice, each moved at random by up to a third of the spacing."""
    i = np.arange(n) + 0.5
    z, u = 1 - 2 * i / n, np.pi * (1 + 5**0.5) * i
    s = np.sqrt(1 - z * z)
    D = np.stack([s * np.cos(u), s * np.sin(u), z], axis=1)
    D += np.random.default_rng(seed).uniform(-1, 1, D.shape) * np.sqrt(4 * np.pi / n) / 3
    return D / np.linalg.norm(D, axis=1)[:, None]


def _hull_faces(V: Floats) -> Indices:
    """Faces of the convex hull of points around the origin, counter-clockwise seen from outside."""
    F = ConvexHull(V).simplices.astype(np.intp)
    inward = np.linalg.det(V[F]) < 0
    F[inward] = F[inward][:, ::-1]
    return F


def _split_edges(V: Floats, F: Indices) -> tuple[Floats, Indices]:
    """Cut each triangle into four at the midpoints of its sides."""
    sides = np.sort(F[:, [[1, 2], [2, 0], [0, 1]]], axis=2)
    edges, index = np.unique(sides.reshape(-1, 2), axis=0, return_inverse=True)
    M = len(V) + index.reshape(-1, 3)
    a, b, c = F.T
    x, y, z = M.T
    faces = np.concatenate([np.stack(t, axis=1) for t in ((a, z, y), (b, x, z), (c, y, x), (x, y, z))])
    return np.concatenate([V, V[edges].mean(axis=1)]), faces
