"""GIFTI, FreeSurfer, GLB and VTK files: against the libraries that own the formats."""

import struct
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

import rinow
import shapes
from rinow.errors import FileFormatError, InvalidInputError, InvalidMeshError

V, F, *_ = shapes.tetrahedron()
K = np.array([0.1, np.nan, -0.0, 1e300])


# ------------------------------------------------------------------ GIFTI and FreeSurfer


def test_fsaverage5_is_read_whole(tmp_path):
    nilearn = find_spec("nilearn")
    if nilearn is None or nilearn.origin is None:
        pytest.skip("nilearn carries the surface")
    folder = Path(nilearn.origin).parent / "datasets" / "data" / "fsaverage5"
    mesh = rinow.read_mesh(folder / "white_left.gii.gz")
    assert (mesh.n_vertices, mesh.n_faces, mesh.euler_characteristic) == (10242, 20480, 2)
    with pytest.raises(FileFormatError, match="holds no surface"):
        rinow.read_mesh(folder / "curv_left.gii.gz")


def test_companions_belong_to_their_surface_only(tmp_path):
    rinow.write_mesh(tmp_path / "a.surf.gii", (V, F), {"two words": K})
    rinow.write_mesh(tmp_path / "a.b.surf.gii", (V[:3], F[:1] * 0 + [0, 1, 2]), {"k": K[:3]})
    notes = rinow.write_mesh(tmp_path / "a.surf.gii", (V, F), {"direction": V})
    assert "a.direction.shape.gii" in notes[1]
    mesh = rinow.read_mesh(tmp_path / "a.surf.gii")
    assert set(mesh.vertex_data) == {"two words", "direction"}
    assert mesh.notes == ()
    assert set(rinow.read_mesh(tmp_path / "a.b.surf.gii").vertex_data) == {"k"}


def test_a_companion_of_another_surface_is_left_out_and_a_damaged_one_named(tmp_path):
    rinow.write_mesh(tmp_path / "b.surf.gii", (V[:3], [[0, 1, 2]]), {"k": K[:3]})
    rinow.write_mesh(tmp_path / "a.surf.gii", (V, F))
    (tmp_path / "b.k.shape.gii").rename(tmp_path / "a.other.shape.gii")
    mesh = rinow.read_mesh(tmp_path / "a.surf.gii")
    assert not mesh.vertex_data
    assert mesh.notes == ("a.other.shape.gii has 3 values for 4 vertices and was left out.",)
    (tmp_path / "a.other.shape.gii").write_text("<GIFTI")
    with pytest.raises(FileFormatError, match=r"a\.other\.shape\.gii is no intact GIFTI file"):
        rinow.read_mesh(tmp_path / "a.surf.gii")


def test_companions_of_others_are_named_by_their_file(tmp_path):
    from nibabel.gifti.gifti import GiftiDataArray, GiftiImage

    rinow.write_mesh(tmp_path / "a.surf.gii", (V, F))
    array = GiftiDataArray(np.arange(4, dtype=np.float32), intent="NIFTI_INTENT_SHAPE", datatype="NIFTI_TYPE_FLOAT32")
    GiftiImage(darrays=[array]).to_filename(tmp_path / "a.sulc.shape.gii")
    assert rinow.read_mesh(tmp_path / "a.surf.gii").vertex_data["sulc"].tolist() == [0, 1, 2, 3]


