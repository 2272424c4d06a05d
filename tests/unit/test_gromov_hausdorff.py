"""Gromov-Hausdorff distance: brute force, closed forms, certificates, anytime bounds, bad input."""

import json
import math
from functools import partial
from pathlib import Path

import numba
import numpy as np
import pytest
from scipy.sparse.csgraph import shortest_path
from scipy.spatial.distance import pdist, squareform

from naive import correspondences as naive
from rinow import MetricSpace, distortion, gromov_hausdorff
from rinow.comparison import steps
from rinow.comparison.bounds import diameter_bound, eccentricity_bound, packing_bound
from rinow.comparison.clock import Clock
from rinow.comparison.engine import Engine
from rinow.comparison.gromov_hausdorff import first_interval
from rinow.comparison.level_search import LevelSearch
from rinow.comparison.levels import Levels
from rinow.comparison.relaxation import relaxed_maps
from rinow.comparison.satisfiability import Satisfiability
from rinow.comparison.symmetry import isometries
from rinow.errors import InvalidInputError, NotAMetricError

GOLDEN = json.loads((Path(__file__).parents[1] / "golden" / "gromov_hausdorff.json").read_text())
SLOW = pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes")

unlimited = partial(gromov_hausdorff, time_limit=math.inf)
"""What a test expects to be exact must not depend on the speed of the machine."""


def hops(rng, n, share=0.3):
    """Numbers of steps in a random tree with further edges."""
    edges = np.triu((rng.random((n, n)) < share).astype(float), 1)
    for i in range(1, n):
        edges[rng.integers(i), i] = 1.0
    return shortest_path(edges, directed=False, unweighted=True)


def random_space(rng, n):
    """Distances of n random points: plane, line with repeated points, hops in a graph, or generic."""
    kind = rng.integers(4)
    if kind == 0:
        return squareform(pdist(rng.random((n, 2)))) if n > 1 else np.zeros((1, 1))
    if kind == 1:
        places = rng.integers(0, 5, n).astype(float)
        return np.abs(places[:, None] - places)
    if kind == 2:
        return hops(rng, n)
    D = rng.uniform(0.5, 1.0, (n, n))
    D = np.minimum(D, D.T)
    np.fill_diagonal(D, 0.0)
    return D


def polygon(n):
    """Vertices of a regular polygon with the arc metric of the unit circle."""
    steps = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    return np.minimum(steps, n - steps) * (2 * math.pi / n)


def segment(n, length):
    """Equally spaced points of a segment."""
    return np.abs(np.subtract.outer(*[np.linspace(0, length, n)] * 2))


def check_certificate(result, X, Y):
    """The correspondence covers both spaces, and half its distortion is the upper bound."""
    assert set(result.correspondence[:, 0]) == set(range(len(X)))
    assert set(result.correspondence[:, 1]) == set(range(len(Y)))
    assert distortion(result.correspondence, X, Y) == 2 * result.upper
    assert 0 <= result.lower <= result.upper


@pytest.mark.parametrize("seed", range(60, 90))
def test_equals_brute_force(seed):
    rng = np.random.default_rng(seed)
    X, Y = (random_space(rng, n) for n in rng.integers(1, 5, 2))
    result = unlimited(X, Y)
    check_certificate(result, X, Y)
    assert result.exact
    assert result.lower == result.upper == naive.least_distortion(X.tolist(), Y.tolist()) / 2


@pytest.mark.parametrize("case", GOLDEN, ids=lambda case: str(case["name"]))
def test_values_of_closed_forms_are_found_and_proved(case):
    X, Y = np.array(case["DX"]), np.array(case["DY"])
    result = unlimited(X, Y)
    check_certificate(result, X, Y)
    assert result.exact
    assert abs(result.upper - case["value"]) <= 1e-12  # the closed forms are rounded


@pytest.mark.parametrize("m", [4, 8, 12])
def test_polygon_and_next_polygon(m):
    """Regular m-gon and (m+1)-gon are at distance π/(m + 1)."""
    result = unlimited(polygon(m), polygon(m + 1))
    assert result.exact
    assert abs(result.upper - math.pi / (m + 1)) < 1e-12


