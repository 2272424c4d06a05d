"""Surfaces through the voxels of a mask, whose every step is a crease that means nothing."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.rounding import file_rounding
from rinow.mesh import TriangleMesh

__all__ = ["is_voxel_surface"]

Floats = NDArray[np.float64]

FEWEST = 500
"""Faces of a surface that can be told to be one of voxels."""
BENT, TURNED_BACK = (0.1, 0.6), (0.1, 0.2)
"""Share of the edges that bend, and least share among them of those that bend the rarer way, since every step turns
back: of a surface that marching cubes made, and of one of squares, to which parts with square corners come nearer."""
NORMALS, OBLIQUE = 32, 4
"""Most normals up to their sign, 13 but for rounding, and how many of them are oblique to all sides of the voxels."""
RARE = 0.02
"""Share of the faces that may have other normals, of cubes that do not tell what is inside."""
ALIKE = 1e-3
"""Coordinates of normals that differ by less are one, and edges that turn by less are flat, in radians."""
LENGTHS = 6
"""Lengths of the edges of a surface of squares: three sides and the diagonals between them."""


def is_voxel_surface(mesh: TriangleMesh, turnings: Floats) -> bool:
    """Whether all faces are those between the two values of a mask, by marching cubes or around each voxel.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    turnings : (n_edges,) ndarray of float
        Turning of the normal at each edge, nan without.

    Notes
    -----
    Marching cubes put the vertices on the middles of edges of a grid with sides a, b, c.  In its axes all normals are
    multiples of (±1/a or 0, ±1/b or 0, ±1/c or 0), and steps up and down follow each other.  A surface of squares has
    the six along the axes, and no edge longer than a diagonal.
    """
    used, n_edges = mesh.topology.face_used, np.count_nonzero(np.isfinite(turnings))
    n_bends = np.count_nonzero(np.abs(turnings) > ALIKE)
    if np.count_nonzero(used) < FEWEST or not BENT[0] * n_edges < n_bends < BENT[1] * n_edges:
        return False
    corners = mesh.vertices[mesh.faces[used]]
    alike = max(ALIKE, 10.0 * file_rounding(mesh) / float(np.sqrt(np.mean(np.ptp(corners, axis=1) ** 2))))
    bends = turnings[np.abs(turnings) > alike]
    rarer = min(np.count_nonzero(bends > 0.0), np.count_nonzero(bends < 0.0))
    if rarer < TURNED_BACK[0] * len(bends):
        return False
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    normals = _kinds(normals[lengths > 0.0] / lengths[lengths > 0.0, None], alike)
    if len(normals) != 3:
        return _are_of_a_grid(normals, alike)
    lengths = np.sort(mesh.edge_lengths[used], axis=None)
    n_lengths = 1 + np.count_nonzero(np.diff(lengths) > alike * lengths.mean())
    turns_back = rarer >= TURNED_BACK[1] * len(bends)
    return bool(turns_back and n_lengths <= LENGTHS and _are_across(normals, alike).all())


def _kinds(normals: Floats, alike: float) -> Floats:
    """(n, 3): the different normals up to their sign; none if there are many."""
    first = np.argmax(np.abs(normals) > 0.5, axis=1)  # one coordinate at least is 0.57
    normals = normals * np.sign(np.take_along_axis(normals, first[:, None], axis=1))
    normals, counts = np.unique(np.round(normals / alike), axis=0, return_counts=True)
    is_rare = counts <= RARE * counts.sum() / NORMALS
    if counts[is_rare].sum() > RARE * counts.sum() or len(normals) - np.count_nonzero(is_rare) > NORMALS:
        return np.empty((0, 3))
    normals = normals[~is_rare] / np.linalg.norm(normals[~is_rare], axis=1)[:, None]
    is_same = np.abs(normals @ normals.T) > 1.0 - (3.0 * alike) ** 2
    return normals[np.argmax(is_same, axis=1) == np.arange(len(normals))]


def _are_across(normals: Floats, alike: float) -> NDArray[np.bool_]:
    """(n, n): whether two normals are orthogonal, or the same one."""
    return (np.abs(normals @ normals.T) < 3.0 * alike) | np.eye(len(normals), dtype=np.bool_)


def _are_of_a_grid(normals: Floats, alike: float) -> bool:
    """Whether in three axes among them all normals are signs or zeros times the same three numbers."""
    is_across = _are_across(normals, alike)
    for axes in combinations(range(len(normals)), 3):
        if not is_across[np.ix_(axes, axes)].all():
            continue
        sides = np.abs(normals @ normals[list(axes)].T)
        is_known = sides > 3.0 * alike
        is_oblique = is_known.all(axis=1)
        if np.count_nonzero(is_oblique) >= OBLIQUE:
            ratios = np.where(is_known, sides / np.median(sides[is_oblique], axis=0), np.nan)
            if np.all(np.nanmax(ratios, axis=1) - np.nanmin(ratios, axis=1) < 0.05 * np.nanmax(ratios, axis=1)):
                return True
    return False
