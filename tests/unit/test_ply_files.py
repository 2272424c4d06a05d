"""PLY files by hand: headers of every kind, and every fault with its place."""

import tracemalloc

import numpy as np
import pytest

import rinow
from naive import ply as naive
from rinow.errors import FileFormatError, InvalidInputError, InvalidMeshError
from rinow.io import text_numbers

AXES = [("x", "float"), ("y", "float"), ("z", "float")]
TRIANGLE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
CORNERS = [("vertex_indices", "uchar", "int")]
FORMATS = ["ascii", "binary_little_endian", "binary_big_endian"]


def text(header, body="0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"):
    return f"ply\n{header}end_header\n{body}".encode()


LIST = "property list uchar int vertex_index\n"
XYZ = "property float x\nproperty float y\nproperty float z\n"


def plain(vertex="element vertex 3\n" + XYZ,
          face="element face 1\nproperty list uchar int vertex_index\n", form="format ascii 1.0\n"):  # fmt: skip
    return form + vertex + face


@pytest.fixture
def read(tmp_path):
    def read(content):
        (tmp_path / "a.ply").write_bytes(content)
        return rinow.read_mesh(tmp_path / "a.ply")

    return read


def test_comments_blank_lines_and_words_in_the_header(read):
    header = "comment not yet: end_header\nobj_info any\n\n" + plain() + "comment  é\n"
    assert read(text(header)).n_faces == 1


def test_a_body_that_starts_like_a_line_end(read):
    vertices = np.frombuffer(b"\n\r\n\r" * 9, "<f4").reshape(3, 3).tolist()
    for newline in ("\n", "\r\n", "\r"):
        elements = [("vertex", AXES, vertices), ("face", CORNERS, [[[0, 1, 2]]])]
        np.testing.assert_array_equal(read(naive.encode("binary_little_endian", elements, newline)).vertices, vertices)


def test_a_signalling_nan_is_a_nan(read):
    whole = naive.encode("binary_big_endian", [("vertex", AXES, TRIANGLE), ("face", CORNERS, [[[0, 1, 2]]])])
    start = whole.index(b"end_header\n") + 11
    vertices = read(whole[:start] + b"\x7f\xa0\x00\x00" + whole[start + 4 :]).vertices
    np.testing.assert_array_equal(vertices[0], [np.nan, 0, 0])


def test_text_keeps_all_digits_of_positions(read):
    body = "0.1 0.2 0.30000000000000004\n1 0 0\n0 1 0\n3 0 1 2\n"
    assert read(text(plain(), body)).vertices[0].tolist() == [0.1, 0.2, 0.30000000000000004]


def test_text_is_read_in_blocks(read, monkeypatch):
    monkeypatch.setattr(text_numbers, "_BLOCK", 5)
    body = "12345678 0 0\n\n      \n       \n1 0 0 0 1\n0\n3 0 1 2\n"
    assert read(text(plain(), body)).vertices.tolist() == [[12345678, 0, 0], [1, 0, 0], [0, 1, 0]]
    with pytest.raises(FileFormatError, match="line 16 has 'x'"):  # 9 lines of header
        read(text(plain(), body.replace("2\n", "x\n")))


def test_numbers_too_large_for_their_type_stay_as_they_are(read):
    vertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
    red = read(text(plain(vertex), "0 0 0 1\n1 0 0 300\n0 1 0 nan\n3 0 1 2\n")).vertex_data["red"]
    np.testing.assert_array_equal(red, [1, 300, np.nan])


@pytest.mark.parametrize("form", FORMATS)
def test_faces_may_come_first_and_polygons_are_reported(read, form):
    square = [*TRIANGLE, [1.0, 1.0, 0.0]]
    polygons = [[0, 1, 3, 2], [0, 1], [0, 1, 2]]
    mesh = read(naive.encode(form, [("face", CORNERS, [[p] for p in polygons]), ("vertex", AXES, square)]))
    assert mesh.faces.tolist() == [[0, 1, 3], [0, 3, 2], [0, 1, 2]]
    assert mesh.notes[0].startswith("1 face with more than three corners was split")
    assert mesh.notes[1] == "1 face with fewer than three corners was left out."


