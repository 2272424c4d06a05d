"""What one asks of geodesics: sources and a radius, checked once; and the vertices that have no distance."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import as_indices
from rinow.errors import InvalidInputError
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["as_radius", "as_sources", "undefined_vertices"]


def as_sources(sources: ArrayLike, n_vertices: int) -> NDArray[np.intp]:
    """One vertex or a list of them, as (n_sources,) indices."""
    S = np.atleast_1d(as_indices(sources, n_vertices, "sources"))
    if S.ndim != 1:
        raise InvalidInputError(f"sources has shape {S.shape}; give one vertex or one list of vertices.")
    return S


def as_radius(max_distance: float) -> float:
    """A radius: not negative, perhaps infinite."""
    radius = float(max_distance)
    if math.isnan(radius) or radius < 0.0:
        raise InvalidInputError(f"max_distance = {radius} is not a radius; give a number that is not negative.")
    return radius


def undefined_vertices(mesh: TriangleMesh | IntrinsicMesh) -> NDArray[np.bool_]:
    """(n_vertices,): vertices without a finite position, to which no distance is defined."""
    return ~mesh.vertex_is_finite if isinstance(mesh, TriangleMesh) else np.zeros(mesh.n_vertices, np.bool_)
