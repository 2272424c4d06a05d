"""The monotonicity theorems 3.8 to 3.10 of the paper with their missing hypotheses, and what fails without them."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import rinow

RULE = settings(deadline=None, max_examples=150)
PERCEPTIBLE = 1e-12
"""Share of the size by which lengths must differ: curvatures 0.05 apart change them by more than 1e-9 here."""


@st.composite
def two_surfaces(draw):
    """S_k1 and S_k2, k1 < k2, and a size that leaves room for hinges and triangles in both."""
    low = draw(st.floats(-4.0, 3.5))
    high = low + draw(st.floats(0.05, 4.0 - low))
    size = draw(st.floats(0.05, 0.45)) * (math.pi / math.sqrt(high) if high > 0.2 else 7.0)
    return rinow.SpaceForm(low), rinow.SpaceForm(high), size


shares = st.floats(0.2, 1.0)
angles = st.floats(0.3, math.pi - 0.3)


@RULE
@given(two_surfaces(), shares, shares, angles)
def test_3_8_the_third_side_of_a_hinge_shrinks(surfaces, b, c, angle):
    first, second, size = surfaces
    longer, shorter = (float(S.side(size * b, size * c, angle)) for S in (first, second))
    assert longer > shorter + PERCEPTIBLE * size


@RULE
@given(two_surfaces(), shares, shares, st.floats(0.1, 0.9))
def test_3_9_all_angles_of_a_triangle_grow(surfaces, b, c, share):
    first, second, size = surfaces
    a = abs(b - c) + share * (b + c - abs(b - c))
    assume(a < 1.5)
    for sides in ((a, b, c), (b, c, a), (c, a, b)):
        x, y, z = (size * s for s in sides)
        assert float(first.angle(x, y, z)) < float(second.angle(x, y, z)) - PERCEPTIBLE


@st.composite
def sd_quadruple(draw):
    """pq, qr, and the share and angle that place s beside q, sides up to 1."""
    return draw(st.floats(0.2, 0.5)), draw(st.floats(0.2, 0.5)), draw(st.floats(0.2, 0.6)), draw(angles)


@RULE
@given(two_surfaces(), sd_quadruple())
def test_3_10_with_q_between_p_and_r(surfaces, quadruple):
    first, second, size = surfaces
    pq, qr, qs = (size * s for s in quadruple[:3])
    angle = quadruple[3]
    ps, rs = float(first.side(pq, qs, angle)), float(first.side(qr, qs, math.pi - angle))

    def beyond(a, c):
        """In S_k2: the distance from s of the point beyond q on the line of length a + c whose first end is at c."""
        return float(second.side(a, qs, math.pi - float(second.angle(c[0], c[1], qs))))

    # (1) ps and qs equal: rs is longer in S_k1.  (2) rs and qs equal: ps is.
    assert rs > beyond(qr, (ps, pq)) + PERCEPTIBLE * size
    assert ps > beyond(pq, (rs, qr)) + PERCEPTIBLE * size
    # (3) ps and rs equal: qs is shorter in S_k1.
    at_p = float(second.angle(rs, pq + qr, ps))
    assert qs < float(second.side(pq, ps, at_p)) - PERCEPTIBLE * size


@RULE
@given(two_surfaces(), shares, st.floats(0.2, 0.9))
def test_3_10_reverses_for_a_rhombus(surfaces, side, share):
    first, second, size = surfaces
    a, diagonal = 0.5 * size * side, size * side * share
    other = [float(S.side(a, a, 2 * S.angle(a, a, diagonal))) for S in (first, second)]
    assert other[0] < other[1] - PERCEPTIBLE * size


def test_3_10_counterexample():
    # Five distances of a rhombus of side 1 with a diagonal of 1.2 fix the other: 1.6 in the plane, more on the sphere.
    other = [float(S.side(1, 1, 2 * S.angle(1, 1, 1.2))) for S in (rinow.SpaceForm(0.0), rinow.SpaceForm(1.0))]
    assert other == pytest.approx([1.6, 1.714165322], abs=1e-9)


def test_3_8_needs_an_angle_that_is_neither_0_nor_straight():
    for angle, expected in ((0.0, 0.2), (math.pi, 0.8)):
        sides = [float(rinow.SpaceForm(k).side(0.5, 0.3, angle)) for k in (-1.0, 0.0, 1.0)]
        assert sides == pytest.approx([expected] * 3, abs=1e-12)
