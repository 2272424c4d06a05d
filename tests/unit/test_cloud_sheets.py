"""Which points make one sheet: strays, parts, spheres less than a spacing apart, and sheets at random."""

import numpy as np
import pytest

import rinow
import shapes
from rinow import VertexStatus
from rinow.curvature.cloud_layers import nearest_points
from rinow.curvature.cloud_sheet import cloud_sheet


def test_strays_are_left_out():
    torus = shapes.irregular_torus(1500)
    n, rng = len(torus.vertices), np.random.default_rng(8)
    mesh = rinow.TriangleMesh(torus.vertices, torus.faces)
    lifted = rng.choice(n, n // 20, replace=False)
    offsets = rng.choice([-1.5, 1.5], (len(lifted), 1)) * mesh.mean_edge_length
    strays = torus.vertices[lifted] + offsets * mesh.vertex_normals[lifted]
    cloud = rinow.point_cloud_curvature(np.concatenate([torus.vertices, strays]))
    is_left_out = cloud.status == VertexStatus.UNRESOLVED
    assert is_left_out[n:].mean() > 0.9 and not is_left_out[:n].any()
    assert any("lie beside the surface" in note for note in cloud.notes)
    # Without strays the error is 1e-3; one of 36 points that far off bends a quadric by 0.1 of the curvature.
    assert np.median(np.abs(cloud.gaussian[:n] - torus.gaussian)) < 0.02


def test_noise_is_no_stray():
    for seed in (3, 4):
        noisy = shapes.noisy(shapes.irregular_torus(1500), 0.1, seed=seed)
        assert (rinow.point_cloud_curvature(noisy.vertices).status != VertexStatus.UNRESOLVED).all()


def test_signs_of_two_parts_and_of_a_noisy_torus():
    torus = shapes.noisy(shapes.irregular_torus(1500), 0.05)
    n, outer = len(torus.vertices), torus.mean > 0.5
    sphere = shapes.irregular_sphere(400)
    cloud = rinow.point_cloud_curvature(np.concatenate([torus.vertices, 0.3 * sphere.vertices + [0, 0, 3]]))
    assert (cloud.mean[:n][outer] > 0).all()
    np.testing.assert_allclose(cloud.mean[n:], 1 / 0.3, rtol=1e-6)
    # A point far above is no reason to turn the torus.
    above = rinow.point_cloud_curvature(np.concatenate([torus.vertices, [[0.5, 0, 5]]]))
    assert (above.mean[:n][outer] > 0).all()


def two_spheres(gap, noise=0.0):
    """Points of the unit sphere and of one so many spacings inside it, with the exact curvature."""
    outer, rng = shapes.irregular_sphere(1500), np.random.default_rng(9)
    h = np.sqrt(4 * np.pi / 1500)
    r = 1 - gap * h
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    points = np.concatenate([outer.vertices, r * shapes.irregular_sphere(int(1500 * r * r)).vertices @ turn])
    exact = np.where(np.arange(len(points)) < len(outer.vertices), 1.0, r**-2)
    return points + noise * h * rng.normal(size=points.shape), exact


@pytest.mark.parametrize("gap", [1.5, 2.0, 3.0])
@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_two_close_spheres_are_two(gap, noise):
    points, exact = two_spheres(gap, noise)
    cloud = rinow.point_cloud_curvature(points)
    has_value = np.isfinite(cloud.gaussian)
    # Taken for one sheet they are noise of one spacing: errors of 0.1 to 40 at points with status OK.
    assert has_value.mean() > 0.95
    assert np.abs(cloud.gaussian / exact - 1)[has_value].max() < 0.1


@pytest.mark.parametrize(("gap", "least"), [(0.7, 0.4), (0.85, 0.5), (1.0, 0.95)])
def test_spheres_less_than_a_spacing_apart_are_right_or_unresolved(gap, least):
    points, exact = two_spheres(gap, 0.02)
    cloud = rinow.point_cloud_curvature(points)
    has_value = np.isfinite(cloud.gaussian)
    assert has_value.mean() > least
    assert np.abs(cloud.gaussian / exact - 1)[has_value].max() < 0.1


def test_order_and_rotation_of_two_close_spheres():
    points, _ = two_spheres(1.0)
    cloud, rng = rinow.point_cloud_curvature(points), np.random.default_rng(6)
    order = rng.permutation(len(points))
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    other = rinow.point_cloud_curvature(points[order])
    np.testing.assert_array_equal(other.gaussian, cloud.gaussian[order])
    turned = rinow.point_cloud_curvature(points @ turn + [3, 1, 2])
    np.testing.assert_array_equal(turned.status, cloud.status)
    np.testing.assert_allclose(turned.gaussian, cloud.gaussian, rtol=1e-9)  # fits to spheres, which are exact
    # The signs are those of each sphere, whatever lies across.
    assert (cloud.mean > 0).all() and (turned.mean > 0).all()


@pytest.mark.parametrize(("gap", "least"), [(1.2, 0.4), (1.5, 0.75), (2.0, 0.95)])
def test_random_sheets_are_told_or_say_so(gap, least):
    rng = np.random.default_rng(3)
    points = np.column_stack([rng.uniform(0, 30, (1800, 2)), np.repeat([0.0, gap], 900)])
    cloud = rinow.point_cloud_curvature(points)
    inside = np.abs(points[:, :2] - 15).max(axis=1) < 10
    has_value = inside & np.isfinite(cloud.gaussian)
    assert has_value.sum() > least * inside.sum()
    # Errors of two sheets taken for one with detail reach the inverse square of the spacing, in 0.3 of the values.
    is_wrong = has_value & (np.abs(cloud.gaussian) > 1e-2)
    assert is_wrong.sum() < 0.1 * has_value.sum()
    is_hidden = is_wrong & (np.abs(cloud.gaussian) > 2 * cloud.spread)
    assert is_hidden.sum() <= 0.1 * is_wrong.sum()


@pytest.mark.parametrize("noise", [0.0, 0.1, 0.2])
def test_triangles_are_one_closed_surface(noise):
    points = shapes.noisy(shapes.irregular_torus(1500), noise).vertices
    cloud = cloud_sheet(points, *nearest_points(points))
    mesh = rinow.TriangleMesh(points, cloud.faces)
    t = mesh.topology
    # Stars disagree in 0.03 of the points at noise 0.2, and left as many holes and fins.
    assert t.vertex_is_manifold.mean() > 0.995
    assert np.mean(t.vertex_is_boundary | ~t.vertex_is_used) < 0.002 + 0.05 * noise


@pytest.mark.parametrize("height", [3.0, 6.0])
def test_many_strays_far_above_are_left_out(height):
    # One draw has 125 strays, of which 0.86 to 1 are left out; 0.6 would be by their offsets alone.
    torus, shares = shapes.irregular_torus(2500), []
    n, mesh = len(torus.vertices), rinow.TriangleMesh(torus.vertices, torus.faces)
    for seed in (11, 12, 13):
        lifted = np.random.default_rng(seed).choice(n, n // 20, replace=False)
        strays = torus.vertices[lifted] + height * mesh.mean_edge_length * mesh.vertex_normals[lifted]
        cloud = rinow.point_cloud_curvature(np.concatenate([torus.vertices, strays]))
        is_left_out = cloud.status == VertexStatus.UNRESOLVED
        shares.append(is_left_out[n:].mean())
        assert is_left_out[:n].mean() < 0.01
    assert np.mean(shares) > 0.9
