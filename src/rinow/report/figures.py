"""Static pictures of a field on a surface."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.report.raster import camera, shade

__all__ = ["UNDEFINED_GREY", "ColourScale", "colour_limit", "colour_scale", "surface_figure", "write_surface_picture"]

Floats = NDArray[np.float64]
UNDEFINED_GREY = (0.35, 0.35, 0.35)
"""Darker than any shading of the white that stands for 0."""
CLIP_PERCENTILES = (2.0, 98.0)
UP = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def _clip_range(values: Floats, areas: Floats | None) -> tuple[float, float] | None:
    """The 2nd and 98th percentile, each value counted by its area if these are given; None without a value."""
    known = np.isfinite(values)
    if areas is not None and areas[known].sum() > 0.0:
        known &= areas > 0.0
        order = np.flatnonzero(known)[np.argsort(values[known])]
        share = areas[order] / areas[order].sum()
        low, high = np.interp(np.array(CLIP_PERCENTILES) / 100.0, np.cumsum(share) - 0.5 * share, values[order])
        return float(low), float(high)
    if not known.any():
        return None
    low, high = np.percentile(values[known], CLIP_PERCENTILES)
    return float(low), float(high)


def colour_limit(values: Floats, areas: Floats | None = None) -> float:
    """Limit of colours symmetric about 0: the larger of the 2nd and 98th percentile in absolute value."""
    ends = _clip_range(values, areas)
    return (max(abs(ends[0]), abs(ends[1])) if ends else 0.0) or 1.0


@dataclass(frozen=True, slots=True)
class ColourScale:
    """Which values have which colours.

    Attributes
    ----------
    low, high : float
        Values of the first and the last colour; those beyond have the same.
    colour_map : str
        Name of the map in matplotlib.
    rule : str
        How the range was chosen, in words.
    """

    low: float
    high: float
    colour_map: str
    rule: str


def colour_scale(values: Floats, areas: Floats | None = None, *, signed: bool = True) -> ColourScale:
    """Colours of a field: symmetric about 0 for a signed one, else from the 2nd to the 98th percentile.

    Percentiles are of the area that has a value if `areas` (n,) are given: a dense sample of a small part of the
    surface then counts no more than its share.
    """
    rule = "colours clipped at the 2nd and 98th percentile" + ("" if areas is None else " of the area")
    if signed:
        limit = colour_limit(values, areas)
        return ColourScale(-limit, limit, "RdBu_r", f"{rule}, symmetric about 0")
    low, high = _clip_range(values, areas) or (0.0, 1.0)
    if not low < high:
        low, high = (0.0, 2.0 * low) if low > 0.0 else (0.0, 1.0)
    return ColourScale(low, high, "viridis", rule)


def surface_figure(
    vertices: Floats,
    faces: NDArray[np.intp],
    values: Floats,
    *,
    label: str,
    areas: Floats | None = None,
    owner: NDArray[np.intp] | None = None,
    signed: bool = True,
    title: str = "",
    up: str = "z",
) -> Any:
    """Four views around a surface, coloured by a field.

    Parameters
    ----------
    vertices : (n_vertices, 3) ndarray of float
        Positions; faces at non-finite ones are left out.
    faces : (n_faces, 3) ndarray of intp
        Triangles.
    values : (n_vertices,) or (n_points,) ndarray of float
        The field; blue is negative, red positive, grey undefined (nan).
    label : str
        Name and unit of the field, for the colour bar.
    areas : (n_vertices,) or (n_points,) ndarray of float, optional
        Area that each value stands for, for the range of the colours.
    owner : (n_vertices,) ndarray of intp, optional
        The point whose value each vertex has; by default the vertices have their own.
    signed : bool, optional
        Whether the field may be negative; one that never is goes from violet to yellow.
    title : str, optional
        Heading.
    up : {"x", "y", "z"}
        Axis that points up in the picture.

    Returns
    -------
    figure : matplotlib.figure.Figure
        Drawn off-screen; no window and no global state of matplotlib is touched.
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

    chosen = colour_scale(values, areas, signed=signed)
    scale = ScalarMappable(Normalize(chosen.low, chosen.high), chosen.colour_map)
    colours = scale.to_rgba(np.nan_to_num(values, nan=0.0, posinf=chosen.high, neginf=chosen.low))[:, :3]
    colours[np.isnan(values)] = UNDEFINED_GREY
    colours = colours if owner is None else colours[owner]
    figure = Figure(figsize=(9.4, 8.2), dpi=140, layout="constrained")
    axes = figure.subplots(2, 2)
    for axis, picture in zip(axes.flat, _views(vertices, faces, colours, up, pixels=560), strict=True):
        axis.imshow(picture, interpolation="none")
        axis.set_axis_off()
    bar = figure.colorbar(scale, ax=axes, extend="both", shrink=0.75, aspect=32, pad=0.02)
    undefined = int(np.isnan(values).sum())
    places = "vertices" if owner is None else "points"
    grey = f"; grey: undefined at {undefined:,} of {len(values):,} {places}" if undefined else ""
    bar.set_label(f"{label}\n{chosen.rule}{grey}", fontsize=9)
    if title:
        figure.suptitle(title, fontsize=12)
    return figure


def _views(vertices: Floats, faces: NDArray[np.intp], colours: Floats, up: str, *, pixels: int) -> list[Floats]:
    """Pictures from four directions a quarter turn apart, a little from above."""
    used = np.zeros(len(vertices), np.bool_)
    used[faces.ravel()] = True
    V = vertices[used & np.isfinite(vertices).all(axis=1)]
    if len(V) == 0:
        return [np.zeros((pixels, pixels, 4))] * 4
    centre = 0.5 * (V.min(axis=0) + V.max(axis=0))
    axis = np.array(UP[up])
    east, north = np.roll(axis, 1), np.roll(axis, 2)
    views = [
        camera(np.cos(turn) * east + np.sin(turn) * north + 0.45 * axis, axis)
        for turn in np.deg2rad([-60.0, 30.0, 120.0, 210.0])
    ]
    reach = max(float(np.abs((V - centre) @ view[:2].T).max()) for view in views)
    zoom = 0.49 * pixels / reach if reach > 0.0 else 1.0
    return [shade(vertices - centre, faces, colours, view, pixels=pixels, zoom=zoom) for view in views]


def write_surface_picture(path: Path, figure: Any) -> None:
    """Save a figure as PNG."""
    figure.savefig(path, format="png")