@SLOW
def test_polygon_and_segment_need_clause_learning():
    """A circle is not a segment: parity forbids what arc consistency lets pass."""
    X, Y = polygon(16), segment(17, math.pi)
    interval, engine, clock = first_interval(X, Y, 0.0), Engine(X, Y), Clock(math.inf)
    symmetries = isometries(X, clock), isometries(Y, clock)
    steps.warm_start(engine, interval, clock)
    steps.satisfiability(engine, interval, clock, engine.row_levels <= interval.upper, symmetries)
    assert interval.exact
    assert interval.by == "satisfiability"
    assert distortion(interval.pairs, X, Y) == interval.upper


@SLOW
@pytest.mark.parametrize("n", [30, 60])
def test_random_clouds_are_closed(n):
    rng = np.random.default_rng(n)
    X, Y = MetricSpace.from_points(rng.random((n, 2))), MetricSpace.from_points(rng.random((n - 5, 2)))
    result = unlimited(X, Y)
    check_certificate(result, X, Y)
    assert result.exact
    again = unlimited(Y, X)
    assert again.upper == result.upper


@SLOW
def test_noisy_shuffled_copy():
    rng = np.random.default_rng(24)
    points = rng.random((80, 2))
    X = MetricSpace.from_points(points)
    Y = MetricSpace.from_points(rng.permutation(points) + rng.normal(0, 0.003, points.shape))
    result = unlimited(X, Y)
    assert result.exact
    assert result.upper < 0.02  # twice the largest of 160 normal deviates


def test_relaxed_maps_find_noisy_copies_of_spaces_without_coordinates():
    """From both starts together, in at least one of two copies; tabu search alone finds neither."""
    found = 0
    for seed in (0, 1):
        rng = np.random.default_rng(seed + 300)
        D, noise = rng.uniform(0.5, 1.0, (60, 60)), rng.uniform(0.0, 0.01, (60, 60))
        D = squareform(squareform(D, checks=False))
        copy = squareform(squareform(D + noise, checks=False))
        order = rng.permutation(60)
        copy = np.clip(copy, 0.5, 1.0)[np.ix_(order, order)]
        np.fill_diagonal(copy, 0.0)
        maps = relaxed_maps(D, copy, Engine(D, copy).row_levels, Clock(math.inf))
        found += any(distortion(np.stack([np.arange(60), f], axis=1), D, copy) <= 0.01 for f, _ in maps)
    assert found >= 1


def test_relaxed_maps_of_unequal_and_coincident_points():
    X, Y = segment(3, 2.0), np.zeros((5, 5))
    for f, g in relaxed_maps(X, Y, np.zeros((3, 5)), Clock(math.inf)):
        assert f.shape == (3,) and g.shape == (5,)
        assert len(set(f.tolist())) == 3
    assert not list(relaxed_maps(X, Y, np.zeros((3, 5)), Clock(0.0)))


def test_scaling_and_isometry():
    rng = np.random.default_rng(9)
    X, Y = random_space(rng, 6), random_space(rng, 5)
    value = unlimited(X, Y).upper
    order = rng.permutation(6)
    assert unlimited(X[np.ix_(order, order)], Y).upper == value
    assert unlimited(4 * X, 4 * Y).upper == 4 * value
    assert unlimited(X, X[np.ix_(order, order)]).upper == 0.0


def test_triangle_inequality_between_spaces():
    rng = np.random.default_rng(31)
    X, Y, Z = (random_space(rng, n) for n in (5, 4, 6))
    xy, yz, xz = unlimited(X, Y).upper, unlimited(Y, Z).upper, unlimited(X, Z).upper
    assert xz <= xy + yz + 1e-12


@pytest.mark.parametrize("seed", range(5))
def test_bounds_lie_below_and_the_largest_diameter_above(seed):
    rng = np.random.default_rng(500 + seed)
    X, Y = random_space(rng, 7), random_space(rng, 5)
    exact = 2 * unlimited(X, Y).upper
    for bound in (diameter_bound, eccentricity_bound, packing_bound):
        assert bound(X, Y) <= exact
    assert Engine(X, Y).row_bound <= exact <= max(X.max(), Y.max())


