"""Points of S_k as rows (x, y, z) on the quadric x² + y² + k z² = 2z, smooth through the paraboloid of k = 0.

A point at distance r and direction θ from the origin is (s_k(r) cos θ, s_k(r) sin θ, 2 s_k(r/2)²).  The quadric is a
sphere for k > 0 and a sheet of a hyperboloid for k < 0, both scaled by √|k| along z and tangent to z = 0.
"""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.quadruples import PAIR, other_two
from rinow.kernels.spaceform import angle, arc, is_triangle, side, sine


@kernel
def place(r, theta, k, point):
    """Write the point at distance r and direction theta from the origin."""
    rho = sine(r, k)
    half = sine(0.5 * r, k)
    point[0], point[1], point[2] = rho * math.cos(theta), rho * math.sin(theta), 2.0 * half * half


@kernel
def distance(p, q, k):
    """Distance of two points: by chord and complementary chord for k >= 0, by polar coordinates for k < 0.

    Both sums have no negative term, so near, far and opposite points keep their digits; z is not used for k < 0,
    where it would cost some.
    """
    if k >= 0.0:
        x, y, z = p[0] - q[0], p[1] - q[1], p[2] - q[2]
        chord = math.sqrt(x * x + y * y + k * z * z)
        x, y, z = p[0] + q[0], p[1] + q[1], p[2] + q[2]
        complement = math.sqrt(k * (x * x + y * y) + (2.0 - k * z) * (2.0 - k * z))
        return 2.0 * arc(0.5 * chord, 0.5 * complement, k)
    rho, sigma = math.hypot(p[0], p[1]), math.hypot(q[0], q[1])
    radial = sine(0.5 * (arc(rho, 1.0, k) - arc(sigma, 1.0, k)), k)
    if rho == 0.0 or sigma == 0.0:
        return 2.0 * arc(abs(radial), 1.0, k)
    half_turn = 0.5 * math.hypot(p[0] / rho - q[0] / sigma, p[1] / rho - q[1] / sigma)
    return 2.0 * arc(math.hypot(radial, math.sqrt(rho) * math.sqrt(sigma) * half_turn), 1.0, k)


@parallel_kernel
def distances(p, q, k, out):
    """Write the distances of the rows of p and q."""
    for i in prange(out.shape[0]):
        out[i] = distance(p[i], q[i], k)


@kernel
def place_quadruple(d, k, points):
    """Write four points with five of the distances d; return the error of the sixth, inf if a triple has no place.

    One point is the origin, another the direction 0, the angles there place the two others; of all such choices,
    the one with the least error is kept.
    """
    least = np.inf
    for p in range(4):
        for q in range(4):
            if p == q:
                continue
            i, j = other_two(p, q)
            pq, pi, pj, qi, qj = d[PAIR[p, q]], d[PAIR[p, i]], d[PAIR[p, j]], d[PAIR[q, i]], d[PAIR[q, j]]
            if not (is_triangle(pq, pi, qi) and is_triangle(pq, pj, qj)):
                continue
            alpha, beta = angle(qi, pq, pi, k), angle(qj, pq, pj, k)
            for turn in (beta, -beta):
                error = abs(side(pi, pj, abs(alpha - turn), k) - d[PAIR[i, j]])
                if error < least:
                    least = error
                    place(0.0, 0.0, k, points[p])
                    place(pq, 0.0, k, points[q])
                    place(pi, alpha, k, points[i])
                    place(pj, turn, k, points[j])
    return least


@parallel_kernel
def place_quadruples(d, k, rtol, out):
    """Write four points for each row of d, nan if a distance is wrong by more than rtol times the largest one."""
    for row in prange(d.shape[0]):
        if not place_quadruple(d[row], k, out[row]) <= rtol * d[row].max():
            out[row] = np.nan
