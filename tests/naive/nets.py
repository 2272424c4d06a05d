"""Nets, midpoints and graphs of steps straight from their definitions."""

import math

from naive.metric_space import shortest_paths


def farthest_points(D, size, start):
    """Points of the net, and the covering radius of the first 1, 2, ... of them; every distance is computed anew."""
    net, radii = [start], []
    while True:
        gaps = [min(D[p][x] for p in net) for x in range(len(D))]
        radii.append(max(gaps))
        if len(net) == size:
            return net, radii
        net.append(max((x for x in range(len(D)) if x not in net), key=lambda x: gaps[x]))


def covering_radius(D, net):
    """Greatest distance of a point from the net."""
    return max(min(D[p][x] for p in net) for x in range(len(D)))


def defect(D, x, y, z):
    """By how much z fails to be a midpoint of x and y."""
    return max(abs(2 * D[x][z] - D[x][y]), abs(2 * D[z][y] - D[x][y]))


def length_defect(D):
    """Greatest over the pairs of the least defect."""
    n = len(D)
    return max(min(defect(D, x, y, z) for z in range(n)) for x in range(n) for y in range(n))


def chain_lengths(D, chosen, step):
    """Lengths of the shortest chains of the chosen points with steps below a length."""
    k = range(len(chosen))
    edges = [(i, j, D[chosen[i]][chosen[j]]) for i in k for j in k if i < j and D[chosen[i]][chosen[j]] < step]
    return shortest_paths(len(chosen), edges)


def error(D, chosen, step):
    """Greatest excess of a chain over the distance."""
    G = chain_lengths(D, chosen, step)
    return max(G[i][j] - D[p][q] for i, p in enumerate(chosen) for j, q in enumerate(chosen))


def circle(n):
    """Arc distances of n equidistant points of a circle of length 2π."""
    t = 2 * math.pi / n
    return [[t * min(abs(i - j), n - abs(i - j)) for j in range(n)] for i in range(n)]
