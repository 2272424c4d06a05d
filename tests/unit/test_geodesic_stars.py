"""Wald's and Robinson's curvature of stars of geodesic distances: known values, stars in plain loops, boundaries."""

import math

import numba
import numpy as np
import pytest

import shapes
from metric_shapes import flat_torus, hyperbolic_patch
from naive import closed_stars
from naive import geodesics as naive_geodesics
from plates import perforated_plate
from rinow import InvalidInputError, TriangleMesh, VertexStatus, surface_curvature
from rinow.kernels import geodesic_stars as kernels

METHODS = ("wald", "robinson")


def curvature(shape, method, radius=None):
    return surface_curvature((shape.vertices, shape.faces), method=method, radius=radius)


@pytest.mark.parametrize("method", METHODS)
def test_a_flat_torus_is_flat(method):
    c = surface_curvature(flat_torus(16), method=method, radius=0.2)
    # Rounding 1e-16 over 0.2² and the size of a condition, 1000.
    np.testing.assert_allclose(c.gaussian, 0, atol=1e-10)
    assert (c.status == VertexStatus.OK).all()
    np.testing.assert_allclose(c.radius, 0.2)


@pytest.mark.parametrize("method", METHODS)
def test_the_hyperbolic_plane_and_its_boundary(method):
    mesh, r = hyperbolic_patch(800)
    c = surface_curvature(mesh, method=method, radius=0.3)
    boundary = mesh.topology.vertex_is_boundary
    # Straight triangles of the size 0.07 instead of hyperbolic ones, and few vertices in each direction.
    np.testing.assert_allclose(c.gaussian[r < 0.6], -1, atol=0.05)
    assert np.isnan(c.gaussian[boundary]).all()
    assert (c.status[boundary] == VertexStatus.BOUNDARY).all()
    # Stars are not cut but shrink before the boundary; the innermost have their full radius.
    near = (r > 0.85) & ~boundary & (c.status == VertexStatus.OK)
    assert (c.radius[near] < 0.3).all()
    np.testing.assert_allclose(c.radius[r < 0.6], 0.3)
    assert np.mean(c.status[~boundary] == VertexStatus.OK) > 0.97
    assert np.median(np.abs(c.gaussian[near] + 1)) < 0.2


