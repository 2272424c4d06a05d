"""Kernels of the fits over osculating tori against their naive twins."""

import math

import numpy as np
import pytest

import shapes
from naive import jets as naive_jets
from naive import tori as naive_tori
from rinow import TriangleMesh
from rinow.curvature.centres import cover, flat_frames, members_of_discs, sizes_of_discs, turns
from rinow.curvature.sheet import patch_sheet
from rinow.kernels import balls, bends, nested_fits, patches
from rinow.kernels.osculating_torus import arc_place, offset_forms, torus_coordinates, torus_frame

TORUS = shapes.noisy(shapes.irregular_torus(600), 0.02)
SHEET, INDEX = patch_sheet(TriangleMesh(TORUS.vertices, TORUS.faces))
CURVATURES = [(0.0, 0.0), (0.0, 0.7), (0.3, 0.9), (-0.4, 1.0), (0.5, 0.5)]


@pytest.mark.parametrize(("k1", "k2"), CURVATURES)
def test_torus_coordinates_invert_the_torus(k1, k2):
    rng = np.random.default_rng(31)
    for u1, u2, w in rng.uniform(-1, 1, (50, 3)) * (1.5, 1.5, 0.3):
        place = naive_tori.torus_point(u1, u2, w, k1, k2)
        a, b, c, c1, s1, c2, s2 = torus_coordinates(*place, k1, k2)
        # Rounding of the place, 1e-16, over the smallest radius, about 0.3.
        assert (a, b, c) == pytest.approx((u1, u2, w), abs=3e-15)
        expected = (math.cos(k1 * u1), math.sin(k1 * u1), math.cos(k2 * u2), math.sin(k2 * u2))
        assert (c1, s1, c2, s2) == pytest.approx(expected, abs=3e-15)


def test_a_tiny_curvature_is_nearly_none():
    place = (0.9, -1.1, 0.2)
    np.testing.assert_allclose(torus_coordinates(*place, 1e-12, -0.6), torus_coordinates(*place, 0, -0.6), atol=1e-11)


@pytest.mark.parametrize(("k1", "k2"), CURVATURES)
def test_curvatures_of_an_offset_from_a_torus(k1, k2):
    def f(a, b):
        return 0.1 + 0.2 * a - 0.1 * b + 0.3 * a * a + 0.2 * a * b - 0.25 * b * b + 0.1 * a**3

    u1, u2 = 0.3, -0.4
    jet = (
        f(u1, u2), 0.2 + 0.6 * u1 + 0.2 * u2 + 0.3 * u1**2, -0.1 + 0.2 * u1 - 0.5 * u2, 0.6 + 0.6 * u1, 0.2, -0.5
    )  # fmt: skip
    g11, g12, g22, l, m, n, volume = offset_forms(arc_place(u2, k2), k1, k2, *jet)
    assert volume == pytest.approx(math.sqrt(g11 * g22 - g12 * g12), rel=1e-13)
    K, H = naive_tori.offset_curvatures(f, u1, u2, k1, k2)
    # Differences of second order of numbers of size 1 with steps of 1e-3: 1e-16 / 1e-6.
    assert (l * n - m * m) / volume**2 == pytest.approx(K, abs=1e-8)
    assert (g22 * l - 2 * g12 * m + g11 * n) / (2 * volume**2) == pytest.approx(H, abs=1e-8)


def test_the_frame_of_a_torus_is_orthonormal_and_follows_its_arcs():
    u1, u2, k1, k2, step = 0.4, -0.7, 0.5, 0.9, 1e-5
    a, b, n = torus_frame(math.cos(k1 * u1), math.sin(k1 * u1), math.cos(k2 * u2), math.sin(k2 * u2))
    np.testing.assert_allclose(np.array([a, b, n]) @ np.array([a, b, n]).T, np.eye(3), atol=1e-15)
    ahead, behind = (np.array(naive_tori.torus_point(u1, u2 + s, 0.0, k1, k2)) for s in (step, -step))
    np.testing.assert_allclose((ahead - behind) / (2 * step), b, atol=1e-9)
    ahead, behind = (np.array(naive_tori.torus_point(u1, u2, s, k1, k2)) for s in (step, -step))
    np.testing.assert_allclose((ahead - behind) / (2 * step), n, atol=1e-9)


