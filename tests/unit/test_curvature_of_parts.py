"""Curvature of solids with creases: every value from one side, facets flat, walls of prisms those of cylinders."""

import numpy as np
import pytest

import parts
import rinow
import shapes
from rinow import VertexStatus
from rinow.curvature.barriers import crease_barriers
from rinow.curvature.strays import stray_vertices
from surface_methods import curvature

METHODS = ("auto", "sectional")


def prism_of_a_cylinder(angles, radius=1.0, height=3.0, mixed=False):
    """Two rows of vertices at the given angles, the facets cut along one diagonal or at random, fans as lids."""
    n, rng = len(angles), np.random.default_rng(4)
    ring = np.stack([radius * np.cos(angles), radius * np.sin(angles), np.zeros(n)], axis=1)
    V = np.concatenate([ring, ring + np.array([0.0, 0.0, height]), [(0, 0, 0), (0, 0, height)]])
    F = []
    for a in range(n):
        b = (a + 1) % n
        turned = mixed and rng.random() < 0.5
        F += [(a, b, n + a), (b, n + b, n + a)] if turned else [(a, b, n + b), (a, n + b, n + a)]
        F += [(2 * n + 1, n + a, n + b), (2 * n, b, a)]
    return V, np.array(F)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("quality", ["best", "fast"])
def test_boxes_are_flat_everywhere(method, quality):
    for shape in (shapes.cube(), shapes.box(3, (1.0, 2.0, 3.0)), parts.box(0.2), parts.l_shape(0.3)):
        c = curvature(shape, method=method, quality=quality)
        np.testing.assert_array_equal(c.gaussian, 0.0)
        np.testing.assert_allclose(c.mean, 0.0, atol=1e-12)
        np.testing.assert_allclose([c.k1, c.k2], 0.0, atol=1e-12)


@pytest.mark.parametrize("name", list(parts.with_features()))
def test_vertices_on_creases_are_one_sided_and_said_so(name):
    part = parts.with_features()[name](0.2)
    c = curvature(part)
    on_crease = np.isin(np.arange(len(part.vertices)), part.creases)
    np.testing.assert_array_equal(c.status, np.where(on_crease, VertexStatus.BOUNDARY, VertexStatus.OK))
    assert c.notes[-1].startswith(f"{on_crease.sum()} vertices lie on creases")
    assert np.isfinite(c.gaussian).all() and np.isfinite(c.direction1).all()


@pytest.mark.parametrize("n", [12, 40])
@pytest.mark.parametrize("even", [True, False])
def test_two_rows_of_vertices_are_enough_for_a_cylinder(n, even):
    angles = 2 * np.pi * (np.arange(n) + (0 if even else np.random.default_rng(3).uniform(-0.25, 0.25, n))) / n
    V, F = prism_of_a_cylinder(angles, radius=2.0)
    c = rinow.surface_curvature((V, F))
    rims, lids = c.gaussian[: 2 * n], c.gaussian[2 * n :]
    np.testing.assert_array_equal(rims, 0.0)
    np.testing.assert_array_equal(lids, 0.0)
    np.testing.assert_allclose(c.k1[: 2 * n], 0.5, rtol=1e-9)  # circles through three points of a circle
    np.testing.assert_allclose(c.mean[: 2 * n], 0.25, rtol=1e-9)
    np.testing.assert_array_equal(c.k2[: 2 * n], 0.0)
    np.testing.assert_allclose(np.abs(c.direction2[: 2 * n]), [(0, 0, 1)] * (2 * n), atol=1e-12)
    np.testing.assert_array_equal(c.mean[2 * n :], 0.0)


def test_facets_cut_along_any_diagonal_and_turned_inside_out():
    n = 24
    V, F = prism_of_a_cylinder(2 * np.pi * np.arange(n) / n, mixed=True)
    expected = rinow.surface_curvature((V, F))
    np.testing.assert_array_equal(expected.gaussian, 0.0)
    # Where neither facet has its diagonal at the vertex two triangles are all that is seen there.
    assert np.mean(np.abs(expected.mean[: 2 * n] - 0.5) < 1e-9) > 0.6
    np.testing.assert_allclose(expected.mean[: 2 * n], 0.5, rtol=0.1)
    turned = F.copy()
    turned[::3] = turned[::3, ::-1]
    for faces in (F[:, ::-1], turned):
        c = rinow.surface_curvature((V, faces))
        np.testing.assert_allclose(c.mean, expected.mean, atol=1e-9)


