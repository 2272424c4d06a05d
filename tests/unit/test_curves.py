"""Curvature of curves: known values, degenerate data, messages."""

import math

import numpy as np
import pytest

import rinow
from naive import curves as naive
from rinow import NotAMetricError, alt_curvature, arc_length, curve_curvature, haantjes_curvature, menger_curvature

KINDS = ("menger", "haantjes", "alt")
nan = math.nan


def distances(points):
    D = np.linalg.norm(points[:, None] - points, axis=-1)
    return 0.5 * (D + D.T)


def turn(degrees):
    return np.exp(1j * np.radians(degrees))


def plane(z):
    return np.column_stack([np.real(z), np.imag(z)])


# ------------------------------------------------------------------ triples, arcs


def test_menger_curvature_of_a_small_space():
    # A path of two edges is linear, three leaves at mutual distance 2 have the circumradius 2/√3.
    D = 2.0 - 2 * np.eye(4)
    D[0, 1:] = D[1:, 0] = 1
    triples = [[0, 1, 2], [1, 0, 2], [1, 2, 3], [3, 1, 2], [1, 1, 2]]
    half_root_3 = math.sqrt(3) / 2
    np.testing.assert_allclose(menger_curvature(D, triples), [0, 0, half_root_3, half_root_3, nan], rtol=1e-15)
    assert menger_curvature(D, []).shape == (0,)


def test_menger_curvature_without_triangle_inequality():
    D = np.array([[0, 1, 3], [1, 0, 1], [3, 1, 0]], float)
    assert np.isnan(menger_curvature(D, [[0, 1, 2]]))
    D[0, 2] = D[2, 0] = 2 * (1 + 1e-10)
    assert menger_curvature(D, [[0, 1, 2]]) == 0


@pytest.mark.parametrize("size", [1e-100, 1e-9, 1e100])
def test_size_costs_no_digits(size):
    sides = np.array([[0, 3, 5], [3, 0, 4], [5, 4, 0]]) * size
    np.testing.assert_allclose(menger_curvature(sides, [[0, 1, 2]]) * size, 0.4, rtol=1e-15)
    square = size * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    for kind in KINDS:
        expected = curve_curvature(square / size, kind=kind, closed=True)
        np.testing.assert_allclose(size * curve_curvature(square, kind=kind, closed=True), expected, rtol=1e-14)


def test_needle_keeps_its_digits():
    # Heron's formula as printed loses every digit here; the naive twin is exact.
    sides = (1e-8, 1.0, 1.0 + 3e-9)
    D = np.array([[0, sides[0], sides[1]], [sides[0], 0, sides[2]], [sides[1], sides[2], 0]])
    assert menger_curvature(D, [[0, 1, 2]])[0] == pytest.approx(naive.menger_of_sides(*sides), rel=1e-15)


@pytest.mark.parametrize(
    ("triples", "message"),
    [
        ([[0, 1, 3]], "triples[0, 2] = 3 is outside 0..2"),
        ([[0, 1, -1]], "triples[0, 2] = -1 is outside"),
        ([[0, 1]], "shape (1, 2)"),
        ([[0.0, 1.0, 2.0]], "give integer indices"),
    ],
)
def test_menger_curvature_refuses_triples(triples, message):
    with pytest.raises(rinow.InvalidInputError) as caught:
        menger_curvature(np.ones((3, 3)) - np.eye(3), triples)
    assert message in str(caught.value)


def test_menger_curvature_refuses_what_is_no_metric():
    with pytest.raises(NotAMetricError) as caught:
        menger_curvature([[0, 1], [2, 0]], [[0, 1, 1]])
    assert caught.value.witness == (0, 1)


def test_haantjes_curvature_of_exceptions():
    arcs = [2.0, 1.0, 1.0, 1.0, 0.0, -1.0, nan, math.inf, 1.0, 1.0]
    chords = [1.0, 1.0, 1 + 1e-12, 1 + 1e-8, 0.0, -1.0, 0.5, 1.0, nan, 0.0]
    expected = [math.sqrt(3), 0, 0, nan, nan, nan, nan, nan, nan, math.sqrt(24)]
    np.testing.assert_allclose(haantjes_curvature(arcs, chords), expected, rtol=1e-15)


def test_arc_length_of_exceptions():
    expected = [0, 2 * (1 + 4 / 24), 2 * (1 + 4 / 24), 2, nan, nan, nan]
    np.testing.assert_allclose(arc_length([0, 2, 2, 2, -1, nan, 1], [1, 1, -1, 0, 1, 1, nan]), expected, rtol=1e-15)


