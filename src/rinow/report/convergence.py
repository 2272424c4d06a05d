"""Plot of the distances of approximations from their limit against refinement."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["convergence_figure"]

Floats = NDArray[np.float64]


def convergence_figure(scale: Floats, intervals: Mapping[str, Floats], *, label: str, title: str = "") -> Any:
    """Intervals against the scale of the approximations, both on logarithmic axes.

    Parameters
    ----------
    scale : (k,) ndarray of float
        Scale of each approximation, such as its longest edge.
    intervals : mapping of str to (k, 2) ndarray of float
        Name of each distance, and its bounds.  A lower bound of 0 is drawn as an open end; nothing is drawn for an
        infinite upper bound.
    label : str
        Name and unit of the scale.
    title : str, optional
        Heading.

    Returns
    -------
    figure : matplotlib.figure.Figure
        Drawn off-screen; `rinow.report.figures.write_surface_picture` saves it.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 5.0), dpi=140, layout="constrained")
    axis = figure.subplots()
    for k, (name, bounds) in enumerate(intervals.items()):
        use = np.isfinite(bounds[:, 1]) & (bounds[:, 1] > 0.0)
        if not use.any():
            continue
        x, (lower, upper) = scale[use], bounds[use].T
        (line,) = axis.plot(x, upper, marker="v", markersize=5, label=name)
        known = lower > 0.0
        axis.plot(x[known], lower[known], marker="^", markersize=5, linestyle=":", color=line.get_color())
        axis.vlines(x[known] * 1.01**k, lower[known], upper[known], color=line.get_color(), alpha=0.4)
    axis.set(xscale="log", yscale="log", xlabel=label, title=title)
    axis.set_ylabel("upper bound (▾, solid) and lower bound (▴, dotted)")
    axis.grid(which="both", alpha=0.2)
    axis.legend(fontsize=8)
    return figure
