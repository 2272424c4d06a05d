"""Quadruples by their six distances (12, 13, 14, 23, 24, 34): golden ones, and random ones of model surfaces."""

import math

import numpy as np

import rinow
from golden_files import golden

EPS = 2.0**-53
GOLDEN = golden("quadruples")["quadruples"]
DISTANCES = np.array([[float(x) for x in row["distances"].values()] for row in GOLDEN])
PAIRS = I, J = np.triu_indices(4, 1)


def matrix(distances, n=4):
    """Symmetric matrix from the upper triangle, row by row."""
    D = np.zeros((n, n))
    D[np.triu_indices(n, 1)] = distances
    return D + D.T


def sampled(k, radius, n, seed):
    """Quadruples of points of S_k in a disk."""
    surface = rinow.SpaceForm(k)
    points = surface.sample(4 * n, radius, np.random.default_rng(seed)).reshape(n, 4, 3)
    return surface.distance(points[:, I], points[:, J])


def semidependent(k, n, seed, size=1.0):
    """Quadruples of S_k in Robinson's order: point 2 on the segment from 1 to 3; and the curvature they have."""
    rng = np.random.default_rng(seed)
    a, c, b = size * rng.uniform(0.1, 0.5, (3, n))
    alpha = rng.uniform(0.1, math.pi - 0.1, n)
    surface = rinow.SpaceForm(k / size**2)
    Q = np.stack([a, a + c, surface.side(a, b, alpha), c, b, surface.side(c, b, math.pi - alpha)], axis=1)
    return Q, k / size**2
