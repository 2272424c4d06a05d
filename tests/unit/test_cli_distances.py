"""`rinow curvature --distances`: points of which nothing but their distances is known."""

import csv
import json

import numpy as np
import pytest

import rinow
from rinow.cli.main import main


@pytest.fixture(scope="module")
def space():
    """Points of a sphere of radius 2."""
    sphere = rinow.SpaceForm(0.25)
    points = sphere.sample(30, 1.0, np.random.default_rng(11))
    D = sphere.distance(points[:, None], points)
    return (D + D.T) / 2


@pytest.fixture
def folder(space, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.savetxt("D.csv", space, delimiter=",")
    return tmp_path


def test_values_are_those_of_the_library_in_the_order_of_the_table(space, folder, capsys):
    assert main("curvature D.csv --distances -o out.csv -o out.npz --unit km --json".split()) == 0
    record = json.loads(capsys.readouterr().out)
    expected = rinow.metric_space_curvature(space)
    assert record["counts"] == {"points": 30}
    assert record["units"]["gaussian"] == "1/km²"
    assert record["percentiles"]["gaussian"]["50"] == pytest.approx(0.25, rel=1e-9)
    with np.load("out.npz") as columns:
        np.testing.assert_allclose(columns["gaussian"], expected.value, rtol=1e-9)
        np.testing.assert_array_equal(columns["status"], expected.status)
        assert "curvature K, unit 1/km², positive as on a sphere" in str(columns["units"])
    with open("out.csv", encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    assert rows[0] == ["gaussian", "spread", "radius", "status"]
    np.testing.assert_allclose([float(row[0]) for row in rows[1:]], expected.value, rtol=1e-9)


def test_the_table_on_the_terminal_counts_points(folder, capsys):
    assert main("curvature D.csv --distances --radius 0.9".split()) == 0
    out = capsys.readouterr().out
    assert "method metric_space; points:" in out
    assert "vertex" not in out


def test_rounded_tables_need_a_tolerance(space, folder, capsys):
    np.savetxt("rounded.csv", space.round(2), delimiter=",")
    assert main("curvature rounded.csv --distances".split()) == 1
    assert "rounded.csv: distances[" in capsys.readouterr().err
    assert main("curvature rounded.csv --distances --rtol 0.05".split()) == 0


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("--method wald", "--method needs a surface, and D.csv holds distances only; leave it out."),
        ("--report out.html", "--report needs a surface"),
        ("--field mean", "--field needs a surface"),
        ("-o out.ply", "out.ply has neither suffix .csv nor .npz"),
        ("-o D.csv", "D.csv is the input"),
        ("-o a.csv -o a.csv", "a.csv is named twice as an output"),
    ],
)
def test_what_needs_a_surface_is_refused(folder, capsys, words, sentence):
    before = sorted(path.name for path in folder.iterdir())
    assert main(["curvature", "D.csv", "--distances", *words.split()]) == 1
    assert sentence in capsys.readouterr().err
    assert sorted(path.name for path in folder.iterdir()) == before