def test_the_command_line_writes_gifti_that_every_reader_takes(tmp_path):
    """Connectome Workbench reads no double precision, and asks for the hemisphere."""
    import nibabel

    from rinow.cli.main import main

    points = np.array([[0.1, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    rinow.write_mesh(tmp_path / "in.ply", (points, F))
    assert main(["curvature", str(tmp_path / "in.ply"), "-o", str(tmp_path / "lh.pial.surf.gii")]) == 0
    files = sorted(tmp_path.glob("*.gii"))
    assert len(files) > 4
    for file in files:
        image = nibabel.load(file)
        assert image.meta["AnatomicalStructurePrimary"] == "CortexLeft"
        assert {array.data.dtype.str[1:] for array in image.darrays} <= {"u1", "i4", "f4"}
    back = rinow.read_mesh(tmp_path / "lh.pial.surf.gii")
    np.testing.assert_array_equal(back.vertices, points.astype(np.float32))
    np.testing.assert_array_equal(back.faces, F)


@pytest.mark.parametrize(
    ("name", "side"),
    [
        ("100307.L.white.surf.gii", "CortexLeft"),
        ("sub-01_hemi-R_pial.surf.gii", "CortexRight"),
        ("rh.gii", "CortexRight"),
        ("L.R.gii", None),
        ("Lisa.gii", None),
    ],
)
def test_the_name_tells_the_hemisphere(tmp_path, name, side):
    import nibabel

    rinow.write_mesh(tmp_path / name, (V, F))
    image = nibabel.load(tmp_path / name)
    assert image.meta.get("AnatomicalStructurePrimary") == side
    assert image.darrays[0].meta.get("AnatomicalStructurePrimary") == side


def test_positions_of_single_precision_stay_so_in_gifti(tmp_path):
    import nibabel

    for points, kind in ((V, np.float32), (V + 1e-9, np.float64)):
        notes = rinow.write_mesh(tmp_path / "a.gii", (points, F))
        assert nibabel.load(tmp_path / "a.gii").darrays[0].data.dtype == kind
        assert ("double" in notes[0]) == (kind == np.float64)
        np.testing.assert_array_equal(rinow.read_mesh(tmp_path / "a.gii").vertices, points)


def test_freesurfer_reads_a_field_as_curv(tmp_path):
    from nibabel.freesurfer.io import read_morph_data

    fields = {"gaussian": K, "mean": -K, "direction": V}
    for name, field in (("lh.curv", "gaussian"), ("lh.white.mean.curv", "mean"), ("rh.MEAN.curv", "gaussian")):
        notes = rinow.write_mesh(tmp_path / name, (V, F), fields, units={"mean": "H in 1/mm"}, quality="gaussian")
        with np.errstate(over="ignore"):
            np.testing.assert_array_equal(read_morph_data(tmp_path / name), fields[field].astype(np.float32))
        meaning = "H in 1/mm" if field == "mean" else "gaussian"
        assert notes == (f"{name} holds one field, in single precision: {meaning}.",)
    rinow.write_mesh(tmp_path / "rh.curv", (V, F), {"only": K})
    with pytest.raises(InvalidInputError, match="one number per vertex; name one of gaussian, mean"):
        rinow.write_mesh(tmp_path / "a.curv", (V, F), fields)
    with pytest.raises(InvalidInputError, match="one number per vertex"):
        rinow.write_mesh(tmp_path / "a.direction.curv", (V, F), fields, quality="mean")
    assert not (tmp_path / "a.curv").exists()
    with pytest.raises(FileFormatError, match=r"rh\.curv: a curv file holds a number per vertex and no surface; give"):
        rinow.read_mesh(tmp_path / "rh.curv")


def test_fields_with_one_file_name_are_refused(tmp_path):
    with pytest.raises(InvalidInputError, match="make the same file name"):
        rinow.write_mesh(tmp_path / "a.surf.gii", (V, F), {"a b": K, "a_b": K})
    assert not list(tmp_path.iterdir())


def test_freesurfer_is_known_by_its_first_bytes(tmp_path):
    notes = rinow.write_mesh(tmp_path / "lh.white", (V, F), {"k": K})
    (tmp_path / "lh.white").rename(tmp_path / "rh.any_name")
    np.testing.assert_array_equal(rinow.read_mesh(tmp_path / "rh.any_name").faces, F)
    assert "single precision" in notes[1]


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        (
            b"\xff\xff\xfe" + b"a\n\n" + struct.pack(">2i", 10**9, 10**9),
            "promises 1000000000 vertices and 1000000000 faces",
        ),
        (b"\xff\xff\xfe" + b"a\n\n" + struct.pack(">2i", -4, 4), "promises -4 vertices"),
        (b"\xff\xff\xfe" + b"a", "no intact FreeSurfer file"),
        (b"\x00\x00\x01", "does not start like a FreeSurfer surface"),
    ],
)
def test_faults_of_freesurfer_are_named(tmp_path, content, fault):
    (tmp_path / "lh.pial").write_bytes(content)
    with pytest.raises(FileFormatError, match=fault):
        rinow.read_mesh(tmp_path / "lh.pial")


def test_quadrilaterals_of_freesurfer(tmp_path):
    def three(n):
        return n.to_bytes(3, "big")

    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    data = b"\xff\xff\xff" + three(4) + three(1) + b"".join(struct.pack(">3h", *(100 * x for x in p)) for p in points)
    (tmp_path / "lh.orig").write_bytes(data + b"".join(map(three, range(4))))
    mesh = rinow.read_mesh(tmp_path / "lh.orig")
    assert mesh.vertices.tolist() == [list(p) for p in points]
    assert mesh.face_areas.sum() == 1
    assert mesh.notes == ("quadrilaterals were split into triangles.",)


# ------------------------------------------------------------------ GLB


def test_a_scene_is_joined_in_the_order_of_its_parts(tmp_path):
    import trimesh

    scene, shift = trimesh.Scene(), np.eye(4)
    shift[0, 3] = 8
    part = trimesh.Trimesh(V, F, process=False)
    scene.add_geometry(part, geom_name="first", node_name="b")
    scene.add_geometry(part, geom_name="second", node_name="a", transform=shift)
    scene.add_geometry(trimesh.PointCloud(V))
    (tmp_path / "a.glb").write_bytes(scene.export(file_type="glb"))
    mesh = rinow.read_mesh(tmp_path / "a.glb")
    np.testing.assert_array_equal(mesh.vertices, np.concatenate([V, V + np.array([8, 0, 0])]))
    np.testing.assert_array_equal(mesh.faces, np.concatenate([F, F + 4]))
    assert "2 parts of the scene were joined" in mesh.notes[0]
    assert mesh.notes[1] == "1 part of the scene without triangles was left out."


# ------------------------------------------------------------------ VTK


@pytest.fixture
def polydata():
    pyvista = pytest.importorskip("pyvista")
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0.1]])
    data = pyvista.PolyData(
        points, faces=np.array([4, 0, 1, 2, 3, 3, 0, 1, 4]), lines=np.array([2, 0, 1]), strips=np.array([4, 0, 1, 4, 2])
    )
    data.point_data["two words"] = np.array([0.1, np.nan, 3, 4, 5])
    data.point_data["rgb"] = np.arange(15, dtype=np.uint8).reshape(5, 3)
    data.point_data["uv"] = np.arange(10.0).reshape(5, 2)
    data.point_data["on"] = np.arange(5) > 2
    data.point_data["names"] = ["a", "b c", "%", "d", ""]
    data.point_data["vector"] = points.astype(np.float32)
    data.cell_data["cell"] = np.arange(4)
    data.point_data.active_scalars_name, data.point_data.active_vectors_name = "two words", "vector"
    data.field_data["note"] = ["one {", "two\nlines"]
    return data


