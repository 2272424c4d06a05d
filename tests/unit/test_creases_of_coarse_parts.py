"""Creases of parts as CAD programs write them: one edge from corner to corner, no vertex inside a face."""

import numpy as np
import pytest

import rinow

U = np.array([(0, 0), (2, 0), (2, 1.4), (1.4, 1.4), (1.4, 0.6), (0.6, 0.6), (0.6, 1.4), (0, 1.4)])
THIN_U = np.array([(0, 0), (1.5, 0), (1.5, 1), (1.37, 1), (1.37, 0.13), (0.13, 0.13), (0.13, 1), (0, 1)])
BOTTOM = np.array([(7, 6, 5), (0, 7, 5), (4, 3, 2), (4, 2, 1), (0, 5, 4), (4, 1, 0)])
TOP = np.array([(5, 6, 7), (5, 7, 0), (2, 3, 4), (1, 2, 4), (5, 0, 1), (1, 4, 5)]) + 8


@pytest.mark.parametrize("outline", [U, THIN_U], ids=["thick", "thin"])
def test_convex_and_concave_creases_of_single_edges(outline):
    # The concave edges are lines of one edge between two corners.  Sections from the ends of the arms stop there.
    i, j = np.arange(8), np.roll(np.arange(8), -1)
    V = np.concatenate([np.c_[outline, np.zeros(8)], np.c_[outline, np.full(8, 0.8)]])
    sides = [np.stack([i, j, j + 8], axis=1), np.stack([i, j + 8, i + 8], axis=1)]
    found = rinow.singular_features((V, np.concatenate([*sides, BOTTOM, TOP])))
    expected = np.sort(np.concatenate([np.c_[i, j], np.c_[i, j] + 8, np.c_[i, i + 8]]), axis=1)
    np.testing.assert_array_equal(found.crease_edges, expected[np.lexsort(expected.T[::-1])])
    is_concave = [edge in ([4, 12], [5, 13]) for edge in found.crease_edges.tolist()]
    np.testing.assert_allclose(found.crease_angles, np.where(is_concave, -np.pi / 2, np.pi / 2), atol=1e-9)
    assert found.corners.tolist() == list(range(16))