@pytest.mark.parametrize("order", range(2, 9))
def test_nested_fits_equal_orthogonalised_least_squares(order):
    rng = np.random.default_rng(32)
    n, reach = 120, 3.0
    u, v = reach * np.sqrt(rng.uniform(0, 1, n)) * np.array([np.cos(t := rng.uniform(0, 7, n)), np.sin(t)])
    w = 0.1 + 0.2 * u * v - 0.1 * u**2 + 0.01 * rng.normal(size=n)
    points = np.stack([u, v, w, u * u + v * v])
    work = nested_fits.fits(2)
    reaches = np.array([0.6 * reach, 1.01 * reach])  # the outer ball holds every point
    nested_fits.add_moments(points, n, reaches, 8, work)
    inner = np.count_nonzero(points[3] < reaches[0] ** 2)
    assert work.counts.tolist() == [inner, n]
    assert nested_fits.fit_orders(1, reaches[1], 8, work) == 8
    columns = naive_tori.polynomial_columns(points[:3].T.tolist(), order, reaches[1])
    c = naive_jets.least_squares(columns, w.tolist())
    r = reaches[1]
    expected = [c[0], c[1] / r, c[2] / r, 2 * c[3] / r**2, c[4] / r**2, 2 * c[5] / r**2]
    # Normal equations with pivots down to 2e-6 lose ten of sixteen digits at most, seven here.
    np.testing.assert_allclose(work.jets[order], expected, rtol=1e-7, atol=1e-9)
    A = np.array(columns).T
    rest = w - A @ c
    assert work.residuals[order] == pytest.approx(rest @ rest, rel=1e-7)
    covariance = np.linalg.inv(A.T @ A)[3:6, 3:6] * np.outer(*2 * [np.array([2, 1, 2]) / r**2])
    np.testing.assert_allclose(work.covariances[order], covariance[np.triu_indices(3)], rtol=1e-6, atol=1e-12)
    out = np.empty(45)
    nested_fits.coefficients(order, 8, work, out)
    np.testing.assert_allclose(out[: len(c)], c, rtol=1e-6, atol=1e-8)


def test_half_a_disc_tells_order_eight_about_the_mean_of_its_points():
    rng = np.random.default_rng(36)
    n, reach = 150, 3.0
    u, v = reach * np.sqrt(rng.uniform(0, 1, n)) * np.array([np.cos(t := rng.uniform(0, np.pi, n)), np.sin(t)])
    w = 0.3 - 0.2 * u + 0.1 * v + 0.4 * u * u - 0.3 * u * v + 0.2 * v * v + 0.05 * u**3 * v - 1e-3 * v**8
    points, reaches, tops = np.stack([u, v, w, u * u + v * v]), np.array([reach]), []
    work = nested_fits.fits(1)
    for is_placed in (False, True):
        if is_placed:
            assert nested_fits.place_origin(points, n, reach, work)
        nested_fits.add_moments(points, n, reaches, 8, work)
        tops.append(nested_fits.fit_orders(0, reach, 8, work))
    assert tops[0] < 8 and tops[1] == 8
    # Exact data; pivots down to 2e-6 cost ten digits of sixteen at most.
    np.testing.assert_allclose(work.jets[8], [0.3, -0.2, 0.1, 0.8, -0.3, 0.4], atol=1e-6)
    assert not nested_fits.place_origin(np.zeros((4, 9)), 9, reach, work)
    np.testing.assert_array_equal(work.targets, np.eye(45, 6))


def test_points_on_a_conic_leave_the_order_below_two():
    t = np.linspace(0, 6, 40)
    points = np.stack([np.cos(t), 2 * np.sin(t), 0.1 * t, np.ones(40)])
    work = nested_fits.fits(1)
    nested_fits.add_moments(points, 40, np.array([2.0]), 8, work)
    assert nested_fits.fit_orders(0, 2.0, 5, work) == 1


def test_an_order_needs_more_points_than_unknowns():
    expected = {7: 1, 8: 2, 12: 2, 13: 3, 18: 3, 19: 4, 56: 7, 57: 8}
    assert {n: nested_fits.highest_order(n, 8) for n in expected} == expected
    assert nested_fits.highest_order(57, 4) == 4


def second_derivatives(order, reach, u, v):
    """(3, n_terms): f11, f12, f22 at a point for each coefficient of a polynomial in coordinates over the reach."""
    units = np.eye(nested_fits.TERMS[order])
    return np.array([patches.polynomial(c, order, reach, u, v)[3:] for c in units]).T


def fit_of(u, v, order, reach):
    points = np.stack([u, v, np.zeros_like(u), u * u + v * v])
    work = nested_fits.fits(1)
    nested_fits.add_moments(points, len(u), np.array([reach]), order, work)
    assert nested_fits.fit_orders(0, reach, order, work) == order
    return work, np.array(naive_tori.polynomial_columns(points[:3].T.tolist(), order, reach)).reshape(-1, len(u)).T


