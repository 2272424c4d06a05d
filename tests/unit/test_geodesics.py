"""Exact geodesic distances: closed forms and faulty meshes."""

import numpy as np
import pytest
from scipy.sparse.csgraph import floyd_warshall

import rinow
import shapes
from geodesic_shapes import EXACT, all_distances, grid, wheel


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
