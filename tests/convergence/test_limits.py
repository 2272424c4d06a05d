"""Limits of sets, nets and graphs: Remark 2.20, Blaschke's theorem, Propositions 2.42 to 2.44, Remark 2.53."""

import itertools

import networkx as nx
import numpy as np
import pytest

import rinow
from naive.nets import circle
from shapes import icosphere, irregular_sphere

pytestmark = pytest.mark.usefixtures("compiled_searches")

SEGMENT = [[0, 1, 2]]


def interval(a, b):
    """The points of a line from a to b, as a face without area."""
    return np.array([[a, 0.0, 0.0], [b, 0.0, 0.0], [b, 0.0, 0.0]]), SEGMENT


# ------------------------------------------------------------------ sets


@pytest.mark.parametrize("n", [1, 4, 32, 1024])
def test_an_increasing_sequence_converges_to_the_closure_of_its_union(n):
    """[1/n, 1] has the union (0, 1]; the limit is [0, 1], which Remark 2.20 (1) (b) misses."""
    d = rinow.hausdorff_distance(interval(1 / n, 1), interval(0, 1), tolerance=1e-9)
    assert d.lower <= 1 / n <= d.upper
    assert d.upper <= 1 / n + 1e-8


@pytest.mark.parametrize("n", [1, 4, 32, 1024])
def test_a_decreasing_sequence_converges_to_its_intersection(n):
    d = rinow.hausdorff_distance(interval(-1 / n, 1 + 2 / n), interval(0, 1), tolerance=1e-9)
    assert d.lower <= 2 / n <= d.upper
    assert d.upper <= 2 / n + 1e-8


def test_every_point_of_a_limit_is_the_limit_of_points():
    """Remark 2.20 (2): the distances of the vertices of the limit from the sequence tend to 0."""
    target = icosphere(3)
    worst = []
    for n in (100, 400, 1600):
        s = irregular_sphere(n)
        d = rinow.hausdorff_distance((s.vertices, s.faces), (target.vertices, target.faces))
        worst.append(d.distances_b.max())
        assert worst[-1] <= d.upper
    assert worst[0] > 2 * worst[1] > 4 * worst[2]


def test_a_limit_of_convex_sets_is_convex():
    """Remark 2.20 (3) with a rate: midpoints of a set at distance r from a convex one are within 2 r of the set."""
    rng = np.random.default_rng(21)
    for n in (10, 40, 160):
        A = rng.uniform(size=(n, 3))
        A[:, 2] = np.round(A[:, 2])  # on two sides of the cube only: far from convex
        solid = np.stack(np.meshgrid(*[np.linspace(0, 1, 9)] * 3), axis=-1).reshape(-1, 3)
        # every point of the cube is within √3/16 of the grid
        r = rinow.hausdorff_distance(A, solid).upper + 3**0.5 / 16
        middle = (A[:, None] + A).reshape(-1, 3) / 2
        assert rinow.hausdorff_distance(middle, A).directed_a[1] <= 2 * r


def test_blaschke_among_many_sets_two_are_close():
    """The sets of a space with an ε-net of k points fall into 2^k - 1 classes; two in one class are within 2 ε."""
    rng = np.random.default_rng(22)
    space = rinow.MetricSpace.from_points(rng.uniform(size=(60, 2)))
    net = rinow.farthest_point_net(space, size=4)
    sets = [np.flatnonzero(rng.random(60) < 0.1) for _ in range(40)]
    sets = [A for A in sets if len(A)]
    classes = [frozenset(net.labels[A].tolist()) for A in sets]
    assert len(set(classes)) < len(sets)
    for (A, a), (B, b) in itertools.combinations(zip(sets, classes, strict=True), 2):
        if a == b:
            assert rinow.hausdorff_distance(A, B, space=space).upper <= 2 * net.covering_radius


def test_a_cauchy_sequence_of_sets_converges():
    """Completeness of the space of closed sets: the tails of Σ 2^-k."""
    sets = [np.cumsum(0.5 ** np.arange(n))[:, None] for n in range(1, 20)]
    gaps = [rinow.hausdorff_distance(A, B).upper for A, B in itertools.pairwise(sets)]
    np.testing.assert_allclose(gaps, 0.5 ** np.arange(1, 19), rtol=1e-9)
    limit = np.vstack([sets[-1], [[2.0]]])
    assert [rinow.hausdorff_distance(A, limit).upper for A in sets[:6]] == pytest.approx(
        [1, 0.5, 0.25, 0.125, 0.0625, 0.03125]
    )


# ------------------------------------------------------------------ nets


def cloud(n, seed):
    return rinow.MetricSpace.from_points(np.random.default_rng(seed).uniform(size=(n, 2)))