@pytest.mark.parametrize("method", METHODS)
def test_positions_are_not_read(method):
    shape = shapes.irregular_torus(400)
    mesh = TriangleMesh(shape.vertices, shape.faces)
    a, b = (surface_curvature(m, method=method, radius=0.5).gaussian for m in (mesh, mesh.intrinsic()))
    # From positions geodesics know the shapes of faces a little better than from lengths.
    np.testing.assert_allclose(a, b, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_better_than_the_ring(method):
    shape = shapes.irregular_torus(1500)
    spacing = TriangleMesh(shape.vertices, shape.faces).mean_edge_length
    c, ring = curvature(shape, method, 3.5 * spacing), curvature(shape, "wald")
    error, plain = (np.sqrt(np.mean((x.gaussian - shape.gaussian) ** 2)) for x in (c, ring))
    assert error < 0.6 * plain
    assert np.mean(np.abs(c.gaussian - shape.gaussian) < 2 * c.spread) > 0.85


def test_small_radii_give_the_ring():
    shape = shapes.irregular_sphere(200)
    a, b = curvature(shape, "wald", 1e-6), curvature(shape, "wald")
    np.testing.assert_array_equal(a.gaussian, b.gaussian)
    np.testing.assert_array_equal(a.radius, b.radius)
    assert (curvature(shape, "robinson", 1e-6).status == VertexStatus.UNRESOLVED).all()


@pytest.mark.parametrize("method", METHODS)
def test_order_orientation_and_unit_do_not_matter(method):
    shape = shapes.irregular_ellipsoid(300)
    V, F, rng = shape.vertices, shape.faces, np.random.default_rng(7)
    K = surface_curvature((V, F), method=method, radius=0.4).gaussian
    scaled = surface_curvature((V * 8, F), method=method, radius=3.2).gaussian
    np.testing.assert_allclose(64 * scaled, K, rtol=1e-9)
    p = rng.permutation(len(V))
    again = surface_curvature((V[p], np.argsort(p)[F[:, ::-1]]), method=method, radius=0.4).gaussian
    np.testing.assert_allclose(again, K[p], rtol=1e-9)


@pytest.mark.parametrize("scale", [3.7, 1e-3])
@pytest.mark.parametrize(("sides", "method"), [(5, "robinson"), (6, "robinson"), (6, "wald")])
def test_ties_on_symmetric_plates_are_not_decided_by_rounding(sides, method, scale):
    # In rows of holes many vertices are at one distance from a vertex, some of them by two ways of one length.
    V, F, _ = perforated_plate(5, sides)
    c, d = (
        surface_curvature((s * V, F), method=method, radius=1.2 * s if method == "wald" else None) for s in (1.0, scale)
    )
    np.testing.assert_array_equal(d.status, c.status)
    size = np.nanmax(np.abs(c.gaussian))
    np.testing.assert_allclose(d.gaussian * scale**2, c.gaussian, rtol=1e-9, atol=1e-9 * size)


@pytest.mark.parametrize("method", METHODS)
def test_same_bits_on_one_and_two_threads(method):
    shape, threads = shapes.open_patch(200), numba.get_num_threads()
    K = curvature(shape, method, 0.4).gaussian
    numba.set_num_threads(1)
    try:
        np.testing.assert_array_equal(curvature(shape, method, 0.4).gaussian, K)
    finally:
        numba.set_num_threads(threads)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    "shape",
    [shapes.tetrahedron(), shapes.bow_tie(), shapes.moebius_strip(), shapes.two_components(), shapes.cone(),
     shapes.soup(shapes.icosphere(1)), shapes.open_patch(100)],
)  # fmt: skip
def test_no_shape_is_refused(shape, method):
    c = curvature(shape, method, 0.5)
    assert np.isfinite(c.gaussian[c.status == VertexStatus.OK]).all()
    assert np.isnan(c.gaussian[c.status == VertexStatus.BOUNDARY]).all()


def test_the_default_radius_of_robinson_is_some_spacings():
    shape = shapes.irregular_sphere(300)
    c = curvature(shape, "robinson")
    spacing = TriangleMesh(shape.vertices, shape.faces).mean_edge_length
    assert ((3 * spacing < c.radius) & (c.radius < 5 * spacing)).all()
    np.testing.assert_allclose(c.gaussian, 1, atol=0.15)


def half(shape, axis):
    F = shape.faces[shape.vertices[shape.faces].mean(axis=1)[:, axis] > 0.0]
    used, F = np.unique(F, return_inverse=True)
    return shapes.Shape(shape.vertices[used], F.reshape(-1, 3), shape.gaussian[used], shape.mean[used])


@pytest.mark.parametrize(
    "shape",
    [half(shapes.icosphere(3), 2), half(shapes.irregular_sphere(1000), 2), half(shapes.irregular_torus(1500), 0)],
    ids=["icosphere", "sphere", "torus"],
)
@pytest.mark.parametrize("method", METHODS)
def test_beside_a_boundary_the_curvature_is_taken_from_farther_inside(shape, method):
    mesh = TriangleMesh(shape.vertices, shape.faces)
    c = curvature(shape, method, None if method == "robinson" else 3 * mesh.mean_edge_length)
    inside = ~mesh.topology.vertex_is_boundary
    assert (c.status[inside] == VertexStatus.OK).all()
    at_rim = np.unique(mesh.faces[mesh.topology.vertex_is_boundary[mesh.faces].any(axis=1)])
    at_rim = at_rim[inside[at_rim]]
    error = np.abs(c.gaussian - shape.gaussian)[at_rim]
    # Stars of one spacing see half of K.  On the torus K changes by 0.2 of its root mean square over two spacings.
    assert np.median(error) < 0.1 * np.sqrt(np.mean(shape.gaussian**2))
    assert (error < 1.2 * c.spread[at_rim]).all()


