"""Finite nets: points, chosen one after the other, that are nowhere far from the rest of the space."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow import tolerances
from rinow._arrays import as_index, as_indices, as_number
from rinow._printing import OneLine
from rinow.errors import InvalidInputError
from rinow.mesh import as_mesh, is_mesh_like
from rinow.metric_space import as_metric_space
from rinow.nets.balls import BallOf, covers, mesh_balls, space_balls, surface_radius_of, surface_vertices

__all__ = ["FarthestPointNet", "farthest_point_net", "is_epsilon_net"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True, repr=False)
class FarthestPointNet(OneLine):
    """A net of a space or of the vertices of a mesh.

    Attributes
    ----------
    indices : (size,) ndarray of intp
        The points of the net in the order of their choice.
    covering_radius : float
        Greatest distance of a point from the net, in the unit of length of the space; inf while a component of a mesh
        has no point of the net.
    labels : (n_points,) ndarray of intp
        Nearest point of the net, as its place in `indices`, the earliest of several; -1 for a vertex that is not on the
        surface (no face, or a position that is not finite).
    distances : (n_points,) ndarray of float
        Distance from that point; nan where the label is -1, inf in components without a point of the net.
    radii : (size,) ndarray of float
        Covering radius of the first 1, 2, ... points.  It decreases, and the first k points are at least
        ``radii[k - 2]`` apart from each other.
    surface_radius : float
        Upper bound of the distance of any point of the surface, inside the faces too, from the net; for a space equal
        to `covering_radius`.
    """

    indices: Indices
    covering_radius: float
    labels: Indices
    distances: Floats
    radii: Floats
    surface_radius: float


def farthest_point_net(
    space_or_mesh: Any, *, size: int | None = None, radius: float | None = None, start: int = 0
) -> FarthestPointNet:
    r"""Net of a finite metric space or of a surface by farthest points.

    The first point is `start`; each further one is the point farthest from those before it, the first of several.

    Parameters
    ----------
    space_or_mesh : MetricSpace, (n, n) array_like of float, or mesh
        The space, or a surface whose vertices are its points, with exact geodesic distances: `TriangleMesh`,
        `IntrinsicMesh`, ``(V, F)`` pair or object with vertices and faces.
    size : int, optional
        Number of points of the net.
    radius : float, optional
        Covering radius at which to stop, in the unit of length; with `size`, whichever comes first.
    start : int, default 0
        The first point.

    Returns
    -------
    net : FarthestPointNet
        The points, their true covering radius, and the nearest of them to each point of the space.

    Raises
    ------
    InvalidInputError
        If neither `size` nor `radius` is given, `size` is not between 1 and the number of points, `radius` is negative
        or nan, or `start` is out of range or not on the surface.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    is_epsilon_net : Whether given points are a net.
    rinow.epsilon_graph : The graph of a net that approximates a length space.

    Notes
    -----
    The points are at least `covering_radius` apart (they are a *packing*), so that no net of as many points has a
    covering radius below half of it [1]_.  A net Y of X with the covering radius r has :math:`d_{GH}(X, Y) \le r`.
    On a space the cost is O(size · n_points).  On a mesh each new point asks for the ball whose radius is the covering
    radius before it, so that all balls together cost about log(size) times a whole mesh.

    References
    ----------
    .. [1] T. Gonzalez, "Clustering to minimize the maximum intercluster distance", Theor. Comput. Sci. 38 (1985).

    Examples
    --------
    Points 0, 1, ..., 8 of a line:

    >>> net = farthest_point_net(abs(np.arange(9.0)[:, None] - np.arange(9.0)), size=3)
    >>> net.indices, net.covering_radius, net.labels
    (array([0, 8, 4]), 2.0, array([0, 0, 0, 2, 2, 2, 1, 1, 1]))
    """
    if is_mesh_like(space_or_mesh):
        mesh = as_mesh(space_or_mesh)
        candidates, n_points, ball_of = surface_vertices(mesh), mesh.n_vertices, mesh_balls(mesh)
    else:
        D = as_metric_space(space_or_mesh).distances
        mesh, candidates, n_points, ball_of = None, np.arange(len(D)), len(D), space_balls(D)
    limit = _as_size(size, radius, len(candidates))
    first = as_index(start, n_points, "start")
    if first not in candidates:
        raise InvalidInputError(f"start = {first} is not on the surface: it has no face or no position; take another.")
    indices, radii, distances, labels = _grow(
        ball_of, n_points, candidates, first, limit, -1.0 if radius is None else radius
    )
    reached = float(radii[-1])
    within = reached if mesh is None else surface_radius_of(mesh, distances)
    return FarthestPointNet(indices, reached, labels, distances, radii, within)


def _as_size(size: int | None, radius: float | None, n_points: int) -> int:
    """Greatest number of points, checked."""
    if size is None and radius is None:
        raise InvalidInputError("size and radius are both missing; give the number of points or the covering radius.")
    if radius is not None and not as_number(radius, "radius") >= 0.0:
        raise InvalidInputError(f"radius = {radius} is not a radius; give a number that is not negative.")
    if size is not None and not 1 <= as_number(size, "size") <= n_points:
        raise InvalidInputError(f"size = {size} is outside 1..{n_points}, the number of points of the space.")
    if size is not None and size != int(size):
        raise InvalidInputError(f"size = {size} is not a number of points; give a whole number.")
    return n_points if size is None else int(size)


def _grow(
    ball_of: BallOf, n_points: int, candidates: Indices, first: int, limit: int, radius: float
) -> tuple[Indices, Floats, Floats, Indices]:
    """Indices, covering radii, distances and labels of the net."""
    distances, labels = np.full(n_points, np.nan), np.full(n_points, -1, np.intp)
    distances[candidates] = np.inf
    waiting = np.where(np.isnan(distances), -1.0, distances)  # the same, but -1 for points that are not to be chosen
    indices, radii, farthest, reached = list[int](), list[float](), first, math.inf
    while True:
        indices.append(farthest)
        points, near = ball_of(farthest, reached)
        closer = near < distances[points]
        place = np.flatnonzero(closer) if isinstance(points, slice) else points[closer]
        distances[place] = waiting[place] = near[closer]
        labels[place] = len(indices) - 1
        waiting[farthest] = -1.0
        farthest = int(waiting.argmax())
        reached = max(float(waiting[farthest]), 0.0)
        radii.append(reached)
        if len(indices) == limit or reached <= radius:
            return np.array(indices), np.array(radii), distances, labels


def is_epsilon_net(space: Any, indices: ArrayLike, epsilon: float) -> bool:
    r"""Whether every point of a space, or vertex of a surface, is within a distance of some given points.

    Parameters
    ----------
    space : MetricSpace, (n, n) array_like of float, or mesh
        The space, or a surface whose vertices are its points, with exact geodesic distances.
    indices : (k,) array_like of int
        At least one point.
    epsilon : float
        The distance, not negative, in the unit of length.

    Returns
    -------
    is_net : bool
        Vertices that are not on the surface (no face, or a position that is not finite) do not count.

    Raises
    ------
    InvalidInputError
        If `indices` is empty or out of range, or `epsilon` is negative or nan.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    farthest_point_net : A net with its covering radius.

    Notes
    -----
    The definition is closed: :math:`d(x, A) \le ε` for all x (footnote to Example 2.28 of the paper).  On a mesh ε
    counts as larger by a share of 1e-12, the rounding of geodesic distances.

    Examples
    --------
    >>> line = abs(np.arange(9.0)[:, None] - np.arange(9.0))
    >>> is_epsilon_net(line, [1, 4, 7], 1.0), is_epsilon_net(line, [1, 7], 1.0)
    (True, False)
    """
    if not as_number(epsilon, "epsilon") >= 0.0:
        raise InvalidInputError(f"epsilon = {epsilon} is not a radius; give a number that is not negative.")
    if is_mesh_like(space):
        mesh = as_mesh(space)
        return covers(mesh, _as_chosen(indices, mesh.n_vertices), epsilon * (1.0 + tolerances.COMPARISON))
    D = as_metric_space(space).distances
    return bool((D[:, _as_chosen(indices, len(D))].min(axis=1) <= epsilon).all())


def _as_chosen(indices: ArrayLike, n_points: int) -> Indices:
    """At least one point."""
    chosen = as_indices(indices, n_points, "indices")
    if chosen.ndim != 1 or not len(chosen):
        raise InvalidInputError(f"indices has shape {chosen.shape}; give one list of at least one index.")
    return chosen
