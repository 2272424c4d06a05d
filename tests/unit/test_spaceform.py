"""The model surfaces against the laws of cosines, closed forms and their own limits."""

import math

import numpy as np
import pytest

import rinow
from naive import spaceform as naive
from rinow.kernels import spaceform, spaceform_model

CURVATURES = [-25.0, -1.0, -0.1, 0.0, 0.1, 1.0, 2.0]
# Laws of cosines lose eps/(k x²), x >= 0.01, and the square root of that near 0 and π: hence 1e-9, not 1e-15.
NAIVE = 1e-9


def triangles(n, seed):
    """Sides of triangles of perimeter at most 3, so that they fit into every S_k with k <= 4."""
    points = np.random.default_rng(seed).uniform(0, 1, (n, 3, 2))
    sides = np.linalg.norm(points - np.roll(points, 1, axis=1), axis=2)
    return np.minimum(1.0, 3 / sides.sum(axis=1, keepdims=True)) * sides


@pytest.mark.parametrize("k", CURVATURES)
def test_triangles_agree_with_the_laws_of_cosines(k):
    surface = rinow.SpaceForm(k)
    sides = triangles(200, seed=7)
    a, b, c = sides.T
    alpha = surface.angle(a, b, c)
    assert alpha == pytest.approx([naive.angle(*row, k) for row in sides], abs=NAIVE)
    assert surface.area(a, b, c) == pytest.approx([naive.area(*row, k) for row in sides], abs=NAIVE)
    expected = [naive.side(*row, k) for row in zip(b, c, alpha, strict=True)]
    assert surface.side(b, c, alpha) == pytest.approx(expected, abs=NAIVE)
    assert surface.side(b, c, alpha) == pytest.approx(a, rel=1e-13)


@pytest.mark.parametrize("k", CURVATURES)
def test_derivative_of_the_angle_is_its_difference_quotient(k):
    h = 1e-6
    for a, b, c in triangles(50, seed=8):
        difference = spaceform.angle(a, b, c, k + h) - spaceform.angle(a, b, c, k - h)
        # Central differences: error h² plus rounding eps/h, both 1e-10 here, relative to slopes down to 1e-3.
        assert spaceform.angle_and_derivative(a, b, c, k)[1] == pytest.approx(difference / (2 * h), rel=1e-5, abs=1e-9)


def test_derivative_of_the_angle_at_zero_is_a_third_of_the_area():
    for a, b, c in triangles(50, seed=9):
        third = rinow.SpaceForm(0.0).area(a, b, c) / 3
        assert spaceform.angle_and_derivative(a, b, c, 0.0)[1] == pytest.approx(third, rel=1e-13)


def test_octant_hemisphere_and_lune():
    sphere, quarter = rinow.SpaceForm(4.0), math.pi / 4
    assert sphere.angle(quarter, quarter, quarter) == pytest.approx(math.pi / 2, rel=1e-15)
    assert sphere.area(quarter, quarter, quarter) == pytest.approx(math.pi / 8, rel=1e-15)
    # Three points on a great circle: the area has a square root singularity there.
    assert sphere.area(math.pi / 3, math.pi / 3, math.pi / 3) == pytest.approx(math.pi / 2, rel=1e-7)
    assert sphere.angle(math.pi / 2, 0.5, math.pi / 2 - 0.5) == math.pi
    assert np.isnan(sphere.angle(1.2, 1.2, 1.2))
    assert np.isnan(sphere.area(1.2, 1.2, 1.2))


def test_ideal_triangle_of_the_hyperbolic_plane():
    plane = rinow.SpaceForm(-4.0)
    assert plane.area(60.0, 60.0, 60.0) == pytest.approx(math.pi / 4, rel=1e-15)
    # Base angle of a long isosceles triangle: ln tan(angle/2) = -√-k c/2 up to e^-√-k c.
    assert math.log(plane.angle(200.0, 100.0, 200.0) / 2) == pytest.approx(-100.0, rel=1e-12)


def test_lengths_of_ten_thousand_radii_do_not_overflow():
    k = -1e8
    alpha = 2 * math.asin(math.exp(-300.0))
    # Hinge with the angle e^-300: the third side is b + c - 2·300/√-k.
    assert spaceform.side(1.0, 1.0, alpha, k) == pytest.approx(2 - 600 / 1e4, rel=1e-14)
    assert spaceform.angle(2 - 600 / 1e4, 1.0, 1.0, k) == pytest.approx(alpha, rel=1e-10)
    assert spaceform.side(1.0, 0.25, 0.0, k) == 0.75
    assert spaceform.side(1.0, 0.25, math.pi, k) == 1.25
    assert spaceform.area(1.0, 1.0, 1.0, k) == pytest.approx(math.pi / 1e8, rel=1e-15)


@pytest.mark.parametrize("k", CURVATURES)
def test_degenerate_triangles_have_their_limits(k):
    surface = rinow.SpaceForm(k)
    assert surface.angle(0.0, 0.5, 0.5) == 0
    assert surface.angle(0.5, 0.0, 0.5) == surface.angle(0.5, 0.5, 0.0) == math.pi / 2
    assert surface.angle(0.0, 0.0, 0.0) == math.pi / 3
    assert surface.angle(0.75, 0.5, 0.25) == math.pi
    assert surface.angle(0.25, 0.5, 0.75) == 0
    assert surface.area(0.75, 0.5, 0.25) == 0
    assert spaceform.angle_and_derivative(0.75, 0.5, 0.25, k)[1] == 0
    for bad in ([1, 0.3, 0.3], [-0.1, 0.1, 0.1], [np.nan, 1, 1], [np.inf, np.inf, 1]):
        assert np.isnan(surface.angle(*bad))
        assert np.isnan(surface.area(*bad))
    assert np.isnan(surface.side(-0.1, 1, 1))


