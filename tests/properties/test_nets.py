"""Nets and their graphs against naive twins; packing, Gonzalez' factor, Theorems 2.50 and 2.51."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rinow
from naive import nets as naive
from rinow.metric_space import MetricSpace

POINTS = st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=1, max_size=14)


CIRCLE = MetricSpace(naive.circle(360))


def space_of(points):
    return MetricSpace.from_points(np.array(points, float))


@given(POINTS, st.data())
def test_nets_equal_their_naive_twin(points, data):
    space, n = space_of(points), len(points)
    size, start = data.draw(st.integers(1, n)), data.draw(st.integers(0, n - 1))
    net = rinow.farthest_point_net(space, size=size, start=start)
    indices, radii = naive.farthest_points(space.distances.tolist(), size, start)
    assert net.indices.tolist() == indices
    assert net.radii.tolist() == radii
    assert net.covering_radius == naive.covering_radius(space.distances.tolist(), indices)
    np.testing.assert_array_equal(net.distances, space.distances[net.indices[net.labels], np.arange(n)])
    assert rinow.is_epsilon_net(space, net.indices, net.covering_radius)
    if net.covering_radius > 0:
        assert not rinow.is_epsilon_net(space, net.indices, np.nextafter(net.covering_radius, 0))


@given(POINTS)
def test_nets_are_packings(points):
    """The first k points are radii[k - 2] apart, so at least as far as the covering radius."""
    space = space_of(points)
    net = rinow.farthest_point_net(space, size=len(points))
    for k in range(2, len(points) + 1):
        among = space.subspace(net.indices[:k]).distances[np.triu_indices(k, 1)]
        assert among.min() >= net.radii[k - 2] >= net.radii[k - 1]


@settings(max_examples=30)
@given(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=1, max_size=8), st.integers(1, 3))
def test_no_net_of_as_many_points_is_twice_as_good(points, size):
    space, size = space_of(points), min(size, len(points))
    best = min(
        naive.covering_radius(space.distances.tolist(), net) for net in itertools.combinations(range(len(points)), size)
    )
    assert best <= rinow.farthest_point_net(space, size=size).covering_radius <= 2 * best


@given(POINTS)
def test_length_defect_equals_its_naive_twin(points):
    space = space_of(points)
    assert rinow.length_defect(space) == naive.length_defect(space.distances.tolist())


@given(POINTS, st.data())
def test_midpoints_equal_their_definition(points, data):
    space, n = space_of(points), len(points)
    x, y = data.draw(st.integers(0, n - 1)), data.draw(st.integers(0, n - 1))
    epsilon = data.draw(st.floats(0, 10))
    D = space.distances.tolist()
    expected = [z for z in range(n) if naive.defect(D, x, y, z) <= epsilon]
    assert rinow.midpoints(space, x, y, epsilon=epsilon).tolist() == expected


@given(POINTS, st.floats(0.5, 8), st.data())
def test_graphs_equal_their_naive_twin(points, epsilon, data):
    space = space_of(points)
    chosen = data.draw(st.lists(st.integers(0, len(points) - 1), min_size=1, max_size=8, unique=True))
    D = space.distances.tolist()
    result = rinow.epsilon_graph(space, epsilon, indices=chosen)
    # sums of edges in another order
    assert result.error_bound == pytest.approx(naive.error(D, chosen, epsilon), abs=1e-13)
    inner = rinow.intrinsic_metric(space, epsilon, indices=chosen, infinite=True)
    np.testing.assert_allclose(inner.distances, naive.chain_lengths(D, chosen, epsilon), rtol=1e-15)


@settings(max_examples=25)
@given(st.integers(0, 10**6), st.floats(0.3, 2.5))
def test_theorem_2_51_on_a_circle(seed, epsilon):
    """Random nets with δ < ε²/(4 diam): d_X ≤ d_G ≤ d_X + ε.  The diameter of the circle is π."""
    n, rng = len(CIRCLE), np.random.default_rng(seed)
    fine = epsilon**2 / (4 * np.pi)
    gaps = max(int(2 * fine / (2 * np.pi / n)) - 1, 1)
    net = np.cumsum(rng.integers(max(gaps // 2, 1), gaps + 1, n))
    net = np.concatenate([[0], net[net < n]])
    # the circle itself, not its 360 points: between two points of the net nobody is farther than half the gap
    delta = np.diff([*net, n]).max() * np.pi / n
    if delta >= fine:
        return
    result = rinow.epsilon_graph(CIRCLE, epsilon, indices=net)
    assert result.delta <= delta * (1 + 1e-12)
    assert result.is_fine_enough
    assert -1e-12 <= result.error_bound <= epsilon


def test_theorem_2_51_on_a_sphere():
    """Great-circle distances of points of a sphere, whose covering radius is measured on a finer sample."""
    rng, epsilon = np.random.default_rng(12), 1.5
    P = rng.normal(size=(1500, 3))
    P /= np.linalg.norm(P, axis=1)[:, None]
    D = np.arccos(np.clip(P @ P.T, -1, 1))
    np.fill_diagonal(D, 0)
    space = MetricSpace((D + D.T) / 2)
    result = rinow.epsilon_graph(space, epsilon)
    assert result.delta < epsilon**2 / (4 * space.diameter)
    assert 0 <= result.error_bound < epsilon


@given(st.integers(0, 10**6), st.integers(2, 12), st.floats(0, 0.5))
def test_theorem_2_50_a_limit_inherits_midpoints(seed, n, amount):
    """A correspondence of distortion r changes the length defect by 3 r at most."""
    rng = np.random.default_rng(seed)
    D, E = (space_of(rng.uniform(0, 9, (n, 2))).distances for _ in range(2))
    near = D + amount * E  # a sum of two metrics is a metric
    change = abs(rinow.length_defect(near) - rinow.length_defect(D))
    assert change <= 3 * amount * E.max() + 1e-12
