"""OBJ files: positions and polygons, in the order of the file whatever groups, materials and texture seams it has."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from rinow.errors import FileFormatError
from rinow.io.atomic import replacing
from rinow.io.polygons import Runs, surface_triangles
from rinow.io.text_numbers import numbers_of_rows, write_rows
from rinow.mesh import TriangleMesh

__all__ = ["read_obj", "write_obj"]

_VERTEX = re.compile(rb"^[ \t]*v[ \t]+([^\r\n]*)", re.MULTILINE)
_FACE = re.compile(rb"^[ \t]*f[ \t]+([^\r\n]*)", re.MULTILINE)


def read_obj(path: Path) -> TriangleMesh:
    """Read the vertices and the faces of an OBJ file.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    mesh : TriangleMesh
        One vertex per ``v`` line, in the order of the file, used or not.

    Raises
    ------
    FileFormatError
        If a number or an index has a fault.
    InvalidMeshError
        If the file has no face.

    Notes
    -----
    trimesh is not used here: it splits vertices along texture seams and drops unused ones.
    """
    text = re.sub(rb"#[^\r\n]*", b"", re.sub(rb"\\[ \t]*\r?\n", b" ", path.read_bytes()))
    coordinates, widths = numbers_of_rows(b"\n".join(_VERTEX.findall(text)), lambda i: _line(text, _VERTEX, i))
    short = np.flatnonzero(widths < 3)
    if len(short):
        raise FileFormatError(f"{_line(text, _VERTEX, int(short[0]))} has fewer than three coordinates; correct it.")
    vertices = coordinates[(np.cumsum(widths) - widths)[:, None] + np.arange(3)]
    faces, notes = surface_triangles(len(vertices), _polygons(text, len(vertices)))
    return TriangleMesh(vertices, faces, notes=notes)


def _polygons(text: bytes, n_vertices: int) -> Runs:
    """Corners of all faces, counted from 0."""
    rows = re.sub(rb"/\S*", b"", b"\n".join(_FACE.findall(text)))  # normals and texture
    numbers, counts = numbers_of_rows(rows, lambda i: _line(text, _FACE, i))
    wrong = (numbers == 0) | (numbers != np.floor(numbers)) | (np.abs(numbers) > n_vertices)
    seen = np.full(len(counts), n_vertices)
    if (numbers < 0).any():  # such an index counts back from the last vertex before the face
        starts = [match.start() for match in _VERTEX.finditer(text)]
        seen = np.searchsorted(starts, [match.start() for match in _FACE.finditer(text)])
    seen = np.repeat(seen, counts)
    wrong |= -numbers > seen
    if wrong.any():
        i = int(np.argmax(wrong))
        line = _line(text, _FACE, int(np.searchsorted(np.cumsum(counts), i, side="right")))
        raise FileFormatError(
            f"{line} names vertex {numbers[i]:.17g}, but the vertices are 1..{n_vertices}; correct it."
        )
    return Runs(np.where(numbers < 0, seen + numbers, numbers - 1).astype(np.intp), counts)


def _line(text: bytes, pattern: re.Pattern[bytes], i: int) -> str:
    """Name of the line of the i-th match of a pattern (continued lines count as one)."""
    start = next(match.start(1) for k, match in enumerate(pattern.finditer(text)) if k == i)
    number = text.count(b"\n", 0, start) + 1
    return f"line {number}"


def write_obj(path: Path, mesh: TriangleMesh) -> tuple[str, ...]:
    """Write the geometry with all digits."""
    with replacing(path) as temporary, temporary.open("wb") as file:
        write_rows(file, "v %r %r %r\n", mesh.vertices)
        write_rows(file, "f %d %d %d\n", mesh.faces + 1)
    return ()
