"""Curvature at the points of a cloud that lies on a surface, without a mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import as_points, as_radius
from rinow._printing import counted
from rinow.curvature.cloud_fit import cloud_estimate
from rinow.curvature.cloud_layers import cleaned
from rinow.curvature.cloud_sheet import cloud_sheet
from rinow.curvature.estimate import Estimate, undefined
from rinow.curvature.sheet import morton_order
from rinow.curvature.status import VertexStatus
from rinow.curvature.surface import SurfaceCurvature, assembled, relabelled, rescaled
from rinow.curvature.units import LARGEST_SCALE
from rinow.errors import InvalidInputError

__all__ = ["point_cloud_curvature"]

Floats = NDArray[np.float64]

LEAST_POINTS = 24
"""Points below which nothing is known: a quadric and its error need eight around each, which should be a third."""
SAME = 2.0**-46
"""Distance, over the extent, within which points differ by rounding only, as those of a pole do: they are one."""
STRAY_ROUNDS = 3
"""Times that strays are left out: many hide one another."""
NOTE = (
    "The points have no orientation: the normals agree between neighbours and point away from the middle of each part, "
    "or upwards at its highest point."
)


def point_cloud_curvature(points: ArrayLike, *, radius: float | None = None) -> SurfaceCurvature:
    r"""Gaussian, mean and principal curvatures at points that lie on a surface, or near one.

    Parameters
    ----------
    points : (n_points, 3) array_like of float
        Positions, in any unit of length.  Rows with nan or inf are allowed; points that are equal up to
        rounding get the same values.
    radius : float, optional
        Radius of the balls, positive, in the unit of length; by default each ball and the order of its polynomial
        are chosen from the data, as for meshes.

    Returns
    -------
    curvature : SurfaceCurvature
        Values in the order of the points, as `surface_curvature` has for vertices, with method "point_cloud".  The
        status is BOUNDARY where the neighbours leave out a wide angle, NONFINITE for such positions, and UNRESOLVED
        where the points around do not determine a surface.

    Raises
    ------
    InvalidInputError
        If `points` is not an array of rows of three numbers, or `radius` is not positive.

    See Also
    --------
    surface_curvature : The same with the faces of a mesh.

    Notes
    -----
    Each point is joined to its neighbours in the Delaunay triangulation of the 36 nearest points over the plane across
    its normal, and they to it; balls grow over these links as they do over the edges of a mesh, and the same
    polynomials over osculating tori are fitted to them.  The triangles on which the neighbours agree tell, as in a
    mesh, where the surface is flat and where fits over large balls have taken detail for noise.

    The signs of the normals, and with them those of the mean and the principal curvatures, cannot be known from
    points: they agree between neighbours.  Those of a connected part point away from its middle, which is right for
    closed surfaces, or, where that does not decide, as on a terrain, upwards at its highest point.  On a surface with
    one side only they change along a cut.  The Gaussian curvature does not depend on them.

    Points far from all others, and points beside the quadric of least moduli through those around them, by eight
    standard deviations of the noise and a third of the spacing, alone or much rarer than those, are left out: they are
    UNRESOLVED.  So are all of fewer than 24 points, and points whose standard error exceeds 1.3/radius², unless the
    stars around share two fifths of their triangles: where points fill a part of space, and on most of a curve.

    The mirror image of a cloud has the same curvature, up to the sign of H: where rectangles of points may be cut along
    either diagonal, the cloud tells which one its mirror image is not cut along, unless it is symmetric itself.

    Where a quadric does not fit all of the nearest points, only those that face the same way are neighbours, as on a
    thin wall.  If stars do not agree then, the sheet through the point is followed outwards, and only points on it are.
    Sheets are told from each other at nearly all points if they are 1.5 spacings apart in an even sample, two in a
    random one.  Of nearer ones more and more points are UNRESOLVED, and the spread of the others holds what two sheets
    taken for one with detail are off.

    `spread` is that of the fits of `surface_curvature`.  With much noise a tenth of the points of a border are not seen
    to be there: they have the status OK, but the spread of a border, as all its neighbours do.

    Where no fit over a ball is determined, a quadric is fitted to two rings of neighbours.  Lengths from 1e-140 to
    1e140 neither overflow nor underflow.

    Examples
    --------
    >>> import numpy as np
    >>> directions = np.random.default_rng(3).normal(size=(500, 3))
    >>> points = 2 * directions / np.linalg.norm(directions, axis=1)[:, None]
    >>> curvature = point_cloud_curvature(points)
    >>> np.median(curvature.gaussian).round(4), np.median(curvature.mean).round(4)
    (np.float64(0.25), np.float64(0.5))
    """
    P = as_points(points, "points", 3)
    reach = None if radius is None else as_radius(radius)
    finite = np.isfinite(P).all(axis=1)
    distinct, extent, place = _distinct(P[finite])
    estimate, status, n_strays = _of_distinct(distinct, None if reach is None else reach / extent)
    rows = np.full(len(P), len(distinct), np.intp)  # the last row is for the other points
    rows[finite] = place
    result = relabelled(rescaled(assembled(estimate, status, "point_cloud"), 1.0 / extent), rows)
    beside = "beside the surface of those around"
    what = counted(n_strays, f"point lies {beside} it and was", f"points lie {beside} them and were")
    strays = (f"{what} left out (UNRESOLVED).",)
    return replace(result, notes=(NOTE, *strays[: bool(n_strays)]))


def _distinct(points: Floats) -> tuple[Floats, float, NDArray[np.intp]]:
    """Distinct points, in units of their extent; the extent; and the row of each point among them."""
    if not len(points):
        return points, 1.0, np.empty(0, np.intp)
    low = points.min(axis=0)
    with np.errstate(over="ignore"):
        extent = float((points - low).max()) or 1.0
    if not 1.0 / LARGEST_SCALE < extent < LARGEST_SCALE:
        raise InvalidInputError(f"points extend over {extent:.3g}, and their curvature is no number; scale them.")
    units = (points - low) / extent
    _, first, place = np.unique(np.rint(units / SAME), axis=0, return_index=True, return_inverse=True)
    return units[first], extent, place.ravel()


def _of_distinct(points: Floats, radius: float | None) -> tuple[Estimate, NDArray[np.uint8], int]:
    """The estimate and status of distinct points and, in a last row, of those not finite; how many strays there are."""
    n = len(points)
    everywhere, status = undefined(n + 1), np.full(n + 1, VertexStatus.UNRESOLVED, np.uint8)
    status[n] = VertexStatus.NONFINITE
    if n < LEAST_POINTS:
        return everywhere, status, 0
    order = morton_order(points).astype(np.intp)
    near, is_stray, is_lost = cleaned(points[order])
    for _ in range(STRAY_ROUNDS):
        if not is_stray.any():
            break
        order = order[~is_stray]
        if len(order) < LEAST_POINTS:
            return everywhere, status, n - len(order)
        near, is_stray, is_lost = cleaned(points[order])
    cloud = cloud_sheet(points[order], *near)
    found = cloud_estimate(cloud, radius)
    found.gaussian[is_lost] = np.nan
    everywhere.fill(order, found)
    status[order] = np.where(cloud.at_border, VertexStatus.BOUNDARY, VertexStatus.OK)
    status[order[~np.isfinite(found.gaussian)]] = VertexStatus.UNRESOLVED
    return everywhere, status, n - len(order)
