"""VTK's legacy files (.vtk), text and binary, versions 1 to 5, of type POLYDATA.

They are not read by VTK: its reader ends the process with a segmentation fault on many truncated files.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, BinaryIO
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import read_only
from rinow.errors import FileFormatError
from rinow.io.ply_body import read_element
from rinow.io.ply_header import Element, Property
from rinow.io.polygons import Runs, runs_of_offsets, surface_triangles
from rinow.io.text_numbers import numbers_of_rows
from rinow.mesh import TriangleMesh

__all__ = ["read_legacy_vtk"]

Array = NDArray[Any]

_TYPES = {
    "char": "i1", "signed_char": "i1", "unsigned_char": "u1", "short": "i2", "unsigned_short": "u2", "int": "i4",
    "unsigned_int": "u4", "long": "i8", "unsigned_long": "u8", "vtkidtype": "i4", "vtktypeint64": "i8",
    "vtktypeuint64": "u8", "float": "f4", "double": "f8",
}  # fmt: skip
"""Types by name; vtkIdType is stored in 4 bytes."""

_WIDTHS = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TENSORS6": 6, "GLOBAL_IDS": 1, "PEDIGREE_IDS": 1}
_CELLS = ("POLYGONS", "TRIANGLE_STRIPS", "VERTICES", "LINES")


def read_legacy_vtk(path: Path) -> TriangleMesh:
    """Read a legacy VTK file of type POLYDATA.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    mesh : TriangleMesh
        Points in the order of the file; the point data are in ``vertex_data`` under their names.

    Raises
    ------
    FileFormatError
        If the file holds no POLYDATA, is truncated, or an index has a fault.
    InvalidMeshError
        If it has no polygon.
    """
    with path.open("rb") as file:
        magic, _, form = file.readline(1 << 10), file.readline(1 << 10), file.readline(1 << 10).strip().upper()
        if not magic.startswith(b"# vtk DataFile") or form not in (b"ASCII", b"BINARY"):
            raise FileFormatError("the file does not start like a legacy VTK file; export it again.")
        data = [word.upper() for word in _words(file)]
        if data != ["DATASET", "POLYDATA"]:
            raise FileFormatError(
                f"the file holds {' '.join(data) or 'nothing'}; extract its surface and save that as PolyData."
            )
        points, cells, fields = _content(file, text=form == b"ASCII", version=float(magic.split()[-1]))
    faces, notes = surface_triangles(len(points), cells.get("POLYGONS"), cells.get("TRIANGLE_STRIPS"))
    return TriangleMesh(points, faces, {k: v for k, v in fields.items() if len(v) == len(points)}, notes)


def _content(file: BinaryIO, *, text: bool, version: float) -> tuple[Array, dict[str, Runs], dict[str, Array]]:
    """Points, cells and point data."""
    points, cells, fields = np.empty((0, 3)), dict[str, Runs](), dict[str, Array]()
    place, n_rows = "", 0
    while words := _words(file):
        match [words[0].upper(), *words[1:]]:
            case ["POINTS", n, kind]:
                points = _numbers(file, kind, 3 * int(n), text=text).reshape(-1, 3)
            case [key, n, size] if key in _CELLS:
                cells[key] = (_cells if version >= 5 else _old_cells)(file, int(n), int(size), text=text)
            case ["POINT_DATA" | "CELL_DATA" as place, n]:
                n_rows = int(n)
            case ["METADATA"]:
                while file.readline().strip():
                    pass
            case ["LOOKUP_TABLE", _, n]:
                _numbers(file, "float" if text else "unsigned_char", 4 * int(n), text=text)
            case ["FIELD", _, n]:
                found = [_field(file, text=text) for _ in range(int(n))]
                fields.update({name: v for name, v in found if place == "POINT_DATA" and v is not None})
            case [key, name, *rest]:
                values = _attribute(file, key, rest, n_rows, text=text)
                if place == "POINT_DATA":
                    fields[unquote(name)] = values
            case _:
                raise FileFormatError(f"the line {' '.join(words)!r} has no meaning; save the file as .vtp.")
    return points, cells, fields


def _words(file: BinaryIO) -> list[str]:
    """Words of the next line that has any; none at the end of the file."""
    while line := file.readline():
        if words := line.decode("utf-8", "replace").split():
            return words
    return []


def _numbers(file: BinaryIO, kind: str, count: int, *, text: bool) -> Array:
    """The next numbers, from as many lines as it takes, or from big-endian bytes."""
    if kind.lower() not in _TYPES or count < 0:
        raise FileFormatError(f"{count} numbers of type {kind} are unknown; save the file as .vtp.")
    dtype = np.dtype(_TYPES[kind.lower()])
    if not text:
        return np.frombuffer(_take(file, count * dtype.itemsize), dtype.newbyteorder(">"))
    _check_left(file, count)
    lines, missing = list[bytes](), count
    while missing > 0 and (line := file.readline()):
        lines.append(line)
        missing -= len(line.split())
    if missing:
        raise FileFormatError(f"an array of {count} numbers has {count - missing}; the file is damaged, copy it again.")
    return numbers_of_rows(b"".join(lines), lambda _: "an array")[0]


def _cells(file: BinaryIO, n_offsets: int, n_corners: int, *, text: bool) -> Runs:
    """Cells as offsets and corners, since version 5."""
    arrays: list[Array] = []
    for name, count in (("OFFSETS", n_offsets), ("CONNECTIVITY", n_corners)):
        words = _words(file)
        if len(words) != 2 or words[0].upper() != name:
            raise FileFormatError(f"{' '.join(words)!r} stands where {name} belongs; the file is damaged.")
        arrays.append(_numbers(file, words[1], count, text=text))
    return runs_of_offsets(arrays[1], arrays[0])


def _old_cells(file: BinaryIO, n_cells: int, size: int, *, text: bool) -> Runs:
    """Cells as one list, each led by its number of corners, before version 5."""
    values = _numbers(file, "int", size, text=text)
    corners = Property("corners", values.dtype, values.dtype, values.dtype)
    columns, _ = read_element(read_only(values.view(np.uint8)), 0, Element("cell", n_cells, (corners,)), ("corners",))
    return columns["corners"]


def _attribute(file: BinaryIO, key: str, rest: list[str], n_rows: int, *, text: bool) -> Array:
    """The values of an attribute whose line is ``key name rest``."""
    match [key, *rest]:
        case ["SCALARS", kind, *width] if _words(file)[:1] == ["LOOKUP_TABLE"]:
            n = int(width[0]) if width else 1
        case ["COLOR_SCALARS", width]:
            kind, n = "float" if text else "unsigned_char", int(width)
        case ["TEXTURE_COORDINATES", width, kind]:
            n = int(width)
        case [_, kind] if key in _WIDTHS:
            n = _WIDTHS[key]
        case _:
            raise FileFormatError(f"the line {key} {' '.join(rest)!r} has no meaning; save the file as .vtp.")
    return _shaped(_numbers(file, kind, n * n_rows, text=text), n_rows, kind, text=text)


def _field(file: BinaryIO, *, text: bool) -> tuple[str, Array | None]:
    """The next array of a FIELD, its line being ``name width rows type``; None for text."""
    words = _words(file)
    if len(words) != 4:
        raise FileFormatError(f"the line {' '.join(words)!r} is no head of an array; the file is damaged.")
    name, width, n_rows, kind = unquote(words[0]), int(words[1]), int(words[2]), words[3]
    if kind == "string":
        _check_left(file, width * n_rows)
        for _ in range(width * n_rows):
            file.readline() if text else _take(file, _string_length(file))
        return name, None
    if kind == "bit" and not text:
        bits = np.unpackbits(_numbers(file, "unsigned_char", (width * n_rows + 7) // 8, text=text))
        return name, bits[: width * n_rows].reshape(n_rows, -1).squeeze(1) if width == 1 else None
    kind = "unsigned_char" if kind == "bit" else kind
    return name, _shaped(_numbers(file, kind, width * n_rows, text=text), n_rows, kind, text=text)


def _shaped(values: Array, n_rows: int, kind: str, *, text: bool) -> Array:
    """One row per point, in the type of the file."""
    native = values.astype(_TYPES[kind.lower()])
    return native if len(native) == n_rows else native.reshape(n_rows, -1)


def _string_length(file: BinaryIO) -> int:
    """Length of the next text: the two top bits of its first byte tell how many bytes hold the length."""
    first = _take(file, 1)[0]
    return int.from_bytes(bytes([first & 63]) + _take(file, (7, 3, 1, 0)[first >> 6]), "big")


def _take(file: BinaryIO, size: int) -> bytes:
    """The next bytes."""
    _check_left(file, size)
    return file.read(size)


def _check_left(file: BinaryIO, size: int) -> None:
    """Refuse to read more bytes than are left."""
    if size > os.fstat(file.fileno()).st_size - file.tell():
        raise FileFormatError(f"the file ends before {size} promised bytes; it is truncated, copy it again.")
