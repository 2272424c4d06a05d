"""Errors of averaged angle defects that no comparison of scales shows: what they leave, roughness, and boundaries."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra
from scipy.special import ndtr

from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.length_noise import LengthNoise
from rinow.curvature.waves import Waves, window
from rinow.geodesics.edge_graph import edge_graph

__all__ = ["unseen_error"]

Floats = NDArray[np.float64]

PART = 8.0
"""What is left is averaged over so many times fewer steps than the estimate: enough for the noise to fall well below
the error looked for, and too few to average that away."""
PASSES = 10
"""Repetitions of the mean over a ring that average its squares."""
EVIDENCE = 2.0
"""Squares count beyond so many times the noise expected: that of positions is not quite one of lengths."""
BESIDE = 2.0
"""That average is over fewer steps nearer to a boundary than so many standard deviations of it, and none is taken where
one step is too many: defects end there, and with them the cancellation of noise between neighbours."""
ROUGH = 1.7
"""Share by which noise of the positions makes areas larger, over that of the lengths in it.  Noise σ of the positions
adds 2(σ/h)² to the area of equilateral triangles of side h, up to twice that to stretched ones, and defects as if by
errors of lengths of at least 1.7(σ/h)² h, the part that flat surfaces have too."""
LONGEST = 7
"""Binary logarithm of the most steps."""


def unseen_error(
    flow: CurvatureFlow, noise: LengthNoise, start: Floats, level: Floats, gaussian: Floats, bias: Floats, scale: Floats
) -> Floats:
    r"""Squared error of averaged defects beyond the variance and the squared bias of the scale chosen.

    Parameters
    ----------
    flow : CurvatureFlow
        The mesh.
    noise : LengthNoise
        What noise of its lengths does.
    start, level : (n_vertices,) ndarray of float
        Curvatures before any average, and the variance of the lengths.
    gaussian, bias, scale : (n_vertices,) ndarray of float
        The estimate, its squared bias by the comparison of scales, and its variance along an axis, in length².

    Returns
    -------
    squared_error : (n_vertices,) ndarray of float
        The sum of three; nan where `gaussian` is.

    Notes
    -----
    - *What is left.*  The least of many predicted errors is one whose bias has been taken for too small.  Averaged
      over an eighth of the steps, or less near a boundary, the curvatures less the estimate show a bias that scales
      agree on, as far as their square exceeds the noise.
    - *Roughness.*  By Gauss and Bonnet noise keeps the integral of K, but it makes the area larger, and K smaller.
    - *Boundary.*  No defect is known there, and averages of variance s² at the distance x from it are those of a point
      further inside, by :math:`2s(\varphi(x/s) - (x/s)\Phi(-x/s))` with the normal density φ and distribution Φ, at
      the boundary by a spacing more.  This distance times the gradient, the standard deviation of the estimate in a
      neighbourhood of that size over its radius, is the error of an extrapolation by a constant.
    """
    steps = np.divide(scale, noise.step, out=np.zeros_like(scale), where=noise.step > 0.0)
    distance = _boundary_distances(flow, scale)
    left = _left_over(flow, noise, np.where(flow.has_data, start - gaussian, 0.0), level, steps, distance)
    rough = ROUGH * gaussian * np.sqrt(level) / flow.spacing
    return np.fmax(left - bias, 0.0) + rough**2 + _drift(flow, noise, gaussian, steps, scale, distance) ** 2


def _rungs(steps: Floats, highest: int) -> NDArray[np.intp]:
    """The nearest binary logarithms, from 0 to `highest`; 0 for nan or 0."""
    with np.errstate(all="ignore"):
        return np.clip(np.nan_to_num(np.round(np.log2(steps))), 0, highest).astype(np.intp)


def _boundary_distances(flow: CurvatureFlow, scale: Floats) -> Floats:
    """(n_vertices,): distance from the boundary along edges, inf far from it."""
    ends = np.flatnonzero(flow.mesh.topology.vertex_is_boundary)
    if not len(ends):
        return np.full(len(scale), np.inf)
    reach = 4.0 * np.sqrt(np.fmax.reduce(scale, initial=0.0))
    return np.asarray(dijkstra(edge_graph(flow.mesh), indices=ends, min_only=True, limit=reach))


def _left_over(
    flow: CurvatureFlow, noise: LengthNoise, residual: Floats, level: Floats, steps: Floats, distance: Floats
) -> Floats:
    """(n_vertices,): mean square of what the estimate leaves, averaged over a part of its steps, less the noise."""
    with np.errstate(all="ignore"):
        most = (distance / BESIDE) ** 2 / noise.step
        rungs = np.minimum(_rungs(steps / PART, LONGEST - 3), np.floor(np.log2(np.clip(most, 1.0, 2.0**LONGEST))))
    rungs, left = np.where(np.isfinite(rungs), rungs, 0).astype(np.intp), np.zeros(len(residual))
    windows = [window(2**rung, 1) for rung in range(int(rungs.max(initial=0)) + 1)]
    for rung, mean in enumerate(Waves(flow, np.nan_to_num(residual)).sums(windows)):
        with np.errstate(invalid="ignore"):
            columns = np.column_stack([mean**2, level * noise.variance(windows[rung])])
        columns[~(distance > BESIDE * np.sqrt(2**rung * noise.step))] = np.nan
        square, expected = flow.means(columns, PASSES).T
        here = (rungs == rung) & np.isfinite(square)
        left[here] = (square - EVIDENCE * expected)[here]
    return left


def _drift(
    flow: CurvatureFlow, noise: LengthNoise, gaussian: Floats, steps: Floats, scale: Floats, distance: Floats
) -> Floats:
    """(n_vertices,): the distance that averages near a boundary are shifted by, times the gradient of the estimate."""
    near = np.isfinite(distance) & (steps > 0.0)
    if not near.any():
        return np.zeros(len(gaussian))
    s = np.sqrt(scale)
    with np.errstate(all="ignore"):
        x = distance / s
        shift = 2.0 * s * (np.exp(-0.5 * x * x) / np.sqrt(2.0 * np.pi) - x * ndtr(-x))
    shift[flow.mesh.topology.vertex_is_boundary] += flow.spacing[flow.mesh.topology.vertex_is_boundary]
    rungs, gradients = _rungs(steps, LONGEST), np.zeros(len(gaussian))
    columns, done = np.column_stack([gaussian, gaussian**2]), 0
    for rung in range(int(rungs[near].max()) + 1):
        columns, done = flow.means(columns, 2**rung - done), 2**rung
        variance = np.maximum(columns[:, 1] - columns[:, 0] ** 2, 0.0)
        here = near & (rungs == rung)
        gradients[here] = np.sqrt(variance[here] / (2**rung * noise.step[here]))
    return np.where(near, shift * gradients, 0.0)
