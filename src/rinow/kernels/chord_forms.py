"""Squared normal curvatures around a vertex, from what their chords do to the defects of its neighbours.

A chord of length c on the normal curvature κ is short by κ²c³/24.  On a surface κ² = (k1 cos² + k2 sin²)² of the
direction θ, a combination of 1, cos 2θ, sin 2θ, cos 4θ and sin 4θ: five numbers, called a form here.  All forms are
seen in a frame of their vertex: angles are developed, and 0 at its first neighbour.
"""

import math

import numpy as np

from rinow.kernels._jit import inner, parallel_kernel, prange
from rinow.kernels.development import end_beside, fan_angle, is_member, lay_out_fan
from rinow.kernels.smoothing import CAPACITY, FULL_TURN, develop_ball

N_FORM, N_POLY = 5, 6
N = N_FORM + N_POLY
FEWEST = N + 3
"""Data below which nothing is fitted."""
PIVOT = 1e-10
"""A column depends on earlier ones when this share of its square is left: rounding of squares."""


@inner
def harmonics(x, y, row):
    """Write 1, cos 2θ, sin 2θ, cos 4θ, sin 4θ of the direction (x, y), which is not 0."""
    square = x * x + y * y
    cos, sin = (x * x - y * y) / square, 2.0 * x * y / square
    row[0], row[1], row[2], row[3], row[4] = 1.0, cos, sin, cos * cos - sin * sin, 2.0 * cos * sin


@inner
def turn_form(form, cos, sin, out):
    """Write the coefficients of a form in a frame turned such that its old axis has the direction (cos, sin)."""
    c, s = cos * cos - sin * sin, 2.0 * cos * sin
    out[0] = form[0]
    out[1], out[2] = c * form[1] - s * form[2], s * form[1] + c * form[2]
    c, s = c * c - s * s, 2.0 * c * s
    out[3], out[4] = c * form[3] - s * form[4], s * form[3] + c * form[4]


@inner
def add_edge(derivative, length, x, y, row, out):
    """Add the change of defect over area when the edge of direction (x, y) is longer by c³/24 times each harmonic."""
    if x != 0.0 or y != 0.0:
        harmonics(x, y, row)
        for i in range(N_FORM):
            out[i] += derivative * length * length * length / 24.0 * row[i]


@parallel_kernel
def chord_terms(curvatures, areas, metric, n_blocks, terms):
    """Write the derivatives of defect over area in the five coefficients of the form, 0 without data.

    The derivative of an angle is 1/height in the opposite side and -cot(far angle)/length in a side at it; that of an
    area is length cot(opposite angle)/2.
    """
    n = curvatures.shape[0]
    for block in prange(n_blocks):
        members, slots = np.empty(CAPACITY, np.int64), np.zeros(n, np.int32)
        points, row = np.empty((CAPACITY, 2)), np.empty(N_FORM)
        for v in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            terms[v] = 0.0
            if areas[v] == 0.0:
                continue
            k = lay_out_fan(v, FULL_TURN / fan_angle(v, metric), metric, members, slots, points)
            for i in range(metric.offsets[v], metric.offsets[v + 1]):
                add_corner(metric.corners[i], curvatures[v], areas[v], k, metric, members, slots, points, row, terms[v])


@inner
def add_corner(c, curvature, area, n, metric, members, slots, points, row, out):
    """Add the terms of one face of the star laid out in `points`."""
    f, k = c // 3, c % 3
    j, l = (k + 1) % 3, (k + 2) % 3
    p, q = metric.faces[f, j], metric.faces[f, l]
    opposite, to_q, to_p = metric.lengths[f, k], metric.lengths[f, j], metric.lengths[f, l]
    angle, cot_p, cot_q = metric.angles[f, k], 1.0 / math.tan(metric.angles[f, j]), 1.0 / math.tan(metric.angles[f, l])
    height = to_p * to_q * math.sin(angle) / opposite
    if not height > 0.0 or not is_member(p, n, members, slots) or not is_member(q, n, members, slots):
        return
    px, py = points[slots[p], 0], points[slots[p], 1]
    qx, qy = points[slots[q], 0], points[slots[q], 1]
    share = curvature / 6.0  # a third of the area is the vertex's, and half of that the derivative
    add_edge((-1.0 / height - share * opposite / math.tan(angle)) / area, opposite, qx - px, qy - py, row, out)
    add_edge((cot_p / to_p - share * to_p * cot_q) / area, to_p, px, py, row, out)
    add_edge((cot_q / to_q - share * to_q * cot_p) / area, to_q, qx, qy, row, out)


