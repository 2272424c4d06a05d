"""Detail told from noise: what estimates of neighbouring vertices have in common."""

from importlib import import_module

import numpy as np
import pytest

import rinow
import shapes
from rinow.curvature.sectional import sectional
from rinow.curvature.unresolved import single_rings, with_detail
from surface_methods import relative_error


def waves(length):
    """Twelve plane waves of a length in spacings, with slopes up to about 1: the function and its derivatives."""
    waves = np.random.default_rng(7).normal(size=(12, 3))
    waves *= 2.0 * np.pi / (SPACING * length) / np.linalg.norm(waves, axis=1)[:, None]
    height = 0.2 / np.linalg.norm(waves[0])

    def values(x):
        phase = x @ waves.T
        hessian = -np.einsum("nm,mi,mj->nij", np.cos(phase), waves, waves)
        return height * np.cos(phase).sum(axis=1), -height * np.sin(phase) @ waves, height * hessian

    return values


def bumps(length):
    """Bells and dents that curve like waves of a length in spacings, with slopes up to about 0.5."""
    rng, width = np.random.default_rng(5), SPACING * length / 5.0
    n = int(1.2 / width**2)
    centres, heights = rng.normal(size=(n, 3)), 0.6 * width * rng.choice((-1.0, 1.0), n)
    centres /= np.linalg.norm(centres, axis=1)[:, None]

    def values(x):
        d = (x[:, None] - centres) / width
        bells = heights * np.exp(-0.5 * (d**2).sum(axis=2))
        hessian = np.einsum("nm,nmi,nmj->nij", bells, d, d) - bells.sum(axis=1)[:, None, None] * np.eye(3)
        return bells.sum(axis=1), -np.einsum("nm,nmi->ni", bells, d) / width, hessian / width**2

    return values


def groove(width, depth):
    """A ditch along the equator, of the shape of a bell; lengths in spacings."""
    width, depth = SPACING * width, SPACING * depth

    def values(x):
        z = x[:, 2] / width
        bell, axis = -depth * np.exp(-0.5 * z * z), np.array([0.0, 0.0, 1.0])
        second = bell * (z * z - 1.0) / width**2
        return bell, -np.outer(bell * z / width, axis), np.multiply.outer(second, np.diag(axis))

    return values


SPHERE = shapes.irregular_sphere(3000)
SPACING = rinow.TriangleMesh(SPHERE.vertices, SPHERE.faces).mean_edge_length


def folded_sphere(height):
    """The surface |x| = 1 + height(x): vertices, exact curvatures and normals."""
    u = SPHERE.vertices
    low, high = np.full(len(u), 0.5), np.full(len(u), 1.5)
    for _ in range(50):
        r = 0.5 * (low + high)
        is_inside = r - 1.0 < height(r[:, None] * u)[0]
        low, high = np.where(is_inside, r, low), np.where(is_inside, high, r)
    V = low[:, None] * u
    _, gradient, hessian = height(V)
    gradient = u - gradient
    hessian = (np.eye(3) - u[:, :, None] * u[:, None]) / low[:, None, None] - hessian
    slope = np.linalg.norm(gradient, axis=1)[:, None]
    normals = gradient / slope
    tangential = np.eye(3) - normals[:, :, None] * normals[:, None]
    form = tangential @ hessian @ tangential / slope[:, None]
    H = 0.5 * np.trace(form, axis1=1, axis2=2)
    K = 2.0 * H**2 - 0.5 * np.einsum("nij,nji->n", form, form)
    return V, K, H, normals


@pytest.mark.parametrize("noise", (0.001, 0.002, 0.005, 0.02, 0.1))
def test_independent_noise_is_no_detail(noise):
    # With little noise the largest errors of rings are their own, and common to neighbours: no detail either.
    V, F = shapes.irregular_torus(3000)[:2]
    spacing = rinow.TriangleMesh(V, F).mean_edge_length
    mesh = rinow.TriangleMesh(V + np.random.default_rng(3).normal(size=V.shape) * noise * spacing, F)
    estimate = sectional(mesh)
    np.testing.assert_array_equal(with_detail(mesh, estimate).gaussian, estimate.gaussian)


def test_shallow_noise_that_neighbours_share_is_no_detail():
    # Such as scanners leave, or smoothing.  To fits it is noise; rings would take it for curvature.
    V, F, K = shapes.irregular_torus(3000)[:3]
    torus = rinow.TriangleMesh(V, F)
    a, b = torus.topology.edges.T
    noise = np.random.default_rng(5).normal(size=torus.n_vertices)
    for _ in range(2):
        sums = np.bincount(a, noise[b], len(V)) + np.bincount(b, noise[a], len(V))
        noise = 0.5 * (noise + sums / np.bincount(np.r_[a, b]))
    noise *= 0.045 * torus.mean_edge_length / noise.std()
    mesh = rinow.TriangleMesh(V + torus.vertex_normals * noise[:, None], F)
    estimate = sectional(mesh)
    assert relative_error(with_detail(mesh, estimate).gaussian, K) < 1.05 * relative_error(estimate.gaussian, K)


