"""Kernels of surface curvature against their naive twins."""

import numpy as np
import pytest

import shapes
from naive import jets as naive_jets
from naive import stars as naive_stars
from rinow import TriangleMesh, surface_curvature
from rinow.curvature.lifted import lifted
from rinow.curvature.stencils import empty_frames, stencil_surface
from rinow.kernels import curves, monge, quadrics, ring_jets, stars, stencils

TORUS = shapes.noisy(shapes.irregular_torus(300), 0.02)
MESH = TriangleMesh(TORUS.vertices, TORUS.faces)
V, F = TORUS.vertices.tolist(), TORUS.faces.tolist()
CHOSEN = [0, 17, 100, 205, 290]


def random_star(rng, n):
    """Triangles from a centre to a ring of points around it, in space."""
    turns = np.sort(rng.uniform(0, 2 * np.pi, n)) + np.linspace(0, 2, n)
    P = np.stack([np.cos(turns), np.sin(turns), rng.normal(0, 0.4, n)], axis=1) * rng.uniform(0.5, 1.5, (n, 1))
    radii = np.linalg.norm(P, axis=1)
    chords = np.linalg.norm(P - np.roll(P, -1, axis=0), axis=1)
    return np.stack([chords, radii, np.roll(radii, -1)], axis=1)


@pytest.mark.parametrize("seed", range(10, 30))
def test_star_curvature_equals_bisection_with_the_law_of_cosines(seed):
    rng = np.random.default_rng(seed)
    sides = random_star(rng, int(rng.integers(4, 9)))
    expected = naive_stars.star_curvature(sides.tolist())
    # The law of cosines loses about 1e-16/(k d^2) of an angle; the star has diameter 2.
    assert stars.star_curvature(sides) == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_star_curvature_of_stars_in_the_sphere_and_the_plane_and_the_hyperbolic_plane():
    n = 6
    turn = 2 * np.pi / n
    for k, side in (
        (1.0, lambda r: np.arccos(np.cos(r) ** 2 + np.sin(r) ** 2 * np.cos(turn))),
        (0.0, lambda r: 2 * r * np.sin(turn / 2)),
        (-1.0, lambda r: np.arccosh(np.cosh(r) ** 2 - np.sinh(r) ** 2 * np.cos(turn))),
    ):
        sides = np.tile([side(0.3), 0.3, 0.3], (n, 1))
        assert stars.star_curvature(sides) == pytest.approx(k, abs=1e-12)


def test_a_spike_has_no_embedding_curvature():
    # Three needles, one longer: at the largest curvature it allows, the two others still have small angles.
    assert np.isnan(stars.star_curvature(np.array([[0.1, 1, 1], [0.1, 1, 1], [0.1, 1.5, 1.5]])))


def test_two_segments_through_the_vertex_and_more_have_no_embedding_curvature():
    assert np.isnan(stars.star_curvature(np.array([[2.0, 1, 1], [2.0, 1, 1], [1.0, 1, 1]])))


def test_ring_deviation_is_the_standard_deviation_of_the_closed_ring():
    values = np.random.default_rng(11).normal(size=MESH.n_vertices)
    out = np.empty(MESH.n_vertices)
    stars.ring_deviations(values, MESH.faces, MESH.topology.corner_offsets, MESH.topology.vertex_corners, out)
    for v in CHOSEN:
        assert out[v] == pytest.approx(naive_stars.ring_deviation(values.tolist(), F, v), rel=1e-12)


def test_gauss_sweep_adds_what_is_missing_over_the_area():
    rng = np.random.default_rng(12)
    K, defects = rng.normal(size=(2, MESH.n_vertices)).tolist()
    areas = rng.uniform(1, 2, MESH.n_faces)
    out, closed, t = np.empty(MESH.n_vertices), np.ones(MESH.n_vertices, bool), MESH.topology
    stars.gauss_sweep(
        np.array(K), np.array(defects), areas, MESH.faces, t.corner_offsets, t.vertex_corners, closed, out
    )
    for v in CHOSEN:
        area = sum(a for a, f in zip(areas, F, strict=True) if v in f) / 3
        missing = defects[v] - naive_stars.gauss_defect(K, areas, F, v)
        assert out[v] == pytest.approx(K[v] + missing / area, rel=1e-12)


def test_edge_curvature_is_the_mean_of_the_circles_at_both_ends():
    surface = stencil_surface(MESH)
    N = surface.normals.tolist()
    for i, j in MESH.topology.edges[:40].tolist():
        d = naive_jets.subtract(V[j], V[i])
        c2 = naive_jets.dot(d, d)
        at_i, at_j = -2 * naive_jets.dot(N[i], d) / c2, 2 * naive_jets.dot(N[j], d) / c2
        actual = curves.edge_curvature(MESH.vertices, surface.normals, i, j)
        assert actual == pytest.approx((at_i + at_j) / 2, rel=1e-9, abs=1e-9)


def test_stencils_are_the_sets_they_are_named_after():
    surface = stencil_surface(MESH)
    n_vertices = MESH.n_vertices
    members, marks = np.empty(n_vertices + 1, np.int32), np.zeros(n_vertices, np.int32)
    for v in CHOSEN:
        for n_rings in (2, 3):
            marks[:] = 0
            n, reach = stencils.rings(v, n_rings, surface, members, marks)
            expected = naive_jets.rings(F, v, n_rings)
            assert members[0] == v
            assert sorted(members[1:n]) == sorted(expected)
            assert reach == pytest.approx(max(sum((np.array(V[w]) - V[v]) ** 2) for w in expected), rel=1e-14)


