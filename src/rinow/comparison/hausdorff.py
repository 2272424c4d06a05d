"""Hausdorff distance of point sets in any metric space, and of surfaces in space."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from rinow._arrays import as_indices, as_number, as_points
from rinow._printing import OneLine
from rinow.comparison.hausdorff_surfaces import surface_distance
from rinow.comparison.surface_tree import frame_of, surface_of_mesh, surface_of_points
from rinow.errors import InvalidInputError, InvalidMeshError
from rinow.mesh import TriangleMesh, as_triangle_mesh, is_mesh_like
from rinow.metric_space import as_metric_space

__all__ = ["HausdorffDistance", "hausdorff_distance"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_ENTRIES = 1 << 22  # of a distance matrix copied at one time


@dataclass(frozen=True, slots=True, repr=False)
class HausdorffDistance(OneLine):
    """The Hausdorff distance of two sets as an interval, with the points that show it.

    Attributes
    ----------
    lower, upper : float
        The distance lies between them, in the unit of length of the input; equal for finite sets.
    witness_a, witness_b : int or (3,) ndarray of float
        A point of A and a point of B at distance `lower` from each other: one of them is farthest from the other set,
        the other one is nearest to it.  Row of a point array, element of an index set, position on a surface.
    distances_a : (n_a,) ndarray of float
        Distance of each point or vertex of A from B; nan for a vertex that is not on the surface (no face, or a
        position that is not finite).
    distances_b : (n_b,) ndarray of float
        Distance of each point or vertex of B from A.
    directed_a : (2,) tuple of float
        Bounds of the greatest distance of a point of A from B.  The upper one is as near as asked for in the larger of
        the two directions only.
    directed_b : (2,) tuple of float
        Bounds of the greatest distance of a point of B from A.
    """

    lower: float
    upper: float
    witness_a: int | Floats
    witness_b: int | Floats
    distances_a: Floats
    distances_b: Floats
    directed_a: tuple[float, float]
    directed_b: tuple[float, float]


def hausdorff_distance(A: Any, B: Any, *, space: Any = None, tolerance: float = 1e-4) -> HausdorffDistance:
    r"""Hausdorff distance of two sets: of points, of subsets of a metric space, or of surfaces.

    The distance is the least r such that every point of one set is within r of the other set.

    Parameters
    ----------
    A, B : (n, dimension) array_like of float, (n,) array_like of int, or mesh
        Points of a Euclidean space; with `space`, indices of its points; or surfaces: `TriangleMesh`, ``(V, F)`` pair
        or object with vertices and faces.  A surface is the union of its faces; vertices without a face, and faces
        with a repeated or a non-finite vertex, are no part of it, faces without area are.  A mesh may be compared with
        points in space.
    space : MetricSpace or (n_points, n_points) array_like of float, optional
        The metric space that `A` and `B` are subsets of.
    tolerance : float, default 1e-4
        For surfaces, the greatest ``upper - lower`` relative to the diagonal of the larger of their bounding boxes.

    Returns
    -------
    distance : HausdorffDistance
        Bounds, witnesses, and the distance of every point or vertex from the other set.

    Raises
    ------
    InvalidInputError
        If a set is empty, a point is not finite, an index is out of range, the dimensions differ, or `tolerance` is
        not positive.
    InvalidMeshError
        If a mesh has edge lengths only, or no face that takes part.
    NotAMetricError
        If `space` is a matrix that is not a metric.

    See Also
    --------
    rinow.gromov_hausdorff : The least Hausdorff distance over all isometric embeddings.

    Notes
    -----
    .. math:: d_H(A, B) = \max\{\sup_{a \in A} d(a, B), \sup_{b \in B} d(b, A)\}

    the max-min form of Definition 2.18 of the paper; the neighbourhood form
    :math:`\inf\{r : A \subset U_r(B), B \subset U_r(A)\}` is the same number.  Unlike there, the empty set is refused:
    its distance from any other set is undefined.

    On surfaces the greatest distance of a face from the other surface is enclosed as follows.  The distance from one
    triangle is convex, so that over a convex piece it is greatest at a corner; a face is cut into pieces until each has
    a triangle of the other surface that is no farther than the lower bound plus the tolerance.  Cuts follow the sides
    of the triangles of the other surface, so that surfaces which nearly coincide need few pieces whatever the
    tolerance.  Lower bounds are distances of points from the other surface.  Both bounds include rounding.  Memory is
    linear; the time of two meshes of 100,000 faces is some seconds.

    Examples
    --------
    Two sets of numbers, and two parallel squares:

    >>> result = hausdorff_distance([[0.0], [1.0], [5.0]], [[0.0], [2.0]])
    >>> result.upper, result.witness_a, result.witness_b
    (3.0, 2, 1)
    >>> V = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> F = [[0, 1, 2], [0, 2, 3]]
    >>> result = hausdorff_distance((V, F), ([[x, y, 0.25] for x, y, _ in V], F))
    >>> result.lower <= 0.25 <= result.upper, result.distances_a
    (True, array([0.25, 0.25, 0.25, 0.25]))
    """
    check_tolerance(tolerance)
    if space is not None:
        return _between_subsets(as_metric_space(space).distances, A, B)
    if is_mesh_like(A) or is_mesh_like(B):
        return _between_surfaces(_as_surface(A, "A"), _as_surface(B, "B"), tolerance)
    P, Q = as_point_set(A, "A"), as_point_set(B, "B")
    if P.shape[1] != Q.shape[1]:
        raise InvalidInputError(f"A has points of dimension {P.shape[1]}, B of dimension {Q.shape[1]}; give the same.")
    return _between_points(P, Q)


def check_tolerance(tolerance: float) -> None:
    """Refuse a tolerance that is not positive and finite."""
    if not 0.0 < as_number(tolerance, "tolerance") < np.inf:
        raise InvalidInputError(f"tolerance = {tolerance} is not positive; give a share of the diagonal such as 1e-4.")


def _as_surface(value: Any, name: str) -> TriangleMesh | Floats:
    return as_triangle_mesh(value) if is_mesh_like(value) else as_point_set(value, name, 3)


def as_point_set(points: Any, name: str, dimension: int | None = None) -> Floats:
    """At least one finite point."""
    P = as_points(points, name, dimension)
    if not P.size:
        raise InvalidInputError(f"{name} is empty; the Hausdorff distance needs at least one point in each set.")
    wrong = np.argwhere(~np.isfinite(P))
    if len(wrong):
        i, k = wrong[0]
        raise InvalidInputError(f"{name}[{i}, {k}] = {P[i, k]} is not finite; remove the point.")
    return P


def _of_finite_sets(distances_a: Floats, nearest_a: Indices, distances_b: Floats, nearest_b: Indices) -> Any:
    """The result from the distance and the nearest point of each point."""
    i, j = int(distances_a.argmax()), int(distances_b.argmax())
    far_a, far_b = float(distances_a[i]), float(distances_b[j])
    pair = (i, int(nearest_a[i])) if far_a >= far_b else (int(nearest_b[j]), j)
    d = max(far_a, far_b)
    return HausdorffDistance(d, d, *pair, distances_a, distances_b, (far_a, far_a), (far_b, far_b))


def _between_points(P: Floats, Q: Floats) -> HausdorffDistance:
    frame = frame_of(P, Q)
    p, q = frame.enter(P), frame.enter(Q)
    nearest_a = np.asarray(KDTree(q).query(p, workers=-1)[1])
    nearest_b = np.asarray(KDTree(p).query(q, workers=-1)[1])
    distances_a = np.linalg.norm(p - q[nearest_a], axis=1) * frame.unit
    distances_b = np.linalg.norm(q - p[nearest_b], axis=1) * frame.unit
    return _of_finite_sets(distances_a, nearest_a, distances_b, nearest_b)


def _between_subsets(D: Floats, A: Any, B: Any) -> HausdorffDistance:
    """The exact distance of two lists of points of one space; the witnesses are points of the space."""
    chosen: list[Indices] = []
    for name, value in (("A", A), ("B", B)):
        indices = as_indices(value, len(D), name)
        if indices.ndim != 1 or not len(indices):
            raise InvalidInputError(f"{name} has shape {indices.shape}; give one list of at least one index.")
        chosen.append(indices)
    a, b = chosen
    result = _of_finite_sets(*_row_minima(D, a, b), *_row_minima(D, b, a))
    return replace(result, witness_a=int(a[result.witness_a]), witness_b=int(b[result.witness_b]))


def _row_minima(D: Floats, rows: Indices, columns: Indices) -> tuple[Floats, Indices]:
    """Least distance of each row point from the column points, and the position of the first that has it."""
    least, place = np.empty(len(rows)), np.empty(len(rows), np.intp)
    step = max(_ENTRIES // len(columns), 1)
    for first in range(0, len(rows), step):
        block = D[np.ix_(rows[first : first + step], columns)]
        place[first : first + step] = block.argmin(axis=1)
        least[first : first + step] = block.min(axis=1)
    return least, place


def _between_surfaces(A: TriangleMesh | Floats, B: TriangleMesh | Floats, tolerance: float) -> HausdorffDistance:
    """The interval between two sets of which one at least is a surface, in their own unit and place."""
    sets = [X.vertices[X.topology.vertex_is_used] if isinstance(X, TriangleMesh) else X for X in (A, B)]
    for name, points in zip("AB", sets, strict=True):
        if not len(points):
            raise InvalidMeshError(f"{name} has no face with three different finite vertices; its surface is empty.")
    frame = frame_of(*sets)
    diagonal = max(float(np.linalg.norm(np.ptp(frame.enter(points), axis=0))) for points in sets)
    a, b = (surface_of_mesh(X, frame) if isinstance(X, TriangleMesh) else surface_of_points(X, frame) for X in (A, B))
    result = surface_distance(a, b, tolerance * diagonal)
    unit = frame.unit
    return HausdorffDistance(
        result.lower * unit,
        result.upper * unit,
        frame.leave(result.witnesses[0]),
        frame.leave(result.witnesses[1]),
        result.distances[0] * unit,
        result.distances[1] * unit,
        (result.directed[0][0] * unit, result.directed[0][1] * unit),
        (result.directed[1][0] * unit, result.directed[1][1] * unit),
    )
