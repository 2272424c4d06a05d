"""Clouds of points: mirror images."""

import numpy as np
import pytest

import rinow
import shapes
from rinow.curvature.cloud_hands import hands
from rinow.curvature.cloud_layers import nearest_points
from rinow.curvature.cloud_signs import outward
from rinow.curvature.cloud_stars import first_stars, links_of


def oriented(points):
    near = nearest_points(points).indices
    normals, stars = first_stars(points, near)
    links = links_of(stars)
    return outward(points, normals, links), near, links


@pytest.mark.parametrize("noise", [0.0, 0.05])
@pytest.mark.parametrize("name", ["irregular_torus", "open_patch"])
def test_a_mirror_image_has_the_same_curvature(name, noise):
    points = shapes.noisy(getattr(shapes, name)(900), noise).vertices
    cloud = rinow.point_cloud_curvature(points)
    image = rinow.point_cloud_curvature(points * [1, -1, 1])
    np.testing.assert_array_equal(image.status, cloud.status)
    for key in ("gaussian", "mean"):
        value, other = getattr(cloud, key), getattr(image, key)
        # Where two choices are the same up to rounding the order of sums decides, at a few points; stars of another
        # hand changed most values, at borders by more than a spread.
        assert np.quantile(np.abs(other - value), 0.9) < 1e-8 * np.abs(value).max()
    assert (np.abs(image.gaussian - cloud.gaussian) < cloud.spread).all()


def test_hands_are_those_of_each_part():
    torus, sphere = shapes.irregular_torus(400).vertices, np.add(shapes.irregular_sphere(300).vertices, (9, 0, 0))
    whole = hands(np.concatenate([torus, sphere]), *oriented(np.concatenate([torus, sphere])))
    for part, own in ((torus, whole[: len(torus)]), (sphere, whole[len(torus) :])):
        np.testing.assert_array_equal(hands(part, *oriented(part)), own)
        np.testing.assert_array_equal(hands(part * [1, 1, -1], *oriented(part * [1, 1, -1])), -own)
        normals, near, links = oriented(part)
        np.testing.assert_array_equal(hands(part, -normals, near, links), -own)
    # A symmetric part has no hand, whatever rounding does.
    squares = np.stack(np.meshgrid(np.arange(12.0), np.arange(14.0), [0.0]), axis=-1).reshape(-1, 3)
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    for points in (squares, squares @ turn):
        assert (hands(points, *oriented(points)) == 1).all()
