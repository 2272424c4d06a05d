"""Reading and writing by suffix: what is refused, what is promised, and files that appear whole or not at all."""

import json
import os
import struct
import sys

import numpy as np
import pytest

import rinow
import shapes
from rinow.errors import FileFormatError, InvalidInputError, InvalidMeshError, MissingDependencyError
from rinow.io import ply
from rinow.io.atomic import replacing
from rinow.io.mesh_files import check_outputs, demo_mesh

V, F, *_ = shapes.tetrahedron()
K = np.array([0.1, np.nan, -0.0, 1e300])
FIELDS = {"gaussian": K, "mean": 2 * K, "status": np.arange(4, dtype=np.uint8)}
UNITS = {"gaussian": "Gaussian curvature K, unit 1/mm², convex positive", "absent": "no such field"}


def test_suffixes_count_in_any_case(tmp_path):
    for name in ("a.PLY", "b.Obj", "c.STL", "d.OFF", "e.Npz", "f.surf.GII", "lh.Pial"):
        rinow.write_mesh(tmp_path / name, (V, F))
        assert rinow.read_mesh(str(tmp_path / name)).n_faces == 4


def test_an_unknown_suffix_names_the_known_ones(tmp_path):
    (tmp_path / "a.xyz").write_text("0 0 0")
    for action in (rinow.read_mesh, lambda path: rinow.write_mesh(path, (V, F))):
        with pytest.raises(FileFormatError, match=r"a\.xyz has no suffix of a known mesh format.*\.ply .*\.gii"):
            action(tmp_path / "a.xyz")


@pytest.mark.parametrize(
    "suffix", [".ply", ".obj", ".stl", ".off", ".glb", ".3mf", ".npz", ".vtp", ".vtk", ".gii", ".white", ".none"]
)
def test_missing_empty_and_folder(tmp_path, suffix):
    missing, empty, folder = (tmp_path / f"{name}{suffix}" for name in ("missing", "empty", "folder"))
    empty.touch()
    folder.mkdir()
    with pytest.raises(FileFormatError, match=r"missing\S*: there is no such file"):
        rinow.read_mesh(missing)
    with pytest.raises(FileFormatError, match=r"empty\S*(: the file is empty| has no suffix)"):
        rinow.read_mesh(empty)
    with pytest.raises(FileFormatError, match=r"folder\S*:? .*is a folder"):
        rinow.read_mesh(folder)


def test_a_pipe_is_no_file(tmp_path):
    os.mkfifo(tmp_path / "pipe.ply")
    with pytest.raises(FileFormatError, match="not a regular file"):
        rinow.read_mesh(tmp_path / "pipe.ply")
    with pytest.raises(FileFormatError, match="not a regular file"):
        rinow.write_mesh(tmp_path / "pipe.ply", (V, F))


def test_memory_that_is_not_there_is_a_file_error(tmp_path, monkeypatch):
    path = tmp_path / "a.ply"
    rinow.write_mesh(path, (V, F))

    def fail(*_):
        raise MemoryError

    monkeypatch.setattr(ply, "read_header", fail)
    with pytest.raises(FileFormatError, match=r"a\.ply needs more memory"):
        rinow.read_mesh(path)


def test_fields_of_the_mesh_are_written_by_default(tmp_path):
    mesh = rinow.TriangleMesh(V, F, {"height": V[:, 2]})
    rinow.write_mesh(tmp_path / "a.ply", mesh)
    assert list(rinow.read_mesh(tmp_path / "a.ply").vertex_data) == ["height"]
    rinow.write_mesh(tmp_path / "a.ply", mesh, {})
    assert not rinow.read_mesh(tmp_path / "a.ply").vertex_data


def test_quality_is_the_chosen_field_in_ply_only(tmp_path):
    for name, expected in (("a.ply", "quality"), ("a.npz", "mean"), ("a.vtp", "Mean_Curvature")):
        rinow.write_mesh(tmp_path / name, (V, F), FIELDS, quality="mean")
        back = rinow.read_mesh(tmp_path / name).vertex_data
        np.testing.assert_array_equal(back[expected], FIELDS["mean"])
        assert back["status"].dtype == np.uint8
    with pytest.raises(InvalidInputError, match="quality = 'k1' is not one of the fields gaussian, mean, status"):
        rinow.write_mesh(tmp_path / "a.ply", (V, F), FIELDS, quality="k1")
    with pytest.raises(InvalidInputError, match="'mean' and 'quality' get the same name"):
        rinow.write_mesh(tmp_path / "a.ply", (V, F), {"quality": K, "mean": K}, quality="mean")


