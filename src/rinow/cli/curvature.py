"""`rinow curvature`: the curvature at every vertex of a mesh file."""

from __future__ import annotations

from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from rinow._version import __version__
from rinow.cli._arguments import Flag, Outputs
from rinow.cli._terminal import print_json, print_notes, print_study, working
from rinow.errors import InvalidInputError, naming
from rinow.io.distance_tables import read_distances
from rinow.io.mesh_files import check_outputs, read_mesh, write_result
from rinow.io.point_files import check_point_outputs, holds_points, read_cloud, write_points
from rinow.io.tables import check_tables, write_columns
from rinow.metric_space import MetricSpace
from rinow.study.features import FeatureStudy, study_features
from rinow.study.points import PointStudy, point_counts, study_points
from rinow.study.spaces import study_space
from rinow.study.surface import (
    PERCENTILES,
    SIGN,
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
    output: Outputs = (),
    method: Method = "auto",
    quality: Quality = "best",
    radius: float | None = None,
    distances: Flag = False,
    rtol: float = 1e-9,
    field: Field = "gaussian",
    picture: Path | None = None,
    report: Path | None = None,
    up: Literal["x", "y", "z"] = "z",
    unit: str = "length",
    json: Flag = False,
) -> None:
    """Compute the curvature at every vertex of a mesh or point of a cloud or metric space, in the order of the file.

    Convex with outward normal is positive.

    Parameters
    ----------
    mesh
        Mesh file: PLY, OBJ, STL, OFF, GLB, 3MF, GIFTI, FreeSurfer, VTP, VTK or NPZ.  Points without faces: PLY, NPZ,
        NPY, or text with x, y, z on each line (XYZ, CSV, TSV, TXT, DAT).  With --distances a square matrix as text, NPY
        or NPZ.
    output
        File to write the mesh and its curvature to; may be repeated.  PLY, VTP, VTK, NPZ and GIFTI carry fields;
        lh.mean.curv holds one for FreeSurfer.  Points are written as PLY, CSV or NPZ, points known by their distances
        as CSV or NPZ.
    method
        How to compute the curvature, for meshes; auto needs no setting.  sectional and lifted use positions; intrinsic,
        wald, robinson and angle_defect use edge lengths only and give the field gaussian only.
    quality
        fast is about twice as fast and less accurate; for meshes and the methods auto and sectional.
    radius
        Scale in the unit of length of the file; by default each method chooses its own.
    distances
        The file holds all distances of some points, and nothing else is known of them but, perhaps, their labels.
    rtol
        Distances: how much the axioms of a metric may be broken, relative to the largest one.
    field
        The scalar that becomes `quality` in PLY, fills a .curv file, and is drawn, in the report at first.
    picture
        PNG file to draw four views to.
    report
        HTML file to make: the surface or points and all fields, to turn and read off in a browser, without a network.
    up
        Axis that points up in the picture and in the report.
    unit
        Name of the unit of length of the file, such as mm.
    json
        Print one JSON object instead of a table.
    """
    needs_faces = {"method": method != "auto", "quality": quality != "best"}
    if distances:
        drawn = {"field": field != "gaussian", "picture": picture is not None, "report": report is not None}
        _refuse(needs_faces | drawn, f"needs a surface, and {mesh} holds distances only")
        _curvature_of_distances(mesh, output, radius, rtol, unit, json)
        return
    if holds_points(mesh):
        _refuse(needs_faces, f"needs faces, and {mesh} holds points only")
        _curvature_of_points(mesh, output, radius, field, Views(picture, report, up), unit, json)
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
                notes += write_result(path, surface, study.vertex_data(field), study.units(), field)
        Views(picture, report, up).write(study, features, field=field, title=mesh.name)
    if json:
        print_json(_record(mesh, study, mesh_counts(surface), field, outputs, notes))
    else:
        print_study(str(mesh), study)
        print_notes(tuple(notes))


class Views(NamedTuple):
    """The picture and the report that were asked for, if any, and the axis that points up in them."""

    picture: Path | None
    report: Path | None
    up: str

    def paths(self) -> list[Path]:
        return [path for path in (self.picture, self.report) if path]

    def write(self, study: SurfaceStudy | PointStudy, features: FeatureStudy | None, *, field: str, title: str) -> None:
        if self.picture:
            with working(f"drawing {self.picture.name}"):
                write_picture(self.picture, study, field, title=title, up=self.up)
        if self.report:
            with working(f"writing {self.report.name}"):
                write_report(self.report, study, features, field=field, title=title, up=self.up)


def _curvature_of_points(
    path: Path, output: tuple[Path, ...], radius: float | None, field: Field, views: Views, unit: str, json: bool
) -> None:
    """The curvature at the points of a file without faces."""
    check_point_outputs(output, inputs=[path])
    pictures, pages = [views.picture] if views.picture else [], [views.report] if views.report else []
    check_outputs(views.paths(), inputs=[path, *output], pictures=pictures, pages=pages)
    with working(f"reading {path.name}"):
        points, notes = read_cloud(path)
    with working(f"curvature of {len(points):,} points"):
        study = study_points(points, radius=radius, unit=unit)
    notes = ("The file has no faces: the curvature is that of the cloud of its points.", *notes)
    with study.timed("writing"):
        for target in output:
            with working(f"writing {target.name}"):
                notes += write_points(target, points, study.vertex_data(field), study.units(), field)
        views.write(study, None, field=field, title=path.name)
    if json:
        print_json(_record(path, study, point_counts(points), field, [*output, *views.paths()], list(notes)))
    else:
        print_study(str(path), study)
        print_notes(notes)


def _refuse(given: dict[str, bool], why: str) -> None:
    """Raise for the first option that was given."""
    for option, is_given in given.items():
        if is_given:
            raise InvalidInputError(f"--{option} {why}; leave it out.")


def _curvature_of_distances(
    path: Path, output: tuple[Path, ...], radius: float | None, rtol: float, unit: str, json: bool
) -> None:
    """The curvature at points known by their distances."""
    check_tables(output, inputs=[path])
    with working(f"reading {path.name}"), naming(str(path)):
        matrix, labels = read_distances(path)
        space = MetricSpace(matrix, rtol=rtol)
    with working(f"curvature of {len(space):,} points"):
        study = study_space(space, radius=radius, unit=unit)
    fields, units = study.vertex_data(), study.units()
    meaning = "; ".join(f"{name}: {units[name]}" for name in fields)
    names = {"label": np.array(labels)} if labels else {}
    for target in output:
        with working(f"writing {target.name}"):
            write_columns(target, names | fields, meaning)
    if json:
        print_json(_record(path, study, {"points": len(space)}, "gaussian", list(output), []))
    else:
        print_study(str(path), study)


def write_picture(path: Path, study: SurfaceStudy | PointStudy, field: str, *, title: str, up: str) -> None:
    """Draw one field of a study to a PNG file."""
    from rinow.io.atomic import replacing
    from rinow.report.figures import write_surface_picture
    from rinow.report.page import study_figure

    label = f"{study.units()[field].split(',')[0]}, in {field_unit(field, study.unit)}"
    title = f"{title}: {len(study.positions):,} {study.places}, method {study.curvature.method}"
    figure = study_figure(study, field, label=label, up=up, title=title)
    with replacing(path) as temporary:
        write_surface_picture(temporary, figure)


def write_report(
    path: Path,
    study: SurfaceStudy | PointStudy,
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
