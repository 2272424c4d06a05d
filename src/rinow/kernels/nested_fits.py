"""Polynomial fits of all orders to the points of nested balls, from one set of moments and one factorisation a ball."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels._jit import inner

MAX_ORDER = 8
N_ORDERS = MAX_ORDER - 1
"""Orders 2..8."""
WIDTH = 20
"""Columns of the table of moments, whose first 2 * MAX_ORDER + 1 are used."""
TERMS = (1, 3, 6, 10, 15, 21, 28, 36, 45)
"""Number of monomials of degree at most d."""
V_POWERS = np.array([b for d in range(MAX_ORDER + 1) for b in range(d + 1)])
U_POWERS = np.array([d - b for d in range(MAX_ORDER + 1) for b in range(d + 1)])
PIVOT = 2e-6
"""A monomial depends on earlier ones when this share of its squared norm is left.  A smaller share would admit fits
that nearly interpolate: precise and wrong."""
SPARE, SURPLUS = 2, 1.25
"""An order needs SPARE more points than unknowns, and above 2 also SURPLUS as many."""


class Fits(NamedTuple):
    """Work space of one thread."""

    moments: np.ndarray
    offsets: np.ndarray
    counts: np.ndarray
    squares: np.ndarray
    factor: np.ndarray
    diagonal: np.ndarray
    jets: np.ndarray
    covariances: np.ndarray
    residuals: np.ndarray


@inner
def fits(n_shells):
    """Work space for at most n shells."""
    p = TERMS[MAX_ORDER]
    return Fits(
        np.zeros((n_shells, WIDTH, WIDTH)),
        np.zeros((n_shells, MAX_ORDER + 1, MAX_ORDER + 1)),
        np.zeros(n_shells),
        np.zeros(n_shells),
        np.zeros((p, p + 8)),
        np.zeros(p),
        np.zeros((MAX_ORDER + 1, 6)),
        np.zeros((MAX_ORDER + 1, 6)),
        np.zeros(MAX_ORDER + 1),
    )


@inner
def add_moments(points, n, reaches, order, work):
    """Sums of u^a v^b over the points of each ball to moments[ball, b, a], of w u^a v^b to offsets[ball, b, a]."""
    n_shells, top = len(reaches), 2 * order + 1
    moments, offsets, counts, squares = work.moments, work.offsets, work.counts, work.squares
    moments[:n_shells, :top, :top] = 0.0
    offsets[:n_shells, : order + 1, : order + 1] = 0.0
    counts[:n_shells], squares[:n_shells] = 0.0, 0.0
    powers = np.ones(WIDTH)
    for i in range(n):
        u, v, w, q = points[0, i], points[1, i], points[2, i], points[3, i]
        shell = 0
        while shell < n_shells and q >= reaches[shell] * reaches[shell]:
            shell += 1
        if shell == n_shells:
            continue
        counts[shell] += 1.0
        squares[shell] += w * w
        for a in range(1, top):
            powers[a] = powers[a - 1] * u
        y = 1.0
        for b in range(top):
            row = moments[shell, b]
            for a in range(top - b):
                row[a] += y * powers[a]
            y *= v
        y = w
        for b in range(order + 1):
            row = offsets[shell, b]
            for a in range(order + 1 - b):
                row[a] += y * powers[a]
            y *= v
    for shell in range(1, n_shells):
        counts[shell] += counts[shell - 1]
        squares[shell] += squares[shell - 1]
        for b in range(top):
            for a in range(top - b):
                moments[shell, b, a] += moments[shell - 1, b, a]
        for b in range(order + 1):
            for a in range(order + 1 - b):
                offsets[shell, b, a] += offsets[shell - 1, b, a]


@inner
def highest_order(count, order):
    """The highest order not above the given one that `count` points admit; 1 for none."""
    while order > 1 and (count < TERMS[order] + SPARE or (order > 2 and count < SURPLUS * TERMS[order])):
        order -= 1
    return order


@inner
def fill(shell, reach, order, work):
    """Write the normal equations in coordinates over `reach`; columns after the monomials: units 0..5 and the data."""
    p = TERMS[order]
    scales = np.ones(2 * MAX_ORDER + 1)
    for k in range(1, 2 * order + 1):
        scales[k] = scales[k - 1] / reach
    moments, offsets, factor = work.moments[shell], work.offsets[shell], work.factor
    for i in range(p):
        ui, vi = U_POWERS[i], V_POWERS[i]
        for d in range(ui + vi, order + 1):
            scale, first = scales[ui + vi + d], TERMS[d] - d - 1
            for b in range(vi if d == ui + vi else 0, d + 1):
                factor[i, first + b] = moments[vi + b, ui + d - b] * scale
        for k in range(6):
            factor[i, p + k] = 1.0 if i == k else 0.0
        factor[i, p + 6] = offsets[vi, ui] * scales[ui + vi]
        work.diagonal[i] = factor[i, i]


@inner
def fit_orders(shell, reach, order, work):
    """Fit all orders up to `order`; return the highest complete one.

    The upper Cholesky factor of the monomials in the order of their degree holds those of all lower orders, and the
    columns beside it turn into the rows z and y for which the coefficient c of order d is the sum of z_kc y_k, its
    covariance the sum of z_ka z_kb and the explained square the sum of y_k^2 over the monomials k of order d.
    """
    fill(shell, reach, order, work)
    factor, p = work.factor, TERMS[order]
    c0 = c1 = c2 = c3 = c4 = c5 = v33 = v34 = v35 = v44 = v45 = v55 = 0.0
    left = work.squares[shell]
    degree = 0
    for k in range(p):
        if not factor[k, k] > PIVOT * work.diagonal[k]:
            return degree - 1
        inverse = 1.0 / math.sqrt(factor[k, k])
        row = factor[k]
        for j in range(k, p + 7):
            row[j] *= inverse
        for i in range(k + 1, p):
            below, f = factor[i], row[i]
            for j in range(i, p + 7):
                below[j] -= f * row[j]
        y, z3, z4, z5 = row[p + 6], row[p + 3], row[p + 4], row[p + 5]
        c0, c1, c2, c3 = c0 + row[p] * y, c1 + row[p + 1] * y, c2 + row[p + 2] * y, c3 + z3 * y
        c4, c5, left = c4 + z4 * y, c5 + z5 * y, left - y * y
        v33, v34, v35 = v33 + z3 * z3, v34 + z3 * z4, v35 + z3 * z5
        v44, v45, v55 = v44 + z4 * z4, v45 + z4 * z5, v55 + z5 * z5
        row[k] = inverse
        if k + 1 == TERMS[degree]:
            jet, cov = work.jets[degree], work.covariances[degree]
            jet[0], jet[1], jet[2] = c0, c1 / reach, c2 / reach
            s = 1.0 / (reach * reach)
            jet[3], jet[4], jet[5] = 2.0 * s * c3, s * c4, 2.0 * s * c5
            s *= s
            cov[0], cov[1], cov[2] = 4.0 * s * v33, 2.0 * s * v34, 4.0 * s * v35
            cov[3], cov[4], cov[5] = s * v44, 2.0 * s * v45, 4.0 * s * v55
            work.residuals[degree] = max(left, 0.0)
            degree += 1
    return order


@inner
def bend_variance(u, v, reach, order, work, z):
    """Sum of the variances of the second derivatives of a fit at (u, v), for noise of variance 1; z is (3, 45)."""
    x, y, total, factor = u / reach, v / reach, 0.0, work.factor
    for k in range(TERMS[order]):
        a, b = U_POWERS[k], V_POWERS[k]
        z[0, k] = a * (a - 1) * x ** max(a - 2, 0) * y**b
        z[1, k] = a * b * x ** max(a - 1, 0) * y ** max(b - 1, 0)
        z[2, k] = b * (b - 1) * x**a * y ** max(b - 2, 0)
        for c in range(3):
            for i in range(k):
                z[c, k] -= factor[i, k] * z[c, i]
            z[c, k] *= factor[k, k]
            total += z[c, k] * z[c, k]
    return total / reach**4


@inner
def coefficients(order, top, work, out):
    """Write the coefficients, in coordinates over the reach, of an order of the factorisation made for `top`."""
    p, n, factor = TERMS[top], TERMS[order], work.factor
    for i in range(n):
        out[i] = factor[i, p + 6]
    for i in range(n - 1, -1, -1):
        total = out[i]
        for k in range(i + 1, n):
            total -= factor[i, k] * out[k]
        out[i] = total * factor[i, i]
