"""Curvature from edge lengths alone: closed forms, orders, invariance, noise, faults of meshes."""

import math

import numpy as np
import pytest

import shapes
from metric_shapes import flat_torus, hyperbolic_patch
from naive import development as naive
from rinow import IntrinsicMesh, InvalidInputError, TriangleMesh, VertexStatus, surface_curvature
from rinow.curvature import intrinsic
from rinow.curvature import waves as waves_module
from rinow.curvature.angle_defect import longest_edges
from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.intrinsic import CALIBRATION, intrinsic_curvature
from rinow.curvature.length_noise import LengthNoise
from rinow.curvature.waves import LADDER, LEAST, REACH, Waves, passed, window
from rinow.kernels import smoothing

TORUS = shapes.noisy(shapes.irregular_torus(1500), 0.05)


def curvature(shape, **options):
    return surface_curvature((shape.vertices, shape.faces), method="intrinsic", **options)


def relative_error(shape, **options):
    error = curvature(shape, **options).gaussian - shape.gaussian
    return np.sqrt(np.mean(error**2) / np.mean(shape.gaussian**2))


# ------------------------------------------------------------------ values


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
    plain = surface_curvature((shape.vertices, shape.faces), method="angle_defect").gaussian - shape.gaussian
    assert relative_error(shape) < 0.2 * np.sqrt(np.mean(plain**2) / np.mean(shape.gaussian**2))


def test_positions_are_not_read():
    mesh = TriangleMesh(TORUS.vertices, TORUS.faces)
    np.testing.assert_array_equal(
        surface_curvature(mesh.intrinsic(), method="intrinsic").gaussian, curvature(TORUS).gaussian
    )


def test_total_curvature_is_kept_by_every_step():
    flow = CurvatureFlow(TriangleMesh(TORUS.vertices, TORUS.faces))
    once = flow.step(flow.defect_densities)
    total = np.sum(np.abs(flow.areas * flow.defect_densities))
    # The balance is approximate; without it the step misses 2 % of the absolute total.
    assert abs(np.sum(flow.areas * once)) < 0.005 * total
    np.testing.assert_allclose(flow.step(np.ones(len(once))), 1, atol=1e-12)


@pytest.mark.parametrize("make", [shapes.irregular_torus, shapes.irregular_ellipsoid])
@pytest.mark.parametrize("reach", [1.5, 2.1, 3.5])
def test_one_step_is_a_regression_over_an_unrolled_neighbourhood(make, reach):
    shape = make(300)
    mesh = TriangleMesh(shape.vertices, shape.faces)
    flow, n, faces = CurvatureFlow(mesh), mesh.n_vertices, [tuple(f) for f in shape.faces.tolist()]

    def length(a, b):
        return math.dist(shape.vertices[a], shape.vertices[b])

    radii, t = reach * flow.spacing, mesh.topology
    ball = (radii, flow.areas, t.vertex_is_manifold, flow.has_data, flow.metric, 4)
    counts, starts = np.empty(n, np.int64), np.zeros(n + 1, np.int64)
    smoothing.count_rows(*ball, counts)
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


@pytest.mark.parametrize("order", [1, 2, 3])
def test_windows_keep_polynomials_of_their_order(order):
    for m in LADDER[2:]:
        c, j = window(m, order), np.arange(len(window(m, order)))
        assert len(c) == np.ceil(REACH[order - 1] * np.sqrt(m))
        moments = [np.sum(c * j ** (2.0 * i)) / np.sum(np.abs(c) * j ** (2.0 * i)) for i in range(order + 1)]
        np.testing.assert_allclose(np.sum(c), 1, atol=1e-12)
        np.testing.assert_allclose(moments[1:order], 0, atol=1e-12)
        assert abs(moments[order]) > 1e-3  # and of no higher one
        # What passes is nearly that of order-fold heat flow with the same noise, without its tails.
        S = np.linspace(LEAST, 1, 200)
        assert np.abs(passed(c, S) - (1 - (1 - np.abs(S) ** m) ** order)).max() < 0.3


