"""Local linear regression of curvature over balls of the developed metric, as rows of a sparse matrix."""

import math

import numpy as np

from rinow.kernels._jit import kernel, lean, parallel_kernel, prange
from rinow.kernels.adjacency import previous_corner
from rinow.kernels.development import develop, fan_angle

FULL_TURN = 2.0 * math.pi
CAPACITY = 512
"""Most vertices of one development."""
ONE_SIDED = 0.2
"""No slope is taken out where the square of the distance from the centre of the data exceeds this many of their
variances: extrapolation there, repeated, would keep the noise of the boundary for ever."""
FLATTEST = 1e-3
"""Where the spread of the data across is below this share of that along, it determines no slope across."""


@lean
def weighted_moments(radius, columns, points, areas, weights):
    """Write the weights area (1 - (|u|/radius)²)³, not all 0; their sum, means and covariances."""
    total = mx = my = 0.0
    for m in range(len(columns)):
        x, y = points[m, 0], points[m, 1]
        s = 1.0 - (x * x + y * y) / (radius * radius)
        weights[m] = areas[columns[m]] * s * s * s
        total += weights[m]
        mx += weights[m] * x
        my += weights[m] * y
    mx, my = mx / total, my / total
    xx = xy = yy = 0.0
    for m in range(len(columns)):
        x, y = points[m, 0] - mx, points[m, 1] - my
        xx += weights[m] * x * x
        xy += weights[m] * x * y
        yy += weights[m] * y * y
    return total, mx, my, xx / total, xy / total, yy / total


@kernel
def slope_terms(mx, my, xx, xy, yy):
    """The vector C⁻¹ m of covariances C and means m, without the axis along which C is too small."""
    half, difference = 0.5 * (xx + yy), 0.5 * (xx - yy)
    root = math.sqrt(difference * difference + xy * xy)
    large, small = half + root, half - root
    if not large > 0.0:
        return 0.0, 0.0
    if small > FLATTEST * large:
        det = xx * yy - xy * xy
        return (yy * mx - xy * my) / det, (xx * my - xy * mx) / det
    angle = 0.5 * math.atan2(xy, difference)
    cos, sin = math.cos(angle), math.sin(angle)
    along = (cos * mx + sin * my) / large
    return along * cos, along * sin


@lean
def sees_gap(n, radius, areas, members, points):
    """Whether a member within the radius has no data."""
    for m in range(n):
        if areas[members[m]] == 0.0 and points[m, 0] ** 2 + points[m, 1] ** 2 < radius * radius:
            return True
    return False


@kernel
def develop_ball(v, radius, is_closed, metric, members, slots, points, counts):
    """`develop`, angles of a closed star scaled to 2π; 0 members without a face."""
    if metric.offsets[v + 1] == metric.offsets[v]:
        return 0
    total = fan_angle(v, metric)
    stretch = FULL_TURN / total if is_closed and total > 0.0 else 1.0
    return develop(v, radius, stretch, metric, members, slots, points, counts)


@lean
def is_inside(m, radius, areas, members, points):
    """Whether member m has data and a weight."""
    x, y = points[m, 0], points[m, 1]
    return areas[members[m]] > 0.0 and 1.0 - (x * x + y * y) / (radius * radius) > 0.0


@parallel_kernel
def count_rows(is_fan, radii, areas, is_closed, metric, n_blocks, counts_out):
    """Write the number of data with a weight around each vertex."""
    n = radii.shape[0]
    for block in prange(n_blocks):
        members, slots = np.empty(CAPACITY, np.int64), np.zeros(n, np.int32)
        points, counts = np.empty((CAPACITY, 2)), np.empty(CAPACITY, np.int64)
        for v in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            counts_out[v] = 0
            if is_fan[v]:
                k = develop_ball(v, radii[v], is_closed[v], metric, members, slots, points, counts)
                for m in range(k):
                    counts_out[v] += is_inside(m, radii[v], areas, members, points)


@parallel_kernel
def row_places(radii, areas, is_closed, metric, n_blocks, starts, columns, places, has_gap):
    """Write the data with a weight around each vertex, their places, and whether one without data is among them."""
    n = radii.shape[0]
    for block in prange(n_blocks):
        members, slots = np.empty(CAPACITY, np.int64), np.zeros(n, np.int32)
        points, counts = np.empty((CAPACITY, 2)), np.empty(CAPACITY, np.int64)
        for v in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            i, has_gap[v] = starts[v], False
            if i == starts[v + 1]:
                continue
            k = develop_ball(v, radii[v], is_closed[v], metric, members, slots, points, counts)
            has_gap[v] = sees_gap(k, radii[v], areas, members, points)
            for m in range(k):
                if is_inside(m, radii[v], areas, members, points):
                    columns[i] = members[m]
                    places[i, 0], places[i, 1] = points[m, 0], points[m, 1]
                    i += 1


@parallel_kernel
def regression_rows(radii, areas, starts, columns, places, has_gap, values, variances):
    """Write the rows: weights of the curvatures that give the local linear regression at each vertex.

    Near a boundary they fade into the local mean.  `variances` gets the mean square of the distance along an axis.
    """
    for v in prange(len(radii)):
        row = slice(starts[v], starts[v + 1])
        variances[v] = np.nan
        if starts[v] == starts[v + 1]:
            continue
        points, weights = places[row], values[row]
        total, mx, my, xx, xy, yy = weighted_moments(radii[v], columns[row], points, areas, weights)
        variances[v] = 0.5 * (xx + yy)
        gx, gy = slope_terms(mx, my, xx, xy, yy)
        if has_gap[v]:
            share = max(1.0 - (gx * mx + gy * my) / ONE_SIDED, 0.0)
            gx, gy = share * gx, share * gy
        for m in range(len(weights)):
            weights[m] *= (1.0 - gx * (points[m, 0] - mx) - gy * (points[m, 1] - my)) / total


