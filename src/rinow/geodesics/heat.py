"""Geodesic distances by the heat method: quick and smooth, not exact."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.errors import MissingDependencyError
from rinow.mesh import as_triangle_mesh

__all__ = ["heat_distances"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def heat_distances(mesh: Any, sources: Indices) -> Floats:
    """(n_sources, n_vertices): distances by the heat method of the library potpourri3d; inf where no path leads.

    Raises
    ------
    MissingDependencyError
        If potpourri3d is not installed.
    InvalidMeshError
        If `mesh` has edge lengths only.
    """
    surface = as_triangle_mesh(mesh)
    try:
        from potpourri3d import MeshHeatMethodDistanceSolver
    except ImportError:
        message = "method = 'heat' needs the package potpourri3d; install rinow[heat], or take method='exact'."
        raise MissingDependencyError(message) from None
    t = surface.topology
    used = np.flatnonzero(t.vertex_is_used)
    place = np.cumsum(t.vertex_is_used) - 1
    vertices = surface.vertices[used]
    unit = float(np.ptp(vertices, axis=0).max(initial=0.0)) or 1.0  # the library squares lengths
    solver = MeshHeatMethodDistanceSolver(vertices / unit, place[surface.faces[t.face_used]])
    rows = np.full((len(sources), surface.n_vertices), np.inf)
    rows[np.arange(len(sources)), sources] = 0.0
    for row, source in zip(rows, sources, strict=True):
        if t.vertex_is_used[source]:
            near = t.components[used] == t.components[source]
            row[used[near]] = unit * solver.compute_distance(place[source])[near]
    return rows
