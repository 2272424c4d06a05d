"""Nets of spaces and meshes: closed forms, faulty meshes, and every refusal."""

import math
import re

import numpy as np
import pytest

import rinow
from naive.nets import circle
from rinow.errors import InvalidInputError
from shapes import icosphere, irregular_torus, two_components

LINE = np.abs(np.arange(9.0)[:, None] - np.arange(9.0))


def test_points_of_a_line():
    net = rinow.farthest_point_net(LINE, size=5, start=2)
    assert net.indices.tolist() == [2, 8, 5, 0, 1]
    assert net.radii.tolist() == [6, 3, 2, 1, 1]
    assert net.covering_radius == net.surface_radius == 1
    assert net.labels.tolist() == [3, 4, 0, 0, 2, 2, 2, 1, 1]
    assert net.distances.tolist() == [0, 0, 0, 1, 1, 0, 1, 1, 0]


@pytest.mark.parametrize(("radius", "size"), [(8.0, 1), (4.0, 2), (3.9, 3), (1.0, 5), (0.0, 9)])
def test_the_net_stops_at_the_radius(radius, size):
    net = rinow.farthest_point_net(LINE, radius=radius)
    assert len(net.indices) == size
    assert net.covering_radius <= radius
    assert len(rinow.farthest_point_net(LINE, radius=radius, size=2).indices) == min(size, 2)


def test_all_points_of_a_space_with_repeated_points():
    net = rinow.farthest_point_net(np.zeros((4, 4)), size=4)
    assert sorted(net.indices) == [0, 1, 2, 3]
    assert net.covering_radius == 0
    assert rinow.farthest_point_net(np.zeros((4, 4)), radius=0.0).indices.tolist() == [0]


def test_powers_of_two_of_a_circle():
    """2^k farthest points of a circle are equidistant: the covering radius is π/2^k."""
    for k in range(6):
        net = rinow.farthest_point_net(circle(64), size=2**k)
        assert net.covering_radius == pytest.approx(math.pi / 2**k, rel=1e-12)


def test_a_space_in_parts_needs_a_point_in_each():
    D = [[0, 1, np.inf], [1, 0, np.inf], [np.inf, np.inf, 0]]
    import networkx as nx

    graph = nx.Graph([(0, 1)])
    graph.add_node(2)
    space = rinow.MetricSpace.from_graph(graph, infinite=True)
    assert space.distances.tolist() == D
    assert rinow.farthest_point_net(space, size=1).covering_radius == math.inf
    net = rinow.farthest_point_net(space, size=2)
    assert (net.indices.tolist(), net.covering_radius) == ([0, 2], 1)


def test_a_mesh_gives_the_net_of_its_geodesic_distances():
    torus = irregular_torus(300)
    mesh = torus.vertices, torus.faces
    expected = rinow.farthest_point_net(rinow.geodesic_space(mesh), size=20, start=7)
    actual = rinow.farthest_point_net(mesh, size=20, start=7)
    np.testing.assert_array_equal(actual.indices, expected.indices)
    np.testing.assert_array_equal(actual.labels, expected.labels)
    np.testing.assert_allclose(actual.radii, expected.radii, rtol=1e-12)
    np.testing.assert_allclose(actual.distances, expected.distances, rtol=1e-12, atol=1e-15)
    intrinsic = rinow.farthest_point_net(rinow.TriangleMesh(*mesh).intrinsic(), size=20, start=7)
    np.testing.assert_array_equal(intrinsic.indices, expected.indices)


def test_the_first_radius_of_a_sphere_is_near_half_a_great_circle():
    sphere = icosphere(4)
    net = rinow.farthest_point_net((sphere.vertices, sphere.faces), size=2)
    # the distance of opposite vertices of a polyhedron inscribed with edges h is short by O(h²) = 0.005
    assert net.radii[0] == pytest.approx(math.pi, rel=3e-3)
    assert net.radii[1] == pytest.approx(math.pi / 2, rel=2e-2)