@pytest.mark.parametrize("form", FORMATS)
def test_three_columns_are_one_field(read, form):
    extra = [(f"d_{axis}", "double") for axis in "xyz"] + [
        ("n_x", "double"),
        ("n_y", "float"),
        ("n_z", "double"),
        ("nx", "float"),
    ]
    rows = [[*point, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0] for point in TRIANGLE]
    data = read(naive.encode(form, [("vertex", AXES + extra, rows), ("face", CORNERS, [[[0, 1, 2]]])])).vertex_data
    assert set(data) == {"d", "n_x", "n_y", "n_z", "nx"}
    np.testing.assert_array_equal(data["d"], [[1, 2, 3]] * 3)


def test_bytes_after_the_end_are_reported(read):
    elements = [("vertex", AXES, TRIANGLE), ("face", CORNERS, [[[0, 1, 2]]])]
    assert read(naive.encode("binary_big_endian", elements) + b"more").notes == (
        "4 bytes after the last element were left unread.",
    )


FAULTS = {
    "the line 'ply'": b"solid\n",
    "no line 'end_header'": b"ply\nformat ascii 1.0\nelement vertex 3\n",
    "needs one format line": text(plain(form="format binary 1.0\n")),
    "needs one format line ": text(plain(form="")),
    "line 3 of the PLY header, 'element vertex -1'": text(plain("element vertex -1\nproperty float x\n")),
    "line 4 of the PLY header, 'property real x'": text(plain("element vertex 3\nproperty real x\n")),
    "line 3 of the PLY header, 'property float x'": text(plain("property float x\n")),
    "'property list float int vertex_index'": text(
        plain(face="element face 1\nproperty list float int vertex_index\n")
    ),
    "declares the element 'face' twice": text(plain() + "element face 1\nproperty int i\n"),
    "declares the property of vertex 'x' twice": text(plain("element vertex 3\nproperty float x\nproperty float x\n")),
    "declares no element 'vertex'": text(plain("")),
    "no property 'z'": text(
        plain("element vertex 3\nproperty float x\nproperty float y\n"), "0 0\n1 0\n0 1\n3 0 1 2\n"
    ),
    "line 12 has 'zero' where a number belongs": text(
        plain() + "comment a\ncomment b\n", "0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n"
    ),
    "line 12 has '1,5' where a number belongs": text(plain(), "0 0 0\n1 0 0\n0 1,5 0\n3 0 1 2\n"),
    "face 0 names vertex 1.5, which is not an integer": text(plain(), "0 0 0\n1 0 0\n0 1 0\n3 0 1.5 2\n"),
    "face 0 names vertex -1, but": text(plain(), "0 0 0\n1 0 0\n0 1 0\n3 0 -1 2\n"),
    "end inside face 0 of the 1": text(plain(), "0 0 0\n1 0 0\n0 1 0\n3 0 1\n"),
    "end inside face 0 of the 1 ": text(plain(), "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"),
    "end inside face 0 of the 1  ": text(plain(), "0 0 0\n1 0 0\n0 1 0\n2.5 0 1 2\n"),
    "end inside face 1 of the 2": text(
        plain(face="element face 2\n" + LIST), "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2.5 0 1 2\n"
    ),
    "4 numbers are left after the last element": text(plain(), "0 0 0 7\n1 0 0\n0 1 0\n3 0 1 2\n"),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_have_a_place(read, fault):
    with pytest.raises(FileFormatError, match=fault.rstrip()):
        read(FAULTS[fault])


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("counts", [(10**12, 1), (3, 10**12), (10**17, 10**17)])
def test_a_promise_beyond_the_file_takes_no_memory(read, form, counts):
    header = plain(f"element vertex {counts[0]}\n{XYZ}", f"element face {counts[1]}\n{LIST}", f"format {form} 1.0\n")
    tracemalloc.start()
    try:
        with pytest.raises(FileFormatError, match=r"the header promises at least \d+ bytes, but \d+ follow"):
            read(text(header))
        assert tracemalloc.get_traced_memory()[1] < 1 << 20  # the header is read in blocks of 64 kB
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("form", FORMATS[1:])
def test_truncation_inside_polygons_names_the_face(read, form):
    square = [*TRIANGLE, [1.0, 1.0, 0.0]]
    whole = naive.encode(form, [("vertex", AXES, square), ("face", CORNERS, [[[0, 1, 3, 2]], [[0, 1, 2]]])])
    with pytest.raises(FileFormatError, match="end inside face 1 of the 2 that the header promises"):
        read(whole[:-1])


def test_a_length_beyond_the_file(read):
    whole = naive.encode(
        "binary_little_endian", [("vertex", AXES, TRIANGLE), ("face", [("vertex_index", "uint", "int")], [[[0, 1, 2]]])]
    )
    with pytest.raises(FileFormatError, match="end inside face 0"):
        read(whole[:-16] + b"\xff\xff\xff\xff" + whole[-12:])


def test_empty_lists_only_are_no_face(read):
    whole = naive.encode("binary_little_endian", [("vertex", AXES, TRIANGLE), ("face", CORNERS, [[[]], [[]]])])
    with pytest.raises(InvalidMeshError, match="no face"):
        read(whole)


# ------------------------------------------------------------------ writing


def test_the_header_is_what_meshlab_expects(tmp_path):
    mesh = rinow.TriangleMesh(TRIANGLE, [[0, 1, 2]])
    fields = {"gaussian": [1.0, 2, 3], "direction1": np.eye(3), "status": np.zeros(3, np.uint8), "id": np.arange(3)}
    assert rinow.write_mesh(tmp_path / "a.ply", mesh, fields, quality="gaussian") == ()
    header = (tmp_path / "a.ply").read_bytes().split(b"end_header\n")[0].decode("ascii").splitlines()
    assert header == [
        "ply", "format binary_little_endian 1.0", "element vertex 3", "property double x", "property double y",
        "property double z", "property double quality", "property double direction1_x", "property double direction1_y",
        "property double direction1_z", "property uchar status", "property int id", "element face 1",
        "property list uchar int vertex_indices",
    ]  # fmt: skip


def test_what_ply_cannot_carry_is_said(tmp_path):
    fields = {
        "uv": np.zeros((3, 2)),
        "two words": np.zeros(3),
        "big": np.array([0, 1, 2**40]),
        "on": [True, False, True],
    }
    notes = rinow.write_mesh(tmp_path / "a.ply", (TRIANGLE, [[0, 1, 2]]), fields)
    assert [note.split(":")[0] for note in notes] == [
        "PLY has no arrays",
        "PLY has plain names only",
        "PLY has no 64-bit integers",
    ]
    back = rinow.read_mesh(tmp_path / "a.ply").vertex_data
    assert set(back) == {"uv_0", "uv_1", "two_words", "big", "on"}
    assert back["big"].tolist() == [0, 1, 2**40]
    assert back["on"].tolist() == [1, 0, 1]


@pytest.mark.parametrize(
    "fields", [{"x": [1, 2, 3]}, {"a b": [1, 2, 3], "a_b": [1, 2, 3]}, {"d": np.eye(3), "d_x": [1, 2, 3]}]
)
def test_names_that_collide_are_refused(tmp_path, fields):
    with pytest.raises(InvalidInputError, match="two properties would be called"):
        rinow.write_mesh(tmp_path / "a.ply", (TRIANGLE, [[0, 1, 2]]), fields)
    assert not list(tmp_path.iterdir())
