"""Relations of all vertices of meshes: bounds by rows of some pairs, eccentricities of all, rows of several nodes."""

import math

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra

from clocks import SLOW, Looks
from rinow import TriangleMesh, distortion, gromov_hausdorff
from rinow.comparison import surfaces
from rinow.comparison.clock import Clock
from rinow.comparison.surfaces import sample_of
from rinow.comparison.whole_eccentricities import Eccentricities, gap_of_eccentricities
from rinow.comparison.whole_meshes import WholeRelation
from rinow.geodesics.edge_graph import edge_graph
from rinow.kernels import distortion_bounds

pytestmark = pytest.mark.usefixtures("compiled_searches")

FOREVER = Clock(math.inf)


def sheet(n, height=0.0, seed=40):
    """An uneven sheet of n by n vertices, lifted in its middle."""
    u, v = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="ij"))
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    k = i * n + j
    faces = np.concatenate([np.stack([k, k + n, k + n + 1], axis=1), np.stack([k, k + n + 1, k + 1], axis=1)])
    u, v = np.stack([u, v]) + np.random.default_rng(seed).uniform(-0.2, 0.2, (2, n * n)) / n
    return np.stack([u, v, height * np.sin(math.pi * u) * np.sin(math.pi * v)], axis=1), faces


def small_net(monkeypatch, mesh, size=8):
    """A net of a mesh, and all distances of its vertices in the order of the rows of its metric."""
    full = sample_of(mesh, FOREVER, FOREVER, FOREVER).distances
    monkeypatch.setattr(surfaces, "ALL_VERTICES", 10)
    monkeypatch.setattr(surfaces, "LARGEST_NET", size)
    net = sample_of(mesh, FOREVER, FOREVER, FOREVER)
    monkeypatch.undo()
    return net, full[np.ix_(net.metric.order, net.metric.order)]


def test_rows_are_those_of_dijkstra(monkeypatch):
    mesh = TriangleMesh(*sheet(9, 0.7))
    net, full = small_net(monkeypatch, mesh)
    metric = net.metric
    expected = dijkstra(edge_graph(mesh))
    assert (metric.rows(np.arange(81), FOREVER) == expected[np.ix_(metric.order, metric.order)]).all()
    assert (metric.row(5) == expected[5]).all()
    group = np.array([[3, 4, 12, 13, 14, 40, 80, 3]])  # near and far, one of them twice
    found, low, high = np.empty((1, 8)), np.zeros((1, 81)), np.full((1, 81), np.inf)
    distortion_bounds.bound_eccentricities(group, metric.graph, metric.step, found, low, high)
    true = full.max(axis=1)
    assert found[0] == pytest.approx(true[group[0]], rel=1e-14)
    assert (low[0] <= true * (1 + 1e-12)).all() and (true <= high[0] * (1 + 1e-12)).all()
    assert high[0, 40] == found[0, 5]


@pytest.mark.parametrize("looks", [1, 2, 4, 1000])
def test_bounds_by_some_rows_hold_for_all_pairs_and_become_exact(monkeypatch, looks):
    (X, DX), (Y, DY) = (small_net(monkeypatch, sheet(7, height)) for height in (0.0, 0.9))
    rng = np.random.default_rng(41)
    f, g = rng.integers(49, size=49), rng.integers(49, size=49)
    relation = WholeRelation(X.metric, Y.metric, f, g, (8, X.covering_radius))
    relation.know(DX[7], DY[9])  # no pair of the relation
    relation.improve(Looks(looks))
    pairs = np.stack([relation.xs, relation.ys], axis=1)
    gaps = np.abs(DX[np.ix_(relation.xs, relation.xs)] - DY[np.ix_(relation.ys, relation.ys)])
    assert (gaps.max(axis=1) <= relation.bounds * (1 + 1e-12)).all()
    assert relation.seen <= distortion(pairs, DX, DY) * (1 + 1e-12) <= relation.upper * (1 + 1e-11)
    if looks == 1000:
        assert relation.upper == pytest.approx(gaps.max(), rel=1e-11)


@pytest.mark.parametrize("looks", [0, 1, 3, 100])
def test_gap_of_eccentricities_is_never_more_than_that_of_all_and_comes_near_it(monkeypatch, looks):
    (X, DX), (Y, DY) = (small_net(monkeypatch, sheet(8, height), 5) for height in (0.0, 1.2))
    a, b = DX.max(axis=1), DY.max(axis=1)
    apart = np.abs(a[:, None] - b)
    true = max(apart.min(axis=1).max(), apart.min(axis=0).max())
    sides = [Eccentricities.of(sample, sample.metric) for sample in (X, Y)]
    gap = gap_of_eccentricities(*sides, 0.0, Looks(looks))
    assert gap <= true * (1 + 1e-12)
    if looks == 100:
        known = np.abs(b - sides[0].known[:, None]).min(axis=1).max()
        assert gap >= 0.9 * known > 0.5 * true
    for radii, loss in (((0.01, 0.03), 0.06), ((0.03, 0.01), 0.04)):  # eccentricities of X are missed in Y
        assert gap_of_eccentricities(*sides, 0.0, Looks(0), radii) == pytest.approx(gap - loss, rel=1e-12)


@SLOW
@pytest.mark.parametrize("seconds", [8, 1])
def test_whole_relation_is_better_than_nets_and_holds(monkeypatch, seconds):
    A, B = sheet(16), sheet(16, 0.8)
    exact = gromov_hausdorff(A, B, time_limit=10)
    full = [sample_of(mesh, FOREVER, FOREVER, FOREVER).distances for mesh in (A, B)]
    monkeypatch.setattr(surfaces, "ALL_VERTICES", 10)
    monkeypatch.setattr(surfaces, "LARGEST_NET", 30)
    result = gromov_hausdorff(A, B, time_limit=seconds)
    assert result.lower <= exact.lower <= exact.upper <= result.upper
    if seconds > 1:  # less may not suffice on a busy machine; what was found then holds all the same
        pairs = result.correspondence
        assert result.covering_radii == (0.0, 0.0)
        assert set(pairs[:, 0]) == set(pairs[:, 1]) == set(range(256))
        assert distortion(pairs, *full) / 2 == pytest.approx(result.upper, rel=1e-11)  # all rows: few vertices
    beyond = gromov_hausdorff(A, B, time_limit=seconds, covering_radii=(0.1, 0.02))
    assert beyond.lower <= exact.lower and beyond.upper >= exact.upper
    if seconds > 1:
        assert beyond.covering_radii == (0.1, 0.02)
        assert beyond.upper >= result.upper
