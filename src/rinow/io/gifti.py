"""GIFTI surfaces and the files of fields beside them, through nibabel."""

from __future__ import annotations

import re
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from rinow.errors import FileFormatError, InvalidInputError
from rinow.io.atomic import replacing
from rinow.io.faults import quiet, reading
from rinow.io.fields import Fields, Units, in_type_of
from rinow.mesh import TriangleMesh

__all__ = ["read_gifti", "write_gifti"]

_SUFFIX = re.compile(r"(?:\.surf)?\.gii(?:\.gz)?$", re.IGNORECASE)
_TYPES = ("u1", "i4", "f4", "f8")


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
        Fields; their types are kept where GIFTI has them, else they become float64.
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
    The GIFTI standard (1.0, 2011) names uint8, int32 and float32; nibabel also reads and writes float64, which is used
    here so that no digit is lost.
    """
    companions = {name: _companion(path, name) for name in fields}
    if len(set(companions.values())) < len(companions):
        raise InvalidInputError(f"two of the fields {', '.join(fields)} make the same file name; rename one.")
    files = {path: _image((mesh.vertices, "NIFTI_INTENT_POINTSET", {}), (mesh.faces, "NIFTI_INTENT_TRIANGLE", {}))}
    for name, file in companions.items():
        intent = "NIFTI_INTENT_SHAPE" if fields[name].ndim == 1 else "NIFTI_INTENT_VECTOR"
        files[file] = _image(
            (fields[name], intent, {"Name": name, "rinow_name": name, "Description": units.get(name, name)})
        )
    with ExitStack() as stack:
        for file, image in files.items():
            image.to_filename(str(stack.enter_context(replacing(file))), mode="force")
    made = ", ".join(file.name for file in companions.values())
    return (
        "GIFTI files hold positions and fields in double precision, which nibabel reads; the standard asks for single.",
        *([f"the fields are in companion files: {made}."] if made else []),
    )


def _companion(path: Path, name: str) -> Path:
    """The file of a field beside its surface."""
    gz = ".gz" if path.name.lower().endswith(".gz") else ""
    field = re.sub(r"[^\w-]", "_", name)
    return path.with_name(f"{_stem(path)}.{field}.shape.gii{gz}")


def _image(*arrays: tuple[NDArray[Any], str, dict[str, str]]) -> Any:
    """A GIFTI image of arrays, each with its intent and metadata."""
    from nibabel.gifti.gifti import GiftiDataArray, GiftiImage, GiftiMetaData

    darrays = []
    for values, intent, meta in arrays:
        data = in_type_of(values, _TYPES)
        darrays.append(GiftiDataArray(data, intent=intent, datatype=data.dtype, meta=GiftiMetaData(meta)))
    return GiftiImage(darrays=darrays)
