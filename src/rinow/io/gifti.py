"""GIFTI surfaces and the files of fields beside them, through nibabel."""

from __future__ import annotations

import re
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.errors import FileFormatError, InvalidInputError
from rinow.io.atomic import replacing
from rinow.io.faults import quiet, reading
from rinow.io.fields import Fields, Units, in_type_of
from rinow.mesh import TriangleMesh

__all__ = ["in_single_precision", "read_gifti", "write_gifti"]

_SUFFIX = re.compile(r"(?:\.surf)?\.gii(?:\.gz)?$", re.IGNORECASE)
_TYPES = ("u1", "i4", "f4", "f8")
_HEMISPHERES = {"lh": "CortexLeft", "left": "CortexLeft", "rh": "CortexRight", "right": "CortexRight"}
_HEMISPHERES |= {"L": "CortexLeft", "R": "CortexRight"}


def read_gifti(path: Path) -> TriangleMesh:
    """Read a GIFTI surface and the fields beside it.

    Parameters
    ----------
    path : Path
        The surface, ``stem.surf.gii``, ``stem.gii`` or either with ``.gz``.

    Returns
    -------
    mesh : TriangleMesh
        Vertices in the order of the file.  Every file ``stem.name.shape.gii`` in the same folder with one value (or
        row) per vertex is in ``vertex_data``, under the name in its metadata or else under `name`.

    Raises
    ------
    FileFormatError
        If a file is damaged or holds no surface, or an index has a fault.

    Notes
    -----
    Coordinate system transforms are not applied.  Companions of another length are reported in the notes and left out.
    """
    image = _load(path)
    arrays = [
        image.get_arrays_from_intent(intent) for intent in ("NIFTI_INTENT_POINTSET", "NIFTI_INTENT_TRIANGLE")
    ]  # fmt: skip
    if not arrays[0] or not arrays[1]:
        raise FileFormatError("the GIFTI file holds no surface (pointset and triangles); give the .surf.gii file.")
    vertices, faces = arrays[0][0].data, arrays[1][0].data
    fields: dict[str, NDArray[Any]] = {}
    notes: list[str] = []
    for companion in _companions(path):
        with reading(companion, "GIFTI"):
            array = _load(companion).darrays[0]
        if len(array.data) == len(vertices):
            fields[dict(array.meta).get("rinow_name") or _field_of(companion)] = array.data
        else:
            notes.append(
                f"{companion.name} has {len(array.data)} values for {len(vertices)} vertices and was left out."
            )
    return TriangleMesh(vertices, faces, fields, tuple(notes))


def _load(path: Path) -> Any:
    """The GIFTI image in a file."""
    from nibabel.gifti.gifti import GiftiImage

    with quiet("nibabel.global"):
        return GiftiImage.from_filename(str(path), mmap=False)


def _stem(path: Path) -> str:
    """Name of a surface file without its suffixes."""
    return _SUFFIX.sub("", path.name)


def _companions(path: Path) -> list[Path]:
    """Files of fields that belong to a surface."""
    pattern = re.compile(re.escape(_stem(path)) + r"\.[^.]+\.shape\.gii(?:\.gz)?", re.IGNORECASE)
    return sorted(file for file in path.parent.iterdir() if pattern.fullmatch(file.name))


def _field_of(companion: Path) -> str:
    """The part of the name before ``.shape.gii``."""
    return companion.name.split(".shape.")[0].rsplit(".", 1)[1]


