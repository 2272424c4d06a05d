"""Finite metric spaces as values."""

from __future__ import annotations

from dataclasses import InitVar, dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import issparse
from scipy.sparse.csgraph import shortest_path
from scipy.spatial.distance import pdist, squareform

from rinow import tolerances
from rinow._arrays import (
    as_distance_matrix,
    as_indices,
    as_number,
    as_points,
    in_safe_unit,
    in_unit,
    read_only,
)
from rinow.errors import InvalidInputError, NotAMetricError, naming
from rinow.kernels import metrics
from rinow.metric_graph import graph_edge_lengths

__all__ = [
    "MetricSpace",
    "as_metric_space",
    "both_distances",
    "finite_distances",
    "trusted_metric_space",
]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class MetricSpace:
    """A finite metric space, given by its distance matrix.

    Two points may have distance 0 (a pseudometric), so that repeated points need not be removed.

    Parameters
    ----------
    distances : (n_points, n_points) array_like of float
        Distances, in any unit of length; the matrix is copied.
    rtol : float, default 1e-9
        Rounding allowed in symmetry, diagonal and triangle inequality, relative to the diameter.

    Attributes
    ----------
    distances : (n_points, n_points) ndarray of float
        Exactly symmetric, with zero diagonal, read-only.

    Raises
    ------
    InvalidInputError
        If `distances` is not a square matrix of real numbers.
    NotAMetricError
        If a distance is negative or not finite, the matrix is not symmetric or its diagonal not 0, or the triangle
        inequality fails; `witness` holds the points, for the inequality the triple with the largest excess.

    Notes
    -----
    The check of the triangle inequality costs O(n_points³); `from_points`, `from_graph` and `subspace` do without.

    Examples
    --------
    Three points on a line:

    >>> space = MetricSpace([[0, 1, 3], [1, 0, 2], [3, 2, 0]])
    >>> len(space), space.diameter, space.radius
    (3, 3.0, 2.0)
    >>> MetricSpace([[0, 1, 4], [1, 0, 2], [4, 2, 0]])
    Traceback (most recent call last):
    rinow.errors.NotAMetricError: distances[0, 2] = 4 exceeds distances[0, 1] + distances[1, 2] = 3; ...
    """

    distances: Floats
    rtol: InitVar[float] = field(default=tolerances.METRIC_TRIANGLE_INEQUALITY, kw_only=True)

    def __post_init__(self, rtol: float) -> None:
        if not 0.0 <= as_number(rtol, "rtol") < np.inf:
            raise InvalidInputError(f"rtol = {rtol} is not a relative tolerance; give a number such as 1e-9.")
        D = as_distance_matrix(self.distances, rtol=rtol)
        _check_triangle_inequality(D, rtol)
        object.__setattr__(self, "distances", read_only(D))

    def __len__(self) -> int:
        return len(self.distances)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copies, also those in other processes, are as frozen, and not checked again."""
        return trusted_metric_space, (self.distances,)

    def __repr__(self) -> str:
        return f"MetricSpace(n_points={len(self)}, diameter={self.diameter:.6g})"

    @cached_property
    def eccentricities(self) -> Floats:
        """(n_points,): distance to the farthest point."""
        return read_only(self.distances.max(axis=1))

    @property
    def diameter(self) -> float:
        """Largest distance."""
        return float(self.eccentricities.max())

    @property
    def radius(self) -> float:
        """Least eccentricity."""
        return float(self.eccentricities.min())

    def subspace(self, indices: ArrayLike) -> MetricSpace:
        """The points with the given indices, in that order.

        Parameters
        ----------
        indices : (n,) array_like of int
            At least one index; an index given twice yields two points at distance 0.

        Returns
        -------
        space : MetricSpace
            The distances between these points.

        Raises
        ------
        InvalidInputError
            If `indices` is empty, not one list of integers or out of range.
        """
        chosen = as_indices(indices, len(self), "indices")
        if chosen.ndim != 1 or not len(chosen):
            raise InvalidInputError(f"indices has shape {chosen.shape}; give one list of at least one index.")
        return trusted_metric_space(self.distances[np.ix_(chosen, chosen)])

    @classmethod
    def from_points(cls, points: ArrayLike) -> MetricSpace:
        """Points of a Euclidean space with their straight distances.

        Parameters
        ----------
        points : (n_points, dimension) array_like of float
            Finite coordinates of at least one point.

        Returns
        -------
        space : MetricSpace
            The points in the given order.

        Raises
        ------
        InvalidInputError
            If the shape or type is wrong, there is no point or a coordinate is not finite.
        """
        P = as_points(points)
        wrong = np.argwhere(~np.isfinite(P))
        if len(wrong):
            i, j = wrong[0]
            raise InvalidInputError(f"points[{i}, {j}] = {P[i, j]} is not finite; remove the point.")
        if not len(P):
            raise InvalidInputError("points is empty; a metric space has at least one point.")
        scaled, exponent = in_safe_unit(P)
        lengths = in_unit(pdist(scaled), exponent)
        if not np.isfinite(lengths).all():
            raise InvalidInputError(f"points reach {np.abs(P).max():.3g}, and their distances no number; scale them.")
        return trusted_metric_space(squareform(lengths, checks=False) if len(P) > 1 else np.zeros((1, 1)))

    @classmethod
    def from_graph(cls, graph: Any, *, infinite: bool = False) -> MetricSpace:
        """Nodes of a graph with the lengths of the shortest paths between them.

        Parameters
        ----------
        graph : scipy sparse matrix of shape (n, n), or networkx or igraph graph
            The entries, or the edge attribute "weight" (1 where it is missing), are the lengths of the edges, at
            least 0; a stored 0 is an edge too.  Every edge leads both ways; of parallel or opposite edges the
            shortest counts.
        infinite : bool, default False
            Allow the distance inf between nodes that no path joins.

        Returns
        -------
        space : MetricSpace
            The nodes in the order of the matrix, or of ``graph.nodes``.

        Raises
        ------
        InvalidInputError
            If `graph` is neither of these, has no node, or a length is negative or nan.
        NotAMetricError
            If the graph is disconnected and `infinite` is false; `witness` holds two nodes without a path.

        Notes
        -----
        Dijkstra's algorithm from every node: O(n (n + n_edges) log n).

        Examples
        --------
        >>> import networkx as nx
        >>> MetricSpace.from_graph(nx.cycle_graph(6)).eccentricities
        array([3., 3., 3., 3., 3., 3.])
        """
        D = shortest_path(graph_edge_lengths(graph), method="D", directed=False)
        D = np.minimum(D, D.T)
        apart = np.argwhere(np.isinf(D))
        if len(apart) and not infinite:
            i, j = (int(x) for x in apart[0])
            raise NotAMetricError(
                f"graph has no path from node {i} to node {j}; take one component, or allow infinite=True.", (i, j)
            )
        return trusted_metric_space(D)


def trusted_metric_space(distances: Floats) -> MetricSpace:
    """The space of a matrix known to be a metric, exactly symmetric and 0 on the diagonal: not checked, not copied."""
    space = object.__new__(MetricSpace)
    object.__setattr__(space, "distances", read_only(distances))
    return space


def as_metric_space(space: Any) -> MetricSpace:
    """The space meant by a `MetricSpace` or a square distance matrix.

    Raises
    ------
    InvalidInputError
        If `space` is neither.
    NotAMetricError
        If the matrix is not a metric.
    """
    if isinstance(space, MetricSpace):
        return space
    if hasattr(space, "faces") or hasattr(space, "adj") or issparse(space):
        raise InvalidInputError(
            f"space is a {type(space).__name__}; give a MetricSpace or a square matrix of distances "
            "(geodesic_space makes one of a mesh, MetricSpace.from_graph of a graph)."
        )
    return MetricSpace(space)


def finite_distances(space: Any) -> Floats:
    """The distance matrix of a space in one part.

    Raises
    ------
    InvalidInputError
        If `space` is no space.
    NotAMetricError
        If the matrix is not a metric, or a distance is infinite.
    """
    D = as_metric_space(space).distances
    apart = np.argwhere(np.isinf(D))
    if len(apart):
        i, j = (int(x) for x in apart[0])
        raise NotAMetricError(f"distances[{i}, {j}] is infinite; take one component.", (i, j))
    return D


def both_distances(X: Any, Y: Any) -> tuple[Floats, Floats]:
    """`finite_distances` of two spaces; an error says which of them it is about."""
    with naming("X"):
        DX = finite_distances(X)
    with naming("Y"):
        return DX, finite_distances(Y)


def _check_triangle_inequality(D: Floats, rtol: float) -> None:
    """Raise `NotAMetricError` for the triple with the largest excess, if that is above rtol times the diameter."""
    n_blocks = -(-len(D) // metrics.BLOCK)
    excesses, pairs = np.empty(n_blocks), np.empty((n_blocks, 2), np.intp)
    metrics.worst_excesses(D, excesses, pairs)
    if excesses.max() > rtol * D.max():
        i, j = sorted(int(x) for x in pairs[excesses.argmax()])
        k = int((D[i] + D[j]).argmin())
        raise NotAMetricError(
            f"distances[{i}, {j}] = {D[i, j]:.17g} exceeds distances[{i}, {k}] + distances[{k}, {j}] = "
            f"{D[i, k] + D[k, j]:.17g}; that is {excesses.max() / D.max():.2g} of the largest distance too much: "
            "repair the triangle inequality (shortest paths do) or raise rtol.",
            witness=(i, k, j),
        )