def test_units_are_in_every_file_with_fields(tmp_path):
    for name in ("a.ply", "a.npz", "a.vtp", "a.surf.gii"):
        rinow.write_mesh(tmp_path / name, (V, F), FIELDS, units=UNITS, quality="gaussian")
    header = (tmp_path / "a.ply").read_bytes().split(b"end_header")[0].decode("ascii")
    assert "comment quality = Gaussian curvature K, unit 1/mm^2, convex positive\n" in header
    assert "absent" not in header
    with np.load(tmp_path / "a.npz", allow_pickle=False) as arrays:
        assert json.loads(str(arrays["units"])) == {"gaussian": UNITS["gaussian"]}
    pyvista = pytest.importorskip("pyvista")
    text = pyvista.read(tmp_path / "a.vtp").field_data["rinow_units"][0]
    assert json.loads(text) == {"Gauss_Curvature": UNITS["gaussian"]}
    assert UNITS["gaussian"] in (tmp_path / "a.gaussian.shape.gii").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["a.obj", "a.off", "a.stl", "a.glb", "a.3mf", "lh.white"])
def test_formats_without_fields_say_what_they_left_out(tmp_path, name):
    notes = rinow.write_mesh(tmp_path / name, (V, F), FIELDS)
    assert "geometry only; left out: gaussian, mean, status" in notes[0]
    assert not any("left out" in note for note in rinow.write_mesh(tmp_path / name, (V, F)))


@pytest.mark.parametrize("values", [[1.0, 2.0], 3.0, ["a"] * 4, [1j] * 4, np.zeros((2, 4))])
def test_fields_that_do_not_fit_are_refused(tmp_path, values):
    with pytest.raises(InvalidInputError, match=r"vertex_data\['k'\] has type .* 4 rows"):
        rinow.write_mesh(tmp_path / "a.ply", (V, F), {"k": values})
    with pytest.raises(InvalidInputError, match="give a name"):
        rinow.write_mesh(tmp_path / "a.ply", (V, F), {"": K})
    assert not list(tmp_path.iterdir())


def test_pyvista_is_an_extra(tmp_path, monkeypatch):
    (tmp_path / "a.vtp").write_text("<VTKFile/>")
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(MissingDependencyError, match=r'pip install "rinow\[vtk\]"'):
        rinow.read_mesh(tmp_path / "a.vtp")
    with pytest.raises(MissingDependencyError):
        rinow.write_mesh(tmp_path / "b.vtp", (V, F))


def test_the_demo_mesh_is_spot():
    mesh = demo_mesh()
    assert (mesh.n_vertices, mesh.n_faces, mesh.euler_characteristic) == (2930, 5856, 2)


# ------------------------------------------------------------------ whole or not at all


def test_a_failure_leaves_nothing_behind_and_keeps_the_old_file(tmp_path):
    (tmp_path / "a.txt").write_text("old")
    with pytest.raises(ZeroDivisionError), replacing(tmp_path / "a.txt") as temporary:
        temporary.write_text("half")
        raise ZeroDivisionError
    assert [file.name for file in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "old"


def test_a_failing_writer_leaves_nothing_behind(tmp_path, monkeypatch):
    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(ply, "_write_faces", fail)
    with pytest.raises(FileFormatError, match=r"a\.ply cannot be written: No space left"):
        rinow.write_mesh(tmp_path / "a.ply", (V, F))
    assert not list(tmp_path.iterdir())


def test_gifti_writes_all_companions_or_none(tmp_path):
    (tmp_path / "a.mean.shape.gii").mkdir()
    with pytest.raises(FileFormatError, match="is a folder"):
        rinow.write_mesh(tmp_path / "a.surf.gii", (V, F), FIELDS)
    assert [file.name for file in tmp_path.iterdir()] == ["a.mean.shape.gii"]


def test_a_link_stays_and_its_target_is_replaced(tmp_path):
    (tmp_path / "target.ply").write_text("old")
    (tmp_path / "link.ply").symlink_to(tmp_path / "target.ply")
    rinow.write_mesh(tmp_path / "link.ply", (V, F))
    assert (tmp_path / "link.ply").is_symlink()
    assert rinow.read_mesh(tmp_path / "target.ply").n_faces == 4


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".stl", ".off", ".glb", ".3mf", ".npz", ".vtp", ".gii", ".white"])
def test_unwritable_outputs(tmp_path, suffix):
    (tmp_path / f"folder{suffix}").mkdir()
    with pytest.raises(FileFormatError, match="is a folder"):
        rinow.write_mesh(tmp_path / f"folder{suffix}", (V, F))
    with pytest.raises(FileFormatError, match=r"cannot be written: the folder .* does not exist"):
        rinow.write_mesh(tmp_path / "nowhere" / f"a{suffix}", (V, F))


