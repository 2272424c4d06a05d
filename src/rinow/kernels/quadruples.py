"""Metric quadruples: which triples are linear, and how they fit together.

The points are 0, 1, 2, 3; a quadruple is the row d01, d02, d03, d12, d13, d23 of its distances.
"""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.triangles import excess
from rinow.tolerances import LINEAR_TRIPLE, METRIC_TRIANGLE_INEQUALITY

PAIR = np.array([[-1, 0, 1, 2], [0, -1, 3, 4], [1, 3, -1, 5], [2, 4, 5, -1]])
"""Column of the distance between two points."""

NOT_A_METRIC, GENERIC, SEMIDEPENDENT, BRANCHING, PSEUDOLINEAR, COINCIDENT, LINEAR = range(7)
"""How the linear triples fit together.

SEMIDEPENDENT: one or two with different middles.  BRANCHING: two with one middle.  PSEUDOLINEAR: all four, each with
its own middle, as on a circle.  COINCIDENT: two points at distance 0.  LINEAR: all four, as on a line.
"""


@kernel
def other_two(p, q):
    """The two points that are neither p nor q, ascending."""
    i = 0
    while i == p or i == q:
        i += 1
    return i, 6 - p - q - i


@kernel
def other_three(v):
    """The three points that are not v, ascending."""
    i = 0 if v > 0 else 1
    j = i + 1 if v != i + 1 else i + 2
    return i, j, 6 - v - i - j


@kernel
def gromov_products(d, scale, G):
    """Write the Gromov products of the triples of scale·d; whether they satisfy the triangle inequality.

    G[t, v] is the product (d_vi + d_vj - d_ij)/2 at point v of the triple without point t, exactly 0 if v lies between
    i and j up to rounding; G[t, t] is half the perimeter of that triple.
    """
    slack = 0.0
    for t in range(4):
        i, j, m = other_three(t)
        a, b, c = scale * d[PAIR[j, m]], scale * d[PAIR[i, m]], scale * d[PAIR[i, j]]
        tolerance = 0.5 * LINEAR_TRIPLE * max(a, b, c, 100.0 * min(a, b, c)) / 100.0
        G[t, t] = 0.5 * (a + b + c)
        G[t, i], G[t, j], G[t, m] = 0.5 * excess(a, b, c), 0.5 * excess(b, c, a), 0.5 * excess(c, a, b)
        for v in (i, j, m):
            slack = min(slack, G[t, v])
            if G[t, v] < tolerance:
                G[t, v] = 0.0
    return 2.0 * slack >= -METRIC_TRIANGLE_INEQUALITY * scale * d.max()


@kernel
def relation(G):
    """How the linear triples fit together, and a point that lies between two others, or -1."""
    n_linear, between, distinct, middle = 0, 0, True, -1
    for t in range(4):
        zeros = 0
        for v in range(4):
            zeros += t != v and G[t, v] == 0.0
        n_linear += zeros > 0
        distinct &= zeros < 2
    for v in range(4):
        triples = 0
        for t in range(4):
            triples += t != v and G[t, v] == 0.0
        if triples > between:
            between, middle = triples, v
    if n_linear == 4:
        return (PSEUDOLINEAR if distinct and between == 1 else LINEAR), middle
    if not distinct:
        return COINCIDENT, middle
    if n_linear == 0:
        return GENERIC, middle
    return (BRANCHING if between > 1 else SEMIDEPENDENT), middle


@kernel
def power_of_two(x):
    """The power of 2 that brings x > 0 to [1/2, 1): scaling by it rounds nothing."""
    return math.ldexp(1.0, -math.frexp(x)[1])


@kernel
def read_quadruple(d, G):
    """Write the Gromov products of d scaled by a power of 2; return that scale, the relation and a middle point."""
    largest = 0.0
    for x in d:
        if not 0.0 <= x < np.inf:
            return np.nan, NOT_A_METRIC, -1
        largest = max(largest, x)
    if largest == 0.0:
        return 1.0, LINEAR, 0
    scale = power_of_two(largest)
    if not gromov_products(d, scale, G):
        return np.nan, NOT_A_METRIC, -1
    kind, middle = relation(G)
    return scale, kind, middle


@kernel
def robinson_order(d, G, order):
    """Write points p, q, r, s with q between p and r, p < r; -1 if there are none."""
    _, kind, q = read_quadruple(d, G)
    if kind == NOT_A_METRIC or q < 0:
        order[:] = -1
        return kind
    for t in range(4):
        if t != q and G[t, q] == 0.0:
            order[1], order[3] = q, t
            order[0], order[2] = other_two(q, t)
            break
    return kind


@parallel_kernel
def relations(quadruples, kinds, orders):
    """Write how the linear triples of each quadruple fit together, and the order of a linear triple."""
    for row in prange(quadruples.shape[0]):
        G = np.empty((4, 4))
        kinds[row] = robinson_order(quadruples[row], G, orders[row])
