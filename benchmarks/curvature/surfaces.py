"""Analytic surfaces F = 0 with their exact curvatures, and triangulations of them.

With the gradient g and the Hessian A of F, and g pointing outwards,

    K = g adj(A) g / |g|^4,      H = (|g|^2 tr A - g A g) / (2 |g|^3),

so that convex surfaces are positive.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, Delaunay

Floats = np.ndarray
BORDER = 5
"""Rings of vertices at the border that no error is taken at."""
Field = Callable[[Floats], Floats]


class Surface(NamedTuple):
    """A surface: F with its derivatives, and how it is laid out: "star" about 0, "torus" or "graph" over a square."""

    name: str
    layout: str
    value: Field
    gradient: Field
    hessian: Field


class Mesh(NamedTuple):
    """A triangulation with the exact curvatures at its vertices, and which of them are away from the border."""

    vertices: Floats
    faces: Floats
    gaussian: Floats
    mean: Floats
    interior: Floats


def exact_curvature(surface: Surface, points: Floats) -> tuple[Floats, Floats]:
    """Gaussian and mean curvature at points of the surface."""
    g, A = surface.gradient(points), surface.hessian(points)
    rolled = [np.roll(np.roll(A, -i, axis=1), -j, axis=2) for i, j in ((1, 1), (2, 2), (1, 2), (2, 1))]
    adjugate = rolled[0] * rolled[1] - rolled[2] * rolled[3]
    g2 = np.sum(g * g, axis=1)
    K = np.einsum("ni,nij,nj->n", g, adjugate, g) / g2**2
    H = (g2 * np.trace(A, axis1=1, axis2=2) - np.einsum("ni,nij,nj->n", g, A, g)) / (2 * g2**1.5)
    return K, H


# ------------------------------------------------------------------ surfaces


def quadric(name: str, axes: tuple[float, float, float]) -> Surface:
    """The ellipsoid with these half axes."""
    w = 1 / np.square(axes)
    A = np.diag(2 * w)
    return Surface(
        name, "star", lambda p: p**2 @ w - 1, lambda p: 2 * p * w, lambda p: np.broadcast_to(A, (len(p), 3, 3))
    )


def rounded_cube() -> Surface:
    """x^4 + y^4 + z^4 + (x^2 + y^2 + z^2)/2 = 1: nearly flat sides, round edges."""

    def hessian(p: Floats) -> Floats:
        return (12 * p**2 + 1)[:, :, None] * np.eye(3)

    return Surface("rounded cube", "star", lambda p: (p**4 + p**2 / 2).sum(axis=1) - 1, lambda p: 4 * p**3 + p, hessian)


def torus(R: float = 1.0, r: float = 0.4) -> Surface:
    """(|p|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2)."""
    flat = np.array([1.0, 1.0, 0.0])

    def inner(p: Floats) -> Floats:
        return (p**2).sum(axis=1) + R**2 - r**2

    def value(p: Floats) -> Floats:
        return inner(p) ** 2 - 4 * R**2 * (p**2 @ flat)

    def gradient(p: Floats) -> Floats:
        return 4 * inner(p)[:, None] * p - 8 * R**2 * p * flat

    def hessian(p: Floats) -> Floats:
        outer = 8 * p[:, :, None] * p[:, None, :]
        return outer + 4 * inner(p)[:, None, None] * np.eye(3) - 8 * R**2 * np.diag(flat)

    return Surface("torus", "torus", value, gradient, hessian)


def graph(name: str, f: Field, df: Field, ddf: Field) -> Surface:
    """Z = f(x, y) over the square [-1, 1]^2, the normal upwards."""

    def gradient(p: Floats) -> Floats:
        return np.column_stack([-df(p), np.ones(len(p))])

    def hessian(p: Floats) -> Floats:
        A = np.zeros((len(p), 3, 3))
        xx, xy, yy = ddf(p)
        A[:, 0, 0], A[:, 1, 1] = -xx, -yy
        A[:, 0, 1] = A[:, 1, 0] = -xy
        return A

    return Surface(name, "graph", lambda p: p[:, 2] - f(p), gradient, hessian)


def saddle() -> Surface:
    """Z = (x^2 - y^2)/2."""
    return graph(
        "saddle",
        lambda p: (p[:, 0] ** 2 - p[:, 1] ** 2) / 2,
        lambda p: np.column_stack([p[:, 0], -p[:, 1]]),
        lambda p: (np.ones(len(p)), np.zeros(len(p)), -np.ones(len(p))),
    )


def waves(a: float = 0.15, k: float = 4.0) -> Surface:
    """Z = a sin(k x) cos(k y)."""

    def trig(p: Floats) -> tuple[Floats, ...]:
        return np.sin(k * p[:, 0]), np.cos(k * p[:, 0]), np.sin(k * p[:, 1]), np.cos(k * p[:, 1])

    def df(p: Floats) -> Floats:
        sx, cx, sy, cy = trig(p)
        return a * k * np.column_stack([cx * cy, -sx * sy])

    def ddf(p: Floats) -> Floats:
        sx, cx, sy, cy = trig(p)
        return a * k * k * np.stack([-sx * cy, -cx * sy, -sx * cy])

    return graph("waves", lambda p: a * trig(p)[0] * trig(p)[3], df, ddf)


def surfaces() -> dict[str, Surface]:
    """All surfaces by name."""
    every = (
        quadric("sphere", (1, 1, 1)), quadric("ellipsoid", (1, 0.7, 0.5)), rounded_cube(), torus(), saddle(), waves()
    )  # fmt: skip
    return {s.name: s for s in every}


# ------------------------------------------------------------------ triangulations

STYLES = ("regular", "irregular", "random", "stretched", "marching cubes")


def triangulation(surface: Surface, style: str, n: int, *, noise: float = 0.0, seed: int = 1) -> Mesh:
    """About n vertices on the surface, then noise on every coordinate in units of the mean edge length.

    "regular": lattices; "irregular": jittered ones, diagonals at random; "random": independent points; "stretched":
    lattices with edges five times longer one way; "marching cubes": of a grid in space, vertices on its edges.
    """
    rng = np.random.default_rng([seed, n])
    if style == "marching cubes":
        V, F = _marching_cubes(surface, n)
    else:
        V, F = {"star": _star, "torus": _torus, "graph": _graph}[surface.layout](style, n, rng)
        V = _projected(surface, V)
        F = _oriented(surface, V, F)
    K, H = exact_curvature(surface, V)
    interior = _interior(V, F)
    if noise:
        ends = V[F]
        h = np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2).mean()
        V = V + noise * h * rng.normal(size=V.shape)
    return Mesh(V, F, K, H, interior)


def has(surface: Surface, style: str) -> bool:
    """Whether the surface has triangulations of the style."""
    if style == "stretched":
        return surface.layout != "star"
    return style != "marching cubes" or surface.layout != "graph"


def _projected(surface: Surface, V: Floats) -> Floats:
    """Points moved to the surface: along the ray for star-shaped ones, along the gradient for others."""
    for _ in range(20):
        g = V if surface.layout == "star" else surface.gradient(V)
        V = V - (surface.value(V) / np.sum(g * surface.gradient(V), axis=1))[:, None] * g
    return V


def _star(style: str, n: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
    if style == "regular":
        D, F = _geodesic_grid(round(np.sqrt(n / 10)))
        return 0.5 * D, F
    if style == "random":
        D = rng.normal(size=(n, 3))
    else:
        i = np.arange(n) + 0.5
        z, t = 1 - 2 * i / n, np.pi * (1 + 5**0.5) * i
        D = np.column_stack([np.sqrt(1 - z * z) * np.cos(t), np.sqrt(1 - z * z) * np.sin(t), z])
        D += rng.uniform(-1, 1, D.shape) * np.sqrt(4 * np.pi / n) / 3
    D /= np.linalg.norm(D, axis=1)[:, None]
    return 0.5 * D, ConvexHull(D).simplices.astype(np.intp)


def _geodesic_grid(frequency: int) -> tuple[Floats, Floats]:
    """The icosahedron, each side cut into frequency^2 triangles, on the unit sphere."""
    t = (1 + 5**0.5) / 2
    V = np.array([(0, s, u * t) for s in (-1, 1) for u in (-1, 1)], float)
    V = np.concatenate([np.roll(V, k, axis=1) for k in range(3)])
    weights = np.array([(i, j, frequency - i - j) for i in range(frequency + 1) for j in range(frequency + 1 - i)])
    P = np.concatenate([weights @ V[f] / frequency for f in ConvexHull(V).simplices])
    P = np.unique(np.round(P, 9), axis=0)
    P /= np.linalg.norm(P, axis=1)[:, None]
    return P, ConvexHull(P).simplices.astype(np.intp)


def _lattice(style: str, nu: int, nv: int, rng: np.random.Generator, closed: bool) -> tuple[Floats, Floats]:
    """Points of a lattice in [0, 1)^2, or [0, 1]^2 if not closed, and faces."""
    i, j = np.indices((nu, nv)).reshape(2, -1)
    p = np.column_stack([i, j]).astype(float)
    if style == "irregular":
        free = np.ones(p.shape, bool) if closed else (p > 0) & (p < [nu - 1, nv - 1])
        p += np.where(free, rng.uniform(-0.25, 0.25, p.shape), 0)
    a, b = (i, j) if closed else (i[(i < nu - 1) & (j < nv - 1)], j[(i < nu - 1) & (j < nv - 1)])
    quad = np.stack([a * nv + b, (a + 1) % nu * nv + b, (a + 1) % nu * nv + (b + 1) % nv, a * nv + (b + 1) % nv])
    turn = rng.random(quad.shape[1]) < 0.5 if style == "irregular" else np.zeros(quad.shape[1], bool)
    A, B, C, D = quad
    first, second = np.where(turn, [A, B, D], [A, B, C]).T, np.where(turn, [B, C, D], [A, C, D]).T
    size = [nu, nv] if closed else [nu - 1, nv - 1]
    return p / size, np.concatenate([first, second])


def _torus(style: str, n: int, rng: np.random.Generator, R: float = 1.0, r: float = 0.4) -> tuple[Floats, Floats]:
    if style == "random":
        u = rng.random((round(1.4 * n), 2))  # thinned to even density below
        u = u[rng.random(len(u)) * (R + r) < R + r * np.cos(2 * np.pi * u[:, 1])]
        shifts = np.array([(i, j) for i in (0, -1, 1) for j in (0, -1, 1)])
        plane = (u + shifts[:, None]) * [2 * np.pi * R, 2 * np.pi * r]
        F = Delaunay(plane.reshape(-1, 2)).simplices
        middle = plane.reshape(-1, 2)[F].mean(axis=1) / [2 * np.pi * R, 2 * np.pi * r]
        F = F[((middle >= 0) & (middle < 1)).all(axis=1)] % len(u)
    else:
        ratio = R / r * (1 if style != "stretched" else 1 / 5)
        nv = max(5, round(np.sqrt(n / ratio)))
        u, F = _lattice(style, round(n / nv), nv, rng, closed=True)
    a, b = 2 * np.pi * u.T
    w = R + r * np.cos(b)
    return np.column_stack([w * np.cos(a), w * np.sin(a), r * np.sin(b)]), F


def _graph(style: str, n: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
    m = round(np.sqrt(n))
    if style == "random":
        side = np.arange(m) / m
        border = np.concatenate([np.column_stack(p) for p in ((side, 0 * side), (1 + 0 * side, side))])
        u = np.concatenate([border, 1 - border, rng.random((n - len(border) * 2, 2))])
        F = Delaunay(u).simplices
    else:
        nu = m if style != "stretched" else round(m / np.sqrt(5))
        u, F = _lattice(style, nu, round(n / nu), rng, closed=False)
    return np.column_stack([2 * u - 1, np.zeros(len(u))]), F


def _marching_cubes(surface: Surface, n: int) -> tuple[Floats, Floats]:
    """Marching cubes on a grid, its vertices moved to the surface."""
    from skimage.measure import marching_cubes

    box, size = 1.5, 0.0
    for _ in range(3):  # the number of vertices grows as the square of that of cells along an edge
        m = 24 if not size else round(24 * np.sqrt(n / size))
        x = np.linspace(-box, box, m) + 0.013
        grid = np.stack(np.meshgrid(x, x, x, indexing="ij"), axis=-1)
        V, F, _, _ = marching_cubes(surface.value(grid.reshape(-1, 3)).reshape(m, m, m), 0.0)
        size = size or len(V)
    V = V.astype(float) * (x[1] - x[0]) + x[0]
    for _ in range(5):
        g = surface.gradient(V)
        V = V - (surface.value(V) / np.sum(g * g, axis=1))[:, None] * g
    return V, _oriented(surface, V, F.astype(np.intp))


def _oriented(surface: Surface, V: Floats, F: Floats) -> Floats:
    """Faces counter-clockwise seen from where the gradient points."""
    a, b, c = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
    inward = np.sum(np.cross(b - a, c - a) * surface.gradient((a + b + c) / 3), axis=1) < 0
    return np.ascontiguousarray(np.where(inward[:, None], F[:, ::-1], F))


def _interior(V: Floats, F: Floats) -> Floats:
    """Vertices more than `BORDER` rings from the border, where balls of all tools see no border."""
    sides = np.sort(F[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, counts = np.unique(sides, axis=0, return_counts=True)
    near = np.zeros(len(V), bool)
    near[edges[counts == 1].ravel()] = True
    for _ in range(BORDER):
        near[F[near[F].any(axis=1)].ravel()] = True
    return ~near
