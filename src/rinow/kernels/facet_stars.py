"""Stars that consist of flat facets and bend along one line, as those of prisms that stand for cylinders."""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.adjacency import previous_corner
from rinow.kernels.creases import dot, foot_and_height, minus, row, unit

SLIGHT = 0.05
"""An edge that turns by less than this share of the most at its vertex lies within a facet."""
STRAIGHT = 0.99
"""Cosine of the angle by which a line of bending may turn at a vertex."""


@kernel
def bending_edges(v, turnings, rounding, edge_of, edge_halfedges, offsets, corners, found):
    """Write up to three edges at v between facets to `found`; how many, and how many faces there are."""
    most, count = 0.0, 0
    for is_counting in (False, True):
        for i in range(offsets[v], offsets[v + 1]):
            c = corners[i]
            for h in (c, previous_corner(c)):
                e = edge_of[h]
                if edge_halfedges[e] == h and abs(turnings[e]) > rounding[e]:
                    if not is_counting:
                        most = max(most, abs(turnings[e]))
                    elif abs(turnings[e]) > SLIGHT * most:
                        if count < 3:
                            found[count] = e
                        count += 1
    return count, offsets[v + 1] - offsets[v]


@kernel
def curvature_across(e, turning, edge_halfedges, partners, vertices, faces):
    """Curvature of the circle through an edge and the far ends of its two faces, in the section across it."""
    h = edge_halfedges[e]
    _, mine, _ = foot_and_height(h, vertices, faces)
    _, theirs, _ = foot_and_height(partners[h], vertices, faces)
    chord2 = mine * mine + theirs * theirs + 2.0 * mine * theirs * math.cos(turning)
    return 2.0 * math.sin(turning) / math.sqrt(chord2) if chord2 > 0.0 else np.nan


@kernel
def facet_star(v, turnings, rounding, edge_of, edge_halfedges, partners, vertices, faces, offsets, corners, edges):
    """Curvature across the line along which the star of v bends and an edge of it (-1: flat); nan if there is none.

    One of the edges must be flat: two triangles alone do not tell facets from a smooth surface.
    """
    found = np.empty(3, np.intp)
    count, n_faces = bending_edges(v, turnings, rounding, edge_of, edge_halfedges, offsets, corners, found)
    if n_faces < count + 2 or count > 2:
        return np.nan, -1
    if count == 0:
        return 0.0, -1
    total = 0.0
    for i in range(count):
        e = found[i]
        total += curvature_across(e, turnings[e], edge_halfedges, partners, vertices, faces)
    e = found[0]
    if count == 2:
        g, p = found[1], row(vertices, v)
        one = unit(minus(row(vertices, edges[e, 0] + edges[e, 1] - v), p))
        two = unit(minus(row(vertices, edges[g, 0] + edges[g, 1] - v), p))
        if dot(one, two) > -STRAIGHT:
            return np.nan, -1
    return total / count, e


@parallel_kernel
def facet_stars(
    rows, turnings, rounding, edge_of, edge_halfedges, partners, vertices, faces, offsets, corners, edges, out, lines
):
    """Write curvature across and an edge of the line along which the star of each row bends; nan and -1 without."""
    for i in prange(len(rows)):
        out[i], lines[i] = facet_star(
            rows[i], turnings, rounding, edge_of, edge_halfedges, partners, vertices, faces, offsets, corners, edges
        )