def test_waves_are_polynomials_in_the_step():
    flow = CurvatureFlow(TriangleMesh(TORUS.vertices, TORUS.faces))
    waves, c = Waves(flow, flow.defect_densities), window(4, 3)
    for _ in range(2):  # anew, and from waves that were kept
        found = waves.sums([window(32, 3), c])[1]
    powers = [flow.defect_densities]
    for _ in c[1:]:
        powers.append(flow.step(powers[-1]))
    stretched = np.polynomial.Polynomial([-(1 + LEAST) / (1 - LEAST), 2 / (1 - LEAST)])
    expected = np.polynomial.Chebyshev(c).convert(kind=np.polynomial.Polynomial)(stretched).coef @ powers
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(powers[0]).max())  # coefficients of up to 1e4


@pytest.mark.parametrize("order", [1, 3])
def test_no_window_reaches_further_than_its_steps_and_next_to_nothing_beyond_its_waves(order):
    shape = shapes.irregular_torus(8000)
    mesh = TriangleMesh(shape.vertices, shape.faces)
    flow, start = CurvatureFlow(mesh), np.zeros(mesh.n_vertices)
    start[0] = 1.0
    c = window(16, order)
    kernel = np.abs(Waves(flow, start).sums([c])[0])
    away = np.linalg.norm(shape.vertices - shape.vertices[0], axis=1) / np.sqrt(2 / (1 - LEAST) * flow.step_variances)
    assert kernel[away > 1.5 * len(c)].max() < 1e-3 * kernel.max()
    assert kernel[away > 2.8 * len(c)].max(initial=0.0) < 1e-13 * kernel.max()


def long_grid(n, stretch):
    """A paraboloid over n by n points in rows that are so many times further apart than the points in them."""
    i = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]))
    x, y = (np.indices((n, n)).reshape(2, -1) - (n - 1) / 2) * np.array([[1.0], [1 / stretch]]) / n
    faces = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return TriangleMesh(np.column_stack([x, y, (x * x + y * y) / 2]), faces)


def test_waves_do_not_grow_where_three_values_in_a_row_are_averaged():
    flow = CurvatureFlow(long_grid(24, 50))
    start = np.where(flow.has_data, (-1.0) ** np.arange(24 * 24), 0.0)  # alternating along the rows
    assert flow.step(start)[flow.has_data].min() < -0.25
    for m in (16, 128):
        assert np.nanmax(np.abs(Waves(flow, start).sums([window(m, 3)])[0])) < 1


def test_waves_that_grow_are_no_candidates_or_have_the_spread_of_it(monkeypatch):
    flow = CurvatureFlow(TriangleMesh(TORUS.vertices, TORUS.faces))
    exact = np.abs(TORUS.gaussian).max()
    monkeypatch.setattr(waves_module, "LEAST", 0.1)  # some of what S does lies beyond
    assert np.abs(Waves(flow, flow.defect_densities).sums([window(64, 3)])[0]).max() > 1e5 * exact
    found = curvature(TORUS)
    assert np.mean(np.abs(found.gaussian - TORUS.gaussian) < 2 * found.spread) > 0.9
    assert np.abs(found.gaussian).max() < 5 * exact


def test_no_squared_bias_is_so_small_that_two_spreads_do_not_hold_the_difference_from_the_reference():
    flow = CurvatureFlow(TriangleMesh(TORUS.vertices, TORUS.faces))
    spike = np.zeros(len(TORUS.vertices))
    spike[5] = 1e9
    squared = intrinsic._squared_bias(1, spike, flow, np.ones(len(spike)))
    assert 2 * CALIBRATION * np.sqrt(squared[5]) >= 1e9 * (1 - 1e-12)


def test_every_boundary_vertex_beside_the_interior_has_a_value():
    assert np.isfinite(intrinsic_curvature(long_grid(24, 5)).gaussian).all()


# ------------------------------------------------------------------ scale and noise


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
        c = curvature(shape)
        within = np.mean(np.abs(c.gaussian - shape.gaussian) < 2 * c.spread)
        assert within > 0.9
        assert c.radius.min() > 0


