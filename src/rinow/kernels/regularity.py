"""Largest disk in which every quadruple has a small embedding curvature."""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.embedding_curvatures import embedding_curvatures


@kernel
def least_curvature(values, conditions, diameter, rtol):
    """Least modulus of an embedding curvature if every distance may be off by the share rtol; inf for none."""
    least = np.inf
    for i in range(2):
        if not math.isnan(values[i]):
            error = 6.0 * rtol * conditions[i] / (diameter * diameter)
            least = min(least, max(abs(values[i]) - error, 0.0))
    return least


@kernel
def regular_radius(D, m, rtol):
    """Largest radius at which the quadruples of m and points before it, ordered by distance from 0, are regular.

    One with the curvature k is regular in disks without m, and in those of a radius up to π/(4√k).
    """
    d, G = np.empty(6), np.empty((4, 4))
    values, conditions, kinds = np.empty(2), np.empty(2), np.empty(2, np.int8)
    radius = np.inf
    for i in range(m):
        for j in range(i):
            for n in range(j):
                d[0], d[1], d[2], d[3], d[4], d[5] = D[m, i], D[m, j], D[m, n], D[i, j], D[i, n], D[j, n]
                if embedding_curvatures(d, G, values, kinds, conditions) < 0:
                    continue
                k = least_curvature(values, conditions, d.max(), rtol)
                if k > 0.0:
                    radius = min(radius, 0.25 * math.pi / math.sqrt(k))
                if radius <= D[0, m]:
                    return D[0, m]
    return radius


@parallel_kernel
def regular_radii(D, rtol, radii):
    """Write `regular_radius` of each point."""
    n = D.shape[0]
    for row in prange(n):
        m = row // 2 if row % 2 == 0 else n - 1 - row // 2  # long and short rows in turn, for equal shares
        radii[m] = regular_radius(D, m, rtol)
