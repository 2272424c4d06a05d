"""Edges of a triangle mesh by their numbers: those of its half-edges, and what the ends of each tell.

Edges are numbered in the order of their first half-edges.
"""

from rinow.kernels._jit import parallel_kernel, prange


@parallel_kernel
def number_first_halfedges(edge_halfedges, numbers):
    """Write the number of each edge to its first half-edge."""
    for e in prange(len(edge_halfedges)):
        numbers[edge_halfedges[e]] = e


@parallel_kernel
def number_other_halfedges(first, numbers):
    """Write to each half-edge the number that the first one of its edge has already; -1 without an edge."""
    for h in prange(len(first)):
        if first[h] != h:
            numbers[h] = numbers[first[h]] if first[h] >= 0 else -1


@parallel_kernel
def ends_of_edges(faces, edge_halfedges, ends):
    """Write the start and the end of the first half-edge of each edge."""
    for e in prange(len(edge_halfedges)):
        f, k = edge_halfedges[e] // 3, edge_halfedges[e] % 3
        ends[e, 0], ends[e, 1] = faces[f, k], faces[f, (k + 1) % 3]


@parallel_kernel
def means_of_ends(values, faces, edge_halfedges, out):
    """Write the mean of the values at the two ends of each edge."""
    for e in prange(len(edge_halfedges)):
        f, k = edge_halfedges[e] // 3, edge_halfedges[e] % 3
        out[e] = (values[faces[f, k]] + values[faces[f, (k + 1) % 3]]) / 2.0
