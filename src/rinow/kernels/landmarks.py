"""Landmarks around each node of a graph: far from each other within a ball, with the shortest paths between them."""

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.graphs import forget, settle_ball

ROUNDING = 1.0 + 1e-12
"""Two nodes of a ball are joined through its centre, so not farther than twice its radius, up to rounding."""


@kernel
def ball_of(v, radius, least, rows, distances, order, work, members):
    """Write the nodes of a ball around v to `members` in the order of their discovery; how many, and its radius.

    Without a radius (nan) it is the ball of the `least` nearest nodes and all others as near as the last of them.
    """
    limit, most = (np.inf, least) if np.isnan(radius) else (radius, distances.shape[0])
    reach, reached = settle_ball(v, limit, most, *rows, distances, order, *work)
    n = 0
    for i in range(reached):
        if distances[order[i]] <= reach:
            members[n] = order[i]
            n += 1
    forget(order, reached, distances)
    return n, reach


@kernel
def choose_landmarks(v, members, n, reach, rows, distances, order, work, nearest, landmarks, matrix):
    """Write landmarks, the first of them v and each next one the farthest from those before, and their distances.

    The number of landmarks is returned; it is smaller than asked for in a ball with fewer nodes.
    """
    nearest[:n] = np.inf
    landmarks[0] = v
    count = 0
    while True:
        _, reached = settle_ball(
            landmarks[count], 2.0 * reach * ROUNDING, distances.shape[0], *rows, distances, order, *work
        )
        for j in range(count):
            matrix[count, j] = matrix[j, count] = distances[landmarks[j]]
        matrix[count, count] = 0.0
        count += 1
        farthest = 0
        for i in range(n):
            nearest[i] = min(nearest[i], distances[members[i]])
            if nearest[i] > nearest[farthest]:
                farthest = i
        forget(order, reached, distances)
        if count == landmarks.shape[0] or nearest[farthest] == 0.0:
            return count
        landmarks[count] = members[farthest]


@parallel_kernel
def local_spaces(centres, radius, least, rows, n_blocks, matrices, counts, radii):
    """Write the distances of the landmarks around each centre, their number, and the radius of their ball."""
    n_nodes, n_arcs, size = rows[0].shape[0] - 1, rows[1].shape[0], matrices.shape[1]
    for block in prange(n_blocks):
        distances, order = np.full(n_nodes, np.inf), np.empty(n_nodes, np.intp)
        work = (np.empty(n_arcs + 1), np.empty(n_arcs + 1, np.intp))
        members, nearest = np.empty(n_nodes, np.intp), np.empty(n_nodes)
        landmarks = np.empty(size, np.intp)
        for i in range(centres.shape[0] * block // n_blocks, centres.shape[0] * (block + 1) // n_blocks):
            n, radii[i] = ball_of(centres[i], radius, least, rows, distances, order, work, members)
            counts[i] = choose_landmarks(
                centres[i], members, n, radii[i], rows, distances, order, work, nearest, landmarks, matrices[i]
            )
