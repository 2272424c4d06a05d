"""Polynomial fits of all orders to the points of nested balls, from one set of moments and one factorisation a ball."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels._jit import inlined, inner, lean
from rinow.kernels.eliminations import AT_ONCE, LANES, subtract_beside, subtract_earlier

MAX_ORDER = 8
N_ORDERS = MAX_ORDER - 1
"""Orders 2..8."""
WIDTH = 2 * MAX_ORDER + 1
"""Degrees of the moments, from 0 on."""
MOMENTS, OFFSETS = 24, 16
"""Length of the rows of moments and offsets: their degrees, rounded up to LANES."""
TERMS = (1, 3, 6, 10, 15, 21, 28, 36, 45)
"""Number of monomials of degree at most d."""
V_POWERS = np.array([b for d in range(MAX_ORDER + 1) for b in range(d + 1)])
DEGREES = np.array([d for d in range(MAX_ORDER + 1) for b in range(d + 1)])
SUMS = DEGREES * WIDTH + V_POWERS
"""Place of the sum of a monomial by degree; that of a product of two is the sum of their places."""
PIVOT = 2e-6
"""A monomial depends on earlier ones when this share of its squared norm is left.  A smaller share would admit fits
that nearly interpolate: precise and wrong."""
ONE_SIDED = 0.1
"""Distance of the mean of the points from the centre of a ball, over its radius, from which on it is one-sided.

