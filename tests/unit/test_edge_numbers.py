"""Numbers of edges and clusters of vertices against plain loops, and orders of keys."""

import itertools

import numpy as np
import pytest

import shapes
from rinow import TriangleMesh
from rinow.curvature.centres import cover, turns
from rinow.curvature.sheet import patch_sheet, sorted_by
from rinow.topology import clusters

RNG = np.random.default_rng(83)
TORUS = shapes.noisy(shapes.irregular_torus(700), 0.05)
FINS = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4], [2, 2, 3], [4, 1, 5], [5, 4, 6]])
"""Three faces at one edge, a face that takes no part, and boundaries."""


@pytest.mark.parametrize("faces", [TORUS.faces, FINS, FINS[:, [1, 2, 0]], np.array([[0, 0, 1]])])
def test_edges_are_numbered_by_their_first_half_edges(faces):
    t = TriangleMesh(RNG.normal(size=(faces.max() + 1, 3)), faces).topology
    numbers: dict[frozenset[int], int] = {}
    ends, first, expected = [], [], []
    for f, face in enumerate(faces.tolist()):
        for k in range(3):
            a, b = face[k], face[(k + 1) % 3]
            if len(set(face)) < 3:
                expected.append(-1)
                continue
            if frozenset((a, b)) not in numbers:
                numbers[frozenset((a, b))] = len(numbers)
                ends.append((a, b))
                first.append(3 * f + k)
            expected.append(numbers[frozenset((a, b))])
    np.testing.assert_array_equal(t.edge_of_halfedge(), expected)
    np.testing.assert_array_equal(t.edge_halfedges, first)
    np.testing.assert_array_equal(t.edges, np.reshape(ends, (-1, 2)))


@pytest.mark.parametrize(("n", "k"), [(0, 0), (1, 0), (9, 0), (40, 12), (40, 60)])
def test_clusters_are_numbered_by_their_first_vertices(n, k):
    pairs = RNG.integers(0, max(n, 1), (k, 2))
    label = list(range(n))
    for _, (a, b) in itertools.product(range(n), pairs.tolist()):
        label[a] = label[b] = min(label[a], label[b])
    first, cluster = clusters(n, pairs)
    expected = sorted(set(label))
    assert first.tolist() == expected
    assert cluster.tolist() == [expected.index(x) for x in label]


@pytest.mark.parametrize("n", [0, 1, 5, 3000])
def test_keys_of_all_32_bits_are_sorted_and_equal_ones_stay_in_order(n):
    keys = RNG.integers(0, 1 << 32, n, dtype=np.uint32)
    keys[::3] = keys[: len(keys[::3])]
    keys[n // 2 :: 7] = 0xFFFFFFFF
    np.testing.assert_array_equal(sorted_by(keys), np.argsort(keys, kind="stable"))


@pytest.mark.parametrize("radius", [0.1, 1.0, 1.7, 2.9, 6.0])
@pytest.mark.parametrize("shape", [TORUS, shapes.box(6), shapes.icosphere(3)], ids=["torus", "box", "icosphere"])
def test_centres_are_those_that_none_before_covers(shape, radius):
    sheet, _ = patch_sheet(TriangleMesh(shape.vertices, shape.faces))
    radii = radius * RNG.uniform(0.8, 1.2, len(sheet.vertices))
    candidates = turns(sheet)
    covered, expected, tied = set(), [], []
    for i, c in enumerate(candidates.tolist()):
        if max(c, ~c) not in covered:
            tied.append(max(c, ~c))
        if i + 1 == len(candidates) or candidates[i + 1] >= 0:
            for v in tied:
                covered |= _disc(sheet, v, radii[v] * sheet.spacing[v])
            expected, tied = expected + tied, []
    np.testing.assert_array_equal(cover(sheet, candidates, radii), sorted(expected))


def _disc(sheet, centre, radius):
    found, rest = {centre}, [centre]
    while rest:
        p = rest.pop()
        for q in sheet.neighbours[sheet.offsets[p] : sheet.offsets[p + 1]].tolist():
            if q not in found and np.sum((sheet.vertices[q] - sheet.vertices[centre]) ** 2) < radius**2:
                found.add(q)
                rest.append(q)
    return found
