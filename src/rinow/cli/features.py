"""`rinow features`: cone points, creases and corners of a mesh file."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Literal

from rinow._version import __version__
from rinow.cli._arguments import Flag, Outputs
from rinow.cli._terminal import console, print_json, print_notes, working
from rinow.io.mesh_files import check_outputs, read_mesh, write_result
from rinow.io.point_files import check_has_faces
from rinow.study.features import FIELDS, FeatureStudy, study_features
from rinow.study.surface import mesh_counts

__all__ = ["features"]


def features(
    mesh: Path,
    /,
    *,
    output: Outputs = (),
    picture: Path | None = None,
    up: Literal["x", "y", "z"] = "z",
    json: Flag = False,
) -> None:
    """Find the cone points, creases and corners of a mesh.

    Angles are in radians in files and JSON and in degrees in the table; convex is positive.

    Parameters
    ----------
    mesh
        Mesh file: PLY, OBJ, STL, OFF, GLB, 3MF, GIFTI, FreeSurfer, VTP, VTK or NPZ.
    output
        File to write the mesh and its features to; may be repeated.  PLY, VTP, VTK, NPZ and GIFTI carry fields.
    picture
        PNG file to draw four views to.
    up
        Axis that points up in the picture.
    json
        Print one JSON object instead of a table.
    """
    outputs = [*output, *([picture] if picture else [])]
    check_outputs(outputs, inputs=[mesh], pictures=[picture] if picture else [])
    check_has_faces(mesh, "creases are found on a mesh")
    with working(f"reading {mesh.name}"):
        surface = read_mesh(mesh)
    with working(f"features of {surface.n_vertices:,} vertices"):
        start = time.perf_counter()
        study = study_features(surface)
        seconds = time.perf_counter() - start
    notes = list(study.notes)
    for path in output:
        with working(f"writing {path.name}"):
            notes += write_result(path, surface, study.vertex_data(), FIELDS, "crease_angle")
    if picture:
        with working(f"drawing {picture.name}"):
            _write_picture(picture, study, title=mesh.name, up=up)
    if json:
        print_json(_record(mesh, study, seconds, outputs, notes))
    else:
        _print(str(mesh), study, seconds)
        print_notes(tuple(notes))


def _write_picture(path: Path, study: FeatureStudy, *, title: str, up: str) -> None:
    """The surface in the colours of the mean angle of the creases at each vertex."""
    from rinow.io.atomic import replacing
    from rinow.report.figures import surface_figure, write_surface_picture

    counts = study.counts()
    figure = surface_figure(
        study.mesh.vertices,
        study.mesh.faces,
        study.vertex_data()["crease_angle"],
        label="mean angle of the creases at a vertex, in radians, convex positive",
        up=up,
        title=f"{title}: {counts['crease_edges']:,} crease edges, {counts['corners']:,} corners",
    )
    with replacing(path) as temporary:
        write_surface_picture(temporary, figure)


def _record(
    mesh: Path, study: FeatureStudy, seconds: float, outputs: list[Path], notes: list[str]
) -> dict[str, object]:
    """What --json prints."""
    found = study.features
    return {
        "rinow": __version__,
        "input": str(mesh),
        "counts": mesh_counts(study.mesh),
        "features": study.counts(),
        "units": FIELDS,
        "sign": "convex is positive",
        "cone_points": found.cone_points.tolist(),
        "cone_angles": found.cone_angles.tolist(),
        "crease_edges": found.crease_edges.tolist(),
        "crease_angles": found.crease_angles.tolist(),
        "crease_errors": found.crease_errors.tolist(),
        "crease_exponents": found.crease_exponents.tolist(),
        "corners": found.corners.tolist(),
        "seconds": {"features": seconds},
        "outputs": [str(path) for path in outputs],
        "notes": notes,
    }


def _print(title: str, study: FeatureStudy, seconds: float) -> None:
    """Numbers and angles of the features."""
    from rich.table import Table

    table = Table(title=title)
    table.add_column("feature")
    table.add_column("number", justify="right")
    for name in ("least", "median", "greatest"):
        table.add_column(name, justify="right")
    for name, (number, levels) in study.table().items():
        table.add_row(name, f"{number:,}", *(f"{level:.1f}°" for level in levels))
    out = console()
    out.print(table)
    out.print(f"length of all creases {study.crease_length:.6g}; features {seconds:.2f} s", highlight=False)
