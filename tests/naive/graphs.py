"""Menger and Haantjes curvature of the edges of a graph, by listing every simple path; graphs are dicts of dicts."""

import math
from itertools import pairwise


def simple_paths(graph, u, v, most):
    """All simple paths of at most `most` arcs from u to v, as lists of nodes."""
    found = []

    def walk(path):
        if path[-1] == v:
            found.append(path)
        elif len(path) <= most:
            for w in graph[path[-1]]:
                if w not in path:
                    walk([*path, w])

    walk([u])
    return found


def shortest(graph):
    """Lengths of shortest paths between all nodes, by Floyd and Warshall."""
    d = {u: {v: 0.0 if u == v else graph[u].get(v, math.inf) for v in graph} for u in graph}
    for w in graph:
        for u in graph:
            for v in graph:
                d[u][v] = min(d[u][v], d[u][w] + d[w][v])
    return d


def menger(graph, u, v, *, unweighted=False):
    """Sum of the inverse circumradii of the triangles u, x, v, by the law of sines."""
    d, total = shortest(graph), 0.0
    for path in simple_paths(graph, u, v, 2):
        if len(path) == 3:
            a, b, c = d[u][v], d[u][path[1]], d[path[1]][v]
            if unweighted:
                total += 1 / math.sqrt(3)
            elif max(a, b, c) < 0.5 * (a + b + c):
                total += 2 * math.sin(math.acos((b * b + c * c - a * a) / (2 * b * c))) / a
    return total


def haantjes(graph, u, v):
    """Sum of sqrt((l - d) / d^3) over the simple paths of at most three arcs."""
    d, total = shortest(graph)[u][v], 0.0
    for path in simple_paths(graph, u, v, 3):
        length = sum(graph[a][b] for a, b in pairwise(path))
        total += math.sqrt(max(length - d, 0.0) / d**3)
    return total
