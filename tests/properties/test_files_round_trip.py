"""What is written is read again, bit for bit; what is damaged is a `RinowError` and nothing else."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hn

import rinow
from rinow.io.fields import VTK_NAMES

FIELD_FORMATS = ["a.ply", "a.npz", "a.vtp", "a.vtk", "a.surf.gii", "a.gii.gz"]
TYPES = ["f8", "f4", "i4", "u1"]
NAMES = st.sampled_from(
    ["gaussian", "mean", "k1", "quality", "status", "nx", "height", "direction1", "κ", "a-b", "file"]
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("files")


@st.composite
def meshes(draw, elements=None):
    """Positions of any kind, nan and inf included, and any faces."""
    n = draw(st.integers(3, 7))
    V = draw(hn.arrays(np.float64, (n, 3), elements=elements))
    F = draw(hn.arrays(np.int64, st.tuples(st.integers(1, 6), st.just(3)), elements=st.integers(0, n - 1)))
    return V, F


@st.composite
def meshes_with_fields(draw):
    V, F = draw(meshes())
    names = draw(st.lists(NAMES, unique=True, max_size=4))
    shapes = st.sampled_from([(len(V),), (len(V), 3)])
    return V, F, {name: draw(hn.arrays(draw(st.sampled_from(TYPES)), draw(shapes))) for name in names}


def assert_same(actual, expected):
    """Equal values, the sign of zero included, and equal type."""
    assert actual.dtype == expected.dtype
    np.testing.assert_array_equal(actual, expected)
    np.testing.assert_array_equal(np.signbit(actual[actual == 0]), np.signbit(expected[expected == 0]))


@pytest.mark.parametrize("name", FIELD_FORMATS)
@given(mesh=meshes_with_fields())
@settings(max_examples=40)
def test_positions_and_fields_survive(folder, name, mesh):
    V, F, fields = mesh
    for old in folder.glob("a.*"):
        old.unlink()
    rinow.write_mesh(folder / name, (V, F), fields)
    back = rinow.read_mesh(folder / name)
    assert_same(back.vertices, V)
    np.testing.assert_array_equal(back.faces, F)
    names = VTK_NAMES if name in ("a.vtp", "a.vtk") else {"κ": "_"} if name == "a.ply" else {}
    assert set(back.vertex_data) == {names.get(field, field) for field in fields}
    for field, values in fields.items():
        assert_same(back.vertex_data[names.get(field, field)], values)


@pytest.mark.parametrize("name", ["b.obj", "b.off"])
@given(mesh=meshes())
@settings(max_examples=40)
def test_geometry_survives_in_text(folder, name, mesh):
    rinow.write_mesh(folder / name, mesh)
    back = rinow.read_mesh(folder / name)
    assert_same(back.vertices, mesh[0])
    np.testing.assert_array_equal(back.faces, mesh[1])


@given(mesh=meshes(st.floats(allow_nan=False, allow_infinity=False)))
@settings(max_examples=40)
def test_geometry_survives_in_3mf(folder, mesh):
    rinow.write_mesh(folder / "c.3mf", mesh)
    back = rinow.read_mesh(folder / "c.3mf")
    assert_same(back.vertices, mesh[0])
    np.testing.assert_array_equal(back.faces, mesh[1])


@pytest.mark.parametrize("name", ["c.glb", "lh.white"])
@given(mesh=meshes(st.floats(width=32, allow_nan=False, allow_infinity=False)))
@settings(max_examples=40)
def test_geometry_survives_in_single_precision(folder, name, mesh):
    rinow.write_mesh(folder / name, mesh)
    back = rinow.read_mesh(folder / name)
    np.testing.assert_array_equal(back.vertices, mesh[0])
    np.testing.assert_array_equal(back.faces, mesh[1])


@given(mesh=meshes(st.floats(-1e3, 1e3, width=32)))
def test_triangles_survive_in_stl(folder, mesh):
    V, F = mesh
    rinow.write_mesh(folder / "d.stl", mesh)
    back = rinow.read_mesh(folder / "d.stl")
    used = V[F].reshape(-1, 3)
    # Corners move to the first of their chain of near points: each of at most 18 links is 1e-5 of the diagonal.
    diagonal = np.linalg.norm(used.max(axis=0) - used.min(axis=0))
    np.testing.assert_allclose(back.vertices[back.faces].reshape(-1, 3), used, rtol=0, atol=18e-5 * diagonal)


SOURCES = [
    "e.ply",
    "text.ply",
    "e.obj",
    "e.off",
    "e.stl",
    "text.stl",
    "e.npz",
    "e.surf.gii",
    "e.glb",
    "e.3mf",
    "lh.pial",
    "e.vtk",
]
TEXT = {
    "text.ply": b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty int z\n"
    b"element face 2\nproperty list uchar int vertex_index\nend_header\n"
    b"0 0 0\n1 0 0\n1 nan 0\n0 1 0\n4 0 1 2 3\n3 0 1 2\n",
    "text.stl": b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
    b"endsolid\n",
    "e.obj": b"v 0 0 0\nv 1 0 0\nvt 0 1\nv 0 1 0 # comment\nf 1/1 2/1 3/1\nf -1 -2 \\\n-3\n",
    "e.off": b"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 0.5\n3 0 1 2\n",
}


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    """Whole files of every format."""
    folder = tmp_path_factory.mktemp("whole")
    V, F = np.eye(4, 3), np.array([[0, 1, 2], [3, 2, 1]])
    for name in SOURCES:
        if name in TEXT:
            (folder / name).write_bytes(TEXT[name])
        else:
            rinow.write_mesh(folder / name, (V, F), {"quality": V[:, 0]})
    return {name: (folder / name).read_bytes() for name in SOURCES}


@pytest.mark.parametrize("name", SOURCES)
@given(data=st.data())
@settings(max_examples=60)
def test_a_damaged_file_raises_a_rinow_error_or_is_read(folder, sources, name, data):
    whole = sources[name]
    damaged = bytearray(whole[: data.draw(st.integers(0, len(whole)))] if data.draw(st.booleans()) else whole)
    for _ in range(data.draw(st.integers(0, 3)) if damaged else 0):
        damaged[data.draw(st.integers(0, len(damaged) - 1))] = data.draw(st.integers(0, 255))
    path = folder / name
    path.write_bytes(damaged)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            mesh = rinow.read_mesh(path)
        except rinow.RinowError as error:
            assert str(path) in str(error)
            assert "\n" not in str(error)
        else:
            assert mesh.n_faces > 0


@pytest.mark.parametrize("name", [name for name in SOURCES if not (name in TEXT or name == "e.vtk")])
@given(share=st.floats(0, 1, exclude_max=True))
@settings(max_examples=30)
def test_a_truncated_binary_file_is_always_refused(folder, sources, name, share):
    path = folder / name
    path.write_bytes(sources[name][: int(share * len(sources[name].rstrip()))])
    with pytest.raises(rinow.RinowError):
        rinow.read_mesh(path)
