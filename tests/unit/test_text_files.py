"""OBJ, OFF and STL files: the order of the vertices, every way to write a face, and faults with their line."""

import re
import struct

import numpy as np
import pytest

import rinow
import shapes
from rinow.errors import FileFormatError
from rinow.io.stl import read_stl

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.fixture
def read(tmp_path):
    def read(name, content):
        (tmp_path / name).write_bytes(content.encode() if isinstance(content, str) else content)
        return rinow.read_mesh(tmp_path / name)

    return read


# ------------------------------------------------------------------ OBJ


@pytest.mark.parametrize(
    "face",
    ["f 1 2 3", "f 1/1 2/1 3/2", "f 1//1 2//1 3//1", "f 1/1/1 2/2/1 3/1/1", "f -4 -3 -2", "\tf  1\t2 3 ",
     "f 1 \\\n 2 3",      "f 1/1/1 2/2/1 3/1/1\r", "f 1 2 3 # comment", "g a b\nusemtl m\ns off\nf 1 2 3"],
)  # fmt: skip
def test_every_way_to_write_a_face(read, face):
    mesh = read("a.obj", f"mtllib missing.mtl\n# c\n{SQUARE}vt 0 0\nvt 1 1\nvn 0 0 1\n{face}\n")
    assert mesh.faces.tolist() == [[0, 1, 2]]
    assert mesh.n_vertices == 4


def test_seams_groups_and_unused_vertices_change_nothing(read):
    """trimesh makes two meshes of this file, with 5 and 4 vertices."""
    text = (
        "v 9 9 9\n"
        + SQUARE
        + "vt 0 0\nvt 1 0\nvt 1 1\no one\nusemtl a\nf 2/1 3/2 4/3\no two\nusemtl b\nf 2/3 4/1 5/2\n"
    )
    mesh = read("a.obj", text)
    assert mesh.vertices[:, 0].tolist() == [9, 0, 1, 1, 0]
    assert mesh.faces.tolist() == [[1, 2, 3], [1, 3, 4]]


def test_negative_indices_count_from_the_face(read):
    mesh = read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -4 -1 2\n")
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 3, 1]]


def test_colours_and_weights_after_the_position_are_left_out(read):
    mesh = read("a.obj", "v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 0 1 2\nf 1 2 3\n")
    assert mesh.vertices[2].tolist() == [0, 1, 2]


def test_polygons_are_fans(read):
    mesh = read("a.obj", SQUARE + "f 1 2 3 4\nl 1 2\nf 1 2\n")
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert "1 face with more than three corners" in mesh.notes[0]
    assert "1 face with fewer than three corners" in mesh.notes[1]


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        (SQUARE + "f 1 2 0\n", "line 5 names vertex 0, but the vertices are 1..4"),
        (SQUARE + "\nf 1 2 3\nf 1 2 5\n", "line 7 names vertex 5, but"),
        (SQUARE + "f 1 2 -5\n", "line 5 names vertex -5, but"),
        ("v 0 0 0\nf 1 -2 1\nv 1 0 0\n", "line 2 names vertex -2, but"),
        (SQUARE + "f 1 2 x\n", "line 5 has 'x' where a number belongs"),
        (SQUARE + "f 1 2.5 3\n", "line 5 names vertex 2.5, but"),
        ("v 0 0 0\nv 0 zero 0\nf 1 1 1\n", "line 2 has 'zero' where a number belongs"),
        ("v 0 0 0\nv 0 0\nf 1 1 1\n", "line 2 has fewer than three coordinates"),
        ("v 0 0 0\nv\nf 1 2 1\n", "line 3 names vertex 2, but"),
    ],
)
def test_obj_faults_have_a_line(read, content, fault):
    with pytest.raises(FileFormatError, match=re.escape(fault)):
        read("a.obj", content)


# ------------------------------------------------------------------ OFF


@pytest.mark.parametrize(
    "head", ["OFF\n4 2 0\n", "OFF 4 2 5\n", "# c\n\nOFF\n# c\n4 2\n", "NOFF\r\n4 2 0\r\n", "STCNOFF\n4 2 0\n"]
)
def test_every_head_of_an_off_file(read, head):
    body = "0 0 0\n\n1 0 0 # c\n1 1 0\n  0 1 0\n4 0 1 2 3 0.1 0.2 0.3\n3 0 1 2 7\n"
    mesh = read("a.off", head + body)
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 2]]
    assert "1 face with more than three corners" in mesh.notes[0]