@parallel_kernel
def fit_forms(radii, curvatures, areas, terms, is_fan, metric, n_blocks, forms, smooth):
    """Write the form at each vertex that leaves the curvatures around it smoothest, and the smooth curvature there.

    Defects over areas in a ball are fitted by a quadratic polynomial minus the effect of one form, both by least
    squares.  Where the effect is as smooth as a polynomial, as on regular meshes, the form is not determined: it is
    kept small by the ridge σ²/⟨x²⟩, σ² the variance of the residuals and ⟨x²⟩ the mean square of the curvatures, which
    is the Bayesian estimate for forms of that size.
    """
    n = radii.shape[0]
    for block in prange(n_blocks):
        members, slots = np.empty(CAPACITY, np.int64), np.zeros(n, np.int32)
        points, counts = np.empty((CAPACITY, 2)), np.empty(CAPACITY, np.int64)
        gram, factor, row = np.empty((N + 1, N + 1)), np.empty((N + 1, N + 1)), np.empty(N + 1)
        for v in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            forms[v], smooth[v] = 0.0, 0.0
            if not is_fan[v]:
                continue
            k = develop_ball(v, radii[v], areas[v] > 0.0, metric, members, slots, points, counts)
            count = normal_equations(k, radii[v], curvatures, areas, terms, metric, members, slots, points, row, gram)
            if count < FEWEST or not gram[N, N] > 0.0:
                continue
            factor[:] = gram
            rank = eliminate(factor)
            ridge = factor[N, N] / max(count - rank, 1) / gram[N, N] * gram[0, 0]
            for i in range(N_POLY, N):
                gram[i, i] += ridge
            eliminate(gram)
            substitute(gram, row)
            smooth[v] = row[0]
            forms[v] = row[N_POLY:N]


@inner
def normal_equations(n, radius, curvatures, areas, terms, metric, members, slots, points, row, gram):
    """Write the upper triangle of the sums of products of unknowns and data, weighted; the number of data."""
    gram[:] = 0.0
    count = 0
    for m in range(n):
        w = members[m]
        x, y = points[m, 0] / radius, points[m, 1] / radius
        weight = areas[w] * (1.0 - x * x - y * y)
        if not weight > 0.0:
            continue
        cos, sin = first_direction(m, n, metric, members, slots, points)
        if cos == 0.0 and sin == 0.0:
            continue
        row[0], row[1], row[2], row[3], row[4], row[5] = 1.0, x, y, x * x, x * y, y * y
        turn_form(terms[w], cos, sin, row[N_POLY:N])
        for i in range(N_POLY, N):
            row[i] = -row[i]
        row[N] = curvatures[w]
        count += 1
        for i in range(N + 1):
            for j in range(i, N + 1):
                gram[i, j] += weight * row[i] * row[j]
    return count


@inner
def first_direction(m, n, metric, members, slots, points):
    """Direction from member m to its first neighbour, the axis of its frame; 0 if that is no member."""
    if m == 0:
        return 1.0, 0.0
    w = members[m]
    first, _ = end_beside(metric.corners[metric.offsets[w]], 1, metric.faces)
    if not is_member(first, n, members, slots):
        return 0.0, 0.0
    x, y = points[slots[first], 0] - points[m, 0], points[slots[first], 1] - points[m, 1]
    length = math.sqrt(x * x + y * y)
    return (x / length, y / length) if length > 0.0 else (0.0, 0.0)


@inner
def eliminate(a):
    """Replace the upper triangle by its Cholesky factor, without rows of dependent unknowns; the number of others.

    The last row and column belong to the data: what is left of its diagonal is the sum of squared residuals.
    """
    rank = 0
    for i in range(N):
        before = a[i, i]
        for h in range(i):
            before += a[h, i] * a[h, i]
        if not a[i, i] > PIVOT * before:
            a[i] = 0.0
            continue
        rank += 1
        d = math.sqrt(a[i, i])
        for j in range(i, N + 1):
            a[i, j] /= d
        for j in range(i + 1, N + 1):
            for h in range(j, N + 1):
                a[j, h] -= a[i, j] * a[i, h]
    return rank


@inner
def substitute(factor, solution):
    """Write the unknowns of an eliminated system, 0 for dependent ones."""
    for i in range(N - 1, -1, -1):
        solution[i] = 0.0
        if factor[i, i] > 0.0:
            total = factor[i, N]
            for j in range(i + 1, N):
                total -= factor[i, j] * solution[j]
            solution[i] = total / factor[i, i]
