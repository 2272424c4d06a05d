"""Meshes cut open along their creases: sheets, copies, and curvature from one side only."""

import numpy as np
import pytest

import parts
import rinow
import shapes
from rinow.curvature.barriers import crease_barriers
from rinow.curvature.cut import cut_along_creases


def cut(part):
    mesh = rinow.TriangleMesh(part.vertices, part.faces)
    return mesh, *cut_along_creases(mesh)


def test_a_box_falls_into_six_sides_and_a_cylinder_into_three():
    for part, n_sheets in ((parts.box(0.25), 6), (parts.l_shape(0.25), 8), (parts.cylinder(0.2), 3)):
        mesh, sheets, origin = cut(part)
        assert sheets.topology.n_components == n_sheets
        np.testing.assert_array_equal(origin[: mesh.n_vertices], np.arange(mesh.n_vertices))
        np.testing.assert_array_equal(origin[sheets.faces], mesh.faces)
        np.testing.assert_array_equal(sheets.vertices, mesh.vertices[origin])
        # Each copy has faces of one sheet, and a corner of three sheets has three copies.
        copies = np.bincount(origin)
        assert set(copies[part.corners]) <= {3}
        on_crease = np.setdiff1d(part.creases, part.corners)
        assert (copies[on_crease] == 2).all()
        assert copies.sum() == len(on_crease) + mesh.n_vertices + 2 * len(part.corners)


def test_smooth_meshes_stay_whole():
    shape = shapes.noisy(shapes.irregular_torus(800), 0.05)
    mesh, sheets, origin = cut(shape)
    assert sheets is mesh
    np.testing.assert_array_equal(origin, np.arange(mesh.n_vertices))


def test_given_edges_are_cut_and_unused_vertices_stay():
    shape = shapes.open_patch(100)
    V = np.concatenate([shape.vertices, [[9.0, 9.0, 9.0]]])
    mesh = rinow.TriangleMesh(V, shape.faces)
    t = mesh.topology
    across = (mesh.vertices[t.edges][:, :, 0] > 0).sum(axis=1) == 1
    nothing, origin = cut_along_creases(mesh, np.zeros(t.n_edges, bool))
    assert nothing is mesh and len(origin) == len(V)
    all_cut, origin = cut_along_creases(mesh, np.ones(t.n_edges, bool))
    assert all_cut.topology.n_components == mesh.n_faces
    assert len(origin) == 3 * mesh.n_faces + 1
    # Edges that cross a line form no closed curve, but a band of faces between two rows falls apart.
    some, _ = cut_along_creases(mesh, across)
    assert some.topology.n_components > 1


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_facets_are_flat_and_walls_developable_from_their_own_side(noise):
    part = parts.noisy(parts.cylinder(0.15), noise)
    mesh, sheets, origin = cut(part)
    flat = np.ptp(sheets.vertices[:, 2][sheets.faces], axis=1) < 0.15 * (noise > 0) + 1e-9
    assert flat.any()
    curvature = rinow.surface_curvature(sheets, method="sectional")
    lids = np.unique(sheets.faces[flat & (np.abs(sheets.vertices[:, 2][sheets.faces].mean(axis=1) - 0.75) > 0.7)])
    inside = lids[~sheets.topology.vertex_is_boundary[lids]]
    # A flat disk with noise τ in heights over a radius of about four edges h: K of order (τ/(4 h²))².
    assert np.median(np.abs(curvature.gaussian[inside])) < 1e-6 + 40 * noise
    assert len(origin) == sheets.n_vertices and len(mesh.vertices) == mesh.n_vertices


