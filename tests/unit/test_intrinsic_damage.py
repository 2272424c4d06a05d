"""Curvature from edge lengths alone of damaged meshes, and in another order, orientation and unit."""

import numpy as np
import pytest

import shapes
from rinow import TriangleMesh, VertexStatus, surface_curvature
from rinow.curvature import intrinsic
from rinow.curvature.intrinsic import intrinsic_curvature
from surface_methods import NOISY_TORUS, curvature_by_lengths


def test_order_orientation_and_unit_do_not_matter():
    V, F = NOISY_TORUS.vertices, NOISY_TORUS.faces
    rng = np.random.default_rng(7)
    K = curvature_by_lengths(NOISY_TORUS).gaussian
    close = {"rtol": 1e-9, "atol": 1e-9 * np.abs(K).max()}  # rounding of defects, over areas of 0.01
    p = rng.permutation(len(V))
    G = np.argsort(p)[F][rng.permutation(len(F))]
    again = surface_curvature((V[p], np.roll(G[:, ::-1], 1, axis=1)), method="intrinsic").gaussian
    np.testing.assert_allclose(again, K[p], **close)
    for scale in (1e-3, 1e3):
        scaled = surface_curvature((V * scale, F), method="intrinsic").gaussian
        np.testing.assert_allclose(scaled * scale**2, K, **close)


def test_large_meshes_are_computed_in_another_order(monkeypatch):
    p = np.random.default_rng(7).permutation(len(NOISY_TORUS.vertices))
    V, F = NOISY_TORUS.vertices[p], np.argsort(p)[NOISY_TORUS.faces]
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
    clean, found = curvature_by_lengths(shape).gaussian, []
    for beside in (0.0, 1e-6):
        V, (a, b, c) = shape.vertices.copy(), shape.faces[100]
        V[a] = 0.5 * (V[b] + V[c]) * (1.0 + beside)
        moved = curvature_by_lengths(shape._replace(vertices=V))
        assert (moved.status == VertexStatus.OK).all()
        found.append(np.abs(moved.gaussian - clean).max())
    assert found[0] < 2.0 * found[1] < 0.5 * clean.mean()


@pytest.mark.parametrize(
    "shape",
    [shapes.tetrahedron(), shapes.bow_tie(), shapes.moebius_strip(), shapes.two_components(), shapes.cone(),
     shapes.soup(shapes.icosphere(1)), shapes.open_patch(100)],
)  # fmt: skip
def test_no_shape_is_refused(shape):
    c = curvature_by_lengths(shape)
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