def write_gifti(path: Path, mesh: TriangleMesh, fields: Fields, units: Units) -> tuple[str, ...]:
    """Write a GIFTI surface and one file ``stem.name.shape.gii`` per field, all of them or none.

    Parameters
    ----------
    path : Path
        The surface.
    mesh : TriangleMesh
        The surface.
    fields : mapping of str to (n_vertices, ...) ndarray
        Fields; their types are kept where nibabel has them, else they become float64.
    units : mapping of str to str
        What a field means; written into its metadata.

    Returns
    -------
    notes : tuple of str
        The files made, and a word on their precision.

    Raises
    ------
    InvalidInputError
        If the names of two fields make the same file name.
    FileFormatError
        If a file cannot be written.

    Notes
    -----
    The GIFTI standard (1.0, 2011) names uint8, int32 and float32.  nibabel also reads and writes float64, which is used
    where a number would lose digits; `in_single_precision` makes what every reader takes.  A name with a part lh, L or
    left (rh, R or right) tells the hemisphere, which Connectome Workbench asks for.
    """
    companions = {name: _companion(path, name) for name in fields}
    if len(set(companions.values())) < len(companions):
        raise InvalidInputError(f"two of the fields {', '.join(fields)} make the same file name; rename one.")
    hemisphere = _hemisphere(path)
    positions = _rounded(mesh.vertices)
    if not np.array_equal(positions, mesh.vertices, equal_nan=True):
        positions = mesh.vertices
    arrays = (positions, "NIFTI_INTENT_POINTSET", hemisphere), (mesh.faces, "NIFTI_INTENT_TRIANGLE", {})
    files = {path: _image(hemisphere, *arrays)}
    for name, file in companions.items():
        intent = "NIFTI_INTENT_SHAPE" if fields[name].ndim == 1 else "NIFTI_INTENT_VECTOR"
        meta = {"Name": name, "rinow_name": name, "Description": units.get(name, name)}
        files[file] = _image(hemisphere, (fields[name], intent, meta))
    with ExitStack() as stack:
        for file, image in files.items():
            image.to_filename(str(stack.enter_context(replacing(file))), mode="force")
    made = ", ".join(file.name for file in companions.values())
    double = any(array.data.dtype == np.float64 for image in files.values() for array in image.darrays)
    return (
        "GIFTI files hold numbers in double precision, which nibabel reads; Connectome Workbench wants float32."
        if double
        else "GIFTI files hold positions and real numbers in single precision, as the standard asks.",
        *([f"the fields are in companion files: {made}."] if made else []),
    )


def in_single_precision(mesh: TriangleMesh, fields: Fields) -> tuple[TriangleMesh, Fields]:
    """The mesh and its fields with numbers that every reader of GIFTI takes."""
    rounded = {name: _rounded(values) if values.dtype == np.float64 else values for name, values in fields.items()}
    return TriangleMesh(_rounded(mesh.vertices), mesh.faces), rounded


def _rounded(values: NDArray[Any]) -> NDArray[np.float32]:
    """The nearest numbers of single precision, infinite where there is none."""
    with np.errstate(over="ignore", invalid="ignore"):
        return values.astype(np.float32)


def _hemisphere(path: Path) -> dict[str, str]:
    """What the name of a surface says about its side, as Connectome Workbench wants to read it."""
    parts = {_HEMISPHERES[part] for part in re.split(r"[._-]", path.name) if part in _HEMISPHERES}
    return {"AnatomicalStructurePrimary": parts.pop()} if len(parts) == 1 else {}


def _companion(path: Path, name: str) -> Path:
    """The file of a field beside its surface."""
    gz = ".gz" if path.name.lower().endswith(".gz") else ""
    field = re.sub(r"[^\w-]", "_", name)
    return path.with_name(f"{_stem(path)}.{field}.shape.gii{gz}")


def _image(about: dict[str, str], *arrays: tuple[NDArray[Any], str, dict[str, str]]) -> Any:
    """A GIFTI image of arrays, each with its intent and metadata."""
    from nibabel.gifti.gifti import GiftiDataArray, GiftiImage, GiftiMetaData

    darrays = []
    for values, intent, meta in arrays:
        data = in_type_of(values, _TYPES)
        darrays.append(GiftiDataArray(data, intent=intent, datatype=data.dtype, meta=GiftiMetaData(meta)))
    return GiftiImage(meta=GiftiMetaData(about), darrays=darrays)
