"""Comparison angles of four points in S_k: the bounds they set to the curvature of a finite metric space.

All lengths may be off by the share `rtol`; each angle is bounded for the worst of these errors.  Every comparison is
monotone in k, so that one quadruple sets one bound, and a scan over all of them needs few roots.
"""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.spaceform import angle
from rinow.kernels.triangles import excess
from rinow.tolerances import LINEAR_TRIPLE

FULL_TURN = 2.0 * math.pi


@kernel
def linear_angle(a, b, c):
    """Angle opposite a if it is the same in every S_k: π or 0 in a linear triple, π/2 at a double point; else nan.

    Sides that fail the triangle inequality are not linear but wrong, and left to the bounds for errors.
    """
    if b == 0.0 or c == 0.0:
        return 0.5 * math.pi
    slack = LINEAR_TRIPLE * max(min(a, b, c), 0.01 * max(a, b, c))
    if abs(excess(b, c, a)) <= slack or abs(excess(c, a, b)) <= slack:
        return 0.0
    return math.pi if abs(excess(a, b, c)) <= slack else np.nan


@kernel
def angle_below(D, v, i, j, k, rtol):
    """Angle at v between i and j, or less: the side opposite v is shortened, the sides at v are lengthened."""
    straight = linear_angle(D[i, j], D[v, i], D[v, j])
    if not math.isnan(straight):
        return straight
    longer = 1.0 + rtol
    return angle((1.0 - rtol) * D[i, j], longer * D[v, i], longer * D[v, j], k)


@kernel
def angle_above(D, v, i, o, k, rtol):
    """Angle at v between its neighbour i and the opposite corner o of a quadrilateral, or more.

    The sides of the quadrilateral are lengthened, its diagonal from v to o is shortened.
    """
    straight = linear_angle(D[i, o], D[v, i], D[v, o])
    if not math.isnan(straight):
        return straight
    longer = 1.0 + rtol
    return angle(longer * D[i, o], longer * D[v, i], (1.0 - rtol) * D[v, o], k)


@kernel
def angles_below(D, v, k, rtol, angles):
    """Write the matrix of `angle_below` at v."""
    for i in range(D.shape[0]):
        angles[i, i] = 0.0
        for j in range(i):
            angles[i, j] = angles[j, i] = angle_below(D, v, i, j, k, rtol)


@kernel
def angles_above(D, v, k, rtol, angles):
    """Write the matrix of `angle_above` at v for the points after v."""
    for i in range(v + 1, D.shape[0]):
        for o in range(v + 1, D.shape[0]):
            angles[i, o] = angle_above(D, v, i, o, k, rtol)


@kernel
def perimeter_bound(D, v, witness):
    """Largest k with room for every triangle at v, (2π/perimeter)², inf without one; writes the triangle."""
    longest = 0.0
    for i in range(D.shape[0]):
        for j in range(i):
            perimeter = D[v, i] + D[i, j] + D[j, v]
            if perimeter > longest and i != v and j != v:
                longest = perimeter
                witness[0], witness[1], witness[2] = v, i, j
    return (FULL_TURN / longest) ** 2 if longest > 0.0 else np.inf


# ------------------------------------------------------------------ three angles around a point


@kernel
def turns(D, v, i, j, m, k, rtol):
    """Whether the angles at v between i, j and m sum to more than 2π in S_k."""
    first, second = angle_below(D, v, i, j, k, rtol), angle_below(D, v, j, m, k, rtol)
    return first + second + angle_below(D, v, m, i, k, rtol) > FULL_TURN


@kernel
def branches(D, v, i, j, m):
    """Whether two of these angles are π for every k."""
    straight = 0
    for a, b in ((i, j), (j, m), (m, i)):
        straight += linear_angle(D[a, b], D[v, a], D[v, b]) == math.pi
    return straight > 1


@kernel
def largest_turning(D, v, i, j, m, high, rtol):
    """Largest k at which the angles do not sum to more than 2π, if they do at `high`; -inf if they always do."""
    if branches(D, v, i, j, m):
        return -np.inf
    step = max(D[v, i], D[v, j], D[v, m]) ** -2
    low = high - step
    while turns(D, v, i, j, m, low, rtol):
        high, step = low, 4.0 * step
        low = high - step
    middle = 0.5 * (low + high)
    while low < middle < high:
        if turns(D, v, i, j, m, middle, rtol):
            high = middle
        else:
            low = middle
        middle = 0.5 * (low + high)
    return low


