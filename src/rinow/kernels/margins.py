"""What single lengths change in a weighted sum of angle defects: the jumps of the slope of its weights."""

import math

import numpy as np

from rinow.kernels._jit import kernel, lean, parallel_kernel, prange


@lean
def slope_beside(h, weights, metric):
    """Derivative of the weighted sum of the angles of the face of half-edge h in its length."""
    f, i, j, far = h // 3, h % 3, (h + 1) % 3, (h + 2) % 3
    w = weights[metric.faces[f, far]]
    at_i = (w - weights[metric.faces[f, i]]) / math.tan(metric.angles[f, j])
    at_j = (w - weights[metric.faces[f, j]]) / math.tan(metric.angles[f, i])
    return (at_i + at_j) / metric.lengths[f, far]


@lean
def n_weighted(f, weights, metric):
    """How many vertices of a face have a weight."""
    count = 0
    for k in range(3):
        count += weights[metric.faces[f, k]] > 0.0
    return count


@kernel
def squared_jump(h, spacing, weights, metric):
    """Square of what an error of half-edge h makes in the weighted sum, over the number of vertices with a weight.

    Noise across a surface changes an edge by its square over the length of the edge: that of a short one errs by more.
    """
    f, far = h // 3, (h + 2) % 3
    total, count = slope_beside(h, weights, metric), n_weighted(f, weights, metric)
    g = metric.partners[h]
    if g >= 0:
        total += slope_beside(g, weights, metric)
        count += weights[metric.faces[g // 3, (g + 2) % 3]] > 0.0
    total *= max(spacing / metric.lengths[f, far], 1.0)
    return total * total / max(count, 1)


@parallel_kernel
def jump_squares(weights, spacing, metric, out):
    """Write for each vertex with a weight its part of the sum of these squares over all edges, 0 elsewhere."""
    for v in prange(metric.offsets.shape[0] - 1):
        total = 0.0
        for i in range(metric.offsets[v], metric.offsets[v + 1]):
            c = metric.corners[i]
            for side in range(3):
                h = 3 * (c // 3) + (c + side) % 3
                share = 1.0 if side == 1 or metric.partners[h] < 0 else 0.5
                total += share * squared_jump(h, spacing[v], weights, metric)
        out[v] = 0.0
        if weights[v] > 0.0:
            out[v] = total if math.isfinite(total) else np.nan
