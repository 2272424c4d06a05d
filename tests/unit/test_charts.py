"""Which of two charts a fit lies over."""

import numpy as np
import pytest

import rinow
import shapes
from rinow.curvature.charts import ABOVE, EXPONENT, FARTHEST, STEEPEST, Choice, log_ratios, lower


def choices(*risks):
    n = len(risks)
    return Choice(np.zeros(n, np.int32), np.full(n, 2, np.int32), np.array(risks))


def test_the_lesser_risk_wins_times_what_residuals_say():
    torus, plane = choices(1.0, 1.0, 1.0, np.nan, 1.0), choices(0.5, 0.5, 2.0, 1.0, np.nan)
    is_level, choice = lower(torus, plane, np.array([0.0, 1.0, -1.0, 0.0, 0.0]), np.zeros(5))
    np.testing.assert_array_equal(is_level, (True, False, True, False, False))
    np.testing.assert_array_equal(choice.risk, (0.5, 1.0, 2.0, np.nan, 1.0))


def test_exact_tori_overflow_nothing():
    torus, plane = choices(1e-60, 0.0, 1e-60), choices(1e-3, 1e-3, np.inf)
    assert not lower(torus, plane, np.array([2000.0, 2000.0, -2000.0]), np.zeros(3))[0].any()


def test_no_plane_where_the_surface_turns_away():
    turns = np.array([0.99, 1.01]) * STEEPEST
    np.testing.assert_array_equal(lower(choices(1.0, 1.0), choices(0.1, 0.1), np.zeros(2), turns)[0], (True, False))


@pytest.mark.parametrize("radius", (0, 3, 11))
def test_ratios_are_those_of_balls_somewhat_larger(radius):
    rng = np.random.default_rng(radius)
    torus, plane = rng.uniform(1.0, 2.0, (2, 1, 12, 7))
    choice = choices(1.0)._replace(radius=np.array([radius], np.int32), order=np.array([4], np.int32))
    k = min(radius + ABOVE, FARTHEST)
    expected = EXPONENT * np.log(plane[0, k, 2] / torus[0, k, 2])
    np.testing.assert_allclose(log_ratios((choice, torus), (choice, plane)), expected)


def test_unknown_residuals_say_nothing():
    nothing = choices(1.0)._replace(radius=np.array([-1], np.int32))
    known, unknown = np.ones((1, 12, 7)), np.full((1, 12, 7), np.nan)
    assert log_ratios((choices(1.0), known), (choices(1.0), unknown)) == 0.0
    assert log_ratios((nothing, known), (nothing, 2.0 * known)) == 0.0


def test_choices_do_not_depend_on_the_unit_of_length():
    V, F = shapes.open_patch(1500)[:2]
    V[:, 2] = 0.2 * np.exp(-6.0 * (V[:, 0] ** 2 + V[:, 1] ** 2))
    V += np.random.default_rng(0).normal(size=V.shape) * 1e-3
    small, large = (rinow.surface_curvature((unit * V, F), method="sectional") for unit in (1.0, 1024.0))
    np.testing.assert_allclose(small.gaussian, large.gaussian * 1024.0**2, rtol=1e-9, atol=1e-9)