@parallel_kernel
def apply_rows(starts, columns, values, x, out):
    """Write the product of the sparse matrix and x; nan for an empty row."""
    for v in prange(starts.shape[0] - 1):
        total = 0.0
        for i in range(starts[v], starts[v + 1]):
            total += values[i] * x[columns[i]]
        out[v] = total if starts[v + 1] > starts[v] else np.nan


@parallel_kernel
def next_wave(current, last, least, is_second, steps):
    """Write the wave after two others in the place of the steps from the current one, of eigenvalues least..1."""
    for v in prange(len(steps)):
        half = (2.0 * steps[v] - (1.0 + least) * current[v]) / (1.0 - least)
        steps[v] = half if is_second else 2.0 * half - last[v]


@parallel_kernel
def add_multiple(factor, wave, total):
    """Add a multiple of a wave to a total."""
    for v in prange(len(wave)):
        total[v] += factor * wave[v]


@parallel_kernel
def interpolate(x, places, heights):
    """Replace each number by the height of the line through points (places, heights) there, as `np.interp` does."""
    last = len(places) - 1
    for v in prange(len(x)):
        if x[v] < places[last] and x[v] > places[0]:
            j = np.searchsorted(places, x[v], "right") - 1
            slope = (heights[j + 1] - heights[j]) / (places[j + 1] - places[j])
            x[v] = slope * (x[v] - places[j]) + heights[j]
        elif not math.isnan(x[v]):
            x[v] = heights[0] if x[v] <= places[0] else heights[last]


@kernel
def column_sums(starts, columns, values, factors, out):
    """Write the sum of factor times value over each column, the factors belonging to the rows."""
    out[:] = 0.0
    for v in range(starts.shape[0] - 1):
        for i in range(starts[v], starts[v + 1]):
            out[columns[i]] += factors[v] * values[i]


@parallel_kernel
def mean_sides(metric, out):
    """Write the mean length of the edges at each vertex, 0 without any; one shared by two faces counts half in each."""
    for v in prange(metric.offsets.shape[0] - 1):
        total = count = 0.0
        for i in range(metric.offsets[v], metric.offsets[v + 1]):
            c = metric.corners[i]
            for side in range(2):
                h = c if side == 0 else previous_corner(c)
                share = 0.5 if metric.partners[h] >= 0 else 1.0
                total += share * metric.lengths[c // 3, (c % 3 + 2 - side) % 3]
                count += share
        out[v] = total / count if count > 0.0 else 0.0


@parallel_kernel
def defect_sensitivities(metric, areas, squares, densities):
    """Write for each vertex the sum of squares of the derivatives of its defect in the edge lengths, and the density.

    The derivative of an angle is 1/height in the opposite side and -cot(far angle)/length in a side at it.  The density
    is the sum over edges of ((h + h')/2)², h and h' the heights over it on both sides, per area: with the
    second derivative of a smooth function across the edge it makes the transposed derivative of a weighted sum of
    defects with these weights.
    """
    for v in prange(metric.offsets.shape[0] - 1):
        total = density = area = 0.0
        for i in range(metric.offsets[v], metric.offsets[v + 1]):
            c = metric.corners[i]
            f, k = c // 3, c % 3
            twice = 6.0 * areas[f] / 3.0
            height = twice / metric.lengths[f, k]
            total += 1.0 / (height * height)
            area += areas[f]
            for side in range(2):
                total += 0.5 * spoke_derivative(c, side, metric) ** 2
            for j in range(3):
                density += 0.5 * half_heights(3 * f + j, areas, metric) ** 2
        squares[v] = total
        densities[v] = density / area


@kernel
def spoke_derivative(c, side, metric):
    """Derivative of the defect at the vertex of corner c in the length of a side there, by both faces on it."""
    f, k = c // 3, c % 3
    far = k + 1 if side == 0 else k + 2
    length = metric.lengths[f, (k + 2 - side) % 3]
    total = 1.0 / math.tan(metric.angles[f, far % 3])
    g = metric.partners[c if side == 0 else 3 * f + (k + 2) % 3]
    if g >= 0:
        w = metric.faces[f, far % 3]
        j = g % 3 if metric.faces[g // 3, g % 3] == w else (g % 3 + 1) % 3
        total += 1.0 / math.tan(metric.angles[g // 3, j])
    return total / length


@kernel
def half_heights(h, areas, metric):
    """Half the sum of the heights over the edge of half-edge h."""
    f = h // 3
    total = areas[f] / metric.lengths[f, (h % 3 + 2) % 3]
    g = metric.partners[h]
    if g >= 0:
        total += areas[g // 3] / metric.lengths[g // 3, (g % 3 + 2) % 3]
    return total


@parallel_kernel
def ring_means(x, offsets, neighbours, out):
    """Write the mean of the finite values in each column of x at each vertex and its neighbours, nan without any."""
    for v in prange(offsets.shape[0] - 1):
        first, last = offsets[v], offsets[v + 1]
        for j in range(x.shape[1]):
            total = x[v, j]
            for i in range(first, last):
                total += x[neighbours[i], j]
            mean = total / (last - first + 1)
            out[v, j] = mean if math.isfinite(total) else finite_mean(v, j, x, offsets, neighbours)


@lean
def finite_mean(v, j, x, offsets, neighbours):
    """The mean of the finite values in column j at v and its neighbours, nan without any."""
    total, count = 0.0, 0
    if math.isfinite(x[v, j]):
        total, count = x[v, j], 1
    for i in range(offsets[v], offsets[v + 1]):
        y = x[neighbours[i], j]
        if math.isfinite(y):
            total += y
            count += 1
    return total / count if count > 0 else np.nan
