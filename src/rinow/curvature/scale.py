"""Order and radius of local fits, from the data: at a sample of the vertices first, then at every centre of a patch."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.centres import DENSE, cover, flat_frames, members_of_discs, turns
from rinow.curvature.charts import MEAN_ORDER, WIDER, Choice, log_ratios, lower
from rinow.curvature.lack_of_fit import squared_biases_by_residuals
from rinow.curvature.patch_tasks import Fitting, Tasks, fill_tables, fit_frames
from rinow.curvature.stencils import N_BLOCKS
from rinow.kernels import balls, covers, patch_driver, patch_fits, risks
from rinow.kernels.nested_fits import MAX_ORDER, N_ORDERS
from rinow.kernels.patch_fits import BOTH, GAUSSIAN, MEAN

__all__ = ["LADDER", "Ladder", "Samples", "chosen_at", "curvedness_of", "sample", "scales", "select", "windows"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]
Scales = tuple[Floats, Floats, Floats]

PILOT_RADII, PILOT_ORDER = 10, 6
"""Balls and orders of the fits over the tangent plane."""
SAMPLE_SPACINGS = ((8192, 4.5, 4.5), (32768, 6.0, 6.0), (np.inf, 8.0, 10.0))
"""Radius a sample covers, in spacings, for surfaces up to so many vertices: with and without refinement."""
BENT = 0.1
"""How much errors of H count over a plane beside those of K: on folds K shall decide."""
ROUNDING = 1e-15
"""Least noise, in spacings."""
NEAR, AROUND = 1.5, 2.2
"""Reach of a sample over the vertices it speaks for, and over the samples it is averaged with, in radii it covers."""

LADDER = np.array([1.6, 2.0, 2.5, 3.1, 3.8, 4.7, 5.8, 7.2, 9.0, 11.2, 14.0, 17.0])
"""Radii of balls, in spacings."""
RUNG = np.log(LADDER[-1] / LADDER[0]) / (len(LADDER) - 1)
"""Logarithm of the step from one to the next."""


class Ladder(NamedTuple):
    """Radii of balls: reaches (R,) in units of `factors` (n,) spacings, and the most points of a ball.

    All noise has at least the variance `rounding` (n,), in spacings.
    """

    reaches: Floats
    factors: Floats
    most: int
    rounding: Floats

    @classmethod
    def of_radius(cls, radius: float, sheet: balls.Sheet, rounding: Floats | float = 0.0) -> Ladder:
        """One ball of a given radius, for positions rounded with that variance, both in the unit of length."""
        least = np.maximum(rounding / sheet.spacing**2, ROUNDING**2)
        return cls(np.ones(1), radius / sheet.spacing, len(sheet.spacing), least)

    @classmethod
    def free(cls, sheet: balls.Sheet, rounding: Floats | float = 0.0) -> Ladder:
        """The balls to choose from."""
        least = np.maximum(rounding / sheet.spacing**2, ROUNDING**2)
        return cls(LADDER, np.ones(len(sheet.spacing)), 4096, least)

    def fitting(
        self, task: int, sheet: balls.Sheet, centres: Ints, frames: Floats, low: Ints, high: Ints, orders: Ints,
        rows: NDArray[np.int64], noise: Floats, errors_of: int = BOTH, curvedness: Floats | None = None,
    ) -> Fitting:  # fmt: skip
        """Fits about some vertices to the balls of the given indices; planes do not tell the curvedness."""
        bend = curvedness_of(frames) if curvedness is None else curvedness
        own = patch_driver.Centres(centres, frames, low, high, self.factors[centres], orders, rows, noise, bend)
        return Fitting(task, errors_of, self.reaches, self.most, sheet, own)

    def frames(
        self, sheet: balls.Sheet, centres: Ints, frames: Floats, choice: Choice, tasks: Tasks, is_level: Bools
    ) -> Floats:
        """Frames of the tori that osculate the fits of a choice of radius and order, or of mean planes.

        Where the given frame is too steep over the mean plane for any fit, its tangent plane stays.
        """
        rows, noise = np.zeros(len(centres) + 1, np.int64), np.zeros(len(centres))
        radius = np.clip(choice.radius + WIDER * is_level, 0, len(self.reaches) - 1).astype(np.int32)
        order = np.where(is_level, MEAN_ORDER, choice.order).astype(np.int32)
        fitting = self.fitting(patch_driver.FRAMES, sheet, centres, frames, radius, radius, order, rows, noise)
        found = fit_frames(fitting, tasks, 0.1)
        cosines = np.sum(found[:, :3] * frames[:, :3], axis=1)
        is_steep = is_level & (cosines**2 * (1.0 + patch_fits.STEEP) < 1.0)
        found[is_steep] = frames[is_steep]
        found[is_level, 9:] = 0.0
        return found

    def turns(self, sheet: balls.Sheet, centres: Ints, frames: Floats, choice: Choice) -> Floats:
        """Angles by which tori turn, in the direction of their curvedness, over the radii of a choice."""
        return curvedness_of(frames) * self.reaches[choice.radius] * self.factors[centres] * sheet.spacing[centres]


def curvedness_of(frames: Floats) -> Floats:
    """Curvedness of the tori of frames."""
    return np.sqrt(0.5) * np.linalg.norm(frames[:, 9:], axis=1)


class Samples(NamedTuple):
    """What the sample tells.

    The vertices in the order in which they become centres; for each vertex the samples near it (compressed rows); for
    each sample the vertices it speaks for (compressed rows), its logarithmic risks of H over the plane, of K over the
    torus, and of both over the mean plane, for each radius and order, `log_ratios` of plane and torus, its choice,
    noise and spacing, and whether its bias was seen, and not only guessed.
    """

    turns: Ints
    starts: Ints
    near: Ints
    member_starts: Ints
    members: Ints
    plane_logs: Floats
    torus_logs: Floats
    level_logs: Floats
    level_ratios: Floats
    choice: Choice
    noise: Floats
    spacing: Floats
    is_seen: Bools


class Examined(NamedTuple):
    """Of samples: logarithmic risks (m, n_radii, 7), choices, noise, and mean square residuals (m, n_radii, 7)."""

    logs: Floats
    choice: Choice
    noise: Floats
    residuals: Floats


def sample(sheet: balls.Sheet, ladder: Ladder, is_refined: bool, tasks: Tasks, sizes: Ints | None = None) -> Samples:
    """Examine all balls and orders at a sample of the vertices, each in a component of so many vertices.

    Planes are asked for the errors of K and of H: where a surface is developable, as a cylinder is, K is 0 over a plane
    in the largest ball, however wrong H is.
    """
    from scipy.sparse import csr_array

    n = len(sheet.vertices)
    rows = np.searchsorted([size for size, _, _ in SAMPLE_SPACINGS], n if sizes is None else sizes)
    reach = np.array([fine if is_refined else coarse for _, fine, coarse in SAMPLE_SPACINGS])[rows]
    order = turns(sheet)
    centres = cover(sheet, order, np.broadcast_to(reach, n))
    m, radius = len(centres), np.broadcast_to(reach, n)[centres]
    links = members_of_discs(sheet, centres, centres, AROUND * radius)
    last = np.full(m, len(ladder.reaches) - 1, np.int32)
    flat, few = flat_frames(sheet, centres), np.minimum(last, PILOT_RADII - 1)
    pilot = _examine(sheet, ladder, centres, flat, 0.0 * sheet.spacing[centres], few, MEAN, links, tasks)
    bent, level = np.zeros(m, np.bool_), np.ones(m, np.bool_)
    frames = ladder.frames(sheet, centres, flat, pilot.choice, tasks, bent)
    if is_refined:
        frames = ladder.frames(sheet, centres, frames, pilot.choice, tasks, bent)
    torus = _examine(sheet, ladder, centres, frames, curvedness_of(frames), last, GAUSSIAN, links, tasks)
    planes = ladder.frames(sheet, centres, flat, torus.choice, tasks, level)
    plane = _examine(sheet, ladder, centres, planes, BENT * curvedness_of(frames), last, BOTH, links, tasks)
    ratios = log_ratios((torus.choice, torus.residuals), (plane.choice, plane.residuals))
    choice = lower(torus.choice, plane.choice, ratios, ladder.turns(sheet, centres, frames, plane.choice))[1]
    everything = np.arange(n, dtype=np.int32)
    room = int(DENSE * (NEAR * radius.max(initial=0.0)) ** 2)
    member_starts, members = members_of_discs(sheet, everything, centres, NEAR * radius, room)
    t = csr_array((np.ones(len(members), np.bool_), members, member_starts), shape=(m, n)).tocsc()
    starts, near = t.indptr.astype(np.int32), t.indices.astype(np.int32)
    is_seen = np.asarray(~np.isnan(torus.logs).all(axis=(1, 2)))
    for examined in (pilot, torus, plane):
        _log_guesses(examined)
    logs = pilot.logs, torus.logs, plane.logs, ratios
    found = choice, torus.noise, sheet.spacing[centres], is_seen
    return Samples(order, starts, near, member_starts, members, *logs, *found)


def _log_guesses(examined: Examined) -> None:
    """Where no bias is seen, at any radius and order, the choice with a guessed one is all that there is to choose."""
    logs, (radius, order, risk) = examined.logs, examined.choice
    rows = np.flatnonzero(np.isnan(logs).all(axis=(1, 2)) & (radius >= 0))
    logs[rows, radius[rows], order[rows] - 2] = np.log(risk[rows])


def _examine(
    sheet: balls.Sheet,
    ladder: Ladder,
    centres: Ints,
    frames: Floats,
    curvedness: Floats,
    high: Ints,
    errors_of: int,
    links: tuple[Ints, Ints],
    tasks: Tasks,
) -> Examined:
    """Examine samples, whose noise is not known beforehand, up to the radii of index `high`."""
    m, n_radii, low = len(centres), len(ladder.reaches), np.zeros(len(centres), np.int32)
    order = np.full(m, PILOT_ORDER if errors_of == MEAN else MAX_ORDER, np.int32)
    rows, spacing = np.arange(m + 1) * n_radii, sheet.spacing[centres]
    fitting = ladder.fitting(
        patch_driver.TABLES, sheet, centres, frames, low, high, order, rows, spacing**2, errors_of, curvedness
    )
    tables = fill_tables(fitting, False, tasks, 0.05)
    residuals = tables.noise.reshape(m, n_radii, N_ORDERS)
    medians = np.empty((m, n_radii * N_ORDERS))
    risks.median_rows(tables.noise.reshape(medians.shape) * spacing[:, None] ** 2, links[1], links[0], medians)
    noise = np.fmin.reduce(medians, axis=1, initial=np.inf) / spacing**2
    noise[noise == np.inf] = 0.0
    noise = np.maximum(noise, ladder.rounding[centres])
    ratios = np.fmin(medians.reshape(residuals.shape) / spacing[:, None, None] ** 2, residuals) / noise[:, None, None]
    missed = squared_biases_by_residuals(ratios, noise, ladder.reaches, curvedness * spacing, errors_of == MEAN)
    s2 = np.repeat(noise, n_radii)[:, None]
    comparison = s2 * tables.bias_variance
    known = patch_fits.Tables(
        (s2 * tables.variance + s2 * s2 * tables.second).astype(np.float32),
        (tables.bias - comparison).astype(np.float32), comparison.astype(np.float32),
        tables.leverage, np.fmax(tables.step - s2 * tables.step_variance, missed.reshape(len(s2), N_ORDERS)),
        *(x[:0] for x in tables[5:]),
    )  # fmt: skip
    logs = np.full((m, n_radii, N_ORDERS), np.nan)
    power = 2 if errors_of == MEAN else 4
    choice = _least(ladder, centres, spacing, power, known, rows, low, high, links, 1, logs)
    return Examined(logs - power * np.log(spacing)[:, None, None], choice, noise * spacing**2, residuals)


def windows(samples: Samples, scales: Scales) -> tuple[Ints, Ints, Ints, Floats]:
    """For each vertex the least and largest index of radius and the highest order chosen near it, and the noise.

    Where the spacing is another one than at a sample, the best radius is between that with as many vertices (without
    noise) and the same length (with noise): both count.
    """
    n = len(samples.starts) - 1
    low, high, top, noise = np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n)
    choice = samples.choice
    known = choice.radius, choice.order, samples.noise
    n_radii = samples.torus_logs.shape[1]
    covers.windows(samples.starts, samples.near, *known, *scales, n_radii, low, high, top, noise)
    unknown = high < 0
    low[unknown], high[unknown], top[unknown] = 0, n_radii - 1, 4
    return low, high, top, noise


def scales(samples: Samples, sheet: balls.Sheet, at_edge: NDArray[np.bool_]) -> Scales:
    """Spacings of vertices and samples, and the step of the ladder.

    It is infinite, so that radii in spacings are taken over as they are, if there is one radius only, and near a
    boundary: there the spacing is known less, and a ball that is small has too few points.
    """
    is_one = samples.torus_logs.shape[1] == 1
    return sheet.spacing, samples.spacing, np.where(at_edge | is_one, np.inf, RUNG)


def chosen_at(vertices: Ints, samples: Samples, scales: Scales, logs: Floats) -> Choice:
    """The least mean logarithmic risk among the samples near each vertex."""
    choice = _empty_choice(len(vertices))
    table = logs.reshape(len(logs), logs.shape[1] * logs.shape[2])
    covers.choices(vertices, samples.starts, samples.near, table, *scales, N_ORDERS, N_BLOCKS, *choice)
    return choice


def select(
    sheet: balls.Sheet, ladder: Ladder, centres: Ints, frames: Floats, curvedness: Floats,
    window: tuple[Ints, Ints, Ints, Floats], links: tuple[Ints, Ints], passes: int, tasks: Tasks,
) -> Choice:  # fmt: skip
    """The least risk of K and H of each centre among the radii low..high and orders up to `top`, for known noise."""
    low, high, top, noise = window
    spacing = sheet.spacing[centres]
    rows = np.zeros(len(centres) + 1, np.int64)
    np.cumsum(high - low + 1, out=rows[1:])
    fitting = ladder.fitting(patch_driver.TABLES, sheet, centres, frames, low, high, top, rows, noise, BOTH, curvedness)
    place, no_logs = (rows, low, high, links, passes), np.empty((0, 0, 0))
    return _least(ladder, centres, spacing, 4, fill_tables(fitting, True, tasks, 0.4), *place, no_logs)


def _least(
    ladder: Ladder, centres: Ints, spacing: Floats, power: int, tables: patch_fits.Tables, rows: NDArray[np.int64],
    low: Ints, high: Ints, links: tuple[Ints, Ints], passes: int, logs: Floats,
) -> Choice:  # fmt: skip
    """The choice of least risk, which is in units of length; its logarithms in those of the spacings.

    The tables, the largest arrays of all, are overwritten by their averages where two passes are made.
    """
    place = (spacing, power, rows, low, high, links)
    bias, bias_variance, step = (_averaged(x, *place, passes) for x in (tables.bias, tables.bias_variance, tables.step))
    variance = _averaged(tables.variance, *place, 1)  # last, since a single pass takes new memory
    averages = (variance, bias, bias_variance, step)
    choice = _empty_choice(len(spacing))
    risks.least_risks(rows, low, high, ladder.reaches, ladder.factors[centres], tables, *averages, *choice, logs)
    return choice._replace(risk=choice.risk / spacing**power)


def _averaged(
    values: NDArray[np.float32], spacing: Floats, power: int, rows: NDArray[np.int64], low: Ints, high: Ints,
    links: tuple[Ints, Ints], passes: int,
) -> NDArray[np.float32]:  # fmt: skip
    """Means over the centres around, taken `passes` times; two passes end in the memory of the values."""
    spare = np.empty_like(values)
    for _ in range(passes):
        risks.average_rows(values, spacing, power, rows, low, high, links[1], links[0], spare)
        values, spare = spare, values
    return values


def _empty_choice(n: int) -> Choice:
    return Choice(np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n))
