"""Maps found by placing spaces in Euclidean space."""

import math

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

from rinow import distortion
from rinow.comparison.alignment import align, coordinates
from rinow.comparison.clock import Clock
from rinow.comparison.gromov_hausdorff import first_interval


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_coordinates_have_the_distances(dimension):
    points = np.random.default_rng(5).normal(size=(12, dimension))
    D = squareform(pdist(points))
    found = coordinates(D)
    assert found.shape == (12, dimension)
    assert np.abs(squareform(pdist(found)) - D).max() < 1e-12 * D.max() * 100  # square roots of rounded squares
    assert np.abs(found.mean(axis=0)).max() < 1e-12 * D.max() * 100


@pytest.mark.parametrize(("dimension", "seed"), [(1, 3), (2, 4), (2, 5), (3, 6)])
def test_moved_copies_with_noise_are_matched(dimension, seed):
    rng = np.random.default_rng(seed)
    points = rng.random((60, dimension)) * [3.0, 2.0, 1.0][:dimension]
    turn = np.linalg.qr(rng.normal(size=(dimension, dimension)))[0]
    order = rng.permutation(60)
    moved = points[order] @ turn + rng.normal(0, 1e-4, points.shape)
    X, Y = squareform(pdist(points)), squareform(pdist(moved))
    interval = first_interval(X, Y, 0.0)
    align(X, Y, interval, Clock(math.inf))
    truth = distortion(np.stack([order, np.arange(60)], axis=1), X, Y)
    assert interval.upper <= truth  # nearest points are the moved ones, unless others are still better
    assert distortion(interval.pairs, X, Y) == interval.upper


def test_a_moved_copy_of_hundreds_of_points_is_found():
    """Eigenvalues by iteration; the ranking of the rotations looks at some of the points only."""
    rng = np.random.default_rng(9)
    points, order = rng.random((600, 3)) * [2.0, 1.5, 1.0], rng.permutation(600)
    moved = points[order] @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
    X, Y = squareform(pdist(points)), squareform(pdist(moved))
    assert np.abs(squareform(pdist(coordinates(X))) - X).max() < 1e-9 * X.max()  # iterations stop before rounding
    interval = first_interval(X, Y, 0.0)
    align(X, Y, interval, Clock(math.inf))
    assert interval.upper < 1e-12 * X.max()


def test_spaces_of_few_points_and_no_time():
    X = np.zeros((1, 1))
    for Y in (X, np.zeros((3, 3)), np.array([[0.0, 2.0], [2.0, 0.0]])):
        interval = first_interval(X, Y, 0.0)
        align(X, Y, interval, Clock(math.inf))
        assert interval.upper == Y.max()
        align(X, Y, interval, Clock(0.0))
    assert coordinates(X).shape == (1, 1)
