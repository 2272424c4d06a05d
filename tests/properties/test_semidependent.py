"""Quadruples with a linear triple: how their curvature moves with the distances, and Robinson's bounds of it."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import rinow

EPS = 2.0**-53


@st.composite
def hinges(draw):
    """Sides a, c, b and angle between a and b at a point of the segment a + c, and a curvature that admits them."""
    a, c, b = (draw(st.floats(0.05, 0.4)) for _ in range(3))
    return a, c, b, draw(st.floats(0.2, math.pi - 0.2)), draw(st.floats(-4.0, 4.0))


def semidependent(a, c, b, alpha, k):
    surface = rinow.SpaceForm(k)
    return np.array([a, a + c, surface.side(a, b, alpha), c, b, surface.side(c, b, math.pi - alpha)])


@given(hinges(), st.floats(0.01, 0.2))
def test_curvature_grows_with_the_median_and_falls_with_the_outer_sides(hinge, share):
    # The corrected form of the comparison of quadruples: one triple linear, one distance changed.
    d = semidependent(*hinge)
    k = rinow.embedding_curvatures(d).values[0]
    assume(np.isfinite(k))
    slack = min(d[0] + d[4] - d[2], d[3] + d[4] - d[5], d[2] + d[4] - d[0], d[5] + d[4] - d[3])
    for column, sign in ((4, 1), (2, -1), (5, -1)):
        moved = d.copy()
        moved[column] += share * min(slack, 0.1)
        assume(moved[2] + moved[4] > moved[0] and moved[5] + moved[4] > moved[3])
        other = rinow.embedding_curvatures(moved)
        if other.count == 1:
            assert sign * other.values[0] > sign * k


@given(hinges(), st.floats(1e-3, 1e3), st.sampled_from([1, 2, 3]), st.booleans())
def test_robinson_scales_and_does_not_see_which_end_is_first(hinge, factor, order, verify):
    d = semidependent(*hinge)
    one = rinow.robinson_curvature(d, order=order, verify=verify)
    assert one.lower <= hinge[-1] <= one.upper
    other = rinow.robinson_curvature(factor * d[[3, 1, 5, 0, 4, 2]], order=order, verify=verify)
    # Rounding the scaled distances moves the curvature by condition · eps / diameter².
    condition = rinow.embedding_curvatures(d).condition[0]
    allowed = 1000 * EPS * (condition / d.max() ** 2 + abs(one.value))
    assert abs(other.value * factor**2 - one.value) <= allowed
    for a, b in ((one.lower, other.lower), (one.upper, other.upper)):
        assert a == b * factor**2 or abs(b * factor**2 - a) <= allowed


@given(hinges(), st.floats(0.01, 3.0))
def test_distances_of_a_linear_triple_compare(hinge, step):
    # p, q, r with q between; s beside them.  In S_k with a larger k the far side of each hinge is shorter.
    a, c, b, alpha, k = hinge
    low, high = rinow.SpaceForm(k - step), rinow.SpaceForm(k)
    ps = low.side(a, b, alpha)
    assume(not np.isnan(high.angle(ps, a, b)))
    rs = [surface.side(c, b, math.pi - surface.angle(ps, a, b)) for surface in (low, high)]
    assert rs[0] > rs[1]
    pr = a + c
    assume(not np.isnan(high.angle(rs[0], pr, ps)))
    qs = [surface.side(a, ps, surface.angle(rs[0], pr, ps)) for surface in (low, high)]
    assert qs[0] == pytest.approx(b, rel=1e-6)
    assert qs[0] < qs[1]


@given(hinges())
def test_robinson_is_above_by_less_than_its_bounds(hinge):
    a, c, b, _, k = hinge
    d = semidependent(*hinge)
    K, diameter = rinow.robinson_curvature(d).value, d.max()
    result = rinow.embedding_curvatures(d)
    noise = 100 * EPS * (result.condition[0] / diameter**2 + abs(k))
    if abs(k) > noise:
        assert np.sign(K) == np.sign(k)
    if abs(k) * diameter**2 <= 1 / 16:
        assert -noise <= K - k <= 0.203 * k**2 * diameter**2 + noise
    # The bound of the paper, with sin² in its quantity lambda.
    plane = rinow.SpaceForm(0.0)
    sines = [math.sin(plane.angle(d[2], a, b)) ** 2, math.sin(plane.angle(d[5], c, b)) ** 2]
    s = max(a + b + d[2], c + b + d[5]) / 2
    size = b * (a * sines[0] + c * sines[1]) / s**2
    if abs(k) * s**2 < 1:
        assert abs(K - k) <= 4 * k**2 * diameter**2 / size + noise


@given(hinges())
def test_the_only_value_is_the_curvature_of_the_surface(hinge):
    d = semidependent(*hinge)
    result = rinow.embedding_curvatures(d)
    assert result.count == 1
    assert result.kind[0] in ("semidependent", "boundary")
    assert abs(result.values[0] - hinge[-1]) <= 24 * EPS * (result.condition[0] / d.max() ** 2 + abs(hinge[-1]))
    assert rinow.is_planar(d, result.values[0])