def variances_beside(places, order, work):
    points = np.array(places).T.copy()
    bends.bend_variances(points, len(places), 3.0, 3.0, order, work)
    return work.bends[: len(places)].copy()


@pytest.mark.parametrize("order", [2, 5, 7])
def test_variance_beside_the_centre_is_that_of_least_squares(order):
    u, v = np.random.default_rng(33).uniform(-2, 2, (2, 60))
    work, columns = fit_of(u, v, order, 3.0)
    covariance = np.linalg.inv(columns.T @ columns)
    places = [(0.0, 0.0), (1.0, -0.4), (-0.3, 1.5)]
    at_centre, *beside = variances_beside(places, order, work)
    for place, found in zip(places[1:], beside, strict=True):
        g = second_derivatives(order, 3.0, *place)
        assert found == pytest.approx(np.trace(g @ covariance @ g.T), rel=1e-6)
    c = work.covariances[order]
    assert at_centre == pytest.approx(c[0] + c[3] + c[5])


def test_points_in_rows_fix_a_polynomial_at_the_centre_and_not_beside_it():
    # 25 points near a square lattice, as marching cubes leave them: polynomials of order 5 may swing between its rows.
    x, y = (g.ravel() for g in np.meshgrid(np.arange(-3, 4.0), np.arange(-3, 4.0)))
    near = x * x + y * y < 2.9**2
    u, v = np.stack([x[near], y[near]]) + 0.02 * np.random.default_rng(34).normal(size=(2, near.sum()))
    assert len(u) < nested_fits.ROOMY * nested_fits.TERMS[5]
    work, _ = fit_of(u, v, 5, 3.0)
    at_centre, beside = variances_beside([(0.0, 0.0), (1.0, 0.0)], 5, work)
    assert beside > 10.0 * at_centre