@pytest.mark.parametrize("n", [1000, 4000])
@pytest.mark.parametrize("noise", [0, 0.01, 0.05])
def test_spread_covers_the_error_on_spheres(n, noise):
    # The ball is large there: the errors of all vertices are nearly one, that of chords.
    shape = shapes.irregular_sphere(n)
    spacing = TriangleMesh(shape.vertices, shape.faces).mean_edge_length
    c = curvature(shapes.noisy(shape, noise * spacing))
    assert np.mean(np.abs(c.gaussian - 1) < 2 * c.spread) > 0.9


def test_radius_fixes_the_scale():
    c = curvature(TORUS, radius=0.6)
    assert 0.4 < np.median(c.radius) < 0.8
    small = curvature(TORUS, radius=1e-9)
    mesh = TriangleMesh(TORUS.vertices, TORUS.faces)
    np.testing.assert_array_equal(small.radius, CurvatureFlow(mesh).spacing)  # the star alone
    with pytest.raises(InvalidInputError, match="positive length"):
        curvature(TORUS, radius=-1.0)


def test_parts_of_the_error_add_up_to_the_spread():
    mesh = TriangleMesh(TORUS.vertices, TORUS.faces)
    found = intrinsic_curvature(mesh)
    c = surface_curvature(mesh, method="intrinsic")
    K, square = np.abs(c.gaussian), longest_edges(mesh) ** 2
    chords = 5 / 24 * K * ((1 - found.on_arcs) * K * square + found.on_arcs * (K * square) ** 2)
    expected = CALIBRATION**2 * (found.variance + found.squared_bias + found.unseen) + chords**2
    np.testing.assert_allclose(c.spread**2, expected, rtol=1e-12)
    assert (np.array([found.variance, found.squared_bias, found.unseen]) >= 0).all()


# ------------------------------------------------------------------ invariance


def test_order_orientation_and_unit_do_not_matter():
    V, F = TORUS.vertices, TORUS.faces
    rng = np.random.default_rng(7)
    K = curvature(TORUS).gaussian
    close = {"rtol": 1e-9, "atol": 1e-9 * np.abs(K).max()}  # rounding of defects, over areas of 0.01
    p = rng.permutation(len(V))
    G = np.argsort(p)[F][rng.permutation(len(F))]
    again = surface_curvature((V[p], np.roll(G[:, ::-1], 1, axis=1)), method="intrinsic").gaussian
    np.testing.assert_allclose(again, K[p], **close)
    for scale in (1e-3, 1e3):
        scaled = surface_curvature((V * scale, F), method="intrinsic").gaussian
        np.testing.assert_allclose(scaled * scale**2, K, **close)


def test_large_meshes_are_computed_in_another_order(monkeypatch):
    p = np.random.default_rng(7).permutation(len(TORUS.vertices))
    V, F = TORUS.vertices[p], np.argsort(p)[TORUS.faces]
    mesh = TriangleMesh(np.vstack([V, [[9.0, 9.0, 9.0]]]), np.vstack([F, [[3, 3, 4]]]))  # a lonely vertex, a bad face
    assert intrinsic._closer_order(mesh) is None  # it is small
    expected = intrinsic_curvature(mesh)
    monkeypatch.setattr(intrinsic, "LARGE", 100)
    assert sorted(intrinsic._closer_order(mesh)) == list(range(mesh.n_vertices))
    actual = intrinsic_curvature(mesh)
    for name in ("gaussian", "variance", "squared_bias", "radius", "on_arcs"):
        # Places in the plane are means in another order: rounding, over areas of 0.01.
        np.testing.assert_allclose(getattr(actual, name), getattr(expected, name), rtol=1e-7, atol=1e-9, err_msg=name)
    assert intrinsic._closer_order(TriangleMesh(*shapes.irregular_torus(3000)[:2])) is None  # neighbours are close


# ------------------------------------------------------------------ faults


def test_damage_leaves_a_value_everywhere_else():
    shape = shapes.irregular_sphere(1000)
    V, F = shape.vertices.copy(), shape.faces
    V[10] = np.nan
    c = surface_curvature((np.vstack([V, [[5.0, 5.0, 5.0]]]), np.vstack([F, F[:1]])), method="intrinsic")
    assert c.status[10] == VertexStatus.NONFINITE and c.status[-1] == VertexStatus.ISOLATED
    assert np.isnan(c.gaussian[[10, -1]]).all()
    ok = c.status == VertexStatus.OK
    assert ok.sum() > 980
    np.testing.assert_allclose(c.gaussian[ok], 1, atol=0.1)


