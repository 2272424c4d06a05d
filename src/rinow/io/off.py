"""OFF files: positions and polygons; colours and normals are left out."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rinow.errors import FileFormatError
from rinow.io.atomic import replacing
from rinow.io.polygons import Runs, surface_triangles
from rinow.io.text_numbers import numbers_of_rows, write_rows
from rinow.mesh import TriangleMesh

__all__ = ["read_off", "write_off"]


def read_off(path: Path) -> TriangleMesh:
    """Read an OFF file in text form, with one vertex and one face per line.

    Parameters
    ----------
    path : Path
        The file; its first word may be OFF, COFF, NOFF, STOFF or a mixture of these.

    Returns
    -------
    mesh : TriangleMesh
        Vertices in the order of the file.

    Raises
    ------
    FileFormatError
        If the header, a number or an index has a fault, or lines are missing.
    InvalidMeshError
        If the file has no face.

    Notes
    -----
    trimesh is not used here: it takes a truncated list of faces for a complete one.
    """
    text = re.sub(rb"#[^\r\n]*", b"", path.read_bytes())
    header = re.match(rb"\s*(?:ST)?C?N?OFF\s+(\d{1,18})\s+(\d{1,18})(?:[ \t]+\d+)?[ \t]*(?=[\r\n]|\Z)", text)
    if not header:
        raise FileFormatError(
            "the file does not start with 'OFF' and the numbers of vertices and faces; export it again."
        )
    n_vertices, n_faces = int(header[1]), int(header[2])
    rows = [row for row in text[header.end() :].splitlines() if row and not row.isspace()]
    if len(rows) < n_vertices + n_faces:
        raise FileFormatError(
            f"the header promises {n_vertices} vertices and {n_faces} faces, but {len(rows)} lines follow; "
            "the file is truncated, copy it again."
        )
    values, widths = numbers_of_rows(b"\n".join(rows[:n_vertices]), lambda i: f"the line of vertex {i}")
    _refuse(widths < 3, "vertex")
    vertices = values[(np.cumsum(widths) - widths)[:, None] + np.arange(3)]
    text = b"\n".join(rows[n_vertices : n_vertices + n_faces])
    values, widths = numbers_of_rows(text, lambda i: f"the line of face {i}")
    starts = np.cumsum(widths) - widths
    first = values[starts]  # the number of corners; after them there may be a colour
    _refuse(~((first >= 1) & (first < widths) & (first == np.floor(first))), "face")
    counts = first.astype(np.intp)
    place = np.arange(len(values)) - np.repeat(starts, widths)
    corners = values[(place >= 1) & (place <= np.repeat(counts, widths))]
    faces, notes = surface_triangles(n_vertices, Runs(corners, counts))
    return TriangleMesh(vertices, faces, notes=notes)


def _refuse(wrong: NDArray[np.bool_], kind: str) -> None:
    """Raise for the first wrong line."""
    if wrong.any():
        raise FileFormatError(
            f"the line of {kind} {np.argmax(wrong)} (counted from 0) has too few numbers; export the file again."
        )


def write_off(path: Path, mesh: TriangleMesh) -> tuple[str, ...]:
    """Write the geometry with all digits."""
    with replacing(path) as temporary, temporary.open("wb") as file:
        file.write(f"OFF\n{mesh.n_vertices} {mesh.n_faces} 0\n".encode("ascii"))
        write_rows(file, "%r %r %r\n", mesh.vertices)
        write_rows(file, "3 %d %d %d\n", mesh.faces)
    return ()
