"""One page for a browser that shows a surface and its curvature, and needs no network."""

from __future__ import annotations

import base64
import hashlib
import io
import json
from datetime import UTC, datetime
from html import escape
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

from rinow._version import __version__
from rinow.report.discs import squares
from rinow.report.figures import surface_figure
from rinow.report.scene import surface_scene
from rinow.report.sections import sections
from rinow.study.features import FeatureStudy
from rinow.study.points import PointStudy
from rinow.study.surface import FIELDS, SIGNED, SurfaceStudy, field_unit

__all__ = ["study_figure", "surface_page", "write_surface_page"]

SCRIPTS = (
    "vendor/three.min.js",
    "scene.js",
    "colours.js",
    "shaders.js",
    "geometry.js",
    "picker.js",
    "viewer.js",
    "picture.js",
    "keys.js",
    "page.js",
)
"""In the order in which they need each other."""
PICTURE_DPI = 90


def surface_page(
    study: SurfaceStudy | PointStudy,
    features: FeatureStudy | None = None,
    *,
    title: str,
    field: str = "gaussian",
    up: str = "z",
    made: datetime | None = None,
) -> str:
    """A page that shows a surface or a cloud of points and its curvature, complete in itself.

    Parameters
    ----------
    study : SurfaceStudy or PointStudy
        Surface and curvature.
    features : FeatureStudy, optional
        Singular points of the same surface, drawn on demand.
    title : str
        Heading, such as the name of the file.
    field : str
        Name of the scalar that is shown at first.
    up : {"x", "y", "z"}
        Axis that points up at first.
    made : datetime, optional
        The time that the page tells; by default now.

    Returns
    -------
    page : str
        HTML with style, scripts, data and a still picture inside.  Its policy forbids every request to a network and
        every script but its own; without WebGL or scripts the picture and the tables remain.

    Examples
    --------
    >>> from rinow import TriangleMesh
    >>> from rinow.study.surface import study_surface
    >>> mesh = TriangleMesh([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]],
    ...                     [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    >>> page = surface_page(study_surface(mesh, method="angle_defect"), title="tetrahedron")
    >>> page.startswith("<!doctype html>"), "1/length²" in page
    (True, True)
    """
    scene = surface_scene(study, features, field=field, up=up)
    label = f"{FIELDS[field][0]}, in {field_unit(field, study.unit)}"
    if field in SIGNED:
        label += ", convex positive"
    style, scripts = _asset("page.css"), [_asset(name) for name in SCRIPTS]
    faces = f", {study.mesh.n_faces:,} faces" if isinstance(study, SurfaceStudy) else ""
    summary = f"{len(study.positions):,} {study.places}{faces}, method {study.curvature.method}"
    time = (made or datetime.now(UTC)).strftime("%Y-%m-%d %H:%M %Z").strip()
    return Template(_asset("template.html")).substitute(
        policy=_policy(style, scripts),
        version=__version__,
        title=escape(title),
        summary=summary,
        place=study.place,
        places=study.places,
        picture=_still_picture(study, field, label, up),
        picture_text=escape(f"Four views coloured by the {label}"),
        style=style,
        sections=sections(study, features, version=__version__, made=time),
        footer=f"Made by rinow {__version__}, {time}.  This page is complete in itself and asks no network.",
        header=_json(scene.header),
        data=scene.data,
        scripts="\n".join(f"<script>{script}</script>" for script in scripts),
    )


def write_surface_page(path: Path, page: str) -> None:
    """Save a page."""
    path.write_text(page, encoding="utf-8", newline="\n")


def _asset(name: str) -> str:
    return (resources.files("rinow.report") / "_assets" / name).read_text(encoding="utf-8")


def _policy(style: str, scripts: list[str]) -> str:
    """What the browser may do: run these scripts, use this style, show pictures that are in the page; nothing else."""
    allowed = {
        "default-src": "'none'",
        "script-src": " ".join(map(_hash, scripts)),
        "style-src": _hash(style),
        "img-src": "data:",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    return "; ".join(f"{what} {whom}" for what, whom in allowed.items())


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _json(value: Any) -> str:
    """JSON that cannot end the element it is in."""
    return json.dumps(value, allow_nan=False, ensure_ascii=False).replace("<", "\\u003c")


def study_figure(study: SurfaceStudy | PointStudy, field: str, *, label: str, up: str, title: str = "") -> Any:
    """The picture of a field of a study, see `surface_figure`; points are drawn as squares."""
    is_mesh = isinstance(study, SurfaceStudy)
    vertices, faces, owner = (study.mesh.vertices, study.mesh.faces, None) if is_mesh else squares(study)
    return surface_figure(
        vertices,
        faces,
        study.fields(field)[field],
        label=label,
        areas=study.areas,
        owner=owner,
        signed=field in SIGNED,
        up=up,
        title=title,
    )


def _still_picture(study: SurfaceStudy | PointStudy, field: str, label: str, up: str) -> str:
    """The picture for printers and for browsers without WebGL, as an address that holds it."""
    figure = study_figure(study, field, label=label, up=up)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=PICTURE_DPI)
    return f"data:image/png;base64,{base64.b64encode(buffer.getvalue()).decode('ascii')}"