def test_a_face_without_area_leaves_no_gap():
    # A vertex moved onto the edge opposite it, exactly: little more is lost than with the same vertex a little beside.
    shape = shapes.irregular_ellipsoid(1000, axes=(1.0, 0.85, 0.7))
    clean, found = curvature(shape).gaussian, []
    for beside in (0.0, 1e-6):
        V, (a, b, c) = shape.vertices.copy(), shape.faces[100]
        V[a] = 0.5 * (V[b] + V[c]) * (1.0 + beside)
        moved = curvature(shape._replace(vertices=V))
        assert (moved.status == VertexStatus.OK).all()
        found.append(np.abs(moved.gaussian - clean).max())
    assert found[0] < 2.0 * found[1] < 0.5 * clean.mean()


@pytest.mark.parametrize(
    "shape",
    [shapes.tetrahedron(), shapes.bow_tie(), shapes.moebius_strip(), shapes.two_components(), shapes.cone(),
     shapes.soup(shapes.icosphere(1)), shapes.open_patch(100)],
)  # fmt: skip
def test_no_shape_is_refused(shape):
    c = curvature(shape)
    assert np.isfinite(c.gaussian[c.status == VertexStatus.OK]).all()


def test_a_single_triangle_has_no_interior():
    c = surface_curvature(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), method="intrinsic")
    assert np.isnan(c.gaussian).all() and (c.status == VertexStatus.BOUNDARY).all()


@pytest.mark.parametrize("make", [shapes.irregular_torus, shapes.irregular_ellipsoid])
def test_curvature_of_lengths_does_not_know_the_orientation_of_faces(make):
    shape = make(500)
    turned = np.where(np.random.default_rng(3).random((len(shape.faces), 1)) < 1 / 3, shape.faces[:, ::-1], shape.faces)
    expected, found = (intrinsic_curvature(TriangleMesh(shape.vertices, faces)) for faces in (shape.faces, turned))
    np.testing.assert_allclose(found.gaussian, expected.gaussian, rtol=0, atol=1e-9 * np.max(np.abs(expected.gaussian)))
    np.testing.assert_allclose(found.on_arcs, expected.on_arcs, atol=1e-9)


@pytest.mark.parametrize("gap", [1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("face", [10, 200, 500])
def test_needles_do_not_turn_what_lies_beyond_them(gap, face):
    # A vertex beside another one: the side of an edge that it is on, and the direction to it, are lost in the plane.
    shape = shapes.irregular_ellipsoid(1500)
    V, F = shape.vertices, shape.faces
    mesh, (a, b) = TriangleMesh(V, F), F[face, :2]
    step = gap * (V[a] - V[b])
    new, normal = len(V), mesh.vertex_normals[b]
    beside = (a == F).any(axis=1) & (b == F).any(axis=1)
    split = np.concatenate([np.where(F[beside] == end, new, F[beside]) for end in (a, b)])
    W = np.concatenate([V, [V[b] + step - (step @ normal) * normal]])
    found = surface_curvature((W, np.concatenate([F[~beside], split])), method="intrinsic").gaussian[:new]
    clean = surface_curvature((V, F), method="intrinsic").gaussian
    assert np.abs(found - shape.gaussian).max() < 1.2 * np.abs(clean - shape.gaussian).max()


def test_narrow_strips_have_a_spread_that_says_what_averages_leave():
    # K falls by a quarter from the middle of the band to its rims, all of which are near to every vertex.
    torus = shapes.irregular_torus(900)
    V, F = torus.vertices, torus.faces
    band = np.abs(V[F].mean(axis=1)[:, 2]) < 2.2 * TriangleMesh(V, F).mean_edge_length
    c = surface_curvature((V, F[band]), method="intrinsic")
    ok = c.status == VertexStatus.OK
    assert np.mean(np.abs(c.gaussian - torus.gaussian)[ok] < 3 * c.spread[ok]) > 0.95
