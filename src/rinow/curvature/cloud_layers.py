"""The points nearest to each point of a cloud that lie on the same sheet: what its curvature is seen from."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from rinow.curvature.cloud_facing import facing
from rinow.curvature.cloud_stars import agreement, first_stars
from rinow.curvature.stencils import N_BLOCKS
from rinow.kernels import cloud_layers, cloud_strays, clouds

__all__ = ["NEAREST", "Near", "cleaned", "nearest_points"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

NEAREST = 36
"""Points looked at around each one: five rows of points that are five times as near along a row as across."""
LEAST, PART = 8, 4
"""Of a small cloud a quarter is around each point, but at least eight: more would be on the other side, too."""
LOOKED_AT = 72
"""Points among which these are sought where there is more than one sheet."""
FAR, SPARSE = 3.0, 2.0
"""Distance of the nearest points, over the same of these, from which a point is far from everything; and over that of
a quarter of the points around, from which a point beside a surface is not on another one."""
N_NEAR, ALONE = 8, 2
"""Points whose mean distance that is, and how many of them may lie beside the surface as well: more are a sheet of
their own, at a crease or beside another one."""
DEVIATIONS, SPACINGS = 14.0, 0.3
"""Offset from the surface that is no noise: in median residuals (eight standard deviations of noise), in spacings."""
THICK, THICKEST = 1.0, 1.2
"""Largest residuals, in spacings, of the nearest points and of twice as many, from which on they are on no sheet: noise
of a fifth of the spacing leaves half of it."""
LEAST_CLAIMS, MOST_LOST = 18, 0.5
"""Points that must have a lost one on their sheets for it to be one of them, and the share of lost points from which
nothing around is known."""
BETWEEN = 0.25
"""Share of its neighbours that gaps part from others from which on a point without such a gap is between two sheets."""

TOLD = 0.8
"""Share of the triangles of the stars around on which these agree, from which on points that face the same way are on
one sheet: noise of a fifth of the spacing leaves 0.86."""


class Near(NamedTuple):
    """(n_points, k): distances and indices of the points nearest to each one, ascending.

    A row with the point itself in the place of another one has fewer.
    """

    distances: Floats
    indices: Indices


def nearest_points(points: Floats) -> Near:
    """The 36 points nearest to each one, or all if there are fewer."""
    distances, near = KDTree(points).query(points, min(NEAREST, len(points) - 1) + 1)
    return Near(distances[:, 1:].copy(), np.asarray(near, np.intp)[:, 1:].copy())


def cleaned(points: Floats) -> tuple[Near, Bools, Bools]:
    """Neighbours on the own sheet of each point, and which points are strays, and on no sheet that could be told.

    Parameters
    ----------
    points : (n_points, 3) ndarray of float
        Positions.

    Returns
    -------
    near : Near
        The 36 nearest points of the own sheet, a quarter of all if these are few; rows of lost points are empty, but
        others have them in theirs.
    is_stray : (n_points,) ndarray of bool
        The point is far from all others, or beside the quadric that fits those around it, alone or among points that
        are much rarer than those of the surface.
    is_lost : (n_points,) ndarray of bool
        The points around, or some of them, are on no surface.

    Notes
    -----
    A quadric of least moduli, which a few strays do not bend, goes through the points around each one, without itself.
    A curved surface of few points leaves residuals too; their median, over the points around, raises the limit.  Where
    one of the residuals is large, the nearest points that face the same way are neighbours, see `cloud_facing`, if the
    stars around agree.  Else, or if they agree more on it, the sheet of the point is followed outwards, see
    `kernels.cloud_layers`; where no gap parts it from other points the neighbours stay, unless gaps part many of these:
    then the point has the neighbours that have it on their sheets, or is lost.  Nothing is examined where fewer than 36
    points are looked at.
    """
    near, n = nearest_points(points), len(points)
    around = max(n // PART, LEAST)
    if near.indices.shape[1] < NEAREST:
        return _first(near, around), np.zeros(n, np.bool_), np.zeros(n, np.bool_)
    close = near.distances[:, :N_NEAR].mean(axis=1)
    is_far = close > FAR * np.median(close[near.indices[:, :N_NEAR]], axis=1)
    normals, offsets, middles, largest = np.empty_like(points), np.empty(n), np.empty(n), np.empty(n)
    clouds.plane_normals(points, near.indices, NEAREST, normals)
    around_each = near.indices, near.distances[:, -1]
    cloud_strays.offsets(np.arange(n), points, normals, *around_each, N_BLOCKS, offsets, middles, largest)
    spacing = np.sqrt(np.pi / (NEAREST + 0.5)) * near.distances[:, -1]
    is_beside = offsets > np.maximum(DEVIATIONS * np.median(middles[near.indices], axis=1), SPACINGS * spacing)
    is_alone = np.count_nonzero(is_beside[near.indices[:, :N_NEAR]], axis=1) <= ALONE
    is_sparse = close > SPARSE * np.quantile(close[near.indices], 0.25, axis=1)
    farthest = np.maximum(offsets, largest) / spacing
    owners = np.flatnonzero(farthest > SPACINGS)
    near, is_unclear, is_lost = _own_sheets(points, near, owners, farthest > THICK)
    is_stray = is_far | (is_beside & (is_sparse | (is_alone & is_unclear)))
    return _first(near, around), is_stray, is_lost & ~is_stray


def _first(near: Near, count: int) -> Near:
    return Near(near.distances[:, :count].copy(), near.indices[:, :count].copy())


def _own_sheets(points: Floats, near: Near, owners: Indices, is_thick: Bools) -> tuple[Near, Bools, Bools]:
    """Those of the nearest points that face the same way, or those on the sheet followed, where stars agree more."""
    followed = Near(near.distances.copy(), near.indices.copy())
    is_unclear, is_lost = _follow_sheets(points, followed, owners, is_thick)
    if not len(owners):
        return followed, is_unclear, is_lost
    ahead, agreed = facing(points, near.indices)
    is_told, share = agreed > 0.0, agreed[near.indices].mean(axis=1)
    is_told &= share > TOLD
    if not np.array_equal(near.indices, followed.indices):
        others = agreement(first_stars(points, followed.indices)[1])
        is_told &= share >= others[near.indices].mean(axis=1)
    followed.distances[is_told], followed.indices[is_told] = near.distances[is_told], ahead[is_told]
    return followed, is_unclear, is_lost & ~is_told


def _follow_sheets(points: Floats, near: Near, owners: Indices, is_thick: Bools) -> tuple[Bools, Bools]:
    """Overwrite the rows of points beside another sheet by those on their own; which are on none, or thick, or lost."""
    is_unclear, is_lost = np.zeros((2, len(points)), np.bool_)
    distances, indices = KDTree(points).query(points[owners], min(LOOKED_AT, len(points) - 1) + 1)
    distances, indices = distances[:, 1:].copy(), np.asarray(indices, np.intp)[:, 1:].copy()
    is_own, thickness = np.empty(indices.shape, np.bool_), np.empty(len(owners))
    cloud_layers.layers(owners, points, indices, distances, N_BLOCKS, is_own, thickness)
    is_unclear[owners] = (thickness > THICKEST) & is_thick[owners]
    is_parted = np.zeros(len(points), np.bool_)
    is_parted[owners] = ~is_own.all(axis=1)
    is_between = ~is_parted[owners] & (is_parted[near.indices[owners]].mean(axis=1) > BETWEEN)
    is_lost[owners] = is_between | (is_unclear[owners] & is_parted[owners])
    rows = np.flatnonzero(is_between | is_parted[owners])
    owners, distances, indices, is_own = owners[rows], distances[rows], indices[rows], is_own[rows]
    _write(near, owners, distances, indices, is_own & ~is_lost[owners, None])
    _drop_strangers(points, near, owners)
    is_lost = _adopted(near, is_lost)
    _drop_strangers(points, near, owners)
    return is_unclear, is_lost


def _drop_strangers(points: Floats, near: Near, owners: Indices) -> None:
    """Take points out of the rows of those whose company they do not share: one wrong link would join two sheets."""
    strange = np.empty((len(owners), NEAREST), np.bool_)
    cloud_layers.strangers(owners, points, np.sort(near.indices, axis=1), near.indices, near.distances[:, -1], strange)
    near.indices[owners] = np.where(strange, owners[:, None], near.indices[owners])


def _write(near: Near, owners: Indices, distances: Floats, indices: Indices, known: Bools) -> None:
    """Overwrite rows by the first of the known points, as many as fit, the rest by their owners."""
    first = np.argsort(~known, axis=1, kind="stable")[:, :NEAREST]
    known, indices = np.take_along_axis(known, first, axis=1), np.take_along_axis(indices, first, axis=1)
    distances = np.take_along_axis(distances, first, axis=1)
    count = np.maximum(np.count_nonzero(known, axis=1, keepdims=True), 1)
    # As far as so many points of the same density would be.
    farthest = np.take_along_axis(distances, count - 1, axis=1) * np.sqrt(NEAREST / count)
    near.indices[owners] = np.where(known, indices, owners[:, None])
    near.distances[owners] = np.where(known, distances, farthest)


def _adopted(near: Near, is_lost: Bools) -> Bools:
    """Give lost points, whose rows are empty, the rows of those that have them on their sheets; who stays lost."""
    rows, places = np.nonzero(is_lost[near.indices] & ~is_lost[:, None])
    lost, distances = near.indices[rows, places], near.distances[rows, places]
    order = np.lexsort((distances, lost))
    lost, rows, distances = lost[order], rows[order], distances[order]
    owners, starts, counts = np.unique(lost, return_index=True, return_counts=True)
    keep = counts >= LEAST_CLAIMS
    owners, starts, counts = owners[keep], starts[keep], counts[keep]
    rank = np.minimum(np.arange(NEAREST), counts[:, None] - 1) + starts[:, None]
    _write(near, owners, distances[rank], rows[rank], np.arange(NEAREST) < counts[:, None])
    is_lost = is_lost.copy()
    is_lost[owners] = False
    return is_lost | (is_lost[near.indices].mean(axis=1) > MOST_LOST)
