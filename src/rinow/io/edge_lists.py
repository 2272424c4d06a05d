"""Graphs in files: lists of edges with the labels of their ends, GraphML, and sparse matrices of scipy."""

from __future__ import annotations

import ast
import csv
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np
from scipy.sparse import coo_array, load_npz

from rinow.errors import FileFormatError
from rinow.io.faults import reading
from rinow.io.tables import TEXT, text_of

__all__ = ["GraphFile", "names_edges", "read_graph"]

SUFFIXES = (*TEXT, ".edges", ".edgelist", ".graphml", ".npz")

SOURCES = ("source", "from", "src", "node1", "u", "i")
TARGETS = ("target", "to", "dst", "node2", "v", "j")
LENGTHS = ("length", "weight", "distance", "w")
"""What headings call the ends and the length of an edge, in any case."""

Edge = tuple[str, str, str | None, str]
"""The labels of its ends, its length as the file has it, and where in the file it stands."""


class GraphFile(NamedTuple):
    """What a file of a graph holds."""

    labels: tuple[str, ...]  # of the nodes, in the order in which the file names them
    lengths: coo_array  # (n, n): an entry for each edge of the file, 1 where it has no length
    is_directed: bool | None  # None: the file does not say


def read_graph(path: Path) -> GraphFile:
    """Read a graph.

    Parameters
    ----------
    path : Path
        Text with an edge on each line (.csv, .tsv, .txt, .dat, .edges, .edgelist, .xyz): two labels and perhaps a
        length, parted by commas, semicolons, tabs or white space; lines that begin with # or % are skipped.  A heading
        is known by its words (source, target, weight and others) and may name further columns, which are passed over.
        Lines of networkx (``a b {'weight': 2.0}``) are understood.  Or .graphml, with the key ``weight`` or
        ``length``; or .npz as scipy's ``save_npz`` writes it, whose labels are numbers.

    Returns
    -------
    graph : GraphFile
        The nodes, in the order in which the file names them, and the edges.

    Raises
    ------
    FileFormatError
        If the file is missing, has a fault, or holds no graph.
    """
    suffix = path.suffix.lower()
    with reading(path, suffix.removeprefix(".").upper() or "graph"):
        if suffix == ".npz":
            matrix: Any = load_npz(path)
            n, n_columns = matrix.shape
            if n != n_columns:
                raise FileFormatError(f"the matrix has {n} rows of {n_columns}; that of a graph is square.")
            return GraphFile(tuple(map(str, range(n))), coo_array(matrix), None)
        if suffix == ".graphml":
            nodes, edges, is_directed = _graphml(path)
        elif suffix in SUFFIXES:
            nodes, edges, is_directed = [], _listed(text_of(path).decode("utf-8", errors="replace")), None
        else:
            raise FileFormatError(f"the suffix is none of {' '.join(SUFFIXES)}; export a list of edges as CSV.")
        return _collected(nodes, edges, is_directed)


def _collected(nodes: Sequence[str], edges: Iterator[Edge], is_directed: bool | None) -> GraphFile:
    """The graph of nodes and edges; ends of edges that are no nodes yet become such."""
    number = {label: i for i, label in enumerate(nodes)}
    tails, heads, lengths = list[int](), list[int](), list[float]()
    for tail, head, length, place in edges:
        tails.append(number.setdefault(tail, len(number)))
        heads.append(number.setdefault(head, len(number)))
        lengths.append(1.0 if length is None else _length(length, place))
    if not number:
        raise FileFormatError("the file holds no edge; give two labels on each line.")
    matrix = coo_array((np.array(lengths), (np.array(tails, np.intp), np.array(heads, np.intp))), (len(number),) * 2)
    return GraphFile(tuple(number), matrix, is_directed)


def _length(text: str, place: str) -> float:
    length = float(text) if _is_number(text) else np.nan
    if not length >= 0.0:
        raise FileFormatError(f"{place} has {text[:40]!r} for a length; give a number >= 0.")
    return length


def names_edges(heading: Sequence[str]) -> bool:
    """Whether a heading in small letters names the ends of edges."""
    return all(any(word in heading for word in words) for words in (SOURCES, TARGETS))


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _listed(text: str) -> Iterator[Edge]:
    """The edges in lines of text."""
    lines = [
        (f"line {i}", line.strip())
        for i, line in enumerate(text.split("\n"), 1)
        if line.strip() and line.lstrip()[0] not in "#%"
    ]
    mark = next((mark for mark in ";\t," if lines and mark in re.sub(r"\{.*", "", lines[0][1])), " ")
    rows = [(place, *_cells(line, mark)) for place, line in lines]
    if not rows:
        return
    heading = [cell.lower() for cell in rows[0][1]]
    columns, third, has_heading = [0, 1], 2 if len(heading) > 2 else -1, names_edges(heading)
    if has_heading:
        columns = [next(heading.index(word) for word in words if word in heading) for words in (SOURCES, TARGETS)]
        third = next((heading.index(word) for word in LENGTHS if word in heading), -1)
    width = len(heading)
    if not has_heading and (not 2 <= width <= 3 or (width == 3 and not _is_number(heading[2]))):
        raise FileFormatError(
            f"{rows[0][0]} is no heading with source, target and weight, and no edge: two labels and perhaps a length."
        )
    for place, cells, attributes in rows[has_heading:]:
        if len(cells) != width:
            raise FileFormatError(f"{place} has {len(cells)} cells, but the first line {width}.")
        yield cells[columns[0]], cells[columns[1]], cells[third] if third >= 0 else attributes, place


def _cells(line: str, mark: str) -> tuple[list[str], str | None]:
    """The cells of a line, and the length in the attributes that networkx writes behind them."""
    length = None
    if line.endswith("}") and "{" in line:
        line, _, attributes = line.partition("{")
        try:
            length = ast.literal_eval("{" + attributes).get("weight")
        except (ValueError, SyntaxError) as error:
            raise FileFormatError(f"{attributes[:40]!r} are no attributes that networkx writes.") from error
        line = line.strip(f"{mark} ")
    row = next(csv.reader([line], delimiter=mark, skipinitialspace=True))
    return [cell.strip() for cell in row], None if length is None else str(length)


def _graphml(path: Path) -> tuple[list[str], Iterator[Edge], bool]:
    """The nodes and edges of a GraphML file, and whether the edges lead one way."""
    root = ElementTree.parse(path).getroot()
    space = root.tag.partition("}")[0] + "}" if root.tag.startswith("{") else ""
    graph = root.find(f"{space}graph")
    if graph is None:
        raise FileFormatError("the file holds no graph; export it again.")
    names = {key.get("id"): key.get("attr.name", "") for key in root.iter(f"{space}key") if key.get("for") != "node"}
    keys = [key for word in LENGTHS for key, name in names.items() if name.lower() == word]

    def edges() -> Iterator[Edge]:
        for i, edge in enumerate(graph.iter(f"{space}edge")):
            data = {item.get("key"): item.text for item in edge.iter(f"{space}data")}
            length = next((data[key] for key in keys if key in data), None)
            yield edge.get("source", ""), edge.get("target", ""), length, f"edge {i}"

    nodes = [node.get("id", "") for node in graph.iter(f"{space}node")]
    return nodes, edges(), graph.get("edgedefault") == "directed"
