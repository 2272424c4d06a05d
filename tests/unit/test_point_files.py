"""Files of points without faces on the command line: values, outputs, and one sentence for bad input."""

import json

import numpy as np
import pytest

import rinow
import shapes
from rinow.cli.main import main
from rinow.io.point_files import holds_points, read_cloud
from rinow.io.tables import read_points


@pytest.fixture
def cloud(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    points = 2 * shapes.irregular_sphere(300).vertices
    np.savetxt("points.xyz", points, fmt="%.17g")
    np.savetxt("six.csv", np.hstack([points, points]), delimiter=",", header="x,y,z,nx,ny,nz", comments="")
    np.save("points.npy", points)
    np.savez("points.npz", points=points)
    rows = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
    head = "ply\nformat ascii 1.0\nelement vertex 300\nproperty double x\nproperty double y\nproperty double z\n"
    (tmp_path / "points.ply").write_text(head + "end_header\n" + rows)
    return points


@pytest.mark.parametrize("name", ["points.xyz", "six.csv", "points.npy", "points.npz", "points.ply"])
def test_curvature_and_info_of_points(cloud, capsys, name):
    assert main(["curvature", name, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["method"] == "point_cloud" and record["counts"]["points"] == 300
    assert record["percentiles"]["mean"]["50"] == pytest.approx(0.5, rel=1e-6)
    assert any("no faces" in note for note in record["notes"])
    assert main(["info", name]) == 0
    assert "cloud of points" in capsys.readouterr().out


def test_outputs_carry_the_values(cloud, capsys):
    assert main(["curvature", "points.xyz", "-o", "out.ply", "-o", "out.csv", "-o", "out.npz"]) == 0
    assert "point_cloud; points: 300 OK" in capsys.readouterr().out
    expected = rinow.point_cloud_curvature(cloud)
    np.testing.assert_array_equal(read_points("out.ply"), cloud)
    with np.load("out.npz") as arrays:
        np.testing.assert_array_equal(arrays["gaussian"], expected.gaussian)
        np.testing.assert_array_equal(arrays["direction1_x"], expected.direction1[:, 0])
    table = read_points("out.csv")
    np.testing.assert_array_equal(table[:, :4], np.column_stack([cloud, expected.gaussian]))


def test_a_mesh_is_no_cloud(cloud, tmp_path):
    shape = shapes.tetrahedron()
    for name in ("mesh.ply", "mesh.npz"):
        rinow.write_mesh(name, (shape.vertices, shape.faces))
        assert not holds_points(tmp_path / name)
    assert not holds_points(tmp_path / "missing.xyz")
    note = "The rows have 6 numbers; the first three are taken for x, y and z."
    assert read_cloud(tmp_path / "six.csv")[1] == (note,)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["points.xyz", "--method", "lifted"], "--method needs faces, and points.xyz holds points only"),
        (["points.xyz", "--quality", "fast"], "--quality needs faces"),
        (["points.xyz", "--picture", "a.jpg"], "a.jpg"),
        (["points.xyz", "--report", "points.xyz"], "is the input"),
        (["points.xyz", "-o", "out.obj"], "out.obj cannot hold points without faces; choose one of .ply .csv .npz"),
        (["points.ply", "-o", "points.ply"], "points.ply is the input"),
        (["points.xyz", "-o", "a.csv", "-o", "a.csv"], "a.csv is named twice"),
        (["two.csv"], "two.csv has rows of 2 numbers; a point in space has three"),
    ],
)
def test_bad_input_is_one_sentence(cloud, capsys, arguments, message):
    np.savetxt("two.csv", cloud[:, :2], delimiter=",")
    assert main(["curvature", *arguments]) == 1
    err = capsys.readouterr().err
    assert message in err and err.count("\n") == 1


@pytest.mark.parametrize("heading", ["", "x;y;z\n", "x, mm;y, mm;z, mm\n", "# 1, 2; 3\n"])
def test_beside_semicolons_commas_are_decimal_marks(tmp_path, heading):
    path = tmp_path / "p.csv"
    path.write_text(f"{heading}1,5;2,25;3\n-4,5;5;1e-2\n", encoding="utf-8")
    np.testing.assert_array_equal(read_points(path), [[1.5, 2.25, 3], [-4.5, 5, 0.01]])
    path.write_text("# a comment; with both, and rows with commas\n1,2,3\n4,5,6\n", encoding="utf-8")
    np.testing.assert_array_equal(read_points(path), [[1, 2, 3], [4, 5, 6]])


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("heading", ["", "x;y;höhe\n"])
def test_tables_of_spreadsheets_keep_their_first_row(tmp_path, encoding, heading):
    (tmp_path / "p.csv").write_text(f"{heading}1;2;3\n4;5;6\n", encoding=encoding)
    np.testing.assert_array_equal(read_points(tmp_path / "p.csv"), [[1, 2, 3], [4, 5, 6]])


@pytest.mark.parametrize(
    ("heading", "columns"),
    [
        ("index,x,y,z,covering_radius", [1, 2, 3]),  # as rinow net writes it
        ("# a comment\nZ;X;Y;w;v", [1, 2, 0]),
        ('"Gauss","Points:0","Points:1","Points:2","k"', [1, 2, 3]),  # as ParaView does
        ("k\tPoints_0\tPoints_1\tPoints_2\tm", [1, 2, 3]),
        (",x,y,z,a", [1, 2, 3]),  # as pandas does
        ("a,b,c,d,e", [0, 1, 2]),
        ("x,y,z", [0, 1, 2]),  # of other columns than the rows
    ],
)
def test_a_heading_tells_the_coordinates(tmp_path, heading, columns):
    table = np.random.default_rng(4).normal(size=(9, 5))
    mark = next(mark for mark in ";\t," if mark in heading)
    rows = "\n".join(mark.join(map(repr, row)) for row in table.tolist())
    (tmp_path / "p.csv").write_text(f"{heading}\n{rows}\n", encoding="utf-8")
    points, (note,) = read_cloud(tmp_path / "p.csv")
    np.testing.assert_array_equal(points, table[:, columns])
    words = "first three" if columns == [0, 1, 2] else f"columns {', '.join(str(c + 1) for c in columns)}"
    assert note == f"The rows have 5 numbers; the {words} are taken for x, y and z."


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("source,target,weight\n0,1,2.5\n1,2,1\n2,0,1\n", "p.csv holds edges of a graph, no points; rinow graph"),
        (",a,b,c,d\na,0,1,1,1\nb,1,0,1,1\nc,1,1,0,1\nd,1,1,1,0\n", "p.csv holds the distances of 4 points, not their"),
        (",a,b\na,0,1\nb,1,2\n", "line 2 has 'a' where a number belongs"),
    ],
)
@pytest.mark.parametrize("command", ["info", "curvature"])
def test_tables_of_other_things_are_no_points(tmp_path, monkeypatch, capsys, command, content, sentence):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.csv").write_text(content, encoding="utf-8")
    assert main([command, "p.csv"]) == 1
    assert sentence in capsys.readouterr().err
