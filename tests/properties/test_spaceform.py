"""Accuracy of the space-form kernels against 60 and more digits, and the laws of triangles."""

import math

import mpmath as mp
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from rinow.kernels import spaceform

EPS = 2.0**-53
curvatures = st.one_of(
    st.just(0.0), st.builds(lambda sign, e: sign * 10.0**e, st.sampled_from([-1.0, 1.0]), st.floats(-300.0, 4.0))
)


@st.composite
def fitting_triangles(draw):
    """Sides and curvature of a triangle that fits into S_k, its size from 1e-8 to 100 but at most 300/√-k."""
    k, size = draw(curvatures), 10.0 ** draw(st.floats(-8.0, 2.0))
    if k != 0:
        size = min(size, (1.4 if k > 0 else 300.0) / math.sqrt(abs(k)))
    b, c = size * draw(st.floats(0.05, 1.0)), size * draw(st.floats(0.05, 1.0))
    a = abs(b - c) + draw(st.floats(0.001, 0.999)) * (b + c - abs(b - c))
    return a, b, c, k


def sine(x, k):
    root = mp.sqrt(k)
    return (mp.sin(root * x) / root).real if k else x


def half_angle_tangent(a, b, c, k):
    s = (a + b + c) / 2
    return mp.sqrt(sine(s - b, k) * sine(s - c, k) / (sine(s, k) * sine(s - a, k)))


def roundings(a, b, c, k):
    """Errors allowed in units of eps: a few, times the condition of s_k at half the perimeter."""
    t = math.sqrt(abs(k)) * (a + b + c) / 2
    return 20 * EPS * max(1.0, t if k <= 0 else t / math.sin(t))


@given(fitting_triangles())
def test_angle_is_right_to_a_few_roundings(triangle):
    with mp.workdps(340):
        exact = 2 * mp.atan(half_angle_tangent(*map(mp.mpf, triangle)))
    assert spaceform.angle(*triangle) == pytest.approx(float(exact), rel=roundings(*triangle))


@given(fitting_triangles())
def test_derivative_is_right_to_a_few_roundings(triangle):
    _, b, c, _ = triangle
    with mp.workdps(1000):
        A, B, C, K = map(mp.mpf, triangle)
        step = mp.mpf(10) ** -330
        angles = [2 * mp.atan(half_angle_tangent(A, B, C, K + sign * step)) for sign in (1, -1)]
        exact = (angles[0] - angles[1]) / (2 * step)
    # The four terms of the derivative cancel down to the shorter enclosing side.
    tolerance = roundings(*triangle) * max(b / c, c / b) * 10
    assert spaceform.angle_and_derivative(*triangle)[1] == pytest.approx(float(exact), rel=tolerance)


@given(fitting_triangles())
def test_area_is_right_to_a_few_roundings(triangle):
    with mp.workdps(1000):
        a, b, c, k = map(mp.mpf, triangle)
        sides = ((a, b, c), (b, c, a), (c, a, b))
        s = (a + b + c) / 2
        heron = mp.sqrt(s * (s - a) * (s - b) * (s - c))
        exact = (sum(2 * mp.atan(half_angle_tangent(*t, k)) for t in sides) - mp.pi) / k if k else heron
    assert spaceform.area(*triangle) == pytest.approx(float(exact), rel=roundings(*triangle))


@given(fitting_triangles(), st.floats(1e-3, 3.14))
def test_side_is_right_to_a_few_roundings(triangle, alpha):
    _, b, c, k = triangle
    with mp.workdps(340):
        B, C, K = map(mp.mpf, (b, c, k))
        chord = mp.sqrt(sine((B - C) / 2, K) ** 2 + sine(B, K) * sine(C, K) * mp.sin(mp.mpf(alpha) / 2) ** 2)
        root = mp.sqrt(K)
        exact = 2 * ((mp.asin(root * chord) / root).real if k else chord)
    assert spaceform.side(b, c, alpha, k) == pytest.approx(float(exact), rel=roundings(b, c, b + c, min(k, 0.0)))


@given(fitting_triangles(), st.floats(0.01, 0.99))
def test_angles_grow_with_the_curvature(triangle, share):
    a, b, c, k = triangle
    lower = k - share * (abs(k) + 1 / (a * a + b * b + c * c))
    assert spaceform.angle(a, b, c, lower) < spaceform.angle(a, b, c, k)


@given(fitting_triangles(), st.floats(0.01, 3.0), st.floats(0.01, 0.99))
def test_the_side_of_a_hinge_shrinks_as_the_curvature_grows(triangle, alpha, share):
    _, b, c, k = triangle
    assume(k <= 0 or (b + c) * math.sqrt(k) < math.pi)
    lower = k - share * (abs(k) + 1 / (b * b + c * c))
    assert spaceform.side(b, c, alpha, lower) > spaceform.side(b, c, alpha, k)


@given(fitting_triangles(), st.floats(1e-3, 1e3))
def test_scaling_lengths_scales_curvature_by_the_inverse_square(triangle, factor):
    a, b, c, k = triangle
    scaled = (factor * a, factor * b, factor * c, k / factor**2)
    # Rounding the scaled lengths moves the thinnest triangle, of relative excess 0.001, by 1000 eps.
    tolerance = 1000 * roundings(*triangle)
    assert spaceform.angle(*scaled) == pytest.approx(spaceform.angle(*triangle), rel=tolerance)
    assert spaceform.area(*scaled) == pytest.approx(factor**2 * spaceform.area(*triangle), rel=tolerance)
