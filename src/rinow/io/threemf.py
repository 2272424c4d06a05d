"""3MF files of printers and CAD programs: meshes of XML in a ZIP archive, put together by transforms."""

from __future__ import annotations

import posixpath
import zipfile
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from rinow.errors import FileFormatError, InvalidMeshError
from rinow.io.atomic import replacing
from rinow.mesh import TriangleMesh

__all__ = ["read_3mf", "write_3mf"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
TYPES = "http://schemas.openxmlformats.org/package/2006/content-types"
MODEL_TYPE = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"

DEEPEST = 64
"""Objects of objects of objects: more than any file needs, so that one that contains itself is known."""


def read_3mf(path: Path) -> TriangleMesh:
    """Read all parts of a 3MF file as one mesh.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    mesh : TriangleMesh
        The parts in the order in which the file builds them, each moved to its place; vertices are not merged.

    Raises
    ------
    FileFormatError
        If the archive has no model, a part is missing or an index has a fault.
    InvalidMeshError
        If no part has a triangle.
    """
    if not zipfile.is_zipfile(path):
        raise FileFormatError("the file is no 3MF archive, or it is truncated; export it again.")
    with zipfile.ZipFile(path) as archive:
        models = _Models(archive)
        root = models.root
        items = [(item.get("objectid", ""), _matrix(item)) for item in models[root].iterfind("{*}build/{*}item")]
        if not items:
            objects = models[root].iterfind("{*}resources/{*}object")
            items = [(item.get("id", ""), np.eye(4)) for item in objects if item.find("{*}mesh") is not None]
        parts = [part for name, matrix in items for part in models.parts(root, name, matrix)]
        unit = models[root].get("unit", "millimeter")
    if not any(len(faces) for _, faces in parts):
        raise InvalidMeshError("no part has a triangle; for a point cloud use point_cloud_curvature.")
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in parts)])
    notes = [f"the file gives its unit of length as {unit}."]
    if len(parts) > 1:
        notes.append(f"the {len(parts)} parts were joined into one mesh; vertices on their seams were not merged.")
    return TriangleMesh(
        np.concatenate([vertices for vertices, _ in parts]),
        np.concatenate([faces + start for start, (_, faces) in zip(starts, parts, strict=False)]),
        notes=tuple(notes),
    )


class _Models:
    """The model files of an archive, each parsed once."""

    def __init__(self, archive: zipfile.ZipFile) -> None:
        self._archive = archive
        self._parsed: dict[str, ElementTree.Element] = {}
        names = archive.namelist()
        targets = ["3D/3dmodel.model", *(name for name in names if name.endswith(".model"))]
        if "_rels/.rels" in names:
            relations = ElementTree.fromstring(archive.read("_rels/.rels"))
            targets[:0] = [r.get("Target", "").lstrip("/") for r in relations if r.get("Type") == MODEL_TYPE]
        found = [name for name in targets if name in names]
        if not found:
            raise FileFormatError("the archive has no model; export it again.")
        self.root = found[0]

    def __getitem__(self, name: str) -> ElementTree.Element:
        if name not in self._parsed:
            if name not in self._archive.namelist():
                raise FileFormatError(f"the archive has no part {name}, which an object names; export it again.")
            self._parsed[name] = ElementTree.fromstring(self._archive.read(name))
        return self._parsed[name]

    def parts(self, file: str, name: str, matrix: Floats, depth: int = 0) -> Iterator[tuple[Floats, Indices]]:
        """Vertices and faces of an object and of the objects it is made of, in their places."""
        found = [item for item in self[file].iterfind("{*}resources/{*}object") if item.get("id") == name]
        if not found or depth > DEEPEST:
            fault = "contains itself" if found else "is not there"
            raise FileFormatError(f"the object {name} of {file} {fault}; export the file again.")
        mesh = found[0].find("{*}mesh")
        if mesh is not None:
            vertices = np.array([_numbers(v, "xyz") for v in mesh.iterfind("{*}vertices/{*}vertex")], np.float64)
            corners = [_numbers(t, ("v1", "v2", "v3")) for t in mesh.iterfind("{*}triangles/{*}triangle")]
            faces = np.array(corners, np.intp).reshape(-1, 3)
            if faces.size and not (0 <= faces.min() and faces.max() < len(vertices)):
                raise FileFormatError(
                    f"the object {name} names a vertex outside 0..{len(vertices) - 1}; export it again."
                )
            vertices = vertices.reshape(-1, 3)
            still = np.array_equal(matrix, np.eye(4))
            yield vertices if still else vertices @ matrix[:3, :3] + matrix[3, :3], faces
        for component in found[0].iterfind("{*}components/{*}component"):
            other = next((value for key, value in component.items() if key.endswith("}path")), "/" + file)
            place = posixpath.normpath(other).lstrip("/")
            yield from self.parts(place, component.get("objectid", ""), _matrix(component) @ matrix, depth + 1)


def _numbers(element: ElementTree.Element, names: str | tuple[str, ...]) -> list[float]:
    """Attributes that are numbers."""
    return [float(element.get(name, "")) for name in names]


def _matrix(element: ElementTree.Element) -> Floats:
    """The transform of an element, which acts on rows from the right."""
    matrix = np.eye(4)
    if text := element.get("transform"):
        matrix[:, :3] = np.array(text.split(), np.float64).reshape(4, 3)
    return matrix


def write_3mf(path: Path, mesh: TriangleMesh) -> tuple[str, ...]:
    """Write the geometry, in double precision.

    Raises
    ------
    FileFormatError
        If a position is not finite, which 3MF forbids.
    """
    if not mesh.vertex_is_finite.all():
        raise FileFormatError(f"{path}: 3MF cannot hold positions that are not finite; write PLY instead.")
    vertices = "".join(f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in mesh.vertices.tolist())
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in mesh.faces.tolist())
    model = (
        f'<model unit="millimeter" xmlns="{CORE}"><resources><object id="1" type="model"><mesh>'
        f"<vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object></resources>"
        '<build><item objectid="1"/></build></model>'
    )
    relations = (
        f'<Relationships xmlns="{RELATIONS}"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="{MODEL_TYPE}"/>'
        "</Relationships>"
    )
    types = (
        f'<Types xmlns="{TYPES}">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
    )
    files = {"[Content_Types].xml": types, "_rels/.rels": relations, "3D/3dmodel.model": model}
    with replacing(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            archive.writestr(name, '<?xml version="1.0" encoding="UTF-8"?>\n' + text)
    return ("3MF files name a unit of length; this one says millimeter.",)
