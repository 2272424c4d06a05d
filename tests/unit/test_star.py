"""Closed stars: regular ones in closed form, points of S_k, four points, rows that are no star."""

import math

import numpy as np
import pytest

import rinow
from naive import closed_stars as naive

EPS = 2.0**-53


def stars(k, n_points, n, seed, radius=0.6):
    """Stars of S_k: radii, chords; no angle at the centre above 2 radians."""
    rng = np.random.default_rng(seed)
    surface = rinow.SpaceForm(k)
    radii = rng.uniform(0.3, 1.0, (n, n_points)) * radius
    angles = rng.uniform(1, 1.5, (n, n_points))
    angles *= 2 * math.pi / angles.sum(axis=1, keepdims=True)
    return radii, surface.side(radii, np.roll(radii, -1, axis=1), angles)


@pytest.mark.parametrize("k", [-25.0, -1.0, -1e-6, 0.0, 1.0, 4.0])
@pytest.mark.parametrize("n_points", [4, 7])
def test_the_curvature_of_stars_of_a_surface_is_found(k, n_points):
    radii, chords = stars(k, n_points, 200, seed=41)
    actual = rinow.star_curvature(radii, chords)
    # Each angle is wrong by a few eps times its condition, at most 1e3 here; their sum grows by a third of the area.
    assert np.abs(actual - k).max() <= 1e4 * EPS * max(abs(k), 1 / 0.3**2)


@pytest.mark.parametrize(("n", "k"), [(3, None), (5, None), (6, 0.0), (7, None)])
def test_regular_stars_have_closed_forms(n, k):
    # Equilateral triangles with n of them around a point: 2 sin(π/n) cosine(1/2) = 1 in S_k.
    actual = rinow.star_curvature([1.0] * n, [1.0] * n)
    half = 0.5 / math.sin(math.pi / n)
    expected = k if k is not None else 4 * (math.acos(half) ** 2 if half <= 1 else -(math.acosh(half) ** 2))
    assert actual == pytest.approx(expected, rel=1e-14, abs=1e-14)


def test_agrees_with_bisection():
    rng = np.random.default_rng(42)
    radii, chords = rng.uniform(0.9, 1.1, (20, 6)), rng.uniform(0.8, 1.2, (20, 6))
    actual = rinow.star_curvature(radii, chords)
    high = [(2 * math.pi / (r + np.roll(r, -1) + c).max()) ** 2 for r, c in zip(radii, chords, strict=True)]
    expected = [naive.curvature(*star, -20.0, top) for *star, top in zip(radii, chords, high, strict=True)]
    assert actual == pytest.approx(expected, abs=1e-9)


def test_three_points_are_a_planar_quadruple():
    radii, chords = stars(0.7, 3, 100, seed=43)
    quadruples = np.stack([*radii.T, chords[:, 0], chords[:, 2], chords[:, 1]], axis=1)
    result = rinow.embedding_curvatures(quadruples)
    assert (result.kind[:, 1] == "planar").all()
    assert rinow.star_curvature(radii, chords) == pytest.approx(result.values[:, 1], rel=1e-11)


def test_turning_and_scaling_a_star():
    radii, chords = stars(-2.0, 6, 50, seed=44)
    expected = rinow.star_curvature(radii, chords)
    turned = rinow.star_curvature(np.roll(radii, 2, axis=1), np.roll(chords, 2, axis=1))
    assert turned == pytest.approx(expected, rel=1e-11)
    assert rinow.star_curvature(1e3 * radii, 1e3 * chords) == pytest.approx(1e-6 * expected, rel=1e-10)


def test_rows_that_are_no_star_are_nan():
    rows = [([1, 1, 1], [1, 1, 1]), ([1, 1, 1], [3, 1, 1]), ([1, 1, np.nan], [1, 1, 1]), ([1, -1, 1], [1, 1, 1])]
    radii, chords = (np.array(part, float) for part in zip(*rows, strict=True))
    assert np.isnan(rinow.star_curvature(radii, chords)).tolist() == [False, True, True, True]
    # One wide triangle and two thin ones: where the first is a great circle, the others still lack half a turn.
    assert np.isnan(rinow.star_curvature([1] * 3, [1, 0.1, 0.1]))


def test_batches_have_the_shape_of_their_leading_axes():
    assert rinow.star_curvature(np.ones((2, 3, 6)), np.ones((2, 3, 6))).shape == (2, 3)
    assert rinow.star_curvature(np.ones((0, 6)), np.ones((0, 6))).shape == (0,)
    for radii, chords in ((np.ones(3), np.ones(4)), (np.ones(2), np.ones(2)), (1.0, 1.0), (["a"] * 3, np.ones(3))):
        with pytest.raises(rinow.InvalidInputError, match="radii"):
            rinow.star_curvature(radii, chords)
