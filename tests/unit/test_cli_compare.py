"""`rinow compare` and `rinow net`: outputs, exit codes, one sentence for bad input, nothing half-written."""

import json
import os

import numpy as np
import pytest

import rinow
from rinow.cli.main import main
from shapes import cube, icosphere


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    c = cube()
    rinow.write_mesh("a.ply", (c.vertices, c.faces))
    rinow.write_mesh("b.obj", (2 * c.vertices - 0.5, c.faces))
    (tmp_path / "p.csv").write_text("x,y\n0,0\n3,0\n")
    (tmp_path / "q.txt").write_text("# points\n0 1\n0 0\n\n3 4\n")
    np.savez(tmp_path / "d.npz", distances=[[0.0, 1, 3], [1, 0, 2], [3, 2, 0]], other=[1.0])
    np.save(tmp_path / "e.npy", [[0.0, 1], [1, 0]])
    return tmp_path


def run(capfd, *arguments):
    """Exit code, stdout and stderr."""
    code = main(list(arguments))
    out = capfd.readouterr()
    return code, out.out, out.err


def test_surfaces_have_an_interval_and_fields(folder, capfd):
    code, out, err = run(capfd, "compare", "a.ply", "b.obj", "--json", "--unit", "mm", "-o", "a2.ply", "-o", "b.csv")
    assert (code, err) == (0, "")
    record = json.loads(out)
    assert record["lower"] <= 3**0.5 / 2 <= record["upper"]
    assert record["unit"] == "mm"
    assert record["metric"] == "hausdorff"
    assert record["kind"] == "surfaces"
    assert np.shape(record["witness_a"]) == (3,)
    assert record["percentiles_a"]["100"] == pytest.approx(0.5)
    assert record["outputs"] == ["a2.ply", "b.csv"]
    expected = rinow.hausdorff_distance(rinow.read_mesh("a.ply"), rinow.read_mesh("b.obj"))
    np.testing.assert_array_equal(rinow.read_mesh("a2.ply").vertex_data["quality"], expected.distances_a)
    assert b"distance from B, unit mm" in (folder / "a2.ply").read_bytes()
    lines = (folder / "b.csv").read_text().splitlines()
    assert lines[:2] == ["# distance from A, unit mm", "distance"]
    np.testing.assert_array_equal([float(x) for x in lines[2:]], expected.distances_b)


def test_the_table_says_the_interval_in_words(folder, capfd):
    code, out, err = run(capfd, "compare", "a.ply", "b.obj", "--tolerance", "1e-6")
    assert (code, err) == (0, "")
    assert "<= distance <=" in out
    assert "length" in out
    assert "\x1b" not in out


def test_points_have_a_distance_and_witnesses(folder, capfd):
    code, out, _ = run(capfd, "compare", "p.csv", "q.txt", "--points", "--json", "-o", "p.npz")
    record = json.loads(out)
    assert code == 0
    assert record["lower"] == record["upper"] == 4.0
    assert (record["witness_a"], record["witness_b"]) == (1, 2)
    with np.load("p.npz") as archive:
        assert archive["distance"].tolist() == [0.0, 3.0]
        assert "unit length" in str(archive["units"])
    code, out, _ = run(capfd, "compare", "a.ply", "b.obj", "--points", "--json")
    assert json.loads(out)["upper"] == pytest.approx(3**0.5 / 2, rel=1e-15)


def test_a_point_cloud_needs_no_faces(folder, capfd):
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    (folder / "cloud.ply").write_text(f"ply\nformat ascii 1.0\nelement vertex 2\n{axes}end_header\n0 0 0\n0 0 2\n")
    code, out, _ = run(capfd, "compare", "cloud.ply", "a.ply", "--points", "--json")
    assert code == 0
    assert json.loads(out)["directed_a"] == [1.0, 1.0]


def test_surfaces_as_metric_spaces(folder, capfd):
    code, out, _ = run(capfd, "compare", "a.ply", "a.ply", "--metric", "gromov-hausdorff", "--json")
    record = json.loads(out)
    assert code == 0
    assert record["lower"] == record["upper"] == 0.0
    assert record["notes"] == ["distances on the surfaces are lengths of shortest paths along edges."]


def test_distance_matrices_have_an_exact_distance_and_pairs(folder, capfd):
    code, out, err = run(capfd, "compare", "d.npz", "e.npy", "--distances", "--json", "-o", "pairs.csv")
    assert (code, err) == (0, "")
    record = json.loads(out)
    X, Y = rinow.MetricSpace([[0, 1, 3], [1, 0, 2], [3, 2, 0]]), rinow.MetricSpace([[0, 1], [1, 0]])
    assert record["metric"] == "gromov-hausdorff"
    assert record["exact"]
    assert record["upper"] == rinow.gromov_hausdorff(X, Y).upper == 0.5 * rinow.distortion(record["pairs"], X, Y) == 1.0
    rows = (folder / "pairs.csv").read_text().splitlines()
    assert rows[1] == "a,b"
    assert [[int(x) for x in row.split(",")] for row in rows[2:]] == record["pairs"]
    code, out, _ = run(capfd, "compare", "d.npz", "e.npy", "--distances", "--metric", "lipschitz", "--json")
    assert code == 0
    assert json.loads(out)["upper"] is None  # infinite: the sizes differ
    code, out, _ = run(capfd, "compare", "p.csv", "p.csv", "--points", "--metric", "lipschitz")
    assert code == 0
    assert "0 <= distance <= 0;" in out