@pytest.mark.parametrize("width", [0.05, 0.01])
def test_no_curvature_at_a_boundary_exceeds_that_of_a_circle_through_an_edge(width):
    # A noisy strip of one row of triangles, almost a line: the quadrics of its stars bend up to 1500.
    rng, i = np.random.default_rng(7), np.arange(22)
    V = np.column_stack([np.arange(24) / 2, width * (np.arange(24) % 2), 0.02 * rng.normal(size=24)])
    F = np.column_stack([i + i % 2, i + 1 - i % 2, i + 2])
    curvature = rinow.surface_curvature((V, F), method="sectional")
    known = np.isfinite(curvature.gaussian)
    assert known.any()
    assert np.abs(curvature.k1[known]).max() * 0.5 <= 2.0
    assert np.abs(curvature.k2[known]).max() * 0.5 <= 2.0


@pytest.mark.parametrize("quality", ["best", "fast"])
def test_noisy_walls_have_the_mean_curvature_of_their_radius(quality):
    # K is 0 over a plane in any ball, also in those of twice the radius, which miss a third of H.
    part = parts.noisy(parts.cylinder(0.1, radius=0.5, height=2.0), 0.02)
    z, r = part.vertices[:, 2], np.hypot(part.vertices[:, 0], part.vertices[:, 1])
    wall = (np.abs(r - 0.5) < 0.02) & (np.abs(z - 1.0) < 0.8)
    found = rinow.surface_curvature((part.vertices, part.faces), quality=quality)
    # Noise of 0.002 over balls of one radius, of some hundred vertices: H to one or two parts in a hundred.
    np.testing.assert_allclose(found.mean[wall], 1.0, atol=0.05)


def turned(profile, n=36):
    """A ring whose section is a polygon of (radius, height), of long triangles between its corners."""
    t = 2 * np.pi * np.arange(n) / n
    V = np.concatenate([np.stack([r * np.cos(t), r * np.sin(t), np.full(n, z)], axis=1) for r, z in profile])
    return V, strips(n, len(profile))


def strips(n, rings):
    """Triangles between closed rings of n vertices, the last ring joined to the first."""
    a, k = np.arange(n), np.arange(rings)[:, None]
    b, p, q = (a + 1) % n, n * k, n * ((k + 1) % rings)
    quads = ((p + a, p + b, q + b), (p + a, q + b, q + a))
    return np.concatenate([np.stack(c, axis=-1).reshape(-1, 3) for c in quads])


def test_chamfers_of_holes_are_cut_off():
    # The chamfer turns by 40°, as a facet of a coarse round may; but it is narrower than the plane beside it.
    V, F = turned([(0.4, 0), (1, 0), (1, 0.5), (0.48, 0.5), (0.4, 0.5 - 0.08 * np.tan(np.radians(40)))])
    mesh = rinow.TriangleMesh(V, F)
    assert crease_barriers(mesh).sum() == 5 * 36
    np.testing.assert_array_equal(rinow.surface_curvature(mesh).gaussian, 0.0)


def test_corners_with_many_edges_are_no_spikes():
    # A quarter of a disk: both lids are fans about the corner, so that every edge is one of its ring.
    s = np.linspace(0, np.pi / 2, 25)
    P = np.concatenate([[(0.0, 0.0)], np.stack([np.cos(s), np.sin(s)], axis=1)])
    n, f = len(P), np.arange(1, len(P) - 1)
    V = np.concatenate([np.c_[P, np.zeros(n)], np.c_[P, np.full(n, 0.3)]])
    z = np.zeros_like(f)
    walls, lids = strips(n, 2), (np.c_[z + n, f + n, f + n + 1], np.c_[z, f + 1, f])
    F = np.concatenate([walls[:n], walls[2 * n : 3 * n], *lids])
    mesh = rinow.TriangleMesh(V, F)
    assert crease_barriers(mesh).sum() == 2 * n + 3
    curvature = rinow.surface_curvature(mesh)
    np.testing.assert_array_equal(curvature.gaussian, 0.0)
    # The two vertices of the wall that have one of its triangles show nothing of it.
    assert np.sum(np.abs(curvature.mean[2 : n - 1] - 0.5) < 1e-9) == n - 3
