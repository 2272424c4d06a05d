"""Curvature from edge lengths alone: closed forms, orders, noise of lengths, and what the spread holds."""

import math

import numpy as np
import pytest

import shapes
from metric_shapes import flat_torus, hyperbolic_patch
from naive import development as naive
from rinow import IntrinsicMesh, InvalidInputError, TriangleMesh, VertexStatus, surface_curvature
from rinow.curvature.angle_defect import longest_edges
from rinow.curvature.disagreement import proven_bias
from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.intrinsic import CALIBRATION, intrinsic_curvature
from rinow.curvature.length_noise import LengthNoise
from rinow.curvature.waves import Waves, window
from rinow.kernels import smoothing
from surface_methods import NOISY_TORUS, curvature, curvature_by_lengths, relative_error


def test_a_flat_torus_is_exactly_flat():
    mesh = flat_torus()
    assert (surface_curvature(mesh, method="intrinsic").gaussian == 0).all()


def test_the_hyperbolic_plane():
    mesh, r = hyperbolic_patch()
    c = surface_curvature(mesh, method="intrinsic")
    inner = r < 0.8
    # The lengths are those of the surface itself: what is left is the area of flat triangles, K h²/8 = 0.0004.
    np.testing.assert_allclose(c.gaussian[inner], -1, atol=2e-3)
    assert (c.status[~mesh.topology.vertex_is_boundary] == VertexStatus.OK).all()


def test_boundary_vertices_get_values_from_the_interior():
    mesh, _ = hyperbolic_patch()
    c = surface_curvature(mesh, method="intrinsic")
    boundary = mesh.topology.vertex_is_boundary
    assert (c.status[boundary] == VertexStatus.BOUNDARY).all()
    np.testing.assert_allclose(c.gaussian[boundary], -1, atol=0.05)


@pytest.mark.parametrize("make", [shapes.irregular_torus, shapes.irregular_ellipsoid])
def test_far_better_than_the_angle_defect(make):
    shape = make(1500)
    plain = curvature(shape, method="angle_defect").gaussian
    found = curvature_by_lengths(shape).gaussian
    assert relative_error(found, shape.gaussian) < 0.2 * relative_error(plain, shape.gaussian)


def test_positions_are_not_read():
    mesh = TriangleMesh(NOISY_TORUS.vertices, NOISY_TORUS.faces)
    np.testing.assert_array_equal(
        surface_curvature(mesh.intrinsic(), method="intrinsic").gaussian, curvature_by_lengths(NOISY_TORUS).gaussian
    )


@pytest.mark.parametrize("make", [shapes.irregular_torus, shapes.irregular_ellipsoid])
@pytest.mark.parametrize("reach", [1.5, 2.1, 3.5])
def test_one_step_is_a_regression_over_an_unrolled_neighbourhood(make, reach):
    shape = make(300)
    mesh = TriangleMesh(shape.vertices, shape.faces)
    flow, n, faces = CurvatureFlow(mesh), mesh.n_vertices, [tuple(f) for f in shape.faces.tolist()]

    def length(a, b):
        return math.dist(shape.vertices[a], shape.vertices[b])

    radii = reach * flow.spacing
    ball = (radii, flow.areas, flow.has_data, flow.metric, 4)
    counts, starts = np.empty(n, np.int64), np.zeros(n + 1, np.int64)
    smoothing.count_rows(mesh.topology.vertex_is_manifold, *ball, counts)
    np.cumsum(counts, out=starts[1:])
    columns, values, variances = np.empty(starts[-1], np.int32), np.empty(starts[-1]), np.empty(n)
    places, has_gap = np.empty((starts[-1], 2)), np.empty(n, np.bool_)
    smoothing.row_places(*ball, starts, columns, places, has_gap)
    smoothing.regression_rows(radii, flow.areas, starts, columns, places, has_gap, values, variances)
    for v in range(0, n, 30):
        expected = naive.regression_row(naive.develop(faces, length, v, radii[v]), flow.areas, radii[v])
        row = slice(starts[v], starts[v + 1])
        assert sorted(columns[row]) == sorted(expected)
        # Sums of some ten numbers of the size 0.1 to 1.
        np.testing.assert_allclose(values[row], [expected[w] for w in columns[row]], atol=1e-10)


