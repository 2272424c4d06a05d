"""Regions of a space as small distance matrices, of points spread as widely as can be."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow import tolerances
from rinow._arrays import as_indices, read_only
from rinow.curvature.metric_rows import MetricRows, metric_rows
from rinow.errors import InvalidInputError

__all__ = ["Region", "region"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

BLOCK = 256
"""Distances between so many points are computed at once."""


@dataclass(frozen=True, slots=True)
class Region:
    """Points of a space, each as far as possible from those before it.

    Attributes
    ----------
    indices : (n,) ndarray of intp
        The points, by their index in the space.
    distances : (n, n) ndarray of float
        Their distances, none 0 off the diagonal.
    rtol : float
        Share by which a distance may be off.
    """

    indices: Indices
    distances: Floats
    rtol: float


def region(
    space: Any, points: ArrayLike | None = None, radius: float | None = None, *, size: int, rtol: float | None = None
) -> Region:
    """Farthest-point sample of a space, of some of its points, or of the ball around one.

    Parameters
    ----------
    space : MetricSpace, mesh, (n, n) or (n, d) array_like, graph, or MetricRows
        As for `metric_rows`.
    points : int or (k,) array_like of int, optional
        The points of the region, all by default.
    radius : float, optional
        Take the closed ball of this radius around the one point given.
    size : int
        Number of points to keep at most.
    rtol : float, optional
        Error of the distances; by default rounding, and for a mesh what its chords miss of a smooth surface.

    Returns
    -------
    region : Region
        It begins with the first point given, the centre of a ball; points at distance 0 from another are left out.

    Raises
    ------
    InvalidInputError
        If an index is out of range, two points are not connected, or `radius` comes without one point or the reverse.
    """
    rows = metric_rows(space)
    name = "point" if points is not None and np.ndim(points) == 0 else "points"
    members = np.arange(rows.n_points) if points is None else as_indices(points, rows.n_points, name)
    limit = np.inf
    if radius is not None or members.ndim == 0:
        if points is None or members.size != 1 or radius is None or not radius > 0:
            raise InvalidInputError(f"{name} = {points!r}, radius = {radius!r}: a ball has one centre, radius > 0.")
        centre, limit = int(members.ravel()[0]), 2.0 * radius * (1.0 + tolerances.TRIANGLE_INEQUALITY)
        inside = rows.row(centre, limit) <= radius
        inside[centre] = False
        members = np.r_[centre, np.flatnonzero(inside)]
    if not len(members):
        raise InvalidInputError("points is empty; give at least one index.")
    members = members.ravel()
    chosen, D = _farthest_points(rows, members, size, limit)
    if not np.isfinite(D).all():
        raise InvalidInputError("points are not all connected; take those of one component.")
    D, error = rows.finish(members, chosen, D)
    return Region(read_only(members[chosen]), read_only(D), error if rtol is None else float(rtol))


def _farthest_points(rows: MetricRows, members: Indices, size: int, limit: float) -> tuple[Indices, Floats]:
    """Places of points chosen one by one, each the farthest from those before it, and their distances."""
    block = rows.block(members, limit) if len(members) <= BLOCK else None

    def row_of(i: int) -> Floats:
        return rows.row(int(members[i]), limit)[members] if block is None else block[i]

    order, D = [0], [row_of(0)]
    nearest = D[0]
    while len(order) < size and nearest.max() > 0:
        order.append(int(nearest.argmax()))
        D.append(row_of(order[-1]))
        nearest = np.minimum(nearest, D[-1])
    distances = np.stack(D)[:, order]
    return np.array(order, np.intp), np.minimum(distances, distances.T)
