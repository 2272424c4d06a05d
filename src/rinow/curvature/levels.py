"""Height fields on levels: depth images and terrains whose heights are whole multiples of a step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.rounding import file_rounding
from rinow.mesh import TriangleMesh

__all__ = ["Levels", "flat_stars", "levels_of"]

Floats = NDArray[np.float64]

FLAT_DEFECT = 1e-10
"""Angle defects below this, in radians, are rounding: a neighbourhood of such vertices is isometric to the plane."""
FEWEST, FLAT = 250, (0.01, 0.95)
"""Vertices of a height field that can be told to be on levels, and least and largest share of them whose stars are
flat: cones in even rows are on levels, and flat throughout."""
PLANES, LOOKED_AT, ALIKE = 20, 4096, 1e-3
"""Fewest planes of flat stars, how many of these are looked at, and the difference up to which two planes are one, in
radians and edge lengths: rounding makes as many planes as there are slopes, parts of even grids have few."""
KINDS = 8
"""Most frequent normals of flat stars, one of which may be that of treads."""
STEEP, RARE = 0.02, 0.02
"""Cosine of the steepest face of a height field, and share of the faces that may be steeper or turned over."""
LEVELS = 5
"""Fewest levels."""
SMALL, LARGE = 0.12, 3.0
"""Steps, in edge lengths, below which no edge is taken for a crease anyway, and above which it is none of rounding."""


class Levels(NamedTuple):
    """Where heights were rounded: the distance of the levels, and the direction of heights."""

    step: float
    upright: Floats

    def variances(self, normals: Floats) -> Floats:
        """(n,): mean square error of positions along unit normals, since all of a step is as likely."""
        return (self.step * (normals @ self.upright)) ** 2 / 12.0


def flat_stars(mesh: TriangleMesh) -> NDArray[np.bool_]:
    """(n_vertices,): the angles at the vertex sum to 2π, or it is on the boundary."""
    return (np.abs(mesh.vertex_angle_defects) <= FLAT_DEFECT) | mesh.topology.vertex_is_boundary


def levels_of(mesh: TriangleMesh) -> Levels | None:
    """The levels on which all vertices of a height field lie; None if they lie on none.

    Notes
    -----
    Heights are along an axis, or a frequent normal of flat stars, since treads are flat.  Over an even grid there are
    levels in oblique directions as well, closer to each other.  Parts with square steps have walls along them, or a
    side that faces away, and are no height field.
    """
    is_flat = flat_stars(mesh) & ~mesh.topology.vertex_is_boundary & mesh.topology.vertex_is_used
    n, n_flat = np.count_nonzero(mesh.topology.vertex_is_used), np.count_nonzero(is_flat)
    if n < FEWEST or not FLAT[0] * n < n_flat < FLAT[1] * np.count_nonzero(~mesh.topology.vertex_is_boundary):
        return None
    rows = np.flatnonzero(is_flat)[:: max(1, n_flat // LOOKED_AT)]
    normals, unit = mesh.vertex_normals[rows], ALIKE * mesh.mean_edge_length
    offsets = np.sum(normals * (mesh.vertices[rows] - mesh.vertices[rows[0]]), axis=1)
    if len(np.unique(np.round(np.c_[normals / ALIKE, offsets / unit]), axis=0)) < PLANES:
        return None
    kinds, counts = np.unique(np.round(normals / ALIKE), axis=0, return_counts=True)
    frequent = kinds[np.argsort(-counts, kind="stable")[:KINDS]]
    upright = np.concatenate([normals[np.argmax(normals @ frequent.T, axis=0)], np.eye(3)])
    found = sorted((-_step_along(mesh, u), i) for i, u in enumerate(upright))
    return next((Levels(-step, upright[i]) for step, i in found if step < 0.0 and _is_graph(mesh, upright[i])), None)


def _step_along(mesh: TriangleMesh, upright: Floats) -> float:
    """The step of which all heights are multiples, if it is about an edge long; else 0."""
    rounding, edge = 4.0 * file_rounding(mesh), mesh.mean_edge_length
    heights = mesh.vertices[mesh.topology.vertex_is_used] @ upright
    for part in (heights[:: 1 + len(heights) // LOOKED_AT], heights):  # most have none, as few of them show
        part = np.sort(part)
        gaps = np.diff(part)
        gaps = gaps[gaps > rounding]
        if len(gaps) < LEVELS - 1 or not SMALL * edge < gaps.min() < LARGE * edge:
            return 0.0
        step, part = float(gaps.min()), part - part[0]
        if np.any(np.abs(part - step * np.round(part / step)) > rounding):
            return 0.0
    return step


def _is_graph(mesh: TriangleMesh, upright: Floats) -> bool:
    """Whether next to all faces look to one side and none is upright."""
    corners = mesh.vertices[mesh.faces[mesh.topology.face_used]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    cosines = np.sort((normals @ upright) / np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny))
    few = int(RARE * len(cosines))
    return bool(cosines[few] > STEEP or cosines[-1 - few] < -STEEP)
