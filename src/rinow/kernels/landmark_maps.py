"""Maps between graphs that send each node to one whose distances from landmarks are nearly its own.

Row x of `own` holds the distances of node x from the landmarks, row y of `other` those of y from their images, in units
of a diameter.  The gap of a pair is the sum of the fourth powers of the differences: large ones decide, and yet the
images of neighbours are neighbours, which the largest one alone would not do.  An image is looked for near the images
of neighbours, downhill along edges: this costs some dozens of gaps for each node, however large the other graph is.
"""

import numpy as np

from rinow.kernels._jit import inner, kernel, lean, parallel_kernel, prange


@lean
def _gap(own, other, x, y, limit):
    """The gap of a pair, or some value from the limit on."""
    total, n = np.float32(0.0), own.shape[1]
    for start in range(0, n, 16):
        for i in range(start, min(start + 16, n)):
            square = (own[x, i] - other[y, i]) * (own[x, i] - other[y, i])
            total += square * square
        if total >= limit:
            break
    return total


@lean
def _downhill(own, other, x, y, gap, offsets, heads):
    """Go from y to the neighbour with the least gap while it falls; the last node and its gap."""
    while True:
        best = y
        for a in range(offsets[y], offsets[y + 1]):
            value = _gap(own, other, x, heads[a], gap)
            if value < gap:
                best, gap = heads[a], value
        if best == y:
            return y, gap
        y = best


@inner
def _find(x, own, own_graph, other, other_graph, images, gaps):
    """Try the images of the neighbours of x, and go downhill from the best of them."""
    y, gap = images[x], gaps[x]
    for a in range(own_graph[0][x], own_graph[0][x + 1]):
        candidate = images[own_graph[1][a]]
        if candidate >= 0 and candidate != y:
            value = _gap(own, other, x, candidate, gap)
            if value < gap:
                y, gap = candidate, value
    if y >= 0:
        images[x], gaps[x] = _downhill(own, other, x, y, gap, *other_graph)


@kernel
def extend(first, last, own, own_graph, other, other_graph, images, gaps):
    """Give the nodes from first to last an image in this order; where none is known it is -1 and the gap infinite."""
    step = 1 if first <= last else -1
    for x in range(first, last + step, step):
        _find(x, own, own_graph, other, other_graph, images, gaps)


@parallel_kernel
def nearest_rows(own, other, out):
    """Write for each row of `own` the row of `other` with the least gap."""
    for x in prange(own.shape[0]):
        least = np.float32(np.inf)
        for y in range(other.shape[0]):
            value = _gap(own, other, x, y, least)
            if value < least:
                least, out[x] = value, y