@pytest.mark.parametrize("k", [*CURVATURES, -1e4, 1e-12])
def test_sampled_points_are_even_and_their_distances_right(k):
    surface = rinow.SpaceForm(k)
    radius = min(0.9, surface.diameter)
    points = surface.sample(3000, radius, np.random.default_rng(11))
    origin = surface.distance(points, [0, 0, 0])
    assert origin.max() <= radius
    if k in (-1, 0, 1):  # the inner products of the naive twin cancel for large and for small k
        x, y, z = points.T
        assert x * x + y * y + k * z * z == pytest.approx(2 * z, rel=1e-14)
        expected = [naive.distance(p, q, k) for p, q in zip(points[::2], points[1::2], strict=True)]
        assert surface.distance(points[::2], points[1::2]) == pytest.approx(expected, rel=1e-6, abs=1e-9)
    # Half the area lies within the radius r with s(r/2)² = s(radius/2)²/2; 4 standard deviations of 3000 points.
    half = spaceform.sine(radius / 2, k) ** 2 / 2
    inside = np.mean([spaceform.sine(r / 2, k) ** 2 < half for r in origin])
    assert abs(inside - 0.5) < 4 * 0.5 / 3000**0.5


@pytest.mark.parametrize("k", [-1.0, 0.0, 1.0])
def test_distance_of_near_points_keeps_its_digits(k):
    # The points lie on one ray; their coordinates are good to eps, so the distance is to eps·radius = 1e-16.
    near = np.empty((2, 3))
    for point, r in zip(near, (0.5, 0.5 + 1e-9), strict=True):
        spaceform_model.place(r, 0.3, k, point)
    assert rinow.SpaceForm(k).distance(*near) == pytest.approx(1e-9, abs=3e-16)


def test_opposite_points_of_a_sphere():
    points = np.empty((2, 3))
    spaceform_model.place(0.3, 0.0, 4.0, points[0])
    spaceform_model.place(math.pi / 2 - 0.3, math.pi, 4.0, points[1])
    assert rinow.SpaceForm(4.0).distance(*points) == pytest.approx(math.pi / 2, rel=1e-15)


@pytest.mark.parametrize("k", [-1e4, -1.0, 0.0, 1e-9, 1.0, 9.0])
def test_embedded_quadruples_have_the_given_distances(k):
    surface = rinow.SpaceForm(k)
    points = surface.sample(400, 0.5, np.random.default_rng(12)).reshape(10, 10, 4, 3)
    i, j = np.triu_indices(4, 1)
    quadruples = surface.distance(points[..., i, :], points[..., j, :])
    copies = surface.embed(quadruples)
    assert copies.shape == (10, 10, 4, 3)
    actual = surface.distance(copies[..., i, :], copies[..., j, :])
    # Every distance but one is set by construction, the sixth by the best of twelve: 10 roundings.
    assert np.abs(actual - quadruples).max() <= 1e-14 * quadruples.max()


def test_embedding_into_the_wrong_surface_is_nan():
    square = [1, 2**0.5, 1, 1, 2**0.5, 1]
    assert np.isfinite(rinow.SpaceForm(0.0).embed(square)).all()
    assert np.isnan(rinow.SpaceForm(0.5).embed(square)).all()
    assert np.isfinite(rinow.SpaceForm(0.5).embed(square, rtol=1.0)).all()
    rows = [square, [np.nan] * 6, [1, 3, 1, 1, 1, 1], [1, 5, 1, 5, 1, 5], [-1, 1, 1, 1, 1, 1]]
    assert np.isnan(rinow.SpaceForm(0.0).embed(rows, rtol=0.1)).all(axis=(1, 2)).tolist() == [False] + [True] * 4


def test_a_lune_and_a_full_circle_embed():
    points = rinow.SpaceForm((math.pi / 2) ** 2).embed([1, 2, 0.8, 1, 0.9, 1.2], rtol=1e-7)
    assert np.isfinite(points).all()
    points = rinow.SpaceForm((math.pi / 3) ** 2).embed([1, 3, 2, 2, 3, 1], rtol=1e-7)
    assert np.isfinite(points).all()


def test_values_are_frozen_and_input_is_checked():
    surface = rinow.SpaceForm(1)
    assert surface.curvature == 1.0
    assert surface == rinow.SpaceForm(1.0)
    with pytest.raises(AttributeError):
        surface.curvature = 2.0
    for bad in (np.nan, np.inf, "one", [1.0], 1j):
        with pytest.raises(rinow.InvalidInputError, match="curvature"):
            rinow.SpaceForm(bad)
    with pytest.raises(rinow.InvalidInputError, match="quadruple has shape"):
        surface.embed([1, 2, 3])
    with pytest.raises(rinow.InvalidInputError, match="x has shape"):
        surface.distance([1, 2], [1, 2, 3])
    with pytest.raises(rinow.InvalidInputError, match="do not fit together"):
        surface.angle([1, 2], [1, 2, 3], 1)
    for n, radius in ((-1, 1.0), (1, 4.0), (1, -1.0), (1, np.nan)):
        with pytest.raises(rinow.InvalidInputError, match="radius"):
            surface.sample(n, radius, np.random.default_rng(13))
    assert surface.sample(0, 1.0, np.random.default_rng(13)).shape == (0, 3)
    assert surface.angle(np.ones((2, 1)), np.ones(3), 1.0).shape == (2, 3)
    assert surface.distance(np.empty((0, 3)), np.zeros(3)).shape == (0,)
