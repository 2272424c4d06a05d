"""Tables of numbers in files, such as points as rows."""

from __future__ import annotations

import codecs
import csv
import os
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from rinow.errors import FileFormatError
from rinow.io.atomic import check_targets, replacing
from rinow.io.faults import reading, writing
from rinow.io.mesh_files import read_mesh
from rinow.io.npz import VERTICES, read_arrays
from rinow.io.ply import read_ply_points
from rinow.io.text_numbers import numbers_of_rows

__all__ = [
    "TABLE_SUFFIXES",
    "TEXT",
    "check_tables",
    "heading_of",
    "numbers_of_text",
    "read_points",
    "stored_table",
    "text_of",
    "write_columns",
]

Floats = NDArray[np.float64]

TEXT = (".csv", ".tsv", ".txt", ".xyz", ".dat")
TABLE_SUFFIXES = (*TEXT, ".npy", ".npz")
MARKS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
"""Marks at the beginning of text written by spreadsheets."""

POINT_NAMES = ("points", "P", *VERTICES)


def read_points(path: str | os.PathLike[str]) -> Floats:
    """Read points, one per row, from a table, or the vertices of a mesh file or PLY point cloud.

    Parameters
    ----------
    path : path
        Text with one point per line (.csv, .tsv, .txt, .xyz, .dat; commas, semicolons or white space; beside semicolons
        commas are decimal marks; a heading and lines that begin with # are skipped), .npy, .npz (its only array, or
        ``points``, ``P``, ``V`` or ``vertices``), .ply, or any file that `rinow.read_mesh` reads.

    Returns
    -------
    points : (n, dimension) ndarray of float
        In the order of the file.

    Raises
    ------
    FileFormatError
        If the file is missing, has a fault, or holds no table.
    """
    file = Path(path)
    if file.suffix.lower() == ".ply":
        with reading(file, "PLY"):
            return read_ply_points(file)
    if file.suffix.lower() in TABLE_SUFFIXES:
        return _read_table(file, POINT_NAMES)
    return read_mesh(file).vertices


def _read_table(file: Path, names: tuple[str, ...]) -> Floats:
    """A table of real numbers with at least one row and one column."""
    with reading(file, file.suffix.removeprefix(".").upper() or "table"):
        if file.suffix.lower() in TEXT:
            return numbers_of_text(text_of(file))
        table = stored_table(file, names)
        if table.ndim != 2 or not table.size or table.dtype.kind not in "biuf":
            raise FileFormatError(f"the array has type {table.dtype} and shape {table.shape}; give a table of numbers.")
        return np.ascontiguousarray(table, np.float64)


def stored_table(file: Path, names: tuple[str, ...]) -> NDArray[np.generic]:
    """The array of an NPY file, or the only array, or that with one of these names, of an NPZ file."""
    if file.suffix.lower() == ".npz":
        return _chosen(read_arrays(file), names)
    if file.suffix.lower() != ".npy":
        raise FileFormatError(f"the suffix is none of {' '.join(TABLE_SUFFIXES)}; convert the table to CSV.")
    with file.open("rb") as stream:
        if stream.read(len(npy.MAGIC_PREFIX)) != npy.MAGIC_PREFIX:
            raise FileFormatError("the file is no NPY file, or it is damaged; export it again.")
    return np.load(file, allow_pickle=False)


def _chosen(arrays: Mapping[str, NDArray[np.generic]], names: tuple[str, ...]) -> NDArray[np.generic]:
    """The only array, or the first of these names."""
    if len(arrays) == 1:
        return next(iter(arrays.values()))
    for name in names:
        if name in arrays:
            return arrays[name]
    raise FileFormatError(f"the archive holds {', '.join(arrays) or 'nothing'} but none of {', '.join(names)}.")


