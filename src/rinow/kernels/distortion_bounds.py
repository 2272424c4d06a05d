"""Bounds of the distortion of a correspondence of all nodes of two graphs, from the rows of some of its pairs.

The distances of a pair i = (x_i, y_i) from all others give its own distortion, the largest |d(x_i, x_j) - d(y_i, y_j)|.
Another pair j is at distance s = d(x_i, x_j) + d(y_i, y_j) from it, so by the triangle inequality that of j is larger
by s at most.  In the same way the eccentricity of a node bounds those of others.
"""

import numpy as np

from rinow.kernels._jit import inner, kernel, lean, parallel_kernel, prange
from rinow.kernels.edge_rows import work_space, write_rows
from rinow.kernels.graphs import forget, settle_ball


@lean
def _distortions(rows_x, rows_y, xs, ys, out):
    """Write the distortion of each pair whose rows stand side by side."""
    out[:] = 0.0
    for j in range(xs.shape[0]):
        x, y = xs[j], ys[j]
        for i in range(out.shape[0]):
            out[i] = max(out[i], abs(rows_x[x, i] - rows_y[y, i]))


@lean
def _bound_others(rows_x, rows_y, xs, ys, distortions, out):
    """Lower out[j] to what the rows say about the distortion of pair j."""
    for j in range(xs.shape[0]):
        x, y, bound = xs[j], ys[j], out[j]
        for i in range(distortions.shape[0]):
            bound = min(bound, distortions[i] + (rows_x[x, i] + rows_y[y, i]))
        out[j] = bound


@lean
def _bound_eccentricities(rows, eccentricities, low, high):
    """Write the eccentricities of the sources, and narrow the bounds of those of all nodes."""
    eccentricities[:] = 0.0
    for v in range(rows.shape[0]):
        for i in range(eccentricities.shape[0]):
            eccentricities[i] = max(eccentricities[i], rows[v, i])
    for v in range(rows.shape[0]):
        a, b = low[v], high[v]
        for i in range(eccentricities.shape[0]):
            d, e = rows[v, i], eccentricities[i]
            a, b = max(a, max(d, e - d)), min(b, e + d)
        low[v], high[v] = a, b


@parallel_kernel
def bound_distortions(xs, ys, groups, graph_x, graph_y, steps, distortions, bounds):
    """For each group of pairs write their distortions, and lower its own row of bounds of those of all pairs."""
    n, m, k = graph_x[0].shape[0] - 1, graph_y[0].shape[0] - 1, groups.shape[1]
    rows_x, rows_y, work_x, work_y = np.empty((n, k)), np.empty((m, k)), work_space(n), work_space(m)
    for g in prange(groups.shape[0]):
        write_rows(xs[groups[g]], *graph_x, steps[0], rows_x, *work_x)
        write_rows(ys[groups[g]], *graph_y, steps[1], rows_y, *work_y)
        _distortions(rows_x, rows_y, xs, ys, distortions[g])
        _bound_others(rows_x, rows_y, xs, ys, distortions[g], bounds[g])


@parallel_kernel
def bound_eccentricities(groups, graph, step, eccentricities, low, high):
    """For each group of nodes write their eccentricities, and narrow its own rows of bounds of those of all nodes."""
    n = graph[0].shape[0] - 1
    rows, work = np.empty((n, groups.shape[1])), work_space(n)
    for g in prange(groups.shape[0]):
        write_rows(groups[g], *graph, step, rows, *work)
        _bound_eccentricities(rows, eccentricities[g], low[g], high[g])


@inner
def _expect(v, expected, slope, reach, graph, bounds, distances, order, work):
    """Lower the bounds around a node to what it is expected to say about them."""
    _, reached = settle_ball(v, reach, distances.shape[0], *graph, distances, order, *work)
    for i in range(reached):
        bounds[order[i]] = min(bounds[order[i]], expected + slope * distances[order[i]])
    forget(order, reached, distances)


@kernel
def choose_group(seed, target, expected, slope, width, graph, bounds, group, spaces, work):
    """Choose nodes within some width of a seed whose bounds are above a target, and expect these to fall.

    A chosen node will have the value `expected`, it is supposed, and one at distance d from it that plus slope · d.
    What is left of the group repeats the seed.  `spaces` are distances and orders for two searches.
    """
    distances, order, inner_distances, inner_order = spaces
    reach = (target - expected) / slope
    _, reached = settle_ball(seed, width * reach, distances.shape[0], *graph, distances, order, *work)
    count = 0
    for i in range(reached):
        v = order[i]
        if count < group.shape[0] and (i == 0 or bounds[v] > target):
            group[count] = v
            count += 1
            _expect(v, expected, slope, reach, graph, bounds, inner_distances, inner_order, work)
    group[count:] = seed
    forget(order, reached, distances)
