"""Exact geodesic distances on polyhedral surfaces: prepared once, asked often."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_matrix

from rinow.geodesics.batches import ball_rows, distance_rows
from rinow.geodesics.contraction import Contraction, contraction
from rinow.geodesics.queries import as_radii, as_sources, undefined_vertices
from rinow.geodesics.unfolding import UnfoldedMesh, unfold
from rinow.kernels.fans import SINGULAR
from rinow.mesh import as_mesh

__all__ = ["SOURCES_AT_ONCE", "ExactGeodesics", "GeodesicBalls"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Balls = tuple[Indices, NDArray[np.int32], Floats, Floats]

SOURCES_AT_ONCE = 64
"""Sources asked for together where not all rows are kept: enough for all threads, few enough for the memory."""


@dataclass(frozen=True, slots=True)
class GeodesicBalls:
    """Geodesic balls in polar coordinates.

    Attributes
    ----------
    offsets : (n_sources + 1,) ndarray of intp
        Ball i is ``offsets[i]:offsets[i + 1]`` of the other arrays, in no particular order but the source first.
    vertices : (n_entries,) ndarray of int32
        The vertices of the balls.
    distances : (n_entries,) ndarray of float
        Their geodesic distances from the source, in the unit of the mesh.
    directions : (n_entries,) ndarray of float
        Direction in which the shortest path leaves the source, in radians: the angle along the surface from a fixed
        edge, counter-clockwise in the orientation of most faces of the component.  At an interior vertex it lies in
        [0, total angle], at a boundary vertex it counts from the boundary edge.  Of several shortest paths it is that
        of the one whose last half-edge has the least index.  It is nan for the source itself and
        where the faces around the source form no single fan.
    total_angles : (n_sources,) ndarray of float
        Angles of the faces around each source; nan where they form no single fan.
    """

    offsets: Indices
    vertices: NDArray[np.int32]
    distances: Floats
    directions: Floats
    total_angles: Floats


@final
@dataclass(frozen=True, eq=False)
class ExactGeodesics:
    """Exact geodesic distances between the vertices of a surface of flat triangles.

    The mesh is prepared once; many sources are then computed side by side.

    Parameters
    ----------
    mesh : TriangleMesh, IntrinsicMesh, (V, F) pair or object with vertices and faces
        The surface; edge lengths suffice.

    Notes
    -----
    **Method.**  Cones of straight lines (windows) are unfolded from face to face, depth first, from the source and, in
    the order of distance, from each vertex where shortest paths bend: saddles, boundary and singular ones [1]_ [2]_.
    Depth first needs no queue of windows, which pays on small balls.  On large ones the surface is swept in shells:
    windows that leave a shell wait, and are dropped when a shorter path has become known meanwhile [3]_ [4]_.  A shell
    is cut into thinner ones when its work gets out of hand, so the order of distance is kept as far as needed.

    **Accuracy.**  Distances are exact up to rounding, some 1e-14 of the distance.  From positions this holds for faces
    of any shape; from edge lengths alone a nearly flat triangle is known only as well as its lengths tell (rounding
    ε moves its apex by the root of ε).

    **Cost.**  Memory and time of a ball of small radius are those of the ball, some 10 µs for a hundred vertices.  A
    whole mesh of n vertices costs about n to n^1.5 operations.

    **Faulty meshes.**  Faces turned against each other, non-orientable surfaces, vertices with several fans, faces of
    zero area and edges of length zero are computed exactly.  So are edges of three or more faces: a path may go on in
    each of them, and the distance is that of the whole complex.  Faces with a repeated or non-finite vertex take no
    part.

    References
    ----------
    .. [1] J. Mitchell, D. Mount, C. Papadimitriou, "The discrete geodesic problem", SIAM J. Comput. 16 (1987).
    .. [2] J. Chen, Y. Han, "Shortest paths on a polyhedron", Int. J. Comput. Geom. Appl. 6 (1996).
    .. [3] S.-Q. Xin, G.-J. Wang, "Improving Chen and Han's algorithm on the discrete geodesic problem", ACM Trans.
       Graph. 28 (2009).
    .. [4] C. Xu, T. Wang, Y.-J. Liu, L. Liu, Y. He, "Fast wavefront propagation (FWP) for computing exact geodesic
       distances on meshes", IEEE Trans. Vis. Comput. Graph. 21 (2015).

    Examples
    --------
    Opposite corners of a unit square, cut along the other diagonal:

    >>> square = ExactGeodesics(([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 3], [1, 2, 3]]))
    >>> square.distances([0])
    array([[0.        , 1.        , 1.41421356, 1.        ]])
    >>> print(square.distances([0], max_distance=1.0).toarray())
    [[0. 1. 0. 1.]]
    """

    mesh: Any

    def __post_init__(self) -> None:
        object.__setattr__(self, "mesh", as_mesh(self.mesh))

    @cached_property
    def _contraction(self) -> Contraction | None:
        return contraction(self.mesh)

    @cached_property
    def _unfolded(self) -> UnfoldedMesh:
        return unfold(self.mesh if self._contraction is None else self._contraction.mesh)

    def _points(self, vertices: Indices) -> Indices:
        """The vertices of the unfolded mesh at the places of some vertices."""
        return vertices if self._contraction is None else self._contraction.first[vertices]

    def distances(self, sources: ArrayLike, *, max_distance: ArrayLike | None = None) -> Floats | csr_matrix:
        """Distances from the sources to all vertices, or to those within a radius.

        Parameters
        ----------
        sources : (n_sources,) array_like of int, or int
            Vertices.
        max_distance : float or (n_sources,) array_like of float, optional
            Radius, one for all sources or one for each, not negative, in the unit of the mesh.

        Returns
        -------
        distances : (n_sources, n_vertices) ndarray of float
            inf where no path leads, also between a vertex without a face and the others; nan to and from vertices
            whose position is not finite.
        distances : (n_sources, n_vertices) scipy.sparse.csr_matrix of float
            With `max_distance`: entries for the vertices within it, the zero of the source among them.  Columns are
            not sorted within a row.  The row of a source whose position is not finite is empty.

        Raises
        ------
        InvalidMeshError
            If the paths branch too often to be followed, between many sheets at edges of three or more faces.
        InvalidInputError
            If `sources` is not a list of vertices, or `max_distance` is negative, nan or of another length.
        """
        S = as_sources(sources, self.mesh.n_vertices)
        if max_distance is None:
            rows, undefined = distance_rows(self._unfolded, self._points(S)), undefined_vertices(self.mesh)
            rows = rows if self._contraction is None else rows[:, self._contraction.first]
            rows[:, undefined] = rows[undefined[S]] = np.nan
            return rows
        offsets, vertices, distances, _ = self._balls(S, as_radii(max_distance, len(S)))
        return csr_matrix((distances, vertices, offsets), shape=(len(S), self.mesh.n_vertices))

    def polar(self, sources: ArrayLike, *, max_distance: ArrayLike) -> GeodesicBalls:
        """Geodesic balls in polar coordinates: distance, and the direction in which the shortest path starts.

        Parameters
        ----------
        sources : (n_sources,) array_like of int, or int
            Vertices.
        max_distance : float or (n_sources,) array_like of float
            Radius, one for all sources or one for each, not negative, in the unit of the mesh.

        Returns
        -------
        balls : GeodesicBalls
            One ball for each source; empty for a source whose position is not finite.

        Raises
        ------
        InvalidMeshError
            If the paths branch too often to be followed, between many sheets at edges of three or more faces.
        InvalidInputError
            If `sources` is not a list of vertices, or `max_distance` is negative, nan or of another length.
        """
        S = as_sources(sources, self.mesh.n_vertices)
        offsets, vertices, distances, directions = self._balls(S, as_radii(max_distance, len(S)), with_directions=True)
        u = self._unfolded
        records = u.surface.vertices[u.rank[self._points(S)]]
        total_angles = np.where(records["kind"] == SINGULAR, np.nan, records["total_angle"])
        directions = np.clip(directions, 0.0, np.repeat(total_angles, np.diff(offsets)))
        return GeodesicBalls(offsets, vertices, distances, directions, total_angles)

    def _balls(self, sources: Indices, radii: Floats, *, with_directions: bool = False) -> Balls:
        """Offsets, vertices, distances and directions; the ball of a source without a position is empty."""
        is_defined = ~undefined_vertices(self.mesh)[sources]
        asked = self._points(sources[is_defined]), radii[is_defined]
        offsets, vertices, distances, directions = ball_rows(self._unfolded, *asked, with_directions=with_directions)
        if self._contraction is not None:
            offsets, vertices, entry = self._contraction.expanded(offsets, vertices.astype(np.intp))
            distances, directions = distances[entry], directions[entry] if with_directions else directions
            vertices = _source_first(vertices.astype(np.int32), offsets, sources[is_defined])
        counts = np.zeros(len(sources), np.intp)
        counts[is_defined] = np.diff(offsets)
        return np.concatenate([[0], np.cumsum(counts)]), vertices, distances, directions


def _source_first(vertices: NDArray[np.int32], offsets: Indices, sources: Indices) -> NDArray[np.int32]:
    """The vertices of balls in which that of a source changes places with the first one, which is at the same point."""
    for start, stop, source in zip(offsets[:-1], offsets[1:], sources, strict=True):
        place = start + int(np.argmax(vertices[start:stop] == source))
        vertices[place], vertices[start] = vertices[start], source
    return vertices
