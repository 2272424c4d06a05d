"""Curvature from patches fitted over osculating tori, with the order and the scale that the data call for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow._executor import Executor, SerialExecutor
from rinow.curvature.centres import CORE, cover, flat_frames, sizes_of_discs
from rinow.curvature.charts import DOUBTFUL, Choice, either, leads
from rinow.curvature.ends import repair_ends
from rinow.curvature.estimate import Estimate
from rinow.curvature.flat import flat_vertices, flatten
from rinow.curvature.levels import levels_of
from rinow.curvature.patch_tasks import Tasks, add_patches
from rinow.curvature.scale import Ladder, Samples, chosen_at, curvedness_of, sample, scales, windows
from rinow.curvature.searches import Centres, Found, blended, search_both
from rinow.curvature.second_look import Values, look_again
from rinow.curvature.sheet import patch_sheet
from rinow.curvature.stencils import rings_around
from rinow.curvature.strays import spikes, stray_vertices
from rinow.kernels import balls, patch_driver, patch_order, patches, risks
from rinow.mesh import TriangleMesh

__all__ = [
    "EDGE_RINGS",
    "QUALITIES",
    "blended_patches",
    "sectional",
    "shrinkage",
    "standard_errors",
]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Progress = Callable[[int, int], object]

QUARTIC = 3
"""Index of the least radius whose ball holds enough vertices for order 4, which shows the bias of order 2."""
EDGE_POWER = 1.5
"""`Quality.power` beside a boundary, where few patches cover a vertex and their errors differ much, and between patches
over two charts at one place."""
EDGE_CALIBRATION = 1.42
"""`Quality.calibration` at a boundary, where patches of any quality choose their order and radius by themselves."""
APART = 3.0
"""Squared error over the variance between the patches of a vertex: they share most of their points, so that they err
together more than they differ."""
EDGE_RINGS, EDGE_RADII, EDGE_ORDER = 2, 4, 2
"""Vertices this near a boundary look at so many more radii: one-sided balls hold half the vertices, worse placed.
Orders above the last one bend too freely there for a first frame."""


class Quality(NamedTuple):
    """How densely patches lie.

    A patch covers `share` times the least radius near it, at least `least` spacings.  With `selects` each chooses its
    order and radius, else the samples near it do, except beside a boundary, where those of the interior are too bold.
    Patches are weighted by their risk to the power `-power`.  The standard error counts the least risk `calibration`
    times: the noise is the least of many estimates, the fit the one that looks best, and where samples choose, its bias
    is that of other places.
    """

    share: float
    least: float
    selects: bool
    power: float
    calibration: float


QUALITIES = {"best": Quality(0.2, 0.9, True, 0.5, 1.05), "fast": Quality(0.3, 1.2, False, 1.0, 1.2)}


def sectional(
    mesh: TriangleMesh,
    *,
    quality: str = "best",
    radius: float | None = None,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> Estimate:
    r"""Curvature of a surface from its deviations from the torus that osculates it, in patches.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    quality : {"best", "fast"}, optional
        How densely patches lie, and whether each chooses its own order and radius or takes those of a sample near it.
    radius : float, optional
        Radius of all balls, in the unit of length; by default the data decide.
    progress : callable, optional
        Called with the number of vertices done and their total.
    executor : Executor, optional
        Where the tasks of up to 65,536 patches run.

    Returns
    -------
    estimate : Estimate
        Everything, at a boundary one-sided.  Without a fit in reach the two rings are fitted by a quadric; with a
        given `radius` the value is nan there.

    Notes
    -----
    Haantjes and Menger see a curve by the deviation of chords from arcs.  Here the arcs are those of a torus with the
    normal curvatures k1, k2 of a first fit: (u, v) are arc lengths on it and w is the distance from it.  Where the
    surface does not keep its curvatures over a ball, the mean plane of a wider ball takes the place of the torus, if
    by the residuals of both and the errors expected it promises less error; where both promise about the same, and at
    boundaries, fits over both are averaged.  The polynomial :math:`w = f(u, v)` of least squares over a ball gives

    .. math:: K = \frac{L N - M^2}{\det g}, \quad H = \frac{g_{22} L - 2 g_{12} M + g_{11} N}{2 \det g}

    at all points of a patch around the centre.  All orders 2 to 8 come from one Cholesky factorisation of each ball,
    whose leading blocks are the lower orders.  Of each order d and radius the expected squared error is the variance,
    from the residuals, plus the squared bias, the mean over the patches around of
    :math:`(K_d - K_{d+2})^2` (of :math:`(K_d - K_{d+1})^2` where a boundary leaves one side of the ball) less the
    variance of this difference, and to both those of H are added, times the squared curvedness: both curvatures come
    from one fit.  The least sum is taken, patches are blended, and K is shrunk towards 0 as far as its mean square does
    not exceed its mean error (James and Stein).  Where all angles within three rings sum to 2π the surface is isometric
    to the plane and K is 0.

    See Also
    --------
    auto : Together with `intrinsic`.
    """
    is_stray, on_edge, ends = stray_vertices(mesh)
    sheet, index = patch_sheet(mesh, is_stray)
    alone, beside = (index[v] for v in spikes(sheet))
    if len(alone):
        is_stray[alone] = True
        sheet, index = patch_sheet(mesh, is_stray)
    n = mesh.n_vertices
    tasks = Tasks(executor or SerialExecutor())
    if progress is not None:
        tasks.report = lambda share: progress(int(min(share, 0.99) * n), n)
    levels = levels_of(mesh)
    rounding = 0.0 if levels is None else levels.variances(sheet.normals)
    ladder = Ladder.free(sheet, rounding) if radius is None else Ladder.of_radius(radius, sheet, rounding)
    at_edge = rings_around(mesh.topology, mesh.topology.vertex_is_boundary, EDGE_RINGS)[index]
    samples = sample(sheet, ladder, QUALITIES[quality].selects, tasks, _sizes_of_components(mesh)[index])
    values, noise = blended_patches(sheet, ladder, QUALITIES[quality], samples, at_edge, tasks)
    out, direction1, direction2, first, _, steps = values
    out[:, 0] *= shrinkage(samples, values)
    columns = *out[:, :5].T, standard_errors(out, QUALITIES[quality], mesh.topology.vertex_is_boundary[index])
    gaussian, mean, risk, reach, height, spread = (_spread_out(column[:, None], index, n) for column in columns)
    direction1, direction2 = (_spread_out(d, index, n) for d in (direction1, direction2))
    noise, spacing, first = (_spread_out(x[:, None], index, n) for x in (np.sqrt(noise), sheet.spacing, first))
    half = np.sqrt(np.maximum(mean * mean - gaussian, 0.0))
    principal = mean + half, mean - half, direction1, direction2
    estimate = Estimate(gaussian, spread, reach, mean, *principal, noise, spacing, risk, height, first)
    estimate.put(on_edge, ends)
    estimate.put(alone, beside)
    left_out, has_steps = np.zeros((2, mesh.n_vertices), np.bool_)
    left_out[on_edge] = left_out[alone] = has_steps[index[steps]] = True
    estimate = replace(estimate, left_out=left_out, has_steps=has_steps)
    repair_ends(mesh, estimate, radius is None)
    flatten(estimate, flat_vertices(mesh))
    if progress is not None:
        progress(mesh.n_vertices, mesh.n_vertices)
    return estimate


def blended_patches(
    sheet: balls.Sheet, ladder: Ladder, quality: Quality, samples: Samples, at_edge: NDArray[np.bool_], tasks: Tasks
) -> tuple[Values, Floats]:
    """What patches tell at the vertices of the sheet, and the variance of the noise."""
    between = scales(samples, sheet, at_edge)
    low, high, top, noise = windows(samples, between)
    noise = in_half_octaves(noise, sheet.spacing**2)
    core = np.maximum(quality.least, quality.share * ladder.reaches[low] * ladder.factors)
    centres = cover(sheet, samples.turns, core)
    core, at_centres, beside = core[centres], noise[centres], at_edge[centres]
    logs = samples.plane_logs, samples.torus_logs, samples.level_logs
    pilot, torus, plane = (_safe(chosen_at(centres, samples, between, x), beside, ladder) for x in logs)
    ratios = np.empty(len(noise))
    risks.vertex_means(samples.starts, samples.near, samples.level_ratios, ratios)
    frames = ladder.frames(sheet, centres, flat_frames(sheet, centres), pilot, tasks, np.zeros_like(beside))
    lead = leads(torus, plane, ratios[centres], ladder.turns(sheet, centres, frames, plane))
    is_level, is_open = lead > 0.0, beside & ~np.isneginf(lead) | (quality.selects & (np.abs(lead) < DOUBTFUL))
    choice, also, curvedness = either(is_level, torus, plane), np.flatnonzero(is_open), curvedness_of(frames)
    there = Found(frames[also], either(~is_level, torus, plane).at(also), np.ones(len(also)))
    frames[is_level, 9:], there.frames[~is_level[also], 9:] = 0.0, 0.0
    if not quality.selects:
        rows = np.flatnonzero(is_level & ~beside)
        is_plane = np.ones(len(rows), np.bool_)
        frames[rows] = ladder.frames(sheet, centres[rows], frames[rows], choice.at(rows), tasks, is_plane)
    high = high[centres] + np.where(beside, EDGE_RADII, 0)
    window = _widened(low[centres], high, top[centres], len(ladder.reaches))
    known = Centres(centres, core, *window, at_centres, curvedness)
    here = Found(frames, choice, np.ones(len(centres)))
    del between, low, top, logs, pilot, torus, plane  # the searches need the memory
    search_both(sheet, ladder, known, (here, there), also, beside, quality.selects, tasks)
    found, rows = blended(here, there, also)
    del frames, choice, here, there
    values = _means_of_patches(sheet, ladder, quality, found, (centres[rows], core[rows], at_centres[rows]), tasks)
    del found
    density = quality.share, quality.least, quality.power
    look_again(sheet, ladder, values, samples.turns, noise, at_edge, density, tasks)
    return values, noise


def _means_of_patches(
    sheet: balls.Sheet, ladder: Ladder, quality: Quality, found: Found, place: tuple[Ints, Floats, Floats], tasks: Tasks
) -> Values:
    """The weighted means of what patches tell: fits about centres, of which radius and noise are known as well."""
    (frames, choice, least), (centres, core, noise) = found, place
    rows, radius = np.zeros(len(centres) + 1, np.int64), np.maximum(choice.radius, 0)
    np.cumsum(sizes_of_discs(sheet, centres, CORE * core), out=rows[1:])
    totals = np.zeros((len(sheet.vertices), patches.N_VALUES + 1))
    fitting = ladder.fitting(patch_driver.VALUES, sheet, centres, frames, radius, radius, choice.order, rows, noise)
    expected = in_half_octaves(choice.risk, sheet.spacing[centres] ** -4)
    weights = expected**-quality.power * in_half_octaves(least, np.ones(1)) ** (EDGE_POWER - quality.power)
    add_patches(fitting, CORE * core, expected, weights, totals, tasks, 0.2)
    return Values.of(totals, sheet.normals)


def in_half_octaves(variances: Floats, unit: Floats) -> Floats:
    """The nearest powers of √2 times the unit: as well as they are known; what is far away does not change them."""
    with np.errstate(divide="ignore"):
        return np.exp2(0.5 * np.round(2.0 * np.log2(variances / unit))) * unit


def standard_errors(out: Floats, quality: Quality, at_boundary: NDArray[np.bool_]) -> Floats:
    """Standard errors of K (n,) by the risks of patches and by what they differ, in columns 2 and 5 of their means."""
    calibration = np.where(at_boundary, EDGE_CALIBRATION, quality.calibration)
    return np.sqrt(calibration**2 * out[:, 2] + APART * out[:, 5])


def _safe(choice: Choice, beside: NDArray[np.bool_], ladder: Ladder) -> Choice:
    """The choice, with larger balls and lower orders beside a boundary, where samples of the interior were too bold."""
    radius = np.where(beside, np.minimum(choice.radius + EDGE_RADII, len(ladder.reaches) - 1), choice.radius)
    order = np.where(beside, np.minimum(choice.order, EDGE_ORDER), choice.order)
    return choice._replace(radius=radius.astype(np.int32), order=order.astype(np.int32))


def _widened(low: Ints, high: Ints, top: Ints, n_radii: int) -> tuple[Ints, Ints, Ints]:
    """The windows with a radius more at each end and large enough for a quartic, and an even order two higher."""
    return (
        np.maximum(low - 1, 0).astype(np.int32),
        np.clip(high + 1, min(QUARTIC, n_radii - 1), n_radii - 1).astype(np.int32),
        np.minimum((top + 3) // 2 * 2, 8).astype(np.int32),
    )


def shrinkage(samples: Samples, values: Values) -> Floats:
    """Positive-part shrinkage of K towards 0, from its mean square and mean risk around the samples.

    A guess of what nothing shows is no reason to draw K anywhere, nor is a plane around a bump that was missed first.
    """
    out, factors, shrinkage = values.columns, np.empty(len(samples.noise)), np.empty(len(values.columns))
    risks.disc_shrinkage(samples.member_starts, samples.members, out[:, 0], out[:, 2], factors)
    factors[~samples.is_seen] = 1.0
    risks.vertex_means(samples.starts, samples.near, factors, shrinkage)
    shrinkage[values.again] = 1.0
    return shrinkage


def _sizes_of_components(mesh: TriangleMesh) -> NDArray[np.int32]:
    """(n_vertices,): how many vertices the component of each has."""
    component = mesh.topology.components
    return np.bincount(component + 1).astype(np.int32)[component + 1]


def _spread_out(rows: Floats, index: NDArray[np.intp], n: int) -> Floats:
    """Values of the sheet in the order of the n vertices of the mesh, nan elsewhere."""
    out = np.full((n, rows.shape[1]), np.nan)
    patch_order.spread_out(rows, index, out)
    return out if rows.shape[1] > 1 else out[:, 0]
