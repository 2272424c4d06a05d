"""A second look where fits pass by the vertices: smaller balls in the place of those that missed something."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.centres import CORE, cover, flat_frames, sizes_of_discs
from rinow.curvature.charts import Choice
from rinow.curvature.patch_tasks import Tasks, add_patches
from rinow.curvature.scale import Ladder
from rinow.curvature.searches import BESIDE, INSIDE, Centres, Found, look
from rinow.curvature.stencils import rings_around
from rinow.curvature.terraces import beyond_terraces
from rinow.kernels import balls, patch_driver, patches, stencils

__all__ = ["Values", "look_again", "missed"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]

HEIGHT = 4
"""Column of the heights over the fits."""
SURE, SMALL = 8.0, 0.1
"""Mean height of a vertex and its neighbours over the fits, in its standard errors and in spacings, from which on it is
no noise: that of the least noisy fit may be too low by half, and what is smaller bends no ball of a few spacings."""
MOST = 10.0
"""Height of a single vertex, over the noise, that counts at most: a few beside the surface are no bump."""
INDEPENDENT = 2.0
"""Median of the same up to which most of it is independent noise, for which it is 0.7."""
LOOKS, STEPS = 5, 2
"""Most repetitions, and radii that balls are smaller each time: by a third."""
LEAST, BESIDE_EDGE = 2, 3
"""Index of the least radius, which is not made smaller, and by how much it is larger beside a boundary."""
AROUND = 2
"""Rings around a vertex that was missed that are computed anew as well."""
FIRST, INNER, OUTER, NARROW = 4, 6, 4, 5
"""Order of the first frames, highest orders inside and beside a boundary, and how many radii are looked at."""


class Values(NamedTuple):
    """At the vertices of a sheet what `patches.mean_values` tells: its columns, and principal directions.

    `first` (n,) is the H of the first look, and `again` (n,) tells where, away from boundaries, there was another one;
    the heights, in a column, stay those over the fits of the first.  `steps` (n,) tells where these miss terraces.
    """

    columns: Floats
    direction1: Floats
    direction2: Floats
    first: Floats
    again: Bools
    steps: Bools

    @classmethod
    def of(cls, totals: Floats, normals: Floats) -> Values:
        """The means of weighted totals."""
        n = len(totals)
        found = np.empty((n, 6)), np.empty((n, 3)), np.empty((n, 3))
        patches.mean_values(totals, normals, *found)
        return cls(*found, found[0][:, 1].copy(), np.zeros(n, np.bool_), np.zeros(n, np.bool_))

    def put(self, rows: NDArray[np.intp], other: Values) -> None:
        """Take over some rows, in place, from a later look."""
        for mine, others in zip(self[:3], other[:3], strict=True):
            kept = self.columns[rows, HEIGHT]
            mine[rows] = others[rows]
            self.columns[rows, HEIGHT] = kept


def missed(sheet: balls.Sheet, heights: Floats, noise: Floats) -> Bools:
    """(n,): a vertex and most of its neighbours are on one side of the fits, farther than noise puts them there."""
    if not sheet.is_oriented:
        return np.zeros(len(heights), np.bool_)
    return (_errors(sheet, heights, noise) > SURE) & (np.abs(_of_stars(sheet, heights)) > SMALL * sheet.spacing)


def _errors(sheet: balls.Sheet, heights: Floats, noise: Floats) -> Floats:
    """(n,): mean heights of vertices and their neighbours in standard errors of independent noise."""
    ratio = np.divide(np.nan_to_num(heights), np.sqrt(noise), out=np.zeros_like(heights), where=noise > 0.0)
    return np.abs(_of_stars(sheet, np.clip(ratio, -MOST, MOST))) * np.sqrt(np.diff(sheet.offsets) + 1)


def _of_stars(sheet: balls.Sheet, values: Floats) -> Floats:
    """(n,): means over vertices and their neighbours."""
    means = np.empty_like(values)
    stencils.ring_sums(np.nan_to_num(values), sheet.offsets, sheet.neighbours, means)
    return means / (np.diff(sheet.offsets) + 1)


def _detail(sheet: balls.Sheet, heights: Floats, noise: Floats, is_missed: Bools) -> Bools:
    """(n,): what is missed around here is no terrace of voxels.  Where most is independent noise, nothing is one."""
    is_missed = rings_around(sheet, is_missed, AROUND)
    if not is_missed.any() or np.median(_errors(sheet, heights, noise)) < INDEPENDENT:
        return is_missed
    return beyond_terraces(sheet.vertices, (sheet.offsets, sheet.neighbours), sheet.spacing, is_missed, heights)


def look_again(
    sheet: balls.Sheet, ladder: Ladder, found: Values, turns: Ints, noise: Floats, at_edge: Bools,
    quality: tuple[float, float, float], tasks: Tasks,
) -> None:  # fmt: skip
    """Replace, in place, the values where fits pass by the vertices by those of smaller balls, until none do.

    `quality` is the share, the least radius and the power of `sectional.Quality`.

    Notes
    -----
    Order and radius are chosen by what fits of other orders and radii say.  Balls much larger than some bump hold it
    and say the same, that there is none, and samples of the plane around say so as well.  But the vertices then are far
    beside the fit, all on one side.  Steps of voxels are as well, and are left (`terraces`).
    """
    if len(ladder.reaches) == 1:
        return
    least, heights = np.where(at_edge, LEAST + BESIDE_EDGE, LEAST), found.columns[:, HEIGHT].copy()
    is_missed = missed(sheet, heights, noise)
    if not is_missed.any():
        return
    is_detail = _detail(sheet, heights, noise, is_missed)
    found.steps[:] = is_missed & ~is_detail
    for _ in range(LOOKS):
        with np.errstate(invalid="ignore"):
            index = np.searchsorted(ladder.reaches, found.columns[:, 3] / (sheet.spacing * ladder.factors) * (1 + 1e-9))
        index = np.clip(index - 1, 0, len(ladder.reaches) - 1)
        is_missed &= is_detail & (index > least)
        if not is_missed.any():
            return
        rows = np.flatnonzero(rings_around(sheet, is_missed, AROUND))
        high = _least_around(sheet, np.where(is_missed, index - STEPS, len(ladder.reaches)))
        high = np.maximum(high, least)[rows].astype(np.int32)
        again = _of_smaller(sheet, ladder, rows, high, turns, noise, at_edge, quality, tasks)
        rows = rows[np.isfinite(again.columns[rows, 0])]
        is_detail[rows] = True
        found.put(rows, again)
        found.again[rows] = ~at_edge[rows]
        heights[rows] = again.columns[rows, HEIGHT]
        is_missed = missed(sheet, heights, noise)


def _least_around(sheet: balls.Sheet, values: NDArray[np.intp]) -> NDArray[np.intp]:
    """The least value within `AROUND` rings."""
    for _ in range(AROUND):
        around = np.minimum.reduceat(np.append(values[sheet.neighbours], values.max()), sheet.offsets[:-1])
        values = np.minimum(values, np.where(np.diff(sheet.offsets) > 0, around, values))
    return values


def _of_smaller(
    sheet: balls.Sheet, ladder: Ladder, rows: NDArray[np.intp], high: Ints, turns: Ints, noise: Floats,
    at_edge: Bools, quality: tuple[float, float, float], tasks: Tasks,
) -> Values:  # fmt: skip
    """Values of patches about some vertices, over balls of no more than a radius of each."""
    share, smallest, power = quality
    highest, core = np.zeros(len(noise), np.int32), np.zeros(len(noise))
    highest[rows] = high
    core[rows] = np.maximum(smallest, share * ladder.reaches[np.maximum(high - NARROW, 0)])
    centres = cover(sheet, _among(turns, rows), core)
    high, core = highest[centres], core[centres]
    order, one = np.full(len(centres), FIRST, np.int32), np.ones(len(centres))
    start = Choice(high, order, one)
    inside = np.zeros(len(centres), np.bool_)
    frames = ladder.frames(sheet, centres, flat_frames(sheet, centres), start, tasks, inside)
    low = np.maximum(high - NARROW, 0).astype(np.int32)
    top = np.where(at_edge[centres], OUTER, INNER).astype(np.int32)
    known = Centres(centres, core, low, high, top, noise[centres], 0.0 * one)
    chosen, beside = Found(frames, start, one), at_edge[centres]
    for search, is_own in ((INSIDE, ~beside), (BESIDE, beside)):
        if is_own.any():
            own = np.flatnonzero(is_own)
            chosen.put(own, look(search, sheet, ladder, known.at(own), chosen.at(own), tasks, 0.0))
    choice = chosen.choice
    starts, radius = np.zeros(len(centres) + 1, np.int64), np.maximum(choice.radius, 0)
    np.cumsum(sizes_of_discs(sheet, centres, CORE * core), out=starts[1:])
    totals = np.zeros((len(sheet.vertices), patches.N_VALUES + 1))
    fitting = ladder.fitting(
        patch_driver.VALUES, sheet, centres, chosen.frames, radius, radius, choice.order, starts, noise[centres]
    )
    add_patches(fitting, CORE * core, choice.risk, choice.risk**-power, totals, tasks, 0.0)
    return Values.of(totals, sheet.normals)


def _among(turns: Ints, rows: NDArray[np.intp]) -> Ints:
    """The turns of some vertices; those tied with one that is left out are tied with the next one of these."""
    vertices, group = np.where(turns < 0, ~turns, turns), np.cumsum(turns >= 0)
    is_in = np.zeros(len(turns), np.bool_)
    is_in[rows] = True
    kept = is_in[vertices]
    vertices, group = vertices[kept], group[kept]
    return np.where(np.diff(group, prepend=-1) == 0, ~vertices, vertices).astype(np.int32)
