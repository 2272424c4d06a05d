"""Points beside the surface that those around them lie on: offsets from quadrics that few points cannot bend."""

import numpy as np

from rinow.kernels import monge
from rinow.kernels._jit import inner, parallel_kernel, prange

ROUNDS = 6
"""Regressions with weights that make the last one that of least moduli, nearly."""
RIDGE = 1e-9
"""Added to the mean squares of the terms, of order 1 or less: points on a line determine no quadric."""
LEAST = 0.1
"""Residuals below this share of their median count no more."""


@inner
def local_terms(v, near, points, normal, reach, terms, heights):
    """Write the six terms of a quadric and the heights at the neighbours of a point, in units of their reach."""
    t = monge.some_tangent(normal)
    b = monge.cross(normal, t)
    for i in range(near.shape[0]):
        w = near[i]
        dx, dy, dz = points[w, 0] - points[v, 0], points[w, 1] - points[v, 1], points[w, 2] - points[v, 2]
        x, y = (t[0] * dx + t[1] * dy + t[2] * dz) / reach, (b[0] * dx + b[1] * dy + b[2] * dz) / reach
        terms[i, 0], terms[i, 1], terms[i, 2] = 1.0, x, y
        terms[i, 3], terms[i, 4], terms[i, 5] = x * x, x * y, y * y
        heights[i] = (normal[0] * dx + normal[1] * dy + normal[2] * dz) / reach


@inner
def robust_fit(terms, heights, weights, residuals):
    """Write the moduli of the residuals of the quadric; its height at the origin and the median modulus."""
    k = terms.shape[0]
    weights[:] = 1.0
    height, middle = 0.0, 0.0
    for _ in range(ROUNDS):
        matrix, right = np.zeros((6, 6)), np.zeros(6)
        total = weights.sum()
        for i in range(k):
            w = weights[i] / total
            for a in range(6):
                right[a] += w * terms[i, a] * heights[i]
                for c in range(6):
                    matrix[a, c] += w * terms[i, a] * terms[i, c]
        for a in range(6):
            matrix[a, a] += RIDGE
        quadric = np.linalg.solve(matrix, right)
        for i in range(k):
            fitted = 0.0
            for a in range(6):
                fitted += quadric[a] * terms[i, a]
            residuals[i] = abs(heights[i] - fitted)
        height, middle = quadric[0], np.median(residuals)
        for i in range(k):
            weights[i] = 1.0 / max(residuals[i], LEAST * middle, RIDGE)
    return height, middle


@parallel_kernel
def offsets(rows, points, normals, near, reach, n_blocks, out, middles, largest):
    """Write distances of points[rows] from quadrics through their neighbours, the median and largest one of these.

    Row i of `near` has the neighbours of points[rows[i]]; all are 0 where these are at one place or no normal is known.
    """
    for block in prange(n_blocks):
        n, k = near.shape
        terms, heights, weights, residuals = np.empty((k, 6)), np.empty(k), np.empty(k), np.empty(k)
        for i in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            out[i], middles[i], largest[i] = 0.0, 0.0, 0.0
            v = rows[i]
            normal = (normals[v, 0], normals[v, 1], normals[v, 2])
            if normal != (0.0, 0.0, 0.0) and reach[i] > 0.0:
                local_terms(v, near[i], points, normal, reach[i], terms, heights)
                height, middle = robust_fit(terms, heights, weights, residuals)
                out[i], middles[i] = abs(height) * reach[i], middle * reach[i]
                largest[i] = residuals.max() * reach[i]