def text_of(file: Path) -> bytes:
    """What a text file holds, as UTF-8 without a mark and with one kind of line end."""
    text = file.read_bytes()
    for mark, encoding in MARKS.items():
        if text.startswith(mark):
            text = text.decode(encoding, errors="replace").encode()
    return text.replace(b"\r", b"\n")


def heading_of(file: Path) -> list[str]:
    """The cells of the first line of a text file that is no comment, in small letters; none if one is a number."""
    if not file.is_file():
        return []
    lines = (line for line in text_of(file).split(b"\n") if line.strip() and not line.lstrip().startswith(b"#"))
    first = next(lines, b"").decode("utf-8", errors="replace").strip(" ")
    mark = next((mark for mark in ";\t," if mark in first), " ")
    cells = [cell.strip().lower() for cell in next(csv.reader([first], delimiter=mark, skipinitialspace=True), [])]
    return [] if any(_is_number(cell.encode()) for cell in cells) else cells


def numbers_of_text(text: bytes) -> Floats:
    """Rows of numbers; blank lines and comments are skipped, and so is a heading: a first row without any number.

    In a row with semicolons, which part numbers, commas are decimal marks, as in spreadsheets of half of Europe.
    """
    lines = text.split(b"\n")
    rows = (line for line in lines if not line.lstrip().startswith(b"#"))
    comma = b"." if b";" in text and any(b";" in row and b"," in row for row in rows) else b" "
    lines = text.replace(b",", comma).replace(b";", b" ").split(b"\n")
    kept = [i for i, line in enumerate(lines) if line.strip() and not line.lstrip().startswith(b"#")]
    if kept and not any(_is_number(word) for word in lines[kept[0]].split()):
        del kept[0]
    if not kept:
        raise FileFormatError("the file holds no numbers; give one row per line.")
    values, counts = numbers_of_rows(b"\n".join(lines[i] for i in kept), lambda i: f"line {kept[i] + 1}")
    uneven = np.flatnonzero(counts[: len(kept)] != counts[0])
    if len(uneven):
        i = int(uneven[0])
        raise FileFormatError(f"line {kept[i] + 1} has {counts[i]} numbers, but the first row {counts[0]}.")
    return values.reshape(len(kept), int(counts[0]))


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def check_tables(paths: Iterable[Path], *, inputs: Iterable[Path] = ()) -> None:
    """Refuse tables that could not be written later.

    Raises
    ------
    FileFormatError
        If a suffix is neither .csv nor .npz, or a file is an input, occurs twice, or cannot be made where it is.
    """
    targets = list(paths)
    for path in targets:
        if path.suffix.lower() not in (".csv", ".npz"):
            raise FileFormatError(f"{path} has neither suffix .csv nor .npz; choose another name for the table.")
    check_targets(targets, inputs)


def write_columns(path: Path, columns: Mapping[str, NDArray[np.generic]], meaning: str) -> None:
    """Write columns of equal length as CSV or NPZ, whole or not at all.

    Parameters
    ----------
    path : Path
        A file with the suffix .csv or .npz.
    columns : mapping of str to (n,) ndarray
        The columns.
    meaning : str
        Quantities and units in words: the first line of a CSV file after #, the array ``units`` of an NPZ file.

    Raises
    ------
    FileFormatError
        If the file cannot be written.
    """
    with writing(path, "table"), replacing(path) as temporary:
        if path.suffix.lower() == ".npz":
            with zipfile.ZipFile(temporary, "w") as archive:
                for name, values in {**columns, "units": np.array(meaning)}.items():
                    with archive.open(f"{name}.npy", "w", force_zip64=True) as file:
                        npy.write_array(file, np.asarray(values), allow_pickle=False)
            return
        rows = zip(*(np.asarray(values).tolist() for values in columns.values()), strict=True)
        with temporary.open("w", encoding="utf-8", newline="") as file:
            file.write(f"# {meaning}\n{','.join(columns)}\n")
            csv.writer(file, lineterminator="\n").writerows(rows)  # numbers as by repr, texts quoted where they must be
