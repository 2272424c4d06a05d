"""What one asks of geodesics: sources and a radius, checked once; and the forms of an answer."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_matrix, vstack

from rinow._arrays import as_floats, as_indices
from rinow.errors import InvalidInputError
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["as_radii", "as_sources", "mark_undefined", "rows_within", "undefined_vertices"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_ENTRIES = 1 << 24  # of the full rows held at one time


def as_sources(sources: ArrayLike, n_vertices: int) -> Indices:
    """One vertex or a list of them, as (n_sources,) indices."""
    S = np.atleast_1d(as_indices(sources, n_vertices, "sources"))
    if S.ndim != 1:
        raise InvalidInputError(f"sources has shape {S.shape}; give one vertex or one list of vertices.")
    return S


def as_radii(max_distance: ArrayLike, n_sources: int) -> Floats:
    """(n_sources,): radii, not negative, perhaps infinite, from one for all or one for each source."""
    radii = as_floats(max_distance, "max_distance")
    if radii.shape not in ((), (n_sources,)):
        raise InvalidInputError(
            f"max_distance has shape {radii.shape}; give one radius, or one for each of the {n_sources} sources."
        )
    radii = np.broadcast_to(radii, (n_sources,))
    bad = np.flatnonzero(~(radii >= 0.0))
    if len(bad):
        place = f"max_distance[{bad[0]}]" if np.ndim(max_distance) else "max_distance"
        raise InvalidInputError(f"{place} = {radii[bad[0]]} is not a radius; give a number that is not negative.")
    return radii


def undefined_vertices(mesh: TriangleMesh | IntrinsicMesh) -> Bools:
    """(n_vertices,): vertices without a finite position, to which no distance is defined."""
    return ~mesh.vertex_is_finite if isinstance(mesh, TriangleMesh) else np.zeros(mesh.n_vertices, np.bool_)


def mark_undefined(rows: Floats, mesh: TriangleMesh | IntrinsicMesh, sources: Indices) -> Floats:
    """The same rows, with nan to and from vertices without a finite position."""
    undefined = undefined_vertices(mesh)
    rows[:, undefined] = np.nan
    rows[undefined[sources]] = np.nan
    return rows


def rows_within(rows_of: Callable[[Indices], Floats], sources: Indices, n_vertices: int, radii: Floats) -> csr_matrix:
    """(n_sources, n_vertices): the entries of ``rows_of(sources)`` within the radii, zeros among them."""
    blocks = [csr_matrix((0, n_vertices))]
    step = max(_ENTRIES // n_vertices, 1)
    for first in range(0, len(sources), step):
        block = slice(first, first + step)
        rows = rows_of(sources[block])
        i, j = np.nonzero(np.isfinite(rows) & (rows <= radii[block, None]))
        blocks.append(csr_matrix((rows[i, j], (i, j)), shape=rows.shape))
    return csr_matrix(vstack(blocks))
