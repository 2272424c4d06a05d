"""Curvature of a point set: least squares of the small eigenvalues of its Gram matrix, by Jacobi and golden section."""

import math

from naive.spaceform import sine


def eigenvalues(A, sweeps=30):
    """Eigenvalues of a symmetric matrix by Jacobi's rotations, descending."""
    A = [row[:] for row in A]
    n = len(A)
    for _ in range(sweeps):
        for p in range(n):
            for q in range(p + 1, n):
                if abs(A[p][q]) < 1e-300:
                    continue
                angle = 0.5 * math.atan2(2 * A[p][q], A[q][q] - A[p][p])
                c, s = math.cos(angle), math.sin(angle)
                for i in range(n):
                    A[i][p], A[i][q] = c * A[i][p] - s * A[i][q], s * A[i][p] + c * A[i][q]
                for i in range(n):
                    A[p][i], A[q][i] = c * A[p][i] - s * A[q][i], s * A[p][i] + c * A[q][i]
    return sorted((A[i][i] for i in range(n)), reverse=True)


def misfit(D, k):
    """Sum of the squares of all but the two largest eigenvalues, the base being the most central point."""
    base = min(range(len(D)), key=lambda i: max(D[i]))
    E = [[4 * sine(x / 2, k) ** 2 for x in row] for row in D]
    rest = [i for i in range(len(D)) if i != base]
    H = [[(E[i][base] + E[j][base] - E[i][j]) / 2 - k / 4 * E[i][base] * E[j][base] for j in rest] for i in rest]
    return sum(x * x for x in eigenvalues(H)[2:])


def curvature(D, low, high, steps=60):
    """The k of the least misfit in [low, high]."""
    ratio = (math.sqrt(5) - 1) / 2
    for _ in range(steps):
        a, b = high - ratio * (high - low), low + ratio * (high - low)
        if misfit(D, a) < misfit(D, b):
            high = b
        else:
            low = a
    return (low + high) / 2
