"""Quadrics fitted to the circles through a vertex and the vertices of its two rings.

The circle that touches the tangent plane at p and runs through a neighbour at distance d and height z has the
curvature 2 z / d^2.  The fit gives each of these curvatures the same weight, so each height the weight 1/d^4.
"""

import math

import numpy as np

from rinow.kernels import monge, stencils
from rinow.kernels._jit import lean, parallel_kernel, prange
from rinow.kernels.stencils import QUADRIC_POINTS, SOFTENING

PIVOT = 1e-6
"""A term depends on the earlier ones when this share of its norm is left.  Where all points lie near two lines the
product x y is barely determined, but neither the normal nor the mean curvature need it."""


@lean
def quadric_moments(points, n):
    """Weighted sums over the points: products of degree 2, 3, 4, and the height times products of degree 1 and 2."""
    xx = xy = yy = xxx = xxy = xyy = yyy = x4 = x3y = x2y2 = xy3 = y4 = 0.0
    zx = zy = zxx = zxy = zyy = 0.0
    for i in range(n):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        d2 = x * x + y * y + z * z + SOFTENING
        w = 1.0 / (d2 * d2)
        a, b, c = w * x * x, w * x * y, w * y * y
        xx, xy, yy = xx + a, xy + b, yy + c
        xxx, xxy, xyy, yyy = xxx + a * x, xxy + b * x, xyy + b * y, yyy + c * y
        x4, x3y, x2y2, xy3, y4 = x4 + a * x * x, x3y + a * x * y, x2y2 + b * x * y, xy3 + c * x * y, y4 + c * y * y
        zx, zy, zxx, zxy, zyy = zx + w * z * x, zy + w * z * y, zxx + a * z, zxy + b * z, zyy + c * z
    return (xx, xy, yy), (xxx, xxy, xyy, yyy), (x4, x3y, x2y2, xy3, y4), (zx, zy), (zxx, zxy, zyy)


@lean
def solve_three(a, b, c, d, e, f, x, y, z):
    """Solution of the symmetric system ((a, b, c), (b, d, e), (c, e, f)) and its last pivots; 0 if one is not > 0."""
    if not a > 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    l1, l2 = b / a, c / a
    p, q = d - l1 * b, e - l1 * c
    if not p > 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    l3 = q / p
    r = f - l2 * c - l3 * q
    if not r > 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    y -= l1 * x
    w = (z - l2 * x - l3 * y) / r
    v = y / p - l3 * w
    return x / a - l1 * v - l2 * w, v, w, p, r


@lean
def solve_quadric(moments, tilted, coefficients):
    """Write c of z = c0 x + c1 y + c2 x^2 + c3 x y + c4 y^2, the slopes eliminated first; whether it is determined.

    Without `tilted` the slopes are 0: Euler's formula in the given tangent plane.
    """
    (xx, xy, yy), t, q, (zx, zy), g = moments
    det = xx * yy - xy * xy
    if tilted and not det > PIVOT * xx * yy:
        return False
    ia, ib, ic = (yy / det, -xy / det, xx / det) if tilted else (0.0, 0.0, 0.0)
    a0, a1, a2 = ia * t[0] + ib * t[1], ia * t[1] + ib * t[2], ia * t[2] + ib * t[3]
    b0, b1, b2 = ib * t[0] + ic * t[1], ib * t[1] + ic * t[2], ib * t[2] + ic * t[3]
    s00, s11, s22 = q[0] - a0 * t[0] - b0 * t[1], q[2] - a1 * t[1] - b1 * t[2], q[4] - a2 * t[2] - b2 * t[3]
    s01, s02, s12 = q[1] - a0 * t[1] - b0 * t[2], q[2] - a0 * t[2] - b0 * t[3], q[3] - a1 * t[2] - b1 * t[3]
    g0, g1, g2 = g[0] - a0 * zx - b0 * zy, g[1] - a1 * zx - b1 * zy, g[2] - a2 * zx - b2 * zy
    c2, c3, c4, p1, p2 = solve_three(s00, s01, s02, s11, s12, s22, g0, g1, g2)
    if not (s00 > PIVOT * q[0] and p1 > PIVOT * q[2] and p2 > PIVOT * q[4]):
        return False
    zx, zy = zx - c2 * t[0] - c3 * t[1] - c4 * t[2], zy - c2 * t[1] - c3 * t[2] - c4 * t[3]
    coefficients[0], coefficients[1] = ia * zx + ib * zy, ib * zx + ic * zy
    coefficients[2], coefficients[3], coefficients[4] = c2, c3, c4
    return True


@lean
def fit_quadric(points, n, coefficients):
    """Fit a quadric, or Euler's formula where points are too few or too much in line; whether either is determined."""
    if n < QUADRIC_POINTS:
        stencils.stretch_to_chords(points, n)
    moments = quadric_moments(points, n)
    if n >= QUADRIC_POINTS and solve_quadric(moments, True, coefficients):
        return True
    return n >= 3 and solve_quadric(moments, False, coefficients)


@parallel_kernel
def ring_quadrics(rows, surface, is_small, n_blocks, frames):
    """Write principal frames of quadrics fitted to two rings of rows[i]; nan, and the given normal, without one.

    On a small surface the rings may reach around it: there, what faces away is left out.
    """
    n_vertices, n = surface.vertices.shape[0], len(rows)
    for block in prange(n_blocks):
        members, marks = np.empty(n_vertices + 1, np.int32), np.zeros(n_vertices, np.int32)
        points, coefficients = np.empty((n_vertices, 3)), np.empty(5)
        for row in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            v = rows[row]
            size, reach = stencils.rings(v, 2, surface, members, marks)
            normal, unit = stencils.normal_at(v, surface), math.sqrt(reach)
            if is_small:
                size = stencils.facing(members, size, normal, surface)
            fitted, tangent = False, normal
            if unit > 0.0 and normal != (0.0, 0.0, 0.0):
                tangent = stencils.local_coordinates(members, size, unit, normal, surface.vertices, points)
                fitted = fit_quadric(points, size - 1, coefficients)
            if fitted:
                monge.write_principal_frame(row, coefficients, unit, tangent, normal, frames)
            else:
                monge.write_no_frame(row, normal, frames)
