"""Simplices from their edge lengths, seen along the longest edge.

With the longest edge, of length L from point p to point q, as an axis, point i lies at the position x_i on it and its
perpendicular parts have the inner products h_ij.  Then the Gram determinant of all edges at p is L² det h, in which
the diagonal h_ii = 4 area²/L² comes from Heron's product and loses no digit.
"""

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.quadruples import other_two
from rinow.kernels.triangles import excess
from rinow.tolerances import METRIC_TRIANGLE_INEQUALITY


@kernel
def longest_edge(D):
    """Points p > q with the largest distance; -1, -1 unless D is a symmetric matrix of lengths with zero diagonal."""
    p, q = D.shape[0] - 1, 0
    for i in range(D.shape[0]):
        for j in range(i):
            if not 0.0 <= D[i, j] < np.inf or abs(D[i, j] - D[j, i]) > METRIC_TRIANGLE_INEQUALITY * D[i, j]:
                return -1, -1
            if D[i, j] > D[p, q]:
                p, q = i, j
        if D[i, i] != 0.0:
            return -1, -1
    return p, q


@kernel
def position(D, p, q, i):
    """x_i = (d_pi² - d_qi² + L²)/(2L): where point i lies along the edge from p to q."""
    return 0.5 * (D[p, q] + (D[p, i] - D[q, i]) * ((D[p, i] + D[q, i]) / D[p, q]))


@kernel
def squared_height(D, p, q, i):
    """h_ii: squared distance of point i from the line through p and q; negative if there is no such triangle."""
    a, b, c = D[p, q], D[p, i], D[q, i]
    return (a + (b + c)) * (excess(a, b, c) / a) * (excess(b, c, a) / a) * excess(c, a, b) / 4.0


@kernel
def perpendicular_product(D, p, q, i, j):
    """h_ij = (h_ii + h_jj + (x_i - x_j)² - d_ij²)/2."""
    along = abs(position(D, p, q, i) - position(D, p, q, j))
    heights = squared_height(D, p, q, i) + squared_height(D, p, q, j)
    return 0.5 * (heights - (D[i, j] - along) * (D[i, j] + along))


@kernel
def cayley_menger_4(D):
    """Bordered determinant of the squared distances of four points: 288 times the squared volume."""
    p, q = longest_edge(D)
    if p < 0:
        return np.nan
    if D[p, q] == 0.0:
        return 0.0
    i, j = other_two(p, q)
    product = perpendicular_product(D, p, q, i, j)
    return 8.0 * D[p, q] ** 2 * (squared_height(D, p, q, i) * squared_height(D, p, q, j) - product * product)


@parallel_kernel
def cayley_menger_4s(D, out):
    """Write the determinant of each matrix (4, 4)."""
    for row in prange(out.shape[0]):
        out[row] = cayley_menger_4(D[row])


@kernel
def perpendicular_gram(D, H, moments):
    """Write h_ij and (h_ii - x_i (L - x_i))/2 for the points off the longest edge; return its length L, or nan."""
    p, q = longest_edge(D)
    if p < 0 or D[p, q] == 0.0:
        H[:], moments[:] = 0.0, 0.0
        return np.nan if p < 0 else 0.0
    row = 0
    for i in range(D.shape[0]):
        if i == p or i == q:
            continue
        x = position(D, p, q, i)
        H[row, row] = squared_height(D, p, q, i)
        moments[row] = 0.5 * (H[row, row] - x * (D[p, q] - x))
        column = 0
        for j in range(i):
            if j != p and j != q:
                H[row, column] = H[column, row] = perpendicular_product(D, p, q, i, j)
                column += 1
        row += 1
    return D[p, q]


@parallel_kernel
def perpendicular_grams(D, lengths, H, moments):
    """Write the longest edge and the perpendicular Gram matrix of each matrix of distances."""
    for row in prange(D.shape[0]):
        lengths[row] = perpendicular_gram(D[row], H[row], moments[row])
