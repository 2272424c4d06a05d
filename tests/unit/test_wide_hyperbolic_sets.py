"""Points of the hyperbolic plane that are far apart, in units of the curvature: their fit, exact and with noise."""

import numpy as np
import pytest

import rinow
from rinow.embedding.misfit import quietest_curvature


def distances(n, radius, seed, noise=0.0):
    """Distances of points of the plane of curvature -1, with independent errors."""
    plane, rng = rinow.SpaceForm(-1.0), np.random.default_rng(seed)
    points = plane.sample(n, radius, rng)
    D = plane.distance(points[:, None], points)
    errors = np.triu(rng.normal(scale=noise, size=D.shape), 1)
    D = np.abs((D + D.T) / 2 + errors + errors.T)
    np.fill_diagonal(D, 0)
    return D


@pytest.mark.parametrize("radius", [3.0, 5.0, 8.0, 13.0])
@pytest.mark.parametrize("n", [12, 40])
def test_exact_points(n, radius):
    """Diameters of 6 to 26: the least misfit near 0 has a positive curvature, or there is none."""
    for seed in (91, 92, 93):
        fit = rinow.fit_curvature(distances(n, radius, seed))
        # Chords have lost half of their digits at a distance of 26: exp(13) times the rounding of the distances.
        assert fit.value == pytest.approx(-1, abs=1e-9 * np.exp(radius) / np.exp(3))
        assert fit.residual < 1e-6


@pytest.mark.parametrize("radius", [3.0, 5.0, 8.0])
def test_noisy_points(radius):
    fits = [rinow.fit_curvature(distances(30, radius, seed, noise=0.005 * radius)) for seed in range(94, 106)]
    value, error, residual = np.array([(f.value, f.standard_error, f.residual) for f in fits]).T
    assert np.all((-1.5 < value) & (value < -0.5))
    assert np.median(np.abs(value + 1)) < 0.15
    assert (np.abs(value + 1) < 2 * error).mean() >= 0.8
    assert np.abs(np.median(residual) / (0.005 * radius) - 1) < 0.1


def test_scaling_and_relabelling():
    D = distances(20, 6.0, seed=106, noise=0.05)
    fit, large = rinow.fit_curvature(D), rinow.fit_curvature(1e3 * D)
    order = np.random.default_rng(107).permutation(20)
    again = rinow.fit_curvature(D[np.ix_(order, order)])
    assert fit.value == pytest.approx(-1, abs=0.1)
    assert large.value == pytest.approx(1e-6 * fit.value, rel=1e-6)
    # The copies that tell the bias are others.
    assert again.value == pytest.approx(float(fit.value), abs=float(fit.standard_error))


@pytest.mark.parametrize("n", [4, 7, 20])
def test_points_of_a_line_or_a_tree_have_no_quietest_curvature(n):
    line = np.abs(np.subtract.outer(np.arange(n), np.arange(n))) / (n - 1)
    is_end = np.arange(n) > 0
    star = (1.0 - np.eye(n)) * np.where(np.outer(is_end, is_end), 1.0, 0.5)
    for D in (line, star):
        assert np.isnan(quietest_curvature(D, 1.0))
        assert np.isnan(rinow.fit_curvature(D).value)
