"""Fits in two charts at one place: which are blended, and how much each of them counts."""

import numpy as np

from rinow.curvature.charts import Choice
from rinow.curvature.searches import ALIKE, Found, blended


def found(*risks, radius=3):
    """What centres found with such risks, the least around each being its own."""
    n = len(risks)
    choice = Choice(np.full(n, radius, np.int32), np.full(n, 4, np.int32), np.array(risks, float))
    return Found(np.arange(11.0 * n).reshape(n, 11), choice, np.ones(n))


def test_fits_of_like_risk_follow_those_of_the_first_chart():
    both, rows = blended(found(1.0, 1.0, 2.0), found(1.01 * ALIKE, 0.5), np.array([0, 2]))
    np.testing.assert_array_equal(rows, [0, 1, 2, 2])
    np.testing.assert_array_equal(both.choice.risk, [1.0, 1.0, 2.0, 0.5])
    np.testing.assert_array_equal(both.frames[3], found(0.0, 0.0).frames[1])


def test_the_least_risk_around_is_that_in_either_chart():
    both, _ = blended(found(1.0, 1.0, 2.0), found(4.0, 0.5), np.array([0, 2]))
    np.testing.assert_array_equal(both.least * both.choice.risk, [1.0, 1.0, 0.5, 1.0, 0.5])


def test_where_one_chart_has_no_fit_the_other_counts_alone():
    both, rows = blended(found(np.inf, 1.0), found(2.0, np.inf), np.array([0, 1]))
    np.testing.assert_array_equal(rows, [0, 1, 0])
    np.testing.assert_array_equal(both.least, [0.0, 1.0, 1.0])
    _, rows = blended(found(1.0, 1.0), found(0.5, 0.5, radius=-1), np.array([0, 1]))
    np.testing.assert_array_equal(rows, [0, 1])


def test_without_open_centres_nothing_is_added():
    both, rows = blended(found(1.0, 2.0), found(), np.zeros(0, np.intp))
    np.testing.assert_array_equal(rows, [0, 1])
    np.testing.assert_array_equal(both.least, [1.0, 1.0])
