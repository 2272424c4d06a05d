"""Curvature at the points of a cloud that lies on a surface, without a mesh."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import as_floats, as_points
from rinow._executor import SerialExecutor
from rinow.curvature.cloud_sheet import Cloud, cloud_sheet
from rinow.curvature.estimate import Estimate
from rinow.curvature.patch_tasks import Tasks
from rinow.curvature.scale import Ladder, sample
from rinow.curvature.sectional import (
    EDGE_CALIBRATION,
    EDGE_RINGS,
    QUALITIES,
    blended_patches,
    corrected,
    rings_around,
    shrinkage,
)
from rinow.curvature.sheet import morton_order
from rinow.curvature.status import VertexStatus
from rinow.curvature.surface import SurfaceCurvature
from rinow.curvature.unresolved import with_detail
from rinow.errors import InvalidInputError
from rinow.mesh import TriangleMesh

__all__ = ["point_cloud_curvature"]

Floats = NDArray[np.float64]

LEAST_POINTS = 7
"""Points below which no quadric over a tangent plane is determined: it has six coefficients."""
NOTE = "The points have no orientation: the normals point outwards at the highest point, and agree between neighbours."


def point_cloud_curvature(points: ArrayLike, *, radius: float | None = None) -> SurfaceCurvature:
    r"""Gaussian, mean and principal curvatures at points that lie on a surface, or near one.

    Parameters
    ----------
    points : (n_points, 3) array_like of float
        Positions, in any unit of length.  Rows with nan or inf are allowed; repeated points get the same values.
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
    Each point is joined to its neighbours in the Delaunay triangulation of the 36 nearest points over their plane of
    least squares, and they to it; balls grow over these links as they do over the edges of a mesh, and the same
    polynomials over osculating tori are fitted to them.  The signs of the normals, and with them those of the mean
    and the principal curvatures, cannot be known from points: they agree between neighbours and are outward at the
    highest point of each component, which is right for closed surfaces.  On a surface with one side only they change
    along a cut.  The Gaussian curvature does not depend on them.

    Where no fit over a ball is determined, a quadric is fitted to two rings of neighbours.  Sheets nearer to each
    other than some spacings are taken for one.  Lengths from 1e-140 to 1e140 neither
    overflow nor underflow.

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
    if radius is not None:
        value = as_floats(radius, "radius")
        if value.ndim or not 0.0 < value < np.inf:
            raise InvalidInputError(f"radius = {radius!r} is not a positive length; leave it out for the default.")
    status = np.full(len(P), VertexStatus.UNRESOLVED, np.uint8)
    finite = np.isfinite(P).all(axis=1)
    status[~finite] = VertexStatus.NONFINITE
    distinct, place = np.unique(P[finite], axis=0, return_inverse=True)
    if len(distinct) < LEAST_POINTS:
        return _assembled(np.full((len(P), 4), np.nan), np.full((2, len(P), 3), np.nan), status)
    unit = 1.0 / float(np.ptp(distinct, axis=0).max())
    order = morton_order(distinct)
    cloud = cloud_sheet((distinct[order] - distinct[0]) * unit)
    found = _of_cloud(cloud, None if radius is None else float(radius) * unit)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    where, rows = np.flatnonzero(finite), rank[place.ravel()]
    values = np.column_stack([found.gaussian, found.mean, found.spread, found.radius])
    values *= np.array([unit**2, unit, unit**2, 1.0 / unit])
    everywhere, both = np.full((len(P), 4), np.nan), np.full((2, len(P), 3), np.nan)
    everywhere[where], both[:, where] = values[rows], np.stack([found.direction1, found.direction2])[:, rows]
    known = np.isfinite(everywhere[:, 0])
    border = np.zeros(len(P), np.bool_)
    border[where] = cloud.at_border[rows]
    status[known] = np.where(border[known], VertexStatus.BOUNDARY, VertexStatus.OK)
    return _assembled(everywhere, both, status)


def _of_cloud(cloud: Cloud, radius: float | None) -> Estimate:
    """The estimate of fits over the links of a cloud, with what its triangles know better."""
    sheet, quality = cloud.sheet, QUALITIES["best"]
    ladder = Ladder.free(sheet) if radius is None else Ladder.of_radius(radius, sheet)
    tasks = Tasks(SerialExecutor())
    samples = sample(sheet, ladder, quality.selects, tasks)
    at_edge = rings_around(sheet, cloud.at_border, EDGE_RINGS)
    out, direction1, direction2, noise = blended_patches(sheet, ladder, quality, samples, at_edge, tasks)
    out[:, 0] *= shrinkage(samples, out)
    gaussian, mean, risk, reach = out[:, :4].T.copy()
    half = np.sqrt(np.maximum(mean * mean - gaussian, 0.0))
    spread = quality.calibration * np.sqrt(risk)
    spread[cloud.at_border] *= EDGE_CALIBRATION
    fit = Estimate(
        gaussian, spread, reach, mean, mean + half, mean - half, direction1, direction2, np.sqrt(noise), sheet.spacing
    )
    if not len(cloud.faces):
        return fit
    mesh = TriangleMesh(sheet.vertices, cloud.faces)
    corrected(mesh, fit, radius is None)
    return fit if radius is not None else with_detail(mesh, fit)


def _assembled(values: Floats, directions: Floats, status: NDArray[np.uint8]) -> SurfaceCurvature:
    """The result with the quantities that follow from K and H."""
    gaussian, mean, spread, radius = values.T.copy()
    half = np.sqrt(np.maximum(mean * mean - gaussian, 0.0))
    k1, k2 = mean + half, mean - half
    directions[:, np.isnan(gaussian)] = np.nan
    fields: dict[str, Any] = {
        "shape_index": 2.0 / np.pi * np.arctan2(k1 + k2, k1 - k2),
        "curvedness": np.sqrt(0.5 * (k1 * k1 + k2 * k2)),
        "direction1": directions[0],
        "direction2": directions[1],
    }
    return SurfaceCurvature(
        gaussian=gaussian, mean=mean, k1=k1, k2=k2, status=status, radius=radius, spread=spread, method="point_cloud",
        notes=(NOTE,), **fields,
    )  # fmt: skip
