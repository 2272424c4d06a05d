"""Lower bounds by clusters and holes: below the distance, equal to naive twins, known holes, when they are used."""

import math

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

from metric_shapes import polygon
from naive import persistence as naive
from rinow import gromov_hausdorff
from rinow.comparison import persistence
from rinow.comparison.bounds import diameter_bound, eccentricity_bound, packing_bound, single_linkage_bound
from rinow.comparison.clock import Clock
from rinow.comparison.engine import Engine
from rinow.comparison.gromov_hausdorff import first_interval
from rinow.comparison.persistence import NETS, bottleneck_bound, diagram, persistence_bound, raise_by_persistence

HOLES = pytest.mark.skipif(not persistence.gudhi_installed(), reason="the extra `persistence` is not installed")


def line(places):
    """Distances of points of the line."""
    return np.abs(np.subtract.outer(places, places))


def random_space(rng, n):
    """Points of a plane, of a line with repetitions, a polygon, or any metric with ratio 2."""
    kind = rng.integers(4)
    if kind == 0:
        return squareform(pdist(rng.random((n, 2)))) if n > 1 else np.zeros((1, 1))
    if kind == 1:
        return line(rng.integers(0, 5, n).astype(float))
    if kind == 2:
        return polygon(n)
    D = np.triu(rng.uniform(0.5, 1.0, (n, n)), 1)
    return D + D.T


def random_diagram(rng, *, births):
    return np.sort(rng.random((rng.integers(5), 2)), axis=1) * [births, 1.0]


def test_clusters_and_holes_lie_below_the_distance():
    """300 pairs; not by one bit above, since births and deaths are distances and rounding keeps the order."""
    rng = np.random.default_rng(271)
    dimensions = NETS if persistence.gudhi_installed() else ()
    for _ in range(300):
        X, Y = (random_space(rng, n) for n in rng.integers(1, 9, 2))
        distortion = 2 * gromov_hausdorff(X, Y, time_limit=math.inf).upper
        assert single_linkage_bound(X, Y) <= distortion
        for dimension in dimensions:
            assert persistence_bound(X, Y, dimension) <= distortion


def test_single_linkage_counts_clusters():
    """The least δ for which one space never has more clusters at t + δ than the other one at t."""
    rng = np.random.default_rng(272)
    for _ in range(40):
        X, Y = (random_space(rng, n) for n in rng.integers(1, 7, 2))
        bound, scales = single_linkage_bound(X, Y), np.unique(np.concatenate([X.ravel(), Y.ravel()]))
        above = bound + 1e-12  # t + bound is rounded
        for A, B in ((X, Y), (Y, X)):
            assert all(naive.clusters(B, t + above) <= naive.clusters(A, t) for t in scales)
        if bound > 1e-9:
            below = bound - 1e-9
            assert any(naive.clusters(B, t + below) > naive.clusters(A, t) for A, B in ((X, Y), (Y, X)) for t in scales)


def test_gap_in_a_segment_is_seen_by_single_linkage_alone():
    """Segments of length 20, one with a gap of 6 in its middle: distortion 5 at steps of 1."""
    X, Y = line(np.r_[np.arange(8.0), np.arange(13.0, 21.0)]), line(np.arange(21.0))
    assert single_linkage_bound(X, Y) == 5.0
    others = [bound(X, Y) for bound in (diameter_bound, eccentricity_bound, packing_bound)]
    assert max([*others, Engine(X, Y).row_bound]) <= 3.0
    result = gromov_hausdorff(X, Y, time_limit=math.inf)
    assert result.exact
    assert 2 * result.upper >= 5.0


@pytest.mark.parametrize("births", [0.0, 1.0])
def test_bottleneck_distance_equals_all_matchings(births):
    rng = np.random.default_rng(273)
    for _ in range(300):
        a, b = random_diagram(rng, births=births), random_diagram(rng, births=births)
        assert bottleneck_bound(a, b) == naive.bottleneck_distance(a.tolist(), b.tolist())


def test_diagrams_for_which_gudhi_gives_too_much():
    """Version 3.13 returns 0.3077, half of the greatest death."""
    a, b = (
        [(0.0, d) for d in deaths] for deaths in ((0.1734, 0.2370, 0.2975, 0.4819, 0.4841), (0.5215, 0.5252, 0.6153))
    )
    assert naive.bottleneck_distance(a, b) == 0.5215 - 0.2975
    assert bottleneck_bound(np.array(a), np.array(b)) == 0.5215 - 0.2975


@HOLES
@pytest.mark.parametrize("dimension", NETS)
def test_diagrams_equal_their_naive_twins(dimension):
    """Bit for bit: edge collapses and the filtration of GUDHI change no birth and no death."""
    rng, found = np.random.default_rng(274), 0
    for k in range(30):
        D = random_space(rng, int(rng.integers(1, 9))) if k else polygon(8)
        holes = naive.diagram(D.tolist(), dimension)
        assert sorted(map(tuple, diagram(D, dimension).tolist())) == holes
        found += len(holes)
    assert found


@HOLES
@pytest.mark.parametrize("n", [4, 7, 24, 100])
def test_hole_of_a_regular_polygon(n):
    """One hole, from one step to ⌈n/3⌉ steps (Adamaszek 2013); a segment has none."""
    C = polygon(n)
    assert diagram(C, 1).tolist() == [[C[0, 1], C[0, -(-n // 3)]]]
    S = line(np.linspace(0, math.pi, n))
    assert diagram(S, 1).shape == (0, 2)
    assert persistence_bound(C, S, 1) == 0.5 * (C[0, -(-n // 3)] - C[0, 1])


@HOLES
def test_octahedron_has_a_hole_of_dimension_two():
    D = np.where(np.arange(6)[:, None] % 3 == np.arange(6) % 3, 2.0, 1.0)
    np.fill_diagonal(D, 0.0)
    assert diagram(D, 2).tolist() == [[1.0, 2.0]]
    assert persistence_bound(D, np.zeros((1, 1)), 2) == 0.5


@HOLES
def test_nets_of_larger_spaces_lose_their_radii():
    """A circle and a segment of 301 points: below the hole of the circle, 2π/3, by the radii of the nets."""
    C, S = polygon(301), line(np.linspace(0, math.pi, 301))
    bound = persistence_bound(C, S, 1)
    assert math.pi / 3 - 6 * (2 * math.pi / 100) <= bound <= math.pi / 3
    assert persistence_bound(C, S, 1, lower=math.pi / 2) == 0.0  # no hole outlives the radius π


@HOLES
def test_raises_open_intervals_when_there_is_time(monkeypatch):
    C, S = polygon(30), np.zeros((1, 1))
    hole = 0.5 * (C[0, 10] - C[0, 1])

    def raised(seconds):
        interval = first_interval(C, S, 0.0)
        interval.lower, interval.by = 0.0, "non-negativity"
        raise_by_persistence(C, S, interval, Clock(seconds))
        return interval.lower, interval.by

    assert raised(math.inf) == (hole, "persistence")
    assert raised(0.5) == (0.0, "non-negativity")
    monkeypatch.setattr(persistence, "gudhi_installed", lambda: False)
    assert raised(math.inf) == (0.0, "non-negativity")