@pytest.mark.parametrize("f", [haantjes_curvature, arc_length])
def test_shapes_broadcast(f):
    assert f(np.ones((3, 1)), 0.5).shape == (3, 1)
    assert f(np.ones((3, 1)), np.ones(2)).shape == (3, 2)
    assert isinstance(f(1.0, 0.5), float)
    with pytest.raises(rinow.InvalidInputError, match=r"shapes \(2,\) and \(3,\)"):
        f(np.ones(2), np.ones(3))
    with pytest.raises(rinow.InvalidInputError, match="give real numbers"):
        f(1j, 1)


# ------------------------------------------------------------------ curves


@pytest.mark.parametrize("kind", KINDS)
def test_closed_and_open_regular_polygon(kind):
    n = 12
    polygon = plane(3 * turn(np.arange(n) * 360 / n))
    closed = curve_curvature(polygon, kind=kind, closed=True)
    expected = {"menger": 1 / 3, "alt": 1 / 3, "haantjes": 1 / 3 / math.cos(math.pi / n / 2)}[kind]
    np.testing.assert_allclose(closed, expected, rtol=1e-13)
    np.testing.assert_allclose(curve_curvature(polygon, kind=kind), closed, rtol=1e-12)
    # Rounding from distances: 10 eps/(turn of an edge)², times 10 for the extrapolation at the ends.
    np.testing.assert_allclose(curve_curvature(distances(polygon), kind=kind), closed, rtol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_straight_lines_have_curvature_0(kind):
    along = np.array([[1.0], [2.0], [4.0], [5.0], [5.5], [7.0], [8.0]])
    assert not curve_curvature(along, kind=kind).any()
    assert not curve_curvature(np.abs(along - along.T), kind=kind).any()
    # Thirds are rounded: eps/h² times the size 8, h = 0.5, and 7 for the extrapolation at the ends.
    assert (curve_curvature(along * np.array([1, 2, 2]) / 3, kind=kind) < 7 * 8 * 2.2e-16 / 0.25).all()


def test_turning_back_is_linear_for_menger():
    # The middle point is beyond both others: a linear triple, though the arc is longer than its chord.
    points = np.array([[0.0, 0], [3, 3], [1, 1]])
    assert (curve_curvature(points) < 1e-15).all()
    assert (curve_curvature(points, kind="haantjes") > 0.5).all()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("n", [0, 1, 2])
def test_short_curves_have_no_curvature(kind, n):
    actual = curve_curvature(np.zeros((n, 3)), kind=kind)
    assert actual.shape == (n,)
    assert np.isnan(actual).all()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("n", [3, 4])
def test_reach_is_cut_on_short_curves(kind, closed, n):
    points = plane(turn(np.arange(n) * 20.0))
    cut = curve_curvature(points, kind=kind, closed=closed, reach=1)
    np.testing.assert_array_equal(curve_curvature(points, kind=kind, closed=closed, reach=9), cut)


def test_ends_of_an_open_curve():
    points = plane([0, 1, 2 + 1j, 2 + 3j, 1j])
    actual = curve_curvature(points)
    expected = [naive.menger(*points[i : i + 3].tolist()) for i in (0, 0, 1, 2, 2)]
    np.testing.assert_allclose(actual, expected, rtol=1e-14)
    # The triple of a point near the end has the point itself in the middle.
    expected = [naive.menger(*points[[0, j, 4]].tolist()) for j in (1, 1, 2, 3, 3)]
    np.testing.assert_allclose(curve_curvature(points, reach=2), expected, rtol=1e-14)
    expected = [naive.haantjes(points.tolist())] * 5
    np.testing.assert_allclose(curve_curvature(points, kind="haantjes", reach=2), expected, rtol=1e-14)


def test_closed_curves_go_on_over_their_ends():
    points = plane([0, 1, 2 + 1j, 2 + 3j, 1j])
    around = np.arange(-1, 6) % 5
    expected = [naive.menger(*points[around[i : i + 3]].tolist()) for i in range(5)]
    np.testing.assert_allclose(curve_curvature(points, closed=True), expected, rtol=1e-14)


@pytest.mark.parametrize("kind", KINDS)
def test_bad_points_spoil_their_neighbourhood_only(kind):
    points = plane(turn(np.arange(24) * 10.0))
    clean = curve_curvature(points, kind=kind)
    reach = 2 if kind == "alt" else 1
    for bad in (nan, math.inf):
        points[11, 0] = bad
        spoiled = np.abs(np.arange(24) - 11) <= reach
        np.testing.assert_array_equal(curve_curvature(points, kind=kind), np.where(spoiled, nan, clean))


def test_points_that_coincide():
    z = turn(np.array([0, 10, 20, 30, 40, 40, 50, 60, 70, 80]))
    for kind in ("menger", "haantjes"):
        np.testing.assert_array_equal(np.flatnonzero(np.isnan(curve_curvature(plane(z), kind=kind))), [4, 5])
    assert np.isnan(curve_curvature(plane(z), kind="alt")[3:7]).all()
    # An arc with a third side is still an arc.
    assert np.isfinite(curve_curvature(plane(z), kind="haantjes", reach=2)).all()
    assert np.isnan(curve_curvature(np.ones((5, 2)), kind="haantjes")).all()
    # An arc that ends where it began has the excess L = 2 over the chord 0: 24 L/(L³ - 1 - 1).
    assert curve_curvature([[0.0], [1.0], [0.0]], kind="haantjes")[1] == pytest.approx(math.sqrt(8), rel=1e-15)


def test_alt_curvature_at_chosen_points():
    points = plane(np.linspace(0, 2, 15) ** 2 + 1j * np.linspace(0, 2, 15))
    along = curve_curvature(points, kind="alt")
    index = np.array([[3, 0], [14, 3]])
    np.testing.assert_array_equal(alt_curvature(points, index), along[index])
    np.testing.assert_array_equal(
        alt_curvature(distances(points), index, reach=3)[1], alt_curvature(distances(points), [14, 3], reach=3)
    )
    value = alt_curvature(points, 5)
    assert isinstance(value, float)
    assert value == along[5]
    np.testing.assert_array_equal(alt_curvature(points, [], closed=True), [])
    with pytest.raises(rinow.InvalidInputError, match=r"index\[1\] = 15 is outside 0\.\.14"):
        alt_curvature(points, [0, 15])


def test_wide_reach_averages_noise():
    # Ten times the reach divides the effect of noise on Menger curvature by about a hundred.
    rng = np.random.default_rng(17)
    points = plane(turn(np.arange(360.0))) + rng.normal(0, 1e-4, (360, 2))
    error = [np.std(curve_curvature(points, closed=True, reach=reach) - 1) for reach in (1, 10)]
    assert 60 < error[0] / error[1] < 140


# ------------------------------------------------------------------ points or distances


def test_distances_are_recognised():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 2, 0]])
    D = distances(points)
    expected = curve_curvature(points)
    np.testing.assert_allclose(curve_curvature(D), expected, rtol=1e-15)
    D[0, 1] *= 1 + 1e-15
    np.testing.assert_allclose(curve_curvature(D), expected, rtol=1e-15)


