"""Jets of a surface at a vertex: polynomial heights over the tangent plane, fitted to circles through the vertex.

The circle that touches the tangent plane at p and runs through a neighbour at distance d and height z has the
curvature 2 z / d^2.  The fit gives each of these curvatures the same weight, so each height the weight 1/d^4.
"""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels import monge, stencils
from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.stencils import QUADRIC_POINTS, SOFTENING

MAX_ORDER = 4
WIDTH = 2 * MAX_ORDER + 1
TERMS = (0, 2, 5, 9, 14)
"""Number of monomials x^a y^b with 1 <= a + b <= order; no constant, for the surface runs through p."""
X_POWERS = np.array([1, 0, 2, 1, 0, 3, 2, 1, 0, 4, 3, 2, 1, 0])
Y_POWERS = np.array([0, 1, 0, 1, 2, 0, 1, 2, 3, 0, 1, 2, 3, 4])
SPARE = 1.25
"""Points for each unknown that an order needs."""
PIVOT = 5e-4
"""A monomial depends on the earlier ones when this share of its norm is left: far more than rounding leaves, for
a fit that nearly interpolates is precise and wrong."""
STEEP = 0.1
"""Squared slope of the fitted surface from which its own tangent plane is the better one to fit over."""


class Scratch(NamedTuple):
    """Work space of one thread."""

    members: np.ndarray
    marks: np.ndarray
    points: np.ndarray
    powers: np.ndarray
    moments: np.ndarray
    heights: np.ndarray
    factor: np.ndarray
    coefficients: np.ndarray
    rows: np.ndarray


@kernel
def scratch(n_vertices):
    """Work space for a surface with n vertices."""
    n_terms = TERMS[MAX_ORDER]
    return Scratch(
        np.empty(n_vertices, np.int32),
        np.zeros(n_vertices, np.int32),
        np.empty((n_vertices, 3)),
        np.ones(WIDTH),
        np.empty((WIDTH, WIDTH)),
        np.empty((MAX_ORDER + 1, MAX_ORDER + 1)),
        np.empty((n_terms, n_terms)),
        np.empty(n_terms),
        np.empty((4, n_terms)),
    )


@kernel
def add_moments(points, n, powers, moments, heights):
    """Write the sums of w x^a y^b to moments[b, a], of w z x^a y^b to heights[b, a]; return the sum of w z^2."""
    moments[:, :] = 0.0
    heights[:, :] = 0.0
    total = 0.0
    for i in range(n):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        d2 = x * x + y * y + z * z + SOFTENING
        wy = 1.0 / (d2 * d2)
        total += wy * z * z
        for a in range(1, WIDTH):
            powers[a] = powers[a - 1] * x
        for b in range(WIDTH):
            for a in range(WIDTH):
                moments[b, a] += wy * powers[a]
            if b <= MAX_ORDER:
                for a in range(MAX_ORDER + 1):
                    heights[b, a] += wy * z * powers[a]
            wy *= y
    return total


@kernel
def factorise(moments, first, last, factor):
    """Write the upper Cholesky factor of the monomials first..last - 1, its diagonal inverted; where it broke off."""
    for i in range(first, last):
        for j in range(i, last):
            factor[i, j] = moments[Y_POWERS[i] + Y_POWERS[j], X_POWERS[i] + X_POWERS[j]]
    for k in range(first, last):
        if not factor[k, k] > PIVOT * moments[2 * Y_POWERS[k], 2 * X_POWERS[k]]:
            return k
        factor[k, k] = 1.0 / math.sqrt(factor[k, k])
        for j in range(k + 1, last):
            factor[k, j] *= factor[k, k]
        for i in range(k + 1, last):
            for j in range(i, last):
                factor[i, j] -= factor[k, i] * factor[k, j]
    return last


@kernel
def forward(factor, first, last, x):
    """Solve with the transposed factor, in place."""
    for k in range(first, last):
        x[k] *= factor[k, k]
        for i in range(k + 1, last):
            x[i] -= factor[k, i] * x[k]


@kernel
def solve(heights, factor, first, last, c):
    """Write the coefficients; return the part of the sum of w z^2 that they explain."""
    c[:first] = 0.0
    for i in range(first, last):
        c[i] = heights[Y_POWERS[i], X_POWERS[i]]
    forward(factor, first, last, c)
    explained = 0.0
    for i in range(last - 1, first - 1, -1):
        explained += c[i] * c[i]
        for k in range(i + 1, last):
            c[i] -= factor[i, k] * c[k]
        c[i] *= factor[i, i]
    return explained


