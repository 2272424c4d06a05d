"""Invariances of surface_curvature: isometry, renumbering, change of unit, threads."""

import numba
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import shapes
from rinow import IntrinsicMesh, TriangleMesh, surface_curvature

METHODS = st.sampled_from(("auto", "sectional", "lifted", "intrinsic", "wald", "angle_defect"))
FIELDS = ("gaussian", "mean", "k1", "k2", "curvedness")
# Coarse, noisy, open: vertices with few neighbours, with full balls, and at a boundary.
SHAPE = shapes.noisy(shapes.open_patch(150), 0.05)
SEEDS = st.integers(2, 10**6)
FEW = settings(max_examples=25, deadline=None)


def rotation(rng):
    Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return Q * np.sign(np.linalg.det(Q))


def assert_equal_curvature(actual, expected, rtol):
    np.testing.assert_array_equal(actual.status, expected.status)
    for name in FIELDS:
        a, b = getattr(actual, name), getattr(expected, name)
        np.testing.assert_allclose(a, b, rtol=rtol, atol=rtol * np.nanmax(np.append(np.abs(b), 0.0)), err_msg=name)


@FEW
@given(METHODS, SEEDS)
def test_rigid_motions_change_nothing(method, seed):
    rng = np.random.default_rng(seed)
    Q, shift = rotation(rng), rng.normal(size=3)
    c = surface_curvature((SHAPE.vertices, SHAPE.faces), method=method)
    d = surface_curvature((SHAPE.vertices @ Q.T + shift, SHAPE.faces), method=method)
    # Normal equations of order 4 lose four to six digits; so do the differences of angles.
    assert_equal_curvature(d, c, rtol=1e-9)


@FEW
@given(METHODS, SEEDS)
def test_renumbering_vertices_and_faces_renumbers_the_result(method, seed):
    rng = np.random.default_rng(seed)
    n, m = len(SHAPE.vertices), len(SHAPE.faces)
    new, order = rng.permutation(n), rng.permutation(m)
    V = np.empty_like(SHAPE.vertices)
    V[new] = SHAPE.vertices
    F = new[SHAPE.faces][order]
    F = np.take_along_axis(F, (np.arange(3) + rng.integers(0, 3, (m, 1))) % 3, axis=1)
    c = surface_curvature((SHAPE.vertices, SHAPE.faces), method=method)
    d = surface_curvature((V, F), method=method)
    np.testing.assert_array_equal(d.status[new], c.status)
    np.testing.assert_allclose(d.gaussian[new], c.gaussian, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(d.mean[new], c.mean, rtol=1e-9, atol=1e-9)


@FEW
@given(st.sampled_from(("wald", "angle_defect")), st.floats(1e-3, 1e3), SEEDS)
def test_intrinsic_meshes_know_no_numbering_and_no_unit(method, scale, seed):
    rng = np.random.default_rng(seed)
    mesh = TriangleMesh(SHAPE.vertices, SHAPE.faces)
    order = rng.permutation(mesh.n_faces)
    c = surface_curvature(mesh, method=method)
    d = surface_curvature(IntrinsicMesh(mesh.faces[order], mesh.edge_lengths[order] * scale), method=method)
    np.testing.assert_array_equal(d.status, c.status)
    np.testing.assert_allclose(d.gaussian * scale**2, c.gaussian, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(d.spread * scale**2, c.spread, rtol=1e-9)
    np.testing.assert_allclose(d.radius / scale, c.radius, rtol=1e-12)


@FEW
@given(METHODS, SEEDS)
def test_turned_faces_change_nothing(method, seed):
    rng = np.random.default_rng(seed)
    F = SHAPE.faces.copy()
    turned = rng.random(len(F)) < 0.3
    F[turned] = F[turned][:, ::-1]
    c = surface_curvature((SHAPE.vertices, SHAPE.faces), method=method)
    assert_equal_curvature(surface_curvature((SHAPE.vertices, F), method=method), c, rtol=1e-9)


@FEW
@given(METHODS, SEEDS, st.integers(0, 200))
@example("auto", 2, 152)  # once cut into sheets, all neighbours of a vertex lie on it
def test_any_list_of_triangles_is_answered(method, seed, n_faces):
    rng = np.random.default_rng(seed)
    V = rng.integers(-2, 3, (25, 3)) * rng.choice([1.0, 1e-9, np.nan], (25, 1), p=[0.8, 0.15, 0.05])
    F = rng.integers(0, 25, (n_faces + 1, 3))
    c = surface_curvature((V, F), method=method)
    ok, none = c.status == 0, np.isin(c.status, (2, 3, 5, 6))
    assert np.isfinite(c.gaussian[ok]).all()
    if method in ("auto", "sectional", "lifted"):
        assert all(np.isfinite(getattr(c, name)[ok]).all() for name in (*FIELDS, "shape_index", "direction1"))
    assert all(np.isnan(getattr(c, name)[none]).all() for name in (*FIELDS, "spread", "radius"))


@pytest.mark.parametrize("method", ("sectional", "lifted", "wald", "angle_defect"))
def test_one_thread_gives_the_same_bits(method):
    c = surface_curvature((SHAPE.vertices, SHAPE.faces), method=method)
    before = numba.get_num_threads()
    numba.set_num_threads(1)
    try:
        d = surface_curvature((SHAPE.vertices, SHAPE.faces), method=method)
    finally:
        numba.set_num_threads(before)
    for name in (*FIELDS, "spread", "direction1", "direction2"):
        np.testing.assert_array_equal(getattr(d, name), getattr(c, name))