def test_verify_has_the_proof_of_a_solver_checked(folder, capfd, compiled_searches):
    around = np.abs(np.subtract.outer(np.arange(16), np.arange(16)))
    np.save("circle.npy", np.minimum(around, 16 - around))
    np.save("segment.npy", np.abs(np.subtract.outer(np.arange(17), np.arange(17))) / 2)
    limit = "--time-limit", "120"
    code, out, _ = run(capfd, "compare", "circle.npy", "segment.npy", "--distances", "--verify", "--json", *limit)
    record = json.loads(out)
    assert code == 0 and record["lower"] <= 2.5 <= record["upper"]  # half of 10 half steps
    assert (record["lower_bound_by"], record["proof_checked"]) == ("satisfiability", True)
    assert main(["compare", "d.npz", "e.npy", "--distances", "--json"]) == 0
    assert json.loads(capfd.readouterr().out)["proof_checked"] is None


def test_surfaces_by_their_inner_distances(folder, capfd):
    code, out, _ = run(capfd, "compare", "a.ply", "b.obj", "--metric", "lipschitz", "--json", "--time-limit", "20")
    record = json.loads(out)
    assert code == 0
    assert record["unit"] == "1"
    assert record["lower"] <= np.log(2) + 1e-12
    assert record["upper"] >= np.log(2) - 1e-12


def test_net_writes_meshes_and_tables(folder, capfd):
    s = icosphere(2)
    rinow.write_mesh("s.ply", (s.vertices, s.faces))
    code, out, err = run(
        capfd, "net", "s.ply", "--size", "6", "--json", "-o", "n.ply", "-o", "n.csv", "-o", "n.npz", "--unit", "m"
    )
    assert (code, err) == (0, "")
    record = json.loads(out)
    expected = rinow.farthest_point_net((s.vertices, s.faces), size=6)
    assert record["indices"] == expected.indices.tolist()
    assert record["covering_radius"] == expected.covering_radius
    assert record["unit"] == "m"
    mesh = rinow.read_mesh("n.npz")
    np.testing.assert_array_equal(mesh.vertex_data["net_label"], expected.labels)
    np.testing.assert_array_equal(mesh.vertex_data["net_distance"], expected.distances)
    np.testing.assert_array_equal(rinow.read_mesh("n.ply").vertex_data["quality"], expected.distances)
    assert (folder / "n.csv").read_text().splitlines()[1] == "index,x,y,z,covering_radius"
    code, out, _ = run(capfd, "net", "s.ply", "--radius", "0.7")
    assert code == 0
    assert "covering radius" in out


BAD = [
    (["compare", "a.ply", "missing.ply"], "missing.ply: there is no such file"),
    (["compare", "a.ply", "p.csv"], "p.csv has no faces; add --points if its rows are points"),
    (["compare", "p.csv", "text.csv", "--points"], "text.csv: line 2"),
    (["compare", "p.csv", "uneven.csv", "--points"], "uneven.csv: line 3 has 3 numbers, but the first row 2."),
    (["compare", "p.csv", "empty.csv", "--points"], "empty.csv: the file is empty"),
    (["compare", "p.csv", "a.ply", "--points"], "A has points of dimension 2, B of dimension 3"),
    (["compare", "p.csv", "mixed.csv", "--points"], "mixed.csv: line 1 has 'x' where a number belongs"),
    (["compare", "p.csv", "text.npy", "--points"], "text.npy: the file is no NPY file"),
    (["compare", "d.npz", "p.csv", "--points"], "d.npz: the archive holds distances, other but none of points"),
    (["compare", "d.npz", "p.csv", "--points", "--distances"], "exclude each other"),
    (["compare", "d.npz", "uneven.csv", "--distances"], "uneven.csv: line 3"),
    (["compare", "d.npz", "q.txt", "--distances"], "q.txt has 3 rows of 2 numbers; a distance matrix is square."),
    (["compare", "d.npz", "e.npy", "--distances", "--metric", "hausdorff"], "choose --metric gromov-hausdorff"),
    (["compare", "a.ply", "b.obj", "--tolerance", "0"], "tolerance = 0.0 is not positive"),
    (["compare", "a.ply", "b.obj", "-o", "a.ply"], "a.ply is the input"),
    (["compare", "p.csv", "q.txt", "--points", "-o", "p.csv"], "p.csv is the input"),
    (["compare", "a.ply", "b.obj", "-o", "no_folder/o.csv"], "does not exist"),
    (["compare", "p.csv", "q.txt", "--points", "-o", "o.ply"], "neither suffix .csv nor .npz"),
    (["compare", "a.ply", "b.obj", "-o", "o.csv", "-o", "o.csv"], "named twice"),
    (["compare", "a.ply", "b.obj", "-o", "1.csv", "-o", "2.csv", "-o", "3.csv"], "3.csv is one output too many"),
    (["net", "a.ply"], "size and radius are both missing"),
    (["net", "a.ply", "--size", "9"], "size = 9 is outside 1..8"),
    (["net", "a.ply", "--size", "2.5"], "size = 2.5 is not a number of points"),
    (["net", "a.ply", "--size", "2", "-o", "n.csv", "-o", "n.csv"], "n.csv is named twice"),
    (["net", "a.ply", "--size", "2", "--start", "8"], "start = 8 is outside 0..7"),
    (["net", "a.ply", "--size", "2", "-o", "a.ply"], "a.ply is the input"),
]


