"""Geodesic distances: balls, polar coordinates, spaces, the edge graph, heat; threads; errors."""

import re
import sys

import numba
import numpy as np
import pytest

import rinow
import shapes
from geodesic_shapes import EXACT, all_distances, grid, wheel
from rinow.errors import InvalidInputError, InvalidMeshError, MissingDependencyError
from rinow.geodesics import batches
from rinow.geodesics.exact import ExactGeodesics


def test_a_radius_for_each_source_and_the_zero_of_the_source():
    V, F = grid(6)
    sources, radii = [0, 24, 30], np.array([0.0, 1.0, 2.5])
    balls = ExactGeodesics((V, F)).distances(sources, max_distance=radii)
    straight = np.linalg.norm(V[sources][:, None] - V, axis=2)
    inside = straight <= radii[:, None]
    np.testing.assert_array_equal(np.diff(balls.indptr), inside.sum(axis=1))
    np.testing.assert_allclose(balls.toarray(), np.where(inside, straight, 0), rtol=EXACT)
    for method in ("exact", "edges"):
        assert rinow.geodesic_distances((V, F), [0], method=method, max_distance=0.0).nnz == 1
    edges = rinow.geodesic_distances((V, F), sources, method="edges", max_distance=radii)
    assert edges.max() <= 2.5 and edges.nnz < balls.nnz


def test_polar_coordinates_in_the_plane_and_on_a_cone():
    V, F = grid(6)
    balls = ExactGeodesics((V, F)).polar([24], max_distance=3.0)
    X = V[balls.vertices] - V[24]
    assert balls.vertices[0] == 24 and np.isnan(balls.directions[0])
    turn = (balls.directions - np.arctan2(X[:, 1], X[:, 0]))[1:]
    np.testing.assert_allclose(np.exp(1j * (turn - turn[0])), 1.0, atol=1e-12)
    np.testing.assert_allclose(balls.total_angles, 2 * np.pi, rtol=EXACT)
    mesh, _, _, _ = wheel(24, 3, 7.0)
    balls = ExactGeodesics(mesh).polar([0], max_distance=2.5)
    steps = np.sort(balls.directions[1:]) * 24 / 7.0
    np.testing.assert_allclose(np.diff(np.unique(np.rint(steps - steps[0]))), 1.0)
    np.testing.assert_allclose(balls.total_angles, 7.0, rtol=1e-12)


def test_same_bits_on_one_and_two_threads():
    V, F, *_ = shapes.noisy(shapes.irregular_torus(300), 0.2)
    threads = numba.get_num_threads()
    try:
        results = []
        for n in (1, min(2, threads)):
            numba.set_num_threads(n)
            g = ExactGeodesics((V, F))
            ball = g.distances(np.arange(len(V)), max_distance=0.5)
            ball.sort_indices()
            results.append((g.distances(np.arange(20)), ball.data, ball.indices))
    finally:
        numba.set_num_threads(threads)
    for one, two in zip(*results, strict=True):
        np.testing.assert_array_equal(one, two)


def test_geodesic_space_is_symmetric_to_the_last_digit():
    V, F, *_ = shapes.irregular_torus(150)
    chosen = [3, 77, 140, 3]
    space = rinow.geodesic_space((V, F), chosen)
    np.testing.assert_array_equal(space.distances, space.distances.T)
    np.testing.assert_allclose(space.distances, all_distances(V, F)[np.ix_(chosen, chosen)], rtol=1e-12)
    assert len(rinow.geodesic_space(shapes.cube()[:2])) == 8


def test_edges_are_longer():
    V, F, *_ = shapes.irregular_sphere(200)
    edges = rinow.geodesic_distances((V, F), [0, 5], method="edges")
    exact = rinow.geodesic_distances((V, F), [0, 5])
    assert (edges >= exact * (1 - EXACT)).all() and (edges < 1.3 * exact + 1e-12).all()


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        ([99], {}, "sources[0] = 99 is outside 0..8; indices count from 0."),
        ([[0, 1]], {}, "sources has shape (1, 2); give one vertex or one list of vertices."),
        ([0], {"max_distance": -1.0}, "max_distance = -1.0 is not a radius; give a number that is not negative."),
        ([0, 1], {"max_distance": [1, np.nan]}, "max_distance[1] = nan is not a radius"),
        ([0], {"max_distance": [1, 2]}, "max_distance has shape (2,); give one radius, or one for each of the 1"),
        ([0], {"method": "fast"}, 'method = \'fast\' is unknown; give "exact", "edges" or "heat".'),
    ],
)
def test_faults_of_arguments_are_named(arguments, options, message):
    with pytest.raises(InvalidInputError, match=re.escape(message)):
        rinow.geodesic_distances(grid(2), arguments, **options)


def test_faults_of_spaces_are_named():
    V, F = grid(1)
    two = np.concatenate([V, V + 5]), np.concatenate([F, F + 4])
    with pytest.raises(InvalidMeshError, match="vertices 0 and 4 have no geodesic distance; give `indices` within one"):
        rinow.geodesic_space(two)
    with pytest.raises(InvalidInputError, match=re.escape("indices has shape (0,); give one list of at least one")):
        rinow.geodesic_space(two, np.empty(0, int))


def test_room_for_windows_grows_and_has_an_end(monkeypatch):
    V, F = shapes.icosphere(2)[:2]
    expected = ExactGeodesics((V, F)).distances([0, 5])
    monkeypatch.setattr(batches, "_ROOM", (16, 0))
    np.testing.assert_array_equal(ExactGeodesics((V, F)).distances([0, 5]), expected)
    monkeypatch.setattr(batches, "_ROOM_AT_MOST", 1)
    with pytest.raises(InvalidMeshError, match="geodesics from vertex 0 branch too often"):
        ExactGeodesics((V, F)).distances([0, 5])
    with pytest.raises(InvalidMeshError, match="branch too often"):
        ExactGeodesics((V, F)).distances([0, 5], max_distance=9.0)


def test_heat_needs_its_package(monkeypatch):
    monkeypatch.setitem(sys.modules, "potpourri3d", None)
    with pytest.raises(MissingDependencyError, match=re.escape("install rinow[heat]")):
        rinow.geodesic_distances(grid(2), [0], method="heat")


def test_heat_is_near_the_exact_distance():
    pytest.importorskip("potpourri3d")
    V, F, *_ = shapes.irregular_sphere(1000)
    heat = rinow.geodesic_distances((V, F), [0], method="heat")
    tiny = rinow.geodesic_distances((np.array(V) * 2.0**-500, F), [0], method="heat")
    np.testing.assert_allclose(tiny * 2.0**500, heat, rtol=1e-9)  # rounding of a division by the size
    assert np.abs(heat - rinow.geodesic_distances((V, F), [0])).max() < 0.1
