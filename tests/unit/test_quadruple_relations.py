"""What kinds of quadruples have in common: conditions, linear triples, trees, great circles, planar ones."""

import math

import numpy as np
import pytest

import rinow
from naive import quadruples as naive
from quadruple_shapes import DISTANCES, I, J, sampled


def test_condition_is_the_largest_derivative():
    Q = np.concatenate([sampled(1.0, 0.7, 40, seed=25), sampled(-4.0, 0.7, 40, seed=26)])
    result = rinow.embedding_curvatures(Q)
    h = 1e-7
    slopes = []
    for column in range(6):
        moved = [rinow.embedding_curvatures(Q + sign * h * np.eye(6)[column]).values for sign in (1, -1)]
        slopes.append((moved[0] - moved[1]) / (2 * h))
    slopes = np.array(slopes)
    expected = np.abs(slopes).max(axis=0) * Q.max(axis=1)[:, None] ** 3
    mild = result.condition < 1e3  # central differences err by h² times a power of the condition
    assert mild.mean() > 0.5
    assert result.condition[mild] == pytest.approx(expected[mild], rel=1e-3)
    # A value scales with the inverse square of the distances: Euler's identity.
    euler = (slopes * Q.T[:, :, None]).sum(axis=0)
    assert euler[mild] == pytest.approx(-2 * result.values[mild], rel=1e-3, abs=1e-4)


def test_relations_of_linear_triples():
    rows = {
        "line": [1, 2, 3, 1, 2, 1],
        "line in another order": [2, 1, 1, 1, 3, 2],
        "circle": [1, 3, 2, 2, 3, 1],
        "tripod": [1, 1, 1, 2, 2, 2],
        "branch": [1, 1, 1, 2, 2, 1.5],
        "two points coincide": [0, 1, 1, 1, 1, 1.5],
        "one point": [0] * 6,
        "two pairs": [0, 1, 1, 1, 1, 0],
        "generic": [1, 1.1, 1.2, 1.3, 1.4, 1.7],
        "great circle of three": [2, 2, 1, 2, 1.1, 1.5],
    }
    result = rinow.embedding_curvatures(list(rows.values()))
    assert dict(zip(rows, result.count.tolist(), strict=True)) == {
        "line": -1,
        "line in another order": -1,
        "circle": 1,
        "tripod": 0,
        "branch": 0,
        "two points coincide": -1,
        "one point": -1,
        "two pairs": -1,
        "generic": 2,
        "great circle of three": 2,
    }
    is_linear = dict(zip(rows, rinow.is_linear(list(rows.values())).tolist(), strict=True))
    assert [name for name, flag in is_linear.items() if flag] == [
        "line",
        "line in another order",
        "one point",
        "two pairs",
    ]
    is_semidependent = dict(zip(rows, rinow.is_semidependent(list(rows.values())).tolist(), strict=True))
    assert [name for name, flag in is_semidependent.items() if flag] == ["circle", "tripod", "branch"]


def test_trees_have_one_value():
    rng = np.random.default_rng(27)
    leaf, middle = rng.uniform(0.1, 1, (200, 4)), rng.uniform(0, 1, 200)
    Q = leaf[:, I] + leaf[:, J] + middle[:, None] * ((I < 2) != (J < 2))
    result = rinow.embedding_curvatures(Q)
    assert (result.count == 1).all()
    assert (result.kind[:, 0] == "planar").all()
    # A share of 1e-9 more of the largest sum brings the second value back, far below.
    Q[:, 1] *= 1 + 1e-9
    result = rinow.embedding_curvatures(Q)
    assert (result.count == 2).all()
    assert (result.values[:, 0] < -10 / Q.max(axis=1) ** 2).all()


def test_three_points_on_a_great_circle():
    # The equator in three equal parts, and points at latitude h: at a pole they are at distance π/2 from all three.
    sphere = rinow.SpaceForm(1.0)
    third = 2 * math.pi / 3
    for h in (0.0, 0.4, 1.0, math.pi / 2):
        far = sphere.side(math.pi / 2 - h, math.pi / 2, [0.3, third - 0.3, third + 0.3])
        result = rinow.embedding_curvatures([third, third, far[0], third, far[1], far[2]])
        last = result.values[result.count - 1]
        assert last == pytest.approx(1, rel=1e-12)
        assert result.kind[result.count - 1] == "boundary"


def test_planarity_of_every_value():
    result = rinow.embedding_curvatures(DISTANCES)
    for m in range(2):
        has = (result.kind[:, m] != "") & (result.kind[:, m] != "boundary")
        planar = rinow.is_planar(DISTANCES[has], result.values[has, m])
        assert (planar == (result.kind[has, m] != "nonplanar")).all()
    square = [1, 2**0.5, 1, 1, 2**0.5, 1]
    assert rinow.is_planar(square, 2.892447948459)
    assert not rinow.is_planar(square, [-1.0, 0.0, 2.8, 3.0, 100.0]).any()
    assert not rinow.is_planar([0, 1, 1, 1, 1, 1.5], 0.0)
    assert not rinow.is_planar([np.nan] * 6, 0.0)
    assert rinow.is_planar([1, 2, 3, 1, 2, 1], 0.5)


def test_planar_quadruples_have_an_angle_sum_of_a_full_turn():
    Q = sampled(0.5, 1.0, 200, seed=28)
    result = rinow.embedding_curvatures(Q)
    for d, values in zip(Q, result.values, strict=True):
        # The naive angles lose half of the digits near 0 and π.
        assert max(naive.angle_sums(d, values[1])) == pytest.approx(2 * math.pi, abs=1e-6)
        assert max(naive.angle_sums(d, values[0])) < 2 * math.pi + 1e-6


def test_every_value_embeds():
    result = rinow.embedding_curvatures(DISTANCES)
    for d, values in zip(DISTANCES, result.values, strict=True):
        for k in values[np.isfinite(values)]:
            surface = rinow.SpaceForm(k)
            points = surface.embed(d)
            # The sixth distance follows from five: the error of k times its effect, 1e-13 at most in these rows.
            assert np.abs(surface.distance(points[I], points[J]) - d).max() <= 1e-12 * d.max()
