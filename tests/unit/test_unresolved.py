"""Detail told from noise: the residuals of stars at neighbouring vertices."""

import numpy as np

import rinow
import shapes
from rinow.curvature.sectional import sectional
from rinow.curvature.steiner import circumcentric_areas, steiner_curvatures
from rinow.curvature.unresolved import with_detail

FREQUENCY, HEIGHT = 16.5, 0.012
"""Waves of 5.5 spacings on 3000 vertices of a sphere, whose slopes reach about 1."""


def folded_sphere():
    """The surface |x| = 1 + a sum of plane waves: vertices, faces, exact curvatures and normals."""
    u, F = shapes.irregular_sphere(3000)[:2]
    waves = np.random.default_rng(7).normal(size=(12, 3))
    waves *= FREQUENCY / np.linalg.norm(waves, axis=1)[:, None]
    low, high = np.full(len(u), 0.5), np.full(len(u), 1.5)
    for _ in range(50):
        r = 0.5 * (low + high)
        is_inside = r - 1.0 < HEIGHT * np.cos(r[:, None] * u @ waves.T).sum(axis=1)
        low, high = np.where(is_inside, r, low), np.where(is_inside, high, r)
    V = low[:, None] * u
    gradient = u + HEIGHT * np.sin(V @ waves.T) @ waves
    hessian = (np.eye(3) - u[:, :, None] * u[:, None]) / low[:, None, None]
    hessian += HEIGHT * np.einsum("nm,mi,mj->nij", np.cos(V @ waves.T), waves, waves)
    slope = np.linalg.norm(gradient, axis=1)[:, None]
    normals = gradient / slope
    tangential = np.eye(3) - normals[:, :, None] * normals[:, None]
    form = tangential @ hessian @ tangential / slope[:, None]
    H = 0.5 * np.trace(form, axis1=1, axis2=2)
    K = 2.0 * H**2 - 0.5 * np.einsum("nij,nji->n", form, form)
    return V, F, K, H, normals


def relative_error(found, exact):
    return np.linalg.norm(found - exact) / np.linalg.norm(exact)


def test_independent_noise_is_no_detail():
    V, F = shapes.noisy(shapes.irregular_torus(2000), 0.05)[:2]
    mesh = rinow.TriangleMesh(V, F)
    estimate = sectional(mesh)
    np.testing.assert_array_equal(with_detail(mesh, estimate).gaussian, estimate.gaussian)


def test_smooth_surfaces_without_noise_are_left_alone():
    V, F = shapes.irregular_torus(2000)[:2]
    mesh = rinow.TriangleMesh(V, F)
    estimate = sectional(mesh)
    assert with_detail(mesh, estimate) is estimate


def test_folds_near_the_spacing_are_detail():
    V, F, K, H, _ = folded_sphere()
    mesh = rinow.TriangleMesh(V, F)
    fit, rings = sectional(mesh), rinow.surface_curvature(mesh, method="lifted")
    found = with_detail(mesh, fit)
    for name, exact in (("mean", H), ("gaussian", K)):
        error, of_fits, of_rings = (relative_error(getattr(x, name), exact) for x in (found, fit, rings))
        assert error < 0.6 * of_fits
        assert error < 0.95 * of_rings


def test_noise_on_folds_keeps_the_estimate_from_single_rings():
    V, F, K, H, normal = folded_sphere()
    h = rinow.TriangleMesh(V, F).edge_lengths.mean()
    V = V + normal * np.random.default_rng(11).normal(size=(len(V), 1)) * 0.03 * h
    mesh = rinow.TriangleMesh(V, F)
    found = rinow.surface_curvature(mesh)
    gaussian, mean = steiner_curvatures(mesh)
    assert relative_error(found.mean, H) < 0.8 * relative_error(mean, H)
    assert relative_error(found.gaussian, K) < 0.9 * relative_error(gaussian, K)


def test_steiner_formula_of_a_cube():
    # Twelve edges of length 1 that turn by a right angle, eight corners of a right angle and a half.
    mesh = rinow.TriangleMesh(*shapes.cube()[:2])
    gaussian, mean = steiner_curvatures(mesh)
    area = circumcentric_areas(mesh)
    np.testing.assert_allclose(area.sum(), mesh.face_areas.sum(), rtol=1e-14)
    np.testing.assert_allclose(gaussian * area, 0.5 * np.pi, rtol=1e-14)
    np.testing.assert_allclose((mean * area).sum(), 3.0 * np.pi * mesh.edge_lengths.min(), rtol=1e-14)


def test_areas_of_obtuse_faces_are_halved_and_quartered():
    mesh = rinow.TriangleMesh([(0, 0, 0), (4, 0, 0), (2, 0.5, 0)], [(0, 1, 2)])
    np.testing.assert_allclose(circumcentric_areas(mesh), [0.25, 0.25, 0.5])


def test_without_orientation_there_is_no_mean_curvature():
    mesh = rinow.TriangleMesh(*shapes.moebius_strip()[:2])
    gaussian, mean = steiner_curvatures(mesh)
    assert np.isfinite(gaussian[~mesh.topology.vertex_is_boundary]).all()
    assert np.isnan(mean).all()
