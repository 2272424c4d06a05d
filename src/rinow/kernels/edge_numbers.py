"""Edges of a triangle mesh by their numbers: those of its half-edges, and what the ends of each tell.

Edges are numbered in the order of their first half-edges.
"""

from rinow.kernels._jit import parallel_kernel, prange


@parallel_kernel
def count_edges(first, counts):
    """Write how many half-edges of each of some pieces of them are the first ones of their edge."""
    n, n_pieces = len(first), len(counts)
    for i in prange(len(counts)):
        count = 0
        for h in range(n * i // n_pieces, n * (i + 1) // n_pieces):
            count += first[h] == h
        counts[i] = count


@parallel_kernel
def list_edges(first, starts, edge_halfedges):
    """Write the first half-edges of all edges; those of each piece from its start on."""
    n, n_pieces = len(first), len(starts) - 1
    for i in prange(len(starts) - 1):
        e = starts[i]
        for h in range(n * i // n_pieces, n * (i + 1) // n_pieces):
            if first[h] == h:
                edge_halfedges[e] = h
                e += 1


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
