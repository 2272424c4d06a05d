"""Curvature along the rims of strips: faces of a part with rows of vertices at their ends and none between."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.estimate import Estimate
from rinow.curvature.stencils import rings_around
from rinow.mesh import TriangleMesh

__all__ = ["Rims", "rims_of", "take_strips", "write_rims"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

STRIP_RINGS = 2
"""Rings around a vertex without a vertex inside that show nothing but a strip."""
LEAST_TURN, STRAIGHT = 1e-6, 1e-6
"""Turning of the faces beside a vertex, and of its rim, that tell no direction in which the surface bends."""
STEEP = 0.3
"""Least sine of the angle between a rim and the lines that do not bend."""
STEADY = 0.5
"""Largest step from the mean of both neighbours on the rim, over the curvature itself."""
ALIKE = 2.0
"""Ratio up to which the curvature by the rim and that by the turning of the faces are of one surface."""


class Rims(NamedTuple):
    """At vertices of a boundary what rim and faces show.

    `rows` (n,); curvature across the lines that do not bend, `across` (n,), nan where the rim does not tell it; unit
    vectors `lines` (n, 3) along these and `normals` (n, 3); the turning of the two faces there, and the height of the
    lower one over the rim.
    """

    rows: Indices
    across: Floats
    lines: Floats
    normals: Floats
    turns: Floats
    heights: Floats


def rims_of(mesh: TriangleMesh) -> Rims:
    r"""What the rims of a mesh show at their vertices.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, cut open along its creases.

    Returns
    -------
    rims : Rims
        Of all vertices with two boundary edges.

    Notes
    -----
    The circle through a vertex and its neighbours on the rim has the curvature vector c (Menger) and the tangent t
    there.  The line e in which the faces on both sides of the vertex meet does not bend.  Both span the tangent plane;
    with its normal N and the angle β between both,

    .. math:: k = - \frac{c \cdot N}{\sin^2 β}

    is the curvature across the line (Meusnier, Euler), exact on cylinders and cones with circular rims.  It is told
    where it agrees with the turning of the faces, and with those before and after it on the rim: under noise it does
    not.
    """
    h, t = mesh.topology.boundary_halfedges, mesh.topology
    ends, none = t.halfedge_ends(h), np.full(mesh.n_vertices, -1, np.intp)
    out, into = none.copy(), none.copy()
    out[ends[:, 0]], into[ends[:, 1]] = np.arange(len(h)), np.arange(len(h))
    counts = np.bincount(ends.ravel(), minlength=mesh.n_vertices)
    rows = np.flatnonzero((counts == 2) & (out >= 0) & (into >= 0))
    before, after = into[rows], out[rows]
    V, corners = mesh.vertices, mesh.vertices[mesh.faces[h // 3]]
    vectors = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas, lengths = np.linalg.norm(vectors, axis=1), np.linalg.norm(V[ends[:, 1]] - V[ends[:, 0]], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        unit, heights = vectors / areas[:, None], areas / lengths
        bend, tangent = _circles(V[ends[before, 0]] - V[rows], V[ends[after, 1]] - V[rows])
        lines = np.cross(unit[before], unit[after])
        sine = np.linalg.norm(lines, axis=1)
        lines /= sine[:, None]
        turns = np.arctan2(sine, np.sum(unit[before] * unit[after], axis=1))
        normals = np.cross(tangent, lines)
        slant = np.linalg.norm(normals, axis=1)
        normals /= np.copysign(slant, np.sum(normals * (unit[before] + unit[after]), axis=1))[:, None]
        across = -np.sum(bend * normals, axis=1) / slant**2
        by_faces = 2.0 * turns / ((lengths[before] + lengths[after]) * slant)
        ratio = np.abs(across) / by_faces
        is_told = (turns > LEAST_TURN) & (slant > STEEP) & (ratio < ALIKE) & (ratio > 1.0 / ALIKE)
    across[~is_told] = np.nan
    across[~_are_steady(across, rows, ends[before, 0], ends[after, 1])] = np.nan
    return Rims(rows, across, lines, normals, turns, np.fmin(heights[before], heights[after]))


def _are_steady(across: Floats, rows: Indices, before: Indices, after: Indices) -> NDArray[np.bool_]:
    """Curvatures that are about the mean of those before and after them on the rim: noise makes few such."""
    everywhere = np.full(1 + max(rows.max(initial=0), before.max(initial=0), after.max(initial=0)), np.nan)
    everywhere[rows] = across
    sides = np.stack([everywhere[before], everywhere[after]])
    sides = np.where(np.isfinite(sides), sides, sides[::-1])
    with np.errstate(invalid="ignore"):
        return np.abs(sides.mean(axis=0) - across) <= STEADY * np.abs(across)


def _circles(one: Floats, two: Floats) -> tuple[Floats, Floats]:
    """Curvature vectors and unit tangents, at the origin, of the circles through it and two points each."""
    a, b = np.sum(one * one, axis=1)[:, None], np.sum(two * two, axis=1)[:, None]
    axis = np.cross(one, two)
    square = np.sum(axis * axis, axis=1)[:, None]
    centre = np.cross(a * two - b * one, axis)  # times twice the square
    is_straight = square <= STRAIGHT**2 * a * b
    tangent = np.where(is_straight, two - one, np.cross(axis, centre))
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    far = np.sum(centre * centre, axis=1)[:, None]
    bend = np.where(is_straight, 0.0, 2.0 * square * centre / far)
    return bend, tangent


def take_strips(mesh: TriangleMesh, estimate: Estimate, rims: Rims) -> None:
    """Write the curvature of ruled surfaces without twist at the rims of strips into an estimate, in place.

    Nothing between two rims shows how a strip bends from one to the other.  Who made it thought that it turns by no
    more over its width than from one face to the next, which makes the spread: k times the turning over the height.
    What no rim tells has the spread of everything that its fit may have made up.
    """
    if estimate.mean is None or estimate.k1 is None or estimate.k2 is None:
        return
    is_inside = mesh.topology.vertex_is_used & ~mesh.topology.vertex_is_boundary
    is_strip = ~rings_around(mesh.topology, is_inside, STRIP_RINGS)[rims.rows]
    is_open = is_strip & (rims.turns > LEAST_TURN) & (estimate.spread[rims.rows] != 0.0)
    unknown = rims.rows[is_open & np.isnan(rims.across)]
    squared = np.fmax(estimate.k1[unknown] ** 2, estimate.k2[unknown] ** 2)
    estimate.spread[unknown] = np.fmax(estimate.spread[unknown], squared)
    known = np.flatnonzero(is_open & np.isfinite(rims.across))
    rows, across = rims.rows[known], rims.across[known]
    estimate.gaussian[rows] = 0.0
    estimate.spread[rows] = np.abs(across) * rims.turns[known] / rims.heights[known]
    write_rims(estimate, rims, known)


def write_rims(estimate: Estimate, rims: Rims, places: Indices) -> None:
    """Write mean and principal curvatures at some places of the rims, for the Gaussian curvature that is there."""
    rows, across = rims.rows[places], rims.across[places]
    along = np.divide(estimate.gaussian[rows], across, out=np.zeros(len(rows)), where=across != 0.0)
    is_first = across >= along
    values = {"mean": 0.5 * (across + along), "k1": np.fmax(across, along), "k2": np.fmin(across, along)}
    for name, value in values.items():
        getattr(estimate, name)[rows] = value
    if estimate.direction1 is None or estimate.direction2 is None:
        return
    lines, sideways = rims.lines[places], np.cross(rims.normals[places], rims.lines[places])
    estimate.direction1[rows] = np.where(is_first[:, None], sideways, lines)
    estimate.direction2[rows] = np.where(is_first[:, None], lines, sideways)
