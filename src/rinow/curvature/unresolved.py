"""Detail that a mesh barely resolves, such as the folds of a cortex, told from noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.estimate import Estimate
from rinow.curvature.lifted import lifted
from rinow.kernels import stencils
from rinow.mesh import TriangleMesh

__all__ = ["with_detail"]

Floats = NDArray[np.float64]

NOISY = 0.005
"""Noise of the positions, over the spacing, below which fits have resolved everything."""
WHITE, DETAIL = 0.05, 0.3
"""Correlation of neighbours up to which a residual is noise, and from which it is detail."""
PASSES = 10
"""Averages over rings of neighbours: some hundred vertices decide together, if their component as a whole agrees."""
LARGEST = 3.0
"""Residuals are cut at this multiple of their median modulus, lest a few bad stars decide."""
STEPS = 8
"""What a whole mesh or component says is rounded to so many parts, or parts of an octave: a local change of the mesh
then leaves it as it is, unless it lies at a border."""


def with_detail(mesh: TriangleMesh, estimate: Estimate) -> Estimate:
    """An estimate by fits, with the curvature of stars where fits over larger balls have smoothed detail away.

    Notes
    -----
    The mean curvature of a star is a second difference of the positions.  Of independent noise the errors of such
    differences at neighbouring vertices are anticorrelated: one vertex moved outwards raises its own and lowers those
    around it.  So where the difference between the star and the fit is positively correlated between neighbours, and
    the fits call it noise, it is detail that the fits have missed, and the star is nearer to the truth.
    """
    if estimate.mean is None or estimate.noise is None or estimate.spacing is None:
        return estimate
    if not (estimate.noise > NOISY * estimate.spacing).any():
        return estimate
    star = lifted(mesh)
    share = _detail_share(mesh, (star.mean - estimate.mean) * estimate.spacing)  # type: ignore[operator]
    with np.errstate(invalid="ignore"):
        share[~(estimate.noise > NOISY * estimate.spacing)] = 0.0
    share[~(np.isfinite(star.gaussian) & np.isfinite(estimate.gaussian))] = 0.0
    if not share.any():
        return estimate
    return _blend(estimate, star, share)


def _detail_share(mesh: TriangleMesh, residual: Floats) -> Floats:
    """(n_vertices,): 0 where the residual is like noise, 1 where neighbours have it in common."""
    known = np.isfinite(residual) & ~mesh.topology.vertex_is_boundary
    middle = float(np.median(np.abs(residual[known]))) if known.any() else 0.0
    largest = LARGEST * 2.0 ** (np.round(STEPS * np.log2(middle)) / STEPS) if middle > 0.0 else 0.0
    r = np.where(known, np.clip(residual, -largest, largest), 0.0)
    product, square = r * _ring_means(mesh, r, 1, itself=False), r * r
    near = _share_of(_ring_means(mesh, product, PASSES), _ring_means(mesh, square, PASSES))
    component = mesh.topology.components + 1
    whole = _share_of(*(np.bincount(component, x).astype(np.float64) for x in (product, square)))
    return np.minimum(near, np.round(STEPS * whole[component]) / STEPS)


def _share_of(covariance: Floats, variance: Floats) -> Floats:
    correlation = np.divide(covariance, variance, out=np.zeros_like(variance), where=variance > 0.0)
    return np.clip((correlation - WHITE) / (DETAIL - WHITE), 0.0, 1.0)


def _ring_means(mesh: TriangleMesh, values: Floats, passes: int, *, itself: bool = True) -> Floats:
    """Means over each vertex and its neighbours, or the neighbours alone, taken `passes` times."""
    t = mesh.topology
    count = np.maximum(np.diff(t.neighbour_offsets) + (1 if itself else 0), 1)
    for _ in range(passes):
        sums = np.empty_like(values)
        stencils.ring_sums(values, t.neighbour_offsets, t.neighbours, sums)
        values = (sums if itself else sums - values) / count
    return values


def _blend(fit: Estimate, star: Estimate, share: Floats) -> Estimate:
    """Both by their shares, and the directions, scale and spread of the larger one."""
    mix = {name: getattr(fit, name) + _step(fit, star, name, share) for name in ("gaussian", "mean")}
    half = np.sqrt(np.maximum(mix["mean"] ** 2 - mix["gaussian"], 0.0))
    mix |= {"k1": mix["mean"] + half, "k2": mix["mean"] - half}
    mostly = share > 0.5
    for name in ("spread", "radius", "direction1", "direction2"):
        ours, theirs = getattr(fit, name), getattr(star, name)
        mix[name] = np.where(mostly if ours.ndim == 1 else mostly[:, None], theirs, ours)
    return replace(fit, **mix)


def _step(fit: Estimate, star: Estimate, name: str, share: Floats) -> Floats:
    return np.where(share > 0.0, share * (getattr(star, name) - getattr(fit, name)), 0.0)
