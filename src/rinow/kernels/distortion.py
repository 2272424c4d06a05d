"""How far a relation or map is from an isometry."""

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.compatibility import discrepancy


@kernel
def worst_partner(kind, DX, DY, xs, ys, i):
    """Worst discrepancy of pair i with the earlier ones, and the place of the pair that has it."""
    worst, at = -1.0, i
    for j in range(i + 1):
        value = discrepancy(kind, DX[xs[i], xs[j]], DY[ys[i], ys[j]])
        if value > worst:
            worst, at = value, j
    return worst, at


@parallel_kernel
def worst_partners(kind, DX, DY, xs, ys, values, places):
    """Write the worst discrepancy of each pair with the earlier ones and where it occurs."""
    for i in prange(xs.shape[0]):
        values[i], places[i] = worst_partner(kind, DX, DY, xs, ys, i)


@kernel
def largest_discrepancy(kind, DX, DY, xs, ys):
    """Largest discrepancy of two pairs."""
    worst = 0.0
    for i in range(xs.shape[0]):
        worst = max(worst, worst_partner(kind, DX, DY, xs, ys, i)[0])
    return worst


@parallel_kernel
def largest_stretches(DX, DY, f, out):
    """Write to out[i] the largest ratio of distances of images and points, over the earlier points j."""
    for i in prange(f.shape[0]):
        worst = 0.0
        for j in range(i):
            a, b = DX[i, j], DY[f[i], f[j]]
            if b > 0.0:
                worst = max(worst, b / a if a > 0.0 else np.inf)
        out[i] = worst
