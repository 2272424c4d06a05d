"""NPZ files: the arrays V and F and one array per field; nothing pickled."""

from __future__ import annotations

import math
import zipfile
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from rinow.errors import FileFormatError, InvalidInputError
from rinow.io.atomic import replacing
from rinow.io.faults import quiet
from rinow.io.fields import Fields, Units, units_text
from rinow.io.polygons import Runs, surface_triangles
from rinow.mesh import TriangleMesh

__all__ = ["FACES", "VERTICES", "read_arrays", "read_npz", "write_npz"]

_RESERVED = ("V", "F", "units")
VERTICES, FACES = ("V", "vertices"), ("F", "faces")
"""Names of the arrays, the first ones as `write_npz` gives them."""


def read_npz(path: Path) -> TriangleMesh:
    """Read ``V`` or ``vertices`` (n_vertices, 3), ``F`` or ``faces`` (n_faces, corners) and the fields of an NPZ file.

    Parameters
    ----------
    path : Path
        The file, as `write_npz` or ``numpy.savez`` writes it.

    Returns
    -------
    mesh : TriangleMesh
        Arrays with one row per vertex are in ``vertex_data``.

    Raises
    ------
    FileFormatError
        If an array is missing, pickled or truncated, or an index has a fault.
    """
    arrays = read_arrays(path)
    held = [next((name for name in names if name in arrays), None) for names in (VERTICES, FACES)]
    missing = [names[0] for names, name in zip((VERTICES, FACES), held, strict=True) if name is None]
    if missing:
        raise FileFormatError(
            f"the archive holds {', '.join(arrays)} but no {missing[0]}; V and F, or vertices and faces, are needed."
        )
    V, F = (arrays[str(name)] for name in held)
    if V.ndim != 2 or F.ndim != 2 or (F.size and F.dtype.kind not in "iu"):
        raise FileFormatError(
            f"V has shape {V.shape}, F {F.shape} and type {F.dtype}; give floats (n, 3), integers (m, 3)."
        )
    faces, notes = surface_triangles(len(V), Runs(F.reshape(-1), F.shape[1]) if F.size else None)
    rest = {name: a for name, a in arrays.items() if name not in (*held, "units")}
    fields = {name: a for name, a in rest.items() if a.ndim and len(a) == len(V) and a.dtype.kind in "biuf"}
    if len(fields) < len(rest):
        notes = (
            *notes,
            f"arrays of another length were left out: {', '.join(sorted(rest.keys() - fields))}.",
        )
    return TriangleMesh(V, faces, fields, notes)


def read_arrays(path: Path) -> dict[str, NDArray[Any]]:
    """All arrays of an archive, none of them pickled.

    Raises
    ------
    FileFormatError
        If the file is no archive, or an array is pickled or truncated.
    """
    if not zipfile.is_zipfile(path):
        raise FileFormatError("the file is no NPZ archive, or it is truncated; write it again.")
    with zipfile.ZipFile(path) as archive:
        return {info.filename.removesuffix(".npy"): _read_array(archive, info) for info in archive.infolist()}


def _read_array(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> NDArray[Any]:
    """One array, after its shape was compared with its size."""
    with archive.open(info) as file:
        shape, dtype, start = _npy_header(file)
    if dtype.hasobject or math.prod(shape) * dtype.itemsize != info.file_size - start:
        raise FileFormatError(f"{info.filename} is pickled or not as large as its header says; write it again.")
    with archive.open(info) as file:
        return npy.read_array(file, allow_pickle=False)


def _npy_header(file: IO[bytes]) -> tuple[tuple[int, ...], np.dtype, int]:
    """Shape, type and length of the header of an array in NPY format."""
    version = npy.read_magic(file)
    with quiet():
        shape, _, dtype = npy.read_array_header_1_0(file) if version == (1, 0) else npy.read_array_header_2_0(file)
    return shape, dtype, file.tell()


def write_npz(path: Path, mesh: TriangleMesh, fields: Fields, units: Units) -> tuple[str, ...]:
    """Write V, F, every field in its own type, and what they mean as JSON in ``units``.

    Raises
    ------
    InvalidInputError
        If a field is called V, F or units.
    FileFormatError
        If the file cannot be written.
    """
    reserved = [name for name in fields if name in _RESERVED]
    if reserved:
        raise InvalidInputError(f"the field {reserved[0]!r} has a name that NPZ files reserve; rename it.")
    arrays: dict[str, NDArray[Any]] = {"V": mesh.vertices, "F": mesh.faces, **fields}
    if units:
        arrays["units"] = np.array(units_text(units))
    with replacing(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name, values in arrays.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as file:
                npy.write_array(file, values, allow_pickle=False)
    return ()
