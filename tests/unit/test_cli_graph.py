"""`rinow graph`: files of graphs as networkx, pandas and others write them; labels come back in the tables."""

import csv
import json

import networkx as nx
import numpy as np
import pytest
from scipy.sparse import save_npz

import rinow
from rinow.cli.main import main

NAMES = ["Ann", "Bo, Jr", "Cy", "Di", "Ed"]


def graph(directed=False):
    """A triangle with a tail and a diagonal, of different lengths."""
    found = (nx.DiGraph if directed else nx.Graph)()
    found.add_weighted_edges_from(
        [(NAMES[i], NAMES[j], w) for i, j, w in [(0, 1, 1.5), (1, 2, 1.0), (0, 2, 1.25), (2, 3, 2.0), (3, 4, 1.0)]]
        + [(NAMES[1], NAMES[3], 2.5)]
    )
    return found


def rows_of(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def written(name, G):
    """The graph in a file, and whether the file keeps the labels."""
    frame = nx.to_pandas_edgelist(G)
    if name.endswith(".graphml"):
        nx.write_graphml(G, name)
    elif name.endswith(".npz"):
        save_npz(name, nx.to_scipy_sparse_array(G))
    elif name == "pandas.csv":
        frame.to_csv(name)
    elif name == "bare.tsv":
        frame.to_csv(name, sep="\t", index=False, header=False, columns=["source", "target", "weight"])
    elif name == "semicolons.csv":
        frame.assign(kind="x").to_csv(name, sep=";", index=False)
    else:
        G = nx.relabel_nodes(G, {label: label.replace(", ", "_") for label in G})
        writer = nx.write_edgelist if name.endswith(".edgelist") else nx.write_weighted_edgelist
        writer(G, name, **({"delimiter": ","} if name.startswith("comma") else {}))
    return not name.endswith(".npz")


@pytest.mark.parametrize(
    "name",
    ["a.graphml", "a.npz", "pandas.csv", "bare.tsv", "semicolons.csv", "a.edgelist", "comma.edgelist", "a.txt"],
)
@pytest.mark.parametrize("directed", [False, True])
def test_files_of_other_programs_give_the_values_of_the_library(tmp_path, monkeypatch, capsys, name, directed):
    monkeypatch.chdir(tmp_path)
    G = graph(directed)
    has_labels = written(name, G)
    flag = ["--directed"] if directed and not name.endswith(".graphml") else []
    assert main(["graph", name, *flag, "-o", "n.csv", "-o", "e.csv", "--unit", "km", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["counts"] == {"nodes": 5, "edges": 6, "undefined": 0, "minus_infinity": 0}
    assert (record["unit"], record["weighted"]) == ("1/km", True)
    expected = rinow.graph_curvature(G, kind="haantjes")
    labels = list(G) if has_labels else [str(i) for i in range(5)]
    if name.endswith((".edgelist", ".txt")):
        labels = [label.replace(", ", "_") for label in labels]
    nodes = {row["label"]: float(row["curvature"]) for row in rows_of("n.csv")}
    assert nodes == {k: pytest.approx(v, rel=1e-12) for k, v in zip(labels, expected.nodes, strict=True)}
    edges = {frozenset((r["source"], r["target"])): float(r["curvature"]) for r in rows_of("e.csv")}
    ends = [frozenset((labels[i], labels[j])) for i, j in expected.edge_index]
    assert edges == {k: pytest.approx(v, rel=1e-12) for k, v in zip(ends, expected.edges, strict=True)}


def test_edges_without_lengths_and_nodes_without_edges(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text("% comment\na,b\nb,c\nc,a\n\nc,d\n")
    assert main(["graph", "a.csv", "-o", "n.npz"]) == 0
    assert "4 nodes, 4 edges, all lengths 1" in capsys.readouterr().out
    with np.load("n.npz") as table:
        assert table["label"].tolist() == list("abcd")
        assert table["curvature"].tolist() == [2.0, 2.0, 2.0, 0.0]
    lonely = nx.complete_graph(4)
    lonely.add_node("lone")
    nx.write_graphml(lonely, "b.graphml")
    assert main(["graph", "b.graphml", "--kind", "wald", "-o", "n.csv"]) == 0
    out = capsys.readouterr().out
    assert "1 nodes are nan" in out
    rows = rows_of("n.csv")
    assert rows[-1]["label"] == "lone"
    assert rows[-1]["curvature"] == "nan"
    assert list(rows[0]) == ["label", "curvature", "spread", "radius"]


@pytest.mark.parametrize(
    ("content", "words", "sentence"),
    [
        (b"a,b\nb,c,3\n", "", "a.csv: line 2 has 3 cells, but the first line 2."),
        (b"a,b,1\nb,c,-3\n", "", "a.csv: line 2 has '-3' for a length; give a number >= 0."),
        (b"a,b,1\nb,c,x\n", "", "line 2 has 'x' for a length"),
        (b"n1,n2,cost\na,b,1\n", "", "a.csv: line 1 is no heading with source, target and weight, and no edge"),
        (b"a,b,c,d\n", "", "line 1 is no heading"),
        (b"a\n", "", "line 1 is no heading"),
        (b"# nothing\n", "", "a.csv: the file holds no edge; give two labels on each line."),
        (b"", "", "a.csv: the file is empty"),
        (b"a b {'weight': \n", "", "line 1 is no heading"),
        (b"a b {x}\n", "", "are no attributes that networkx writes"),
        (b"a,b\n", "-o n.csv -o e.csv -o f.csv", "f.csv is one output too many"),
        (b"a,b\n", "--kind wald -o n.csv -o e.csv", "e.csv is one output too many; kind wald has values of nodes only"),
        (b"a,b\n", "-o n.graphml", "n.graphml has neither suffix .csv nor .npz"),
        (b"a,b\n", "-o a.csv", "a.csv is the input"),
    ],
)
def test_bad_input_is_one_sentence(tmp_path, monkeypatch, capsys, content, words, sentence):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_bytes(content)
    assert main(["graph", "a.csv", *words.split()]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("rinow: ")
    assert err.count("\n") == 1
    assert sentence in err
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("a.graphml", b"<graphml></graphml>", "a.graphml: the file holds no graph; export it again."),
        ("a.graphml", b"<graphml>", "a.graphml is no intact GRAPHML file"),
        ("a.gml", b"graph [ ]", "a.gml: the suffix is none of .csv"),
        ("a.npz", b"PK", "a.npz is no intact NPZ file"),
    ],
)
def test_damaged_files_are_named(tmp_path, monkeypatch, capsys, name, content, sentence):
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_bytes(content)
    assert main(["graph", name]) == 1
    assert sentence in capsys.readouterr().err


@pytest.mark.parametrize("command", ["info", "curvature"])
def test_a_graph_is_no_mesh(tmp_path, monkeypatch, capsys, command):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.edgelist").write_text("0 1\n1 2\n")
    assert main([command, "a.edgelist"]) == 1
    assert capsys.readouterr().err == (
        "rinow: a.edgelist holds a graph, no mesh; rinow graph computes the curvature of a graph.\n"
    )
