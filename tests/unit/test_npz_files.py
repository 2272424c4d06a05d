"""NPZ files: archives of numpy, and what is wrong with others."""

import io
import zipfile

import numpy as np
import pytest

import rinow
import shapes
from rinow.errors import FileFormatError, InvalidInputError, InvalidMeshError
from rinow.io.point_files import holds_points
from rinow.io.tables import read_points

V, F, *_ = shapes.tetrahedron()
K = np.array([0.1, np.nan, -0.0, 1e300])


def test_an_archive_of_numpy_is_read(tmp_path):
    quads = np.array([[0, 1, 2, 3]], np.uint16)
    np.savez_compressed(
        tmp_path / "a.npz", V=V.astype(np.float32), F=quads, k=K, m=np.eye(4), cells=np.zeros(7), name="x"
    )
    mesh = rinow.read_mesh(tmp_path / "a.npz")
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert set(mesh.vertex_data) == {"k", "m"}
    assert "split" in mesh.notes[0]
    assert mesh.notes[1] == "arrays of another length were left out: cells, name."


def test_vertices_and_faces_are_names_as_good_as_v_and_f(tmp_path):
    path = tmp_path / "a.npz"
    np.savez(path, vertices=V, faces=F, k=K)
    mesh = rinow.read_mesh(path)
    np.testing.assert_array_equal(mesh.vertices, V)
    np.testing.assert_array_equal(mesh.faces, F)
    assert list(mesh.vertex_data) == ["k"]
    assert not holds_points(path)
    np.savez(path, vertices=V, k=K)
    assert holds_points(path)
    np.testing.assert_array_equal(read_points(path), V)


@pytest.mark.parametrize(
    ("arrays", "fault"),
    [
        ({"V": V}, "holds V but no F"),
        ({"V": V, "F": F.astype(float)}, "and type float64"),
        ({"V": V[0], "F": F}, r"V has shape \(3,\)"),
        ({"V": V[:, :2], "F": F}, r"vertices has shape \(4, 2\)"),
        ({"V": V, "F": F + 1}, "face 1 names vertex 4|face 0 names vertex 4"),
        ({"V": V, "F": F, "k": np.array([None] * 4)}, "k.npy is pickled"),
    ],
)
def test_faults_of_npz_are_named(tmp_path, arrays, fault):
    np.savez(tmp_path / "a.npz", allow_pickle=True, **arrays)
    with pytest.raises(FileFormatError, match=fault):
        rinow.read_mesh(tmp_path / "a.npz")


def test_an_array_larger_than_its_file_takes_no_memory(tmp_path):
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (10**12, 3)})
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("V.npy", header.getvalue() + bytes(100))
    with pytest.raises(FileFormatError, match=r"V\.npy is pickled or not as large as its header says"):
        rinow.read_mesh(tmp_path / "a.npz")


def test_no_faces_in_an_archive_is_no_mesh(tmp_path):
    np.savez(tmp_path / "a.npz", V=V, F=np.empty((0, 3)))
    with pytest.raises(InvalidMeshError, match="no face"):
        rinow.read_mesh(tmp_path / "a.npz")


def test_reserved_names_are_refused(tmp_path):
    with pytest.raises(InvalidInputError, match="'V' has a name that NPZ files reserve"):
        rinow.write_mesh(tmp_path / "a.npz", (V, F), {"V": K})
