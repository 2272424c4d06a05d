"""Scattered points triangulated up to their convex hull: what is over its dents is no part of the surface."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from rinow import TriangleMesh, VertexStatus, singular_features, surface_curvature
from rinow.curvature.hull_slivers import without_hull_slivers


def scattered(height, n=500, seed=1):
    """Random points of a graph over a square, with the counter-clockwise triangles of Delaunay."""
    return delaunay(height, np.random.default_rng(seed).uniform(-1, 1, (n, 2)))


def delaunay(height, plane):
    faces = Delaunay(plane).simplices.astype(np.intp)
    a, b = (plane[faces[:, k]] - plane[faces[:, 0]] for k in (1, 2))
    faces[a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0]] = faces[a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0]][:, ::-1]
    return TriangleMesh(np.column_stack([plane, height(*plane.T)]), faces)


def cap(x, y):
    return np.sqrt(9.0 - x * x - y * y)


def bump(x, y):
    return np.exp(-x * x - y * y)


def test_a_sliver_goes_and_what_is_behind_it():
    plane = np.array([(-4, 0), (4, 0), (1, 0.4), (-1.5, 0.5), (0, 5)])
    faces = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 4), (3, 2, 4), (2, 1, 4)])
    mesh = TriangleMesh(np.column_stack([plane, -0.05 * plane[:, 0] ** 2]), faces)
    # The angle at 2 is 155°, and both slivers turn by 45° and more from the faces that are none.
    np.testing.assert_array_equal(without_hull_slivers(mesh).faces, faces[2:])
    level = TriangleMesh(mesh.vertices * (1, 1, 0), faces)  # these go on smoothly
    assert without_hull_slivers(level) is level
    alone = TriangleMesh(mesh.vertices[:3], faces[:1])  # no vertex loses its last face
    np.testing.assert_array_equal(without_hull_slivers(alone).faces, faces[:1])


def test_a_mesh_without_slivers_stays_as_it_is():
    x, y = (c.ravel() for c in np.meshgrid(np.arange(4.0), np.arange(3.0)))
    mesh = TriangleMesh(np.column_stack([x, y, 0 * x]), Delaunay(np.column_stack([x, y])).simplices)
    assert without_hull_slivers(mesh) is mesh


def test_slivers_away_from_creases_stay_for_the_fits():
    mesh = scattered(bump)
    nothing = np.zeros(mesh.topology.n_edges, np.bool_)
    assert without_hull_slivers(mesh, nothing) is mesh
    assert without_hull_slivers(mesh, ~nothing).n_faces < mesh.n_faces


@pytest.mark.parametrize("surface", [cap, bump])
@pytest.mark.parametrize("seed", range(1, 5))
def test_a_smooth_surface_has_no_features_at_its_hull(surface, seed):
    # With the slivers 0 to 46 creases, and up to 3 cone points.
    features = singular_features(scattered(surface, seed=seed))
    assert not len(features.crease_edges) and not len(features.cone_points) and not len(features.corners)


@pytest.mark.parametrize("quality", ["best", "fast"])
def test_curvature_at_the_hull_is_that_of_the_surface(quality):
    for seed in range(1, 5):
        mesh = scattered(cap, 800, seed)
        found = surface_curvature(mesh, quality=quality)
        # With the slivers up to 0.25 off, and K = 0 with spread 0 at up to three vertices.
        np.testing.assert_allclose(found.gaussian, 1 / 9, rtol=1e-5)
        ends = mesh.topology.vertex_is_boundary
        np.testing.assert_array_equal(found.status == VertexStatus.BOUNDARY, ends)


def test_a_ridge_is_found_up_to_the_hull():
    plane = np.random.default_rng(1).uniform(-1, 1, (1500, 2))
    ridge, sides = np.linspace(-1, 1, 41), plane[np.abs(plane[:, 0]) > 0.04]
    mesh = delaunay(lambda x, y: -np.abs(x), np.concatenate([np.column_stack([0 * ridge, ridge]), sides]))
    found = {tuple(e) for e in singular_features(mesh).crease_edges.tolist()}
    known = {(k, k + 1) for k in range(40)}
    assert len(found & known) >= 0.95 * max(len(known), len(found))
