"""Persistent homology by reduction of the whole boundary matrix, bottleneck distance by trying all matchings."""

import math
from itertools import combinations


def diagram(D, dimension):
    """Birth and death of the holes of a dimension in the Vietoris-Rips complex, scales being diameters."""
    simplices = [s for k in range(1, dimension + 3) for s in combinations(range(len(D)), k)]
    diameter = {s: max((D[i][j] for i, j in combinations(s, 2)), default=0.0) for s in simplices}
    order = sorted(simplices, key=lambda s: (diameter[s], len(s)))
    place = {s: k for k, s in enumerate(order)}
    columns, holes = {}, []
    for s in order:
        boundary = {place[face] for face in combinations(s, len(s) - 1)} if len(s) > 1 else set()
        while boundary and max(boundary) in columns:
            boundary ^= columns[max(boundary)]
        if boundary:
            columns[max(boundary)] = boundary
            creator = order[max(boundary)]
            if len(creator) == dimension + 1 and diameter[creator] < diameter[s]:
                holes.append((diameter[creator], diameter[s]))
    return sorted(holes)


def bottleneck_distance(a, b):
    """Least, over all ways to pair some points of two diagrams, of the largest difference; the rest is left alone."""
    best = math.inf

    def extend(i, free, worst):
        nonlocal best
        if worst >= best:
            return
        if i == len(a):
            best = min(best, max([worst, *((d - c) / 2 for c, d in free)]))
            return
        extend(i + 1, free, max(worst, (a[i][1] - a[i][0]) / 2))
        for k, (c, d) in enumerate(free):
            extend(i + 1, free[:k] + free[k + 1 :], max(worst, abs(a[i][0] - c), abs(a[i][1] - d)))

    extend(0, list(b), 0.0)
    return best


def clusters(D, t):
    """Number of sets of points that steps of at most t join."""
    parts = [{i} for i in range(len(D))]
    for i, j in combinations(range(len(D)), 2):
        if D[i][j] <= t:
            joined = [p for p in parts if i in p or j in p]
            parts = [p for p in parts if p not in joined] + [set().union(*joined)]
    return len(parts)