Monomials about the centre of half a disc depend on each other so much that order 6 cannot be told; about the mean of
the points they do not.  The polynomials are the same.
"""
ROOMY = 2.0
"""Points over unknowns below which a fit may be loose beside its centre."""
ROWS, STRIDE = 48, 56
"""Rows of a factor, in fours, of which the last ones are spare, and columns: monomials, targets, data, spare ones."""
PLACES, COLUMNS = 92, 280
"""The most points of a crowd, rounded up to AT_ONCE, and second derivatives there, three each, rounded up to LANES."""
ROUNDING = 1e-15
"""Share of the squared offsets below which what a fit leaves of them is rounding, other in another order of sums."""
SPARE, SURPLUS = 2, 1.25
"""An order needs SPARE more points than unknowns, and above 2 also SURPLUS as many."""


class Fits(NamedTuple):
    """Work space of one thread.

    moments[ball, b, a] and offsets[ball, b, a] are the sums of u^a v^b and of w u^a v^b, `sums` and `offset_sums` those
    of one ball by degree, u and v being counted from `origin`; `shifts` are powers of its coordinates.  Of the points
    still to be added `powers` has u^a and `places` has v and w.  targets[i] are value and derivatives f1, f2, f11/2,
    f12, f22/2 of a monomial at the centre.  `monomials`, `columns`, their squares and `bends` serve points beside it,
    of balls of at most PLACES points.
    """

    origin: np.ndarray
    shifts: np.ndarray
    targets: np.ndarray

    moments: np.ndarray
    offsets: np.ndarray
    powers: np.ndarray
    places: np.ndarray
    counts: np.ndarray
    squares: np.ndarray
    sums: np.ndarray
    offset_sums: np.ndarray
    factor: np.ndarray
    jets: np.ndarray
    covariances: np.ndarray
    residuals: np.ndarray

    monomials: np.ndarray
    columns: np.ndarray
    squares_of_columns: np.ndarray
    bends: np.ndarray


@inner
def fits(n_shells):
    """Work space for at most n shells."""
    p = TERMS[MAX_ORDER]
    return Fits(
        np.zeros(2),
        np.ones((2, MAX_ORDER + 1)),
        np.eye(p, 6),
        np.zeros((n_shells, WIDTH + 1, MOMENTS)),
        np.zeros((n_shells, MAX_ORDER + 2, OFFSETS)),
        np.zeros((n_shells, AT_ONCE, MOMENTS)),
        np.zeros((n_shells, AT_ONCE, 2)),
        np.zeros(n_shells),
        np.zeros(n_shells),
        np.zeros(WIDTH * WIDTH),
        np.zeros(WIDTH * WIDTH),
        np.zeros((ROWS, STRIDE)),
        np.zeros((MAX_ORDER + 1, 6)),
        np.zeros((MAX_ORDER + 1, 6)),
        np.zeros(MAX_ORDER + 1),
        np.ones((TERMS[MAX_ORDER - 2], PLACES)),
        np.zeros((ROWS, COLUMNS)),
        np.zeros(COLUMNS),
        np.zeros(PLACES),
    )


@lean
def place_origin(points, n, reach, work):
    """Count u and v from the mean of the points of one ball if it is one-sided, else from its centre; whether it is."""
    u = v = count = 0.0
    for i in range(n):
        if points[3, i] < reach * reach:
            u, v, count = u + points[0, i], v + points[1, i], count + 1.0
    u, v = u / count, v / count
    one_sided = u * u + v * v > (ONE_SIDED * reach) ** 2
    if not one_sided and work.origin[0] == 0.0 and work.origin[1] == 0.0:
        return False  # the targets are at hand
    work.origin[0], work.origin[1] = (u, v) if one_sided else (0.0, 0.0)
    px, py = work.shifts[0], work.shifts[1]
    for k in range(1, MAX_ORDER + 1):
        px[k], py[k] = -px[k - 1] * work.origin[0] / reach, -py[k - 1] * work.origin[1] / reach
    for i in range(TERMS[MAX_ORDER]):
        a, b, target = DEGREES[i] - V_POWERS[i], V_POWERS[i], work.targets[i]
        a1, b1, a2, b2 = max(a - 1, 0), max(b - 1, 0), max(a - 2, 0), max(b - 2, 0)
        target[0], target[1], target[2] = px[a] * py[b], a * px[a1] * py[b], b * px[a] * py[b1]
        target[3], target[4] = 0.5 * a * (a - 1) * px[a2] * py[b], a * b * px[a1] * py[b1]
        target[5] = 0.5 * b * (b - 1) * px[a] * py[b2]
    return one_sided


@inlined
def add_products(first, powers, factors, order, sums, stride):
    """Add to sums[b, a] the products first v^b u^a of AT_ONCE points with powers u^a and factors v, two rows at a time.

    Powers and sums are flat, the rows of the latter `stride` apart; what is beyond a + b = order means nothing.
    """
    y0, y1, y2, y3 = first
    for b in range(0, order + 1, 2):
        z0, z1, z2, z3 = y0 * factors[0, 0], y1 * factors[1, 0], y2 * factors[2, 0], y3 * factors[3, 0]
        rows = sums[b * stride :]
        for a in range((order - b + LANES) // LANES * LANES):
            x0, x1, x2, x3 = powers[a], powers[MOMENTS + a], powers[2 * MOMENTS + a], powers[3 * MOMENTS + a]
            rows[a] += (y0 * x0 + y1 * x1) + (y2 * x2 + y3 * x3)
            rows[stride + a] += (z0 * x0 + z1 * x1) + (z2 * x2 + z3 * x3)
        y0, y1, y2, y3 = z0 * factors[0, 0], z1 * factors[1, 0], z2 * factors[2, 0], z3 * factors[3, 0]


@inlined
def add_points(powers, places, order, moments, offsets):
    """Add the points that wait to the moments and offsets of a shell."""
    add_products((1.0, 1.0, 1.0, 1.0), powers, places, 2 * order, moments, MOMENTS)
    w = (places[0, 1], places[1, 1], places[2, 1], places[3, 1])
    add_products(w, powers, places, order, offsets, OFFSETS)


@lean
def add_all(terms, sums):
    """Add one flat array to another; as a sum of arrays this compiles code for messages about their shapes."""
    for i in range(len(sums)):
        sums[i] += terms[i]


@lean
def add_moments(points, n, reaches, order, work):
    """Write the moments and offsets of each ball, the number of its points and the sum of w^2."""
    n_shells, top = len(reaches), 2 * order + 1
    counts, squares, places = work.counts, work.squares, work.places
    moments, offsets = work.moments.reshape(len(counts), -1), work.offsets.reshape(len(counts), -1)
    powers = work.powers.reshape(len(counts), -1)
    moments[:n_shells], offsets[:n_shells] = 0.0, 0.0
    counts[:n_shells], squares[:n_shells] = 0.0, 0.0
    for i in range(n):
        u, v, w, q = points[0, i] - work.origin[0], points[1, i] - work.origin[1], points[2, i], points[3, i]
        shell = 0
        while shell < n_shells and q >= reaches[shell] * reaches[shell]:
            shell += 1
        if shell == n_shells:
            continue
        place = int(counts[shell]) % AT_ONCE
        counts[shell] += 1.0
        squares[shell] += w * w
        x = 1.0
        for a in range(place * MOMENTS, place * MOMENTS + top):
            powers[shell, a] = x
            x *= u
        places[shell, place, 0], places[shell, place, 1] = v, w
        if place == AT_ONCE - 1:
            add_points(powers[shell], places[shell], order, moments[shell], offsets[shell])
    for shell in range(n_shells):
        last = int(counts[shell]) % AT_ONCE
        if last > 0:
            powers[shell, last * MOMENTS :] = 0.0
            add_points(powers[shell], places[shell], order, moments[shell], offsets[shell])
        if shell > 0:
            counts[shell] += counts[shell - 1]
            squares[shell] += squares[shell - 1]
            add_all(moments[shell - 1], moments[shell])
            add_all(offsets[shell - 1], offsets[shell])


@lean
def highest_order(count, order):
    """The highest order not above the given one that `count` points admit; 1 for none."""
    while order > 1 and (count < TERMS[order] + SPARE or (order > 2 and count < SURPLUS * TERMS[order])):
        order -= 1
    return order


@inlined
def sort_by_degree(moments, reach, last, sums):
    """Write the moments of degree up to `last`, in coordinates over `reach`, in the order of degree and b."""
    scale = 1.0
    for d in range(last + 1):
        for b in range(d + 1):
            sums[d * WIDTH + b] = moments[b, d - b] * scale
        scale /= reach


@inlined
def write_equation(i, order, work):
    """Write a row of the normal equations; the columns after the monomials are the targets and the data."""
    row, p, targets, own = work.factor[i], TERMS[order], work.targets[i], work.sums[SUMS[i] :]
    for j in range(i, p):
        row[j] = own[SUMS[j]]
    for k in range(6):
        row[p + k] = targets[k]
    row[p + 6] = work.offset_sums[SUMS[i]]


@lean
def fit_orders(shell, reach, order, work):
    """Fit all orders up to `order`; return the highest complete one.

    The upper Cholesky factor of the monomials in the order of their degree holds those of all lower orders, and the
    columns beside it turn into the rows z and y for which the target c of order d is the sum of z_kc y_k, its
    covariance the sum of z_ka z_kb and the explained square the sum of y_k^2 over the monomials k of order d.
    """
    sort_by_degree(work.moments[shell], reach, 2 * order, work.sums)
    sort_by_degree(work.offsets[shell], reach, order, work.offset_sums)
    factor, p, flat = work.factor, TERMS[order], work.factor.reshape(-1)
    c0 = c1 = c2 = c3 = c4 = c5 = v33 = v34 = v35 = v44 = v45 = v55 = 0.0
    left = work.squares[shell]
    degree = 0
    for k in range(p):
        first = k // LANES * LANES
        n = (p + 7 - first + LANES - 1) // LANES * LANES
        if k % AT_ONCE == 0:
            for i in range(k, min(k + AT_ONCE, p)):
                write_equation(i, order, work)
            subtract_earlier(k, first, n, factor, flat, STRIDE)
        subtract_beside(k, first, n, factor, flat, STRIDE)
        row = factor[k]
        if not row[k] > PIVOT * work.sums[2 * SUMS[k]]:
            return degree - 1
        inverse, rest = 1.0 / math.sqrt(row[k]), flat[k * STRIDE + first :]
        for j in range(n):
            rest[j] *= inverse
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
            work.residuals[degree] = max(left, ROUNDING * work.squares[shell])
            degree += 1
    return order


@lean
def coefficients(order, top, work, out):
    """Write the coefficients, in coordinates over the reach, of an order of the factorisation made for `top`."""
    p, n, factor = TERMS[top], TERMS[order], work.factor
    for i in range(n):
        out[i] = factor[i, p + 6]
    for k in range(n - 1, -1, -1):
        out[k] *= factor[k, k]
        for i in range(k):
            out[i] -= factor[i, k] * out[k]
