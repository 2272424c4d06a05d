"""`rinow net`: farthest points on a surface."""

from __future__ import annotations

import time
from pathlib import Path
from typing import cast

import numpy as np

from rinow._version import __version__
from rinow.cli._arguments import Flag, Outputs
from rinow.cli._terminal import print_counts, print_json, print_notes, working
from rinow.io.mesh_files import check_outputs, read_mesh, write_result
from rinow.io.point_files import check_has_faces
from rinow.io.tables import check_tables, write_columns
from rinow.mesh import TriangleMesh
from rinow.nets.farthest_point import FarthestPointNet, farthest_point_net

__all__ = ["net"]


def net(
    mesh: Path,
    /,
    *,
    size: float | None = None,
    radius: float | None = None,
    start: int = 0,
    output: Outputs = (),
    unit: str = "length",
    json: Flag = False,
) -> None:
    """Choose vertices of a mesh that are nowhere far from the rest, by exact geodesic distances.

    Parameters
    ----------
    mesh
        Mesh file.
    size
        Number of points; give it or a radius.
    radius
        Covering radius at which to stop, in the unit of length of the file.
    start
        The first point, counted from 0.
    output
        File to write to; may be repeated.  CSV: the points in the order of their choice; any other format: the mesh
        with the fields `net_distance` and `net_label`, which PLY, VTP, VTK, NPZ and GIFTI carry.
    unit
        Name of the unit of length of the file, such as mm.
    json
        Print one JSON object instead of a table.
    """
    tables = [path for path in output if path.suffix.lower() == ".csv"]
    meshes = [path for path in output if path not in tables]
    check_outputs(meshes, inputs=[mesh])
    check_tables(tables, inputs=[mesh])
    check_has_faces(mesh, "geodesic distances need a mesh (`rinow.farthest_point_net` takes points as a MetricSpace)")
    with working(f"reading {mesh.name}"):
        surface = read_mesh(mesh)
    begin = time.perf_counter()
    with working(f"geodesic distances on {surface.n_vertices:,} vertices"):
        whole = int(size) if size is not None and size.is_integer() else size  # a type int would round without a word
        result = farthest_point_net(surface, size=cast(int | None, whole), radius=radius, start=start)
    record = {
        "size": len(result.indices),
        "covering_radius": result.covering_radius,
        "surface_radius": result.surface_radius,
        "seconds": time.perf_counter() - begin,
    }
    notes = [*surface.notes]
    for path in meshes:
        notes += _write_mesh(path, result, surface, unit)
    for path in tables:
        _write_points(path, result, surface.vertices, unit)
    if not json:
        print_counts(f"{mesh}: net by farthest points", record)
        print_notes((f"radii in {unit}; surface_radius bounds the distance inside the faces too.", *notes))
        return
    order = {"indices": result.indices.tolist(), "radii": result.radii.tolist()}
    files = {"outputs": [str(path) for path in output], "notes": notes}
    print_json({"rinow": __version__, "input": str(mesh), **record, "unit": unit, **order, **files})


def _write_mesh(path: Path, result: FarthestPointNet, surface: TriangleMesh, unit: str) -> tuple[str, ...]:
    """The mesh with the distance from the net and the nearest point of it."""
    fields = {"net_distance": result.distances, "net_label": result.labels}
    units = {
        "net_distance": f"geodesic distance from the net, unit {unit}",
        "net_label": "nearest point of the net, by its place in it; -1 off the surface",
    }
    return write_result(path, surface, fields, units, "net_distance")


def _write_points(path: Path, result: FarthestPointNet, vertices: np.ndarray, unit: str) -> None:
    """The points, and how far they reach together with those before."""
    x, y, z = vertices[result.indices].T
    columns = {"index": result.indices, "x": x, "y": y, "z": z, "covering_radius": result.radii}
    write_columns(path, columns, f"points of a net in the order of choice; positions and radii in {unit}")
