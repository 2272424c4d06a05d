"""Curved triangles: the areas that their defects are divided by, and where in a star a defect is felt."""

import math

from rinow.kernels._jit import parallel_kernel, prange


@parallel_kernel
def area_ratios(curvatures, metric, out):
    """Write the area around each vertex as its defect sees it, over that of the flat triangles; 1 without faces.

    By the next term of Legendre's theorem the angle of a triangle with sides a, b, c and curvature K exceeds that of
    the flat one, opposite a, by K area/3 (1 + K (a² + 7b² + 7c²)/120).
    """
    for v in prange(curvatures.shape[0]):
        total = area = 0.0
        for i in range(metric.offsets[v], metric.offsets[v + 1]):
            f, k = metric.corners[i] // 3, metric.corners[i] % 3
            a, b, c = metric.lengths[f, k], metric.lengths[f, (k + 1) % 3], metric.lengths[f, (k + 2) % 3]
            share = b * c * math.sin(metric.angles[f, k])
            total += share * (1.0 + curvatures[v] * (a * a + 7.0 * (b * b + c * c)) / 120.0)
            area += share
        out[v] = total / area if area > 0.0 else 1.0


@parallel_kernel
def hat_means(curvatures, areas, metric, out):
    """Write the mean of curvatures, linear on each face, that the defect of each vertex has; 0 without data.

    A point of curvature in a triangle raises the angle at a corner by its barycentric coordinate there.
    """
    for v in prange(areas.shape[0]):
        out[v] = 0.0
        if areas[v] == 0.0:
            continue
        total = area = 0.0
        for i in range(metric.offsets[v], metric.offsets[v + 1]):
            f, k = metric.corners[i] // 3, metric.corners[i] % 3
            share = metric.lengths[f, (k + 1) % 3] * metric.lengths[f, (k + 2) % 3] * math.sin(metric.angles[f, k])
            p, q = metric.faces[f, (k + 1) % 3], metric.faces[f, (k + 2) % 3]
            total += share * (0.5 * curvatures[v] + 0.25 * (curvatures[p] + curvatures[q]))
            area += share
        out[v] = total / area
