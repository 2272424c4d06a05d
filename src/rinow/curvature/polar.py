"""Angles at a point and polar coordinates around it (3.30 and 3.31 of the paper, corrected)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow import tolerances
from rinow._arrays import as_indices
from rinow.curvature.metric_rows import MetricRows, Rose, exact, metric_rows
from rinow.curvature.units import LARGEST_SCALE
from rinow.curvature.wald_point import wald_curvature
from rinow.embedding.spaceform import SpaceForm
from rinow.errors import InvalidInputError

__all__ = ["angle_at", "polar_coordinates"]

Floats = NDArray[np.float64]

ALIGNED = math.sqrt(tolerances.COMPARISON)
"""Angles below this are 0 up to rounding, which the angle of a linear triple magnifies to its square root."""
POINTS = 12
"""Points from which the curvature near the vertex of an angle is estimated: 495 quadruples."""


def angle_at(space: Any, p: int, q: int, r: int, *, curvature: float | None = None) -> float:
    r"""Angle at p between the shortest paths to q and to r.

    It is :math:`2\arcsin(\tfrac12 \lim d(x)/x)`, where d(x) is the distance of the points at distance x from p on
    the two paths.

    Parameters
    ----------
    space : MetricSpace, mesh, (n, n) or (n, d) array_like, or graph
        Distances; a surface with exact geodesic distances of its vertices; points with straight distances; or edge
        lengths (scipy sparse or networkx) with shortest paths.
    p, q, r : int
        Vertex of the angle and a point on each leg.
    curvature : float, optional
        Curvature near p in 1/length²; by default that of Wald in the ball around p through the farther one of q and r,
        and 0 where there is none.  A mesh needs none.

    Returns
    -------
    angle : float
        In radians, in [0, π]; nan if q or r is at distance 0 from p or not connected with it, or if the triangle p q r
        does not fit into the surface of the given curvature.

    Raises
    ------
    InvalidInputError
        If an index is out of range or `space` is no space.
    NotAMetricError
        If a matrix is not a metric, or a graph is not connected.

    See Also
    --------
    polar_coordinates : Distances and angles of all points.

    Notes
    -----
    On a mesh it is the exact angle between the directions in which the shortest paths leave p, measured along the
    faces: at most half of the angles around p, or π.  (At a vertex where faces do not form one fan it is found as in
    other spaces.)

    Elsewhere the limit is that of the comparison angle in the triangle p x r as x tends to p along p q (first
    variation of length), or with q and r exchanged.  Points of the space that lie between p and q, up to 1e-12 of the
    distances, stand for x: a line in d(p, x) through two of their comparison angles is followed to 0.  Without such
    points the angle is that of the triangle p q r in the surface of the given curvature: exact on a surface of that
    curvature, else wrong by a third of the difference times the area of the triangle.

    References
    ----------
    Definition 3.30 of the paper.

    Examples
    --------
    >>> bool(np.isclose(angle_at([[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]], 0, 1, 2), np.pi / 4))
    True
    """
    rows = metric_rows(space)
    p, q, r = (int(i) for i in as_indices([p, q, r], rows.n_points, "(p, q, r)"))
    if (rose := rows.rose(p)) is not None:
        return float(_turns(rose, q)[r])
    leg, other = _leg(rows, p, q), r
    if len(reverse := _leg(rows, p, r)) > len(leg):
        leg, other = reverse, q
    return float(_limits(rows, p, leg, _surface(rows, p, (q, r), curvature))[other])


def polar_coordinates(space: Any, p: int, p1: int, p2: int, *, curvature: float | None = None) -> Floats:
    r"""Distance from p and direction at p of every point.

    Parameters
    ----------
    space : MetricSpace, mesh, (n, n) or (n, d) array_like, or graph
        As for `angle_at`.
    p : int
        Origin.
    p1, p2 : int
        Points in the direction 0 and in a direction between 0 and π.
    curvature : float, optional
        As for `angle_at`, with p1 and p2 for q and r.

    Returns
    -------
    coordinates : (n, 2) ndarray of float
        Distance r >= 0 and angle θ in [0, 2π) of every point; θ = 0 at distance 0, and nan where `angle_at` is.

    Raises
    ------
    InvalidInputError
        If an index is out of range, `space` is no space, p, p1 and p2 lie on one shortest path, or none leads to p1 or
        p2.
    NotAMetricError
        If a matrix is not a metric, or a graph is not connected.

    See Also
    --------
    angle_at : One angle.

    Notes
    -----
    With m(q, p, r) the angle at p, θ is :math:`m(q, p, p_1)` if :math:`|m(p_2, p, p_1) - m(q, p, p_1)| = m(q, p, p_2)`
    and 2π minus that otherwise.  The paper prints m(q, p, p1) on the right, which is wrong: with p1, p2 at 0 and 60
    degrees it places a point at 40 degrees at 320.  At a cone point θ has a gap in the middle, since m is at most half
    of the full angle, or at an excess of angle jumps there.  Angles of a sample satisfy no equation exactly, so θ is
    the one of the two whose angle to p2 is nearer to m(q, p, p2); on a mesh the directions themselves tell the side.

    References
    ----------
    Remark 3.31 of the paper.

    Examples
    --------
    >>> points = [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -2]]
    >>> polar_coordinates(points, 0, 1, 2).round(4)
    array([[0.    , 0.    ],
           [1.    , 0.    ],
           [1.    , 1.5708],
           [1.    , 3.1416],
           [2.    , 4.7124]])
    """
    rows = metric_rows(space)
    p, p1, p2 = (int(i) for i in as_indices([p, p1, p2], rows.n_points, "(p, p1, p2)"))
    if (rose := rows.rose(p)) is not None:
        first, second = _turns(rose, p1), _turns(rose, p2)
    else:
        surface = _surface(rows, p, (p1, p2), curvature)
        first, second = (_limits(rows, p, _leg(rows, p, q), surface) for q in (p1, p2))
    frame = first[p2]
    if not 0 < frame < math.pi:
        raise InvalidInputError(f"p, p1, p2 = {p}, {p1}, {p2} have the angle {frame:.6g}; choose p2 off the line p p1.")
    near_side = _near_side(first, second, frame) if rose is None else _turned_towards(rose, p1, p2)
    theta = np.where(near_side | (first <= ALIGNED), first, 2 * math.pi - first)
    r = rows.row(p, math.inf)
    return np.stack([r, np.where(r > 0, theta, 0.0)], axis=1)


def _leg(rows: MetricRows, p: int, q: int) -> NDArray[np.intp]:
    """The points on the shortest path from p to q, from the nearest to q; those at distance 0 from p left out."""
    from_p, from_q = rows.row(p, math.inf), rows.row(q, math.inf)
    with np.errstate(invalid="ignore"):  # of points that no path leads to
        between = from_p + from_q - from_p[q] <= tolerances.COMPARISON * from_p[q]
    between[q] = True
    points = np.flatnonzero(between & (from_p > 0))
    return points[np.argsort(from_p[points], kind="stable")]


def _turns(rose: Rose, q: int) -> Floats:
    """Angle between the path to q and that to every point."""
    turn = np.abs(rose.directions - rose.directions[q])
    return np.minimum(np.minimum(turn, rose.total - turn), math.pi)


def _turned_towards(rose: Rose, p1: int, p2: int) -> NDArray[np.bool_]:
    """Whether the shorter turn from p1 to every point goes in the sense of that from p1 to p2."""
    turn = rose.directions - rose.directions[p1]
    if math.isfinite(rose.total):
        turn -= rose.total * np.round(turn / rose.total)
    return turn * turn[p2] >= 0


def _near_side(first: Floats, second: Floats, frame: float) -> NDArray[np.bool_]:
    """Whether the angles with p1 and p2 differ, rather than add up or go round, to the angle between p1 and p2."""
    beyond = np.minimum(frame + first, 2 * math.pi - frame - first)
    return np.abs(np.abs(frame - first) - second) <= np.abs(beyond - second)


def _surface(rows: MetricRows, p: int, ends: tuple[int, int], curvature: float | None) -> SpaceForm:
    """The surface of the given curvature, or of that of Wald at p, at the scale of the two points, or the plane."""
    radius = float(rows.row(p, math.inf)[list(ends)].max())
    if curvature is None and 0 < radius < math.inf:
        if not 1.0 / LARGEST_SCALE < radius < LARGEST_SCALE:
            raise InvalidInputError(f"distances reach {radius:.3g}, and their curvature is no number; scale them.")
        found = wald_curvature(rows._replace(finish=exact), p, radius=radius, max_points=POINTS)
        curvature = found.value if found.exists else None
    return SpaceForm(curvature or 0.0)


def _limits(rows: MetricRows, p: int, leg: NDArray[np.intp], surface: SpaceForm) -> Floats:
    """Angle at p between the leg and the path to every point, followed to p from two points of the leg."""
    from_p = rows.row(p, math.inf)
    if not len(leg):
        return np.full(rows.n_points, np.nan)
    x = from_p[leg]
    pair = leg[[0, int(np.searchsorted(x, 2 * x[0]))]] if x[-1] >= 2 * x[0] else leg[:1]
    angles = [surface.angle(rows.row(int(i), math.inf), from_p[i], from_p) for i in pair]
    with np.errstate(invalid="ignore"):
        limit = angles[0] + (angles[0] - angles[-1]) * x[0] / max(from_p[pair[-1]] - x[0], x[0])
    return np.where(from_p > 0, np.clip(limit, 0.0, math.pi), np.nan)
