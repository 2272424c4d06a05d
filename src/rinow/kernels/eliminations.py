"""Rows of a Cholesky factor, or of what it is applied to, less what earlier rows explain: four by four."""

from rinow.kernels._jit import inlined

AT_ONCE = 4
"""Points added to moments, and rows subtracted from others, in one go: rows are short, loops over them many."""
LANES = 8
"""Loops over rows begin and end at multiples of it: the last few entries one by one would take as long as the rest."""


@inlined
def subtract_earlier(k, first, n, factor, rows, stride):
    """Subtract from n columns of the rows k..k + 3 what the rows before k, by the columns of the factor, explain.

    Rows are `stride` apart in one flat array: then vector code needs to make sure once only that they do not overlap.
    """
    own = rows[k * stride + first :]
    for m in range(0, k, AT_ONCE):
        a0, a1, a2, a3 = factor[m, k], factor[m + 1, k], factor[m + 2, k], factor[m + 3, k]
        b0, b1, b2, b3 = factor[m, k + 1], factor[m + 1, k + 1], factor[m + 2, k + 1], factor[m + 3, k + 1]
        c0, c1, c2, c3 = factor[m, k + 2], factor[m + 1, k + 2], factor[m + 2, k + 2], factor[m + 3, k + 2]
        d0, d1, d2, d3 = factor[m, k + 3], factor[m + 1, k + 3], factor[m + 2, k + 3], factor[m + 3, k + 3]
        earlier = rows[m * stride + first :]
        for j in range(n):
            w, x, y, z = earlier[j], earlier[stride + j], earlier[2 * stride + j], earlier[3 * stride + j]
            own[j] -= (a0 * w + a1 * x) + (a2 * y + a3 * z)
            own[stride + j] -= (b0 * w + b1 * x) + (b2 * y + b3 * z)
            own[2 * stride + j] -= (c0 * w + c1 * x) + (c2 * y + c3 * z)
            own[3 * stride + j] -= (d0 * w + d1 * x) + (d2 * y + d3 * z)


@inlined
def subtract_beside(k, first, n, factor, rows, stride):
    """Subtract from n columns of row k what the rows before it among its four explain."""
    own = rows[k * stride + first :]
    for m in range(k // AT_ONCE * AT_ONCE, k):
        a, earlier = factor[m, k], rows[m * stride + first :]
        for j in range(n):
            own[j] -= a * earlier[j]
