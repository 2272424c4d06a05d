"""How well a fit fixes second derivatives beside its centre: the variances of them that noise of variance 1 causes."""

from rinow.kernels._jit import inlined, lean
from rinow.kernels.eliminations import AT_ONCE, LANES, subtract_beside, subtract_earlier
from rinow.kernels.nested_fits import COLUMNS, DEGREES, TERMS, V_POWERS


@lean
def write_monomials(points, size, core, reach, last, work):
    """Write the monomials of degree up to `last` at the points of the core, one column each; how many columns.

    They are rounded up to AT_ONCE, the last ones being spare.
    """
    monomials, n = work.monomials, 0
    x, y = monomials[1], monomials[2]
    for j in range(size):
        u, v = points[0, j], points[1, j]
        if u * u + v * v < core * core:
            x[n], y[n] = (u - work.origin[0]) / reach, (v - work.origin[1]) / reach
            n += 1
    n = (n + AT_ONCE - 1) // AT_ONCE * AT_ONCE
    for k in range(TERMS[1], TERMS[last]):
        d, b = DEGREES[k], V_POWERS[k]
        row, lower, factor = monomials[k], monomials[k - d if b < d else k - d - 1], x if b < d else y
        for j in range(n):
            row[j] = factor[j] * lower[j]
    return n


@inlined
def write_bends(k, n, work):
    """Write to a row of the columns the second derivatives, over the reach, of a monomial at n points."""
    row, d, b, m = work.columns[k], DEGREES[k], V_POWERS[k], work.monomials
    uu, uv, vv = (d - b) * (d - b - 1), (d - b) * b, b * (b - 1)
    i = k - 2 * d + 1  # the monomial less two factors u
    x, y, z = m[i if uu > 0 else 0], m[i - 1 if uv > 0 else 0], m[i - 2 if vv > 0 else 0]
    for j in range(n):
        row[j], row[n + j], row[2 * n + j] = uu * x[j], uv * y[j], vv * z[j]


@lean
def bend_variances(points, size, core, reach, order, work):
    """Write to `work.bends` the summed variances of the second derivatives of a fit, for noise of variance 1.

    They are those at the points of a ball of at most PLACES that are nearer than `core` to its centre, in their order.
    """
    n = write_monomials(points, size, core, reach, order - 2, work)
    columns, squares, factor, flat = work.columns, work.squares_of_columns, work.factor, work.columns.reshape(-1)
    width = (3 * n + LANES - 1) // LANES * LANES
    columns[: TERMS[1], :width] = 0.0
    squares[:width] = 0.0
    for k in range(TERMS[1], TERMS[order]):
        write_bends(k, n, work)
    for k in range(TERMS[1], TERMS[order]):
        if k % AT_ONCE == 0:
            subtract_earlier(k, 0, width, factor, flat, COLUMNS)
        subtract_beside(k, 0, width, factor, flat, COLUMNS)
        row, inverse = columns[k], factor[k, k]
        for j in range(width):
            row[j] *= inverse
            squares[j] += row[j] * row[j]
    for j in range(n):
        work.bends[j] = (squares[j] + squares[n + j] + squares[2 * n + j]) / reach**4