def test_polynomial_has_its_derivatives():
    rng = np.random.default_rng(33)
    c, reach, h = rng.normal(size=45), 2.0, 1e-5
    f, f1, f2, f11, f12, f22 = patches.polynomial(c, 8, reach, 0.5, -0.7)
    columns = naive_tori.polynomial_columns([[0.5, -0.7, 0.0]], 8, reach)
    assert f == pytest.approx(sum(a * col[0] for a, col in zip(c, columns, strict=True)), rel=1e-12)

    def slopes(u, v):
        return np.array(patches.polynomial(c, 8, reach, u, v))

    along, across = (slopes(0.5 + h, -0.7) - slopes(0.5 - h, -0.7)), (slopes(0.5, -0.7 + h) - slopes(0.5, -0.7 - h))
    np.testing.assert_allclose(along[:3] / (2 * h), [f1, f11, f12], rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(across[:3] / (2 * h), [f2, f12, f22], rtol=1e-8, atol=1e-8)


def neighbours_of(sheet):
    rows = np.split(sheet.neighbours, sheet.offsets[1:-1])
    return [set(row.tolist()) for row in rows]


@pytest.mark.parametrize("reach", [2.5, 6.0])
def test_a_ball_is_the_set_of_admitted_vertices_joined_to_its_centre(reach):
    work, near = balls.ball(len(SHEET.vertices), 4096), neighbours_of(SHEET)
    for epoch, v in enumerate((3, 211, 598), 1):
        frame = flat_frames(SHEET, np.array([v], np.int32))[0]
        frame[9:] = 0.1, 0.2
        spacing = SHEET.spacing[v]
        n = balls.grow(v, frame, reach, epoch, SHEET, work)

        def coordinates(q, v=v, frame=frame, spacing=spacing):
            d = (SHEET.vertices[q] - SHEET.vertices[v]) / spacing
            return torus_coordinates(d @ frame[3:6], d @ frame[6:9], d @ frame[:3], *frame[9:] * spacing)

        def admits(q, v=v, frame=frame, spacing=spacing):
            u1, u2, w, c1, s1, c2, s2 = coordinates(q)
            N = np.array([-s1 * c2, -s2, c1 * c2]) @ np.stack([frame[3:6], frame[6:9], frame[:3]])
            far = np.linalg.norm(SHEET.vertices[q] - SHEET.vertices[v]) >= reach * spacing
            far |= u1**2 + u2**2 + w**2 >= reach**2
            return not far and N @ SHEET.normals[q] > 0.3 and abs(w) < 1 + 0.8 * math.hypot(u1, u2) and c1 > -0.32

        expected = naive_tori.ball(SHEET.vertices, near, v, admits)
        assert set(work.members[:n].tolist()) == expected
        for i in range(1, n):
            np.testing.assert_allclose(work.points[:3, i], coordinates(work.members[i])[:3], atol=1e-14)


def test_a_ball_does_not_enter_another_sheet():
    # Two square grids 0.01 apart, and the same folded together along one side.
    patch = shapes.open_patch(100)
    V = np.concatenate([patch.vertices * (1, 1, 0), patch.vertices * (1, 1, 0) + (0, 0, 0.01)])
    apart = TriangleMesh(V, np.concatenate([patch.faces, patch.faces[:, ::-1] + len(patch.vertices)]))
    edge = np.flatnonzero(patch.vertices[:, 0] == -1)
    index = np.arange(len(V))
    index[edge + len(patch.vertices)] = edge
    v = int(np.argmin(np.abs(patch.vertices[:, :2] - (-0.5, 0)).sum(axis=1)))
    for mesh in (apart, TriangleMesh(V, index[apart.faces])):
        sheet, order = patch_sheet(mesh)
        work, centre = balls.ball(len(order), 4096), int(np.flatnonzero(order == v)[0])
        n = balls.grow(centre, flat_frames(sheet, np.array([centre], np.int32))[0], 4.0, 1, sheet, work)
        assert n > 20
        assert (order[work.members[:n]] < len(patch.vertices)).all()


@pytest.mark.parametrize("radius", [0.9, 3.0])
def test_centres_cover_the_sheet_and_are_in_no_disc_of_each_other(radius):
    centres = cover(SHEET, turns(SHEET), np.full(len(INDEX), radius))
    everything = np.arange(len(INDEX), dtype=np.int32)
    starts, members = members_of_discs(SHEET, everything, centres, np.full(len(centres), radius))
    assert len(np.unique(members)) == len(INDEX)
    np.testing.assert_array_equal(np.diff(starts), sizes_of_discs(SHEET, centres, np.full(len(centres), radius)))
    again = members_of_discs(SHEET, everything, centres, np.full(len(centres), radius), 1)  # too little room
    np.testing.assert_array_equal(np.concatenate(again), np.concatenate([starts, members]))
    for i in range(len(centres)):
        row = members[starts[i] : starts[i + 1]]
        others = np.intersect1d(row, centres)
        distance = np.linalg.norm(SHEET.vertices[others] - SHEET.vertices[centres[i]], axis=1)
        # Discs have radii in the spacing of their own centres: a later centre may hold an earlier one.
        earlier = np.minimum(SHEET.spacing[others], SHEET.spacing[centres[i]])
        assert (distance[others != centres[i]] >= radius * earlier[others != centres[i]]).all()


def test_the_choice_of_centres_knows_no_motion_no_scale_and_no_numbering():
    rng = np.random.default_rng(34)
    Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    Q *= np.sign(np.linalg.det(Q))
    new = rng.permutation(len(TORUS.vertices))
    V = np.empty_like(TORUS.vertices)
    V[new] = 37.0 * TORUS.vertices @ Q.T + 1.0
    sheet, index = patch_sheet(TriangleMesh(V, new[TORUS.faces]))
    centres = INDEX[cover(SHEET, turns(SHEET), np.full(len(INDEX), 2.0))]
    moved = index[cover(sheet, turns(sheet), np.full(len(index), 2.0))]
    assert set(new[centres].tolist()) == set(moved.tolist())


@pytest.mark.parametrize("radius", [1.2, 2.0, 4.5])
def test_stars_of_equal_shape_become_centres_together(radius):
    # Latitudes of 30 equal stars each: what a step along them leaves as it is keeps the centres.
    u, v = (x.ravel() for x in np.meshgrid(np.arange(30), np.arange(14), indexing="ij"))
    s, t = 2 * np.pi * u / 30, 2 * np.pi * v / 14
    V = np.stack([(2.0 + 0.8 * np.cos(t)) * np.cos(s), (2.0 + 0.8 * np.cos(t)) * np.sin(s), 0.8 * np.sin(t)])
    a, b, c, d = (((u + i) % 30) * 14 + (v + j) % 14 for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
    sheet, index = patch_sheet(TriangleMesh(V.T, np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3)))
    centres = np.sort(index[cover(sheet, turns(sheet), np.full(len(index), radius))])
    assert 30 <= len(centres) < len(index)
    np.testing.assert_array_equal(np.sort((centres + 14) % len(index)), centres)
