"""Rinow curvature: model surfaces, theorems of Kirk, graphs, cones, errors of the distances."""

import math

import networkx as nx
import numba
import numpy as np
import pytest

import conformal
import rinow
from metric_shapes import cone, sampled
from quadruple_shapes import PAIRS, matrix
from rinow import rinow_curvature, rinow_point_curvature

SURFACE = conformal.Disk()


@pytest.mark.parametrize("k", [-1.0, 0.0, 1.0])
def test_model_surfaces_have_both_bounds(k):
    bounds = rinow_curvature(sampled(k, 40, seed=7))
    # A share of 1e-12 moves a bound by 200e-12/diameter² at a well-shaped quadruple of diameter 1.
    assert k - 1e-13 <= bounds.lower <= k + 1e-9
    assert k - 1e-9 <= bounds.upper <= k + 1e-13


def test_bounds_hold_for_all_errors_below_rtol():
    rng = np.random.default_rng(7)
    for k in (-1.0, 1.0):
        D = sampled(k, 30, seed=8)
        noise = np.triu(rng.uniform(-1e-4, 1e-4, D.shape), 1)
        noisy = rinow.MetricSpace(D * (1 + noise + noise.T), rtol=1e-3)
        bounds = rinow_curvature(noisy, rtol=1e-4)
        assert bounds.upper <= k <= bounds.lower
        assert bounds.lower - bounds.upper < 0.1  # 400 rtol/diameter² with room


def test_bounds_lie_between_the_extremes_of_gaussian_curvature():
    P = SURFACE.sample(30, 0.2, seed=7)
    D = SURFACE.distances(P)
    bounds, few = rinow_curvature(D), rinow_curvature(D[:15, :15])
    disk = 0.21 * np.stack([np.cos(u := np.linspace(0, 2 * np.pi, 200)), np.sin(u)], axis=1)
    K = SURFACE.curvature(np.concatenate([disk * s for s in np.linspace(0, 1, 50)]))
    assert K.min() <= bounds.lower <= few.lower
    assert few.upper <= bounds.upper <= K.max()
    # 30 points have seen most of it: K at the points themselves, less what a quadruple averages.
    seen = SURFACE.curvature(P)
    assert bounds.lower < 0.6 * seen.min() + 0.4 * seen.mean()
    assert bounds.upper > 0.6 * seen.max() + 0.4 * seen.mean()


def test_witnesses_show_the_bounds():
    D = SURFACE.distances(SURFACE.sample(20, 0.2, seed=9))
    bounds = rinow_curvature(D)
    lower, upper = np.array(bounds.lower_witness), np.array(bounds.upper_witness)
    assert rinow_curvature(D, lower).lower == pytest.approx(bounds.lower, rel=1e-11)
    assert rinow_curvature(D, upper).upper == pytest.approx(bounds.upper, rel=1e-11)
    p, q, r, s = lower
    around = [rinow.SpaceForm(bounds.lower).angle(D[a, b], D[p, a], D[p, b]) for a, b in ((q, r), (r, s), (s, q))]
    assert sum(around) == pytest.approx(2 * math.pi, abs=1e-9)
    sixes = [D[w][:, w][PAIRS] for w in (lower, upper)]
    values = rinow.embedding_curvatures(sixes).values
    # The default error of 1e-12 moves the value of a thin quadruple of diameter 0.4 by up to 1e-6.
    assert (values[0, 1], values[1, 0]) == pytest.approx((bounds.lower, bounds.upper), abs=1e-5)


def test_trees_branch_and_circles_close():
    tree = rinow_curvature(nx.balanced_tree(2, 3))
    assert (tree.lower, tree.upper) == (-math.inf, -math.inf)
    for n in (5, 6, 9):
        circle = rinow_curvature(nx.cycle_graph(n), rtol=0.0)
        # The longest triangle goes round the circle of length n; at n = 5 the longest has 2 + 2 + 1.
        assert circle.lower == pytest.approx((2 * math.pi / n) ** 2, rel=1e-12)
        assert circle.upper <= circle.lower * (1 + 1e-12)
    even = rinow_curvature(nx.cycle_graph(6), rtol=0.0)
    assert even.upper == pytest.approx(even.lower, rel=1e-12)


def test_space_has_rinow_curvature_zero():
    grid = np.indices((3, 3, 3)).reshape(3, -1).T
    bounds = rinow_curvature(grid)
    assert (bounds.lower, bounds.upper) == pytest.approx((0, 0), abs=1e-10)
    points = np.random.default_rng(7).uniform(-1, 1, (100, 3))
    bounds = rinow_curvature(points)
    assert -1e-12 < bounds.lower < 1e-3  # of four million tetrahedra, some are almost flat
    assert -1e-3 < bounds.upper < 1e-12
    at = rinow_point_curvature(points, 0, radius=1.0)
    assert at.exists
    assert abs(at.value) <= max(at.standard_error, 1e-9) < 0.1