def test_noise_of_lengths_has_the_variance_predicted():
    mesh = flat_torus(40)
    t, tau = mesh.topology, 1e-5
    noise = tau * np.random.default_rng(7).normal(size=t.n_edges)
    lengths = np.array(mesh.edge_lengths)
    for h in (t.edge_halfedges, t.partners[t.edge_halfedges]):
        lengths[h // 3, (h % 3 + 2) % 3] += noise
    flow = CurvatureFlow(IntrinsicMesh(mesh.faces, lengths))
    model = LengthNoise.of(flow)
    waves = Waves(flow, flow.defect_densities)
    for m, order in ((0, 1), (1, 1), (2, 2), (4, 1), (4, 3), (8, 2), (12, 1), (12, 3)):
        c = window(m, order)
        ratio = np.sqrt(np.mean(waves.sums([c])[0] ** 2) / np.mean(tau**2 * model.variance(c)))
        assert 0.7 < ratio < 1.5, (m, order)  # S is not quite Gaussian; 1600 values, fewer independent ones


def test_spread_covers_the_error_under_noise():
    for noise in (0.02, 0.05):
        shape = shapes.noisy(shapes.irregular_torus(2500), noise)
        c = curvature_by_lengths(shape)
        within = np.mean(np.abs(c.gaussian - shape.gaussian) < 2 * c.spread)
        assert within > 0.9
        assert c.radius.min() > 0


@pytest.mark.parametrize("noise", [0.005, 0.02])
def test_a_bump_is_not_flat_since_large_balls_agree_on_that(noise):
    """Its total curvature is 0, and so are all averages over balls that hold it whole."""
    shape = shapes.noisy(shapes.bump_on_plane(), noise)
    c = curvature_by_lengths(shape)
    on_bump = np.linalg.norm(shape.vertices[:, :2], axis=1) < 0.6
    assert relative_error(c.gaussian[on_bump], shape.gaussian[on_bump]) < 0.5
    assert np.mean((np.abs(c.gaussian - shape.gaussian) < 2 * c.spread)[on_bump]) > 0.9


def test_balls_that_hold_all_corners_of_a_small_noisy_cube_do_not_agree_that_it_is_round():
    """Balls of 16 spacings hold half of |x|⁴ + |y|⁴ + |z|⁴ = 1, and larger ones have the same means, no bias."""
    sphere = shapes.irregular_sphere(800)
    V = sphere.vertices / np.sum(sphere.vertices**4, axis=1, keepdims=True) ** 0.25
    g, h = 4 * V**3, 12 * V**2  # of the level set: K = Σ g_i² h_j h_k / |g|⁴
    minors = np.roll(h, 1, axis=1) * np.roll(h, 2, axis=1)
    gaussian = np.sum(g**2 * minors, axis=1) / np.sum(g**2, axis=1) ** 2
    for seed in range(3):
        c = curvature_by_lengths(shapes.noisy(sphere._replace(vertices=V, gaussian=gaussian), 0.1, seed=seed))
        assert np.mean(np.abs(c.gaussian - gaussian) < 2 * c.spread) > 0.85


@pytest.mark.parametrize("n", [1000, 4000])
@pytest.mark.parametrize("noise", [0, 0.01, 0.05])
def test_spread_covers_the_error_on_spheres(n, noise):
    # The ball is large there: the errors of all vertices are nearly one, that of chords.
    shape = shapes.irregular_sphere(n)
    spacing = TriangleMesh(shape.vertices, shape.faces).mean_edge_length
    c = curvature_by_lengths(shapes.noisy(shape, noise * spacing))
    assert np.mean(np.abs(c.gaussian - 1) < 2 * c.spread) > 0.9


def test_radius_fixes_the_scale():
    c = curvature_by_lengths(NOISY_TORUS, radius=0.6)
    assert 0.4 < np.median(c.radius) < 0.8
    small = curvature_by_lengths(NOISY_TORUS, radius=1e-9)
    mesh = TriangleMesh(NOISY_TORUS.vertices, NOISY_TORUS.faces)
    np.testing.assert_array_equal(small.radius, CurvatureFlow(mesh).spacing)  # the star alone
    with pytest.raises(InvalidInputError, match="positive length"):
        curvature_by_lengths(NOISY_TORUS, radius=-1.0)


def test_parts_of_the_error_add_up_to_the_spread():
    mesh = TriangleMesh(NOISY_TORUS.vertices, NOISY_TORUS.faces)
    found = intrinsic_curvature(mesh)
    c = surface_curvature(mesh, method="intrinsic")
    K, square = np.abs(c.gaussian), longest_edges(mesh) ** 2
    chords = 5 / 24 * K * ((1 - found.on_arcs) * K * square + found.on_arcs * (K * square) ** 2)
    expected = CALIBRATION**2 * (found.variance + found.squared_bias + found.unseen) + chords**2
    np.testing.assert_allclose(c.spread**2, expected, rtol=1e-12)
    assert (np.array([found.variance, found.squared_bias, found.unseen]) >= 0).all()


def test_a_difference_proves_a_bias_only_if_there_is_one():
    mesh = flat_torus()
    nothing = np.zeros(mesh.n_vertices)
    flow = CurvatureFlow(mesh)
    assert np.isnan(proven_bias(nothing.copy(), nothing, flow)).all()  # values that agree exactly, without noise
    np.testing.assert_allclose(proven_bias(nothing + 2.0, nothing, flow), 4.0)
    np.testing.assert_allclose(proven_bias(nothing + 2.0, nothing + 1.0, flow), 3.0)
    assert np.isnan(proven_bias(nothing + 1.0, nothing + 1.0, flow)).all()
