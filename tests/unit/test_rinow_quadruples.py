"""Rinow curvature of four points, and of triangles with points on their sides."""

import math
from itertools import combinations, permutations

import numpy as np
import pytest

import conformal
import rinow
from naive import comparison as naive
from naive import spaceform
from quadruple_shapes import GOLDEN, PAIRS, matrix
from rinow import rinow_curvature

SURFACE = conformal.Disk()


@pytest.mark.parametrize("row", [r for r in GOLDEN if r["status"] == "ok"], ids=lambda r: r["name"])
def test_four_points_are_bounded_by_their_embedding_curvatures(row):
    D = matrix([float(d) for d in row["distances"].values()])
    bounds = rinow_curvature(D, rtol=0.0)
    values = [float(v) for v in row["embedding_curvatures"]]
    scale = max([1 / D.max() ** 2, *map(abs, values)])
    expected = {t: v for t, v in zip(row["types"], values, strict=True)}
    # The bounds are found by bisection of angles: about 1e-15/angle derivative, a thin quadruple has 1e-6.
    lower = expected.get("planar", expected.get("sd", expected.get("boundary", -math.inf)))
    assert bounds.lower == pytest.approx(lower, abs=1e-9 * scale)
    if "boundary" not in expected or "nonplanar" in expected:
        upper = expected.get("nonplanar", expected.get("sd", -math.inf))
        assert bounds.upper == pytest.approx(upper, abs=1e-9 * scale)


def test_examples_of_the_paper():
    # 3.6 branches: no bound from below.  3.7(a): 1.47949977, the printed 0 and 1 are wrong.  3.7(b), radii printed.
    branching = rinow_curvature(matrix([1, 1, 1, 2, 2, 2]))
    assert (branching.lower, branching.upper, branching.upper_witness) == (-math.inf, -math.inf, ())
    assert branching.lower_witness[0] == 0
    equidistant = rinow_curvature(matrix([math.pi / 2] * 6))
    assert equidistant.lower == pytest.approx((math.acos(-1 / 3) / (math.pi / 2)) ** 2, rel=1e-9)
    assert equidistant.upper == -math.inf
    p, d = math.pi, 1.5 * math.pi
    two = rinow_curvature(matrix([d, p, p, p, p, d]))
    assert two.lower == pytest.approx(0.282315492194044110, rel=1e-9)
    assert two.upper == pytest.approx(1 / 9, rel=1e-9)


def test_flat_and_spherical_quadruple_that_replaces_example_3_7_a():
    a, b = 1.27455578231, 1.00434286546
    bounds = rinow_curvature(matrix([2, a, b, a, b, 0.883546741918]))
    # The distances are given to 1e-11, an error of them counts 100 times.
    assert (bounds.upper, bounds.lower) == pytest.approx((0, 1), abs=1e-8)


@pytest.mark.parametrize("rtol", [0.0, 0.01])
def test_bounds_agree_with_the_naive_twin(rtol):
    for seed in range(10, 14):
        D = np.triu(np.random.default_rng(seed).uniform(1, 2, (6, 6)), 1)
        D += D.T
        bounds = rinow_curvature(D, rtol=rtol)
        assert (bounds.lower, bounds.upper) == pytest.approx(naive.bounds(D.tolist(), rtol), rel=1e-11)


def triangle_with_side_points():
    """Corners 0, 1, 2 and three points between each two of them on a surface of variable curvature."""
    corners = np.array([[-0.1, -0.1], [0.15, -0.05], [0.0, 0.15]])
    i, j = np.array([0, 0, 1]), np.array([1, 2, 2])
    v = SURFACE.directions(corners[i], corners[j])
    sides = [SURFACE.flow(corners[i], t * v) for t in (0.25, 0.5, 0.75)]
    D = SURFACE.distances(np.concatenate([corners, *sides]))
    for m in range(9):  # the parts of a side sum up exactly
        a, b, p, t = i[m % 3], j[m % 3], 3 + m, 0.25 * (1 + m // 3)
        D[a, p] = D[p, a] = t * D[a, b]
        D[b, p] = D[p, b] = (1 - t) * D[a, b]
        for q in range(3 + m % 3, 3 + m, 3):
            D[p, q] = D[q, p] = abs(t - 0.25 * (1 + (q - 3) // 3)) * D[a, b]
    return D


def side_comparisons(D, k):
    """Definition 6.1: xy - x_k y_k for all triangles p, q, r, points x of the side pq and y of pr, ends included."""
    points = range(len(D))

    def between(p, x, q):
        return abs(D[p][x] + D[x][q] - D[p][q]) < 1e-13

    for p, q, r in permutations(points, 3):
        if between(p, q, r) or between(q, r, p) or between(r, p, q):
            continue
        angle = spaceform.angle(D[q][r], D[p][q], D[p][r], k)
        for x in points:
            for y in points:
                if p not in (x, y) and between(p, x, q) and between(p, y, r):
                    yield D[x][y] - spaceform.side(D[p][x], D[p][y], angle, k)


def test_side_points_are_compared_by_quadruples_with_a_linear_triple():
    D = triangle_with_side_points()
    Q = np.array(list(combinations(range(12), 4)))
    sixes = np.stack([D[Q[:, i], Q[:, j]] for i, j in zip(*PAIRS, strict=True)], axis=1)
    found = rinow.embedding_curvatures(sixes)
    kappa = found.values[(found.kind == "semidependent").any(axis=1), 0]
    assert len(kappa) > 100
    lists = D.tolist()
    # Rounding of a side by the laws of cosines at k = 1 and distances near 0.1: 1e-16/0.1.
    assert max(side_comparisons(lists, kappa.max() + 1e-6)) <= 1e-14 < max(side_comparisons(lists, kappa.max() - 0.05))
    assert min(side_comparisons(lists, kappa.min() - 1e-6)) >= -1e-14 > min(side_comparisons(lists, kappa.min() + 0.05))
    bounds = rinow_curvature(D)
    assert bounds.lower <= kappa.min() + 1e-6
    assert bounds.upper >= kappa.max() - 1e-6
