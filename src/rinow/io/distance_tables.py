"""Tables of all distances of some points, with the labels of these where the file has any."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import squareform

from rinow.errors import FileFormatError
from rinow.io.faults import reading
from rinow.io.npz import read_arrays
from rinow.io.tables import TEXT, numbers_of_text, stored_table, text_of

__all__ = ["Distances", "read_distances"]

Labels = tuple[str, ...]

NAMES = ("distances", "D")
"""Names of the matrix in an NPZ file."""

MARKS = ";\t, "
"""What may part the cells of a table; a mark is taken for one if as many cells are a table of so many lines."""

LABELS = "labels"
"""Name of the labels in an NPZ file."""


class Distances(NamedTuple):
    """A square matrix, not checked further, and a label for each of its points, or none."""

    matrix: NDArray[np.float64]
    labels: Labels = ()


def read_distances(path: str | os.PathLike[str]) -> Distances:
    """Read a square matrix of distances from a table.

    Parameters
    ----------
    path : path
        Text (.csv, .tsv, .txt, .xyz, .dat; commas, semicolons, tabs or white space; beside semicolons commas are
        decimal marks; lines that begin with # are skipped), .npy, or .npz (its only array, or ``distances`` or ``D``).
        The first row, the first column or both may hold labels, as pandas and R write them; in .npz they are
        ``labels``.  The n (n - 1) / 2 distances in one row or column, as scipy's ``pdist`` gives them, will do too.

    Returns
    -------
    distances : Distances
        The matrix and the labels.

    Raises
    ------
    FileFormatError
        If the file is missing, has a fault, its table is not square, or its rows and columns have different orders.
    """
    file = Path(path)
    labels: Labels = ()
    with reading(file, file.suffix.removeprefix(".").upper() or "table"):
        if file.suffix.lower() in TEXT:
            labels, text = _split_labels(text_of(file))
            table = numbers_of_text(text)
        else:
            table = stored_table(file, NAMES)
            if file.suffix.lower() == ".npz":
                labels = tuple(map(str, read_arrays(file).get(LABELS, ())))
        if table.ndim not in (1, 2) or not table.size or table.dtype.kind not in "biuf":
            raise FileFormatError(f"the array has type {table.dtype} and shape {table.shape}; give a table of numbers.")
        D = _square(np.ascontiguousarray(table, np.float64))
        if labels and len(labels) != len(D):
            raise FileFormatError(f"there are {len(labels)} labels for {len(D)} points; give one for each.")
    if D.shape[0] != D.shape[1]:
        raise FileFormatError(f"{file} has {D.shape[0]} rows of {D.shape[1]} numbers; a distance matrix is square.")
    return Distances(D, labels)


def _square(table: NDArray[np.float64]) -> NDArray[np.float64]:
    """The matrix of distances that stand in one row or column; others as they are, with two axes."""
    n = round((1 + (1 + 8 * table.size) ** 0.5) / 2)
    if table.shape != (1, 1) and table.size == max(table.shape) and n * (n - 1) // 2 == table.size:
        return squareform(table.ravel())
    return np.atleast_2d(table)


def _split_labels(text: bytes) -> tuple[Labels, bytes]:
    """The labels of the points, and the text without them, its lines where they were."""
    lines = text.decode("utf-8", errors="replace").split("\n")
    kept = [i for i, line in enumerate(lines) if line.strip() and not line.lstrip().startswith("#")]
    n = len(kept)
    for mark in MARKS if n > 1 else "":
        head, row = _cells(lines[kept[0]], mark), _cells(lines[kept[1]], mark)
        has_head = not all(map(_is_number, head)) or len(head) == len(row) - 1
        if has_head and len(row) == n - 1 == len(head):  # labels of columns
            lines[kept[0]] = ""
            return tuple(head), "\n".join(lines).encode()
        if has_head and len(row) == n and len(head) in (n - 1, n):
            lines[kept[0]] = ""
            return _without_first_column(lines, kept[1:], mark, head[len(head) - n + 1 :])
        if len(row) == n + 1 == len(head) and not (_is_number(head[0]) and _is_number(row[0])):
            return _without_first_column(lines, kept, mark, ())
    return (), text


def _without_first_column(lines: list[str], kept: list[int], mark: str, columns: Sequence[str]) -> tuple[Labels, bytes]:
    """The first cells of some lines, which are labels, and all lines without them."""
    rows = [_cells(lines[i], mark) for i in kept]
    labels = tuple(cells[0] for cells in rows)
    if sorted(columns) == sorted(labels) and tuple(columns) != labels:
        raise FileFormatError("the labels of the columns have another order than those of the rows; sort both alike.")
    for i, cells in zip(kept, rows, strict=True):
        lines[i] = mark.join(cells[1:])
    return labels, "\n".join(lines).encode()


def _cells(line: str, mark: str) -> list[str]:
    """The cells of a line; white space parts them where no mark does."""
    row = next(csv.reader([line.strip(" ")], delimiter=mark, skipinitialspace=True))
    return [cell.strip() for cell in row]


def _is_number(word: str) -> bool:
    try:
        float(word.replace(",", "."))
    except ValueError:
        return False
    return True
