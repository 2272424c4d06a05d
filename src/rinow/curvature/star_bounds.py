"""Fits that the stars of the mesh contradict: the mean of K over a ring is its angle defects over its area."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.angle_defect import angle_defect
from rinow.curvature.estimate import Estimate
from rinow.curvature.rims import Rims, write_rims
from rinow.curvature.stencils import rings_around
from rinow.curvature.unresolved import single_rings
from rinow.mesh import TriangleMesh
from rinow.topology import Topology

__all__ = ["heed_stars"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

RINGS = 4
"""Rows of vertices beside the boundary of a face."""
SURE = 3.0
"""Spreads by which a fit leaves the range of the stars around it."""
FEWEST = 3
"""Stars that show what they have in common: of a vertex and its neighbours, at the boundary within two rings."""
BEYOND = 0.5
"""Widths of that range by which it does."""
LEAST = 0.1
"""Least such step, in units of the larger squared curvature of the fit."""


def heed_stars(mesh: TriangleMesh, estimate: Estimate, rims: Rims) -> None:
    """Take what the stars of the mesh say where a fit contradicts all of them around, in place.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, cut open along its creases.
    estimate : Estimate
        Its curvature.
    rims : Rims
        What the boundary shows: the mean curvature there, where stars have none.

    Notes
    -----
    Of a few rows of vertices, or beside triangles many times as long as it is wide, the smallest ball may hold all of a
    face of a part, and fits of several orders may agree on what is not there.  The angle defects know better (Gauss and
    Bonnet), unless positions are noisy; but then the stars of a vertex and its neighbours differ by much more than a
    fit errs.  So what lies outside their range by more than half its width, and by three spreads or with a spread above
    that width, is no curvature of this surface.  A vertex inside has that of its own star then, one at the boundary the
    middle of those within two rings.  The width is the spread, at the boundary together with (k θ/2)² for the curvature
    k and the turning θ of its faces, since polygons stand for curves there.
    """
    if estimate.mean is None or estimate.k1 is None or estimate.k2 is None:
        return
    t, stars = mesh.topology, angle_defect(mesh).gaussian
    if not t.vertex_is_boundary.any():
        return
    stars[~t.vertex_is_manifold] = np.nan
    low, high = _ranges(t, stars, stars)
    wide = _ranges(t, low, high)
    low, high = (np.where(t.vertex_is_boundary, x, y) for x, y in zip(wide, (low, high), strict=True))
    largest, width = np.fmax(np.abs(estimate.k1), np.abs(estimate.k2)), high - low
    with np.errstate(invalid="ignore"):
        step = np.fmax(low - estimate.gaussian, estimate.gaussian - high)
        is_wrong = rings_around(t, t.vertex_is_boundary, RINGS)
        is_wrong &= (step > SURE * estimate.spread) | (estimate.spread > width)
        is_wrong &= (step > BEYOND * width) & (step > LEAST * largest**2)
    rows = np.flatnonzero(is_wrong)
    is_wrong[[v for v in rows if _known_stars(t, v, stars) < FEWEST]] = False
    if not is_wrong.any():
        return
    both = single_rings(mesh)
    rows = np.flatnonzero(is_wrong & np.isfinite(both[:, 1]))
    estimate.gaussian[rows], estimate.mean[rows] = both[rows].T
    half = np.sqrt(np.maximum(estimate.mean[rows] ** 2 - estimate.gaussian[rows], 0.0))
    estimate.k1[rows], estimate.k2[rows] = estimate.mean[rows] + half, estimate.mean[rows] - half
    estimate.spread[rows] = width[rows]
    places = np.flatnonzero(is_wrong[rims.rows] & np.isfinite(rims.across))
    rows = rims.rows[places]
    chords = (0.5 * rims.across[places] * rims.turns[places]) ** 2
    estimate.gaussian[rows], estimate.spread[rows] = 0.5 * (low + high)[rows], np.hypot(width[rows], chords)
    write_rims(estimate, rims, places)
    is_wrong[rows] = is_wrong[np.isfinite(both[:, 1])] = False
    rest = np.flatnonzero(is_wrong)
    estimate.spread[rest] = np.fmax(estimate.spread[rest], step[rest])


def _known_stars(graph: Topology, vertex: np.intp, stars: Floats) -> int:
    """How many stars of a vertex and its neighbours, at the boundary of those and theirs, have a curvature."""
    near = graph.neighbours[graph.neighbour_offsets[vertex] : graph.neighbour_offsets[vertex + 1]]
    if graph.vertex_is_boundary[vertex]:
        rows = [graph.neighbours[graph.neighbour_offsets[v] : graph.neighbour_offsets[v + 1]] for v in near]
        near = np.unique(np.concatenate([near, *rows]))
    return int(np.count_nonzero(np.isfinite(stars[np.append(near[near != vertex], vertex)])))


def _ranges(graph: Topology, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """The least and largest values at each vertex and its neighbours; nan does not count."""
    offsets, near = graph.neighbour_offsets, graph.neighbours
    has_any = np.diff(offsets) > 0
    found = np.fmin.reduceat(np.append(low[near], np.nan), offsets[:-1])
    found = found, np.fmax.reduceat(np.append(high[near], np.nan), offsets[:-1])
    return np.where(has_any, np.fmin(low, found[0]), low), np.where(has_any, np.fmax(high, found[1]), high)
