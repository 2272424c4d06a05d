"""Squared normal curvatures around a vertex, from what their chords do to the defects of its neighbours.

A chord of length c on the normal curvature κ is short by κ²c³/24.  On a surface κ² = (k1 cos² + k2 sin²)² of the
direction θ, a combination of 1, cos 2θ, sin 2θ, cos 4θ and sin 4θ: five numbers, called a form here.  Each
vertex has a frame of its own for them, that of its fan laid out in the plane.
"""

import math

import numpy as np

from rinow.kernels._jit import lean, parallel_kernel, prange
from rinow.kernels.development import fan_angle, is_member, lay_out_fan
from rinow.kernels.smoothing import CAPACITY, FULL_TURN, develop_ball

N_FORM, N_POLY = 5, 6
N = N_FORM + N_POLY
FEWEST = N + 3
"""Data below which nothing is fitted."""
PIVOT = 1e-10
"""A column depends on earlier ones when this share of its square is left: rounding of squares."""


@lean
def harmonics(x, y, row):
    """Write 1, cos 2θ, sin 2θ, cos 4θ, sin 4θ of the direction (x, y), which is not 0."""
    square = x * x + y * y
    cos, sin = (x * x - y * y) / square, 2.0 * x * y / square
    row[0], row[1], row[2], row[3], row[4] = 1.0, cos, sin, cos * cos - sin * sin, 2.0 * cos * sin


@lean
def turn_form(form, cos, sin, mirror, out):
    """Write a form as seen in another frame, in which its axis has the direction (cos, sin); `mirror` is 1 or -1."""
    c, s = cos * cos - sin * sin, 2.0 * cos * sin
    b, d = mirror * form[2], mirror * form[4]
    out[0] = form[0]
    out[1], out[2] = c * form[1] - s * b, s * form[1] + c * b
    c, s = c * c - s * s, 2.0 * c * s
    out[3], out[4] = c * form[3] - s * d, s * form[3] + c * d


@lean
def add_edge(derivative, length, x, y, row, out):
    """Add the change of defect over area when the edge of direction (x, y) is longer by c³/24 times each harmonic."""
    if x != 0.0 or y != 0.0:
        harmonics(x, y, row)
        for i in range(N_FORM):
            out[i] += derivative * length * length * length / 24.0 * row[i]


@parallel_kernel
def chord_terms(curvatures, areas, metric, rings, n_blocks, terms, spokes):
    """Write the derivatives of defect over area in the five coefficients of the form, 0 without data, and the frame.

    `rings` are the compressed rows of neighbours; `spokes` gets the direction of each neighbour of each vertex.

    The derivative of an angle is 1/height in the opposite side and -cot(far angle)/length in a side at it; that of an
    area is length cot(opposite angle)/2.
    """
    n, (offsets, neighbours) = curvatures.shape[0], rings
    for block in prange(n_blocks):
        members, slots = np.empty(CAPACITY, np.int64), np.zeros(n, np.int32)
        points, row = np.empty((CAPACITY, 2)), np.empty(N_FORM)
        for v in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            terms[v] = 0.0
            if areas[v] == 0.0:
                continue
            k = lay_out_fan(v, FULL_TURN / fan_angle(v, metric), metric, members, slots, points)
            for i in range(metric.offsets[v], metric.offsets[v + 1]):
                c = metric.corners[i]
                add_corner(c, curvatures[v], areas[v], k, metric, members, slots, points, row, terms[v])
            for i in range(offsets[v], offsets[v + 1]):
                w = neighbours[i]
                x, y = (points[slots[w], 0], points[slots[w], 1]) if is_member(w, k, members, slots) else (0.0, 0.0)
                length = math.sqrt(x * x + y * y)
                spokes[i, 0], spokes[i, 1] = (x / length, y / length) if length > 0.0 else (0.0, 0.0)


@lean
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
def fit_forms(radii, curvatures, areas, terms, spokes, is_fan, metric, rings, n_blocks, forms, smooth):
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
            data = (curvatures, areas, terms, spokes)
            count = normal_equations(k, radii[v], data, rings, members, slots, points, row, gram)
            if count < FEWEST or not gram[N, N] > 0.0:
                continue
            mean_square = gram[N, N] / gram[0, 0]
            rank = eliminate(gram, 0, N_POLY)
            factor[:] = gram
            rank += eliminate(factor, N_POLY, N)
            ridge = factor[N, N] / max(count - rank, 1) / mean_square
            for i in range(N_POLY, N):
                gram[i, i] += ridge
            eliminate(gram, N_POLY, N)
            substitute(gram, row)
            smooth[v] = row[0]
            forms[v] = row[N_POLY:N]


@lean
def normal_equations(n, radius, data, rings, members, slots, points, row, gram):
    """Write the upper triangle of the sums of products of unknowns and data, weighted; the number of data."""
    curvatures, areas, terms, spokes = data
    gram[:] = 0.0
    count = 0
    for m in range(n):
        w = members[m]
        x, y = points[m, 0] / radius, points[m, 1] / radius
        weight = areas[w] * (1.0 - x * x - y * y)
        if not weight > 0.0:
            continue
        cos, sin, mirror = axis_of(m, n, spokes, rings, members, slots, points)
        if mirror == 0.0:
            continue
        row[0], row[1], row[2], row[3], row[4], row[5] = 1.0, x, y, x * x, x * y, y * y
        turn_form(terms[w], cos, sin, mirror, row[N_POLY:N])
        for i in range(N_POLY, N):
            row[i] = -row[i]
        row[N] = curvatures[w]
        count += 1
        for i in range(N + 1):
            for j in range(i, N + 1):
                gram[i, j] += weight * row[i] * row[j]
    return count


@lean
def axis_of(m, n, spokes, rings, members, slots, points):
    """Direction of the axis of the frame of member m, 1 or -1 if mirrored; 0 if none of its neighbours is a member.

    It is the turn that brings the spokes of its frame nearest to their places in the plane, by least squares.
    """
    if m == 0:
        return 1.0, 0.0, 1.0
    x = y = mirrored_x = mirrored_y = 0.0
    w, (offsets, neighbours) = members[m], rings
    for i in range(offsets[w], offsets[w + 1]):
        q = neighbours[i]
        if is_member(q, n, members, slots):
            dx, dy = points[slots[q], 0] - points[m, 0], points[slots[q], 1] - points[m, 1]
            a, b = dx * spokes[i, 0], dy * spokes[i, 1]
            p, r = dy * spokes[i, 0], dx * spokes[i, 1]
            x, y = x + a + b, y + p - r
            mirrored_x, mirrored_y = mirrored_x + a - b, mirrored_y + p + r
    mirror = 1.0
    if mirrored_x * mirrored_x + mirrored_y * mirrored_y > x * x + y * y:
        x, y, mirror = mirrored_x, mirrored_y, -1.0
    length = math.sqrt(x * x + y * y)
    return (x / length, y / length, mirror) if length > 0.0 else (0.0, 0.0, 0.0)


@lean
def eliminate(a, first, last):
    """Turn rows of the upper triangle into rows of its Cholesky factor, 0 for dependent unknowns; how many are not.

    The last row and column belong to the data: what is left of its diagonal is the sum of squared residuals.
    """
    rank = 0
    for i in range(first, last):
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


@lean
def substitute(factor, solution):
    """Write the unknowns of an eliminated system, 0 for dependent ones."""
    for i in range(N - 1, -1, -1):
        solution[i] = 0.0
        if factor[i, i] > 0.0:
            total = factor[i, N]
            for j in range(i + 1, N):
                total -= factor[i, j] * solution[j]
            solution[i] = total / factor[i, i]
