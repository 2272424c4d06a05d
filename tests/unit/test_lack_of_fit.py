"""Waves of a height field under noise: large balls see a plane, and what they leave tells that it is none."""

import numpy as np
import pytest

from rinow import surface_curvature
from rinow.curvature.lack_of_fit import squared_biases_by_residuals

REACHES = np.array([1.2, 1.5, 1.8, 2.0, 2.5, 3.0, 4.0])


def waves(n):
    """A square grid of n x n vertices over [-1, 1]² with two waves each way, its K, and the inner vertices."""
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij"))
    a, p, q = 0.05, 6.0, 5.0
    z, zx, zy = (a * f(p * x) * g(q * y) for f, g in ((np.sin, np.cos), (np.cos, np.cos), (np.sin, np.sin)))
    slope = 1 + (p * zx) ** 2 + (q * zy) ** 2
    hessian = p**2 * q**2 * (z**2 - (a * np.cos(p * x) * np.sin(q * y)) ** 2)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    corner = i * n + j
    faces = np.concatenate(
        [np.stack([corner, corner + n, corner + n + 1], 1), np.stack([corner, corner + n + 1, corner + 1], 1)]
    )
    inner = np.maximum(np.abs(x), np.abs(y)) < 1 - 3.0 / n
    return np.stack([x, y, z], axis=1), faces, hessian / slope**2, inner


@pytest.mark.parametrize("quality", ["best", "fast"])
@pytest.mark.parametrize(("noise", "bound"), [(0.02, 0.3), (0.05, 0.6)])
def test_waves_of_twenty_spacings_are_not_flat(noise, bound, quality):
    """Balls of one size know K to 0.13 and 0.24 here; the largest of all, which hold a wave, see K = 0."""
    V, F, K, inner = waves(38)
    for seed in (11, 12):
        c = surface_curvature(
            (V + noise * 2 / 37 * np.random.default_rng(seed).normal(size=V.shape), F), quality=quality
        )
        error = np.abs(c.gaussian - K)[inner]
        assert np.sqrt(np.mean(error**2) / np.mean(K[inner] ** 2)) < bound
        assert np.mean(error < 2 * c.spread[inner]) > 0.85


def test_noise_alone_tells_nothing():
    """Ratios below eight, fits that are missing, and residuals that hardly any two fits share."""
    ratios = np.full((3, 7, 7), 1.5)
    ratios[0, 6, 0] = 7.9
    ratios[1] = 10.0 ** np.arange(49).reshape(7, 7)
    ratios[2, 1:4] = np.nan
    assert np.isnan(squared_biases_by_residuals(ratios, np.full(3, 0.01), REACHES, np.ones(3), False)).all()


def test_what_is_missed_bends_over_the_largest_ball_that_is_fitted():
    """a = √(0.01 (108 - 8)) = 1 beyond a ball of radius 3: H is off by 16/9, K by 16/9 (16/9 + 2)."""
    ratios = np.ones((1, 7, 7))
    ratios[0, 6, 0] = 108.0
    arguments = ratios, np.array([0.01]), REACHES, np.array([1.0])
    for of_mean, expected in ((True, 16 / 9), (False, 16 / 9 * (16 / 9 + 2))):
        found = squared_biases_by_residuals(*arguments, of_mean)
        assert found[0, 6, 0] == pytest.approx(expected**2)
        assert np.isnan(found).sum() == found.size - 1