def test_bounds_of_one_to_three_points():
    nothing = rinow_curvature([[0.0]])
    assert (nothing.lower, nothing.upper, nothing.lower_witness, nothing.n_points) == (math.inf, -math.inf, (), 1)
    triangle = rinow_curvature([[0, 1, 1], [1, 0, 1], [1, 1, 0]], rtol=0.0)
    assert triangle.lower == pytest.approx((2 * math.pi / 3) ** 2)
    assert triangle.lower_witness == (0, 2, 1)
    twice = rinow_curvature(np.array([[0, 0], [0, 0], [1, 0], [0, 1], [1, 1]]))
    assert twice.n_points == 4
    assert (twice.lower > 0) and twice.upper == pytest.approx(0, abs=1e-10)


def test_curvature_at_a_point_is_gaussian_curvature():
    P = SURFACE.sample(30, 0.2, seed=11)
    D = SURFACE.distances(P)
    at = rinow_point_curvature(D, 0, radius=0.3)
    assert at.exists
    assert at.value == pytest.approx(SURFACE.curvature(P[0]), abs=2 * at.standard_error)
    # Half of what the bounds change by between three balls of radius 0.07 to 0.15, where the curvature has slope 6.
    assert at.standard_error < 0.8
    assert [ball.n_points for ball in at.balls] == sorted([ball.n_points for ball in at.balls], reverse=True)
    # Fewer points contradict less.
    lowers, uppers = [b.lower for b in at.balls], [b.upper for b in at.balls]
    assert lowers == sorted(lowers)
    assert uppers == sorted(uppers, reverse=True)


@pytest.mark.parametrize("angle", [4.0, 5.0, 7.5])
def test_no_curvature_at_a_cone_point(angle):
    assert not rinow_point_curvature(cone(angle, 40, seed=7), 0, radius=1.0).exists
    beside = rinow_curvature(cone(angle, 60, seed=7))
    # A missing angle is positive curvature, an excess negative; the flat part has 0.
    assert (beside.upper > 1 and beside.lower > -1e-6) if angle < 2 * np.pi else (beside.lower < -1)


def test_isolated_point_has_no_value():
    at = rinow_point_curvature([[0, 0], [9, 9], [9, 8]], 0, radius=1.0)
    assert math.isnan(at.value)
    assert not at.exists
    assert len(at.balls) == 1


def test_ball_and_list_of_points_choose_the_region():
    D = sampled(1.0, 30, seed=7)
    inside = np.flatnonzero(D[3] <= 0.4)
    ball, listed = rinow_curvature(D, 3, radius=0.4), rinow_curvature(D, inside)
    assert ball.n_points == listed.n_points == len(inside)
    assert set(ball.lower_witness) <= set(inside.tolist())
    assert ball.lower == pytest.approx(listed.lower, rel=1e-12)


def test_large_regions_are_sampled_evenly():
    D = sampled(0.0, 60, seed=7)
    bounds = rinow_curvature(D, max_points=20)
    assert bounds.n_points == 20
    assert (bounds.lower, bounds.upper) == pytest.approx((0, 0), abs=1e-9)


def test_same_bits_on_one_and_two_threads():
    D, threads = sampled(-1.0, 30, seed=7), numba.get_num_threads()
    both = rinow_curvature(D)
    numba.set_num_threads(1)
    try:
        assert rinow_curvature(D) == both
    finally:
        numba.set_num_threads(threads)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"points": [0, 1], "radius": 1.0}, "a ball has one centre"),
        ({"points": 0}, "a ball has one centre"),
        ({"points": 0, "radius": -1.0}, "radius > 0"),
        ({"points": 7, "radius": 1.0}, "points = 7|outside 0..3"),
        ({"points": []}, "points is empty"),
        ({"radius": 1.0}, "a ball has one centre"),
    ],
)
def test_faults_are_named(arguments, message):
    with pytest.raises(rinow.InvalidInputError, match=message):
        rinow_curvature(matrix([1] * 6), **arguments)


def test_disconnected_graph_is_refused():
    with pytest.raises(rinow.NotAMetricError, match="no path"):
        rinow_curvature(nx.Graph([(0, 1), (2, 3)]))
    space = rinow.MetricSpace.from_graph(nx.Graph([(0, 1), (2, 3)]), infinite=True)
    with pytest.raises(rinow.InvalidInputError, match="not all connected"):
        rinow_curvature(space)