def test_a_hole_is_concave():
    n = 20
    V, F = prism_of_a_cylinder(2 * np.pi * np.arange(n) / n, height=1.0)
    wall = F[(F < 2 * n).all(axis=1)][:, ::-1]
    square = np.array([(-3, -3, z) for z in (0, 1)] + [(3, -3, z) for z in (0, 1)], float)
    square = np.concatenate([square, [(3, 3, 0), (3, 3, 1), (-3, 3, 0), (-3, 3, 1)]])
    V = np.concatenate([V[: 2 * n], square])
    corners = 2 * n + 2 * np.arange(4)
    quadrant = np.floor(np.arange(n) / n * 4 + 0.5).astype(int) % 4  # the corner that sees vertex a
    corner_of = corners[(quadrant + 2) % 4]
    plate = []
    for a in range(n):
        b = (a + 1) % n
        plate.append((a, corner_of[a], b))
        if corner_of[a] != corner_of[b]:
            plate.append((b, corner_of[a], corner_of[b]))
    bottom = np.array(plate)[:, ::-1]
    top = np.where(np.array(plate) < n, np.array(plate) + n, np.array(plate) + 1)
    sides = [(a, b, b + 1) for a, b in zip(corners, np.roll(corners, -1), strict=True)]
    sides += [(a, b + 1, a + 1) for a, b in zip(corners, np.roll(corners, -1), strict=True)]
    faces = np.concatenate([wall, top, bottom, sides])
    c = rinow.surface_curvature((V, faces))
    np.testing.assert_array_equal(c.gaussian, 0.0)
    np.testing.assert_allclose(c.mean[: 2 * n], -0.5, rtol=1e-9)
    np.testing.assert_allclose(c.mean[2 * n :], 0.0, atol=1e-12)


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_walls_and_lids_beside_a_crease_take_nothing_from_beyond(noise):
    clean = parts.cylinder(0.12)
    part = parts.noisy(clean, noise)
    c = curvature(part)
    V = clean.vertices
    on_crease = np.isin(np.arange(len(V)), part.creases)
    wall = ~on_crease & (np.abs(np.hypot(V[:, 0], V[:, 1]) - 1.0) < 1e-6)
    lids = ~on_crease & ~wall
    # Heights of deviation 0.02 h over balls of two to four spacings h: curvatures of 0.02 / (4 h) to 0.01 / h.
    tolerance = 0.02 + 8 * noise
    assert np.median(np.abs(c.mean[wall] - 0.5)) < tolerance
    assert np.quantile(np.abs(c.mean[wall] - 0.5), 0.95) < 3 * tolerance
    assert np.quantile(np.abs(c.mean[lids]), 0.95) < 1e-9 + 25 * noise
    assert np.quantile(np.abs(c.gaussian[lids]), 0.95) < 1e-9 + 25 * noise


@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_smooth_meshes_are_not_cut(noise):
    for shape in (shapes.irregular_torus(3000), shapes.irregular_sphere(2000), shapes.open_patch(1500)):
        mesh = rinow.TriangleMesh(*shapes.noisy(shape, noise)[:2])
        assert not crease_barriers(mesh).any()


def test_coarse_rounds_are_no_prisms_and_small_solids_stay_whole():
    u, v = np.meshgrid(np.arange(40) * 2 * np.pi / 40, np.arange(9) * 2 * np.pi / 9, indexing="ij")
    V = np.stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)], axis=-1).reshape(-1, 3)
    F = shapes._grid_faces(40, 9, None, closed=True)
    for mesh in (rinow.TriangleMesh(V, F), rinow.TriangleMesh(*shapes.tetrahedron()[:2])):
        assert not crease_barriers(mesh).any()


def test_progress_counts_the_vertices_of_the_mesh():
    calls = []
    part = parts.box(0.3)
    curvature(part, progress=lambda *x: calls.append(x))
    assert calls[-1] == (len(part.vertices), len(part.vertices))
    assert all(done <= total == len(part.vertices) for done, total in calls)


def test_a_given_radius_stays_on_its_side():
    c = curvature(parts.box(0.15), radius=0.5)
    np.testing.assert_allclose(c.gaussian[np.isfinite(c.gaussian)], 0.0, atol=1e-12)
    np.testing.assert_allclose(c.mean[np.isfinite(c.mean)], 0.0, atol=1e-9)


# ------------------------------------------------------------------ vertices that tell nothing


def test_vertices_amid_an_edge_are_strays():
    V, F = shapes.irregular_sphere(300)[:2]
    assert not stray_vertices(rinow.TriangleMesh(V, F))[0].any()
    a, b, c = F[10]
    split = np.concatenate([np.delete(F, 10, axis=0), [[a, 300, c], [300, b, c], [a, b, 300]]])
    W = np.concatenate([V, [0.6 * V[a] + 0.4 * V[b]]])
    is_stray, on_edge, ends = stray_vertices(rinow.TriangleMesh(W, split))
    np.testing.assert_array_equal(np.flatnonzero(is_stray), [300])
    np.testing.assert_array_equal((on_edge[0], ends[0]), (300, a))
    c = rinow.surface_curvature((W, split))
    np.testing.assert_allclose(c.gaussian[300], 0.6 * c.gaussian[a] + 0.4 * c.gaussian[b], rtol=1e-14)
    np.testing.assert_allclose(c.gaussian, 1.0, rtol=1e-6)
