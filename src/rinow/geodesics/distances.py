"""Geodesic distances between the vertices of a mesh, and the metric space they make."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_matrix

from rinow._arrays import as_indices
from rinow.errors import InvalidInputError, InvalidMeshError
from rinow.geodesics.edge_graph import edge_distances
from rinow.geodesics.exact import SOURCES_AT_ONCE, ExactGeodesics
from rinow.geodesics.heat import heat_distances
from rinow.geodesics.queries import as_radii, as_sources, mark_undefined, rows_within
from rinow.mesh import as_mesh
from rinow.metric_space import MetricSpace, trusted_metric_space

__all__ = ["geodesic_distances", "geodesic_space"]

Floats = NDArray[np.float64]


def geodesic_distances(
    mesh: Any,
    sources: ArrayLike,
    *,
    method: Literal["exact", "edges", "heat"] = "exact",
    max_distance: ArrayLike | None = None,
) -> Floats | csr_matrix:
    """Geodesic distances from vertices of a mesh to all vertices, or to those within a radius.

    The geodesic distance is the length of the shortest path on the surface of flat triangles.

    Parameters
    ----------
    mesh : TriangleMesh, IntrinsicMesh, (V, F) pair or object with vertices and faces
        The surface; edge lengths suffice, except for ``"heat"``.
    sources : (n_sources,) array_like of int, or int
        Vertices.
    method : {"exact", "edges", "heat"}
        The shortest paths of the surface (`ExactGeodesics`); the shortest ones along edges, which are longer; or the
        approximation by the heat method [1]_, which needs the optional package potpourri3d.
    max_distance : float or (n_sources,) array_like of float, optional
        Radius, one for all sources or one for each, not negative, in the unit of the mesh.

    Returns
    -------
    distances : (n_sources, n_vertices) ndarray of float
        In the unit of the mesh.  inf where no path leads, also between a vertex without a face and the others; nan to
        and from vertices whose position is not finite.
    distances : (n_sources, n_vertices) scipy.sparse.csr_matrix of float
        With `max_distance`: entries for the vertices within it, the zero of the source among them, in no particular
        order within a row.  The row of a source whose position is not finite is empty.

    Raises
    ------
    InvalidInputError
        If `sources` is not a list of vertices, `max_distance` is negative, nan or of another length, or `method` is
        unknown.
    InvalidMeshError
        If `mesh` is no mesh, or has edge lengths only and `method` is ``"heat"``, or exact paths branch too often
        between many sheets at edges of three or more faces.
    MissingDependencyError
        If `method` is ``"heat"`` and potpourri3d is not installed.

    See Also
    --------
    ExactGeodesics : The same for many calls on one mesh, with directions.
    geodesic_space : The distances as a metric space.

    Notes
    -----
    With ``"exact"`` and a radius the cost is that of the balls.  The other methods compute full rows first.

    References
    ----------
    .. [1] K. Crane, C. Weischedel, M. Wardetzky, "Geodesics in heat", ACM Trans. Graph. 32 (2013).

    Examples
    --------
    Opposite corners of a unit square, cut along the other diagonal:

    >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 3], [1, 2, 3]]
    >>> geodesic_distances(square, 0)
    array([[0.        , 1.        , 1.41421356, 1.        ]])
    >>> geodesic_distances(square, 0, method="edges")
    array([[0., 1., 2., 1.]])
    """
    surface = as_mesh(mesh)
    if method == "exact":
        return ExactGeodesics(surface).distances(sources, max_distance=max_distance)
    if method not in ("edges", "heat"):
        raise InvalidInputError(f'method = {method!r} is unknown; give "exact", "edges" or "heat".')
    S = as_sources(sources, surface.n_vertices)
    radii = as_radii(math.inf if max_distance is None else max_distance, len(S))
    rows_of = partial(heat_distances, surface)
    if method == "edges":
        rows_of = partial(edge_distances, surface, max_distance=float(radii.max(initial=0.0)))

    def marked_rows_of(some: NDArray[np.intp]) -> Floats:
        return mark_undefined(rows_of(some), surface, some)

    if max_distance is None:
        return marked_rows_of(S)
    return rows_within(marked_rows_of, S, surface.n_vertices, radii)


def geodesic_space(
    mesh: Any, indices: ArrayLike | None = None, *, progress: Callable[[int, int], None] | None = None
) -> MetricSpace:
    """Vertices of a mesh with their exact geodesic distances, as a metric space.

    Parameters
    ----------
    mesh : TriangleMesh, IntrinsicMesh, (V, F) pair or object with vertices and faces
        The surface; edge lengths suffice.
    indices : (n_points,) array_like of int, optional
        The vertices to take, all by default.
    progress : callable, optional
        Called with the numbers of vertices done and in all, again and again; what it raises stops the computation.

    Returns
    -------
    space : MetricSpace
        Its points are the vertices in the order of `indices`.

    Raises
    ------
    InvalidMeshError
        If two of the vertices have no distance: they lie in different components, or a position is not finite.
    InvalidInputError
        If `indices` is empty, not one list of integers or out of range.

    Notes
    -----
    The cost is that of one whole-mesh computation for each point.  Of the two directions the shorter path is taken, so
    that the matrix is symmetric to the last digit.

    Examples
    --------
    A unit square, cut along a diagonal:

    >>> space = geodesic_space(([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 3], [1, 2, 3]]), [0, 2])
    >>> print(space.distances)
    [[0.         1.41421356]
     [1.41421356 0.        ]]
    """
    geodesics = ExactGeodesics(mesh)
    n = geodesics.mesh.n_vertices
    chosen = np.arange(n) if indices is None else as_indices(indices, n, "indices")
    if chosen.ndim != 1 or not len(chosen):
        raise InvalidInputError(f"indices has shape {chosen.shape}; give one list of at least one vertex.")
    D = np.empty((len(chosen), len(chosen)))
    for first in range(0, len(chosen), SOURCES_AT_ONCE):
        block = slice(first, first + SOURCES_AT_ONCE)
        D[block] = np.asarray(geodesics.distances(chosen[block]))[:, chosen]
        if progress is not None:
            progress(min(block.stop, len(chosen)), len(chosen))
    lost = np.argwhere(~np.isfinite(D))
    if len(lost):
        i, j = (int(chosen[k]) for k in lost[0])
        raise InvalidMeshError(f"vertices {i} and {j} have no geodesic distance; give `indices` within one component.")
    return trusted_metric_space(np.minimum(D, D.T))
