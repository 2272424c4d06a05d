"""FreeSurfer's files of surfaces and of numbers at their vertices, through nibabel."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rinow.errors import FileFormatError, InvalidInputError
from rinow.io.atomic import replacing
from rinow.io.faults import quiet
from rinow.io.fields import Fields, Units
from rinow.mesh import TriangleMesh

__all__ = ["chosen_field", "is_freesurfer", "read_curv", "read_freesurfer", "write_curv", "write_freesurfer"]

_TRIANGLES, _QUADS = b"\xff\xff\xfe", (b"\xff\xff\xff", b"\xff\xff\xfd")


def is_freesurfer(path: Path) -> bool:
    """Whether a file starts like a FreeSurfer surface of triangles; their names (lh.white) have no fixed suffix."""
    try:
        with path.open("rb") as file:
            return file.read(3) == _TRIANGLES
    except OSError:
        return False


def read_freesurfer(path: Path) -> TriangleMesh:
    """Read a FreeSurfer surface.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    mesh : TriangleMesh
        Vertices in the order of the file, in its surface coordinates (mm).

    Raises
    ------
    FileFormatError
        If the file is truncated or an index has a fault.
    """
    from nibabel.freesurfer.io import read_geometry

    quads = _check_size(path)
    with quiet("nibabel.global"):
        geometry: Any = read_geometry(str(path))
    return TriangleMesh(geometry[0], geometry[1], notes=("quadrilaterals were split into triangles.",) if quads else ())


def _check_size(path: Path) -> bool:
    """Refuse a file smaller than its header promises; say whether it holds quadrilaterals."""
    with path.open("rb") as file:
        magic = file.read(3)
        if magic in _QUADS:
            return True
        if magic != _TRIANGLES:
            raise FileFormatError(
                "the file does not start like a FreeSurfer surface; fields such as lh.curv are no surface."
            )
        file.readline()
        file.readline()
        counts = np.frombuffer(file.read(8).ljust(8, b"\0"), ">i4").astype(int)
        size = file.tell() + 12 * int(counts.sum())
    if path.stat().st_size < size or counts.min() < 0:
        raise FileFormatError(
            f"the header promises {counts[0]} vertices and {counts[1]} faces, so {size} bytes, but the file has "
            f"{path.stat().st_size}; it is truncated, copy it again."
        )
    return False


def write_freesurfer(path: Path, mesh: TriangleMesh) -> tuple[str, ...]:
    """Write the geometry in single precision."""
    from nibabel.freesurfer.io import write_geometry

    with replacing(path) as temporary:
        write_geometry(str(temporary), mesh.vertices, mesh.faces, create_stamp="created by rinow")
    return ("FreeSurfer files hold positions in single precision.",)


def read_curv(path: Path) -> TriangleMesh:
    """Refuse a file that holds no surface.

    Raises
    ------
    FileFormatError
        Always.
    """
    raise FileFormatError("a curv file holds a number per vertex and no surface; give the surface, such as lh.white.")


def chosen_field(path: Path, fields: Fields, quality: str | None) -> str:
    """The one field of a curv file: that named before the suffix (lh.mean.curv), else `quality` or the only one.

    Raises
    ------
    InvalidInputError
        If none is named, or it has several numbers per vertex.
    """
    named = path.name.split(".")[-2:-1]
    name = named[0] if named and named[0] in fields else quality
    if name is None and len(fields) == 1:
        (name,) = fields
    if name is None or fields[name].ndim > 1:
        single = ", ".join(field for field, values in fields.items() if values.ndim == 1)
        raise InvalidInputError(f"a curv file holds one number per vertex; name one of {single or 'some field'}.")
    return name


def write_curv(path: Path, mesh: TriangleMesh, fields: Fields, units: Units) -> tuple[str, ...]:
    """Write one field as FreeSurfer's tools and freeview read it, in single precision."""
    from nibabel.freesurfer.io import write_morph_data

    ((name, values),) = fields.items()
    with replacing(path) as temporary, np.errstate(over="ignore", invalid="ignore"):
        write_morph_data(str(temporary), values.astype(np.float32), fnum=mesh.n_faces)
    return (f"{path.name} holds one field, in single precision: {units.get(name, name)}.",)
