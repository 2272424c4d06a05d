"""Curvature of any curve equals its naive twin and does not depend on place, direction, numbering and unit."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from naive import curves as naive
from rinow import alt_curvature, arc_length, curve_curvature, haantjes_curvature, menger_curvature
from strategies import triangle_sides

EPS = 2.0**-53
KINDS = ("menger", "haantjes", "alt")


@st.composite
def polylines(draw, min_points=5, max_points=9):
    """Points in space, each 0.1 to 2 from the one before and no two closer than 0.05."""
    n = draw(st.integers(min_points, max_points))
    rng = np.random.default_rng(draw(st.integers(2, 10**6)))
    steps = rng.normal(size=(n, 3))
    steps *= rng.uniform(0.1, 2.0, (n, 1)) / np.linalg.norm(steps, axis=1, keepdims=True)
    points = np.cumsum(steps, axis=0)
    assume(distances(points)[np.triu_indices(n, 1)].min() > 0.05)
    return points


def distances(points):
    D = np.linalg.norm(points[:, None] - points, axis=-1)
    return 0.5 * (D + D.T)


def matrix(a, b, c):
    return [[0, a, b], [a, 0, c], [b, c, 0]]


@given(triangle_sides())
def test_menger_curvature_of_sides(sides):
    # Exact for the given sides up to the dozen roundings of the product.
    assert menger_curvature(matrix(*sides), [[0, 1, 2]])[0] == pytest.approx(
        naive.menger_of_sides(*sides), rel=16 * EPS
    )


@given(triangle_sides(), st.permutations(range(3)))
def test_menger_curvature_does_not_depend_on_the_order(sides, order):
    D = np.array(matrix(*sides))
    assert menger_curvature(D, [order]) == menger_curvature(D, [[0, 1, 2]])


@given(triangle_sides())
def test_menger_curvature_is_at_most_that_of_the_circle_on_the_longest_side(sides):
    assert menger_curvature(matrix(*sides), [[0, 1, 2]])[0] <= 2 / max(sides) * (1 + 16 * EPS)


@given(polylines(), st.booleans())
def test_menger_along_a_curve(points, closed):
    n = len(points)
    middle = np.arange(n) if closed else np.clip(np.arange(n), 1, n - 2)
    expected = [naive.menger(*points[[(i - 1) % n, i, (i + 1) % n]].tolist()) for i in middle]
    # Unit vectors have an error of 2 eps; the sine may be small: an absolute error of that over the chord of 0.05.
    np.testing.assert_allclose(curve_curvature(points, closed=closed), expected, rtol=1e-14, atol=200 * EPS)


@given(polylines(), st.integers(1, 2))
def test_haantjes_along_a_curve(points, reach):
    n = len(points)
    start = np.clip(np.arange(n) - reach, 0, n - 1 - 2 * reach)
    expected = [naive.haantjes(points[i : i + 2 * reach + 1].tolist()) for i in start]
    np.testing.assert_allclose(curve_curvature(points, kind="haantjes", reach=reach), expected, rtol=1e-13)


@given(polylines(5, 5), st.integers(0, 4))
def test_alt_curvature_agrees_with_the_naive_twin(points, i):
    # The twin solves exactly; orthogonalising four terms in floats costs eps times the square of their condition,
    # up to 1e8 for such wild curves, on squares of up to (2/0.05)².
    expected = naive.alt(points.tolist(), i)
    assert alt_curvature(points, i) ** 2 == pytest.approx(expected**2, rel=1e-8, abs=1e-8)


@given(polylines(), st.booleans(), st.sampled_from(KINDS))
def test_points_and_distances_agree(points, closed, kind):
    # Squares from rounded distances: at sides of 0.05 and sizes of 10 the error is below 1e3 eps 10/0.05³.
    actual = curve_curvature(distances(points), kind=kind, closed=closed) ** 2
    expected = curve_curvature(points, kind=kind, closed=closed) ** 2
    np.testing.assert_allclose(actual, expected, rtol=1e-7, atol=1e-7)


@given(polylines(), st.booleans(), st.sampled_from(KINDS), st.integers(2, 10**6), st.floats(-3, 3))
def test_motions_change_nothing_and_similarities_the_unit(points, closed, kind, seed, exponent):
    rotation = Rotation.from_quat(np.random.default_rng(seed).normal(size=4))
    moved = rotation.apply(points + np.array([3.0, -2.0, 1.0]))
    scale = 10.0**exponent
    actual = curve_curvature(scale * moved, kind=kind, closed=closed) * scale
    np.testing.assert_allclose(actual**2, curve_curvature(points, kind=kind, closed=closed) ** 2, rtol=1e-7, atol=1e-7)


@given(polylines(), st.booleans(), st.sampled_from(KINDS))
def test_direction_does_not_matter(points, closed, kind):
    actual = curve_curvature(points[::-1], kind=kind, closed=closed)[::-1]
    expected = curve_curvature(points, kind=kind, closed=closed)
    np.testing.assert_allclose(actual**2, expected**2, rtol=1e-7, atol=1e-7)


@given(polylines(), st.integers(1, 4), st.sampled_from(KINDS))
def test_first_point_of_a_closed_curve(points, shift, kind):
    actual = curve_curvature(np.roll(points, shift, axis=0), kind=kind, closed=True)
    expected = np.roll(curve_curvature(points, kind=kind, closed=True), shift)
    np.testing.assert_allclose(actual**2, expected**2, rtol=1e-7, atol=1e-7)


@given(st.floats(1e-3, 1e3), st.floats(-1e3, 1e3))
def test_lift_and_curvature_are_inverse_to_third_order(chord, kappa):
    # With x = κc the lift has the curvature κ (1 + x²/24)^(-3/2), exactly.
    arc = arc_length(chord, kappa)
    x = abs(kappa * chord)
    assume(x > 1e-4)
    assert haantjes_curvature(arc, chord) == pytest.approx(
        abs(kappa) * (1 + x * x / 24) ** -1.5, rel=1e-14 + 100 * EPS / x**2
    )
    assert arc >= chord
