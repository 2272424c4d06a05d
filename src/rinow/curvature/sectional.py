"""Curvature from patches fitted over osculating tori, with the order and the scale that the data call for."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow._executor import Executor
from rinow.curvature.centres import CORE, cover, flat_frames, members_of_discs
from rinow.curvature.estimate import Estimate
from rinow.curvature.scale import Choice, Ladder, Samples, chosen_at, sample, select, windows
from rinow.curvature.sheet import patch_sheet
from rinow.curvature.stencils import N_BLOCKS, empty_frames, stencil_surface
from rinow.kernels import balls, patches, quadrics, risks, stencils
from rinow.mesh import TriangleMesh

__all__ = ["QUALITIES", "sectional"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Progress = Callable[[int, int], object]

QUARTIC = 3
"""Index of the least radius whose ball holds enough vertices for order 4, which shows the bias of order 2."""
PASSES = 2
"""Averages of squared differences over the centres around."""
FLAT_DEFECT = 1e-10
"""Angle defects below this, in radians, are rounding: a neighbourhood of such vertices is isometric to the plane."""
FLAT_RINGS = 3
CALIBRATION = 1.25
"""The standard error over the root of the least risk: the noise is the least of many estimates, the fit the luckiest."""
VALUES_PER_TASK = 400_000
"""Values of patches at vertices that are kept at a time."""


class Quality(NamedTuple):
    """How densely patches lie.

    A patch covers `share` times the least radius near it, at least `least` spacings.  With `selects` each chooses its
    order and radius, else the samples near it do.  Patches are weighted by their risk to the power `-power`.
    """

    share: float
    least: float
    selects: bool
    power: float


QUALITIES = {"best": Quality(0.2, 0.9, True, 0.5), "fast": Quality(0.3, 1.2, False, 1.0)}


def sectional(
    mesh: TriangleMesh,
    *,
    quality: str = "best",
    radius: float | None = None,
    barriers: NDArray[np.bool_] | None = None,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> Estimate:
    r"""Curvature from polynomials fitted to the deviations from an osculating torus."""
    sheet, index = patch_sheet(mesh, barriers)
    ladder = Ladder.free(sheet) if radius is None else Ladder.of_radius(radius, sheet)
    samples = sample(sheet, ladder, QUALITIES[quality].selects)
    out, direction1, direction2, noise = _blended(sheet, ladder, QUALITIES[quality], samples)
    shrinkage = _shrinkage(samples, out)
    out[:, 0] *= shrinkage
    gaussian, mean, risk, reach = (_spread_out(out[:, i], index, mesh.n_vertices) for i in range(4))
    direction1, direction2 = (_spread_out(d, index, mesh.n_vertices) for d in (direction1, direction2))
    is_flat = _flat_vertices(mesh)
    gaussian[is_flat & np.isfinite(gaussian)] = 0.0
    noise, spacing = (_spread_out(x, index, mesh.n_vertices) for x in (np.sqrt(noise), sheet.spacing))
    spread, half = CALIBRATION * np.sqrt(risk), np.sqrt(np.maximum(mean * mean - gaussian, 0.0))
    estimate = Estimate(
        gaussian, spread, reach, mean, mean + half, mean - half, direction1, direction2, noise, spacing
    )
    if radius is None:
        _fill_in(mesh, estimate)
    if progress is not None:
        progress(mesh.n_vertices, mesh.n_vertices)
    return estimate


def _blended(
    sheet: balls.Sheet, ladder: Ladder, quality: Quality, samples: Samples
) -> tuple[Floats, Floats, Floats, Floats]:
    """K, H, risk, radius and order at the vertices of the sheet, principal directions, and variance of the noise."""
    low, high, top, noise = windows(samples)
    core = np.maximum(quality.least, quality.share * ladder.reaches[low] * ladder.factors)
    centres, sizes = cover(sheet, core)
    frames = flat_frames(sheet, centres)
    pilot = chosen_at(centres, samples, samples.plane_logs)
    tori = np.empty_like(frames)
    reaches = ladder.reaches[pilot.radius] * ladder.factors[centres]
    patches.pilot_frames(centres, frames, reaches, pilot.order, ladder.most, N_BLOCKS, sheet, tori)
    if quality.selects:
        pilot = chosen_at(centres, samples, samples.torus_logs)
        reaches = ladder.reaches[pilot.radius] * ladder.factors[centres]
        patches.pilot_frames(centres, tori.copy(), reaches, pilot.order, ladder.most, N_BLOCKS, sheet, tori)
    core, at_centres = core[centres], noise[centres]
    if quality.selects:
        window = _widened(low[centres], high[centres], top[centres], len(ladder.reaches))
        links = members_of_discs(sheet, centres, centres, 2.2 * core)
        choice = select(sheet, ladder, centres, tori, (*window, at_centres), links, PASSES)
    else:
        choice = chosen_at(centres, samples, samples.torus_logs)
    totals = np.zeros((len(sheet.vertices), patches.N_VALUES))
    _add_patches(sheet, ladder, centres, tori, choice, CORE * core, at_centres, sizes, quality.power, totals)
    out, direction1, direction2 = np.empty((len(totals), 5)), np.empty((len(totals), 3)), np.empty((len(totals), 3))
    patches.mean_values(totals, sheet.normals, out, direction1, direction2)
    return out, direction1, direction2, noise


def _widened(low: Ints, high: Ints, top: Ints, n_radii: int) -> tuple[Ints, Ints, Ints]:
    """The windows with a radius more at each end, wide enough for a quartic, and the highest order with two more, even."""
    return (
        np.maximum(low - 1, 0).astype(np.int32),
        np.clip(high + 1, min(QUARTIC, n_radii - 1), n_radii - 1).astype(np.int32),
        np.minimum((top + 3) // 2 * 2, 8).astype(np.int32),
    )


def _add_patches(
    sheet: balls.Sheet, ladder: Ladder, centres: Ints, frames: Floats, choice: Choice, cores: Floats, noise: Floats,
    sizes: Ints, power: float, totals: Floats,
) -> None:  # fmt: skip
    """Add the weighted values of all patches to the totals of their vertices, a task at a time."""
    starts = np.zeros(len(centres) + 1, np.int64)
    np.cumsum(sizes, out=starts[1:])
    reaches = ladder.reaches[choice.radius] * ladder.factors[centres]
    first = 0
    while first < len(centres):
        last = max(int(np.searchsorted(starts, starts[first] + VALUES_PER_TASK, "right")) - 1, first + 1)
        part, own = slice(first, last), starts[first : last + 1] - starts[first]
        vertices, values = np.empty(own[-1], np.int32), np.empty((own[-1], patches.N_VALUES))
        patches.patch_values(
            centres[part], frames[part], reaches[part], choice.order[part], cores[part], noise[part],
            choice.risk[part], power, own, ladder.most, N_BLOCKS, sheet, vertices, values,
        )  # fmt: skip
        patches.add_values(vertices, values, totals)
        first = last


def _shrinkage(samples: Samples, out: Floats) -> Floats:
    """Positive-part shrinkage of K towards 0, from its mean square and mean risk around the samples."""
    factors, shrinkage = np.empty(len(samples.noise)), np.empty(len(out))
    risks.disc_shrinkage(samples.member_starts, samples.members, out[:, 0], out[:, 2], factors)
    risks.vertex_means(samples.starts, samples.near, factors, shrinkage)
    return shrinkage


def _flat_vertices(mesh: TriangleMesh) -> NDArray[np.bool_]:
    """(n_vertices,): every interior vertex within three rings has the angle 2π."""
    t = mesh.topology
    curved = (np.abs(mesh.vertex_angle_defects) > FLAT_DEFECT) & ~t.vertex_is_boundary
    if curved.mean() > 0.99:
        return ~curved & False
    count = curved.astype(np.float64)
    for _ in range(FLAT_RINGS):
        sums = np.empty_like(count)
        stencils.ring_sums(np.minimum(count, 1.0), t.neighbour_offsets, t.neighbours, sums)
        count = sums
    return count == 0.0


def _spread_out(values: Floats, index: NDArray[np.intp], n: int) -> Floats:
    """Values of the sheet in the order of the mesh, nan elsewhere."""
    out = np.full((n, *values.shape[1:]), np.nan)
    out[index] = values
    return out


def _fill_in(mesh: TriangleMesh, estimate: Estimate) -> None:
    """Take two rings and a quadric, or Euler's formula alone, where no patch has a fit."""
    assert estimate.mean is not None
    rows = np.flatnonzero(~np.isfinite(estimate.gaussian) & mesh.topology.vertex_is_used)
    if not len(rows):
        return
    frames = empty_frames(len(rows))
    quadrics.ring_quadrics(rows, stencil_surface(mesh), N_BLOCKS, frames)
    values = (frames.k1 * frames.k2, 0.5 * (frames.k1 + frames.k2), frames.k1, frames.k2)
    for name, value in zip(("gaussian", "mean", "k1", "k2"), values, strict=True):
        getattr(estimate, name)[rows] = value
    estimate.direction1[rows], estimate.direction2[rows] = frames.direction1, frames.direction2
