"""The distances of spaces of every kind, one row at a time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, issparse

from rinow import tolerances
from rinow._arrays import as_floats, as_points, in_safe_unit, in_unit
from rinow.curvature.clouds import arc_distances
from rinow.errors import InvalidInputError
from rinow.geodesics.exact import ExactGeodesics
from rinow.mesh import IntrinsicMesh, TriangleMesh, as_mesh, is_mesh_like
from rinow.metric_space import MetricSpace

__all__ = ["MetricRows", "Rose", "exact", "metric_rows"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


class Rose(NamedTuple):
    """The directions in which the shortest paths leave a point."""

    directions: Floats
    """Angle of the path to every point, counted along the surface in radians; nan for the point itself."""
    total: float
    """Angle of a full turn; inf at a boundary, where directions do not close up."""


class MetricRows(NamedTuple):
    """A space as a function from a point to its distances."""

    n_points: int
    row: Callable[[int, float], Floats]
    """Distances from a point to all points; those beyond the limit given may be inf."""
    block: Callable[[Indices, float], Floats]
    """Distances between some points; those beyond the limit given may be inf."""
    finish: Callable[[Indices, Indices, Floats], tuple[Floats, float]]
    """From the points of a region, places of some in it and their distances: better distances, and their error."""
    rose: Callable[[int], Rose | None]
    """The directions at a point, None where only distances are known."""


def metric_rows(space: Any) -> MetricRows:
    """The distances of a space of any kind.

    Parameters
    ----------
    space : MetricSpace, mesh, (n, n) or (n, d) array_like, graph, or MetricRows
        Distances; a surface with exact geodesic distances of its vertices; points with straight distances, or in
        regions where they lie on a surface in space with arcs along it; or edge lengths (scipy sparse or networkx)
        with shortest paths.  A square array holds distances.

    Raises
    ------
    InvalidInputError
        If `space` is none of these.
    """
    if isinstance(space, MetricRows):
        return space
    if is_mesh_like(space):
        return _surface(as_mesh(space))
    if issparse(space) or hasattr(space, "nodes"):
        space = MetricSpace.from_graph(space)
    if not isinstance(space, MetricSpace):
        values = as_floats(space, "space")
        if values.ndim != 2 or values.shape[0] != values.shape[1]:
            return _cloud(as_points(values, "space"))
        space = MetricSpace(values)
    return _matrix(space)


def _matrix(space: MetricSpace) -> MetricRows:
    """The rows of a matrix."""
    D = space.distances

    def row(i: int, limit: float) -> Floats:
        return D[i]

    def block(some: Indices, limit: float) -> Floats:
        return D[np.ix_(some, some)]

    return MetricRows(len(D), row, block, exact, _no_rose)


def _cloud(points: Floats) -> MetricRows:
    """Points with straight distances, or arcs along the surface in space that they lie on."""
    if not len(points) or not np.isfinite(points).all():
        raise InvalidInputError(f"space has {len(points)} points, not all finite; give at least one, all finite.")
    P, exponent = in_safe_unit(points)

    def row(i: int, limit: float) -> Floats:
        return in_unit(np.linalg.norm(P - P[i], axis=1), exponent)

    def finish(members: Indices, chosen: Indices, D: Floats) -> tuple[Floats, float]:
        arcs = arc_distances(P[members], chosen) if P.shape[1] == 3 else None
        return (in_unit(arcs[0], exponent), arcs[1]) if arcs else exact(members, chosen, D)

    def block(some: Indices, limit: float) -> Floats:
        return in_unit(np.linalg.norm(P[some, None] - P[some], axis=2), exponent)

    return MetricRows(len(P), row, block, finish, _no_rose)


def _surface(mesh: TriangleMesh | IntrinsicMesh) -> MetricRows:
    """Vertices with exact geodesic distances."""
    geodesics = ExactGeodesics(mesh)

    def row(i: int, limit: float) -> Floats:
        if np.isinf(limit):
            return np.asarray(geodesics.distances([i]), np.float64)[0]
        near = csr_array(geodesics.distances([i], max_distance=limit))
        distances = np.full(mesh.n_vertices, np.inf)
        distances[near.indices] = near.data
        distances[i] = 0.0
        return distances

    def block(some: Indices, limit: float) -> Floats:
        if np.isinf(limit):
            return np.asarray(geodesics.distances(some), np.float64)[:, some]
        near = coo_array(csr_array(geodesics.distances(some, max_distance=limit))[:, some])
        distances = np.full((len(some), len(some)), np.inf)
        distances[near.coords] = near.data
        np.fill_diagonal(distances, 0.0)
        return distances

    def finish(members: Indices, chosen: Indices, D: Floats) -> tuple[Floats, float]:
        return D, max(_chord_error(mesh, members), tolerances.COMPARISON)

    def rose(i: int) -> Rose | None:
        distances = row(i, np.inf)
        reach = float(distances[np.isfinite(distances)].max(initial=0.0))
        ball = geodesics.polar([i], max_distance=reach * (1 + tolerances.COMPARISON))
        if not ball.total_angles[0] > 0:
            return None
        directions = np.full(mesh.n_vertices, np.nan)
        directions[ball.vertices] = ball.directions
        on_boundary = mesh.topology.vertex_is_boundary[i]
        return Rose(directions, np.inf if on_boundary else float(ball.total_angles[0]))

    return MetricRows(mesh.n_vertices, row, block, finish, rose)


def _no_rose(i: int) -> None:
    """Nothing is known of directions."""


def exact(members: Indices, chosen: Indices, D: Floats) -> tuple[Floats, float]:
    """Distances that are as good as float64 allows."""
    return D, tolerances.COMPARISON


def _chord_error(mesh: TriangleMesh | IntrinsicMesh, members: Indices) -> float:
    """Largest share by which an edge between the points is shorter than the arc it stands for.

    An arc of curvature κ is longer than its chord c by the share (κc)²/24 (Haantjes), and κc is the angle between the
    normals at its ends.  A path across faces lies deeper in the surface, and is short by up to two and a half times
    that: lengths in different directions differ by ± one such share, and only their ratios bend quadruples.  Without
    positions, c² K is taken as in a regular star: 2/√3 times the angle defect.
    """
    inside = np.zeros(mesh.n_vertices, np.bool_)
    inside[members] = True
    if isinstance(mesh, IntrinsicMesh):
        turns = 2 / 3**0.5 * np.abs(mesh.vertex_angle_defects[inside & ~mesh.topology.vertex_is_boundary])
    else:
        edges = mesh.topology.edges
        ends = mesh.vertex_normals[edges[inside[edges].all(axis=1)]]
        turns = ((ends[:, 0] - ends[:, 1]) ** 2).sum(axis=1)
    return float(turns.max(initial=0.0)) / 24