def test_colours_of_vertices_are_left_out(read):
    mesh = read("a.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n0 1 0 0 0 0 0\n3 0 1 2\n")
    assert mesh.vertices[1].tolist() == [1, 0, 0]


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        ("4OFF\n1 1 0\n", "does not start with 'OFF'"),
        ("OFF BINARY\n1 1 0\n", "does not start with 'OFF'"),
        ("OFF\n-1 1 0\n", "does not start with 'OFF'"),
        ("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "promises 3 vertices and 2 faces, but 4 lines follow"),
        ("OFF\n1000000000000 1 0\n0 0 0\n", "promises 1000000000000 vertices"),
        ("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "the line of vertex 1 (counted from 0) has too few numbers"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "the line of face 0 (counted from 0) has too few numbers"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n1.5 0 1\n", "the line of face 0 (counted from 0) has too few numbers"),
        ("OFF\n3 1 0\n0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", "the line of vertex 1 has 'zero' where a number belongs"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 nan\n", "face 0 names vertex nan, which is not an integer"),
    ],
)
def test_off_faults_have_a_place(read, content, fault):
    with pytest.raises(FileFormatError, match=re.escape(fault)):
        read("a.off", content)


# ------------------------------------------------------------------ STL

FACET = "facet normal 0 0 1\n outer loop\n  vertex {}\n  vertex {}\n  vertex {}\n endloop\nendfacet\n"
TWO_FACETS = FACET.format("0 0 0", "1 0 0", "1 1 0") + FACET.format("0 0 0", "1 1 1e-9", "0 1 0")


def binary_stl(triangles, header=b""):
    data = header.ljust(80, b" ") + struct.pack("<I", len(triangles))
    return data + b"".join(struct.pack("<12fH", 0, 0, 0, *np.ravel(t), 0) for t in triangles)


def test_corners_are_welded_and_reported(tmp_path):
    (tmp_path / "a.stl").write_text(f"solid vertex of a facet\n{TWO_FACETS}endsolid\n")
    mesh, vertex_map = read_stl(tmp_path / "a.stl")
    assert vertex_map.tolist() == [0, 1, 2, 0, 2, 3]
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert mesh.notes[0].startswith("the 6 corners of the STL file were welded into 4 vertices (closer than 1e-05")
    apart, identity = read_stl(tmp_path / "a.stl", rtol=0)
    assert apart.n_vertices == 5
    np.testing.assert_array_equal(apart.vertices[identity][4], [1, 1, 1e-9])


def test_several_solids_are_one_mesh(read):
    text = f"SOLID A\n{TWO_FACETS.upper()}ENDSOLID A\nsolid b\n{FACET.format('5 0 0', '6 0 0', '6 1 0')}endsolid b\n"
    assert read("a.stl", text).n_faces == 3


@pytest.mark.parametrize("header", [b"", b"solid but binary", b"COLOR=\n\r\x1a"])
def test_binary_stl_is_read_and_welded(read, header):
    V, F, *_ = shapes.icosphere(1)
    mesh = read("a.stl", binary_stl(V[F], header))
    # Single precision: half a unit in the last place of numbers up to 1.
    np.testing.assert_allclose(mesh.vertices[mesh.faces], V[F], rtol=0, atol=2.0**-25)
    assert mesh.n_vertices == len(V)
    assert mesh.topology.is_closed


def test_bytes_after_a_binary_stl(read):
    triangle = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
    assert read("a.stl", binary_stl(triangle) + b"more").n_faces == 1
    with pytest.raises(FileFormatError, match="the text has 0 vertex lines"):
        read("a.stl", binary_stl(triangle, b"solid") + b"more")


def test_corners_that_are_not_finite_stay_apart(read):
    mesh = read("a.stl", binary_stl([[[0, 0, 0], [1, 0, 0], [np.nan, 1, 0]], [[0, 0, 0], [1, 0, 0], [np.nan, 1, 0]]]))
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 1, 3]]


def test_normals_are_written(tmp_path):
    rinow.write_mesh(tmp_path / "a.stl", ([[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 1, 0]], [[0, 1, 2], [1, 2, 3]]))
    data = (tmp_path / "a.stl").read_bytes()
    assert struct.unpack("<3f", data[84:96]) == (0, 0, 1)
    assert struct.unpack("<3f", data[134:146]) == (0, 0, 0)


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        (binary_stl(np.zeros((2, 3, 3)))[:-1], "a binary STL file of 2 triangles has 184 bytes, this one 183"),
        (b"\0" * 10, "a binary STL file of 0 triangles has 84 bytes, this one 10"),
        (bytes(80) + b"\xff\xff\xff\xff", "a binary STL file of 4294967295 triangles has 214748364834 bytes"),
        (f"solid\n{TWO_FACETS}", "0 endsolid"),
        (f"solid\n{TWO_FACETS[:-12]}\nendsolid\n", "6 vertex lines, 1 endfacet"),
        (f"solid\n{TWO_FACETS.replace('1 1 0', '1 1')}endsolid\n", "every facet needs three vertices of three numbers"),
        (f"solid\n{TWO_FACETS.replace('1 1 0', '1 one 0')}endsolid\n", "vertex line 2 (counted from 0) has 'one'"),
    ],
)
def test_faults_of_stl_are_named(read, content, fault):
    with pytest.raises(FileFormatError, match=re.escape(fault)):
        read("a.stl", content)