def test_the_caller_decides_what_is_ambiguous():
    points = np.array([[0.0, 1, 2], [1, 0, 3], [2, 3, 0]])
    np.testing.assert_array_equal(curve_curvature(points), curve_curvature(points, distances=True))
    as_points = curve_curvature(points, distances=False)
    np.testing.assert_allclose(as_points, naive.menger(*points.tolist()), rtol=1e-14)
    assert (as_points != curve_curvature(points)).all()
    points[0, 2] = math.inf
    assert np.isnan(curve_curvature(points)).all()
    with pytest.raises(NotAMetricError, match="on the diagonal"):
        points[0, 2] = 2
        curve_curvature(points + np.eye(3), distances=True)
    with pytest.raises(rinow.InvalidInputError, match="give a square matrix"):
        curve_curvature(points[:2], distances=True)


@pytest.mark.parametrize(("value", "message"), [(nan, "is not finite"), (-1.0, "is negative")])
def test_distances_with_a_fault_are_not_taken_for_points(value, message):
    D = distances(np.arange(8.0).reshape(4, 2))
    D[1], D[:, 1] = value, value
    D[1, 1] = nan if math.isnan(value) else 0
    with pytest.raises(NotAMetricError, match=message):
        curve_curvature(D)


@pytest.mark.parametrize(
    ("points", "options", "message"),
    [
        (np.zeros(3), {}, "shape (3,); give one point per row"),
        ("abc", {}, "give real numbers"),
        (np.zeros((3, 2)), {"kind": "frenet"}, "kind = 'frenet' is unknown; give one of menger, haantjes, alt"),
        (np.zeros((3, 2)), {"reach": 0}, "reach = 0 leaves no neighbours"),
    ],
)
def test_faults_of_arguments_are_named(points, options, message):
    with pytest.raises(rinow.InvalidInputError) as caught:
        curve_curvature(points, **options)
    assert message in str(caught.value)