def test_no_time_gives_bounds_at_once():
    rng = np.random.default_rng(12)
    X, Y = (MetricSpace.from_points(rng.random((n, 2))) for n in (60, 50))
    result = gromov_hausdorff(X, Y, time_limit=0)
    check_certificate(result, X, Y)
    assert not result.exact
    assert result.lower_bound_by in ("diameter", "eccentricities")


def test_relative_tolerance_stops_early():
    rng = np.random.default_rng(13)
    X, Y = (MetricSpace.from_points(rng.random((20, 2))) for _ in range(2))
    result, exact = (unlimited(X, Y, rtol=rtol) for rtol in (0.2, 0.0))
    assert result.lower <= exact.upper <= result.upper <= 1.25 * result.lower


def test_one_point_and_repeated_points():
    X = squareform(pdist(np.random.default_rng(3).random((6, 2))))
    assert unlimited([[0.0]], X).upper == X.max() / 2
    doubled = X[np.ix_([0, 0, 1, 2, 3, 4, 5, 5], [0, 0, 1, 2, 3, 4, 5, 5])]
    assert unlimited(X, doubled).upper == 0.0
    assert unlimited([[0.0]], [[0.0]]).exact


@pytest.mark.parametrize(
    ("matrix", "message", "error"),
    [
        ([[0, 1], [2, 0]], "differs from its transpose", NotAMetricError),
        ([[0, -1], [-1, 0]], "is negative", NotAMetricError),
        ([[0, math.nan], [math.nan, 0]], "is not finite", NotAMetricError),
        ([[0, 1, 5], [1, 0, 1], [5, 1, 0]], r"distances\[0, 2\] = 5 exceeds", NotAMetricError),
        (np.empty((0, 0)), "is empty", InvalidInputError),
        ([], "is empty", InvalidInputError),
        ([[0, 1]], "give a square matrix", InvalidInputError),
    ],
)
def test_faults_of_spaces_are_named(matrix, message, error):
    with pytest.raises(error, match=message):
        gromov_hausdorff(matrix, [[0.0]])


def test_broken_triangle_names_its_witness_and_may_be_allowed():
    D = [[0, 1, 2.1], [1, 0, 1], [2.1, 1, 0]]
    with pytest.raises(NotAMetricError) as caught:
        gromov_hausdorff([[0.0]], D)
    assert caught.value.witness == (0, 1, 2)
    assert gromov_hausdorff([[0.0]], MetricSpace(D, rtol=0.1)).upper == 1.05


def test_faults_of_limits_are_named():
    with pytest.raises(InvalidInputError, match="time_limit = -1"):
        gromov_hausdorff([[0.0]], [[0.0]], time_limit=-1)
    with pytest.raises(InvalidInputError, match="time_limit = nan"):
        gromov_hausdorff([[0.0]], [[0.0]], time_limit=math.nan)
    with pytest.raises(InvalidInputError, match="rtol = 1"):
        gromov_hausdorff([[0.0]], [[0.0]], rtol=1.0)
    with pytest.raises(InvalidInputError, match="time_limit has type <U1; give real numbers"):
        gromov_hausdorff([[0.0]], [[0.0]], time_limit="5")
    with pytest.raises(InvalidInputError, match=r"time_limit has shape \(2,\); give one number"):
        gromov_hausdorff([[0.0]], [[0.0]], time_limit=[1, 2])
    with pytest.raises(InvalidInputError, match="covering_radii has type"):
        gromov_hausdorff([[0.0]], [[0.0]], covering_radii=("a", 1))


@pytest.mark.parametrize("unit", [1e-300, 1e300])
def test_tiny_and_huge_distances(unit):
    rng = np.random.default_rng(9)
    X, Y = (squareform(pdist(rng.random((n, 2)))) for n in (7, 6))
    result = unlimited(X * unit, Y * unit)
    assert result.exact
    assert result.upper == pytest.approx(unlimited(X, Y).upper * unit, rel=1e-12)  # rounding of the products


def test_levels_are_the_differences_of_distances():
    rng = np.random.default_rng(61)
    X, Y = random_space(rng, 6), random_space(rng, 5)
    levels, gaps = Levels(X, Y), np.unique(np.abs(X.reshape(-1, 1) - Y.reshape(1, -1)))
    for level in (0.0, *gaps, 0.3, 1.7, 99.0):
        assert levels.above(level) == min(gaps[gaps > level], default=math.inf)
        assert levels.up_to(level) == max(gaps[gaps <= level])
    assert levels.few
    assert not Levels(*(squareform(pdist(rng.random((40, 2)))) for _ in range(2))).few


