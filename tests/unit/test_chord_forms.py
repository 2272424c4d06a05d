"""Normal curvatures from the chords of a mesh, and the defects without them: finite differences and closed forms."""

import math

import numpy as np
import pytest

import shapes
from metric_shapes import flat_torus
from rinow import IntrinsicMesh, TriangleMesh
from rinow.curvature.arcs import REACH, without_chords
from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.intrinsic import intrinsic_curvature
from rinow.curvature.length_noise import LengthNoise
from rinow.kernels import arcs, chord_forms


def rings_of(flow):
    return flow.mesh.topology.neighbour_offsets, flow.mesh.topology.neighbours


def terms_of(flow):
    terms, spokes = np.empty((len(flow.areas), 5)), np.empty((len(rings_of(flow)[1]), 2))
    chord_forms.chord_terms(flow.defect_densities, flow.areas, flow.metric, rings_of(flow), 4, terms, spokes)
    return terms, spokes


def forms_of(mesh):
    flow = CurvatureFlow(mesh)
    terms, spokes = terms_of(flow)
    forms, smooth = np.empty((len(terms), 5)), np.empty(len(terms))
    data = (flow.defect_densities, flow.areas, terms, spokes, mesh.topology.vertex_is_manifold)
    chord_forms.fit_forms(REACH * flow.spacing, *data, flow.metric, rings_of(flow), 4, forms, smooth)
    return forms, smooth


def mesh_of(shape):
    return TriangleMesh(shape.vertices, shape.faces)


def great_circles(shape):
    """The lengths of arcs of the unit sphere instead of chords."""
    mesh = mesh_of(shape)
    return IntrinsicMesh(mesh.faces, 2 * np.arcsin(mesh.edge_lengths / 2), mesh.n_vertices)


def test_terms_are_derivatives_by_finite_differences():
    mesh = mesh_of(shapes.irregular_torus(300))
    flow, step = CurvatureFlow(mesh), 1e-5
    c = np.array(mesh.edge_lengths)
    longer = CurvatureFlow(IntrinsicMesh(mesh.faces, c + step * c**3 / 24, mesh.n_vertices))
    shorter = CurvatureFlow(IntrinsicMesh(mesh.faces, c - step * c**3 / 24, mesh.n_vertices))
    expected = (longer.defect_densities - shorter.defect_densities) / (2 * step)
    # Central differences: rounding 1e-16/area/step = 1e-9.
    np.testing.assert_allclose(terms_of(flow)[0][:, 0], expected, atol=1e-7)


@pytest.mark.parametrize("k", [1, 2])
def test_terms_of_directions_are_derivatives_in_the_plane(k):
    rng = np.random.default_rng(7)
    n, faces = 12, flat_torus(12).faces
    place = np.stack(np.divmod(np.arange(n * n), n), axis=1) + rng.uniform(-0.2, 0.2, (n * n, 2))
    sides = place[np.roll(faces, -2, axis=1)] - place[np.roll(faces, -1, axis=1)]
    sides = (sides + n / 2) % n - n / 2
    c, angle, step = np.hypot(*sides.T).T, np.arctan2(*sides.T[::-1]).T, 1e-5
    found, _ = terms_of(CurvatureFlow(IntrinsicMesh(faces, c)))
    expected = [
        CurvatureFlow(IntrinsicMesh(faces, c + step * c**3 / 24 * f(2 * k * angle))).defect_densities / step
        for f in (np.cos, np.sin)
    ]
    # Frames are turned by an angle of their own; the second derivative leaves `step` itself.
    np.testing.assert_allclose(np.hypot(*found.T[2 * k - 1 : 2 * k + 1]), np.hypot(*expected), atol=1e-4)


@pytest.mark.parametrize("radius", [1.0, 30.0])
def test_the_form_of_a_sphere_is_its_squared_curvature(radius):
    forms, smooth = forms_of(mesh_of(shapes.irregular_sphere(1000, radius)))
    # The next order of the arc over a chord, and the area of triangles without curvature: c² = 0.02.
    np.testing.assert_allclose(forms * radius**2, np.tile([1, 0, 0, 0, 0], (1000, 1)), atol=0.03)
    np.testing.assert_allclose(smooth * radius**2, 1, atol=0.01)


