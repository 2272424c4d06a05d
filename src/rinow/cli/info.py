"""`rinow info`: what a file of a mesh or of points holds and what is wrong with it."""

from __future__ import annotations

from pathlib import Path

from rinow.cli._arguments import Flag
from rinow.cli._terminal import print_counts, print_json, print_notes, working
from rinow.io.mesh_files import read_mesh
from rinow.io.point_files import holds_points, read_cloud
from rinow.study.points import point_counts
from rinow.study.surface import mesh_counts

__all__ = ["info"]


def info(mesh: Path, /, *, json: Flag = False) -> None:
    """Count the parts and the faults of a mesh, or of points without faces.

    Parameters
    ----------
    mesh
        Mesh file, or points as for `rinow curvature`.
    json
        Print one JSON object instead of a table.
    """
    if holds_points(mesh):
        _info_of_points(mesh, json)
        return
    with working("reading"):
        surface = read_mesh(mesh)
        record = {
            **mesh_counts(surface),
            "bounding_box_diagonal": surface.diagonal,
            "mean_edge_length": surface.mean_edge_length,
            "area": float(surface.face_areas[surface.topology.face_used].sum()),
        }
    fields = sorted(surface.vertex_data)
    if json:
        print_json({"input": str(mesh), **record, "fields": fields, "notes": surface.notes})
        return
    print_counts(str(mesh), record)
    print_notes((*surface.notes, f"fields: {', '.join(fields) or 'none'}."))


def _info_of_points(path: Path, json: bool) -> None:
    with working("reading"):
        points, notes = read_cloud(path)
    notes = ("The file has no faces: it holds a cloud of points.", *notes)
    if json:
        print_json({"input": str(path), **point_counts(points), "notes": notes})
        return
    print_counts(str(path), point_counts(points))
    print_notes(notes)