def test_outputs_are_checked_before_the_work(tmp_path):
    source, other = tmp_path / "in.ply", tmp_path / "out.ply"
    rinow.write_mesh(source, (V, F))
    (tmp_path / "alias.ply").symlink_to(source)
    check_outputs([other, tmp_path / "p.png"], inputs=[source], pictures=[tmp_path / "p.png"])
    for outputs, fault in (
        ([source], "is the input"),
        ([tmp_path / "alias.ply"], "is the input"),
        ([tmp_path / "x" / ".." / "in.ply"], "is the input"),
        ([other, other], "twice"),
        ([tmp_path / "a.doc"], "no suffix"),
        ([tmp_path / "nowhere" / "a.ply"], "does not exist"),
    ):
        with pytest.raises(FileFormatError, match=fault):
            check_outputs(outputs, inputs=[source])
    with pytest.raises(FileFormatError, match=r"\.png"):
        check_outputs([tmp_path / "p.jpg"], pictures=[tmp_path / "p.jpg"])


# ------------------------------------------------------------------ faults that all formats share

HEADER = (
    "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
)
LIST = "element face {}\nproperty list uchar int vertex_indices\nend_header\n"


def bad_index(kind, index):
    """A file of three vertices whose one face names another one (counted from 0)."""
    if kind == "ply":
        return (HEADER.format(3) + LIST.format(1)).encode() + bytes(36) + struct.pack("<B3i", 3, 0, 1, index)
    if kind == "obj":
        return f"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {index + 1 if index >= 0 else index - 2}\n".encode()
    return f"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 {index}\n".encode()


@pytest.mark.parametrize("kind", ["ply", "obj", "off"])
@pytest.mark.parametrize("index", [3, -2, 2**31 - 1])
def test_an_index_out_of_range_is_named(tmp_path, kind, index):
    path = tmp_path / f"a.{kind}"
    path.write_bytes(bad_index(kind, 2))
    np.testing.assert_array_equal(rinow.read_mesh(path).faces, [[0, 1, 2]])
    path.write_bytes(bad_index(kind, index))
    with pytest.raises(FileFormatError, match=r"(face 0|line 4) names vertex -?\d+, but the vertices are [01]\.\.[23]"):
        rinow.read_mesh(path)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.ply", (HEADER.format(3) + LIST.format(0)).encode() + bytes(36)),
        ("b.ply", (HEADER.format(3) + "end_header\n").encode() + bytes(36)),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"),
        ("a.off", b"OFF 3 0 0\n0 0 0\n1 0 0\n0 1 0\n"),
        ("a.stl", b"solid nothing\nendsolid nothing\n"),
        ("b.stl", bytes(84)),
    ],
)
def test_no_face_is_no_mesh(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InvalidMeshError, match=rf"{name}: .*(no face; for a point cloud use point_cloud|no triangle)"):
        rinow.read_mesh(tmp_path / name)


@pytest.mark.parametrize("name", ["a.ply", "a.obj", "a.off", "a.npz", "a.vtp", "a.vtk", "a.surf.gii", "lh.white"])
def test_positions_that_are_not_finite_are_no_error(tmp_path, name):
    W = V.copy()
    W[0, 0], W[1, 1] = np.nan, -np.inf
    rinow.write_mesh(tmp_path / name, (W, F))
    np.testing.assert_array_equal(rinow.read_mesh(tmp_path / name).vertices, W)


def test_glb_cannot_hold_nan(tmp_path):
    with pytest.raises(FileFormatError, match="GLB cannot hold positions that are not finite"):
        rinow.write_mesh(tmp_path / "a.glb", (np.full((3, 3), np.nan), [[0, 1, 2]]))
    assert not list(tmp_path.iterdir())