def test_forms_are_squares_of_eulers_formula():
    shape = shapes.irregular_ellipsoid(4000)
    forms, _ = forms_of(mesh_of(shape))
    H, d2 = shape.mean, shape.mean**2 - shape.gaussian  # κ = H + d cos 2θ
    size = np.median(H**2 + d2)
    for found, exact in (
        (forms[:, 0], H**2 + d2 / 2),
        (np.hypot(forms[:, 1], forms[:, 2]), 2 * np.abs(H) * np.sqrt(np.abs(d2))),
        (np.hypot(forms[:, 3], forms[:, 4]), d2 / 2),
    ):
        assert np.median(np.abs(found - exact)) < 0.1 * size  # the form varies over 3.5 spacings


def test_geodesic_lengths_have_no_chords():
    mesh = great_circles(shapes.irregular_sphere(1000))
    forms, _ = forms_of(mesh)
    np.testing.assert_allclose(forms, 0, atol=0.03)
    # No chords, no evidence for them: the areas remain those of flat triangles, K c²/8 = 0.0025.
    assert np.abs(intrinsic_curvature(mesh).gaussian - 1).max() < 4e-3


def test_regular_meshes_and_noise_show_no_form():
    shape = shapes.irregular_sphere(1000)
    noisy = shapes.noisy(shape, 0.05 * mesh_of(shape).mean_edge_length)
    u, v = 2 * np.pi / 30 * np.stack(np.divmod(np.arange(900), 30))
    regular = np.stack([(1 + 0.4 * np.cos(v)) * np.cos(u), (1 + 0.4 * np.cos(v)) * np.sin(u), 0.4 * np.sin(v)], axis=1)
    cases = (
        (mesh_of(shape), 0.99, 1.0),
        (mesh_of(noisy), 0.0, 0.1),
        (TriangleMesh(regular, flat_torus(30).faces), 0.0, 0.1),
    )
    for mesh, least, most in cases:
        flow = CurvatureFlow(mesh)
        _, shares = without_chords(flow, LengthNoise.of(flow))
        assert least <= np.median(shares) <= most


def test_areas_of_spherical_triangles():
    # The defect of great circles over the area of flat triangles is wrong by c², over the corrected one by c⁴.
    for make, c2 in ((shapes.irregular_sphere(1000), 0.02), (shapes.irregular_sphere(4000), 0.005)):
        flow = CurvatureFlow(great_circles(make))
        ratios = np.empty(len(flow.areas))
        arcs.area_ratios(np.ones(len(ratios)), flow.metric, ratios)
        np.testing.assert_allclose(flow.defect_densities / ratios, 1, atol=0.2 * c2**2)


def test_a_point_of_curvature_raises_angles_by_its_barycentric_coordinates():
    A, B, C, X = np.array([[0.0, 0.0], [3.0, 0.2], [1.0, 2.0], [1.4, 0.7]])

    def angle(opposite, p, q):
        return math.acos((p * p + q * q - opposite * opposite) / (2 * p * q))

    a, b, c = math.dist(B, C), math.dist(C, A), math.dist(A, B)
    p, q, r = math.dist(X, A), math.dist(X, B) + 1e-6, math.dist(X, C)  # a longer spoke: X becomes a cone point
    defect = 2 * math.pi - angle(a, q, r) - angle(b, r, p) - angle(c, p, q)
    rise = [angle(q, c, p) + angle(r, b, p), angle(r, a, q) + angle(p, c, q), angle(p, b, r) + angle(q, a, r)]
    flat = [angle(a, b, c), angle(b, c, a), angle(c, a, b)]
    coordinates = np.linalg.solve(np.vstack([np.stack([A, B, C], axis=1), np.ones(3)]), [*X, 1.0])
    np.testing.assert_allclose((np.array(rise) - flat) / defect, coordinates, atol=1e-4)


def test_means_over_hats_keep_the_total():
    mesh = mesh_of(shapes.irregular_torus(300))
    flow, values = CurvatureFlow(mesh), np.random.default_rng(7).normal(size=mesh.n_vertices)
    means = np.empty_like(values)
    arcs.hat_means(values, flow.areas, flow.metric, means)
    np.testing.assert_allclose(flow.areas @ means, flow.areas @ values, rtol=1e-12)
    arcs.hat_means(np.ones_like(values), flow.areas, flow.metric, means)
    np.testing.assert_allclose(means, 1, rtol=1e-12)
