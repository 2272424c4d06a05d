"""Meshes as values: checks at the boundary, integrated curvature, degenerate input."""

import numpy as np
import pytest
from hypothesis import given

from naive import topology as naive
from rinow import IntrinsicMesh, InvalidInputError, InvalidMeshError, TriangleMesh
from rinow.kernels import triangles
from rinow.mesh import as_mesh, as_triangle_mesh
from strategies import face_lists, triangle_sides

TETRAHEDRON = (
    np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]),
    np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]),
)
STRIP = (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]), np.array([[0, 1, 2], [1, 3, 2]]))


@given(triangle_sides())
def test_angles_and_area_equal_the_textbook_formulas(sides):
    # The law of cosines loses half the digits near 0 and pi; sides are kept 1 % away from degenerate.
    angles = triangles.triangle_angles(*sides)
    np.testing.assert_allclose(angles, [naive.angle(*np.roll(sides, -k)) for k in range(3)], atol=1e-12)
    np.testing.assert_allclose(triangles.triangle_area(*sides), naive.area(*sides), rtol=1e-12)
    assert sum(angles) == pytest.approx(np.pi, abs=4 * np.finfo(float).eps)


@pytest.mark.parametrize(
    ("sides", "expected"),
    [
        ((0.0, 1.0, 1.0), (0.0, np.pi / 2, np.pi / 2)),
        ((0.0, 0.0, 0.0), (np.pi / 3, np.pi / 3, np.pi / 3)),
        ((2.0, 1.0, 1.0), (np.pi, 0.0, 0.0)),
        ((3e-160, 4e-160, 5e-160), (np.arctan2(3, 4), np.arctan2(4, 3), np.pi / 2)),
        ((3e150, 4e150, 5e150), (np.arctan2(3, 4), np.arctan2(4, 3), np.pi / 2)),
    ],
)
def test_degenerate_and_extreme_triangles(sides, expected):
    np.testing.assert_allclose(triangles.triangle_angles(*sides), expected, atol=1e-15)


def test_needle_keeps_all_digits_of_its_small_angle():
    # Kahan's example: the angle opposite 1e-9 in an isosceles triangle is 2 asin(1e-9 / 2).
    assert triangles.triangle_angle(1e-9, 1.0, 1.0) == pytest.approx(1e-9, rel=1e-15)


@given(face_lists())
def test_gauss_bonnet_holds_on_any_complex(case):
    n, faces = case
    mesh = TriangleMesh(np.random.default_rng(9).normal(size=(n, 3)), faces)
    total = mesh.vertex_angle_defects.sum()
    assert total == pytest.approx(2 * np.pi * naive.euler_characteristic(faces.tolist()), abs=1e-12 * len(faces))


def test_gauss_bonnet_with_degenerate_faces():
    V, F = TETRAHEDRON
    V = V[[0, 0, 2, 3]]  # two corners in one place: two faces are segments
    assert TriangleMesh(V, F).vertex_angle_defects.sum() == pytest.approx(4 * np.pi, abs=1e-14)
    assert TriangleMesh(V[[0, 0, 0, 0]], F).vertex_angle_defects.sum() == pytest.approx(4 * np.pi, abs=1e-14)


@pytest.mark.parametrize("shape", [TETRAHEDRON, STRIP])
def test_defects_equal_the_naive_twin(shape):
    mesh = TriangleMesh(*shape)
    expected = naive.angle_defects(mesh.faces.tolist(), mesh.edge_lengths.tolist(), mesh.n_vertices)
    np.testing.assert_allclose(mesh.vertex_angle_defects, expected, atol=1e-14)
    np.testing.assert_allclose(mesh.vertex_areas.sum(), mesh.face_areas.sum(), rtol=1e-14)


def test_lengths_alone_give_the_same_defects():
    mesh = TriangleMesh(*TETRAHEDRON)
    np.testing.assert_array_equal(mesh.intrinsic().vertex_angle_defects, mesh.vertex_angle_defects)
    np.testing.assert_array_equal(mesh.intrinsic().vertex_areas, mesh.vertex_areas)


def test_counts_of_a_strip():
    mesh = TriangleMesh(*STRIP)
    assert mesh.euler_characteristic == 1
    assert mesh.boundary_vertices.tolist() == [0, 1, 2, 3]
    assert mesh.components.tolist() == [0, 0, 0, 0]
    assert mesh.mean_edge_length == pytest.approx((4 + 2**0.5) / 5)


def test_bow_tie_fin_and_isolated_vertex():
    faces = np.array([[0, 1, 2], [0, 3, 4], [1, 2, 5], [1, 2, 6]])
    t = TriangleMesh(np.random.default_rng(3).normal(size=(8, 3)), faces).topology
    assert t.vertex_is_manifold.tolist() == [False, False, False, True, True, True, True, False]
    assert (~t.edge_is_manifold).sum() == 1
    assert t.components[7] == -1


def test_normals_point_outward_whatever_the_faces_say():
    V, F = TETRAHEDRON
    expected = V / np.sqrt(3)
    one_turned = F.copy()
    one_turned[1] = one_turned[1, ::-1]
    for faces in (F, F[:, ::-1], one_turned):
        np.testing.assert_allclose(TriangleMesh(V, faces).vertex_normals, expected, atol=1e-15)


