"""`rinow net`: farthest points on a surface or of a metric space."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from rinow._version import __version__
from rinow.cli._arguments import Flag, Outputs
from rinow.cli._terminal import print_counts, print_json, print_notes, working
from rinow.errors import naming
from rinow.io.distance_tables import read_distances
from rinow.io.mesh_files import check_outputs, read_mesh, write_result
from rinow.io.point_files import check_has_faces
from rinow.io.tables import check_tables, write_columns
from rinow.mesh import TriangleMesh
from rinow.metric_space import MetricSpace
from rinow.nets.farthest_point import FarthestPointNet, farthest_point_net

__all__ = ["net"]


def net(
    mesh: Path,
    /,
    *,
    size: float | None = None,
    radius: float | None = None,
    start: int = 0,
    distances: Flag = False,
    rtol: float = 1e-9,
    output: Outputs = (),
    unit: str = "length",
    json: Flag = False,
) -> None:
    """Choose vertices of a mesh that are nowhere far from the rest, by exact geodesic distances, or points by theirs.

    Parameters
    ----------
    mesh
        Mesh file; with --distances a square matrix as text, NPY or NPZ.
    size
        Number of points; give it or a radius.
    radius
        Covering radius at which to stop, in the unit of length of the file.
    start
        The first point, counted from 0.
    distances
        The file holds all distances of some points; outputs are CSV or NPZ tables of the points chosen.
    rtol
        Distances: how much the axioms of a metric may be broken, relative to the largest one.
    output
        File to write to; may be repeated.  CSV: the points in the order of their choice; any other format: the mesh
        with the fields `net_distance` and `net_label`, which PLY, VTP, VTK, NPZ and GIFTI carry.
    unit
        Name of the unit of length of the file, such as mm.
    json
        Print one JSON object instead of a table.
    """
    tables = [path for path in output if distances or path.suffix.lower() == ".csv"]
    meshes = [path for path in output if path not in tables]
    check_outputs(meshes, inputs=[mesh])
    check_tables(tables, inputs=[mesh])
    if not distances:
        cure = "geodesic distances need a mesh; add --distances if it holds a matrix of distances"
        check_has_faces(mesh, cure + " (`rinow.farthest_point_net` takes points as a MetricSpace)")
    with working(f"reading {mesh.name}"):
        space, columns = _space_of(mesh, rtol) if distances else _surface_of(mesh)
    begin = time.perf_counter()
    with working("distances of the points" if distances else "geodesic distances on the surface"):
        whole = int(size) if size is not None and size.is_integer() else size  # a type int would round without a word
        result = farthest_point_net(space, size=cast(int | None, whole), radius=radius, start=start)
    record = {
        "size": len(result.indices),
        "covering_radius": result.covering_radius,
        **({} if distances else {"surface_radius": result.surface_radius}),
        "seconds": time.perf_counter() - begin,
    }
    notes = list(space.notes) if isinstance(space, TriangleMesh) else []
    for path in meshes:
        notes += _write_mesh(path, result, cast(TriangleMesh, space), unit)
    for path in tables:
        chosen = {name: values[result.indices] for name, values in columns.items()}
        table = {"index": result.indices, **chosen, "covering_radius": result.radii}
        write_columns(path, table, f"points of a net in the order of choice; positions and radii in {unit}")
    if not json:
        print_counts(f"{mesh}: net by farthest points", record)
        inside = "" if distances else "; surface_radius bounds the distance inside the faces too"
        print_notes((f"radii in {unit}{inside}.", *notes))
        return
    order = {"indices": result.indices.tolist(), "radii": result.radii.tolist()}
    files = {"outputs": [str(path) for path in output], "notes": notes}
    print_json({"rinow": __version__, "input": str(mesh), **record, "unit": unit, **order, **files})


Columns = dict[str, NDArray[Any]]
"""What a table says of each point, beside its number."""


def _space_of(path: Path, rtol: float) -> tuple[MetricSpace, Columns]:
    """The space of a table of distances, with the labels of its points."""
    with naming(str(path)):
        matrix, labels = read_distances(path)
        return MetricSpace(matrix, rtol=rtol), {"label": np.array(labels)} if labels else {}


def _surface_of(path: Path) -> tuple[TriangleMesh, Columns]:
    """The surface of a mesh file, with the positions of its vertices."""
    surface = read_mesh(path)
    return surface, dict(zip("xyz", surface.vertices.T, strict=True))


def _write_mesh(path: Path, result: FarthestPointNet, surface: TriangleMesh, unit: str) -> tuple[str, ...]:
    """The mesh with the distance from the net and the nearest point of it."""
    fields = {"net_distance": result.distances, "net_label": result.labels}
    units = {
        "net_distance": f"geodesic distance from the net, unit {unit}",
        "net_label": "nearest point of the net, by its place in it; -1 off the surface",
    }
    return write_result(path, surface, fields, units, "net_distance")