def test_smooth_surfaces_without_noise_are_left_alone():
    V, F = shapes.irregular_torus(2000)[:2]
    mesh = rinow.TriangleMesh(V, F)
    estimate = sectional(mesh)
    assert with_detail(mesh, estimate) is estimate


@pytest.mark.parametrize(
    ("height", "length", "noise"),
    [(waves, 5, 0.0), (waves, 7, 0.0), (waves, 7, 0.01), (bumps, 5, 0.0), (bumps, 7, 0.0), (bumps, 7, 0.03)],
)
def test_folds_of_a_few_spacings_are_detail(height, length, noise, monkeypatch):
    V, K, H, normals = folded_sphere(height(length))
    V = V + normals * np.random.default_rng(11).normal(size=(len(V), 1)) * noise * SPACING
    mesh = rinow.TriangleMesh(V, SPHERE.faces)
    again, rings, single = sectional(mesh), rinow.surface_curvature(mesh, method="lifted"), single_rings(mesh)
    found = with_detail(mesh, again)
    gaussian, mean = relative_error(found.gaussian, K), relative_error(found.mean, H)
    monkeypatch.setattr(import_module("rinow.curvature.sectional"), "look_again", lambda *_: None)
    fit = sectional(mesh)  # of the first look, by which detail is told
    assert gaussian <= relative_error(again.gaussian, K) < relative_error(fit.gaussian, K)
    assert mean <= relative_error(again.mean, H) < relative_error(fit.mean, H)
    # Better than each of what it is made of, by a third on average.
    assert gaussian < 0.9 * min(relative_error(x, K) for x in (fit.gaussian, rings.gaussian, single[:, 0]))
    assert mean < 0.92 * min(relative_error(x, H) for x in (fit.mean, rings.mean, single[:, 1]))


@pytest.mark.parametrize("depth", (1.0, 3.0))
@pytest.mark.parametrize("width", (0.6, 1.0))
def test_spreads_beside_a_groove_say_that_no_method_resolves_it(width, depth):
    # Rings and edge lengths differ by many times what each expects to err by; K is small, but not nowhere.
    V, K, _, _ = folded_sphere(groove(width, depth))
    found = rinow.surface_curvature((V, SPHERE.faces))
    error, near = np.abs(found.gaussian - K), np.abs(V[:, 2]) < 6.0 * SPACING
    assert np.mean(error[near] < 2.0 * found.spread[near]) > 0.92
    assert np.mean(error[near] > np.maximum(4.0 * found.spread[near], 0.02 / SPACING**2)) < 0.03


@pytest.mark.parametrize(("height", "length", "noise"), [(waves, 4, 0.0), (bumps, 4, 0.0), (bumps, 7, 0.03)])
def test_total_curvature_of_rings_is_that_of_the_defects(height, length, noise):
    # By chance alone the total would be off by the square root of the number of vertices times a typical excess, ~2.
    V, _, _, normals = folded_sphere(height(length))
    V = V + normals * np.random.default_rng(11).normal(size=(len(V), 1)) * noise * SPACING
    mesh = rinow.TriangleMesh(V, SPHERE.faces)
    gaussian = with_detail(mesh, sectional(mesh)).gaussian
    assert abs((gaussian * mesh.vertex_areas).sum() - 4.0 * np.pi) < 4.0  # 8 to 12 without the correction


def test_steiner_formula_of_a_cube():
    # Twelve edges of length 1 that turn by a right angle, eight corners of a right angle and a half.
    mesh = rinow.TriangleMesh(*shapes.cube()[:2])
    gaussian, mean = single_rings(mesh).T
    np.testing.assert_allclose(gaussian * mesh.vertex_areas, 0.5 * np.pi, rtol=1e-14)
    np.testing.assert_allclose((mean * mesh.vertex_areas).sum(), 3.0 * np.pi * mesh.edge_lengths.min(), rtol=1e-14)


def test_without_orientation_there_is_no_mean_curvature():
    mesh = rinow.TriangleMesh(*shapes.moebius_strip()[:2])
    gaussian, mean = single_rings(mesh).T
    assert np.isfinite(gaussian[~mesh.topology.vertex_is_boundary]).all()
    assert np.isnan(mean).all()


def test_waves_of_four_spacings_are_no_steps_of_voxels():
    # They are as low as these on the mean of a star, but not at single vertices.
    V, K, H, _ = folded_sphere(waves(4))
    result = rinow.surface_curvature((V, SPHERE.faces))
    assert relative_error(result.gaussian, K) < 0.5
    assert relative_error(result.mean, H) < 0.25
    assert not any("steps" in note for note in result.notes)
