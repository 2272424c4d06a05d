"""Regular disks: those around a point in which all embedding curvatures are small (3.23 of the paper)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rinow._arrays import as_indices, in_safe_unit, in_unit
from rinow.curvature.metric_rows import metric_rows
from rinow.curvature.regions import region
from rinow.kernels import regularity

__all__ = ["regular_radius"]

SETTLED = 0.99
"""The radius stays when another sample changes it by less than this share."""


def regular_radius(space: Any, point: int, *, rtol: float | None = None, max_points: int = 32) -> float:
    r"""Radius of the largest regular disk around a point.

    A disk of radius ρ is regular if each of its non-linear quadruples has an embedding curvature of modulus below
    :math:`\pi^2/(16\rho^2)`.

    Parameters
    ----------
    space : MetricSpace, mesh, (n, n) or (n, d) array_like, or graph
        Distances; a surface with exact geodesic distances of its vertices; points with straight distances, or with
        arcs where at least 25 of them lie on a surface in space; or edge lengths (scipy sparse or networkx) with
        shortest paths.
    point : int
        Index of the centre.
    rtol : float, optional
        Share by which a distance may be wrong, as for `rinow_curvature`.
    max_points : int, default 32
        Of more points in a disk this many are examined, each as far as possible from those before it.

    Returns
    -------
    radius : float
        Supremum of the radii of regular open disks, in the unit of the distances; inf if every disk is regular.

    Raises
    ------
    InvalidInputError
        If `space` is none of these, `point` is out of range, or no path joins two points.
    NotAMetricError
        If a matrix is not a metric, or a graph is not connected.

    See Also
    --------
    wald_curvature : The limit of embedding curvatures at a point.

    Notes
    -----
    A quadruple with the embedding curvature k, the smaller in modulus of two, spoils the disks that contain it and
    have a radius above :math:`\pi/(4\sqrt{|k|})`; one without spoils all that contain it.  More points cannot enlarge
    the radius, and on a surface of constant curvature k it is :math:`\pi/(4\sqrt{|k|})`.  Smaller disks are sampled
    anew until the radius stays, to one part in a hundred: of more than `max_points` points the result is an upper
    bound that close.  The cost is O(max_points⁴) for each disk, a tenth of a second for 32 points.

    References
    ----------
    Definition 3.23 of the paper, with "has an embedding curvature" for "its curvature is".

    Examples
    --------
    >>> from rinow import SpaceForm
    >>> sphere = SpaceForm(1.0)
    >>> P = sphere.sample(20, 1.0, np.random.default_rng(7))
    >>> bool(np.isclose(regular_radius(sphere.distance(P[:, None], P), 0), np.pi / 4))
    True
    """
    rows = metric_rows(space)
    reach = float(rows.row(int(as_indices(point, rows.n_points, "point")), math.inf).max())
    radius = math.inf
    while reach > 0:
        examined = min(radius, reach)
        ball = region(rows, point, examined, size=max_points, rtol=rtol)
        D, exponent = in_safe_unit(ball.distances)
        order = np.argsort(D[0], kind="stable")
        bounds = np.empty(len(order))
        regularity.regular_radii(np.ascontiguousarray(D[np.ix_(order, order)]), ball.rtol, bounds)
        radius = min(radius, float(in_unit(bounds.min(), exponent)))
        if radius >= SETTLED * examined:
            break
    return radius
