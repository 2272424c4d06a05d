"""Wald curvature on a surface of variable curvature: second order in the radius, with an honest standard error."""

import numpy as np

import conformal
from rinow import wald_curvature

SURFACE = conformal.Disk()


def errors(radius, n, seeds):
    results = []
    for seed in seeds:
        P = SURFACE.sample(n, radius, seed)
        curvature = wald_curvature(SURFACE.distances(P), 0, radius=10.0)
        results.append((curvature.value - SURFACE.curvature(P[0]), curvature.standard_error))
    return np.array(results).T


def test_error_is_of_second_order_in_the_radius():
    rms = [np.sqrt(np.mean(errors(radius, 12, range(10, 15))[0] ** 2)) for radius in (0.2, 0.1, 0.05)]
    orders = np.log2(rms[:-1] / np.array(rms[1:]))
    # Random stencils: the first order is that of one power less, 1; 2 is measured to ±0.1.
    assert (orders > 1.8).all()
    assert rms[-1] < 0.01


def test_standard_error_covers_the_error():
    for n in (8, 20):
        error, standard_error = errors(0.1, n, range(20, 28))
        z = np.abs(error / standard_error)
        # A normal variable has a median of 0.67; 8 draws leave a factor of 2.
        assert 0.1 < np.median(z) < 1.4
        assert np.mean(z < 3) >= 0.8