@kernel
def fit_jet(points, n, order, work):
    """Fit the highest order that n points determine; return its range of monomials (empty without any) and residual.

    Below order 2 the given tangent plane is kept: Euler's formula, the monomials 2..4 alone.
    """
    while order > 2 and n < SPARE * TERMS[order]:
        order -= 1
    if n < QUADRIC_POINTS:
        order = 1
        stencils.stretch_to_chords(points, n)
    total = add_moments(points, n, work.powers, work.moments, work.heights)
    rank = factorise(work.moments, 0, TERMS[order], work.factor)
    while order > 1 and rank < TERMS[order]:
        order -= 1
    first, last = 0, TERMS[order]
    if order == 1:
        first, last = 2, 5
        if n < 3 or factorise(work.moments, first, last, work.factor) < last:
            return 0, 0, 0.0
    explained = solve(work.heights, work.factor, first, last, work.coefficients)
    return first, last, max(total - explained, 0.0)


@kernel
def second_derivative_covariance(n, first, last, work):
    """Covariance of f11, f12, f22 for heights of variance 1/w, and the vertex's own, shared by all, of 1/mean w."""
    rows, moments = work.rows, work.moments
    rows[:, :] = 0.0
    for i in range(first, last):
        rows[3, i] = moments[Y_POWERS[i], X_POWERS[i]] * math.sqrt(n / moments[0, 0])
    forward(work.factor, first, last, rows[3])
    for r in range(3):
        rows[r, r + 2] = 1.0 if r == 1 else 2.0
        forward(work.factor, first, last, rows[r])
    a = b = c = d = e = f = x = y = z = 0.0
    for k in range(first, last):
        p, q, r, s = rows[0, k], rows[1, k], rows[2, k], rows[3, k]
        a, b, c, d, e, f = a + p * p, b + p * q, c + p * r, d + q * q, e + q * r, f + r * r
        x, y, z = x + p * s, y + q * s, z + r * s
    return a + x * x, b + x * y, c + x * z, d + y * y, e + y * z, f + z * z


@kernel
def standard_error(residual, n, first, last, work):
    """Standard error, to second order, of K = (f11 f22 - f12^2) / W^4; nan without a spare point."""
    spare = n - (last - first)
    if spare == 0:
        return np.nan
    v11, c12, c13, v12, c23, v22 = second_derivative_covariance(n, first, last, work)
    coefficients = work.coefficients
    f11, f12, f22 = 2.0 * coefficients[2], coefficients[3], 2.0 * coefficients[4]
    linear = f22 * f22 * v11 + 4.0 * f12 * f12 * v12 + f11 * f11 * v22
    linear += 2.0 * f11 * f22 * c13 - 4.0 * f12 * (f22 * c12 + f11 * c23)
    quadratic = v11 * v22 + c13 * c13 + 2.0 * v12 * v12
    variance = residual / spare
    w2 = 1.0 + coefficients[0] ** 2 + coefficients[1] ** 2
    return math.sqrt(variance * (max(linear, 0.0) + variance * quadratic)) / w2**2


@kernel
def fit_ball(v, radius, order, surface, work):
    """Fit a jet to the metric ball; its monomials and residual, the number of points, and the frame of its plane.

    Where the surface turns out steep over the first tangent plane, the fit is made again over its own.
    """
    first = last = n = 0
    residual, c = 0.0, work.coefficients
    normal = tangent = stencils.normal_at(v, surface)
    if normal == (0.0, 0.0, 0.0):
        return first, last, residual, n, tangent, normal
    for attempt in range(2):
        n = stencils.metric_ball(v, radius, normal, 2 * v + attempt + 1, surface, work.members, work.marks)
        tangent = stencils.local_coordinates(work.members, n, radius, normal, surface.vertices, work.points)
        first, last, residual = fit_jet(work.points, n - 1, order, work)
        if attempt == 1 or last == 0 or c[0] ** 2 + c[1] ** 2 < STEEP:
            break
        normal = monge.graph_frame(c[0], c[1], tangent, normal)[2]
    return first, last, residual, n - 1, tangent, normal


@parallel_kernel
def ball_jets(start, stop, radii, order, surface, n_blocks, frames, spread):
    """Write frames and standard errors of vertices start..stop - 1, from metric balls; nan without a fit."""
    for block in prange(n_blocks):
        work = scratch(surface.vertices.shape[0])
        for v in range(start + (stop - start) * block // n_blocks, start + (stop - start) * (block + 1) // n_blocks):
            row = v - start
            spread[row] = np.nan
            first, last, residual, n, tangent, normal = fit_ball(v, radii[v], order, surface, work)
            if last > 0:
                monge.write_principal_frame(row, work.coefficients, radii[v], tangent, normal, frames)
                spread[row] = standard_error(residual, n, first, last, work) / radii[v] ** 2
            else:
                monge.write_no_frame(row, normal, frames)
