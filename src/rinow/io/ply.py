"""PLY files (G. Turk, 1994): text and both binary forms, every scalar type, lists of any kind."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from rinow._printing import counted
from rinow.errors import FileFormatError, InvalidInputError
from rinow.io.atomic import replacing
from rinow.io.fields import Fields, Units, in_type_of
from rinow.io.ply_body import body_bytes, read_element
from rinow.io.ply_header import Element, Header, read_header
from rinow.io.polygons import Runs, surface_triangles
from rinow.mesh import TriangleMesh

__all__ = ["has_faces", "read_ply", "read_ply_points", "write_ply", "write_ply_points"]

Indices = NDArray[np.intp]

_AXES = ("x", "y", "z")
_LISTS = ("vertex_indices", "vertex_index")
_TYPE_NAMES = {
    "i1": "char",
    "u1": "uchar",
    "i2": "short",
    "u2": "ushort",
    "i4": "int",
    "u4": "uint",
    "f4": "float",
    "f8": "double",
}
_BLOCK = 1 << 20


def read_ply(path: Path) -> TriangleMesh:
    """Read a PLY file.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    mesh : TriangleMesh
        Vertices in the order of the file; every other number of a vertex is in ``vertex_data`` under its name and in
        its type, and name_x, name_y, name_z together are one field `name` of shape (n_vertices, 3).

    Raises
    ------
    FileFormatError
        If the header, the data or an index has a fault.
    InvalidMeshError
        If the file has no face.

    Notes
    -----
    Positions are float64; in a text file they have all their digits even where the header says float.  A body is
    mapped, not loaded, so a file of N bytes needs little more memory than its mesh.
    """
    header = read_header(path)
    data = body_bytes(path, header)
    columns, rest = _all_columns(data, header)
    if rest and header.byte_order is None:
        raise FileFormatError(f"{rest // 8} numbers are left after the last element; a line or the header has a fault.")
    vertices, fields = _vertices(columns["vertex"], _element(header, "vertex"), text=header.byte_order is None)
    strips = _find(columns.get("tristrips", {}))
    faces, notes = surface_triangles(len(vertices), _find(columns.get("face", {})), strips and _split(strips))
    if rest:
        what = "after the last element"
        notes = (*notes, f"{counted(rest, f'byte {what} was', f'bytes {what} were')} left unread.")
    return TriangleMesh(vertices, faces, fields, notes)


def has_faces(path: Path) -> bool:
    """Whether the header of a PLY file promises faces or strips of them.

    Raises
    ------
    FileFormatError
        If the header has a fault.
    """
    return any(e.n_rows for e in read_header(path).elements if e.name in ("face", "tristrips"))


def read_ply_points(path: Path) -> NDArray[np.float64]:
    """(n_vertices, 3): the positions of a PLY file, whether it has faces or not.

    Raises
    ------
    FileFormatError
        If the header or the data has a fault.
    """
    header = read_header(path)
    columns, _ = _all_columns(body_bytes(path, header), header)
    return _vertices(columns["vertex"], _element(header, "vertex"), text=header.byte_order is None)[0]


def _all_columns(data: NDArray[np.uint8], header: Header) -> tuple[dict[str, dict[str, Runs]], int]:
    """The properties in use of every element, and the number of bytes left over."""
    _element(header, "vertex")
    columns: dict[str, dict[str, Runs]] = {}
    position = 0
    for element in header.elements:
        wanted = {
            "vertex": [p.name for p in element.properties if p.length is None], "face": _LISTS, "tristrips": _LISTS
        }.get(element.name, ())  # fmt: skip
        columns[element.name], position = read_element(data, position, element, wanted)
    return columns, len(data) - position


def _element(header: Header, name: str) -> Element:
    """The element of this name."""
    for element in header.elements:
        if element.name == name:
            return element
    raise FileFormatError(f"the PLY header declares no element {name!r}; it is not a mesh.")


def _vertices(columns: dict[str, Runs], element: Element, *, text: bool) -> tuple[NDArray[np.float64], Fields]:
    """Positions and fields."""
    missing = [axis for axis in _AXES if axis not in columns]
    if missing:
        raise FileFormatError(f"the vertices have no property {missing[0]!r}; x, y and z are needed.")
    vertices = np.empty((element.n_rows, 3))
    for k, axis in enumerate(_AXES):
        vertices[:, k] = columns[axis].items
    fields: dict[str, NDArray[Any]] = {}
    for p in element.properties:
        if p.name in columns and p.name not in _AXES:
            values = np.array(columns[p.name].items, p.item.newbyteorder("="))
            fields[p.name] = _as_declared(values, p.declared) if text else values
    return vertices, _joined(fields)


def _as_declared(values: NDArray[Any], declared: np.dtype) -> NDArray[Any]:
    """Numbers from text in the type of the header; left in float64 where that cannot hold them."""
    with np.errstate(invalid="ignore", over="ignore"):
        result = values.astype(declared)
    return result if declared.kind == "f" or np.array_equal(result, values) else values


def _joined(fields: dict[str, NDArray[Any]]) -> Fields:
    """Fields of which three are called name_x, name_y, name_z become one of shape (n, 3)."""
    result: dict[str, NDArray[Any]] = {}
    for name, values in fields.items():
        stem = name[:-2]
        parts = [fields.get(f"{stem}_{axis}") for axis in _AXES]
        if (
            name[-2:] not in ("_x", "_y", "_z")
            or not stem
            or any(p is None or p.dtype != values.dtype for p in parts)
            or stem in fields
        ):
            result[name] = values
        elif name.endswith("_x"):
            result[stem] = np.stack([p for p in parts if p is not None], axis=1)
    return result


def _find(columns: dict[str, Runs]) -> Runs | None:
    """The list of vertex indices, under one of its two names."""
    return next((columns[name] for name in _LISTS if name in columns), None)


def _split(strips: Runs) -> Runs:
    """Strips that end where the file has an index -1."""
    counts = strips.lengths()
    strip = np.repeat(np.arange(len(counts)), counts) + np.cumsum(strips.items == -1)
    keep = strips.items != -1
    return Runs(strips.items[keep], np.unique(strip[keep], return_counts=True)[1])


def write_ply(path: Path, mesh: TriangleMesh, fields: Fields, units: Units) -> tuple[str, ...]:
    """Write a binary little-endian PLY file with positions in double precision.

    Parameters
    ----------
    path : Path
        The file to make or to replace.
    mesh : TriangleMesh
        The surface.
    fields : mapping of str to (n_vertices, ...) ndarray
        One property each, in its own type or in double; shape (n_vertices, 3) makes three: name_x, name_y, name_z.
    units : mapping of str to str
        What a field means; written as a comment.

    Returns
    -------
    notes : tuple of str
        What had to be changed.

    Raises
    ------
    InvalidInputError
        If two properties would have the same name.
    FileFormatError
        If the file cannot be written.
    """
    return _write(path, mesh.vertices, mesh.faces, fields, units)


def write_ply_points(path: Path, points: NDArray[np.float64], fields: Fields, units: Units) -> tuple[str, ...]:
    """Write points without faces, as `write_ply` writes vertices.

    Raises
    ------
    InvalidInputError
        If two properties would have the same name.
    FileFormatError
        If the file cannot be written.
    """
    return _write(path, points, None, fields, units)


def _write(
    path: Path, vertices: NDArray[np.float64], faces: Indices | None, fields: Fields, units: Units
) -> tuple[str, ...]:
    """Write the header, the vertices and the faces, if there are any; returns what had to be changed."""
    properties, notes = _properties(fields)
    records = np.dtype(
        [(axis, "<f8") for axis in _AXES] + [(name, v.dtype.newbyteorder("<")) for name, v in properties.items()]
    )
    with replacing(path) as temporary, temporary.open("wb") as file:
        file.write(_header(len(vertices), None if faces is None else len(faces), properties, units).encode("ascii"))
        _write_vertices(file, vertices, properties, records)
        if faces is not None:
            _write_faces(file, faces)
    return notes


def _properties(fields: Fields) -> tuple[dict[str, NDArray[Any]], tuple[str, ...]]:
    """One column per property, and what was changed."""
    properties: dict[str, NDArray[Any]] = {}
    notes: list[str] = []
    for field, values in fields.items():
        name = re.sub(r"[^!-~]", "_", field)
        columns = in_type_of(values.reshape(len(values), -1), _TYPE_NAMES)
        suffixes = [""] if values.ndim == 1 else ["_x", "_y", "_z"] if values.shape[1:] == (3,) else None
        if suffixes is None:
            suffixes = [f"_{k}" for k in range(columns.shape[1])]
            notes.append(f"PLY has no arrays: the field {field!r} was split into {columns.shape[1]} properties.")
        if name != field:
            notes.append(f"PLY has plain names only: the field {field!r} was called {name!r}.")
        if columns.dtype.kind == "f" and values.dtype.kind in "iu":
            notes.append(f"PLY has no 64-bit integers: the field {field!r} was written in double precision.")
        for k, suffix in enumerate(suffixes):
            if name + suffix in properties or name + suffix in _AXES:
                raise InvalidInputError(
                    f"two properties would be called {name + suffix!r}; rename the field {field!r}."
                )
            properties[name + suffix] = columns[:, k]
    return properties, tuple(notes)


def _header(n_vertices: int, n_faces: int | None, properties: Fields, units: Units) -> str:
    """The header, with a comment for each field that has a unit."""
    comments = [f"comment {_plain(name)} = {_plain(text)}" for name, text in units.items()]
    declared = [f"property double {axis}" for axis in _AXES]
    declared += [f"property {_TYPE_NAMES[v.dtype.str[1:]]} {name}" for name, v in properties.items()]
    lines = ["ply", "format binary_little_endian 1.0", *comments, f"element vertex {n_vertices}", *declared]
    if n_faces is not None:
        lines += [f"element face {n_faces}", "property list uchar int vertex_indices"]
    return "\n".join([*lines, "end_header"]) + "\n"


def _plain(text: str) -> str:
    """Text on one line in ASCII, which some programs insist on; superscripts as powers."""
    for letter, plain in {"²": "^2", "³": "^3", "−": "-", "µ": "u", "μ": "u", "κ": "kappa"}.items():
        text = text.replace(letter, plain)
    return " ".join(text.split()).encode("ascii", "replace").decode()


def _write_vertices(file: BinaryIO, vertices: NDArray[np.float64], properties: Fields, records: np.dtype) -> None:
    """Write positions and fields, block by block."""
    for start in range(0, len(vertices), _BLOCK):
        rows = slice(start, start + _BLOCK)
        block = np.empty(len(vertices[rows]), records)
        for k, axis in enumerate(_AXES):
            block[axis] = vertices[rows, k]
        for name, values in properties.items():
            block[name] = values[rows]
        file.write(block.data)


def _write_faces(file: BinaryIO, faces: Indices) -> None:
    """Write the triangles, block by block."""
    for start in range(0, len(faces), _BLOCK):
        corners = faces[start : start + _BLOCK]
        block = np.empty(len(corners), [("n", "u1"), ("corners", "<i4", (3,))])
        block["n"], block["corners"] = 3, corners
        file.write(block.data)
