"""Vertices of damaged meshes that tell nothing about the surface and must not take part in its fits."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from rinow.curvature.caps import cap_faces
from rinow.curvature.cloud_layers import DEVIATIONS, NEAREST, SPACINGS
from rinow.curvature.stencils import N_BLOCKS
from rinow.kernels import balls, cloud_strays, stencils
from rinow.mesh import TriangleMesh

__all__ = ["spikes", "stray_vertices"]

Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]

ALONE = 4.0
"""Square of a height over the neighbours, over the mean square of theirs, from which on it may be a spike."""
LEAF = 32
"""Points of a leaf of the tree of all vertices, which few are sought in: to make it takes longer than to search it."""


def stray_vertices(mesh: TriangleMesh) -> tuple[Bools, Indices, Indices]:
    """Vertices on an edge of two others, made by splitting it: they lie on the chord, not on the surface.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    is_stray : (n_vertices,) ndarray of bool
        The vertices.
    on_edge, ends : (k,) ndarray of intp
        Those on an edge, and for each the end of the edge that is nearer to it.
    """
    is_stray = np.zeros(mesh.n_vertices, np.bool_)
    L, thin = mesh.edge_lengths, cap_faces(mesh)
    apex = np.argmax(L[thin], axis=1)
    sides = np.stack([(apex + 1) % 3, (apex + 2) % 3], axis=1)
    # Column k is opposite corner k: the nearer end is the corner opposite the longer one of the two sides.
    farther = np.take_along_axis(L[thin], sides, axis=1).argmax(axis=1)
    on_edge = mesh.faces[thin, apex]
    ends = mesh.faces[thin, sides[np.arange(len(thin)), farther]]
    on_edge, first = np.unique(on_edge, return_index=True)
    is_stray[on_edge] = True
    return is_stray, on_edge, ends[first]


def spikes(sheet: balls.Sheet) -> tuple[Indices, Indices]:
    """Vertices alone beside the surface of those around them, and for each its nearest neighbour that is not.

    They are sought as in point clouds (`rinow.curvature.cloud_layers`), but only among those that stand out from their
    ring much more than its other members from theirs.
    """
    none = np.empty(0, np.intp)
    height, stands_out = np.empty(len(sheet.spacing)), np.empty(len(sheet.spacing), np.bool_)
    stencils.heights_over_rings(sheet.vertices, sheet.normals, sheet.offsets, sheet.neighbours, height)
    stencils.stand_out(height, 0.5 * SPACINGS * sheet.spacing, ALONE, sheet.offsets, sheet.neighbours, stands_out)
    likely = np.flatnonzero(stands_out)
    if not len(likely) or len(height) <= NEAREST:
        return none, none
    tree = KDTree(sheet.vertices, LEAF, compact_nodes=False, balanced_tree=False)
    found_near: tuple[Any, Any] = tree.query(sheet.vertices[likely], NEAREST + 1)
    distances, near = found_near
    offsets, middles, largest = np.empty((3, len(likely)))
    around = np.ascontiguousarray(near[:, 1:]), np.ascontiguousarray(distances[:, -1])
    cloud_strays.offsets(likely, sheet.vertices, sheet.normals, *around, N_BLOCKS, offsets, middles, largest)
    found = offsets > np.maximum(DEVIATIONS * middles, SPACINGS * sheet.spacing[likely])
    is_spike = np.isin(near[found], likely[found])
    return likely[found], near[found, np.argmin(is_spike, axis=1)]
