"""The surface that fits many points: exact points, noise with its standard error, sets without a fit."""

import math

import numpy as np
import pytest

import rinow
from naive import point_set as naive
from rinow.embedding.point_set import closest_curvatures

EPS = 2.0**-53


def distances(k, n, radius, seed):
    surface = rinow.SpaceForm(k)
    points = surface.sample(n, radius, np.random.default_rng(seed))
    D = surface.distance(points[:, None], points)
    return (D + D.T) / 2


def disturbed(D, size, rng):
    noise = np.triu(rng.normal(scale=size, size=D.shape), 1)
    return np.abs(D + noise + noise.T)


@pytest.mark.parametrize("k", [-4.0, -1.0, -1e-6, 0.0, 1.0, 4.0])
@pytest.mark.parametrize("n", [5, 9, 40])
def test_points_of_a_surface_are_fitted_to_rounding(k, n):
    D = distances(k, n, 0.6, seed=51)
    fit = rinow.fit_curvature(D)
    # The condition of a set of points is that of its better quadruples, below 1e3.
    assert abs(fit.value - k) <= 1e4 * EPS / D.max() ** 2
    assert fit.residual <= 100 * EPS * D.max()


def test_four_points_have_one_of_their_embedding_curvatures():
    D = np.array([distances(1.0, 4, 0.6, seed) for seed in range(60, 80)])
    values = rinow.fit_curvature(D).value
    i, j = np.triu_indices(4, 1)
    exact = rinow.embedding_curvatures(D[:, i, j])
    distance = np.abs(values[:, None] - exact.values).min(axis=1)
    found = distance <= 1e-9 / D.max(axis=(1, 2)) ** 2
    assert found.mean() >= 0.9  # the smaller one may be too far below for the fit
    assert np.isnan(rinow.fit_curvature(D).standard_error).all()


def test_agrees_with_the_minimum_of_the_naive_misfit():
    rng = np.random.default_rng(52)
    for seed in (53, 54):
        D = disturbed(distances(0.5, 6, 0.7, seed), 1e-3, rng)
        np.fill_diagonal(D, 0)
        expected = naive.curvature(D.tolist(), -2.0, 3.0)
        # A minimum is found to the square root of the rounding of the misfit.
        assert closest_curvatures(D[None])[0] == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("k", [1.0, 0.0, -1.0])
def test_two_standard_errors_hold_the_curvature_of_noisy_points(k):
    # The least misfit of 30 points is off by one standard error with noise of 1 %, and by three with 3 %.
    for noise in (0.01, 0.03):
        rng, D = np.random.default_rng(70), [distances(k, 30, 1.0, seed) for seed in range(20)]
        D = np.array([disturbed(d, noise, rng) * (1 - np.eye(30)) for d in D])
        fit, least = rinow.fit_curvature(D), closest_curvatures(D)
        assert (np.abs(fit.value - k) < 2 * fit.standard_error).mean() >= 0.85
        assert abs((fit.value - k).mean()) < 0.5 * (least - k).mean()


def test_a_fit_that_more_noise_would_undo_has_no_standard_error():
    D = disturbed(distances(1.0, 15, 1.0, seed=75), 0.1, np.random.default_rng(76)) * (1 - np.eye(15))
    fit = rinow.fit_curvature(D)
    assert math.isfinite(fit.value)
    assert math.isnan(fit.standard_error)
    assert fit.value == closest_curvatures(D[None])[0]


def test_the_standard_error_is_that_of_repeated_measurements():
    rng = np.random.default_rng(55)
    D = distances(1.0, 12, 0.7, seed=56)
    noise = 1e-4
    fits = rinow.fit_curvature(np.array([disturbed(D, noise, rng) for _ in range(300)]))
    spread = fits.value.std(ddof=1)
    # 300 values give a standard deviation to 4 %; the misfit estimates the noise to 10 % each, their mean to 1 %.
    assert np.median(fits.standard_error) == pytest.approx(spread, rel=0.15)
    assert np.median(fits.residual) == pytest.approx(noise, rel=0.05)
    assert abs(fits.value.mean() - 1) < 4 * spread / 300**0.5


def test_scaling_and_relabelling():
    rng = np.random.default_rng(57)
    D = disturbed(distances(-1.0, 8, 0.6, seed=58), 1e-3, rng)
    np.fill_diagonal(D, 0)
    fit = rinow.fit_curvature(D)
    large = rinow.fit_curvature(1e3 * D)
    assert large.value == pytest.approx(1e-6 * fit.value, rel=1e-9)
    assert large.standard_error == pytest.approx(1e-6 * fit.standard_error, rel=1e-9)
    assert large.residual == pytest.approx(1e3 * fit.residual, rel=1e-9)
    order = rng.permutation(8)
    assert rinow.fit_curvature(D[np.ix_(order, order)]).value == pytest.approx(fit.value, rel=1e-9)


def test_sets_without_a_fit_are_nan():
    line = np.abs(np.subtract.outer(range(6), range(6)))
    tripod = np.array([[0, 1, 1, 1], [1, 0, 2, 2], [1, 2, 0, 2], [1, 2, 2, 0]])
    bad = 1.0 - np.eye(5)
    bad[0, 1] = 3
    huge, tiny = 1e200 * (1 - np.eye(6)), 1e-200 * (1 - np.eye(6))
    for D in (line, tripod, bad, np.zeros((4, 4)), np.full((4, 4), np.nan), huge, tiny):
        fit = rinow.fit_curvature(D)
        assert np.isnan([fit.value, fit.standard_error, fit.residual]).all()
    # Six points in general position fit nowhere, but some curvature is best.
    assert math.isfinite(rinow.fit_curvature(1 - np.eye(6)).value)


def test_batches_have_the_shape_of_their_leading_axes():
    batch = rinow.fit_curvature(np.array([[1 - np.eye(4)] * 3] * 2))
    assert batch.value.shape == batch.residual.shape == (2, 3)
    assert rinow.fit_curvature(np.empty((0, 5, 5))).value.shape == (0,)
    for bad in (np.zeros(4), np.zeros((3, 3)), np.zeros((4, 5)), "abc"):
        with pytest.raises(rinow.InvalidInputError, match="distances"):
            rinow.fit_curvature(bad)
