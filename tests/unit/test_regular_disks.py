"""Regular disks: closed forms, the naive twin, and what the paper proves of them (3.24 to 3.27)."""

import math
from itertools import combinations

import networkx as nx
import numpy as np
import pytest

import rinow
from metric_shapes import sampled
from naive import regular_disks as naive
from quadruple_shapes import PAIRS
from rinow import regular_radius
from rinow.kernels import spaceform_model


def with_side_points(k, radius, seed):
    """Points in a disk of S_k around 0, midpoints of all pairs of 1 to 6, one quarter point; and these pairs."""
    surface, rng = rinow.SpaceForm(k), np.random.default_rng(seed)
    points = np.concatenate([np.zeros((1, 3)), surface.sample(6, radius, rng)])
    pairs = np.array(list(combinations(range(1, 7), 2)))
    middles = np.array([midpoint(points[i], points[j], k) for i, j in pairs])
    points = np.concatenate([points, middles, [midpoint(points[1], middles[0], k)]])
    D = surface.distance(points[:, None], points)
    D = 0.5 * (D + D.T)
    for m, (i, j) in enumerate(pairs, 7):
        D[m, [i, j]] = D[[i, j], m] = 0.5 * D[i, j]
    D[-1, [1, 7, 2]] = D[[1, 7, 2], -1] = D[1, 2] * np.array([0.25, 0.25, 0.75])
    return D, pairs


def midpoint(p, q, k):
    """The middle of two points in model coordinates: the mean, moved to the quadric along the line from its centre."""
    if k == 0:
        mean = 0.5 * (p + q)
        return np.array([mean[0], mean[1], 0.5 * (mean[0] ** 2 + mean[1] ** 2)])
    centre = np.array([0, 0, 1 / k])
    mean = 0.5 * (p + q) - centre
    return centre + mean / math.sqrt(k * mean[:2] @ mean[:2] + (k * mean[2]) ** 2)


def quadruples(D):
    Q = np.array(list(combinations(range(len(D)), 4)))
    return np.stack([D[Q[:, i], Q[:, j]] for i, j in zip(*PAIRS, strict=True)], axis=1)


@pytest.mark.parametrize("k", [-4.0, 1.0, 9.0])
def test_model_surfaces_have_the_radius_of_a_quarter_of_pi(k):
    expected = math.pi / (4 * math.sqrt(abs(k)))
    D = sampled(k, 40, 7, radius=2 * expected)
    assert regular_radius(D, 0) == pytest.approx(expected, rel=1e-6)


def test_flat_disks_are_all_regular():
    assert regular_radius(np.random.default_rng(7).uniform(-1, 1, (40, 2)), 0) == math.inf
    assert regular_radius([[0.0]], 0) == math.inf


def test_radius_agrees_with_the_naive_twin():
    for seed in range(10, 16):
        points = np.random.default_rng(seed).uniform(-1, 1, (8, 3))
        D = np.linalg.norm(points[:, None] - points, axis=2)

        def curvature(Q, D=D):
            values = rinow.embedding_curvatures(D[np.ix_(Q, Q)][PAIRS]).values
            return np.nanmin(np.abs(values), initial=np.inf)

        expected = naive.regular_radius(D.tolist(), curvature)
        assert regular_radius(D, 0) == pytest.approx(expected, rel=1e-9)


def test_disks_end_where_a_graph_branches():
    spider = nx.star_graph(3)
    nx.add_path(spider, [3, 4, 5])
    assert regular_radius(spider, 5) == 4  # two legs of the star are at distance 4
    assert regular_radius(spider, 0) == 1
    assert regular_radius(nx.path_graph(6), 2) == math.inf


def test_larger_spaces_are_sampled():
    D = sampled(1.0, 150, 7, radius=1.5)
    assert regular_radius(D, 0, max_points=20) == pytest.approx(math.pi / 4, rel=1e-6)


def test_point_out_of_range_is_refused():
    with pytest.raises(rinow.InvalidInputError, match=r"outside 0\.\.1"):
        regular_radius([[0, 1], [1, 0]], 2)


# ------------------------------------------------------------------ propositions of the paper, in compact convex disks


@pytest.mark.parametrize("k", [-1.0, 0.0, 1.0])
def test_two_linear_triples_make_a_quadruple_linear(k):
    # 3.24, and 3.25: not every triple is linear.
    D, _ = with_side_points(k, radius=0.6, seed=7)
    assert regular_radius(D, 0) > 0.6
    sixes = quadruples(D)
    triples = [[0, 1, 3], [0, 2, 4], [1, 2, 5], [3, 4, 5]]
    sides = np.sort(sixes[:, triples], axis=2)
    n_linear = (np.abs(sides[..., 0] + sides[..., 1] - sides[..., 2]) < 1e-13).sum(axis=1)
    assert set(n_linear.tolist()) == {0, 1, 4}
    assert rinow.is_linear(sixes).tolist() == (n_linear == 4).tolist()


def test_two_linear_triples_without_regularity():
    star = rinow.MetricSpace.from_graph(nx.star_graph(3)).distances
    assert not rinow.is_linear(star[PAIRS])
    assert regular_radius(star, 0) == 1


@pytest.mark.parametrize("k", [-1.0, 0.0, 1.0])
def test_regular_disks_are_strictly_convex_and_shortest_paths_unique(k):
    # 3.26: the middle of two points is nearer to the centre than the farther one.  3.27: a point in the middle
    # is the middle: those with almost the same distances are close to it.
    D, pairs = with_side_points(k, radius=0.6, seed=9)
    assert regular_radius(D, 0) > 0.6
    for m, (i, j) in enumerate(pairs, 7):
        assert D[0, m] < max(D[0, i], D[0, j])
    dense = sampled(k, 400, 7, radius=0.6)
    dense = dense[np.ix_(dense[0] < 0.6, dense[0] < 0.6)]
    far = np.argwhere(np.triu(dense > 0.5))[::50]
    for q, r in far:
        excess = np.maximum(dense[q], dense[r]) - 0.5 * dense[q, r]
        middle = np.flatnonzero(excess < 0.01)
        # Height over the side: √(2 · 0.5 · 0.01) in the plane, less than a half more here; twice that between two.
        assert dense[np.ix_(middle, middle)].max(initial=0) < 2 * 1.5 * 0.1


def test_shortest_paths_are_not_unique_beyond_a_regular_disk():
    equator = 2 * np.pi * np.arange(8) / 8
    points = np.empty((9, 3))
    for i, (r, theta) in enumerate([(0.0, 0.0), *((math.pi / 2, u) for u in equator)]):
        spaceform_model.place(r, theta, 1.0, points[i])
    D = rinow.SpaceForm(1.0).distance(points[:, None], points)
    D = 0.5 * (D + D.T)
    q, r = 1, 5  # opposite points
    middles = np.flatnonzero(np.isclose(D[q], math.pi / 2) & np.isclose(D[r], math.pi / 2))
    assert D[np.ix_(middles, middles)].max() == pytest.approx(math.pi)
    assert regular_radius(D, 0) <= math.pi / 2
