"""Centres of patches: which vertices, the frames they start from, and which of them lie near each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.sheet import sorted_by
from rinow.curvature.stencils import N_BLOCKS
from rinow.kernels import balls, covers

__all__ = ["CORE", "cover", "flat_frames", "members_of_discs"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

CORE = 1.4
"""Radius of the part of a patch that is used, over the radius within which the centre is the only one."""


def cover(sheet: balls.Sheet, radii: Floats, core: float = CORE) -> tuple[Ints, Ints]:
    """Vertices within whose radii all vertices lie, and the sizes of their discs of `core` radii.

    Parameters
    ----------
    sheet : Sheet
        The surface.
    radii : (n,) ndarray of float
        Radius a vertex covers, in spacings.
    core : float, optional
        At least 1.

    Notes
    -----
    The vertices are taken in the order of a hash of the shapes of their stars, so the choice is that of a random order:
    a change of the mesh changes the choice near it only, and neither a motion nor another numbering changes it, except
    among stars of equal shape, which come in the order of their numbers in the sheet.
    """
    keys = np.empty(len(radii), np.uint32)
    covers.shape_keys(sheet.vertices, sheet.offsets, sheet.neighbours, keys)
    centres, sizes = np.empty(len(radii), np.int32), np.empty(len(radii), np.int32)
    count = covers.cover(sorted_by(keys), radii * sheet.spacing, core, sheet, centres, sizes)
    order = np.argsort(centres[:count])
    return centres[order], sizes[order]


def members_of_discs(sheet: balls.Sheet, targets: Ints, sources: Ints, radii: Floats) -> tuple[Ints, Ints]:
    """Compressed rows: the numbers of the targets in the disc of each source, grown over edges; radii in spacings."""
    places = np.full(len(sheet.vertices), -1, np.int32)
    places[targets] = np.arange(len(targets), dtype=np.int32)
    lengths = radii * sheet.spacing[sources]
    counts, starts = np.empty(len(sources), np.int32), np.zeros(len(sources) + 1, np.int32)
    members = np.empty(0, np.int32)
    for is_counting in (True, False):
        covers.link(places, sources, lengths, counts, starts, is_counting, N_BLOCKS, sheet, members)
        if is_counting:
            np.cumsum(counts, out=starts[1:])
            members = np.empty(starts[-1], np.int32)
    return starts, members


def flat_frames(sheet: balls.Sheet, rows: Ints) -> Floats:
    """(n, 11): normal, two tangents and curvatures 0 of the tangent planes at vertices."""
    frames = np.zeros((len(rows), 11))
    balls.flat_frames(rows, sheet, frames)
    return frames
