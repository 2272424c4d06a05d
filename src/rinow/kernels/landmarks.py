"""Landmarks around each node of a graph: far from each other within a ball, with the shortest paths between them."""

import numpy as np

from rinow.kernels._jit import inner, lean, parallel_kernel, prange
from rinow.kernels.graphs import settle_ball, sift_down, sift_up


@lean
def reach_node(v, column, length, apart, touched, n_touched):
    """Write a distance of a landmark; how many nodes have one of any landmark, which `touched` lists.

    The last column says which these are.
    """
    if apart[v, -1] == np.inf:
        touched[n_touched] = v
        n_touched += 1
        apart[v, -1] = 0.0
    apart[v, column] = length
    return n_touched


@lean
def meet(v, column, apart, best):
    """Shorten the paths from a landmark to those before by that over v; whether one of them is shorter now."""
    own, is_shorter = apart[v, column], False
    for j in range(column):
        total = own + apart[v, j]
        if total < best[j]:
            best[j], is_shorter = total, True
    return is_shorter


@lean
def missing(column, best, reaches):
    """How far a search must lead to know the distances of its landmark from those before, as far as paths are known.

    A path that two searches do not see is not shorter than the distances up to which they saw everything, together.
    """
    most = 0.0
    for j in range(column):
        most = max(most, best[j] - reaches[j])
    return most


@lean
def search_landmark(v, column, radius, is_even, rows, apart, touched, n_touched, best, reaches, keys, nodes):
    """Dijkstra's algorithm from a landmark up to a radius, and until its distances from those before are known.

    If all arcs have one length, nodes are settled in the order in which they are reached: no heap is needed.  The
    searches of two landmarks meet halfway: `best` has the lengths of the shortest paths on which both have seen a
    common node, `reaches` the distances up to which each saw everything.  How many nodes are reached by any search is
    returned.
    """
    offsets, heads, lengths = rows
    n_touched = reach_node(v, column, 0.0, apart, touched, n_touched)
    for j in range(column):
        best[j] = apart[v, j]
    keys[0], nodes[0], first, last, far = 0.0, v, 0, 1, missing(column, best, reaches)
    while first < last and keys[first] < max(radius, far):
        d, u = keys[first], nodes[first]
        if is_even:
            first += 1
        else:
            last -= 1
            keys[0], nodes[0] = keys[last], nodes[last]
            sift_down(last, keys, nodes)
        if d > apart[u, column]:
            continue
        for i in range(offsets[u], offsets[u + 1]):
            w, new = heads[i], d + lengths[i]
            if new < apart[w, column]:
                n_touched = reach_node(w, column, new, apart, touched, n_touched)
                if d < far and meet(w, column, apart, best):
                    far = missing(column, best, reaches)
                keys[last], nodes[last] = new, w
                if not is_even:
                    sift_up(last, keys, nodes)
                last += 1
    reaches[column] = keys[first] if first < last else np.inf
    return n_touched


@inner
def choose_landmarks(v, radius, least, is_even, rows, apart, touched, members, work, nearest, matrix):
    """Write the distances of landmarks, the first of them v and each next one the farthest from those before.

    They lie in a ball around v: without a radius (nan) that of the `least` nearest nodes and all others as near as the
    last of them.  Returned are their number, smaller than asked for in a ball with fewer nodes, and the radius.
    """
    limit, most = (np.inf, least) if np.isnan(radius) else (radius, apart.shape[0])
    best, reaches = np.empty(matrix.shape[0]), np.empty(matrix.shape[0])
    reach, n_touched = settle_ball(v, limit, most, *rows, apart[:, 0], members, *work)
    touched[:n_touched] = members[:n_touched]
    for i in range(n_touched):
        apart[members[i], -1] = 0.0
    n, count, landmark, reaches[0] = 0, 0, v, reach
    for i in range(n_touched):
        if apart[members[i], 0] <= reach:
            members[n], nearest[n] = members[i], np.inf
            n += 1
    while True:
        for j in range(count):
            matrix[count, j] = matrix[j, count] = best[j]
        matrix[count, count] = 0.0
        farthest = 0
        for i in range(n):
            nearest[i] = min(nearest[i], apart[members[i], count])
            if nearest[i] > nearest[farthest]:
                farthest = i
        count += 1
        if count == matrix.shape[0] or nearest[farthest] == 0.0:
            break
        landmark = members[farthest]
        n_touched = search_landmark(
            landmark, count, nearest[farthest], is_even, rows, apart, touched, n_touched, best, reaches, *work
        )
    for i in range(n_touched):
        apart[touched[i]] = np.inf
    return count, reach


@parallel_kernel
def local_spaces(centres, radius, least, rows, n_blocks, matrices, counts, radii):
    """Write the distances of the landmarks around each centre, their number, and the radius of their ball."""
    is_even = len(rows[2]) > 0 and rows[2].min() == rows[2].max()
    n_nodes, n_arcs, size = rows[0].shape[0] - 1, rows[1].shape[0], matrices.shape[1]
    for block in prange(n_blocks):
        apart, touched = np.full((n_nodes, size + 1), np.inf), np.empty(n_nodes, np.intp)
        members, nearest = np.empty(n_nodes, np.intp), np.empty(n_nodes)
        work = (np.empty(n_arcs + 1), np.empty(n_arcs + 1, np.intp))
        for i in range(centres.shape[0] * block // n_blocks, centres.shape[0] * (block + 1) // n_blocks):
            counts[i], radii[i] = choose_landmarks(
                centres[i], radius, least, is_even, rows, apart, touched, members, work, nearest, matrices[i]
            )
