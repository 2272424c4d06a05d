"""Any PLY file, written number by number, is read as it was meant."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rinow
from naive import ply as naive

RANGES = {"char": (-128, 127), "uchar": (0, 255), "short": (-(2**15), 2**15 - 1), "ushort": (0, 2**16 - 1),
          "int": (-(2**31), 2**31 - 1), "uint": (0, 2**32 - 1)}  # fmt: skip
DTYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
}


def numbers(kind):
    """Any number that the type holds exactly."""
    return st.integers(*RANGES[kind]) if kind in RANGES else st.floats(width=32 if kind == "float" else 64)


@st.composite
def declarations(draw, prefix, max_size=3):
    """Properties of any type, numbers and lists."""
    kinds = st.one_of(
        st.tuples(st.sampled_from(list(DTYPES))),
        st.tuples(st.sampled_from(list(RANGES)), st.sampled_from(list(DTYPES))),
    )
    return [(f"{prefix}{i}", *types) for i, types in enumerate(draw(st.lists(kinds, max_size=max_size)))]


def values(declaration):
    _, *types = declaration
    return numbers(types[0]) if len(types) == 1 else st.lists(numbers(types[1]), max_size=3)


@st.composite
def files(draw):
    """A file and what it means: vertices, fields, polygons."""
    n = draw(st.integers(3, 6))
    axes = [(axis, draw(st.sampled_from(["float", "double", "short"]))) for axis in "xyz"]
    vertex = draw(st.permutations(axes + draw(declarations("p"))))
    corners = ("vertex_indices", draw(st.sampled_from(list(RANGES))), draw(st.sampled_from(list(RANGES))))
    face = draw(st.permutations([corners, *draw(declarations("q"))]))
    sizes = st.just(3) if draw(st.booleans()) else st.integers(0, 6)
    polygon = sizes.flatmap(lambda k: st.lists(st.integers(0, n - 1), min_size=k, max_size=k))
    polygons = [[0, 1, 2], *draw(st.lists(polygon, max_size=4))]
    rows = [[draw(values(d)) for d in vertex] for _ in range(n)]
    faces = [[polygon if d is corners else draw(values(d)) for d in face] for polygon in polygons]
    other = draw(declarations("r"))
    elements = [("vertex", vertex, rows), ("face", face, faces)]
    others = [("other", other, [[draw(values(d)) for d in other] for _ in range(draw(st.integers(0, 2)))])]
    if other:  # a record without properties would be an empty line of text
        elements = draw(st.permutations(elements + others))
    return elements, vertex, rows, polygons


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("ply")


@given(
    files(),
    st.sampled_from(["ascii", "binary_little_endian", "binary_big_endian"]),
    st.sampled_from(["\n", "\r\n", "\r"]),
)
def test_every_file_is_read_as_meant(folder, file, form, newline):
    elements, vertex, rows, polygons = file
    path = folder / "any.ply"
    path.write_bytes(naive.encode(form, elements, newline))
    mesh = rinow.read_mesh(path)
    columns = {name: [row[i] for row in rows] for i, (name, *types) in enumerate(vertex) if len(types) == 1}
    np.testing.assert_array_equal(mesh.vertices, np.array([columns.pop(axis) for axis in "xyz"], float).T)
    np.testing.assert_array_equal(mesh.faces, naive.fans(polygons))
    assert set(mesh.vertex_data) == set(columns)
    for name, expected in columns.items():
        actual = mesh.vertex_data[name]
        assert actual.dtype == DTYPES[dict((d[0], d[1]) for d in vertex)[name]]
        np.testing.assert_array_equal(actual, np.array(expected, actual.dtype))


@given(st.lists(st.integers(-1, 5), min_size=3, max_size=20))
def test_triangle_strips_agree_with_the_naive_twin(folder, corners):
    path = folder / "strip.ply"
    vertices = [(float(i), float(i * i), 0.0) for i in range(6)]
    axes = [(axis, "float") for axis in "xyz"]
    strips = ("tristrips", [("vertex_indices", "int", "int")], [[corners]])
    path.write_bytes(naive.encode("binary_big_endian", [("vertex", axes, vertices), strips]))
    expected = naive.strip(corners)
    if expected:
        actual = rinow.read_mesh(path).faces
        turned = [min(np.roll(face, k).tolist() for k in range(3)) for face in actual]
        assert turned == [min(list(np.roll(face, k)) for k in range(3)) for face in expected]
    else:
        with pytest.raises(rinow.InvalidMeshError, match="no face"):
            rinow.read_mesh(path)
