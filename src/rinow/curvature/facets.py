"""Curvature of vertices between flat facets, as models of parts have them: all on feature lines, none inside faces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.creases import EdgeTurnings
from rinow.curvature.estimate import Estimate
from rinow.curvature.rims import rims_of
from rinow.curvature.rounding import coordinate_rounding, file_rounding
from rinow.kernels import facet_stars
from rinow.mesh import TriangleMesh

__all__ = ["take_facets", "tells_facets"]

Floats = NDArray[np.float64]


BY_CHANCE = 0.02
"""Turning of the typical edge, in radians, by rounding of coordinates from which on faces are coplanar by chance."""


def tells_facets(turnings: EdgeTurnings) -> bool:
    """Whether what is flat is so by design.

    Coordinates that are rounded to a share of the spacing, as 32 bits do far from the origin, tell no facets, nor do
    the treads of voxels and levels.
    """
    gains = turnings.gains[np.isfinite(turnings.gains)]
    if len(gains) and coordinate_rounding(turnings.mesh) * float(np.median(gains)) > BY_CHANCE:
        return False
    return not turnings.have_treads


def take_facets(mesh: TriangleMesh, estimate: Estimate, is_open: NDArray[np.bool_]) -> None:
    r"""Write the curvature of prisms and flat facets into an estimate.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, cut open along its creases.
    estimate : Estimate
        Its curvature; changed in place at vertices whose star is flat, and at open ones whose star has coplanar faces
        and bends along one line.
    is_open : (n_vertices,) ndarray of bool
        Vertices on creases and those without a fit.

    Notes
    -----
    Such a star is isometric to a part of the plane, K = 0.  A facet of a prism inscribed in a cylinder of radius R has
    the height h over the edge where it meets the next one; with the angle θ between both,

    .. math:: \frac{1}{R} = \frac{2 \sin θ}{\sqrt{h_1^2 + h_2^2 + 2 h_1 h_2 \cos θ}}

    is the Menger curvature of three points of the section across that edge, exact for any two heights.
    """
    if estimate.mean is None or estimate.k1 is None or estimate.k2 is None:
        return
    rows = np.flatnonzero(mesh.topology.vertex_is_used)
    t, turnings = mesh.topology, EdgeTurnings(mesh)
    if not tells_facets(turnings):
        return
    rounding = file_rounding(mesh) * turnings.gains
    across, lines = np.empty(len(rows)), np.empty(len(rows), np.intp)
    facet_stars.facet_stars(
        rows, np.nan_to_num(turnings.turnings), rounding, turnings.edge_of_halfedge, turnings.halfedges, t.partners,
        mesh.vertices, mesh.faces, t.corner_offsets, t.vertex_corners, t.edges, across, lines,
    )  # fmt: skip
    is_facet = np.isfinite(across) & (is_open[rows] | (lines < 0))
    rims = rims_of(mesh)
    known = np.isfinite(rims.across)
    by_rim = np.full(mesh.n_vertices, np.nan)
    by_rim[rims.rows[known]] = rims.across[known]
    rows, across, lines = rows[is_facet], across[is_facet], lines[is_facet]
    across = np.where((lines >= 0) & np.isfinite(by_rim[rows]), by_rim[rows], across)
    estimate.gaussian[rows] = estimate.spread[rows] = 0.0
    estimate.mean[rows] = 0.5 * across
    estimate.k1[rows], estimate.k2[rows] = np.maximum(across, 0.0), np.minimum(across, 0.0)
    bent = lines >= 0
    _turn_directions(mesh, estimate, rows[bent], across[bent], t.edges[lines[bent]])


def _turn_directions(
    mesh: TriangleMesh, estimate: Estimate, rows: NDArray[np.intp], across: Floats, edges: NDArray[np.intp]
) -> None:
    """The principal directions along and across the edges."""
    if estimate.direction1 is None or estimate.direction2 is None:
        return
    along = mesh.vertices[edges[:, 1]] - mesh.vertices[edges[:, 0]]
    along /= np.linalg.norm(along, axis=1)[:, None]
    sideways = np.cross(mesh.vertex_normals[rows], along)
    lengths = np.linalg.norm(sideways, axis=1)
    known = lengths > 0.0
    rows, across, along = rows[known], across[known], along[known]
    sideways = sideways[known] / lengths[known, None]
    convex = (across > 0.0)[:, None]
    estimate.direction1[rows] = np.where(convex, sideways, along)
    estimate.direction2[rows] = np.where(convex, along, sideways)
