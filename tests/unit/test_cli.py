"""The command line: outputs, exit codes, and one sentence for every kind of bad input."""

import importlib
import inspect
import io
import json
import os

import numpy as np
import pytest

import rinow
import shapes
from rinow.cli.main import SUMMARIES, main

V = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
F = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
PLY_HEADER = "ply\nformat {}\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
FACES = "element face {}\nproperty list uchar int vertex_indices\nend_header\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rinow.write_mesh("in.ply", rinow.TriangleMesh(V, F))
    return tmp_path


def ascii_ply(vertices, faces):
    return (
        PLY_HEADER.format("ascii 1.0", len(vertices))
        + FACES.format(len(faces))
        + "".join(" ".join(map(str, row)) + "\n" for row in (*vertices, *faces))
    )


def test_demo_writes_a_mesh_a_picture_and_a_page(folder, capsys):
    assert main(["demo"]) == 0
    mesh = rinow.read_mesh("rinow-demo.ply")
    assert mesh.n_vertices == 2930
    assert np.isfinite(mesh.vertex_data["quality"]).all()
    assert (folder / "rinow-demo.png").read_bytes().startswith(b"\x89PNG")
    assert (folder / "rinow-demo.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    out = capsys.readouterr()
    assert "gaussian" in out.out
    assert "1/length²" in out.out
    assert out.err == ""


def test_curvature_at_the_quality_asked_for(folder, capsys):
    torus = shapes.irregular_torus(3000)
    rinow.write_mesh("torus.ply", rinow.TriangleMesh(torus.vertices, torus.faces))
    assert main(["curvature", "torus.ply", "-o", "out.npz", "--quality", "fast"]) == 0
    expected = rinow.surface_curvature(rinow.read_mesh("torus.ply"), quality="fast")
    np.testing.assert_array_equal(rinow.read_mesh("out.npz").vertex_data["gaussian"], expected.gaussian)


def test_progress_is_shown_to_a_terminal_only(folder, capsys, monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    watched = Terminal()
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr("sys.stderr", watched)
    assert main(["curvature", "in.ply"]) == 0
    assert "curvature of 4 vertices" in watched.getvalue()
    assert "100%" in watched.getvalue()
    assert "curvature of 4 vertices" not in capsys.readouterr().out


def test_curvature_writes_every_output_in_order(folder, capsys):
    arguments = ["in.ply", "-o", "out.ply", "-o", "out.npz", "--picture", "out.png", "--field", "mean", "--unit", "mm"]
    assert main(["curvature", *arguments, "--json"]) == 0
    out = capsys.readouterr()
    record = json.loads(out.out)
    assert out.err == ""
    assert record["counts"]["vertices"] == 4
    assert record["counts"]["euler_characteristic"] == 2
    assert record["units"]["gaussian"] == "1/mm²"
    assert record["outputs"] == ["out.ply", "out.npz", "out.png"]
    assert set(record["percentiles"]["gaussian"]) == {str(p) for p in record["percentile_levels"]}
    assert set(record["seconds"]) >= {"curvature", "writing"}
    expected = rinow.surface_curvature((V, F))
    for name in ("out.ply", "out.npz"):
        mesh = rinow.read_mesh(name)
        np.testing.assert_array_equal(mesh.vertices, V)
        np.testing.assert_array_equal(mesh.faces, F)
        np.testing.assert_array_equal(mesh.vertex_data["gaussian"], expected.gaussian)
        np.testing.assert_array_equal(mesh.vertex_data["status"], expected.status)
    np.testing.assert_array_equal(rinow.read_mesh("out.ply").vertex_data["quality"], expected.mean)
    assert b"1/mm" in (folder / "out.ply").read_bytes()


@pytest.mark.parametrize("method", ["auto", "sectional", "lifted", "intrinsic", "wald", "robinson", "angle_defect"])
def test_every_method_runs(folder, capsys, method):
    assert main(["curvature", "in.ply", "--method", method, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["counts"]["vertices"] == 4


def test_info_counts_edges_and_area(folder, capsys):
    assert main(["info", "in.ply", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["edges"] == 6
    assert record["area"] == pytest.approx(8 * 3**0.5)
    assert main(["info", "in.ply"]) == 0
    assert "euler characteristic" in capsys.readouterr().out


@pytest.mark.parametrize(
    "arguments", [["curvature"], ["nonsense"], ["curvature", "in.ply", "--method", "x"], ["info", "--y"]]
)
def test_wrong_usage_exits_with_2(folder, arguments):
    assert main(arguments) == 2


@pytest.mark.parametrize("name", SUMMARIES)
def test_list_of_commands_says_what_their_docstrings_say(name):
    command = getattr(importlib.import_module(f"rinow.cli.{name}"), name)
    documented = inspect.getdoc(command).partition("\n\nParameters")[0]
    assert documented.split() == SUMMARIES[name].split()


def test_help_and_version_exit_with_0(capsys):
    assert main(["--version"]) == 0
    assert rinow.__version__ in capsys.readouterr().out
    assert main(["--help"]) == 0


BAD_FILES = {
    "missing.ply": None,
    "empty.ply": b"",
    "truncated.ply": PLY_HEADER.format("binary_little_endian 1.0", 4).encode() + FACES.format(4).encode() + b"\0" * 50,
    "huge.ply": PLY_HEADER.format("binary_little_endian 1.0", 10**12).encode() + FACES.format(4).encode() + b"\0" * 50,
    "huge_ascii.ply": PLY_HEADER.format("ascii 1.0", 10**12).encode() + FACES.format(4).encode() + b"0 0 0\n",
    "text.ply": ascii_ply([[0, 0, "zero"], [1, 0, 0], [0, 1, 0]], [[3, 0, 1, 2]]).encode(),
    "range.ply": ascii_ply([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[3, 0, 1, 3]]).encode(),
    "negative.ply": ascii_ply([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[3, 0, -1, 2]]).encode(),
    "points.off": b"OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n",
    "plane.xyz": b"0 0\n",
    "nosuffix": b"0 0 0\n",
    "not.obj": b"\xff\xfe\x00garbage",
    "not.stl": b"solid",
    "not.off": b"OFF\n3 1 0\n0 0 0\n",
    "not.npz": b"PK\x03\x04",
    "not.gii": b"<GIFTI",
    "not.glb": b"glTF",
    "not.vtp": b"<VTKFile",
}


@pytest.mark.parametrize("name", BAD_FILES)
@pytest.mark.parametrize("command", ["curvature", "info"])
def test_a_bad_file_gives_one_sentence_and_nothing_is_written(folder, capfd, name, command):
    if BAD_FILES[name] is not None:
        (folder / name).write_bytes(BAD_FILES[name])
    before = sorted(os.listdir(folder))
    arguments = ["-o", "out.ply", "--picture", "out.png"] if command == "curvature" else []
    assert main([command, name, *arguments]) == 1
    out = capfd.readouterr()
    assert out.err.startswith("rinow: ")
    assert out.err.count("\n") == 1
    assert name in out.err
    assert "Traceback" not in out.err
    assert out.out == ""
    assert sorted(os.listdir(folder)) == before


def test_a_folder_is_not_a_mesh(folder, capsys):
    (folder / "folder.ply").mkdir()
    assert main(["curvature", "folder.ply"]) == 1
    assert "folder" in capsys.readouterr().err


@pytest.mark.parametrize(
    "outputs",
    [
        ["-o", "in.ply"],
        ["-o", "./in.ply"],
        ["--picture", "in.ply"],
        ["-o", "missing_folder/out.ply"],
        ["-o", "out.unknown"],
        ["-o", "out.ply", "-o", "out.ply"],
        ["-o", "folder.ply"],
        ["--picture", "out.jpeg2000"],
    ],
)
def test_a_bad_output_is_refused_before_anything_is_computed(folder, capsys, outputs):
    (folder / "folder.ply").mkdir()
    original = (folder / "in.ply").read_bytes()
    before = sorted(os.listdir(folder))
    assert main(["curvature", "in.ply", "-o", "good.ply", *outputs]) == 1
    assert capsys.readouterr().err.count("\n") == 1
    assert sorted(os.listdir(folder)) == before
    assert (folder / "in.ply").read_bytes() == original


def test_a_quality_without_effect_is_noted(folder, capsys):
    assert main(["curvature", "in.ply", "--method", "wald", "--quality", "fast"]) == 0
    assert "quality 'fast' changes nothing: method 'wald' has only one." in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize("radius", ["0", "-1", "nan", "inf"])
def test_a_bad_radius_is_one_sentence(folder, capsys, radius):
    assert main(["curvature", "in.ply", "--method", "sectional", "--radius", radius]) == 1
    assert "radius" in capsys.readouterr().err


def test_nonfinite_coordinates_are_no_error(folder, capsys):
    vertices = np.vstack([V, [np.nan, 0, 0], [np.inf, 0, 0]])
    rinow.write_mesh("nan.ply", rinow.TriangleMesh(vertices, [*F.tolist(), [0, 1, 4]]))
    assert main(["curvature", "nan.ply", "--method", "angle_defect", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["status"] == {"OK": 4, "NONFINITE": 2}


def test_no_fields_no_colour_in_a_pipe(folder, capsys):
    assert main(["curvature", "in.ply"]) == 0
    assert "\x1b" not in capsys.readouterr().out


def test_quadruple_prints_all_values(capsys):
    r = str(2**0.5)
    assert main(["quadruple", "1", r, "1", "1", r, "1", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert [v["kind"] for v in record["values"]] == ["nonplanar", "planar"]
    assert record["values"][1]["curvature"] == pytest.approx(2.89244794846, rel=1e-11)
    assert np.shape(record["values"][0]["coordinates"]) == (4, 3)
    assert record["robinson"] is None


def test_quadruple_with_a_linear_triple_has_robinsons_certificate(capsys):
    assert main(["quadruple", "1", "2", "2", "1", "1.5", "2", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    robinson = record["robinson"]
    assert robinson["lower"] <= record["values"][0]["curvature"] <= robinson["upper"]
    assert robinson["value"] == pytest.approx(
        -16 / 15
    )  # by hand from 6 (cos a + cos a') / ...; the curvature is -1.334
    assert main(["quadruple", "1", "2", "2", "1", "1.5", "2"]) == 0
    assert "certified" in capsys.readouterr().out


@pytest.mark.parametrize(("distances", "reason"), [("1 1 1 2 2 2", "branch"), ("1 2 3 1 2 1", "on a line")])
def test_quadruple_says_why_there_is_no_value(capsys, distances, reason):
    assert main(["quadruple", *distances.split()]) == 0
    assert reason in capsys.readouterr().out


@pytest.mark.parametrize(
    ("distances", "fault"),
    [("1 5 1 1 1 1", "d13 = 5 exceeds d12 + d23 = 2"), ("1 1 1 1 nan 1", "d24 = nan"), ("1 1 1 1 1 inf", "d34 = inf")],
)
def test_quadruple_names_what_is_not_a_metric(capsys, distances, fault):
    assert main(["quadruple", *distances.split()]) == 1
    assert fault in capsys.readouterr().err


def test_features_writes_fields_and_lists_them(folder, capsys):
    arguments = ["features", "in.ply", "-o", "out.ply", "-o", "out.npz", "--picture", "out.png", "--json"]
    assert main(arguments) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["features"] == {"cone_points": 4, "crease_edges": 6, "corners": 4}
    assert record["outputs"] == ["out.ply", "out.npz", "out.png"]
    expected = rinow.singular_features((V, F))
    assert record["crease_edges"] == expected.crease_edges.tolist()
    for name in ("out.ply", "out.npz"):
        data = rinow.read_mesh(name).vertex_data
        np.testing.assert_array_equal(data["feature"], 2)
        np.testing.assert_allclose(data["cone_angle"], np.pi)
    assert (folder / "out.png").read_bytes().startswith(b"\x89PNG")
    assert main(["features", "in.ply"]) == 0
    assert "crease edges" in capsys.readouterr().out
    assert main(["features", "nothing.ply"]) == 1