@pytest.mark.parametrize(("arguments", "message"), BAD)
def test_bad_input_is_one_sentence_and_nothing_is_written(folder, capfd, arguments, message):
    (folder / "text.csv").write_text("1,2\n3,four\n")
    (folder / "uneven.csv").write_text("x,y\n1,2\n1,2,3\n")
    (folder / "empty.csv").write_text("")
    (folder / "mixed.csv").write_text("1,x\n1,2\n")  # no heading: it would be lost without a word
    (folder / "text.npy").write_text("1,2\n")
    before = sorted(os.listdir(folder))
    code, out, err = run(capfd, *arguments)
    assert (code, out) == (1, "")
    assert err.startswith("rinow: ")
    assert err.count("\n") == 1
    assert message in err
    assert sorted(os.listdir(folder)) == before


@pytest.mark.parametrize(
    "arguments",
    [["compare", "a.ply"], ["compare", "a.ply", "b.obj", "--metric", "x"], ["net"], ["net", "a.ply", "--size", "x"]],
)
def test_wrong_usage_exits_with_2(folder, arguments):
    assert main(arguments) == 2


def test_a_matrix_that_is_no_metric_is_named(folder, capfd):
    (folder / "bent.csv").write_text("0,1,2.1\n1,0,1\n2.1,1,0\n")
    code, out, err = run(capfd, "compare", "d.npz", "bent.csv", "--distances")
    assert (code, out) == (1, "")
    assert err.startswith("rinow: B: bent.csv: distances[0, 2] = 2.1")
    assert err.endswith("raise rtol.\n")
    code, out, _ = run(capfd, "compare", "d.npz", "bent.csv", "--distances", "--rtol", "0.1", "--json")
    assert code == 0
    assert json.loads(out)["lower"] >= 0.45  # the diameters are 3 and 2.1


def test_meshes_of_unequal_size_need_no_distances(folder, capfd, monkeypatch):
    monkeypatch.setattr("rinow.study.comparison.geodesics_within", None)
    rinow.write_mesh(folder / "c.off", (np.eye(3), [[0, 1, 2]]))
    code, out, _ = run(capfd, "compare", "a.ply", "c.off", "--metric", "lipschitz", "--json")
    assert code == 0
    assert json.loads(out)["lower_bound_by"] == "size"


@pytest.mark.parametrize("metric", ["gromov-hausdorff", "lipschitz"])
def test_a_mesh_in_two_parts_is_named(folder, capfd, metric):
    c = cube()
    both = np.concatenate([c.vertices, c.vertices + 3]), np.concatenate([c.faces, c.faces + 8])
    rinow.write_mesh(folder / "two.ply", both)
    for pair, name in ((("two.ply", "a.ply"), "A"), (("a.ply", "two.ply"), "B")):
        code, out, err = run(capfd, "compare", *pair, "--metric", metric)
        assert (code, out) == (1, "")
        assert err == f"rinow: {name}: two.ply: mesh has no path from vertex 0 to vertex 8; take one component.\n"


def test_a_vertex_without_a_face_has_no_geodesic_distance(folder, capfd):
    c = cube()
    rinow.write_mesh(folder / "loose.ply", (np.concatenate([c.vertices, [[5, 5, 5]]]), c.faces))
    code, out, err = run(capfd, "compare", "loose.ply", "loose.ply", "--metric", "lipschitz")
    assert (code, out) == (1, "")
    assert err.startswith("rinow: A: loose.ply: mesh has no face at vertex 8")
    assert main(["compare", "loose.ply", "loose.ply", "--metric", "gromov-hausdorff"]) == 0


def test_geodesic_distances_that_take_too_long_are_refused(folder, capfd):
    s = icosphere(3)
    rinow.write_mesh(folder / "s.ply", (s.vertices, s.faces))
    code, out, err = run(capfd, "compare", "s.ply", "s.ply", "--metric", "lipschitz", "--time-limit", "0")
    assert (code, out) == (1, "")
    assert err.startswith("rinow: the geodesic distances of 642 vertices take about")
    assert err.endswith("or simplify the meshes.\n")
