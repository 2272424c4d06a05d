"""Surfaces without positions: meshes by their edge lengths, and matrices of distances."""

import math

import numpy as np
from scipy.sparse.csgraph import shortest_path
from scipy.spatial.distance import pdist, squareform

from rinow import IntrinsicMesh, SpaceForm


def flat_torus(n=24):
    """Lengths of a jittered triangulation of the unit square with opposite sides glued."""
    rng = np.random.default_rng(7)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    xy = (np.stack([i, j], 1) + rng.uniform(-0.25, 0.25, (n * n, 2))) / n

    def corner(a, b):
        return (a % n) * n + b % n

    F = np.concatenate(
        [np.stack([corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)], 1),
         np.stack([corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)], 1)]
    )  # fmt: skip
    sides = np.stack([xy[F[:, (k + 1) % 3]] - xy[F[:, (k + 2) % 3]] for k in range(3)], 1)
    return IntrinsicMesh(F, np.linalg.norm(sides - np.round(sides), axis=2))


def hyperbolic_patch(n=1500):
    """Distances between the points of an irregular disk of radius 1 in the plane of curvature -1."""
    from scipy.spatial import Delaunay

    rng = np.random.default_rng(7)
    i = np.arange(n) + 0.5
    r = np.sqrt(i / n) + rng.uniform(-0.2, 0.2, n) / np.sqrt(n)
    phi = np.pi * (1 + 5**0.5) * i
    klein = np.tanh(r)[:, None] * np.stack([np.cos(phi), np.sin(phi)], 1)  # geodesics are straight in these
    F = Delaunay(klein).simplices
    P = np.stack([np.sinh(r) * np.cos(phi), np.sinh(r) * np.sin(phi), np.cosh(r)], 1)
    d = [P[F[:, (k + 1) % 3]] - P[F[:, (k + 2) % 3]] for k in range(3)]
    chords = [np.sqrt(e[:, 0] ** 2 + e[:, 1] ** 2 - e[:, 2] ** 2) for e in d]
    return IntrinsicMesh(F, 2 * np.arcsinh(np.stack(chords, 1) / 2)), r


def sphere_net(n, diameter=None):
    """Geodesic distances of a Fibonacci net of the unit sphere, or of one with the given diameter of the net."""
    z = 1 - (2 * np.arange(n) + 1) / n
    angle = np.pi * (1 + np.sqrt(5)) * np.arange(n)
    P = np.stack([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z], axis=1)
    D = np.arccos(np.clip(P @ P.T, -1, 1))
    D = (D + D.T) / 2
    np.fill_diagonal(D, 0)
    return D if diameter is None else D * (diameter / D.max())


def sampled(k, n, seed, radius=0.5):
    """Distances of random points of a disk of S_k."""
    surface = SpaceForm(k)
    points = surface.sample(n, radius, np.random.default_rng(seed))
    D = surface.distance(points[:, None], points)
    return 0.5 * (D + D.T)


def cone(angle, n, seed):
    """Distances of random points of the unit disk around the apex of a flat cone, which is point 0."""
    rng = np.random.default_rng(seed)
    r, u = np.sqrt(rng.random(n)), angle * rng.random(n)
    r[0] = 0
    turn = np.abs(u[:, None] - u)
    turn = np.minimum(np.minimum(turn, angle - turn), np.pi)
    D = np.sqrt((r[:, None] - r) ** 2 + 4 * r[:, None] * r * np.sin(turn / 2) ** 2)
    return 0.5 * (D + D.T)


def hops(rng, n, share=0.3):
    """Numbers of steps in a random tree with further edges."""
    edges = np.triu((rng.random((n, n)) < share).astype(float), 1)
    for i in range(1, n):
        edges[rng.integers(i), i] = 1.0
    return shortest_path(edges, directed=False, unweighted=True)


def random_space(rng, n):
    """Distances of n random points: plane, line with repeated points, hops in a graph, or generic."""
    kind = rng.integers(4)
    if kind == 0:
        return squareform(pdist(rng.random((n, 2)))) if n > 1 else np.zeros((1, 1))
    if kind == 1:
        places = rng.integers(0, 5, n).astype(float)
        return np.abs(places[:, None] - places)
    if kind == 2:
        return hops(rng, n)
    D = rng.uniform(0.5, 1.0, (n, n))
    D = np.minimum(D, D.T)
    np.fill_diagonal(D, 0.0)
    return D


def polygon(n):
    """Vertices of a regular polygon on a circle of length 2π."""
    steps = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    return np.minimum(steps, n - steps) * (2 * math.pi / n)


def segment(n, length):
    """Equally spaced points of a segment."""
    return np.abs(np.subtract.outer(*[np.linspace(0, length, n)] * 2))
