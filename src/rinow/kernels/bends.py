"""How well a fit fixes second derivatives beside its centre: the variances of them that noise of variance 1 causes."""

from rinow.kernels._jit import inner
from rinow.kernels.nested_fits import DEGREES, TERMS, V_POWERS, subtract_earlier


@inner
def write_monomials(points, size, core, reach, last, work):
    """Write the monomials of degree up to `last` at the points of the core, one column each; how many columns."""
    monomials, n = work.monomials, 0
    for j in range(size):
        u, v = points[0, j], points[1, j]
        if u * u + v * v < core * core:
            x, y = (u - work.origin[0]) / reach, (v - work.origin[1]) / reach
            for k in range(1, TERMS[last]):
                d, b = DEGREES[k], V_POWERS[k]
                monomials[k, n] = x * monomials[k - d, n] if b < d else y * monomials[k - d - 1, n]
            n += 1
    return n


@inner
def bend_variances(points, size, core, reach, order, work):
    """Write to `work.bends` the summed variances of the second derivatives of a fit, for noise of variance 1.

    They are those at the points of a ball of at most CROWD that are nearer than `core` to its centre, in their order.
    """
    n = write_monomials(points, size, core, reach, order - 2, work)
    columns, bends, factor = work.columns, work.bends, work.factor
    columns[: TERMS[1], : 3 * n] = 0.0
    bends[:n] = 0.0
    for k in range(TERMS[1], TERMS[order]):
        row, d, b = columns[k], DEGREES[k], V_POWERS[k]
        for c, share in enumerate(((d - b) * (d - b - 1), (d - b) * b, b * (b - 1))):
            lower = work.monomials[k - 2 * d + 1 - c if share > 0 else 0]  # the monomial less two factors
            for j in range(n):
                row[c * n + j] = share * lower[j]
        subtract_earlier(k, 0, 3 * n, factor, columns)
        for c in range(3):
            for j in range(n):
                row[c * n + j] *= factor[k, k]
                bends[j] += row[c * n + j] ** 2
    for j in range(n):
        bends[j] /= reach**4
