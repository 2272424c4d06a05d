"""Defects and areas of the curved triangles whose chords are the edges of a mesh."""

import math

import numpy as np

from rinow.kernels._jit import inner, parallel_kernel, prange
from rinow.kernels.chord_forms import N_FORM, harmonics
from rinow.kernels.development import end_beside, fan_angle, is_member, lay_out_fan
from rinow.kernels.smoothing import CAPACITY, FULL_TURN
from rinow.kernels.triangles import triangle_angle, triangle_area


@parallel_kernel
def squared_bends(forms, is_closed, metric, n_blocks, bends):
    """Write κ² at the vertex of each corner along the edges to the next and to the previous corner; 0 at least."""
    n = forms.shape[0]
    for block in prange(n_blocks):
        members, slots = np.empty(CAPACITY, np.int64), np.zeros(n, np.int32)
        points, row = np.empty((CAPACITY, 2)), np.empty(N_FORM)
        for v in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            if metric.offsets[v] == metric.offsets[v + 1]:
                continue
            total = fan_angle(v, metric)
            stretch = FULL_TURN / total if is_closed[v] and total > 0.0 else 1.0
            k = lay_out_fan(v, stretch, metric, members, slots, points)
            for i in range(metric.offsets[v], metric.offsets[v + 1]):
                c = metric.corners[i]
                for side in range(2):
                    w, _ = end_beside(c, side, metric.faces)
                    bends[c, side] = 0.0
                    if is_member(w, k, members, slots):
                        bends[c, side] = along(forms[v], points[slots[w]], row)


@inner
def along(form, point, row):
    """The form in the direction of a point, 0 at least."""
    if point[0] == 0.0 and point[1] == 0.0:
        return 0.0
    harmonics(point[0], point[1], row)
    total = 0.0
    for i in range(N_FORM):
        total += form[i] * row[i]
    return max(total, 0.0)


@inner
def arc(f, k, bends, shares, metric):
    """Length of the arc over the side opposite corner k of face f: c + κ²c³/24, κ² the mean at its ends."""
    p, q = 3 * f + (k + 1) % 3, 3 * f + (k + 2) % 3
    square = shares[metric.faces[f, (k + 1) % 3]] * bends[p, 0] + shares[metric.faces[f, (k + 2) % 3]] * bends[q, 1]
    c = metric.lengths[f, k]
    return c + square * c * c * c / 48.0


@parallel_kernel
def arc_curvatures(areas, bends, shares, smooth, metric, curvatures):
    """Write defect over area of the triangles with arcs for sides, 0 without data.

    By the next term of Legendre's theorem the angle of a triangle with sides a, b, c and curvature K exceeds that of
    the flat one, opposite a, by K area/3 (1 + K (a² + 7b² + 7c²)/120): that is the area a defect has to be divided by.
    Shares of the corrections, for lengths and areas, are given vertex by vertex.
    """
    for v in prange(areas.shape[0]):
        curvatures[v] = 0.0
        if areas[v] == 0.0:
            continue
        defect, area = FULL_TURN, 0.0
        for i in range(metric.offsets[v], metric.offsets[v + 1]):
            f, k = metric.corners[i] // 3, metric.corners[i] % 3
            a = arc(f, k, bends, shares, metric)
            b = arc(f, (k + 1) % 3, bends, shares, metric)
            c = arc(f, (k + 2) % 3, bends, shares, metric)
            defect -= triangle_angle(a, b, c)
            excess = shares[v] * smooth[v] * (a * a + 7.0 * (b * b + c * c)) / 120.0
            area += triangle_area(a, b, c) / 3.0 * (1.0 + excess)
        curvatures[v] = defect / area if area > 0.0 and math.isfinite(defect) else 0.0


@parallel_kernel
def hat_means(curvatures, areas, metric, out):
    """Write the mean of curvatures, linear on each face, that the defect of each vertex has; 0 without data.

    A point of curvature in a triangle raises the angle at a corner by its barycentric coordinate there.
    """
    for v in prange(areas.shape[0]):
        out[v] = 0.0
        if areas[v] == 0.0:
            continue
        total = area = 0.0
        for i in range(metric.offsets[v], metric.offsets[v + 1]):
            f, k = metric.corners[i] // 3, metric.corners[i] % 3
            share = metric.lengths[f, (k + 1) % 3] * metric.lengths[f, (k + 2) % 3] * math.sin(metric.angles[f, k])
            p, q = metric.faces[f, (k + 1) % 3], metric.faces[f, (k + 2) % 3]
            total += share * (0.5 * curvatures[v] + 0.25 * (curvatures[p] + curvatures[q]))
            area += share
        out[v] = total / area
