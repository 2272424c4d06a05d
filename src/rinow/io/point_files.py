"""Files of points without faces: whether a file is one, the points, and points with fields."""

from __future__ import annotations

import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.errors import FileFormatError
from rinow.io.atomic import check_targets
from rinow.io.distance_tables import read_distances
from rinow.io.edge_lists import names_edges
from rinow.io.faults import reading, writing
from rinow.io.fields import renamed
from rinow.io.npz import FACES
from rinow.io.ply import has_faces, write_ply_points
from rinow.io.tables import TABLE_SUFFIXES, TEXT, heading_of, read_points, write_columns

__all__ = ["check_has_faces", "check_point_outputs", "holds_points", "read_cloud", "write_points"]

Floats = NDArray[np.float64]

WRITTEN = (".ply", ".csv", ".npz")
AXES = ("x", "y", "z")
NAMES = (AXES, *(tuple(f"points{mark}{i}" for i in range(3)) for mark in ":_"))
"""What headings call the coordinates, in any case; ParaView says Points:0 or Points_0."""


def holds_points(path: Path) -> bool:
    """Whether a file holds points only: a table, or a PLY or NPZ file without faces.

    Raises
    ------
    FileFormatError
        If the header of a PLY file has a fault.
    """
    suffix = path.suffix.lower()
    if not path.is_file() or not path.stat().st_size:
        return False
    if suffix == ".ply":
        with reading(path, "PLY"):
            return not has_faces(path)
    if suffix == ".npz":
        if not zipfile.is_zipfile(path):
            return False
        with zipfile.ZipFile(path) as archive:
            return not {f"{name}.npy" for name in FACES} & set(archive.namelist())
    return suffix in TABLE_SUFFIXES


def check_has_faces(path: Path, cure: str) -> None:
    """Refuse a file of points where a mesh is needed.

    Raises
    ------
    FileFormatError
        If the file holds points only; the sentence ends with the cure.
    """
    if holds_points(path):
        raise FileFormatError(f"{path} has no faces; {cure}.")


def read_cloud(path: Path) -> tuple[Floats, tuple[str, ...]]:
    """Points in space, and what was left out of the file, one sentence each.

    Raises
    ------
    FileFormatError
        If the file has a fault, its rows have less than three numbers, or it holds a matrix of distances.
    """
    heading = heading_of(path) if path.suffix.lower() in TEXT else []
    named = next((names for names in NAMES if set(names) <= set(heading)), None)
    if named is None and names_edges(heading):
        raise FileFormatError(f"{path} holds edges of a graph, no points; rinow graph computes their curvature.")
    try:
        points = read_points(path)
    except FileFormatError as error:
        raise _as_distances(path) or error from error
    width = points.shape[1]
    if width < 3:
        raise FileFormatError(f"{path} has rows of {width} numbers; a point in space has three: x, y and z.")
    if _is_of_distances(points):
        raise _distances_fault(path, width)
    columns = [0, 1, 2]
    if named is not None and len(heading) == width:
        columns = [heading.index(name) for name in named]
    words = "first three" if columns == [0, 1, 2] else f"columns {', '.join(str(c + 1) for c in columns)}"
    notes = () if width == 3 else (f"The rows have {width} numbers; the {words} are taken for x, y and z.",)
    return np.ascontiguousarray(points[:, columns]), notes


def _is_of_distances(table: Floats) -> bool:
    """Whether a table is a matrix of distances rather than one of points."""
    n, width = table.shape
    return n == width > 3 and np.allclose(table, table.T) and not table.diagonal().any()


def _distances_fault(path: Path, n: int) -> FileFormatError:
    return FileFormatError(
        f"{path} holds the distances of {n} points, not their places; add --distances (rinow curvature, rinow compare)."
    )


def _as_distances(path: Path) -> FileFormatError | None:
    """The error for a table that is one of distances with labels."""
    try:
        matrix, _ = read_distances(path)
    except FileFormatError:
        return None
    return _distances_fault(path, len(matrix)) if _is_of_distances(matrix) else None


def check_point_outputs(outputs: Iterable[Path], *, inputs: Iterable[Path] = ()) -> None:
    """Refuse outputs for points that could not be written later.

    Raises
    ------
    FileFormatError
        If an output has another suffix than .ply, .csv and .npz, is an input, occurs twice, or cannot be made.
    """
    targets = list(outputs)
    for path in targets:
        if path.suffix.lower() not in WRITTEN:
            raise FileFormatError(f"{path} cannot hold points without faces; choose one of {' '.join(WRITTEN)}.")
    check_targets(targets, inputs)


def write_points(
    path: Path, points: Floats, fields: Mapping[str, NDArray[Any]], units: Mapping[str, str], quality: str
) -> tuple[str, ...]:
    """Write points with fields as PLY, CSV or NPZ, whole or not at all; returns what had to be changed.

    Parameters
    ----------
    path : Path
        A file with one of these suffixes.
    points : (n_points, 3) ndarray of float
        Positions.
    fields : mapping of str to (n_points, ...) ndarray
        One column each; shape (n_points, 3) makes three: name_x, name_y, name_z.
    units : mapping of str to str
        What each field means.
    quality : str
        Name of the field that PLY files call ``quality``.

    Raises
    ------
    FileFormatError
        If the file cannot be written.
    """
    if path.suffix.lower() == ".ply":
        names = {quality: "quality"}
        with writing(path, "PLY"):
            return write_ply_points(path, points, renamed(fields, names), renamed(units, names))
    columns: dict[str, NDArray[Any]] = dict(zip(AXES, points.T, strict=True))
    for name, values in fields.items():
        parts = {name: values} if values.ndim == 1 else {f"{name}_{a}": v for a, v in zip(AXES, values.T, strict=True)}
        columns.update(parts)
    write_columns(path, columns, "; ".join(f"{name}: {units[name]}" for name in fields if name in units))
    return ()
