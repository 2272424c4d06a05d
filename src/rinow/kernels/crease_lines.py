"""Linking edges to lines: hysteresis along a line, chains that end nowhere, components, junctions."""

import math

import numpy as np

from rinow.kernels._jit import kernel
from rinow.kernels.adjacency import previous_corner
from rinow.kernels.creases import dot, minus, row, unit

CONTINUES = 0.5
"""Cosine of the angle by which a line of edges may turn from one edge to the next."""


@kernel
def incident_edge(v, j, edge_of, offsets, corners):
    """The j-th of the edges at v as its corners list them: each one once or twice, or -1."""
    c = corners[offsets[v] + j // 2]
    return edge_of[c if j % 2 == 0 else previous_corner(c)]


@kernel
def kept_edges_at(v, kept, edge_of, offsets, corners, found):
    """Write up to three different kept edges at v to `found`; how many."""
    n = 0
    for j in range(2 * (offsets[v + 1] - offsets[v])):
        g = incident_edge(v, j, edge_of, offsets, corners)
        if g >= 0 and kept[g]:
            is_new = True
            for i in range(n):
                is_new = is_new and found[i] != g
            if is_new:
                found[n] = g
                n += 1
                if n == 3:
                    break
    return n


@kernel
def direction_from(v, e, edges, vertices):
    """Unit vector from v along edge e."""
    w = edges[e, 0] + edges[e, 1] - v
    return unit(minus(row(vertices, w), row(vertices, v)))


@kernel
def spread_along_lines(kept, candidate, edges, edge_of, offsets, corners, vertices):
    """Add to `kept` the candidate edges that continue a kept edge, again and again."""
    queue = np.empty(edges.shape[0], np.intp)
    end = 0
    for e in range(edges.shape[0]):
        if kept[e]:
            queue[end] = e
            end += 1
    begin = 0
    while begin < end:
        e = queue[begin]
        begin += 1
        for side in range(2):
            v = edges[e, side]
            d = direction_from(v, e, edges, vertices)
            for j in range(2 * (offsets[v + 1] - offsets[v])):
                g = incident_edge(v, j, edge_of, offsets, corners)
                if g >= 0 and candidate[g] and not kept[g]:
                    if dot(d, direction_from(v, g, edges, vertices)) < -CONTINUES:
                        kept[g] = True
                        queue[end] = g
                        end += 1


@kernel
def weakest_sides(kept, strength, edge_of, share, drop):
    """Mark the weakest edge of each face with three kept ones if it is below a share of the next one."""
    for f in range(edge_of.shape[0] // 3):
        a, b, c = edge_of[3 * f], edge_of[3 * f + 1], edge_of[3 * f + 2]
        if a >= 0 and b >= 0 and c >= 0 and kept[a] and kept[b] and kept[c]:
            if strength[b] < strength[a]:
                a, b = b, a
            if strength[c] < strength[a]:
                a, c = c, a
            if strength[a] < share * min(strength[b], strength[c]):
                drop[a] = True


@kernel
def remove_short_ends(kept, weights, edges, may_end, edge_of, offsets, corners, length):
    """Take away chains that weigh less than `length` from a free end, where none may be, until none is left.

    The weights (n_edges,) are whole numbers, 1 or more.
    """
    found, chain = np.empty(3, np.intp), np.empty(length, np.intp)
    changed = True
    while changed:
        changed = False
        for e in range(edges.shape[0]):
            for side in range(2):
                v = edges[e, side]
                if kept[e] and not may_end[v] and kept_edges_at(v, kept, edge_of, offsets, corners, found) == 1:
                    n, total, g = 0, 0, e
                    while total < length:
                        chain[n] = g
                        n, total = n + 1, total + weights[g]
                        v = edges[g, 0] + edges[g, 1] - v
                        if may_end[v] or kept_edges_at(v, kept, edge_of, offsets, corners, found) != 2:
                            break
                        g = found[0] + found[1] - g
                    if total < length:
                        changed = True
                        for i in range(n):
                            kept[chain[i]] = False


@kernel
def line_components(kept, edges, n_vertices):
    """Label of each kept edge, a vertex that all edges joined to it share; -1 for the others."""
    parent = np.full(n_vertices, -1, np.intp)
    labels = np.full(edges.shape[0], -1, np.intp)
    for e in range(edges.shape[0]):
        if kept[e]:
            a, b = root(edges[e, 0], parent), root(edges[e, 1], parent)
            if a != b:
                parent[max(a, b)] = min(a, b)
    for e in range(edges.shape[0]):
        if kept[e]:
            labels[e] = root(edges[e, 0], parent)
    return labels


@kernel
def root(v, parent):
    """Representative of v, with path halving."""
    while parent[v] >= 0:
        if parent[parent[v]] >= 0:
            parent[v] = parent[parent[v]]
        v = parent[v]
    return v


@kernel
def junctions(kept, edges, edge_of, offsets, corners, vertices, degrees, turns):
    """Write the number of kept edges at each vertex, three standing for more, and the turn of a line of two there."""
    found = np.empty(3, np.intp)
    for v in range(offsets.shape[0] - 1):
        degrees[v], turns[v] = kept_edges_at(v, kept, edge_of, offsets, corners, found), 0.0
        if degrees[v] == 2:
            a, b = direction_from(v, found[0], edges, vertices), direction_from(v, found[1], edges, vertices)
            turns[v] = math.acos(min(max(-dot(a, b), -1.0), 1.0))
