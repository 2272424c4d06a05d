"""Metric axioms and shortest paths by plain loops."""

import math


def worst_triple(D):
    """Largest excess d(i, j) - d(i, k) - d(k, j) and the triple (i, k, j), i < j, that has it."""
    n = len(D)
    triples = ((i, k, j) for i in range(n) for k in range(n) for j in range(i + 1, n))
    return max((D[i][j] - D[i][k] - D[k][j], (i, k, j)) for i, k, j in triples)


def shortest_paths(n, edges):
    """Floyd and Warshall: distances of n nodes joined by two-way edges (i, j, length)."""
    D = [[0.0 if i == j else math.inf for j in range(n)] for i in range(n)]
    for i, j, length in edges:
        D[i][j] = D[j][i] = min(D[i][j], length)
    for k in range(n):
        for i in range(n):
            for j in range(n):
                D[i][j] = min(D[i][j], D[i][k] + D[k][j])
    return D
