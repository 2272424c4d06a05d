"""STL files: separate triangles, welded into a surface."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rinow import tolerances
from rinow.errors import FileFormatError, InvalidMeshError
from rinow.io.atomic import replacing
from rinow.io.faults import reading
from rinow.io.text_numbers import numbers_of_rows
from rinow.mesh import TriangleMesh

__all__ = ["read_stl", "read_stl_mesh", "write_stl"]

Indices = NDArray[np.intp]

_HEADER = 84
_RECORD = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"^[ \t]*vertex[ \t]+([^\r\n]*)", re.MULTILINE | re.IGNORECASE)
_WORDS = re.compile(rb"^[ \t]*(?:end(facet|solid)|solid)\b", re.MULTILINE | re.IGNORECASE)


def read_stl(path: str | os.PathLike[str], *, rtol: float = tolerances.WELD_DISTANCE) -> tuple[TriangleMesh, Indices]:
    """Read an STL file, text or binary, and merge the corners that are one point.

    Parameters
    ----------
    path : path
        The file.
    rtol : float, optional
        Corners closer than this share of the diagonal of the bounding box are one vertex.

    Returns
    -------
    mesh : TriangleMesh
        Vertices in the order of their first appearance, faces in the order of the file.
    vertex_map : (3 n_faces,) ndarray of intp
        Vertex of each corner of the file.

    Raises
    ------
    FileFormatError
        If the file is truncated or a number has a fault.
    InvalidMeshError
        If the file has no triangle.
    """
    with reading(Path(path), "STL"):
        return _welded(Path(path), rtol)


def read_stl_mesh(path: Path) -> TriangleMesh:
    """The mesh of `read_stl` alone."""
    return _welded(path, tolerances.WELD_DISTANCE)[0]


def _welded(path: Path, rtol: float) -> tuple[TriangleMesh, Indices]:
    """The welded mesh and the vertex of each corner."""
    corners = _corners(path)
    if not len(corners):
        raise InvalidMeshError("the STL file has no triangle; export it again.")
    first, rank = _distinct(corners)  # the search for near pairs would find every pair of equal corners
    mesh, merged = TriangleMesh(corners[first], rank.reshape(-1, 3)).welded(rtol=rtol)
    vertex_map = merged[rank]
    note = (
        f"the {len(corners)} corners of the STL file were welded into {mesh.n_vertices} vertices "
        f"(closer than {rtol:g} of the diagonal); rinow.io.stl.read_stl gives the map."
    )
    return TriangleMesh(mesh.vertices, mesh.faces, notes=(note,)), vertex_map


def _distinct(points: NDArray[np.floating]) -> tuple[Indices, Indices]:
    """The first of every group of equal points, in the order of the points, and the number of each point's group."""
    order = np.lexsort(points.T)
    is_new = np.ones(len(points), np.bool_)
    is_new[1:] = (points[order[1:]] != points[order[:-1]]).any(axis=1)
    group = np.empty(len(points), np.intp)
    group[order] = np.cumsum(is_new) - 1
    first = order[is_new]
    in_order = np.argsort(first)
    rank = np.empty(len(first), np.intp)
    rank[in_order] = np.arange(len(first))
    return first[in_order], rank[group]


def _corners(path: Path) -> NDArray[np.floating]:
    """Corners of all triangles, one per row."""
    data = np.memmap(path, np.uint8, "r")
    n_faces = int(data[80:_HEADER].view("<u4")[0]) if len(data) >= _HEADER else 0
    end = _HEADER + n_faces * _RECORD.itemsize
    is_text = bytes(data[:80]).lstrip()[:5].lower() == b"solid"
    if len(data) >= _HEADER and (len(data) == end or (len(data) > end and not is_text)):
        return data[_HEADER:end].view(_RECORD)["corners"].reshape(-1, 3)
    if not is_text:
        raise FileFormatError(
            f"a binary STL file of {n_faces} triangles has {max(end, _HEADER)} bytes, this one {len(data)}; "
            "the file is truncated, copy it again."
        )
    return _corners_of_text(data.tobytes())


def _corners_of_text(text: bytes) -> NDArray[np.float64]:
    """Corners in an STL file in text form, of all its solids."""
    values, widths = numbers_of_rows(b"\n".join(_VERTEX.findall(text)), lambda i: f"vertex line {i} (counted from 0)")
    words = [match[1].lower() if match[1] else b"" for match in _WORDS.finditer(text)]
    n_faces, n_ends, n_starts = (words.count(word) for word in (b"facet", b"solid", b""))
    if n_starts != n_ends or (widths != 3).any() or len(widths) != 3 * n_faces:
        raise FileFormatError(
            f"the text has {len(widths)} vertex lines, {n_faces} endfacet, {n_starts} solid and {n_ends} endsolid; "
            "every facet needs three vertices of three numbers and every solid an end, so the file is truncated."
        )
    return values.reshape(-1, 3)


def write_stl(path: Path, mesh: TriangleMesh) -> tuple[str, ...]:
    """Write a binary STL file: separate triangles in single precision with their normals."""
    block = np.zeros(mesh.n_faces, _RECORD)
    corners = mesh.vertices[mesh.faces]
    with np.errstate(all="ignore"):
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        block["normal"] = np.where(np.isfinite(normals), normals, 0.0)
        block["corners"] = corners
    with replacing(path) as temporary, temporary.open("wb") as file:
        file.write(b"binary STL".ljust(80, b"\0") + mesh.n_faces.to_bytes(4, "little"))
        file.write(block.data)
    return ("STL holds separate triangles in single precision: vertices and their order are lost.",)
