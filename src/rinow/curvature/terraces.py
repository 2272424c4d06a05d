"""Terraces of voxels, told from detail: no point of them is farther from the surface than half a voxel."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.kernels import stencils

__all__ = ["beyond_terraces"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Rows = tuple[NDArray[np.integer[Any]], NDArray[np.integer[Any]]]

LEAST, MOST = 0.6, 1.5
"""Half of a voxel, in spacings, for cubes and for voxels more than twice as long as wide.

Marching cubes have three vertices on two squares of the grid or so: half a side of a cube is 0.57 spacings."""
GAIN = 1.1
"""Half of the longest side, in spacings, over what diagonals exceed these by, and a seventh more, since fits err: for
cubes 0.57 over 0.6, for 1 : 1 : 2.5 it is 1.14 over 1.2."""
LONG = 0.98
"""Share of the vertices that have no edge longer than the diagonal of a face of the voxels."""
FEW = 2e-3
"""Share of a set of steps that may seem higher, where fits are beside the surface themselves or noise that neighbours
share has a peak.  Of folds, scans and terrains three times as many or more are."""
GRADED = 2.0
"""Ratio of large to small spacings from which on a mesh is not one of voxels of one size, but of cells of an octree, as
reconstructions of scattered points are, or of none: its longest edges then tell nothing about those elsewhere."""
PASSES = 5
"""Averages of the spacing over rings: that of one vertex is chance."""
STEPS = 8
"""The length of diagonals is rounded to so many parts of an octave: what is changed far away then leaves it."""


def beyond_terraces(vertices: Floats, rings: Rows, spacing: Floats, is_missed: Bools, heights: Floats) -> Bools:
    """Which of the vertices that fits have missed are of a connected set that is higher than terraces somewhere.

    Parameters
    ----------
    vertices : (n_vertices, 3) ndarray of float
        Positions.
    rings : tuple of ndarray of int
        Neighbours of each vertex, in compressed rows.
    spacing : (n_vertices,) ndarray of float
        Typical distance between neighbours.
    is_missed : (n_vertices,) ndarray of bool
        Where the fits pass by the vertices, all of them on one side.
    heights : (n_vertices,) ndarray of float
        Heights over the fits, in the unit of length.

    Notes
    -----
    A surface through the voxels of a mask has steps, whose curvature is large at the scale of some spacings and means
    nothing.  Smoothing makes them round, and neither fits nor residuals tell them from small waves of the surface.  But
    steps are low everywhere, and detail is not: somewhere a fold or a bump rises over the fits that miss it.
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import connected_components

    rows, (offsets, neighbours) = np.flatnonzero(is_missed), rings
    is_beyond = np.zeros(len(heights), np.bool_)
    if not len(rows):
        return is_beyond
    is_high = np.abs(heights) > _half_voxels(vertices, rings, spacing)
    links = csr_array((np.ones(len(neighbours), np.bool_), neighbours, offsets), shape=(len(heights),) * 2)
    component = connected_components(links[rows][:, rows], directed=False)[1]
    is_beyond[rows] = (np.bincount(component, is_high[rows]) > FEW * np.bincount(component))[component]
    return is_beyond


def _half_voxels(vertices: Floats, rings: Rows, spacing: Floats) -> Floats:
    """(n_vertices,): half of the longest side of the voxels that the vertices are on, by the diagonals of their faces.

    Around a vertex the spacing tells the short sides, or both if a long one is among them; then it is larger.
    """
    longest = np.empty(len(vertices))
    stencils.longest_links(vertices, *rings, longest)
    is_joined = longest > 0.0
    small, large = np.nanquantile(spacing[is_joined], (0.05, 0.95))
    diagonal = 2.0 ** (np.round(STEPS * np.log2(np.quantile(longest[is_joined], LONG))) / STEPS)
    for _ in range(PASSES):
        sums = np.empty_like(spacing)
        stencils.ring_sums(np.nan_to_num(spacing), *rings, sums)
        spacing = sums / (np.diff(rings[0]) + 1)
    if large > GRADED * small:
        return LEAST * spacing
    ratio = np.divide(diagonal, spacing, out=np.zeros_like(spacing), where=spacing > 0.0)
    return spacing * np.clip(GAIN * (ratio - 1.0), LEAST, MOST)