@pytest.mark.parametrize("seed", range(6))
def test_proposition_2_42_an_approximation_bounds_the_distance(seed):
    """ε-nets of one size whose distances differ by at most δ: d_GH ≤ 2 ε + δ/2 (printed: 2 ε + δ)."""
    X, Y = cloud(14, seed), cloud(11, 50 + seed)
    for size in (3, 6, 11):
        a, b = rinow.farthest_point_net(X, size=size), rinow.farthest_point_net(Y, size=size)
        epsilon = max(a.covering_radius, b.covering_radius)
        delta = rinow.distortion(np.stack([a.indices, b.indices], axis=1), X, Y)
        assert rinow.gromov_hausdorff(X, Y, time_limit=20).lower <= 2 * epsilon + delta / 2


@pytest.mark.parametrize("seed", range(6))
def test_proposition_2_42_a_distance_below_epsilon_gives_a_5_epsilon_approximation(seed):
    X, Y = cloud(14, seed), cloud(11, 50 + seed)
    result = rinow.gromov_hausdorff(X, Y, time_limit=20)
    epsilon = result.upper * (1 + 1e-9)
    image = dict(result.correspondence[::-1].tolist())  # the map of Corollary 2.37: any partner
    net = rinow.farthest_point_net(X, radius=epsilon)
    images = [image[int(x)] for x in net.indices]
    assert rinow.distortion(np.stack([net.indices, images], axis=1), X, Y) < 5 * epsilon
    assert rinow.is_epsilon_net(Y, images, 5 * epsilon)


def test_proposition_2_44_spaces_converge_exactly_when_nets_of_one_size_do():
    """Polygons with ever more corners and their arc metric converge to a circle, and so do nets of 6 points."""
    limit = rinow.MetricSpace(circle(96))
    net = rinow.farthest_point_net(limit, size=6)
    distances = []
    for n in (12, 24, 48):
        polygon = rinow.MetricSpace(circle(n))
        nearest = np.round(net.indices * n / 96).astype(int) % n
        S_n, S = polygon.subspace(nearest), limit.subspace(net.indices)
        d = rinow.gromov_hausdorff(S_n, S, time_limit=10)
        assert d.exact
        # back: the nets bound the distance of the spaces
        radius = polygon.distances[:, nearest].min(axis=1).max()
        whole = rinow.gromov_hausdorff(polygon, limit, time_limit=0.5)
        assert whole.lower <= d.upper + radius + net.covering_radius
        # forth: the images of an ε/2-net are an ε-net
        assert rinow.is_epsilon_net(polygon, nearest, 2 * net.covering_radius)
        distances.append(d.upper)
    assert distances[0] >= distances[1] >= distances[2]
    assert distances[2] <= np.pi / 48


# ------------------------------------------------------------------ length spaces and graphs


def test_length_defects_vanish_in_the_limit():
    """Theorem 2.50 on nets of a circle: the defect is that of neighbours, 2π/n."""
    for n in (8, 16, 32, 64):
        assert rinow.length_defect(circle(n)) == pytest.approx(2 * np.pi / n, rel=1e-12)


def test_graphs_with_bounded_edges_converge_to_a_finite_graph():
    """Remark 2.53 (1): tripods whose third leg shrinks converge to a segment, a graph with fewer edges."""
    for n in (1, 4, 16):
        graph = nx.Graph()
        for leg, length in enumerate((1.0, 1.0, 1.0 / n)):
            nx.add_path(graph, [0, *((leg, k) for k in range(4))], weight=length / 4)
        tripod = rinow.MetricSpace.from_graph(graph)
        nodes = list(graph.nodes)
        segment = [i for i, node in enumerate(nodes) if node == 0 or node[0] < 2]
        assert rinow.hausdorff_distance(range(len(nodes)), segment, space=tripod).upper == pytest.approx(1 / n)
        # the same bound holds between the spaces
        whole = rinow.gromov_hausdorff(tripod, tripod.subspace(segment), time_limit=10)
        assert whole.lower <= 1 / n


def bouquet(n):
    """Loops of lengths 2, 1, 1/2, ... at one vertex, each cut into 8 parts: its middle is a point."""
    graph = nx.Graph()
    for k in range(n):
        nx.add_cycle(graph, [0, *((k, j) for j in range(1, 8))], weight=2.0 ** (1 - k) / 8)
    return graph


def test_graphs_with_bounded_vertices_may_converge_to_an_infinite_graph():
    """Remark 2.53 (2): one vertex and ever more loops of lengths 2^(1-k) tend to infinitely many loops."""
    graph = bouquet(9)
    space, nodes = rinow.MetricSpace.from_graph(graph), list(graph.nodes)
    for n in range(1, 9):
        part = [i for i, node in enumerate(nodes) if node == 0 or node[0] < n]
        # the middle of the longest missing loop is half its length away
        assert rinow.hausdorff_distance(part, range(len(nodes)), space=space).upper == 2.0**-n
