"""Geodesics on surfaces parts of which have shrunk to a point."""

import numpy as np
import pytest

import rinow
import shapes
from rinow import ExactGeodesics, IntrinsicMesh, TriangleMesh
from rinow.geodesics.contraction import contraction

SPHERE = shapes.icosphere(2)
V, F = SPHERE.vertices, SPHERE.faces
POLE = np.array([0.0, 0.0, 1.0])


def shrunk(part, size):
    """The sphere with some vertices drawn together around the pole."""
    return np.where(part[:, None], POLE + size * (V - POLE), V)


def distances(vertices):
    return rinow.geodesic_distances((vertices, F), np.arange(len(V)))


@pytest.mark.parametrize("height", [0.95, 0.8, 0.4, -0.5])
def test_a_cap_that_is_a_point_is_the_limit_of_small_caps(height):
    cap = V[:, 2] > height
    D = distances(shrunk(cap, 0.0))
    assert (D[np.ix_(cap, cap)] == 0).all()
    assert np.abs(D - D.T).max() <= 1e-12
    size = 1e-6
    assert np.abs(D - distances(shrunk(cap, size))).max() <= 8 * size  # twice a path through the cap


def test_a_belt_that_is_a_point_joins_two_parts():
    belt = np.abs(V[:, 2]) < 0.3
    D = distances(shrunk(belt, 0.0))
    top, bottom = V[:, 2] >= 0.3, V[:, 2] <= -0.3
    through = D[:, belt][:, :1]
    np.testing.assert_allclose(D[np.ix_(top, bottom)], (through + through.T)[np.ix_(top, bottom)], rtol=1e-12)


@pytest.mark.parametrize("points", [V * 0, V * 0 + 3.0])
def test_a_mesh_that_is_one_point(points):
    assert (distances(points) == 0).all()
    balls = ExactGeodesics((points, F)).polar([5, 7], max_distance=0.0)
    assert np.diff(balls.offsets).tolist() == [len(V), len(V)]
    assert balls.vertices[balls.offsets[:-1]].tolist() == [5, 7]
    assert (balls.distances == 0).all()


def test_edge_lengths_tell_the_same_as_positions():
    mesh = TriangleMesh(shrunk(V[:, 2] > 0.8, 0.0), F)
    known = IntrinsicMesh(F, mesh.edge_lengths)
    sources = [0, 50, 161]
    expected = rinow.geodesic_distances(mesh, sources)
    np.testing.assert_allclose(rinow.geodesic_distances(known, sources), expected, rtol=1e-9, atol=1e-12)


def test_balls_hold_all_vertices_at_a_point():
    cap = V[:, 2] > 0.8
    geodesics = ExactGeodesics((shrunk(cap, 0.0), F))
    sources = np.concatenate([np.flatnonzero(cap)[-2:], [int(V[:, 2].argmin())]])
    rows, radius = geodesics.distances(sources), 1.3
    near = geodesics.distances(sources, max_distance=radius)
    np.testing.assert_array_equal(near.toarray(), np.where(rows <= radius, rows, 0.0))
    assert np.diff(near.indptr).tolist() == (rows <= radius).sum(axis=1).tolist()
    balls = geodesics.polar(sources, max_distance=10.0)
    assert balls.vertices[balls.offsets[:-1]].tolist() == sources.tolist()
    for i in range(len(sources)):
        ball = slice(balls.offsets[i], balls.offsets[i + 1])
        np.testing.assert_array_equal(rows[i, balls.vertices[ball]], balls.distances[ball])
        directions = balls.directions[ball][balls.distances[ball] > 0]
        assert ((directions >= 0) & (directions <= balls.total_angles[i])).all()


def test_lines_are_part_of_the_surface():
    """Faces with a side of length 0 and no face beside them."""
    needle = [[0, 0, 0], [0, 0, 0], [2, 0, 0]], [[0, 1, 2]]
    np.testing.assert_allclose(rinow.geodesic_distances(needle, [0, 1, 2])[:, 2], [2, 2, 0], atol=1e-15)
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 0], [1, -2, 0]]
    tail = square, [[0, 1, 3], [1, 2, 3], [1, 4, 5]]
    D = rinow.geodesic_distances(tail, [5])[0]
    np.testing.assert_allclose(D, [3, 2, 3, 2 + 2**0.5, 2, 0], atol=1e-15)


def test_a_mesh_without_such_edges_stays_itself():
    assert contraction(TriangleMesh(V, F)) is None
