"""How far a finite metric space is from having midpoints."""

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange


@kernel
def midpoint_defect(D, i, j):
    """Least e for which two points have an e-midpoint: |2 d(i, k) - d(i, j)| <= e and |2 d(k, j) - d(i, j)| <= e."""
    length, least = D[i, j], np.inf
    for k in range(D.shape[0]):
        least = min(least, max(abs(2.0 * D[i, k] - length), abs(2.0 * D[j, k] - length)))
    return least


@parallel_kernel
def worst_midpoint_defects(D, out):
    """Write for each point i the greatest defect of the pairs (i, j), i < j."""
    n = D.shape[0]
    for r in prange(n):
        i = r // 2 if r % 2 == 0 else n - 1 - r // 2  # long and short rows in turn, for equal shares
        worst = 0.0
        for j in range(i + 1, n):
            worst = max(worst, midpoint_defect(D, i, j))
        out[i] = worst