@kernel
def lower_bound(D, v, k, rtol, witness):
    """Largest curvature, at most k, that triangles at v and angles around v allow; writes the points that say so."""
    n = D.shape[0]
    room = perimeter_bound(D, v, witness)
    if k < room:
        witness[:] = -1
    sure = min(k, room / (1.0 + rtol) ** 2)  # there even the lengthened triangles have angles
    angles = np.empty((n, n))
    angles_below(D, v, sure, rtol, angles)
    for i in range(n):
        for j in range(i):
            for m in range(j):
                if angles[i, j] + angles[j, m] + angles[i, m] > FULL_TURN:
                    sure = largest_turning(D, v, i, j, m, sure, rtol)
                    witness[0], witness[1], witness[2], witness[3] = v, i, j, m
                    if sure == -np.inf:
                        return sure
                    angles_below(D, v, sure, rtol, angles)
    return sure if witness[3] >= 0 else min(k, room / (1.0 - rtol) ** 2)


@parallel_kernel
def lower_bounds(D, k, rtol, bounds, witnesses):
    """Write the lower bound at each point, and its witness: three points, four with the middle one first, or -1."""
    for v in prange(D.shape[0]):
        witnesses[v] = -1
        bounds[v] = lower_bound(D, v, k, rtol, witnesses[v])


# ------------------------------------------------------------------ two angles beside a diagonal


@kernel
def bends(D, v, i, o, j, k, rtol):
    """Whether the angle at v between i and j exceeds those on both sides of the diagonal from v to o."""
    beside = angle_above(D, v, i, o, k, rtol) + angle_above(D, v, j, o, k, rtol)
    return angle_below(D, v, i, j, k, rtol) > beside


@kernel
def smallest_bending(D, v, i, o, j, low, rtol):
    """Smallest k at which the quadrilateral v, i, o, j does not bend at both ends of v o, if it does at `low`."""
    first = max(D[v, i] + D[i, j] + D[j, v], D[o, i] + D[i, j] + D[j, o])
    second = max(D[v, i] + D[i, o] + D[o, v], D[v, j] + D[j, o] + D[o, v])
    high = (FULL_TURN / max(first, second)) ** 2
    middle = 0.5 * (low + high)
    while low < middle < high:
        if bends(D, v, i, o, j, middle, rtol) and bends(D, o, i, v, j, middle, rtol):
            low = middle
        else:
            high = middle
        middle = 0.5 * (low + high)
    return high


@kernel
def opposite_corner(below, above, i, j, m):
    """The three points, that opposite v second, in the order in which the quadrilateral bends at v; or -1."""
    if below[i, m] > above[i, j] + above[m, j]:
        return i, j, m
    if below[j, m] > above[j, i] + above[m, i]:
        return j, i, m
    if below[i, j] > above[i, m] + above[j, m]:
        return i, m, j
    return i, -1, j


@kernel
def upper_bound(D, v, k, rtol, witness):
    """Smallest curvature, at least k, that quadrilaterals of v and later points allow; writes the points in order."""
    n = D.shape[0]
    below, above = np.empty((n, n)), np.empty((n, n))
    angles_below(D, v, k, rtol, below)
    angles_above(D, v, k, rtol, above)
    for i in range(v + 3, n):
        for j in range(v + 2, i):
            for m in range(v + 1, j):
                p, o, q = opposite_corner(below, above, i, j, m)
                if o >= 0 and bends(D, o, p, v, q, k, rtol):
                    k = smallest_bending(D, v, p, o, q, k, rtol)
                    witness[0], witness[1], witness[2], witness[3] = v, p, o, q
                    angles_below(D, v, k, rtol, below)
                    angles_above(D, v, k, rtol, above)
    return k


@parallel_kernel
def upper_bounds(D, k, rtol, bounds, witnesses):
    """Write the upper bound from each point and the points after it, and its witness: corners in order, or -1."""
    n = D.shape[0]
    for row in prange(n):
        v = row // 2 if row % 2 == 0 else n - 1 - row // 2  # long and short rows in turn, for equal shares
        witnesses[v] = -1
        bounds[v] = upper_bound(D, v, k, rtol, witnesses[v])
