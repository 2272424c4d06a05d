"""Mesh files: the suffix of a name decides the format."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from rinow.errors import FileFormatError, InvalidInputError
from rinow.io.atomic import check_targets
from rinow.io.faults import reading, writing
from rinow.io.fields import VTK_NAMES, checked_fields, renamed
from rinow.io.freesurfer import (
    chosen_field,
    is_freesurfer,
    read_curv,
    read_freesurfer,
    write_curv,
    write_freesurfer,
)
from rinow.io.gifti import in_single_precision, read_gifti, write_gifti
from rinow.io.glb import read_glb, write_glb
from rinow.io.npz import read_npz, write_npz
from rinow.io.obj import read_obj, write_obj
from rinow.io.off import read_off, write_off
from rinow.io.ply import read_ply, write_ply
from rinow.io.stl import read_stl_mesh, write_stl
from rinow.io.threemf import read_3mf, write_3mf
from rinow.io.vtk import read_vtp, write_vtk
from rinow.io.vtk_legacy import read_legacy_vtk
from rinow.mesh import TriangleMesh, as_triangle_mesh

__all__ = ["check_outputs", "demo_mesh", "read_mesh", "write_mesh", "write_result"]

PathLike = str | os.PathLike[str]


@dataclass(frozen=True, slots=True)
class _Format:
    """A file format: how it is read and written, and what its fields are called."""

    name: str
    read: Callable[[Path], TriangleMesh]
    write: Callable[..., tuple[str, ...]]
    has_fields: bool = False
    names: Mapping[str, str] = field(default_factory=dict)


_PLY = _Format("PLY", read_ply, write_ply, has_fields=True)
_GIFTI = _Format("GIFTI", read_gifti, write_gifti, has_fields=True)
_FREESURFER = _Format("FreeSurfer", read_freesurfer, write_freesurfer)
_CURV = _Format("curv", read_curv, write_curv, has_fields=True)

_FORMATS = {
    ".ply": _PLY,
    ".obj": _Format("OBJ", read_obj, write_obj),
    ".stl": _Format("STL", read_stl_mesh, write_stl),
    ".off": _Format("OFF", read_off, write_off),
    ".glb": _Format("GLB", read_glb, write_glb),
    ".3mf": _Format("3MF", read_3mf, write_3mf),
    ".npz": _Format("NPZ", read_npz, write_npz, has_fields=True),
    ".vtp": _Format("VTP", read_vtp, write_vtk, has_fields=True, names=VTK_NAMES),
    ".vtk": _Format("VTK", read_legacy_vtk, write_vtk, has_fields=True, names=VTK_NAMES),
    ".gii": _GIFTI,
    ".gii.gz": _GIFTI,
    **dict.fromkeys((".white", ".pial", ".inflated", ".sphere", ".orig", ".smoothwm"), _FREESURFER),
    ".curv": _CURV,
}

GRAPHS = (".graphml", ".gml", ".gexf", ".edges", ".edgelist")
"""Suffixes of graphs, which are no meshes."""


def read_mesh(path: PathLike) -> TriangleMesh:
    """Read a triangle mesh from a file.

    Parameters
    ----------
    path : path
        A file whose suffix is, in any case, .ply, .obj, .stl, .off, .glb, .3mf, .npz, .vtp, .vtk (PolyData), .gii,
        .gii.gz or a name of FreeSurfer's surfaces (.white, .pial, .inflated, .sphere, .orig, .smoothwm; other names are
        known by their first bytes).

    Returns
    -------
    mesh : TriangleMesh
        Vertices in the number and the order of the file, whether faces use them or not, in its unit of length; only
        STL, which has no vertices but separate triangles, is welded (`rinow.io.stl.read_stl` gives the map).
        Positions with nan or inf are kept.  ``vertex_data`` holds the fields of PLY, NPZ, VTP, VTK and GIFTI files
        under the names of the file; ``notes`` says what had to be done, such as splitting polygons into triangles.

    Raises
    ------
    FileFormatError
        If the file is missing, empty, truncated or damaged, names a vertex that is not there, or has an unknown suffix.
    InvalidMeshError
        If the file has no face; for a point cloud use `point_cloud_curvature`.
    MissingDependencyError
        If the file is a .vtp and pyvista is not installed.

    See Also
    --------
    write_mesh

    Notes
    -----
    The cost is O(n_vertices + n_faces), for STL O(n_faces log n_faces).  The size of a file is compared with what its
    header promises before memory is taken.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp(), "tetrahedron.off")
    >>> _ = file.write_text("OFF 4 4 0  0 0 0  1 0 0  0 1 0  0 0 1".replace("  ", chr(10)) + '''
    ... 3 0 2 1
    ... 3 0 1 3
    ... 3 1 2 3
    ... 3 2 0 3''')
    >>> mesh = read_mesh(file)
    >>> mesh.n_vertices, mesh.n_faces
    (4, 4)
    """
    file = Path(path)
    form = _format_of(file, sniff=True)
    with reading(file, form.name):
        return form.read(file)


def write_mesh(
    path: PathLike,
    mesh: Any,
    vertex_data: Mapping[str, ArrayLike] | None = None,
    *,
    units: Mapping[str, str] | None = None,
    quality: str | None = None,
) -> tuple[str, ...]:
    """Write a triangle mesh to a file, whole or not at all.

    Parameters
    ----------
    path : path
        A file with a suffix that `read_mesh` knows, or .curv; an existing one is replaced.
    mesh : TriangleMesh, (V, F) pair or object with vertices and faces
        The surface.
    vertex_data : mapping of str to (n_vertices, ...) array_like of float or int, optional
        Fields to write; by default those of the mesh.
    units : mapping of str to str, optional
        What each field means (quantity, unit, sign); written beside the fields.
    quality : str, optional
        Name of the field that PLY files call ``quality``, as MeshLab expects, and that a .curv file holds.

    Returns
    -------
    notes : tuple of str
        What the format could not carry, one sentence each.

    Raises
    ------
    FileFormatError
        If the suffix is unknown or the file cannot be written.
    InvalidInputError
        If a field has a wrong length, type or name.
    MissingDependencyError
        If the file is a .vtp or .vtk and pyvista is not installed.

    See Also
    --------
    read_mesh

    Notes
    -----
    PLY (binary, positions and real fields in double precision), VTP, VTK, NPZ and GIFTI (one companion file
    ``stem.field.shape.gii`` for each field) keep every field and every bit, nan included.  In VTP and VTK the fields
    gaussian, mean, k1 and k2 are called Gauss_Curvature, Mean_Curvature, Maximum_Curvature and Minimum_Curvature, as
    by VTK itself.  OBJ, OFF and 3MF keep the geometry only; STL, GLB and FreeSurfer files keep it in single precision.
    FreeSurfer's .curv files hold one field: that named before the suffix (``lh.mean.curv``), else `quality`.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp(), "triangle.ply")
    >>> triangle = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> write_mesh(file, triangle, {"height": [0.1, float("nan"), 0.3]}, units={"height": "height in m"})
    ()
    >>> read_mesh(file).vertex_data["height"]
    array([0.1, nan, 0.3])
    """
    file = Path(path)
    form = _format_of(file)
    surface = as_triangle_mesh(mesh)
    fields = checked_fields(surface.vertex_data if vertex_data is None else vertex_data, surface.n_vertices)
    if quality is not None and quality not in fields:
        raise InvalidInputError(f"quality = {quality!r} is not one of the fields {', '.join(fields) or '(none)'}.")
    if form is _CURV:
        chosen = chosen_field(file, fields, quality)
        fields = {chosen: fields[chosen]}
    names = {quality: "quality"} if form is _PLY and quality is not None else form.names
    meanings = {name: text for name, text in (units or {}).items() if name in fields}
    with writing(file, form.name):
        if form.has_fields:
            return form.write(file, surface, renamed(fields, names), renamed(meanings, names))
        notes = form.write(file, surface)
    if fields:
        left_out = (
            f"{form.name} holds geometry only; left out: {', '.join(fields)} (PLY, NPZ, GIFTI, VTP, VTK keep fields)."
        )
        notes = (left_out, *notes)
    return notes


def write_result(
    path: PathLike, mesh: TriangleMesh, vertex_data: Mapping[str, ArrayLike], units: Mapping[str, str], quality: str
) -> tuple[str, ...]:
    """As `write_mesh`, but so that other programs read it: GIFTI in single precision, as its standard has it."""
    if _format_of(Path(path)) is _GIFTI:
        mesh, vertex_data = in_single_precision(mesh, checked_fields(vertex_data, mesh.n_vertices))
    return write_mesh(path, mesh, vertex_data, units=units, quality=quality)


def check_outputs(
    outputs: Iterable[PathLike],
    *,
    inputs: Iterable[PathLike] = (),
    pictures: Iterable[PathLike] = (),
    pages: Iterable[PathLike] = (),
) -> None:
    """Refuse output files that could not be written later, before any work is done.

    Parameters
    ----------
    outputs : paths
        Files to be written.
    inputs : paths, optional
        Files to be read; none of them is overwritten.
    pictures : paths, optional
        Those outputs that are pictures, not meshes.
    pages : paths, optional
        Those outputs that are pages for a browser.

    Raises
    ------
    FileFormatError
        If an output is an input, occurs twice, has a wrong suffix (pictures: .png, pages: .html), or cannot be
        made where it is.
    """
    suffixes = {os.path.realpath(path): (".png", "pictures") for path in pictures}
    suffixes |= {os.path.realpath(path): (".html", "reports") for path in pages}
    targets = list(outputs)
    check_targets(targets, inputs)
    for output in targets:
        place = os.path.realpath(output)
        suffix, kind = suffixes.get(place, ("", "meshes"))
        if kind == "meshes":
            _format_of(Path(output))
        elif not place.lower().endswith(suffix):
            raise FileFormatError(f"{output} has not the suffix {suffix}, the one of {kind}; choose another name.")


def demo_mesh() -> TriangleMesh:
    """The mesh that comes with the package: Spot the cow, by Keenan Crane (CC0), 2930 vertices.

    Examples
    --------
    >>> demo_mesh().n_vertices
    2930
    """
    with resources.as_file(resources.files("rinow.io") / "_assets" / "spot.ply") as path:
        return read_mesh(path)


def _format_of(path: Path, *, sniff: bool = False) -> _Format:
    """The format that the suffix of a name means; FreeSurfer surfaces may also be known by their first bytes."""
    name = path.name.lower()
    for suffix, form in _FORMATS.items():
        if name.endswith(suffix):
            return form
    if sniff and os.path.isfile(path) and is_freesurfer(path):
        return _FREESURFER
    if sniff and not os.path.exists(path):
        raise FileFormatError(f"{path}: there is no such file; check the name and the folder.")
    if os.path.isdir(path):
        raise FileFormatError(f"{path} is a folder; give the name of a mesh file.")
    if sniff and os.path.isfile(path) and not os.path.getsize(path):
        raise FileFormatError(f"{path}: the file is empty; export it again.")
    if sniff and name.endswith(GRAPHS):
        raise FileFormatError(f"{path} holds a graph, no mesh; rinow graph computes the curvature of a graph.")
    cure = "convert the mesh to PLY" if sniff else "choose one of these"
    raise FileFormatError(f"{path} has no suffix of a known mesh format ({' '.join(_FORMATS)}); {cure}.")
