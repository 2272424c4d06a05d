"""Order and radius of local fits, from the data: at a sample of the vertices first, then at every centre of a patch."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.centres import cover, flat_frames, members_of_discs
from rinow.curvature.stencils import N_BLOCKS
from rinow.kernels import balls, covers, patch_fits, patches, risks
from rinow.kernels.nested_fits import MAX_ORDER, N_ORDERS

__all__ = ["LADDER", "Choice", "Ladder", "Samples", "chosen_at", "sample", "select", "windows"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

PILOT_RADII, PILOT_ORDER = 10, 6
"""Balls and orders of the fits over the tangent plane."""
SAMPLE_SPACINGS = ((8192, 4.5), (32768, 6.0), (np.inf, 8.0))
"""Radius a sample covers, in spacings, for meshes up to so many vertices."""
ROUNDING = 1e-15
"""Least noise, in spacings."""
NEAR, AROUND = 1.5, 2.2
"""Reach of a sample over the vertices it speaks for, and over the samples it is averaged with, in radii it covers."""


class Ladder(NamedTuple):
    """Radii of balls: reaches (R,) in units of `factors` (n,) spacings, and the most points of a ball."""

    reaches: Floats
    factors: Floats
    most: int

    @classmethod
    def of_radius(cls, radius: float, sheet: balls.Sheet) -> Ladder:
        """One ball of a given radius, in the unit of length."""
        return cls(np.ones(1), radius / sheet.spacing, len(sheet.spacing))

    @classmethod
    def free(cls, sheet: balls.Sheet) -> Ladder:
        """The balls to choose from."""
        return cls(LADDER, np.ones(len(sheet.spacing)), 4096)


LADDER = np.array([1.6, 2.0, 2.5, 3.1, 3.8, 4.7, 5.8, 7.2, 9.0, 11.2, 14.0, 17.0])
"""Radii of balls, in spacings."""


class Choice(NamedTuple):
    """For each centre the index of the radius (-1 for none), the order and the expected squared error."""

    radius: Ints
    order: Ints
    risk: Floats


class Samples(NamedTuple):
    """What the sample tells.

    For each vertex the samples near it (compressed rows); for each sample the vertices it speaks for (compressed rows),
    its logarithmic risks of H over the plane and of K over the torus for each radius and order, its choice and noise.
    """

    starts: Ints
    near: Ints
    member_starts: Ints
    members: Ints
    plane_logs: Floats
    torus_logs: Floats
    choice: Choice
    noise: Floats


def sample(sheet: balls.Sheet, ladder: Ladder, is_refined: bool) -> Samples:
    """Examine all balls and orders at a sample of the vertices."""
    from scipy.sparse import csr_array

    n = len(sheet.vertices)
    radius = next(r for size, r in SAMPLE_SPACINGS if n <= size)
    centres, _ = cover(sheet, np.full(n, radius))
    m = len(centres)
    links = members_of_discs(sheet, centres, centres, np.full(m, AROUND * radius))
    n_plane = min(PILOT_RADII, len(ladder.reaches))
    plane_logs, choice, _ = _examine(sheet, ladder, centres, flat_frames(sheet, centres), n_plane, True, links)
    frames = flat_frames(sheet, centres)
    out = np.empty_like(frames)
    reaches = ladder.reaches[choice.radius] * ladder.factors[centres]
    patches.pilot_frames(centres, frames, reaches, choice.order, ladder.most, N_BLOCKS, sheet, out)
    if is_refined:
        patches.pilot_frames(centres, out.copy(), reaches, choice.order, ladder.most, N_BLOCKS, sheet, out)
    torus_logs, choice, noise = _examine(sheet, ladder, centres, out, len(ladder.reaches), False, links)
    everything = np.arange(n, dtype=np.int32)
    member_starts, members = members_of_discs(sheet, everything, centres, np.full(m, NEAR * radius))
    t = csr_array((np.ones(len(members), np.bool_), members, member_starts), shape=(m, n)).tocsc()
    return Samples(t.indptr, t.indices, member_starts, members, plane_logs, torus_logs, choice, noise)


def _examine(
    sheet: balls.Sheet, ladder: Ladder, centres: Ints, frames: Floats, n_radii: int, is_mean: bool, links: tuple[Ints, Ints]
) -> tuple[Floats, Choice, Floats]:
    """Logarithmic risks (m, n_radii, 7), choices and noise of samples, whose noise is not known beforehand."""
    m = len(centres)
    low, high = np.zeros(m, np.int32), np.full(m, n_radii - 1, np.int32)
    order = np.full(m, PILOT_ORDER if is_mean else MAX_ORDER, np.int32)
    rows = np.arange(m + 1) * n_radii
    tables = _empty_tables(rows[-1], known=False)
    patch_fits.fill_tables(
        centres, frames, ladder.reaches, ladder.factors[centres], low, high, order, rows, np.ones(m), is_mean,
        ladder.most, N_BLOCKS, sheet, tables,
    )  # fmt: skip
    spacing = sheet.spacing[centres]
    residuals = _averaged(tables.noise, spacing, -2, rows, low, high, links, 1).reshape(m, n_radii * N_ORDERS).astype(np.float64)
    noise = np.fmin.reduce(residuals, axis=1, initial=np.inf)
    noise[noise == np.inf] = 0.0
    noise = np.maximum(noise, ROUNDING**2)
    s2 = np.repeat(noise, n_radii)[:, None]
    comparison = s2 * tables.bias_variance
    known = patch_fits.Tables(
        (s2 * tables.variance + s2 * s2 * tables.second).astype(np.float32),
        (tables.bias - comparison).astype(np.float32), comparison.astype(np.float32),
        tables.leverage, tables.second[:0], tables.noise[:0],
    )  # fmt: skip
    logs = np.full((m, n_radii, N_ORDERS), np.nan)
    power = 2 if is_mean else 4
    choice = _least(ladder, spacing, power, known, rows, low, high, links, 1, logs)
    return logs - power * np.log(spacing)[:, None, None], choice, noise * spacing**2


def windows(samples: Samples) -> tuple[Ints, Ints, Ints, Floats]:
    """For each vertex the least and largest index of radius and the highest order chosen near it, and the noise there."""
    n = len(samples.starts) - 1
    low, high, top, noise = np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n)
    choice = samples.choice
    covers.windows(samples.starts, samples.near, choice.radius, choice.order, samples.noise, low, high, top, noise)
    unknown = high < 0
    low[unknown], high[unknown], top[unknown] = 0, samples.torus_logs.shape[1] - 1, 4
    return low, high, top, noise


def chosen_at(vertices: Ints, samples: Samples, logs: Floats) -> Choice:
    """The least mean logarithmic risk among the samples near each vertex."""
    choice = _empty_choice(len(vertices))
    covers.choices(vertices, samples.starts, samples.near, logs, *choice)
    return choice


def select(
    sheet: balls.Sheet, ladder: Ladder, centres: Ints, frames: Floats, window: tuple[Ints, Ints, Ints, Floats],
    links: tuple[Ints, Ints], passes: int,
) -> Choice:  # fmt: skip
    """The least risk of each centre among the radii low..high and orders up to `top`, for known noise."""
    low, high, top, noise = window
    spacing = sheet.spacing[centres]
    rows = np.zeros(len(centres) + 1, np.int64)
    np.cumsum(high - low + 1, out=rows[1:])
    tables = _empty_tables(rows[-1], known=True)
    patch_fits.fill_tables(
        centres, frames, ladder.reaches, ladder.factors[centres], low, high, top, rows, noise / spacing**2, False,
        ladder.most, N_BLOCKS, sheet, tables,
    )  # fmt: skip
    return _least(ladder, spacing, 4, tables, rows, low, high, links, passes, np.empty((0, 0, 0)))


def _least(
    ladder: Ladder, spacing: Floats, power: int, tables: patch_fits.Tables, rows: NDArray[np.int64],
    low: Ints, high: Ints, links: tuple[Ints, Ints], passes: int, logs: Floats,
) -> Choice:  # fmt: skip
    """The choice of least risk, which is in units of length; its logarithms in those of the spacings."""
    place = (spacing, power, rows, low, high, links)
    bias, bias_variance = (_averaged(x, *place, passes) for x in (tables.bias, tables.bias_variance))
    variance = _averaged(tables.variance, *place, 1)
    choice = _empty_choice(len(spacing))
    risks.least_risks(rows, low, high, ladder.reaches, tables, variance, bias, bias_variance, *choice, logs)
    return choice._replace(risk=choice.risk / spacing**power)


def _averaged(
    values: NDArray[np.float32], spacing: Floats, power: int, rows: NDArray[np.int64], low: Ints, high: Ints,
    links: tuple[Ints, Ints], passes: int,
) -> NDArray[np.float32]:  # fmt: skip
    for _ in range(passes):
        out = np.empty_like(values)
        risks.average_rows(values, spacing, power, rows, low, high, links[1], links[0], out)
        values = out
    return values


def _empty_tables(n_rows: int, known: bool) -> patch_fits.Tables:
    n_biases, n_unknown = patch_fits.N_BIASES, 0 if known else n_rows
    sizes = ((n_rows, N_ORDERS), (n_rows, n_biases), (n_rows, n_biases), (n_rows, N_ORDERS))
    return patch_fits.Tables(*(np.empty(s, np.float32) for s in (*sizes, (n_unknown, N_ORDERS), (n_unknown, N_ORDERS))))


def _empty_choice(n: int) -> Choice:
    return Choice(np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n))