@pytest.mark.parametrize("method", METHODS)
def test_stars_of_one_spacing_have_a_spread_that_says_so(method):
    shape = shapes.irregular_sphere(600)
    c = curvature(shape, method, TriangleMesh(shape.vertices, shape.faces).mean_edge_length)
    ok = c.status == VertexStatus.OK
    assert np.isfinite(c.spread[ok]).all()
    assert np.mean(np.abs(c.gaussian - 1)[ok] < 2 * c.spread[ok]) > 0.99


def test_radius_is_checked():
    for method in METHODS:
        with pytest.raises(InvalidInputError, match="not a positive length"):
            curvature(shapes.tetrahedron(), method, -1.0)


# ------------------------------------------------------------------ parts in plain loops


def test_stars_in_plain_loops():
    rng = np.random.default_rng(7)
    directions = np.sort(rng.uniform(0, 2 * math.pi, 8)) * 0.2 + np.arange(8) * math.pi / 4
    radii = rng.uniform(0.8, 1.2, 8)
    gaps = np.diff(directions, append=directions[0] + 2 * math.pi)
    chords = np.sqrt(radii**2 + np.roll(radii, -1) ** 2 - 2 * radii * np.roll(radii, -1) * np.cos(gaps)) * 0.98
    out = np.empty(1)
    kernels.star_values(np.array([8]), radii[None], chords[None], out)
    assert out[0] == pytest.approx(closed_stars.curvature(radii, chords, -5, 2), abs=1e-9)


def test_stars_hold_geodesic_distances(monkeypatch):
    shape = shapes.icosphere(1)

    def length(a, b):
        return math.dist(shape.vertices[a], shape.vertices[b])

    D = np.array(naive_geodesics.geodesic_distances(42, shape.faces.tolist(), length))
    seen = []
    compiled = kernels.star_values

    def recorded(counts, radii, chords, out):
        compiled(counts, radii, chords, out)
        seen.append((counts.copy(), radii.copy(), chords.copy(), out.copy()))

    monkeypatch.setattr(kernels, "star_values", recorded)
    curvature(shape, "wald", 0.9)
    counts, radii, chords, values = seen[0]  # those of the full radius; the smaller ones follow
    assert len(counts) == 42 and (counts >= kernels.FEWEST).all()
    for n, r, c, value in zip(counts, radii, chords, values, strict=True):
        for x in (*r[:n], *c[:n]):
            assert np.abs(D - x).min() < 1e-12
        assert (np.abs(r[:n] - 0.9) <= 0.45).all()
        assert value == pytest.approx(closed_stars.curvature(r[:n], c[:n], -5, 2), abs=1e-9)


def test_lines_of_a_surface_of_constant_curvature():
    # Exact distances in S_k: the mean of Robinson's second order is off by 0.04 k³ diameter⁴.
    for k in (1.0, -1.0):
        angle = np.arange(4) * math.pi / 4
        directions = np.concatenate([angle, angle + math.pi])
        r, across = np.full((1, 8), 0.3), np.empty((1, 2, 2, 2))
        s, c = (math.sin, math.cos) if k > 0 else (math.sinh, math.cosh)
        for line in range(2):
            for e in range(2):
                for f in range(2):
                    turn = directions[line + 4 * e] - directions[line + 2 + 4 * f]
                    x = c(0.3) ** 2 + math.copysign(s(0.3) ** 2 * math.cos(turn), k)
                    across[0, line, e, f] = math.acos(x) if k > 0 else math.acosh(x)
        out = np.empty(1)
        kernels.robinson_values(r, across, np.zeros((1, 4)), 2, out)
        assert out[0] == pytest.approx(k, abs=0.042 * 0.6**4)
        # A small bend of every second end is undone to the first order.
        bent = np.empty(1)
        kernels.robinson_values(r, across, np.full((1, 4), 1e-3), 2, bent)
        assert bent[0] == pytest.approx(out[0], abs=1e-3)


def test_intrinsic_meshes_have_no_other_field():
    shape = shapes.irregular_sphere(200)
    c = surface_curvature(TriangleMesh(shape.vertices, shape.faces).intrinsic(), method="robinson")
    assert np.isfinite(c.gaussian).all() and np.isnan(c.mean).all() and np.isnan(c.direction1).all()
