"""`rinow info`: what a mesh file holds and what is wrong with it."""

from __future__ import annotations

from pathlib import Path

from rinow.cli._terminal import print_counts, print_json, print_notes, working
from rinow.io.mesh_files import read_mesh
from rinow.study.surface import mesh_counts

__all__ = ["info"]


def info(mesh: Path, /, *, json: bool = False) -> None:
    """Count the parts and the faults of a mesh.

    Parameters
    ----------
    mesh
        Mesh file.
    json
        Print one JSON object instead of a table.
    """
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
