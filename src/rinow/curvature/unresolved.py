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
"""Averages over rings of neighbours: some hundred vertices decide together."""
LARGEST = 1.0
"""Residuals over the inverse of the spacing are cut at this: beyond it no mesh resolves a curvature."""


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
    r = np.where(known, np.clip(residual, -LARGEST, LARGEST), 0.0)
    others = _ring_means(mesh, r, 1, itself=False)
    covariance, variance = _ring_means(mesh, r * others, PASSES), _ring_means(mesh, r * r, PASSES)
    correlation = np.divide(covariance, variance, out=np.zeros_like(r), where=variance > 0.0)
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
