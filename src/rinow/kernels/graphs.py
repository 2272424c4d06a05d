"""Short paths beside the edges of a graph, and lengths of shortest paths, over compressed rows of neighbours.

Row u of (offsets, heads, lengths) lists the arcs that leave u, with ascending heads; `into` rows list those that
arrive.  An undirected graph has each edge in both rows, and the two sets of rows are the same.
"""

import math

import numpy as np

from rinow.kernels import triangles
from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.tolerances import LINEAR_TRIPLE

UNIT_TRIANGLE = 1.0 / math.sqrt(3.0)
"""Menger curvature of a triangle of a graph without lengths, as published: the circumradius of the unit triangle,
where the curvature of one with sides of length 1 is its inverse."""

ROUNDED_SUM = 1e-15
"""Two sums of the same three lengths differ by less than this share, in whatever order."""


@kernel
def sift_up(i, keys, nodes):
    """Move entry i of a binary heap up to its place."""
    while i > 0 and keys[i] < keys[(i - 1) // 2]:
        j = (i - 1) // 2
        keys[i], keys[j], nodes[i], nodes[j] = keys[j], keys[i], nodes[j], nodes[i]
        i = j


@kernel
def sift_down(n, keys, nodes):
    """Move the first of n entries of a binary heap down to its place."""
    i = 0
    while 2 * i + 1 < n:
        j = 2 * i + 1
        if j + 1 < n and keys[j + 1] < keys[j]:
            j += 1
        if keys[i] <= keys[j]:
            return
        keys[i], keys[j], nodes[i], nodes[j] = keys[j], keys[i], nodes[j], nodes[i]
        i = j


@kernel
def settle_ball(source, limit, most, offsets, heads, lengths, distances, order, keys, nodes):
    """Dijkstra's algorithm from a node up to a distance or a number of nodes.

    `distances` must be inf everywhere; what is reached is written and listed in `order`, and `forget` makes it inf
    again.  Returned are the distance of the last settled node and the number of nodes reached.  The distances up to
    that one are final, whether settled or not.
    """
    reach, n_settled, n_reached, n_heap = 0.0, 0, 1, 1
    distances[source], keys[0], nodes[0], order[0] = 0.0, 0.0, source, source
    while n_heap > 0 and n_settled < most:
        d, u = keys[0], nodes[0]
        if d > limit:
            break
        n_heap -= 1
        keys[0], nodes[0] = keys[n_heap], nodes[n_heap]
        sift_down(n_heap, keys, nodes)
        if d > distances[u]:
            continue
        reach, n_settled = d, n_settled + 1
        for i in range(offsets[u], offsets[u + 1]):
            v, new = heads[i], d + lengths[i]
            if new < distances[v]:
                if distances[v] == np.inf:
                    order[n_reached] = v
                    n_reached += 1
                distances[v] = new
                keys[n_heap], nodes[n_heap] = new, v
                sift_up(n_heap, keys, nodes)
                n_heap += 1
    return reach, n_reached


@kernel
def forget(order, n, distances):
    """Make the distances of reached nodes inf again."""
    for i in range(n):
        distances[order[i]] = np.inf


@parallel_kernel
def arc_distances(offsets, heads, lengths, n_blocks, out):
    """Write to out[i] the length of the shortest path from the tail to the head of arc i; at most its own length."""
    n_nodes = offsets.shape[0] - 1
    for block in prange(n_blocks):
        distances, order = np.full(n_nodes, np.inf), np.empty(n_nodes, np.intp)
        keys, nodes = np.empty(heads.shape[0] + 1), np.empty(heads.shape[0] + 1, np.intp)
        for u in range(n_nodes * block // n_blocks, n_nodes * (block + 1) // n_blocks):
            limit = 0.0
            for i in range(offsets[u], offsets[u + 1]):
                limit = max(limit, lengths[i])
            _, n = settle_ball(u, limit, n_nodes, offsets, heads, lengths, distances, order, keys, nodes)
            for i in range(offsets[u], offsets[u + 1]):
                out[i] = distances[heads[i]]
            forget(order, n, distances)


@kernel
def mark_row(u, offsets, heads, lengths, marks):
    """Write the lengths of the arcs of row u to `marks`, which is inf elsewhere."""
    for i in range(offsets[u], offsets[u + 1]):
        marks[heads[i]] = lengths[i]


@kernel
def clear_row(u, offsets, heads, marks):
    """Make `marks` inf again."""
    for i in range(offsets[u], offsets[u + 1]):
        marks[heads[i]] = np.inf


@kernel
def change_row(old, new, offsets, heads, lengths, marks):
    """Mark the row `new` in place of `old`, which is -1 for none; the row that is marked now."""
    if new != old:
        if old >= 0:
            clear_row(old, offsets, heads, marks)
        mark_row(new, offsets, heads, lengths, marks)
    return new


@kernel
def menger_of(a, b, c):
    """Menger curvature of a triangle; 0 if the others, up to rounding, are no longer than a side; nan if one is 0."""
    product = a * b * c
    if not product > 0.0:
        return np.nan
    _, p, q, r = triangles.excesses(a, b, c)
    if min(p, q, r) <= LINEAR_TRIPLE * max(min(a, b, c), 0.01 * max(a, b, c)):
        return 0.0
    return 4.0 * triangles.triangle_area(a, b, c) / product


@kernel
def menger_sum(u, chord, unweighted, offsets, heads, distances, marks):
    """Sum of the Menger curvatures of the triangles over the arc from u to v; `marks` has the distances to v."""
    total = 0.0
    for i in range(offsets[u], offsets[u + 1]):
        b = marks[heads[i]]
        if b < np.inf:
            total += UNIT_TRIANGLE if unweighted else menger_of(chord, distances[i], b)
    return total


@kernel
def haantjes_of(length, chord):
    """Haantjes curvature √((l - d)/d³) of a path, without the factor √24, as published for networks.

    It is 0 for a path as short as the chord up to the rounding of both sums, whose square root would be seen.
    """
    excess = (length - chord) / chord
    return math.sqrt(excess) / chord if excess > ROUNDED_SUM else 0.0


@kernel
def haantjes_sum(u, v, own, chord, offsets, heads, lengths, marks):
    """Sum of the Haantjes curvatures of the simple paths of at most three arcs from u to v; `marks` has arcs to v."""
    total = haantjes_of(own, chord)
    for i in range(offsets[u], offsets[u + 1]):
        x, first = heads[i], lengths[i]
        if x == v:
            continue
        if marks[x] < np.inf:
            total += haantjes_of(first + marks[x], chord)
        for j in range(offsets[x], offsets[x + 1]):
            y = heads[j]
            if y != u and y != v and marks[y] < np.inf:
                total += haantjes_of(first + lengths[j] + marks[y], chord)
    return total


@parallel_kernel
def menger_curvatures(order, tails, ends, chords, unweighted, offsets, heads, distances, into, n_blocks, out):
    """Write to out[e] the Menger curvature of the arc e; `order` lists the arcs by their head."""
    n = order.shape[0]
    into_offsets, into_tails, into_distances = into
    for block in prange(n_blocks):
        marks, marked = np.full(offsets.shape[0] - 1, np.inf), -1
        for i in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            e = order[i]
            marked = change_row(marked, ends[e], into_offsets, into_tails, into_distances, marks)
            out[e] = menger_sum(tails[e], chords[e], unweighted, offsets, heads, distances, marks)


@parallel_kernel
def haantjes_curvatures(order, tails, ends, own, chords, offsets, heads, lengths, into, n_blocks, out):
    """Write to out[e] the Haantjes curvature of the arc e, nan for a chord 0; `order` lists the arcs by their head."""
    n = order.shape[0]
    into_offsets, into_tails, into_lengths = into
    for block in prange(n_blocks):
        marks, marked = np.full(offsets.shape[0] - 1, np.inf), -1
        for i in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            e = order[i]
            marked = change_row(marked, ends[e], into_offsets, into_tails, into_lengths, marks)
            out[e] = np.nan
            if chords[e] > 0.0:
                out[e] = haantjes_sum(tails[e], marked, own[e], chords[e], offsets, heads, lengths, marks)
