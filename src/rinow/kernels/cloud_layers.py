"""Sheets of a cloud that lie close to each other: which of the points around one are on its own sheet.

The sheet is followed from the point outwards: quadrics are fitted with weights that fall off with the distance from the
point, less and less, and with the residual of the quadric before.
"""

import math

import numpy as np

from rinow.kernels._jit import inner, parallel_kernel, prange
from rinow.kernels.cloud_strays import RIDGE, local_terms

REACHES = (1.0, 1.0, 1.0, 1.5, 1.5, 2.2, 2.2, 4.0, 4.0)
"""Width of the weights in each round, over that of the first."""
FIRST, NTH = 0.65, 11
"""That width, over the distance of the twelfth nearest point."""
WIDTHS = (FIRST, 4 * FIRST)
"""Those of the weights for the plane over which quadrics are fitted, the second where the first leads to nothing."""
BESIDE = 0.35
"""Residual, over the spacing, from which on a point hardly counts."""
OWN = 5.0
"""Weight of the point itself, which is on its sheet, in points."""
GAP, GAP_DEVIATIONS = 0.6, 4.0
"""Empty step between two residuals that parts two sheets: over the spacing, and over the residuals below it."""
COMPANY = 0.75
"""Least share of points around a point that a neighbour on its sheet has on its own as well: nearly all."""
FEWEST = 24
"""Points of a sheet, at least: a third of those looked at."""


@inner
def normal_of(v, near, points, weights):
    """Unit normal of the plane through a point that fits its weighted neighbours best."""
    matrix = np.zeros((3, 3))
    for i in range(near.shape[0]):
        for a in range(3):
            for b in range(3):
                matrix[a, b] += weights[i] * (points[near[i], a] - points[v, a]) * (points[near[i], b] - points[v, b])
    vectors = np.linalg.eigh(matrix)[1]
    return vectors[0, 0], vectors[1, 0], vectors[2, 0]


@inner
def weighted_quadric(terms, heights, weights):
    """Coefficients of the quadric of least weighted squares, through the origin with weight `OWN`."""
    matrix, right = np.zeros((6, 6)), np.zeros(6)
    total = OWN + weights.sum()
    for i in range(terms.shape[0]):
        w = weights[i] / total
        for a in range(6):
            right[a] += w * terms[i, a] * heights[i]
            for c in range(6):
                matrix[a, c] += w * terms[i, a] * terms[i, c]
    matrix[0, 0] += OWN / total
    for a in range(6):
        matrix[a, a] += RIDGE
    return np.linalg.solve(matrix, right)


@inner
def follow_sheet(terms, heights, distances, spacing, weights, residuals):
    """Write the moduli of the residuals of the quadric that follows the sheet of the point."""
    width = FIRST * distances[NTH]
    for r in range(len(REACHES)):
        for i in range(len(distances)):
            x = distances[i] / (REACHES[r] * width)
            weights[i] = math.exp(-0.5 * x * x)
            if r > 0:
                y = residuals[i] / (BESIDE * spacing)
                weights[i] /= (1.0 + y * y) ** 2
        quadric = weighted_quadric(terms, heights, weights)
        for i in range(len(distances)):
            fitted = 0.0
            for a in range(6):
                fitted += quadric[a] * terms[i, a]
            residuals[i] = abs(heights[i] - fitted)
    return abs(quadric[0])


@inner
def edge_of_sheet(residuals, own, spacing):
    """The largest residual below the first empty step; inf if there is none, or if the point itself is above it."""
    ordered = np.sort(residuals)
    square = 0.0
    for i in range(len(ordered) - 1):
        square += ordered[i] ** 2
        step = ordered[i + 1] - ordered[i]
        if i + 1 >= FEWEST and step > max(GAP * spacing, GAP_DEVIATIONS * math.sqrt(square / (i + 1))):
            return ordered[i] if own < ordered[i] + step else np.inf
    return np.inf


@parallel_kernel
def layers(owners, points, near, distances, n_blocks, is_own, thickness):
    """Write whether near[i, j] is on the sheet of owners[i], and the largest residual there, in spacings."""
    for block in prange(n_blocks):
        n, k = near.shape
        terms, heights, weights, residuals = np.empty((k, 6)), np.empty(k), np.empty(k), np.empty(k)
        for i in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            reach, spacing, edge = distances[i, k - 1], math.sqrt(math.pi / (k + 0.5)), np.inf
            for width in WIDTHS:
                weights[:] = np.exp(-0.5 * (distances[i] / (width * distances[i, NTH])) ** 2)
                normal = normal_of(owners[i], near[i], points, weights)
                local_terms(owners[i], near[i], points, normal, reach, terms, heights)
                own = follow_sheet(terms, heights, distances[i] / reach, spacing, weights, residuals)
                edge = edge_of_sheet(residuals, own, spacing)
                if edge < np.inf:
                    break
            thickness[i] = 0.0
            for j in range(k):
                is_own[i, j] = residuals[j] <= edge
                if is_own[i, j]:
                    thickness[i] = max(thickness[i], residuals[j] / spacing)


@inner
def is_stranger(v, w, points, ordered, row, reach):
    """Whether too few points around v, itself among them, that w has looked at are in the row of w, which has some."""
    seen = shared = 0
    is_empty = ordered[w, 0] == w and ordered[w, -1] == w
    for i in range(-1, row.shape[0]):
        u = v if i < 0 else row[i]
        if (i < 0 or u != v) and u != w:
            x, y, z = points[u, 0] - points[w, 0], points[u, 1] - points[w, 1], points[u, 2] - points[w, 2]
            if x * x + y * y + z * z < (1.0 - 1e-9) * reach[w] ** 2:
                seen += 1
                place = np.searchsorted(ordered[w], u)
                shared += place < ordered.shape[1] and ordered[w, place] == u
    return not is_empty and shared < COMPANY * seen


@parallel_kernel
def strangers(owners, points, ordered, near, reach, out):
    """Write whether near[owners[i], j] does not share the company of its owner; `ordered` has the rows sorted."""
    for i in prange(len(owners)):
        v = owners[i]
        for j in range(near.shape[1]):
            w = near[v, j]
            out[i, j] = w != v and is_stranger(v, w, points, ordered, near[v], reach)
