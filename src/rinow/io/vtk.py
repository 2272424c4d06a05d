"""VTK's polygon files through pyvista, which is the extra `vtk`: XML (.vtp), and legacy (.vtk) for writing."""

from __future__ import annotations

import re
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from rinow.errors import FileFormatError, MissingDependencyError
from rinow.io.atomic import replacing
from rinow.io.fields import Fields, Units, units_text
from rinow.io.polygons import Runs, runs_of_offsets, surface_triangles
from rinow.mesh import TriangleMesh

__all__ = ["read_vtp", "write_vtk"]

_HARMLESS = re.compile("ERROR: In|Warning: In|.*minor version|.*InformationKey")
"""Heads of messages, newer files, and ranges of arrays that are nan."""


def read_vtp(path: Path) -> TriangleMesh:
    """Read an XML file of type PolyData.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    mesh : TriangleMesh
        Points in the order of the file; the point data are in ``vertex_data`` under their names.

    Raises
    ------
    FileFormatError
        If VTK finds a fault, or the file holds no PolyData.
    InvalidMeshError
        If it has no polygon.
    MissingDependencyError
        If pyvista is not installed.
    """
    pyvista = _pyvista()
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader  # pyvista.read would log faults and configure logging

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    with _vtk_faults() as faults:
        reader.Update()
        if found := faults():
            raise FileFormatError(f"VTK says {found[0]!r}; the file is damaged or no PolyData, export it again.")
    data = pyvista.wrap(reader.GetOutput())
    points = np.asarray(data.points)
    faces, notes = surface_triangles(len(points), _cells(data.GetPolys()), _cells(data.GetStrips()))
    fields = {name: np.array(values) for name, values in data.point_data.items() if values.dtype.kind in "biuf"}
    return TriangleMesh(points, faces, fields, notes)


def _cells(cells: Any) -> Runs:
    """Corners of all cells."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    return runs_of_offsets(vtk_to_numpy(cells.GetConnectivityArray()), vtk_to_numpy(cells.GetOffsetsArray()))


def write_vtk(path: Path, mesh: TriangleMesh, fields: Fields, units: Units) -> tuple[str, ...]:
    """Write points in double precision, every field in its own type, and what they mean as JSON in the field data.

    Raises
    ------
    MissingDependencyError
        If pyvista is not installed.
    FileFormatError
        If the file cannot be written.
    """
    pyvista = _pyvista()
    data = pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.faces)
    for name, values in fields.items():
        flat = values if values.ndim < 3 else values.reshape(len(values), -1)
        data.point_data[name] = flat.astype(np.uint8) if flat.dtype.kind == "b" else flat
    if units:
        data.field_data["rinow_units"] = [units_text(units)]
    with replacing(path) as temporary, _vtk_faults() as faults:
        data.save(str(temporary))
        if found := faults():
            raise FileFormatError(f"{path}: VTK says {found[0]!r}; choose another folder or format.")
    return ()


def _pyvista() -> Any:
    """The module pyvista."""
    try:
        import pyvista
    except ImportError as error:
        raise MissingDependencyError('VTP and VTK files need pyvista: pip install "rinow[vtk]".') from error
    return pyvista


@contextmanager
def _vtk_faults() -> Generator[Callable[[], list[str]]]:
    """Collect what VTK would print on stderr: it goes on after most faults and returns what it has."""
    from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow

    before, verbosity = vtkOutputWindow.GetInstance(), vtkLogger.GetCurrentVerbosityCutoff()
    window = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(window)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)

    def faults() -> list[str]:
        lines = [re.sub(r"\(0x\w+\)", "", line).strip() for line in window.GetOutput().splitlines()]
        return [line for line in lines if line and not _HARMLESS.match(line)]

    try:
        yield faults
    finally:
        vtkOutputWindow.SetInstance(before)
        vtkLogger.SetStderrVerbosity(verbosity)
