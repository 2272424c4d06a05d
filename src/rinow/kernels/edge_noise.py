"""How noisy the heights of the vertices of a mesh are, from edges that turn to and fro."""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.creases import foot_and_height

FEW = 32
"""Numbers up to which insertion sorts fastest."""


@parallel_kernel
def edge_gains(vertices, faces, partners, edge_halfedges, out):
    """Write the standard deviation of the turning at each edge for heights of the vertices with deviation 1."""
    for e in prange(edge_halfedges.shape[0]):
        h = edge_halfedges[e]
        g = partners[h]
        out[e] = np.inf
        if g >= 0:
            p, mine, _ = foot_and_height(h, vertices, faces)
            q, theirs, _ = foot_and_height(g, vertices, faces)
            if faces[h // 3, h % 3] != faces[g // 3, g % 3]:
                q = 1.0 - q
            start = (1.0 - p) / mine + (1.0 - q) / theirs
            end = p / mine + q / theirs
            out[e] = math.sqrt(1.0 / mine**2 + 1.0 / theirs**2 + start * start + end * end)


@parallel_kernel
def compare_turnings(turnings, gains, sharp, rounding, is_sharp, is_flat):
    """Write whether each edge turns by an angle, and by no more than heights that are rounded; both not without one."""
    for e in prange(len(turnings)):
        size = abs(turnings[e])
        is_sharp[e], is_flat[e] = size >= sharp, gains[e] < np.inf and size <= rounding * gains[e]


@kernel
def middle_spread(values, n):
    """Smaller distance from 0 of the quartiles on its two sides, over that of the normal law; 0 if one side is empty.

    Noise turns edges to and fro, a convex or a folded neighbourhood turns them one way.  The values get sorted.
    """
    if n > FEW:
        values[:n].sort()
    else:
        for i in range(1, n):
            x, j = values[i], i
            while j > 0 and values[j - 1] > x:
                values[j] = values[j - 1]
                j -= 1
            values[j] = x
    low, high = values[(n - 1) // 4], values[n - 1 - (n - 1) // 4]
    return max(min(-low, high), 0.0) / 0.6745


@parallel_kernel
def height_noise(turnings, gains, edge_of, offsets, corners, n_blocks, out):
    """Write the standard deviation of heights that explains the turnings at the edges of the star of each vertex."""
    n_vertices = offsets.shape[0] - 1
    for block in prange(n_blocks):
        values = np.empty(2 * FEW)
        for v in range(n_vertices * block // n_blocks, n_vertices * (block + 1) // n_blocks):
            if len(values) < 2 * (offsets[v + 1] - offsets[v]):
                values = np.empty(2 * (offsets[v + 1] - offsets[v]))
            n = 0
            for i in range(offsets[v], offsets[v + 1]):
                f, k = corners[i] // 3, corners[i] % 3
                for j in range(2):
                    e = edge_of[3 * f + (k + j) % 3]
                    if np.isfinite(turnings[e]):
                        values[n] = turnings[e] / gains[e]
                        n += 1
            out[v] = middle_spread(values, n) if n > 0 else 0.0
