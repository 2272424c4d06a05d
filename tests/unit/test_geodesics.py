"""Exact geodesic distances on closed forms and on faulty meshes; the forms of an answer; errors."""

import re
import sys

import numba
import numpy as np
import pytest
from scipy.sparse.csgraph import floyd_warshall

import rinow
import shapes
from rinow.errors import InvalidInputError, InvalidMeshError, MissingDependencyError
from rinow.geodesics import batches
from rinow.geodesics.exact import ExactGeodesics

EXACT = 1e-13  # rounding of some dozens of additions


def all_distances(V, F):
    return rinow.geodesic_distances((V, F), np.arange(len(V)))


def grid(n):
    """Unit squares cut along diagonals; vertex i (n + 1) + j is the point (i, j)."""
    i, j = np.indices((n + 1, n + 1)).reshape(2, -1)
    V = np.stack([i, j, np.zeros_like(i)], axis=1).astype(float)
    a = np.array([i * (n + 1) + j for i in range(n) for j in range(n)])
    return V, np.concatenate([np.stack([a, a + n + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + 1], 1)])


def wheel(n_around, n_rings, angle):
    """A cone of any total angle, by lengths alone; returns the mesh, radii and bearings of its vertices."""
    F = shapes.cone(n_around, n_rings).faces
    number = np.arange(1, 1 + n_around * n_rings)
    radii = np.append(0.0, 1.0 + (number - 1) // n_around)
    steps = np.append(0, (number - 1) % n_around)
    turn = (steps[:, None] - steps) % n_around
    turn = np.minimum(turn, n_around - turn) * angle / n_around
    squares = radii[:, None] ** 2 + radii**2 - 2 * radii[:, None] * radii * np.cos(turn)
    L = np.sqrt(np.maximum(squares[F[:, [1, 2, 0]], F[:, [2, 0, 1]]], 0.0))
    return rinow.IntrinsicMesh(F, L), radii, turn, squares


# ------------------------------------------------------------------ closed forms


def test_cube_has_the_diagonals_of_its_nets():
    D = all_distances(*shapes.cube()[:2])
    # A space diagonal runs over two sides: the diagonal of a 1 by 2 rectangle.
    V = shapes.cube().vertices
    expected = np.sqrt([0, 1, 2, 5])[np.rint(np.abs(V[:, None] - V).sum(axis=2)).astype(int)]
    np.testing.assert_allclose(D, expected, rtol=EXACT)


def test_regular_tetrahedron():
    """Its geodesics are straight in the plane modulo half turns about the lattice of the vertices."""
    e1, e2 = np.array([1.0, 0.0]), np.array([0.5, 3**0.5 / 2])
    V, F, *_ = shapes.tetrahedron()
    V = V / 8**0.5
    for _ in range(2):
        V, F = shapes._split_edges(V, F)
    base = shapes.tetrahedron().vertices / 8**0.5
    plane = np.empty((len(V), 2))
    sides = [((0, 1, 2), [0 * e1, e1, e2]), ((1, 2, 3), [e1, e2, e1 + e2])]
    sides += [((0, 1, 3), [0 * e1, e1, e1 - e2]), ((0, 2, 3), [0 * e1, e2, e2 - e1])]
    for face, places in sides:
        corners = base[list(face)].T
        system, right = np.vstack([corners, np.ones(3)]), np.vstack([V.T, np.ones(len(V))])
        weights = np.linalg.lstsq(system, right, rcond=None)[0]
        on = np.abs(system @ weights - right).max(axis=0) + np.maximum(0, -weights.min(axis=0)) < 1e-12
        plane[on] = weights.T[on] @ np.array(places)
    k, l = np.indices((7, 7)).reshape(2, -1)[:, :, None] - 3
    moves = 2 * (k * e1 + l * e2)
    images = np.concatenate([plane[:, None] + moves, -plane[:, None] + moves], axis=1)
    expected = np.linalg.norm(plane[:, None, None] - images, axis=3).min(axis=2)
    np.testing.assert_allclose(all_distances(V, F), expected, rtol=EXACT, atol=EXACT)


@pytest.mark.parametrize("angle", [1.0, 5.0, 2 * np.pi, 7.0, 12.0])
def test_cone_of_any_angle(angle):
    """Straight in the unrolled cone, or over the apex when the bearings differ by π or more."""
    mesh, radii, turn, squares = wheel(24, 3, angle)
    expected = np.where(turn >= np.pi, radii[:, None] + radii, np.sqrt(np.maximum(squares, 0.0)))
    D = rinow.geodesic_distances(mesh, np.arange(mesh.n_vertices))
    # Lengths alone carry the faces: their rounding moves an apex by some 1e-14 of the height.
    np.testing.assert_allclose(D, expected, rtol=1e-12, atol=1e-12)


def test_flat_sheet_with_a_hole():
    """Shortest paths in the plane around a square hole: straight between vertices that see each other."""
    n, low, high = 7, 2, 5
    V, F = grid(n)
    middle = V[F].mean(axis=1)
    inside = ((middle > low) & (middle < high))[:, :2].all(axis=1)
    F = F[~inside]
    used = np.isin(np.arange(len(V)), F)
    t = np.linspace(0, 1, 1681)[1:-1, None, None, None]  # crossing points are rational with small denominators
    X = V[:, :2]
    line = (1 - t) * X[:, None] + t * X
    blocked = ((line > low + 1e-9) & (line < high - 1e-9)).all(axis=-1).any(axis=0)
    direct = np.where(blocked, np.inf, np.linalg.norm(X[:, None] - X, axis=2))
    expected = floyd_warshall(np.where(used[:, None] & used, direct, np.inf))
    D = all_distances(V, F)[np.ix_(used, used)]
    np.testing.assert_allclose(D, expected[np.ix_(used, used)], rtol=EXACT, atol=EXACT)


@pytest.mark.parametrize("squeeze", [1.0, 0.02, 50.0])
def test_obtuse_and_sliver_faces_are_exact_and_symmetric(squeeze):
    V, F, *_ = shapes.noisy(shapes.irregular_torus(150), 0.3)
    D = all_distances(V * (1, 1, squeeze), F)
    np.testing.assert_allclose(D, D.T, rtol=1e-11)


# ------------------------------------------------------------------ faulty meshes


def test_pages_of_a_book():
    """Four half-planes at a common edge: any two of them unfold to a plane."""
    n = 4
    V, F = grid(n)
    spine = V[:, 0] == 0
    place, faces, page = [np.arange(len(V))], [F], [np.where(spine, -1, 0)]
    total = len(V)
    for k in (1, 2, 3):
        own = np.where(spine, np.arange(len(V)), -1)
        own[~spine] = total + np.arange((~spine).sum())
        total += (~spine).sum()
        place.append(own)
        faces.append(own[F] if k < 3 else own[F][:, ::-1])
        page.append(np.full((~spine).sum(), k))
    page = np.concatenate(page)
    angles = np.array([0.0, 0.5, 2.0, 4.0])
    W = np.empty((total, 3))
    for k, own in enumerate(place):
        W[own] = np.stack([V[:, 0] * np.cos(angles[k]), V[:, 1], V[:, 0] * np.sin(angles[k])], axis=1)
    x, y = np.hypot(W[:, 0], W[:, 2]), W[:, 1]
    x[page < 0] = 0
    apart = page[:, None] != page
    expected = np.hypot(np.where(apart, x[:, None] + x, x[:, None] - x), y[:, None] - y)
    np.testing.assert_allclose(all_distances(W, np.concatenate(faces)), expected, rtol=EXACT, atol=EXACT)


def test_paths_lead_through_the_vertex_of_a_bow_tie():
    D = all_distances(*shapes.bow_tie()[:2])
    np.testing.assert_allclose(D[1, 3:], 8**0.5, rtol=EXACT)
    np.testing.assert_array_equal(D, D.T)


def test_moebius_strip_by_its_double_cover():
    V, F, *_ = shapes.moebius_strip(24, 5)
    n = len(V)
    first = F.copy()
    # Sheets change where the faces join the last column to the first one.
    column = F % 24
    wraps = (column.max(axis=1) - column.min(axis=1)) > 1
    second = F + n
    seam = wraps[:, None] & (column == 0)
    first, second = np.where(seam, F + n, F), np.where(seam, F, second)
    cover = rinow.geodesic_distances((np.concatenate([V, V]), np.concatenate([first, second])), np.arange(n))
    expected = np.minimum(cover[:, :n], cover[:, n:])
    np.testing.assert_allclose(all_distances(V, F), expected, rtol=1e-12, atol=1e-12)


def test_turned_faces_change_nothing():
    V, F, *_ = shapes.open_patch(100)
    turned = np.where((np.arange(len(F)) % 3 == 0)[:, None], F[:, ::-1], F)
    np.testing.assert_allclose(all_distances(V, turned), all_distances(V, F), rtol=EXACT)


def test_components_isolated_and_nonfinite_vertices():
    V, F = grid(2)
    V = np.concatenate([V, V + np.array([9, 0, 0]), [[5, 5, 5], [np.nan, 0, 0]]])
    F = np.concatenate([F, F + 9, [[0, 1, 19]]])
    D = all_distances(V, F)
    assert np.isinf(D[:9, 9:19]).all() and np.isinf(D[18, :18]).all() and D[18, 18] == 0
    assert np.isnan(D[19]).all() and np.isnan(D[:, 19]).all()
    np.testing.assert_allclose(D[:9, :9], np.linalg.norm(V[:9, None] - V[:9], axis=2), rtol=EXACT)
    balls = rinow.geodesic_distances((V, F), [0, 18, 19], max_distance=np.inf)
    assert np.diff(balls.indptr).tolist() == [9, 1, 0]


def test_a_mesh_whose_only_face_takes_no_part():
    np.testing.assert_equal(all_distances([[0, 0, 0], [1, 0, 0], [np.nan, 0, 0]], [[0, 1, 2]])[0], [0, np.inf, np.nan])


def test_zero_area_caps_and_zero_length_edges():
    """A vertex on the diagonal of a square, and a corner given twice."""
    V = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.25, 0.25, 0]]
    caps = np.array(V, float), np.array([[0, 1, 2], [0, 2, 4], [0, 4, 3], [4, 2, 3]])
    expected = np.linalg.norm(caps[0][:, None] - caps[0], axis=2)
    np.testing.assert_allclose(all_distances(*caps), expected, rtol=EXACT, atol=1e-15)
    V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 0]], float)
    D = all_distances(V, [[0, 1, 3], [1, 4, 3], [4, 2, 3]])
    np.testing.assert_allclose(D, np.linalg.norm(V[:, None] - V, axis=2), rtol=EXACT, atol=1e-15)


# ------------------------------------------------------------------ forms of an answer


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


# ------------------------------------------------------------------ errors


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