def test_moebius_strip_is_not_orientable():
    n = 7
    faces = [(i, (i + 1) % n, (i + 2) % n) for i in range(n)]
    mesh = TriangleMesh(np.random.default_rng(4).normal(size=(n, 3)), faces)
    assert not mesh.topology.is_orientable
    assert mesh.euler_characteristic == 0


def test_nonfinite_positions_are_marked_and_the_rest_stands():
    V, F = STRIP
    V = V.copy()
    V[3, 1] = np.nan
    mesh = TriangleMesh(V, F)
    assert mesh.vertex_is_finite.tolist() == [True, True, True, False]
    assert mesh.topology.face_used.tolist() == [True, False]
    np.testing.assert_allclose(mesh.vertex_areas, [1 / 6, 1 / 6, 1 / 6, 0])
    assert mesh.diagonal == pytest.approx(2**0.5)


def test_faces_with_a_repeated_vertex_take_no_part():
    V, F = STRIP
    mesh = TriangleMesh(V, [*F.tolist(), [0, 0, 1]])
    assert mesh.topology.face_used.tolist() == [True, True, False]
    assert mesh.face_is_degenerate.tolist() == [False, False, True]


def test_welding_keeps_order_and_reports_the_map():
    V, F = TETRAHEDRON
    soup = TriangleMesh(
        V[F.ravel()] + 1e-9 * np.random.default_rng(6).normal(size=(12, 3)), np.arange(12).reshape(4, 3)
    )
    assert soup.is_soup
    welded, vertex_map = soup.welded()
    assert welded.n_vertices == 4
    assert welded.topology.is_closed
    np.testing.assert_allclose(welded.vertices[vertex_map], soup.vertices, atol=1e-7)
    assert vertex_map[:3].tolist() == [0, 1, 2]  # first appearance gives the order
    assert not welded.is_soup


def test_the_mesh_does_not_change_with_its_source():
    V, F = (a.copy() for a in TETRAHEDRON)
    mesh = TriangleMesh(V, F, {"f": np.arange(4)})
    V[0], F[0] = 9.0, 3
    np.testing.assert_array_equal(mesh.vertices, TETRAHEDRON[0])
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0] = 1.0
    with pytest.raises(TypeError):
        mesh.vertex_data["f"] = 1


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        (np.zeros((3, 2)), [[0, 1, 2]], r"vertices has shape \(3, 2\)"),
        (np.zeros((0, 3)), [[0, 1, 2]], "vertices is empty"),
        (np.zeros((3, 3)), np.zeros((0, 3), int), "faces is empty"),
        (np.zeros((3, 3)), [[0, 1, 3]], r"faces\[0, 2\] = 3 is outside 0\.\.2"),
        (np.zeros((3, 3)), [[0, 1, 2], [0, -1, 2]], r"faces\[1, 1\] = -1 is outside"),
        (np.zeros((3, 3)), [[0.0, 1.0, 2.0]], "faces has type float64"),
        (np.zeros((4, 3)), [[0, 1, 2, 3]], "split quadrilaterals"),
        (np.zeros((3, 3), complex), [[0, 1, 2]], "complex128"),
        ([["a", "b", "c"]], [[0, 0, 0]], "vertices has type"),
    ],
)
def test_bad_input_names_the_place(vertices, faces, message):
    with pytest.raises(InvalidInputError, match=message):
        TriangleMesh(vertices, faces)


@pytest.mark.parametrize(
    ("lengths", "message"),
    [
        ([[1.0, 1, 1]], "one length per side"),
        ([[1.0, 1, 1], [1, -1, 1]], r"edge_lengths\[1, 1\] = -1 is negative"),
        ([[1.0, 1, 1], [3, 1, 1]], "triangle inequality"),
        ([[1.0, 1, 1], [1, 1.5, 1]], "common edge the lengths 1 and 1.5"),
    ],
)
def test_faults_of_edge_lengths_are_named(lengths, message):
    with pytest.raises(InvalidMeshError, match=message):
        IntrinsicMesh([[0, 1, 2], [1, 3, 2]], lengths)


def test_undefined_lengths_take_their_face_out():
    mesh = IntrinsicMesh([[0, 1, 2], [1, 3, 2]], [[1.0, 1, 1], [np.nan, 1, 1]], n_vertices=5)
    assert mesh.topology.face_used.tolist() == [True, False]
    assert mesh.n_vertices == 5


def test_vertex_data_must_fit():
    with pytest.raises(InvalidInputError, match=r"vertex_data\['x'\]"):
        TriangleMesh(*STRIP, {"x": np.zeros(3)})


def test_objects_with_vertices_and_faces_are_meshes():
    import pyvista
    import trimesh

    V, F = TETRAHEDRON
    for thing in ((V, F), trimesh.Trimesh(V, F, process=False), pyvista.PolyData.from_regular_faces(V, F)):
        mesh = as_mesh(thing)
        np.testing.assert_array_equal(mesh.vertices, V)
        np.testing.assert_array_equal(mesh.faces, F)
    with pytest.raises(InvalidMeshError, match="read_mesh"):
        as_mesh("spot.ply")
    with pytest.raises(InvalidMeshError, match="positions are needed"):
        as_triangle_mesh(TriangleMesh(V, F).intrinsic())
