"""Meshes for benchmarks: big, irregular, seeded."""

from __future__ import annotations

import numpy as np


def jittered_torus(n_vertices: int, *, jitter: float = 0.2, seed: int = 20) -> tuple[np.ndarray, np.ndarray]:
    """Torus with radii 1 and 0.4; grid points moved along the surface by up to `jitter` spacings.

    The vertices are exactly on the torus, so its curvature K = cos v / (0.4 (1 + 0.4 cos v)) is known.
    """
    nv = int(np.sqrt(n_vertices / 2.5))
    nu = n_vertices // nv
    rng = np.random.default_rng(seed)
    i, j = np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij")
    u = (i.ravel() + jitter * rng.uniform(-1, 1, nu * nv)) * (2 * np.pi / nu)
    v = (j.ravel() + jitter * rng.uniform(-1, 1, nu * nv)) * (2 * np.pi / nv)
    w = 1.0 + 0.4 * np.cos(v)
    V = np.stack([w * np.cos(u), w * np.sin(u), 0.4 * np.sin(v)], axis=1)
    a = (i * nv + j).ravel()
    b = (((i + 1) % nu) * nv + j).ravel()
    c = (((i + 1) % nu) * nv + (j + 1) % nv).ravel()
    d = (i * nv + (j + 1) % nv).ravel()
    return V, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def torus_curvature(V: np.ndarray) -> np.ndarray:
    """Gaussian curvature of the torus of `jittered_torus` at its points."""
    w = np.hypot(V[:, 0], V[:, 1])
    return (w - 1.0) / (0.16 * w)
