"""Meshes whose geodesic distances are known: sheets of unit squares, and cones of any angle by their lengths."""

import numpy as np

import rinow
import shapes

EXACT = 1e-13  # rounding of some dozens of additions


def all_distances(V, F):
    return rinow.geodesic_distances((V, F), np.arange(len(V)))


def grid(n):
    """Unit squares cut along diagonals; vertex i (n + 1) + j is the point (i, j)."""
    i, j = np.indices((n + 1, n + 1)).reshape(2, -1)
    V = np.stack([i, j, np.zeros_like(i)], axis=1).astype(float)
    a = np.array([i * (n + 1) + j for i in range(n) for j in range(n)])
    return V, np.concatenate([np.stack([a, a + n + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + 1], 1)])


def wheel(n_around, n_rings, angle):
    """A cone of any total angle, by lengths alone; returns the mesh, radii and bearings of its vertices."""
    F = shapes.cone(n_around, n_rings).faces
    number = np.arange(1, 1 + n_around * n_rings)
    radii = np.append(0.0, 1.0 + (number - 1) // n_around)
    steps = np.append(0, (number - 1) % n_around)
    turn = (steps[:, None] - steps) % n_around
    turn = np.minimum(turn, n_around - turn) * angle / n_around
    squares = radii[:, None] ** 2 + radii**2 - 2 * radii[:, None] * radii * np.cos(turn)
    L = np.sqrt(np.maximum(squares[F[:, [1, 2, 0]], F[:, [2, 0, 1]]], 0.0))
    return rinow.IntrinsicMesh(F, L), radii, turn, squares
