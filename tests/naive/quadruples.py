"""Embedding curvatures as zeros of a Gram determinant, counted on a grid; planarity by sums of angles."""

import itertools
import math

from naive.spaceform import angle, sine

PAIRS = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))


def matrix(d):
    """Distance matrix of d01, d02, d03, d12, d13, d23."""
    D = [[0.0] * 4 for _ in range(4)]
    for (i, j), x in zip(PAIRS, d, strict=True):
        D[i][j] = D[j][i] = x
    return D


def largest_curvature(d):
    """(2π/P)², P the largest perimeter of a triple."""
    D = matrix(d)
    triples = ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))
    return (2 * math.pi / max(D[i][j] + D[j][k] + D[i][k] for i, j, k in triples)) ** 2


def gram_determinant(d, k):
    """Determinant of the inner products of the vectors s_k(d_3i) u_i, u_i the directions at point 3; 0 if d embeds."""
    D = matrix(d)
    E = [[4 * sine(x / 2, k) ** 2 for x in row] for row in D]
    H = [[(E[i][3] + E[j][3] - E[i][j]) / 2 - k / 4 * E[i][3] * E[j][3] for j in range(3)] for i in range(3)]
    return (
        H[0][0] * (H[1][1] * H[2][2] - H[1][2] ** 2)
        - H[0][1] * (H[0][1] * H[2][2] - H[1][2] * H[0][2])
        + H[0][2] * (H[0][1] * H[1][2] - H[1][1] * H[0][2])
    )


def embedding_curvatures(d, lowest, n=4000):
    """Simple zeros of the Gram determinant in [lowest, k_max], ascending."""
    k_max = largest_curvature(d)
    grid = [k_max - (i / n) ** 2 * (k_max - lowest) for i in range(n + 1)]
    zeros = []
    for high, low in itertools.pairwise(grid):
        if (gram_determinant(d, low) > 0) != (gram_determinant(d, high) > 0):
            zeros.append(bisect(lambda k: gram_determinant(d, k), low, high))
    return zeros[::-1]


def bisect(f, low, high):
    positive = f(low) > 0
    for _ in range(60):
        middle = (low + high) / 2
        if (f(middle) > 0) == positive:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def angle_sums(d, k):
    """Sum of the three angles in S_k at each point."""
    D = matrix(d)
    sums = []
    for v in range(4):
        a, b, c = (i for i in range(4) if i != v)
        sums.append(sum(angle(D[i][j], D[v][i], D[v][j], k) for i, j in ((a, b), (b, c), (a, c))))
    return sums