@pytest.mark.parametrize("version", [42, 51])
@pytest.mark.parametrize("binary", [False, True])
def test_legacy_files_are_read_as_vtk_writes_them(tmp_path, polydata, version, binary):
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter

    writer = vtkPolyDataWriter()
    writer.SetFileName(str(tmp_path / "a.vtk"))
    writer.SetFileVersion(version)
    writer.SetInputData(polydata)
    writer.SetFileType(2 if binary else 1)
    writer.Write()
    check_polydata(rinow.read_mesh(tmp_path / "a.vtk"), polydata)


@pytest.mark.parametrize("binary", [False, True])
def test_xml_files_are_read_as_vtk_writes_them(tmp_path, polydata, binary):
    polydata.save(tmp_path / "a.vtp", binary=binary)
    check_polydata(rinow.read_mesh(tmp_path / "a.vtp"), polydata)


def check_polydata(mesh, polydata):
    np.testing.assert_array_equal(mesh.vertices, polydata.points)
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 4], [0, 1, 4], [2, 4, 1]]
    assert "split" in mesh.notes[0]
    assert "2 triangles were taken from triangle strips" in mesh.notes[1]
    assert set(mesh.vertex_data) == {"two words", "rgb", "uv", "on", "vector"}
    for name, values in mesh.vertex_data.items():
        np.testing.assert_array_equal(values, polydata.point_data[name])
        assert values.dtype.kind == polydata.point_data[name].dtype.kind or name == "on"


