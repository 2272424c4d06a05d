"""Lower bounds of large spaces by few points and all their partners: brute force, soundness, an improvement."""

import math

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra
from scipy.spatial.distance import pdist, squareform

import metric_shapes
from clocks import SLOW
from naive import correspondences as naive
from rinow.comparison.clock import Clock
from rinow.comparison.gromov_hausdorff import first_interval
from rinow.comparison.large_subsets import FewPoints, raise_by_few_points
from rinow.kernels.subset_maps import FITS, GIVEN_UP, REFUTED

pytestmark = pytest.mark.usefixtures("compiled_searches")
UNLIMITED = 10**7


def cloud(rng, n):
    """Distances of random points of the plane."""
    return squareform(pdist(rng.random((n, 2))))


def torus(n, m):
    """Distances along the edges of a grid on the torus of radii 1 and 0.4."""
    u, v = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
    a, b = u * (2 * math.pi / n), v * (2 * math.pi / m)
    P = np.stack([(1 + 0.4 * np.cos(b)) * np.cos(a), (1 + 0.4 * np.cos(b)) * np.sin(a), 0.4 * np.sin(b)], axis=1)
    near = (np.abs((np.subtract.outer(u, u) + n // 2) % n - n // 2) <= 1) & (
        np.abs((np.subtract.outer(v, v) + m // 2) % m - m // 2) <= 1
    )
    D = dijkstra(np.where(near, squareform(pdist(P)), 0.0))
    return np.minimum(D, D.T)


@pytest.mark.parametrize("seed", range(60, 84))
def test_never_above_the_least_distortion(seed):
    """Levels from the exact distortion on fit; the bound stays below it, and does not stay at nothing."""
    rng = np.random.default_rng(seed)
    X, Y = cloud(rng, 4 + seed % 2), cloud(rng, 5 - seed % 3 // 2)
    exact = naive.least_distortion(X.tolist(), Y.tolist())
    search = FewPoints(X, Y)
    for level in (exact, 1.1 * exact, 2 * exact):
        assert search.outcome(level, UNLIMITED, Clock(math.inf)) == FITS
    interval = first_interval(X, Y, 0.0)
    raise_by_few_points(X, Y, interval, Clock(math.inf))
    assert interval.lower <= exact <= interval.upper


@pytest.mark.parametrize("seed", range(12))
def test_refutes_what_no_map_attains(seed):
    """All points of one of the two spaces are mapped: below the least distortion of such maps nothing fits."""
    rng = np.random.default_rng(seed)
    X, Y = cloud(rng, 5), cloud(rng, 4)
    least = min(naive.least_map_distortion(A.tolist(), B.tolist()) for A, B in ((X, Y), (Y, X)))
    assert least > 0
    assert FewPoints(X, Y).outcome(np.nextafter(least, 0), UNLIMITED, Clock(math.inf)) == REFUTED


@SLOW
def test_torus_and_sphere_are_apart_by_more_than_eccentricities_say():
    """Points at the hole of the torus have no antipodes; one of them alone gives the bound by eccentricities."""
    X = torus(24, 12)
    Y = metric_shapes.sphere_net(300, X.max())
    interval = first_interval(X, Y, 0.0)
    known = interval.lower
    assert FewPoints(X, Y).outcome(1.005 * known, UNLIMITED, Clock(math.inf)) == REFUTED
    assert FewPoints(X, Y).outcome(0.999 * interval.upper, UNLIMITED, Clock(math.inf)) == FITS


def test_time_may_be_over():
    X, Y = cloud(np.random.default_rng(3), 9), cloud(np.random.default_rng(4), 9)
    interval = first_interval(X, Y, 0.0)
    known = interval.lower
    raise_by_few_points(X, Y, interval, Clock(0.0))
    assert interval.lower == known


def test_decisions_may_be_used_up():
    """A branch that is given up refutes nothing: the level is far above the distance, and one decision does not do."""
    rng = np.random.default_rng(5)
    X, Y = cloud(rng, 12), cloud(rng, 12)
    level = first_interval(X, Y, 0.0).upper
    assert FewPoints(X, Y).outcome(level, 1, Clock(math.inf)) == GIVEN_UP
    assert FewPoints(X, Y).outcome(level, UNLIMITED, Clock(math.inf)) == FITS
