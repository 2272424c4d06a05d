"""FreeSurfer's surface files, through nibabel."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rinow.errors import FileFormatError
from rinow.io.atomic import replacing
from rinow.io.faults import quiet
from rinow.mesh import TriangleMesh

__all__ = ["is_freesurfer", "read_freesurfer", "write_freesurfer"]

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
