"""Curvature of a cloud from fits over its links, with what its triangles know better."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow._executor import SerialExecutor
from rinow.curvature.cloud_sheet import Cloud
from rinow.curvature.ends import repair_ends
from rinow.curvature.estimate import Estimate
from rinow.curvature.flat import flat_vertices, flatten
from rinow.curvature.patch_tasks import Tasks
from rinow.curvature.scale import Ladder, sample
from rinow.curvature.sectional import (
    EDGE_RINGS,
    QUALITIES,
    blended_patches,
    shrinkage,
    standard_errors,
)
from rinow.curvature.stencils import rings_around
from rinow.curvature.unresolved import EVERYWHERE, with_detail
from rinow.kernels import stencils
from rinow.mesh import TriangleMesh

__all__ = ["cloud_estimate"]

Floats = NDArray[np.float64]

UNDECIDED = 1.3
"""Standard error times radius² above which nothing is known.  On surfaces with noise of up to a tenth of the spacing it
is less at 99 of 100 points; of points that fill a part of space the median is 4."""
AGREED = 0.4
"""Share of the triangles of the stars around on which their neighbours agree, above which the surface is known all the
same: nearly all tips of noisy needles exceed it, and one in twenty points of those that fill space."""
MANY = 120.0
"""Twice the points of a cloud below which noise and bias are told from fits that share most points.  The spread
of n points is MANY/n - 1 times as large: else two spreads hold 0.81 of the errors of 36 points and 0.76 to 0.85 of
those of 44, but 0.96 of those of 60."""
DETAIL_RINGS = 3
"""Rings of neighbours that detail is told from."""


def cloud_estimate(cloud: Cloud, radius: float | None) -> Estimate:
    """The estimate of `sectional` for a cloud, in the order of its sheet.

    Parameters
    ----------
    cloud : Cloud
        The cloud.
    radius : float or None
        Radius of all balls, in the unit of length; by default the data decide.

    Notes
    -----
    Edge lengths are not examined: the diagonals of a Delaunay triangulation change along lines, where angle defects
    do not converge.
    """
    sheet, quality, tasks = cloud.sheet, QUALITIES["best"], Tasks(SerialExecutor())
    ladder = Ladder.free(sheet) if radius is None else Ladder.of_radius(radius, sheet)
    samples = sample(sheet, ladder, quality.selects, tasks)
    at_edge = rings_around(sheet, cloud.at_border, EDGE_RINGS)
    values, noise = blended_patches(sheet, ladder, quality, samples, at_edge, tasks)
    out, direction1, direction2, first, *_ = values
    out[:, 0] *= shrinkage(samples, values)
    gaussian, mean, risk, reach, height = out[:, :5].T.copy()
    half = np.sqrt(np.maximum(mean * mean - gaussian, 0.0))
    # With noise a tenth of the border is not seen, but its neighbours are.
    spread = standard_errors(out, quality, rings_around(sheet, cloud.at_border, 1))
    principal = mean + half, mean - half, direction1, direction2
    fit = Estimate(gaussian, spread, reach, mean, *principal, np.sqrt(noise), sheet.spacing, risk, height, first)
    mesh = TriangleMesh(sheet.vertices, cloud.faces) if len(cloud.faces) else None
    if mesh is not None:
        repair_ends(mesh, fit, radius is None)
        t = mesh.topology
        told = rings_around(t, t.vertex_is_used & ~t.vertex_is_boundary, 1)
        flatten(fit, flat_vertices(mesh) & told)
    if radius is not None:
        return fit
    fit = fit if mesh is None else _with_detail(cloud, mesh, fit)
    is_doubtful = (fit.spread * fit.radius**2 > UNDECIDED) | _too_curved(cloud, fit)
    fit.gaussian[is_doubtful & (_over_stars(cloud, cloud.agreement) < AGREED)] = np.nan
    fit.spread[:] *= max(MANY / len(sheet.vertices) - 1.0, 1.0)
    return fit


def _with_detail(cloud: Cloud, mesh: TriangleMesh, fit: Estimate) -> Estimate:
    """The estimate with detail; none at holes among triangles that show detail, and a wide spread around them.

    There the stars of the points disagree, so that the rings around tell less than the comparison of scales believes.
    """
    detailed = with_detail(mesh, fit, EVERYWHERE)
    t = mesh.topology
    at_hole = (t.vertex_is_boundary | ~t.vertex_is_used) & ~cloud.at_border
    step = np.abs(detailed.gaussian - fit.gaussian)
    has_detail = np.where(step > 0.0, 1.0, 0.0)
    around = np.empty_like(has_detail)
    stencils.ring_sums(has_detail, cloud.sheet.offsets, cloud.sheet.neighbours, around)
    unknown = at_hole & (around > 0.5 * np.diff(cloud.sheet.offsets))
    near = rings_around(cloud.sheet, at_hole, DETAIL_RINGS)
    near &= step > 0.0  # an unknown spread is not 0
    detailed.spread[near] = np.fmax(detailed.spread, step)[near]
    detailed.gaussian[unknown] = np.nan
    return detailed


def _over_stars(cloud: Cloud, values: Floats) -> Floats:
    """Mean of the values at each point and its neighbours."""
    sums = np.empty_like(values)
    stencils.ring_sums(values, cloud.sheet.offsets, cloud.sheet.neighbours, sums)
    return sums / (np.diff(cloud.sheet.offsets) + 1)


def _too_curved(cloud: Cloud, fit: Estimate) -> NDArray[np.bool_]:
    """(n_points,): neighbours are farther, in the mean, than any two points of the smaller circle of curvature."""
    sheet = cloud.sheet
    lengths = np.empty(len(sheet.vertices))
    stencils.mean_edge_lengths(sheet.vertices, sheet.offsets, sheet.neighbours, lengths)
    largest = np.fmax(np.abs(fit.k1), np.abs(fit.k2))  # type: ignore[arg-type]
    return largest * lengths > 2.0