def test_quadric_equals_orthogonalised_least_squares():
    surface, frames = stencil_surface(MESH), empty_frames(len(CHOSEN))
    quadrics.ring_quadrics(np.array(CHOSEN), surface, False, 4, frames)
    for row, v in enumerate(CHOSEN):
        members = sorted(naive_jets.rings(F, v, 2))
        size = max(np.linalg.norm(np.array(V[w]) - V[v]) for w in members)
        normal = surface.normals[v].tolist()
        K, H = naive_jets.jet_curvatures(V, normal, members, v, size, 2, stencils.SOFTENING)
        assert frames.k1[row] * frames.k2[row] == pytest.approx(K, rel=1e-9)
        assert (frames.k1[row] + frames.k2[row]) / 2 == pytest.approx(H, rel=1e-9)


def test_ring_jets_equal_orthogonalised_least_squares_over_the_plane_of_a_first_fit():
    surface, out = stencil_surface(MESH), np.empty((MESH.n_vertices, 2, 2))
    ring_jets.ring_jets(surface, 4, out)
    N = surface.normals.tolist()
    for v in CHOSEN:
        members, near = naive_jets.rings(F, v, 3), naive_jets.rings(F, v, 1)
        size = max(np.linalg.norm(np.array(V[w]) - V[v]) for w in members)

        def fit(normal, order):
            facing = [w for w in sorted(members) if w in near or naive_jets.dot(N[w], normal) > stencils.FACING]  # noqa: B023
            return naive_jets.jet_with_centre(V, normal, facing, v, size, order, stencils.SOFTENING)  # noqa: B023

        *_, normal = fit(N[v], ring_jets.LOW)
        expected = [fit(normal, order)[:2] for order in (ring_jets.LOW, ring_jets.HIGH)]
        np.testing.assert_allclose(out[v], expected, rtol=1e-8)


def test_too_few_points_for_a_cubic_leave_no_ring_jet():
    for shape, is_known in ((shapes.tetrahedron(), False), (shapes.icosphere(0), False), (shapes.icosphere(1), True)):
        out = np.empty((len(shape.vertices), 2, 2))
        ring_jets.ring_jets(stencil_surface(TriangleMesh(shape.vertices, shape.faces)), 4, out)
        assert (np.isfinite(out) == is_known).all()


@pytest.mark.parametrize("seed", range(40, 48))
def test_shape_operator_of_a_graph(seed):
    f1, f2, f11, f12, f22 = np.random.default_rng(seed).normal(size=5).tolist()
    s11, s12, s22 = monge.shape_operator(f1, f2, f11, f12, f22)
    K, H = naive_jets.curvatures(f1, f2, f11, f12, f22)
    assert s11 * s22 - s12 * s12 == pytest.approx(K, rel=1e-10)
    assert (s11 + s22) / 2 == pytest.approx(H, rel=1e-10)
    # Normal curvature along the first tangent, the image of (1, 0): second form over first form, sign turned.
    assert s11 == pytest.approx(-f11 / np.sqrt(1 + f1**2 + f2**2) / (1 + f1**2), rel=1e-12)


def test_principal_directions_of_an_ellipsoid_follow_its_curvature_lines():
    shape = shapes.irregular_ellipsoid(2000, (1.0, 1.0, 0.5))  # of revolution: meridians and circles
    c = surface_curvature((shape.vertices, shape.faces), method="sectional")
    off_axis = np.linalg.norm(shape.vertices[:, :2], axis=1) > 0.3
    circles = np.cross([0.0, 0.0, 1.0], shape.vertices)
    circles /= np.linalg.norm(circles, axis=1)[:, None]
    # Here the meridian bends more than the circle, so k1 is along the meridian.
    sine = np.abs(np.sum(c.direction1 * circles, axis=1))[off_axis]
    assert np.quantile(sine, 0.99) < 0.02  # of an angle; the error of the fits over k1 - k2


def test_lifted_metric_has_the_total_curvature_of_the_surface():
    # Sweeps keep the sum of curvature times area, which is 2 pi times the Euler characteristic for any lengths.
    for name, shape in shapes.closed_shapes().items():
        mesh = TriangleMesh(shape.vertices, shape.faces)
        surface, frames = stencil_surface(mesh), empty_frames(mesh.n_vertices)
        quadrics.ring_quadrics(np.arange(mesh.n_vertices), surface, False, 4, frames)
        lengths = np.empty((mesh.n_faces, 3))
        curves.lifted_edge_lengths(mesh.vertices, mesh.faces, frames.normals, mesh.edge_lengths, lengths)
        s = lengths.sum(axis=1) / 2
        areas = np.sqrt(s * (s - lengths[:, 0]) * (s - lengths[:, 1]) * (s - lengths[:, 2]))
        area = np.bincount(mesh.faces.ravel(), np.repeat(areas / 3, 3), mesh.n_vertices)
        total = np.sum(lifted(mesh).gaussian * area)
        assert total == pytest.approx(2 * np.pi * mesh.euler_characteristic, abs=1e-9 * mesh.n_vertices), name