@pytest.mark.parametrize("seed", range(90, 102))
def test_climbing_from_below_gives_the_distance_of_graphs(seed):
    rng = np.random.default_rng(seed)
    X, Y = (hops(rng, n) for n in rng.integers(2, 6, 2))
    exact = naive.least_distortion(X.tolist(), Y.tolist())
    interval = first_interval(X, Y, 0.0)
    interval.lower = 0.0
    engine, clock = Engine(X, Y), Clock(math.inf)
    steps.climb(engine, interval, clock, (isometries(X, clock), isometries(Y, clock)))
    assert interval.lower == interval.upper == exact
    assert distortion(interval.pairs, X, Y) == exact


@SLOW
def test_longer_and_longer_tabu_searches_meet_a_low_level():
    rng = np.random.default_rng(13)
    X, Y = hops(rng, 40, share=0.05), hops(rng, 40, share=0.05)
    least = unlimited(X, Y).upper * 2
    interval = first_interval(X, Y, 0.0)
    assert interval.upper > least
    interval.lower = least
    steps.insist(Engine(X, Y), interval, Clock(math.inf))
    assert distortion(interval.pairs, X, Y) == interval.upper == least


@pytest.mark.parametrize("seed", range(110, 122))
def test_search_at_one_level_agrees_with_brute_force(seed):
    rng = np.random.default_rng(seed)
    X, Y = (hops(rng, n, share=0.2) if seed % 3 else polygon(n) for n in rng.integers(2, 6, 2))
    engine, clock = Engine(X, Y), Clock(math.inf)
    symmetries = isometries(X, clock), isometries(Y, clock)
    exact = naive.least_distortion(X.tolist(), Y.tolist())
    for level in np.unique(np.abs(X.reshape(-1, 1) - Y.reshape(1, -1))):
        search = LevelSearch(engine, level, symmetries)
        refuted, pairs = search.run(clock) if search.consistent else (True, None)
        assert refuted == (level < exact - 1e-12)  # polygons: distances that should be equal differ by rounding
        if pairs is not None:
            assert distortion(pairs, X, Y) <= level


@SLOW
@pytest.mark.parametrize("n", [40, 70, 130])
def test_search_at_one_level_begins_with_what_arc_consistency_leaves(n):
    """The engine for any distances comes to the same pairs by runs of sorted rows."""
    rng = np.random.default_rng(n)
    X, Y = hops(rng, n, share=0.5 / n), hops(rng, n - 2, share=0.5 / n)
    engine, clock, partly = Engine(X, Y), Clock(math.inf), 0
    symmetries = isometries(X, Clock(0.0)), isometries(Y, Clock(0.0))
    for level in range(1, int(max(X.max(), Y.max()))):
        search, expected = LevelSearch(engine, float(level), symmetries), engine.consistent(float(level), clock)
        assert search.consistent == (expected is not None)
        if expected is not None:
            np.testing.assert_array_equal(search.possible(), expected)
            partly += not np.array_equal(expected, engine.row_levels <= level)
    assert partly > 0  # at some level it deletes pairs, but not all of a point


@SLOW
def test_search_at_one_level_agrees_with_clause_learning():
    """Spaces of up to 24 points, beyond what brute force can do: sets larger than those that are united."""
    decided = set()
    for seed in range(130, 142):
        rng = np.random.default_rng(seed)
        X, Y = (hops(rng, n, share=0.15) for n in rng.integers(16, 25, 2))
        engine, clock = Engine(X, Y), Clock(math.inf)
        symmetries = isometries(X, clock), isometries(Y, clock)
        for level in (1.0, 2.0):
            search = LevelSearch(engine, level, symmetries)
            refuted, _ = search.run(clock) if search.consistent else (True, None)
            with Satisfiability(engine, engine.row_levels <= level, level, clock) as solver:
                assert solver.run(clock)[0] == refuted
            decided.add(refuted)
    assert decided == {True, False}
