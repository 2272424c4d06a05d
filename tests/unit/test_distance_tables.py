"""Tables of distances with labels, as pandas and R write them; the labels come back in the outputs."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

import rinow
from rinow.cli.main import main
from rinow.errors import FileFormatError
from rinow.io.distance_tables import read_distances

NAMES = ("Aix", "St. Moritz, upper", "7", "Zürich")
D = np.array([[0, 1, 2, 2.5], [1, 0, 1.5, 1.8], [2, 1.5, 0, 1], [2.5, 1.8, 1, 0]])
CITIES = Path(__file__).parents[2] / "examples" / "city_distances.csv"


def text(rows, mark=",", names=NAMES, head=None, decimal="."):
    """A table as a program writes it that quotes where it must."""
    lines = [] if head is None else [head]
    for name, row in zip(names or [None] * len(rows), rows, strict=True):
        lines.append(([] if name is None else [name]) + [str(x).replace(".", decimal) for x in row])
    quoted = [[f'"{cell}"' if mark in cell or " " in cell else cell for cell in line] for line in lines]
    return "\n".join(mark.join(line) for line in quoted) + "\n"


@pytest.mark.parametrize(
    "content",
    [
        text(D, head=["", *NAMES]),
        text(D, head=["km", *NAMES]),
        text(D, head=list(NAMES)),
        text(D, names=None, head=list(NAMES)),
        text(D),
        text(D, "\t", head=["", *NAMES]),
        text(D, ";", head=["", *NAMES], decimal=","),
        text(D, " ", head=list(NAMES)),
        "# km\n\n" + text(D, head=["", *NAMES]).replace("\n", "\r\n"),
    ],
)
def test_labels_are_found_wherever_they_stand(tmp_path, content):
    file = tmp_path / "D.csv"
    file.write_bytes(content.encode())
    found = read_distances(file)
    np.testing.assert_array_equal(found.matrix, D)
    assert found.labels == NAMES


def test_numbers_are_labels_beside_an_empty_corner_only(tmp_path):
    file = tmp_path / "D.csv"
    file.write_text(text(D, names=list("0123"), head=["", *"0123"]))
    assert read_distances(file).labels == tuple("0123")
    np.testing.assert_array_equal(read_distances(file).matrix, D)
    np.savetxt(file, D, delimiter=",")
    assert read_distances(file).labels == ()
    np.testing.assert_array_equal(read_distances(file).matrix, D)


def test_distances_of_pairs_make_a_matrix(tmp_path):
    points = np.random.default_rng(8).random((6, 2))
    pairs = pdist(points)
    np.save(tmp_path / "p.npy", pairs)
    np.savetxt(tmp_path / "p.txt", pairs)
    np.savez(tmp_path / "p.npz", D=pairs, labels=np.array(list("abcdef")))
    for name in ("p.npy", "p.txt", "p.npz"):
        np.testing.assert_array_equal(read_distances(tmp_path / name).matrix, squareform(pairs))
    assert read_distances(tmp_path / "p.npz").labels == tuple("abcdef")


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        (text(D, head=["", *NAMES[1:], NAMES[0]]), "labels of the columns have another order than those of the rows"),
        (text(D[:3, :3], names=NAMES[:3], head=["", *NAMES[:2], "x"]).replace("1.5", "u"), "line 3 has 'u' where"),
        ("1\n2\n3\n4\n", "has 4 rows of 1 numbers; a distance matrix is square"),
    ],
)
def test_faults_are_named(tmp_path, content, fault):
    (tmp_path / "D.csv").write_text(content, encoding="utf-8")
    with pytest.raises(FileFormatError, match=fault):
        read_distances(tmp_path / "D.csv")


def test_labels_must_be_as_many_as_points(tmp_path):
    np.savez(tmp_path / "D.npz", D=D, labels=np.array(["a", "b"]))
    with pytest.raises(FileFormatError, match=r"D\.npz: there are 2 labels for 4 points"):
        read_distances(tmp_path / "D.npz")


def test_the_shipped_table_of_cities_is_read_and_its_labels_are_kept(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["curvature", str(CITIES), "--distances"]) == 1
    assert "; that is 5.2e-05 of the largest distance too much: repair" in capsys.readouterr().err
    words = [str(CITIES), "--distances", "--rtol", "1e-4", "-o", "out.csv", "-o", "out.npz", "--unit", "km"]
    assert main(["curvature", *words]) == 0
    with open("out.csv", encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    assert rows[0][:2] == ["label", "gaussian"]
    assert [row[0] for row in rows[1:4]] == ["Amsterdam", "Auckland", "Bangkok"]
    with np.load("out.npz") as columns:
        assert columns["label"][-1] == "Tokyo"


def test_pairs_of_compared_spaces_have_their_labels(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("A.csv").write_text(text(D, head=["", *NAMES]), encoding="utf-8")
    np.savetxt("B.csv", D[::-1, ::-1], delimiter=",")
    assert main("compare A.csv B.csv --distances -o pairs.csv --json".split()) == 0
    assert json.loads(capsys.readouterr().out)["upper"] == 0
    with open("pairs.csv", encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    assert rows[0] == ["a", "b", "label_a"]
    assert sorted((int(b), name) for _, b, name in rows[1:]) == list(enumerate(reversed(NAMES)))
    assert rinow.gromov_hausdorff(D, D[::-1, ::-1]).exact


def test_a_net_of_a_table_of_distances(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("A.csv").write_text(text(D, head=["", *NAMES]), encoding="utf-8")
    words = "net A.csv --distances --size 3 --start 1 -o net.csv -o net.npz --unit km --json"
    assert main(words.split()) == 0
    record = json.loads(capsys.readouterr().out)
    expected = rinow.farthest_point_net(rinow.MetricSpace(D), size=3, start=1)
    assert record["indices"] == expected.indices.tolist()
    assert record["covering_radius"] == expected.covering_radius
    assert "surface_radius" not in record
    with open("net.csv", encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    assert rows[0] == ["index", "label", "covering_radius"]
    assert [row[1] for row in rows[1:]] == [NAMES[i] for i in expected.indices]
    with np.load("net.npz") as columns:
        np.testing.assert_array_equal(columns["covering_radius"], expected.radii)
    assert main("net A.csv --distances --size 3 -o net.ply".split()) == 1
    assert "net.ply has neither suffix .csv nor .npz" in capsys.readouterr().err
    assert main("net A.csv --size 3".split()) == 1
    assert "A.csv has no faces; geodesic distances need a mesh; add --distances" in capsys.readouterr().err