def test_the_surface_radius_bounds_the_distance_inside_the_faces():
    """The centre of an equilateral triangle is side/√3 from its corners: the bound is sharp there."""
    V, F = [[0, 0, 0], [1, 0, 0], [0.5, 3**0.5 / 2, 0]], [[0, 1, 2]]
    assert rinow.farthest_point_net((V, F), size=3).surface_radius == pytest.approx(1 / 3**0.5, rel=1e-12)
    sphere = icosphere(2)
    coarse = rinow.farthest_point_net((sphere.vertices, sphere.faces), size=12)
    W, G = sphere.vertices, sphere.faces
    centres = W[G].mean(axis=1)
    fine = (
        np.concatenate([W, centres]),
        np.concatenate([np.stack([G[:, k], G[:, (k + 1) % 3], len(W) + np.arange(len(G))], axis=1) for k in range(3)]),
    )
    rows = rinow.geodesic_distances(fine, coarse.indices)
    assert coarse.covering_radius <= rows.min(axis=0).max() <= coarse.surface_radius


def test_components_and_vertices_off_the_surface():
    shape = two_components(100)
    V = np.concatenate([shape.vertices, [[0.0, 0, 0], [np.nan, 0, 0]]])
    net = rinow.farthest_point_net((V, shape.faces), size=2)
    assert sorted(net.indices < 100) == [False, True]
    assert net.labels[-2:].tolist() == [-1, -1]
    assert np.isnan(net.distances[-2:]).all()
    assert np.isfinite(net.covering_radius)
    assert rinow.farthest_point_net((V, shape.faces), size=1).covering_radius == math.inf
    assert rinow.is_epsilon_net((V, shape.faces), net.indices, net.covering_radius)
    assert not rinow.is_epsilon_net((V, shape.faces), net.indices[:1], 1e9)


def test_epsilon_nets_are_closed():
    assert rinow.is_epsilon_net(LINE, [4], 4.0)
    assert not rinow.is_epsilon_net(LINE, [4], np.nextafter(4.0, 0.0))


BAD = [
    (lambda: rinow.farthest_point_net(LINE, size=1, start=[0]), "start has shape (1,); give one index."),
    (lambda: rinow.farthest_point_net(LINE), "size and radius are both missing; give"),
    (lambda: rinow.farthest_point_net(LINE, size=0), "size = 0 is outside 1..9, the number of points"),
    (lambda: rinow.farthest_point_net(LINE, size=10), "size = 10 is outside 1..9, the number of points"),
    (lambda: rinow.farthest_point_net(LINE, size=2.5), "size = 2.5 is not a number of points; give a whole number."),
    (lambda: rinow.farthest_point_net(LINE, size="3"), "size has type <U1; give real numbers."),
    (lambda: rinow.farthest_point_net(LINE, radius=-1.0), "radius = -1.0 is not a radius; give"),
    (lambda: rinow.farthest_point_net(LINE, radius=math.nan), "radius = nan is not a radius; give"),
    (lambda: rinow.farthest_point_net(LINE, size=2, start=9), "start = 9 is outside 0..8"),
    (lambda: rinow.is_epsilon_net(LINE, [], 1.0), "indices has shape (0,); give one list of at least one index."),
    (lambda: rinow.is_epsilon_net(LINE, [9], 1.0), "indices[0] = 9 is outside 0..8"),
    (lambda: rinow.is_epsilon_net(LINE, [0], math.nan), "epsilon = nan is not a radius; give"),
    (
        lambda: rinow.farthest_point_net((np.eye(4)[:, :3], [[0, 1, 2]]), size=2, start=3),
        "start = 3 is not on the surface",
    ),
]


@pytest.mark.parametrize(("action", "message"), BAD)
def test_faults_of_arguments_are_named(action, message):
    with pytest.raises(InvalidInputError, match=re.escape(message)):
        action()
