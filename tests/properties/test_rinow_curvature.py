"""Rinow curvature of any metric space: order and unit do not matter, more points and less error contradict more."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from rinow import rinow_curvature


@st.composite
def metrics(draw, n=6):
    """Distances between 1 and 2 always satisfy the triangle inequality."""
    values = draw(hnp.arrays(float, n * (n - 1) // 2, elements=st.floats(1.0, 2.0)))
    D = np.zeros((n, n))
    D[np.triu_indices(n, 1)] = values
    return D + D.T


def values(bounds):
    """Both bounds, those below -1000 as one: so far down they double with the last digit of a distance."""
    return np.maximum([bounds.lower, bounds.upper], -1000.0)


@settings(deadline=None, max_examples=25)
@given(metrics(), st.permutations(range(6)))
def test_order_does_not_matter(D, order):
    bounds = rinow_curvature(D)
    permuted = rinow_curvature(D[np.ix_(order, order)])
    assert values(permuted) == pytest.approx(values(bounds), rel=1e-9, abs=1e-9)


@settings(deadline=None, max_examples=25)
@given(metrics(), st.integers(-30, 30))
def test_bounds_have_the_unit_of_curvature(D, exponent):
    bounds, scaled = rinow_curvature(D), rinow_curvature(D * 2.0**exponent)
    assert (scaled.lower, scaled.upper) == pytest.approx(
        (bounds.lower * 4.0**-exponent, bounds.upper * 4.0**-exponent), rel=1e-9, abs=1e-9 * 4.0**-exponent
    )


@settings(deadline=None, max_examples=25)
@given(metrics(), st.integers(4, 5))
def test_more_points_contradict_more(D, n):
    few, all_points = rinow_curvature(D[:n, :n]), rinow_curvature(D)
    assert all_points.lower <= few.lower + 1e-9 * abs(few.lower)
    assert all_points.upper >= few.upper - 1e-9 * abs(few.upper)


@settings(deadline=None, max_examples=25)
@given(st.integers(100, 10**6), st.floats(1e-9, 1e-3), st.floats(1.5, 3.0))
def test_larger_errors_contradict_less(seed, rtol, factor):
    points = np.random.default_rng(seed).uniform(-1, 1, (6, 2))
    exact, rough = rinow_curvature(points, rtol=rtol), rinow_curvature(points, rtol=factor * rtol)
    assert rough.lower >= min(exact.lower, 0.1)  # triangles that fill more than half a sphere are not covered
    assert rough.upper <= exact.upper
