"""The closed star of a vertex: the triangles around it, known by their side lengths."""

import math

import numpy as np

from rinow.kernels._jit import lean, parallel_kernel, prange
from rinow.kernels.spaceform import angle_and_derivative, is_triangle
from rinow.kernels.triangles import triangle_area
from rinow.tolerances import DEGENERATE_AREA

FULL_TURN = 2.0 * math.pi
END_TOLERANCE = 1e-7
"""Angle that may be missing at the largest curvature a star allows; angles there vary like a square root."""
MAX_DOUBLINGS = 40
"""The bracket of a negative curvature reaches to -4^40 over the squared perimeter; below that is rounding."""
MAX_STEPS = 100
CLOSE = 4e-15
"""Last step of the iteration over the largest curvature the star allows: about the rounding of its angles."""


@lean
def star_angle(sides, k):
    """Sum of the comparison angles in S_k at the centre, and its derivative in k."""
    total = slope = 0.0
    for i in range(sides.shape[0]):
        alpha, derivative = angle_and_derivative(sides[i, 0], sides[i, 1], sides[i, 2], k)
        total += alpha
        slope += derivative
    return total, slope


@lean
def negative_bound(sides, unit):
    """A curvature at which the angles sum to less than 2 pi, of -unit, -4 unit, ...; nan without one."""
    low = -unit
    for _ in range(MAX_DOUBLINGS):
        if star_angle(sides, low)[0] < FULL_TURN:
            return low
        low *= 4.0
    return np.nan


@lean
def star_curvature(sides):
    """The k at which the angles of the star in S_k sum to 2 pi, by Newton's method kept in a bracket; nan without one.

    Row i of `sides` holds the side opposite the centre and the two sides at it of triangle i.  The sum of the angles
    increases with k, as far as (2 pi / P)^2, P the largest perimeter, where one triangle is a great circle.
    """
    perimeter = 0.0
    for i in range(sides.shape[0]):
        perimeter = max(perimeter, sides[i, 0] + sides[i, 1] + sides[i, 2])
    if not 0.0 < perimeter < np.inf:
        return np.nan
    limit = (FULL_TURN / perimeter) ** 2
    k, low, high = 0.0, 0.0, limit
    total, slope = star_angle(sides, k)
    if total > FULL_TURN:
        low, high = negative_bound(sides, 1.0 / perimeter**2), 0.0
    for _ in range(MAX_STEPS):
        step = (FULL_TURN - total) / slope if slope > 0.0 else np.inf
        if not low < k + step < high:
            step = 0.5 * (low + high) - k
        k += step
        if not abs(step) > CLOSE * max(abs(k), limit):
            break
        total, slope = star_angle(sides, k)
        if total < FULL_TURN:
            low = k
        else:
            high = k
    if limit - k <= CLOSE * limit and star_angle(sides, limit)[0] < FULL_TURN - END_TOLERANCE:
        return np.nan
    return k


@parallel_kernel
def closed_star_curvatures(radii, chords, out):
    """Write the curvature of each row, chord i joining the ends of radii i and i + 1; nan for a row that is no star."""
    n = radii.shape[1]
    for row in prange(out.shape[0]):
        sides = np.empty((n, 3))
        is_star = True
        for i in range(n):
            sides[i, 0], sides[i, 1], sides[i, 2] = chords[row, i], radii[row, i], radii[row, (i + 1) % n]
            is_star &= is_triangle(sides[i, 0], sides[i, 1], sides[i, 2])
        out[row] = star_curvature(sides) if is_star else np.nan


@parallel_kernel
def vertex_star_curvatures(edge_lengths, offsets, corners, is_closed, n_blocks, out):
    """Write the embedding curvature of the star of each vertex, nan where it is not closed."""
    n = offsets.shape[0] - 1
    degree = 0
    for v in range(n):
        degree = max(degree, offsets[v + 1] - offsets[v])
    for block in prange(n_blocks):
        sides = np.empty((degree, 3))
        for v in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            out[v] = np.nan
            if is_closed[v]:
                for i in range(offsets[v], offsets[v + 1]):
                    f, k = corners[i] // 3, corners[i] % 3
                    for j in range(3):
                        sides[i - offsets[v], j] = edge_lengths[f, (k + j) % 3]
                out[v] = star_curvature(sides[: offsets[v + 1] - offsets[v]])


@parallel_kernel
def proper_stars(edge_lengths, offsets, corners, out):
    """Write whether some face at each vertex is not degenerate."""
    for v in prange(offsets.shape[0] - 1):
        out[v] = False
        for i in range(offsets[v], offsets[v + 1]):
            f = corners[i] // 3
            a, b, c = edge_lengths[f, 0], edge_lengths[f, 1], edge_lengths[f, 2]
            if triangle_area(a, b, c) > DEGENERATE_AREA * max(a, b, c) ** 2:
                out[v] = True
                break


@parallel_kernel
def longest_edges(edge_lengths, offsets, corners, out):
    """Write the longest edge at each vertex; nan without a face."""
    for v in prange(offsets.shape[0] - 1):
        longest = -1.0
        for i in range(offsets[v], offsets[v + 1]):
            f, k = corners[i] // 3, corners[i] % 3
            longest = max(longest, edge_lengths[f, (k + 1) % 3], edge_lengths[f, (k + 2) % 3])
        out[v] = longest if longest >= 0.0 else np.nan


@parallel_kernel
def ring_deviations(values, faces, offsets, corners, out):
    """Write the standard deviation of the finite values at each vertex and its neighbours; nan for fewer than two.

    The ring is run through twice, once for each end of the edges opposite the vertex.
    """
    for v in prange(offsets.shape[0] - 1):
        count, total, squares = 1, 0.0, 0.0  # sums of differences from the value at v
        for i in range(offsets[v], offsets[v + 1]):
            f, k = corners[i] // 3, corners[i] % 3
            for j in range(1, 3):
                difference = values[faces[f, (k + j) % 3]] - values[v]
                if math.isfinite(difference):
                    count += 1
                    total += 0.5 * difference
                    squares += 0.5 * difference * difference
        n = 0.5 * (count + 1)
        out[v] = math.sqrt(max(squares - total * total / n, 0.0) / (n - 1.0)) if count > 1 else np.nan


@parallel_kernel
def gauss_sweep(curvatures, defects, face_areas, faces, offsets, corners, is_closed, out):
    """Write curvatures corrected by what is missing in defect = sum of (2 K_i + K_j + K_k) area / 12 (Gauss, art. 28).

    Where a neighbour has no value, the vertex's own stands for it; open stars keep their value.
    """
    for v in prange(offsets.shape[0] - 1):
        out[v] = curvatures[v]
        if not is_closed[v]:
            continue
        missing, area = defects[v], 0.0
        for i in range(offsets[v], offsets[v + 1]):
            f, k = corners[i] // 3, corners[i] % 3
            p, q = curvatures[faces[f, (k + 1) % 3]], curvatures[faces[f, (k + 2) % 3]]
            p, q = p if math.isfinite(p) else curvatures[v], q if math.isfinite(q) else curvatures[v]
            missing -= (2.0 * curvatures[v] + p + q) * face_areas[f] / 12.0
            area += face_areas[f] / 3.0
        if area > 0.0:
            out[v] += missing / area
