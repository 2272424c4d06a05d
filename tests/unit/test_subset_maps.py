"""Lower bounds by maps of subsets: brute force, spaces of which only nets are known, opposite points."""

import math

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

import metric_shapes
from clocks import SLOW
from metric_shapes import polygon
from naive import correspondences as naive
from rinow import gromov_hausdorff
from rinow.comparison.clock import Clock
from rinow.comparison.subsets import SubsetBound, bound_by_subsets, spread_points, sum_to_opposite
from rinow.errors import InvalidInputError

pytestmark = pytest.mark.usefixtures("compiled_searches")
PATIENT = 600.0
"""Seconds that no machine needs for these sizes."""


def cloud(rng, n):
    """Distances of random points of the plane."""
    return squareform(pdist(rng.random((n, 2))))


@pytest.mark.parametrize("seed", range(40, 52))
def test_maps_by_brute_force(seed):
    rng = np.random.default_rng(seed)
    X = cloud(rng, 4) if seed % 3 else polygon(5)
    Y = cloud(rng, 5) if seed % 2 else polygon(6)
    bound = SubsetBound(X, Y, 0.0)
    bound.improve(Clock(PATIENT))
    exact = naive.least_map_distortion(X.tolist(), Y.tolist())
    rounding = 1e-9  # isometries of polygons
    assert bound.interval.lower <= exact + rounding
    assert exact <= bound.interval.upper
    assert bound.interval.upper <= 1.04 * exact + rounding  # the search stops at a gap of 3 %


@pytest.mark.parametrize("seed", range(20, 32))
def test_nets_stand_for_the_whole_space(seed):
    """The interval of two nets, widened by their covering radii, holds the distance of the spaces."""
    rng = np.random.default_rng(seed)
    X = cloud(rng, 6) if seed % 3 else polygon(6)
    Y = cloud(rng, 5)
    exact = naive.least_distortion(X.tolist(), Y.tolist()) / 2
    nets = [rng.permutation(len(D))[: rng.integers(2, len(D))] for D in (X, Y)]
    radii = [float(D[net].min(axis=0).max()) for D, net in zip((X, Y), nets, strict=True)]
    result = gromov_hausdorff(
        *(D[np.ix_(net, net)] for D, net in zip((X, Y), nets, strict=True)), covering_radii=tuple(radii)
    )
    assert result.lower <= exact + 1e-12  # rounding of sums
    assert exact <= result.upper + 1e-12
    assert result.covering_radii == tuple(radii)
    assert not result.exact


def test_one_known_space_costs_the_radius_of_the_other_only():
    """A segment of length 4 known by its ends, and a point: the ends have one image, and d = 2."""
    result = gromov_hausdorff([[0, 4], [4, 0]], [[0]], covering_radii=(2.0, 0.0))
    assert (result.lower, result.lower_bound_by) == (2.0, "eccentricities")
    assert result.upper == 4.0


@SLOW
def test_circle_and_sphere_are_more_than_half_apart():
    """S¹ and S² are at distance π/3 (Lim, Mémoli, Smith); 20 points of one and a 24-gon say more than 0.5.

    The other half of these points is opposite to them and would say no more.
    """
    Y = metric_shapes.sphere_net(300)
    A = spread_points(Y, 20, opposites=True)
    bound = SubsetBound(Y[np.ix_(A, A)], polygon(24), 2 * 0.5 + math.pi / 12)
    assert bound.interval.lower < bound.interval.upper
    bound.improve(Clock(PATIENT))
    lower = bound.interval.lower / 2 - math.pi / 24
    assert 0.5 < lower <= math.pi / 3


def test_opposite_points_are_not_taken():
    assert abs(sum_to_opposite(polygon(12)) - math.pi) < 1e-12  # rounding of sums
    assert abs(sum_to_opposite(metric_shapes.sphere_net(200)) - math.pi) < 0.1  # the points are 0.25 apart
    assert math.isnan(sum_to_opposite(cloud(np.random.default_rng(4), 50)))
    chosen = spread_points(polygon(12), 12, opposites=True)
    assert len(chosen) == len({i % 6 for i in chosen.tolist()}) == 6
    assert sorted(spread_points(polygon(12), 12, opposites=False)) == list(range(12))


def test_known_bound_is_kept_and_time_may_be_over():
    X, Y = polygon(8), metric_shapes.sphere_net(20)
    assert bound_by_subsets(X, Y, (0.1, 0.1), 0.75, Clock(0.0)) == (0.75, None)
    result = gromov_hausdorff(X, Y, time_limit=0, covering_radii=(math.pi / 8, 0.7))
    assert 0.0 <= result.lower <= math.pi / 3 <= result.upper


@pytest.mark.parametrize("radii", [(-1.0, 0.0), (0.0, math.nan), (1.0,), (math.inf, 0.0)])
def test_faults_of_radii_are_named(radii):
    with pytest.raises(InvalidInputError, match="are not two lengths >= 0"):
        gromov_hausdorff([[0.0]], [[0.0]], covering_radii=radii)
