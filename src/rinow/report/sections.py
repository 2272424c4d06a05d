"""The tables of a page, as HTML that needs no script."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape

import numpy as np

from rinow.report.scene import BITS_OF_LARGE, LARGE, POSITION_STEPS
from rinow.study.features import FeatureStudy
from rinow.study.points import PointStudy, point_counts
from rinow.study.surface import FIELDS, STATUSES, CurvatureStudy, SurfaceStudy, field_unit, mesh_counts
from rinow.study.totals import surface_totals

__all__ = ["sections"]

SPREAD = (
    "The spread is one standard error of the Gaussian curvature at a vertex, as the method can tell from the data: "
    "where the surface is as smooth as the mesh suggests, nearly all errors stay below two spreads.  It is an "
    "estimate, no bound."
)
FAULTS = (
    "nonmanifold_edges",
    "nonmanifold_vertices",
    "unused_vertices",
    "nonfinite_vertices",
    "degenerate_faces",
    "misoriented_faces",
)
"""Counts of a mesh that are told where they are not 0."""


def sections(study: SurfaceStudy | PointStudy, features: FeatureStudy | None, *, version: str, made: str) -> str:
    """All tables of the page, one `<section>` each.

    Parameters
    ----------
    study : SurfaceStudy or PointStudy
        Surface and curvature.
    features : FeatureStudy, optional
        Singular points of the same surface.
    version, made : str
        Version of rinow, and when the page was made.
    """
    totals = _totals(study) if isinstance(study, SurfaceStudy) else _counts(study)
    parts = [totals, _statuses(study), *([_features(features)] if features else [])]
    return "\n".join([*parts, _origin(study, version, made), _reading(study), _citation(version), _percentiles(study)])


def number(value: float, digits: int = 6) -> str:
    """A number as text, with a true minus sign.

    Examples
    --------
    >>> number(-1234567), number(0.125), number(float("nan"))
    ('−1,234,567', '0.125', 'nan')
    """
    text = f"{value:,}" if isinstance(value, int) else f"{value:.{digits}g}"
    return text.replace("-", "−")


def _totals(study: SurfaceStudy) -> str:
    """Area, Euler characteristic and the terms of Gauss-Bonnet, and the faults of the mesh."""
    mesh, unit = study.mesh, study.unit
    counts, totals = mesh_counts(mesh), surface_totals(mesh, study.curvature.gaussian)
    share = totals.area_with_value / totals.area if totals.area > 0.0 else math.nan
    known = "" if share > 0.9999 else f", over the {100 * share:.3g} % of the area that have a value"
    faults = [(name.replace("_", " "), counts[name], "") for name in FAULTS if counts[name]]
    rows: list[tuple[str, float, str]] = [
        ("area", totals.area, f"{unit}²"),
        ("Euler characteristic χ", totals.euler_characteristic, ""),
        ("components", totals.components, ""),
        ("boundary curves", totals.boundary_curves, f"{totals.boundary_edges:,} edges"),
        ("2πχ", 2.0 * math.pi * totals.euler_characteristic, "rad"),
        ("total curvature, by angle defects", totals.inner_defects, "rad"),
        ("turning of the boundary", totals.boundary_turning, "rad"),
        (f"sum of K times area{known}", totals.gaussian_integral, "rad"),
        *faults,
    ]
    cells = [(escape(a), number(round(b, 9) + 0.0 if c == "rad" else b), escape(c)) for a, b, c in rows]
    text = (
        "Gauss and Bonnet: curvature and turning add up to 2πχ.  The sum of K times area has what smooth parts "
        "contribute; edges and corners of parts and noise make it differ."
    )
    return _section("Totals", _table([], cells, numbers=(1,)), text)


def _counts(study: PointStudy) -> str:
    counts = {name.replace("_", " "): n for name, n in point_counts(study.points).items() if n or name == "points"}
    text = "The points have no faces: nothing is known of the whole, such as its area and its Euler characteristic."
    return _section("Totals", _table([], [(name, number(n)) for name, n in counts.items()], numbers=(1,)), text)


def _statuses(study: CurvatureStudy) -> str:
    n = len(study.curvature.status)
    rows = [
        (name, f"{count:,}", f"{100 * count / n:.3g} %", f'<span class="meaning">{STATUSES[name]}</span>')
        for name, count in study.status_counts().items()
    ]
    title = f"{study.places.capitalize()} by status"
    return _section(title, _table(["status", study.places, "share", ""], rows, numbers=(1, 2)))


def _features(study: FeatureStudy) -> str:
    rows = [
        (name, f"{n:,}", *(f"{number(level, 4)}°" for level in levels or ()), *([""] * (0 if levels else 3)))
        for name, (n, levels) in study.table().items()
    ]
    head = ["", "number", "least angle", "median", "greatest"]
    text = f"Length of all creases {number(study.crease_length)}.  Angles of creases are convex positive."
    return _section("Singular features", _table(head, rows, numbers=(1, 2, 3, 4)), text)


def _origin(study: CurvatureStudy, version: str, made: str) -> str:
    """What the values were computed by, and when; and what was found and done."""
    asked, radius = study.settings, study.settings.get("radius")
    used = study.curvature.method
    wish = asked.get("method", used)
    rows = [
        ("rinow", version),
        ("method", used if wish == used else f"{used} (asked for: {wish})"),
        ("quality", str(asked.get("quality", "best"))),
        ("radius", "the choice of the method" if radius is None else f"{number(float(radius))} {study.unit}"),
        ("unit of length", "that of the file, not named" if study.unit == "length" else study.unit),
        ("time", ", ".join(f"{step} {seconds:.2f} s" for step, seconds in study.seconds.items())),
        ("page made", made),
    ]
    notes = [note[:1].upper() + note[1:] for note in study.notes]
    return _section("How it was computed", _table([], [(a, escape(b)) for a, b in rows]), *map(escape, notes))


def _reading(study: CurvatureStudy) -> str:
    """How to read the numbers: sign, unit, spread, what is undefined, digits."""
    digits = (
        f"fields rounded to {BITS_OF_LARGE} binary digits (1 in {2**BITS_OF_LARGE:,}; the files of rinow hold all)"
        if len(study.curvature.status) >= LARGE
        else "fields in single precision (float32, 1 in 16 million)"
    )
    texts = (
        "<b>Sign.</b> Convex with outward normal is positive; H is the mean of k1 and k2, and k1 ≥ k2.",
        f"<b>Unit.</b> Values are pointwise, not integrated: K in {escape(field_unit('gaussian', study.unit))}, "
        f"H, k1 and k2 in {escape(field_unit('mean', study.unit))}.",
        f"<b>Spread.</b> {SPREAD.replace('vertex', study.place)}",
        "<b>Undefined</b> is nan, drawn grey, with a status that says why; it is never a silent 0.",
        f"<b>Numbers of this page.</b> Positions are rounded to 1/{POSITION_STEPS:,} of the longest side; {digits}.",
    )
    return _section("Reading the numbers", "", *texts)


def _citation(version: str) -> str:
    return _section(
        "How to cite",
        "",
        f"The rinow developers: <i>rinow: metric geometry of surfaces and finite metric spaces</i>, version {version}.",
        "E. Saucan: <i>Surface Triangulation – the Metric Approach</i>, 2004, the paper whose system it builds.",
    )


def _percentiles(study: CurvatureStudy) -> str:
    table = study.percentiles()
    heads = {"0": "least", "50": "median", "100": "greatest"}
    levels = [heads.get(p, f"{p} %") for p in next(iter(table.values()))]
    rows = [
        (escape(FIELDS[name][0]), escape(field_unit(name, study.unit)), *(number(v, 5) for v in values.values()))
        for name, values in table.items()
    ]
    body = _table(["field", "unit", *levels], rows, numbers=range(2, 2 + len(levels)))
    return _section(f"Values at the {study.places} that have one", body, kind="full")


def _section(title: str, table: str, *texts: str, kind: str = "") -> str:
    paragraphs = "".join(f"<p>{text}</p>" for text in texts)
    return f'<section class="{kind}"><h2>{title}</h2>{table}{paragraphs}</section>'


def _table(head: Sequence[str], rows: Iterable[Sequence[str]], *, numbers: Iterable[int] = ()) -> str:
    """A table of cells that are HTML already; the first of each row is its heading."""
    right = frozenset(np.asarray(list(numbers), int).tolist())

    def cell(tag: str, column: int, text: str) -> str:
        scope = ' scope="row"' if column == 0 and tag == "td" else ""
        name = "th" if scope else tag
        kind = ' class="number"' if column in right else ""
        return f"<{name}{scope}{kind}>{text}</{name}>"

    top = "".join(cell("th", c, text) for c, text in enumerate(head))
    body = "".join("<tr>" + "".join(cell("td", c, text) for c, text in enumerate(row)) + "</tr>" for row in rows)
    return f"<table>{f'<thead><tr>{top}</tr></thead>' if head else ''}<tbody>{body}</tbody></table>"
