"""Gromov-Hausdorff distance: brute force, closed forms, certificates, anytime bounds, bad input."""

import math

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

from clocks import SLOW, unlimited
from golden_files import golden
from metric_shapes import polygon, random_space, segment
from naive import correspondences as naive
from rinow import MetricSpace, distortion, gromov_hausdorff
from rinow.comparison import steps
from rinow.comparison.bounds import diameter_bound, eccentricity_bound, packing_bound
from rinow.comparison.clock import Clock
from rinow.comparison.engine import Engine
from rinow.comparison.gromov_hausdorff import first_interval
from rinow.comparison.relaxation import relaxed_maps
from rinow.comparison.symmetry import isometries
from rinow.errors import InvalidInputError, NotAMetricError


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


@pytest.mark.parametrize("case", golden("gromov_hausdorff"), ids=lambda case: str(case["name"]))
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
