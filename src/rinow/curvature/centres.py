"""Centres of patches: which vertices, the frames they start from, and which of them lie near each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.sheet import sorted_by
from rinow.kernels import balls, covers

__all__ = ["CORE", "DENSE", "cover", "flat_frames", "members_of_discs", "sizes_of_discs", "turns"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

CORE = 1.4
"""Radius of the part of a patch that is used, over the radius within which the centre is the only one."""
DENSE = 6.0
"""Vertices in a disc over its squared radius in spacings: 3.6 in a mesh of equilateral triangles, rarely above 5."""
WIDEST, PORTIONS = 64, 8
"""Vertices of a disc up to which it is grown before it is known whether it is needed, on all threads, and how many
times as many as the discs grown together hold there are at least, so that most of them are."""
MOST_TIED = 500
"""Stars of equal shape that become centres together."""


def turns(sheet: balls.Sheet) -> Ints:
    """All vertices in the order in which they may become centres; ~v for a vertex v tied with the one before.

    Notes
    -----
    It is that of a hash of the shapes of their stars, so the choice is that of a random order: a change of the mesh
    changes the choice near it only, and neither a motion nor another numbering changes it.  Stars of equal shape, as a
    symmetry of the mesh makes them, are tied, up to `MOST_TIED` of them: more, as on a plane, would all be centres, and
    come in the order of their numbers in the sheet.
    """
    keys = np.empty(len(sheet.vertices), np.uint32)
    covers.shape_keys(sheet.vertices, sheet.offsets, sheet.neighbours, keys)
    order = sorted_by(keys)
    starts = np.flatnonzero(np.diff(keys[order], prepend=~keys[order[:1]]))
    is_tied = np.repeat(np.diff(starts, append=len(keys)) <= MOST_TIED, np.diff(starts, append=len(keys)))
    is_tied[starts] = False
    return np.where(is_tied, ~order, order)


def cover(sheet: balls.Sheet, candidates: Ints, radii: Floats) -> Ints:
    """Vertices within whose radii all vertices lie, ascending.

    Parameters
    ----------
    sheet : Sheet
        The surface.
    candidates : (n,) ndarray of int
        All vertices, as `turns` gives them; each becomes a centre if it lies in the disc of no earlier one that it is
        not tied with.
    radii : (n,) ndarray of float
        Radius a vertex covers, in spacings.
    """
    n, lengths, centres = len(sheet.vertices), radii * sheet.spacing, [np.empty(0, np.int32)]
    marks, room, is_covered = np.zeros(n, np.int32), np.empty(n + 1, np.int32), np.zeros(n, np.bool_)
    size = int(DENSE * min(float(radii.max(initial=0.0)), np.sqrt(n)) ** 2) + 1  # of any radius, larger than all
    width, most = size if size <= WIDEST else 1, n // (PORTIONS * size) + 1
    first, epoch, found = 0, 1, np.empty(n, np.int32)
    while first < len(candidates):
        count, first = covers.next_uncovered(candidates, first, most, is_covered, found)
        counts, members = np.empty(count, np.int32), np.empty((count, width), np.int32)
        covers.small_discs(found[:count], lengths, sheet, counts, members)
        place = marks, room, epoch, is_covered
        centres.append(found[: covers.settle(found[:count], counts, members, lengths, sheet, *place)].copy())
        epoch += count
    return np.sort(np.concatenate(centres))


def sizes_of_discs(sheet: balls.Sheet, sources: Ints, radii: Floats) -> Ints:
    """Number of vertices in the disc of each source, grown over edges; radii in spacings."""
    everything = np.arange(len(sheet.vertices), dtype=np.int32)
    return _linked(sheet, everything, sources, radii, np.zeros(len(sources) + 1, np.int64))[0]


def members_of_discs(
    sheet: balls.Sheet, targets: Ints, sources: Ints, radii: Floats, room: int = 32
) -> tuple[Ints, Ints]:
    """Compressed rows: the numbers of the targets in the disc of each source, grown over edges; radii in spacings.

    It takes twice as long if a disc has more targets than `room`.
    """
    places = np.full(len(sheet.vertices), -1, np.int32)
    places[targets] = np.arange(len(targets), dtype=np.int32)
    counts, links = _linked(sheet, places, sources, radii, np.arange(len(sources) + 1) * room)
    starts = np.zeros(len(sources) + 1, np.int32)
    np.cumsum(counts, out=starts[1:])
    if counts.max(initial=0) > room:
        return starts, _linked(sheet, places, sources, radii, starts.astype(np.int64))[1]
    return starts, links.reshape(len(sources), room)[np.arange(room) < counts[:, None]]


def _linked(
    sheet: balls.Sheet, places: Ints, sources: Ints, radii: Floats, starts: NDArray[np.int64]
) -> tuple[Ints, Ints]:
    """How many targets are in the disc of each source, and those that fit into rows from `starts` on."""
    counts, links = np.empty(len(sources), np.int32), np.empty(starts[-1], np.int32)
    covers.link(places, sources, radii * sheet.spacing[sources], starts, sheet, counts, links)
    return counts, links


def flat_frames(sheet: balls.Sheet, rows: Ints) -> Floats:
    """(n, 11): normal, two tangents and curvatures 0 of the tangent planes at vertices."""
    frames = np.zeros((len(rows), 11))
    balls.flat_frames(rows, sheet, frames)
    return frames
