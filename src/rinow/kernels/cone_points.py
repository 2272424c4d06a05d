"""Curvature concentrated at single vertices, told from curvature spread over a disc by how both grow with the disc."""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange

RINGS = 4
"""Rings around a vertex: the first two hold what belongs to a cone point, the others tell the curvature around it."""
MAX_DISC = 4096
"""Vertices of a disc at most: a hub has more, and is no cone point that could be told from its surroundings."""


@kernel
def grow_disc(v, offsets, neighbours, closed, members, ends, marks, epoch):
    """Write the rings around v to `members`, ring k ending before ends[k]; closed vertices are left out."""
    members[0], marks[v], ends[0] = v, epoch, 1
    n = 1
    for ring in range(1, RINGS + 1):
        begin = 0 if ring == 1 else ends[ring - 2]
        for m in range(begin, ends[ring - 1]):
            w = members[m]
            for i in range(offsets[w], offsets[w + 1]):
                u = neighbours[i]
                if marks[u] != epoch and not closed[u] and n < members.shape[0]:
                    marks[u] = epoch
                    members[n] = u
                    n += 1
        ends[ring] = n


@kernel
def total(values, members, begin, end):
    """Sum of values over members."""
    result = 0.0
    for m in range(begin, end):
        result += values[members[m]]
    return result


@kernel
def concentrated(defects, areas, members, ends):
    """Defect of the disc of two rings that the curvature of the rings beyond does not explain, and its noise.

    With a cone point of defect J in a surface of curvature κ the disc of area A has the defect D = J + κ A, so that
    D/A scales as the power -2 of its radius where J leads, and as 0 where there is none.
    """
    inner, outer = ends[2], ends[RINGS]
    around = total(areas, members, inner, outer)
    kappa = total(defects, members, inner, outer) / around if around > 0.0 else 0.0
    excess = total(defects, members, 0, inner) - kappa * total(areas, members, 0, inner)
    variance = 0.0
    for m in range(inner, outer):
        w = members[m]
        variance += (defects[w] - kappa * areas[w]) ** 2
    return excess, math.sqrt(variance / max(outer - inner, 1))


@kernel
def largest_neighbour(members, ends, defects):
    """Largest defect in the first two rings beside that of the centre, in absolute value."""
    largest = 0.0
    for m in range(1, ends[2]):
        largest = max(largest, abs(defects[members[m]]))
    return largest


@parallel_kernel
def cone_defects(candidates, offsets, neighbours, closed, defects, areas, n_blocks, excess, noise, rival):
    """Write for each candidate the excess of defect, its noise, and the largest other defect within two rings."""
    for block in prange(n_blocks):
        marks = np.full(offsets.shape[0] - 1, -1, np.intp)
        members, ends = np.empty(MAX_DISC, np.intp), np.empty(RINGS + 1, np.intp)
        for i in range(candidates.shape[0] * block // n_blocks, candidates.shape[0] * (block + 1) // n_blocks):
            v = candidates[i]
            grow_disc(v, offsets, neighbours, closed, members, ends, marks, i)
            excess[i], noise[i] = concentrated(defects, areas, members, ends)
            rival[i] = largest_neighbour(members, ends, defects)
