"""`rinow curvature`: the curvature at every vertex of a mesh file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from cyclopts import Parameter

from rinow._version import __version__
from rinow.cli._terminal import print_json, print_notes, print_study, working
from rinow.errors import InvalidInputError
from rinow.io.mesh_files import check_outputs, read_mesh, write_mesh
from rinow.io.point_files import check_point_outputs, holds_points, read_cloud, write_points
from rinow.study.features import FeatureStudy, study_features
from rinow.study.points import point_counts, study_points
from rinow.study.surface import (
    PERCENTILES,
    SIGN,
    SIGNED,
    CurvatureStudy,
    SurfaceStudy,
    field_unit,
    mesh_counts,
    study_surface,
)

__all__ = ["curvature", "write_picture", "write_report"]

Field = Literal["gaussian", "mean", "k1", "k2", "shape_index", "curvedness", "spread"]
Method = Literal["auto", "sectional", "lifted", "intrinsic", "wald", "robinson", "angle_defect"]
Quality = Literal["best", "fast"]


def curvature(
    mesh: Path,
    /,
    *,
    output: Annotated[tuple[Path, ...], Parameter(name=["--output", "-o"], show_default=False)] = (),
    method: Method = "auto",
    quality: Quality = "best",
    radius: float | None = None,
    field: Field = "gaussian",
    picture: Path | None = None,
    report: Path | None = None,
    up: Literal["x", "y", "z"] = "z",
    unit: str = "length",
    json: bool = False,
) -> None:
    """Compute the curvature at every vertex of a mesh or point of a cloud, in the order of the file.

    Convex with outward normal is positive.

    Parameters
    ----------
    mesh
        Mesh file: PLY, OBJ, STL, OFF, GLB, GIFTI, FreeSurfer, VTP, VTK or NPZ.  Points without faces: PLY, NPZ, NPY, or
        text with x, y, z on each line (XYZ, CSV, TSV, TXT, DAT).
    output
        File to write the mesh and its curvature to; may be repeated.  PLY, VTP, NPZ and GIFTI carry fields; points
        are written as PLY, CSV or NPZ.
    method
        How to compute the curvature; for meshes.
    quality
        fast is several times faster and less accurate; for meshes and the methods auto and sectional.
    radius
        Scale in the unit of length of the file; by default each method chooses its own.
    field
        The scalar that becomes `quality` in PLY, and is drawn, in the report at first.
    picture
        PNG file to draw four views to.
    report
        HTML file to make: the surface and all fields, to turn and to read off in a browser, without a network.
    up
        Axis that points up in the picture and in the report.
    unit
        Name of the unit of length of the file, such as mm.
    json
        Print one JSON object instead of a table.
    """
    if holds_points(mesh):
        given = {"method": method != "auto", "quality": quality != "best", "picture": picture, "report": report}
        for option, is_given in given.items():
            if is_given:
                raise InvalidInputError(f"--{option} needs faces, and {mesh} holds points only; leave it out.")
        _curvature_of_points(mesh, output, radius, field, unit, json)
        return
    pictures, pages = [picture] if picture else [], [report] if report else []
    outputs = [*output, *pictures, *pages]
    check_outputs(outputs, inputs=[mesh], pictures=pictures, pages=pages)
    with working(f"reading {mesh.name}"):
        surface = read_mesh(mesh)
    with working(f"curvature of {surface.n_vertices:,} vertices") as progress:
        study = study_surface(surface, method=method, quality=quality, radius=radius, unit=unit, progress=progress)
    features = None
    if report:
        with working(f"creases and corners of {surface.n_vertices:,} vertices"), study.timed("features"):
            features = study_features(surface)
    notes: list[str] = []
    if not np.isfinite(study.fields(field)[field]).any():
        notes.append(f"{field} is undefined at every vertex: method {method} gives none on this mesh.")
    with study.timed("writing"):
        for path in output:
            with working(f"writing {path.name}"):
                notes += write_mesh(path, surface, study.vertex_data(field), units=study.units(), quality=field)
        if picture:
            with working(f"drawing {picture.name}"):
                write_picture(picture, study, field, title=mesh.name, up=up)
        if report:
            with working(f"writing {report.name}"):
                write_report(report, study, features, field=field, title=mesh.name, up=up)
    if json:
        print_json(_record(mesh, study, mesh_counts(surface), field, outputs, notes))
    else:
        print_study(str(mesh), study)
        print_notes(tuple(notes))


def _curvature_of_points(
    path: Path, output: tuple[Path, ...], radius: float | None, field: Field, unit: str, json: bool
) -> None:
    """The curvature at the points of a file without faces."""
    check_point_outputs(output, inputs=[path])
    with working(f"reading {path.name}"):
        points, notes = read_cloud(path)
    with working(f"curvature of {len(points):,} points"):
        study = study_points(points, radius=radius, unit=unit)
    notes = ("The file has no faces: the curvature is that of the cloud of its points.", *notes)
    with study.timed("writing"):
        for target in output:
            with working(f"writing {target.name}"):
                notes += write_points(target, points, study.vertex_data(field), study.units(), field)
    if json:
        print_json(_record(path, study, point_counts(points), field, list(output), list(notes)))
    else:
        print_study(str(path), study)
        print_notes(notes)


def write_picture(path: Path, study: SurfaceStudy, field: str, *, title: str, up: str) -> None:
    """Draw one field of a study to a PNG file."""
    from rinow.io.atomic import replacing
    from rinow.report.figures import surface_figure, write_surface_picture

    label = f"{study.units()[field].split(',')[0]}, in {field_unit(field, study.unit)}"
    figure = surface_figure(
        study.mesh.vertices,
        study.mesh.faces,
        study.fields(field)[field],
        label=label,
        signed=field in SIGNED,
        up=up,
        title=f"{title}: {study.mesh.n_vertices:,} vertices, method {study.curvature.method}",
    )
    with replacing(path) as temporary:
        write_surface_picture(temporary, figure)


def write_report(
    path: Path,
    study: SurfaceStudy,
    features: FeatureStudy | None = None,
    *,
    field: str = "gaussian",
    title: str,
    up: str,
) -> None:
    """Write a page that shows a study, to an HTML file."""
    from rinow.io.atomic import replacing
    from rinow.report.page import surface_page, write_surface_page

    page = surface_page(study, features, title=title, field=field, up=up)
    with replacing(path) as temporary:
        write_surface_page(temporary, page)


def _record(
    path: Path, study: CurvatureStudy, counts: dict[str, int], field: str, outputs: list[Path], notes: list[str]
) -> dict[str, object]:
    """What --json prints."""
    return {
        "rinow": __version__,
        "input": str(path),
        "method": study.curvature.method,
        "field": field,
        "counts": counts,
        "status": study.status_counts(),
        "units": {name: field_unit(name, study.unit) for name in study.fields()},
        "sign": SIGN,
        "percentile_levels": PERCENTILES,
        "percentiles": study.percentiles(),
        "seconds": study.seconds,
        "outputs": [str(path) for path in outputs],
        "notes": [*study.notes, *notes],
    }