def test_legacy_sections_by_hand(tmp_path):
    text = """# vtk DataFile Version 2.0
by hand
ASCII
DATASET POLYDATA
POINTS 3 float
0 0 0
1 0 0 0 1 0
METADATA
INFORMATION 1
NAME a LOCATION b

POLYGONS 1 4
3 0 1 2
POINT_DATA 3
COLOR_SCALARS rgb 3
0 0 0 1 1 1 .5 .5 .5
SCALARS k int 1
LOOKUP_TABLE mine
4 5 6
LOOKUP_TABLE mine 1
0 0 0 1
NORMALS n float
0 0 1 0 0 1 0 0 1
TEXTURE_COORDINATES uv 2 float
0 0 1 0 0 1
"""
    (tmp_path / "a.vtk").write_text(text)
    data = rinow.read_mesh(tmp_path / "a.vtk").vertex_data
    assert {name: values.shape for name, values in data.items()} == {
        "rgb": (3, 3),
        "k": (3,),
        "n": (3, 3),
        "uv": (3, 2),
    }
    assert data["k"].tolist() == [4, 5, 6]
    for old, new, fault in (
        ("POLYDATA", "UNSTRUCTURED_GRID", "holds DATASET UNSTRUCTURED_GRID; extract its surface"),
        ("ASCII", "NEITHER", "does not start like a legacy VTK file"),
        ("3 0 1 2", "3 0 1 3", "face 0 names vertex 3"),
        ("3 0 1 2", "9 0 1 2", "end inside cell 0 of the 1"),
        ("NORMALS", "NONSENSE", "has no meaning"),
        ("LOOKUP_TABLE mine\n4", "4", "has no meaning"),
        ("int 1", "bytes 1", "numbers of type bytes are unknown"),
        ("0 0 1 0 0 1 0 0 1", "0 0 1 0 0 one 0 0 1", "'one' where a number belongs"),
        ("\n0 0 1 0 0 1\n", "\n0 0 1\n", "an array of 6 numbers has 3"),
        ("POINTS 3 float", "POINTS 1000000000000 float", "ends before 3000000000000 promised bytes"),
        ("POINTS 3 float", "POINTS -3 float", "-9 numbers of type float are unknown"),
    ):
        (tmp_path / "a.vtk").write_text(text.replace(old, new))
        with pytest.raises(FileFormatError, match=fault):
            rinow.read_mesh(tmp_path / "a.vtk")


def test_a_damaged_xml_file_is_one_error_and_vtk_is_silent(tmp_path, capfd, caplog):
    pytest.importorskip("pyvista")
    rinow.write_mesh(tmp_path / "a.vtp", (V, F), {"k": K})
    whole = (tmp_path / "a.vtp").read_bytes()
    for size in range(1, len(whole) - 10, 97):
        (tmp_path / "a.vtp").write_bytes(whole[:size])
        with pytest.raises(FileFormatError, match="VTK says"):
            rinow.read_mesh(tmp_path / "a.vtp")
    assert capfd.readouterr() == ("", "")
    assert not caplog.records


def test_other_xml_data_are_named(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    pyvista.PolyData(V).save(tmp_path / "points.vtp")
    with pytest.raises(InvalidMeshError, match="no face"):
        rinow.read_mesh(tmp_path / "points.vtp")
    pyvista.PolyData(V).cast_to_unstructured_grid().save(tmp_path / "grid.vtu")
    (tmp_path / "grid.vtu").rename(tmp_path / "grid.vtp")
    with pytest.raises(FileFormatError, match="no PolyData"):
        rinow.read_mesh(tmp_path / "grid.vtp")
