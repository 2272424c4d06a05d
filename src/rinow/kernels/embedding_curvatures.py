"""All k for which a quadruple embeds isometrically in S_k.

No k above k_max = (2π/P)², P the largest perimeter of a triple, admits its triples.  In w, where k = k_max - w² and
w >= 0, the equations are smooth up to that end and almost linear towards k = -inf.
"""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.comparison_angles import balance, condition
from rinow.kernels.quadruples import (
    BRANCHING,
    COINCIDENT,
    GENERIC,
    LINEAR,
    NOT_A_METRIC,
    PAIR,
    PSEUDOLINEAR,
    other_three,
    other_two,
    read_quadruple,
)
from rinow.tolerances import LINEAR_TRIPLE

NO_VALUE, IS_NONPLANAR, IS_PLANAR, IS_SEMIDEPENDENT, IS_BOUNDARY = range(5)
"""Kinds of values."""
CONTINUUM, INVALID = -1, -2
"""Counts of values that are not numbers of values."""
MAX_STEPS = 200
SMALL_STEP = 1e-8
"""Newton's method is done after a step this small: what is left has the size of its square."""


@kernel
def root(v, o, k_max, low, w, G):
    """The zero of `balance` in k below k_max - low², by Newton's method in w from the start w >= low; nan if none.

    There is one if the balance is negative at its upper end, which is tested for low = 0 when a step leads there.
    """
    high, last = np.inf, np.inf
    tested = low > 0.0
    for _ in range(MAX_STEPS):
        k = k_max - w * w
        value, slope = balance(v, o, k, G)
        step = 0.5 * value / (slope * w) if slope != 0.0 else np.nan
        if abs(step) <= SMALL_STEP * max(1.0, w):
            return k - value / slope
        if value < 0.0:
            low, tested = w, True
        else:
            high = w
        new = w + step
        if not tested and not new > 0.0:
            if not balance(v, o, k_max, G)[0] < 0.0:
                return np.nan
            tested = True
        if high == np.inf:
            new = new if low < new < 3.0 * w + 1.0 else 3.0 * w + 1.0
        elif not low < new < high or abs(step) > 0.5 * last:
            new = 0.5 * (low + high)
        w, last = new, abs(new - w)
    return np.nan


@kernel
def innermost_point(G):
    """The point with the largest sum of Euclidean angles, judged by the products of their half cotangents."""
    least, innermost = np.inf, 0
    for v in range(4):
        i, j, m = other_three(v)
        a = G[i, i] * G[i, v] / (G[i, j] * G[i, m])
        b = G[j, j] * G[j, v] / (G[j, i] * G[j, m])
        c = G[m, m] * G[m, v] / (G[m, i] * G[m, j])
        products = math.sqrt(a * b) + math.sqrt(b * c) + math.sqrt(c * a)
        if products < least:
            least, innermost = products, v
    return innermost


@kernel
def planar_curvature(v, k_max, G):
    """The k at which the angles at some point sum to 2π, and that point; v is tried first.

    It is k_max if they sum to less everywhere, up to rounding: then a triple is a great circle, or two are a lune.
    """
    k = root(v, -1, k_max, 0.0, math.sqrt(k_max), G)
    if np.isnan(k):
        least = 0.0
        for u in range(4):
            shortfall = balance(u, -1, k_max, G)[0]
            if shortfall < least:
                least, v = shortfall, u
        k = root(v, -1, k_max, 0.0, math.sqrt(k_max), G) if least < 0.0 else k_max
    return (k if k_max - k > LINEAR_TRIPLE * k_max else k_max), v


@kernel
def opposite_corner(v, d):
    """The point o for which d_vo plus the distance of the two others is largest, and by what share of that sum."""
    first, second, opposite = 0.0, 0.0, -1
    for o in range(4):
        if o != v:
            i, j = other_two(v, o)
            total = d[PAIR[v, o]] + d[PAIR[i, j]]
            if total > first:
                first, second, opposite = total, first, o
            else:
                second = max(second, total)
    return opposite, (first - second) / first


@kernel
def nonplanar_curvature(v, d, k_max, k, G):
    """The smaller embedding curvature of a quadruple without linear triple, k being the larger; two opposite corners.

    It is nan if the two largest sums of opposite sides are equal, as in a tree: then `across` tends to 0 from below as
    k -> -inf, because the ratio of the angles at the two ends of the middle branch tends to 1 faster than the
    third angle to 0.
    """
    o, gap = opposite_corner(v, d)
    if gap <= LINEAR_TRIPLE:
        return np.nan, v, o
    if k < k_max:
        low = math.sqrt(k_max - k)
        return min(root(v, o, k_max, low, low, G), k), v, o
    least = np.inf
    for u in range(4):
        corner = opposite_corner(u, d)[0]
        excess = balance(u, corner, k_max, G)[0]
        if excess < least:
            least, v, o = excess, u, corner
    return root(v, o, k_max, 0.0, math.sqrt(k_max), G), v, o


@kernel
def embedding_curvatures(d, G, values, kinds, conditions):
    """Write the values of a quadruple with their kinds and conditions; return their count, CONTINUUM or INVALID."""
    values[:], kinds[:], conditions[:] = np.nan, NO_VALUE, np.nan
    scale, relation, v = read_quadruple(d, G)
    if relation == NOT_A_METRIC:
        return INVALID
    if relation == BRANCHING:
        return 0
    if relation == COINCIDENT or relation == LINEAR:
        return CONTINUUM
    k_max = (math.pi / max(G[0, 0], G[1, 1], G[2, 2], G[3, 3])) ** 2
    k, count = k_max, 0
    if relation != PSEUDOLINEAR:
        k, v = planar_curvature(innermost_point(G) if relation == GENERIC else v, k_max, G)
    if relation == GENERIC:
        smaller, u, o = nonplanar_curvature(v, d, k_max, k, G)
        if not np.isnan(smaller):
            values[0], kinds[0], conditions[0] = smaller, IS_NONPLANAR, condition(u, o, smaller, G)
            count = 1
    kind = IS_PLANAR if relation == GENERIC else IS_SEMIDEPENDENT
    values[count], kinds[count] = k, kind if k < k_max else IS_BOUNDARY
    conditions[count] = condition(v, -1, k, G) if k < k_max else k_max * math.sqrt(k_max) / math.pi  # of (2π/P)²
    values *= scale * scale
    conditions *= (scale * d.max()) ** 3
    return count + 1


@parallel_kernel
def all_embedding_curvatures(quadruples, values, counts, kinds, conditions):
    """Write the values, counts, kinds and conditions of each quadruple."""
    for row in prange(quadruples.shape[0]):
        G = np.empty((4, 4))
        counts[row] = embedding_curvatures(quadruples[row], G, values[row], kinds[row], conditions[row])
