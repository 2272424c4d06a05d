"""surface_curvature by each method: closed forms, principal curvatures and directions, radius, spread."""

import numpy as np
import pytest

import shapes
from rinow import TriangleMesh, VertexStatus, surface_curvature
from surface_methods import METHODS, SPHERE, WITH_POSITIONS, curvature


@pytest.mark.parametrize(("method", "tolerance"), [("sectional", 0.02), ("lifted", 0.05), ("wald", 1.5)])
def test_error_on_an_irregular_ellipsoid(method, tolerance):
    shape = shapes.irregular_ellipsoid(1000)
    c = curvature(shape, method=method)
    assert (c.status == VertexStatus.OK).all()
    error = np.sqrt(np.mean((c.gaussian - shape.gaussian) ** 2) / np.mean(shape.gaussian**2))
    assert error < tolerance
    if method in WITH_POSITIONS:
        np.testing.assert_allclose(c.mean, shape.mean, rtol=0.15)
        np.testing.assert_allclose((c.k1 + c.k2) / 2, c.mean, rtol=1e-12)
        assert (c.k1 >= c.k2).all()


def test_principal_curvatures_multiply_to_the_gaussian_one():
    c = curvature(shapes.irregular_torus(1000), method="sectional")
    np.testing.assert_allclose(c.k1 * c.k2, c.gaussian, rtol=1e-12)
    c = curvature(shapes.irregular_torus(1000), method="lifted")
    distinct = c.mean**2 > c.gaussian  # elsewhere k1 = k2 = mean
    np.testing.assert_allclose((c.k1 * c.k2)[distinct], c.gaussian[distinct], rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(c.k1[~distinct], c.mean[~distinct])


@pytest.mark.parametrize("method", WITH_POSITIONS)
def test_shape_index_and_curvedness(method):
    c = curvature(shapes.irregular_torus(600), method=method)
    expected = np.where(c.k1 > c.k2, np.arctan((c.k1 + c.k2) / np.where(c.k1 > c.k2, c.k1 - c.k2, 1)) * 2 / np.pi, 1)
    np.testing.assert_allclose(c.shape_index, expected, atol=1e-12)
    np.testing.assert_allclose(c.curvedness**2, (c.k1**2 + c.k2**2) / 2, rtol=1e-12)


@pytest.mark.parametrize("method", WITH_POSITIONS)
def test_directions_are_unit_orthogonal_and_tangential(method):
    shape = shapes.irregular_torus(1500)
    c = curvature(shape, method=method)
    normals = TriangleMesh(shape.vertices, shape.faces).vertex_normals
    np.testing.assert_allclose(np.linalg.norm(c.direction1, axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(c.direction2, axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(np.sum(c.direction1 * c.direction2, axis=1), 0, atol=1e-12)
    # Normals of stars are exact to about (k h)^2, h = 0.12 and k = 2.5 at most.
    assert np.abs(np.sum(c.direction1 * normals, axis=1)).max() < 0.15


@pytest.mark.parametrize("method", METHODS)
def test_methods_without_positions_know_the_gaussian_curvature_only(method):
    c = curvature(SPHERE, method=method)
    for name in ("mean", "k1", "k2", "shape_index", "curvedness", "direction1", "direction2"):
        values = getattr(c, name)
        assert values.shape == ((1000, 3) if name.startswith("direction") else (1000,))
        assert np.isfinite(values).all() if method in WITH_POSITIONS else np.isnan(values).all()
    assert c.method == method
    assert np.isfinite(c.spread).all()


@pytest.mark.parametrize("method", METHODS)
def test_a_flat_sheet_is_flat(method):
    flat = shapes.open_patch(400)
    flat = flat._replace(vertices=flat.vertices * (1, 1, 0))
    c = curvature(flat, method=method)
    ok = c.status == VertexStatus.OK
    np.testing.assert_allclose(c.gaussian[ok], 0.0, atol=1e-10)  # angles to 1e-15 over areas of 1e-3
    if method in WITH_POSITIONS:
        np.testing.assert_allclose(c.mean, 0.0, atol=1e-12)


@pytest.mark.parametrize("method", ("wald", "angle_defect"))
def test_intrinsic_mesh_and_triangle_mesh_agree(method):
    mesh = TriangleMesh(SPHERE.vertices, SPHERE.faces)
    a, b = surface_curvature(mesh, method=method), surface_curvature(mesh.intrinsic(), method=method)
    np.testing.assert_array_equal(a.gaussian, b.gaussian)
    np.testing.assert_array_equal(a.spread, b.spread)


def test_wald_of_a_regular_tetrahedron():
    c = curvature(shapes.tetrahedron(), method="wald")  # edges of length 8 ** 0.5
    np.testing.assert_allclose(c.gaussian, np.arccos(-1 / 3) ** 2 / 8, rtol=1e-13)


def test_too_few_neighbours_for_a_quadric_leave_the_circumscribed_sphere():
    c = curvature(shapes.tetrahedron(), method="sectional")  # on a sphere of radius 3 ** 0.5
    np.testing.assert_allclose([c.k1, c.k2], 3**-0.5, rtol=0.03)  # not exact by the softened distances
    assert np.isnan(c.spread).all()  # three circles, three unknowns


@pytest.mark.parametrize("name", shapes.closed_shapes())
def test_angle_defects_sum_to_the_euler_characteristic(name):
    shape = shapes.closed_shapes()[name]
    mesh = TriangleMesh(shape.vertices, shape.faces)
    total = np.sum(surface_curvature(mesh, method="angle_defect").gaussian * mesh.vertex_areas)
    assert total == pytest.approx(2 * np.pi * mesh.euler_characteristic, abs=1e-9 * mesh.n_vertices)


def test_radius_is_in_units_of_length():
    c = curvature(SPHERE, method="sectional", radius=0.5)
    np.testing.assert_allclose(c.radius, 0.5, rtol=1e-12)
    np.testing.assert_allclose(c.gaussian, 1, rtol=1e-6)
    spacing = TriangleMesh(SPHERE.vertices, SPHERE.faces).mean_edge_length
    default = curvature(SPHERE, method="sectional").radius
    assert (default > 1.5 * spacing).all()
    assert (default < 20 * spacing).all()


def test_a_radius_below_the_edges_leaves_nothing():
    c = curvature(SPHERE, method="sectional", radius=1e-6)
    assert (c.status == VertexStatus.UNRESOLVED).all()
    assert np.isnan(c.gaussian).all()


@pytest.mark.parametrize("method", METHODS)
def test_spread_measures_noise(method):
    # One standard error: between a half and three times the true one over a whole noisy mesh.
    shape = shapes.noisy(SPHERE, 0.02)
    c = curvature(shape, method=method)
    ratio = np.sqrt(np.mean((c.gaussian - 1) ** 2) / np.mean(c.spread**2))
    assert 0.3 < ratio < 2


def test_the_centre_of_a_large_fan_is_no_shortcut_between_its_neighbours():
    # A cone of slope 1 whose apex has 300 neighbours, at distance 1 from the axis: two rings around one of them would
    # be the whole circle.  The mean curvature of the cone is cos(45°)/2 there.
    c = curvature(shapes.cone(300, 6), method="lifted")
    assert (c.status[:-300] == VertexStatus.OK).all()
    np.testing.assert_allclose(c.mean[1:301], 0.5**0.5 / 2, rtol=0.01)


@pytest.mark.parametrize("method", ["wald", "angle_defect"])
def test_a_value_without_others_beside_it_has_a_spread(method):
    c = curvature(shapes.cone(12, 1), method=method)  # all but the apex are at the boundary
    assert c.status[0] == VertexStatus.OK
    assert c.spread[0] == abs(c.gaussian[0]) > 0.0
    assert np.isnan(c.spread[1:]).all()


def test_an_icosahedron_has_the_curvature_of_its_sphere():
    # Two rings reach around it: what faces away must not be fitted.
    V, F = shapes.icosphere(0, radius=2.0)[:2]
    curvature = surface_curvature((V, F))
    np.testing.assert_allclose(curvature.gaussian, 0.25, rtol=1e-9)
    np.testing.assert_allclose(curvature.mean, 0.5, rtol=1e-9)


def test_noise_of_chords_is_left_to_fits():
    # Ten to one stretched, the diagonals at random: errors of neighbouring defects do not cancel as on a regular grid.
    n, m, axes = 12, 200, np.array([1.5, 1.0, 0.7])
    i, j = np.mgrid[:n, :m].reshape(2, -1)
    u, v = 2 * np.pi * j / m, 0.9 * (2 * i / (n - 1) - 1)
    V = axes * np.stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)], axis=1)
    exact = (1 / np.prod(axes) / ((V / axes**2) ** 2).sum(axis=1)) ** 2
    faces = shapes._grid_faces(n, m, np.random.default_rng(4), closed=True)
    faces = faces[np.ptp(faces // m, axis=1) == 1]  # a band: no face leads from the last row to the first
    inside = (i > 0) & (i < n - 1)
    error = [
        np.linalg.norm((surface_curvature((V, faces), method=method).gaussian - exact)[inside])
        for method in ("auto", "sectional")
    ]
    assert error[0] < 1.01 * error[1]
