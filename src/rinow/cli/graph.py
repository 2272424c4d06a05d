"""`rinow graph`: the curvature of the nodes and edges of a graph."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from rich.table import Table

from rinow._version import __version__
from rinow.cli._arguments import Flag, Outputs
from rinow.cli._terminal import console, print_json, print_notes, working
from rinow.errors import FileFormatError, naming
from rinow.io.edge_lists import read_graph
from rinow.io.tables import check_tables, write_columns
from rinow.study.graphs import GraphStudy, study_graph

__all__ = ["graph"]


def graph(
    edges: Path,
    /,
    *,
    kind: Literal["haantjes", "menger", "wald"] = "haantjes",
    directed: Flag = False,
    output: Outputs = (),
    unit: str = "length",
    json: Flag = False,
) -> None:
    """Compute the curvature of the nodes and edges of a graph by the lengths of its edges.

    Parameters
    ----------
    edges
        List of edges, two labels and perhaps a length on each line (CSV, TSV, TXT, DAT, EDGES, EDGELIST); GraphML; or
        NPZ as of scipy's save_npz.  Weights are lengths: a strong tie is short.
    kind
        haantjes takes all detours of up to three edges, menger the triangles at an edge; wald, for nodes only, asks
        which surface of constant curvature the neighbourhood would fit in.
    directed
        Edges lead from the first node to the second; GraphML files say by themselves.
    output
        CSV or NPZ table of the nodes, with their labels; given a second time that of the edges.
    unit
        Name of the unit of length of the edges, such as km.
    json
        Print one JSON object instead of a table.
    """
    most = 1 if kind == "wald" else 2
    if len(output) > most:
        what = "kind wald has values of nodes only" if len(output) == 2 else "there are tables of nodes and of edges"
        raise FileFormatError(f"{output[most]} is one output too many; {what}.")
    check_tables(output, inputs=[edges])
    with working(f"reading {edges.name}"):
        labels, lengths, is_directed = read_graph(edges)
    with working(f"curvature of {len(labels):,} nodes") as progress, naming(str(edges)):
        lead_one_way = directed or is_directed
        study = study_graph(lengths, labels, kind=kind, directed=lead_one_way, unit=unit, progress=progress)
    meaning = f"{kind} curvature, unit {study.curvature_unit}"
    for path, columns in zip(output, (study.nodes, study.edges), strict=False):
        with working(f"writing {path.name}"):
            write_columns(path, columns(), meaning)
    if not json:
        _print(str(edges), study)
        return
    record: dict[str, object] = {"input": str(edges), "kind": kind, "unit": study.curvature_unit}
    record |= {"weighted": study.weighted, "counts": study.counts()}
    files = {"seconds": {"curvature": study.seconds}, "outputs": [str(path) for path in output]}
    print_json({"rinow": __version__, **record, "percentiles": study.percentiles(), **files})


def _print(title: str, study: GraphStudy) -> None:
    """Percentiles at nodes and edges, and counts."""
    table = Table(title=title)
    table.add_column("curvature of")
    table.add_column("unit")
    percentiles = study.percentiles()
    for p in next(iter(percentiles.values()), {}):
        table.add_column({"0": "least", "50": "median", "100": "greatest"}.get(p, f"{p} %"), justify="right")
    for name, levels in percentiles.items():
        table.add_row(name, study.curvature_unit, *(f"{v:z.4g}" for v in levels.values()))
    if percentiles:
        console().print(table)
    counts = study.counts()
    lengths = "lengths as in the file" if study.weighted else "all lengths 1"
    numbers = f"{counts['nodes']:,} nodes, {counts['edges']:,} edges, {lengths}"
    found = f"kind {study.curvature.kind}; {numbers}; {study.seconds:.2f} s"
    where = "nodes" if study.curvature.kind == "wald" else "edges"
    left = [f"{counts[name]:,} {where} are {word}" for name, word in UNCOMMON.items() if counts[name]]
    print_notes((found, *left))


UNCOMMON = {
    "undefined": "nan: the data determine no value (too few nodes within reach, or ends at distance 0)",
    "minus_infinity": "-inf: more negative than any surface, as on a tree",
}
"""Counts that are told in words, where they are not 0."""
