"""Detail that a mesh barely resolves, such as the folds of a cortex, told from noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.angle_defect import longest_edges, ring_deviations
from rinow.curvature.estimate import Estimate
from rinow.curvature.steiner import steiner_curvatures
from rinow.curvature.stencils import N_BLOCKS, empty_frames, stencil_surface
from rinow.kernels import quadrics, stencils
from rinow.mesh import TriangleMesh

__all__ = ["with_detail"]

Floats = NDArray[np.float64]

NOISY = 0.005
"""Noise of the positions, over the spacing, below which fits have resolved everything."""
OF_FITS, OF_QUADRICS = (0.05, 0.3), (-0.1, 0.1)
"""Correlations of neighbours up to which what fits, or quadrics of two rings, leave is noise, and from which detail.
White noise has -0.14 and -0.28 (mean curvature) or -0.21 (Gaussian)."""
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
    The curvatures of a star are second differences of the positions.  Of independent noise the errors of such
    differences at neighbouring vertices are anticorrelated: one vertex moved outwards raises its own and lowers those
    around it.  So where the difference between the star and the fit is positively correlated between neighbours, and
    the fits call it noise, it is detail that the fits have missed, and the star is nearer to the truth.

    The stars are of two rings first, by a quadric through them.  By the same rule their curvatures move on to those of
    Steiner's formula, which looks at one ring only.
    """
    if estimate.mean is None or estimate.noise is None or estimate.spacing is None:
        return estimate
    with np.errstate(invalid="ignore"):
        is_noisy = estimate.noise > NOISY * estimate.spacing
    if not is_noisy.any():
        return estimate
    star = _two_rings(mesh)
    share = _detail_share(mesh, (star.mean - estimate.mean) * estimate.spacing, OF_FITS)  # type: ignore[operator]
    share[~(is_noisy & np.isfinite(star.gaussian) & np.isfinite(estimate.gaussian))] = 0.0
    share[mesh.topology.vertex_is_boundary] = 0.0  # half a star shows too little
    if not share.any():
        return estimate
    return _blend(estimate, _with_one_ring(mesh, star, estimate.spacing), share)


def _two_rings(mesh: TriangleMesh) -> Estimate:
    """The curvature of quadrics through two rings."""
    q = empty_frames(mesh.n_vertices)
    quadrics.ring_quadrics(np.arange(mesh.n_vertices), stencil_surface(mesh), False, N_BLOCKS, q)
    gaussian, mean, reach = q.k1 * q.k2, 0.5 * (q.k1 + q.k2), longest_edges(mesh)
    spread = ring_deviations(mesh, gaussian)
    return Estimate(gaussian, spread, reach, mean, q.k1, q.k2, q.direction1, q.direction2)


def _with_one_ring(mesh: TriangleMesh, star: Estimate, spacing: Floats) -> Estimate:
    """The stars of two rings, with the curvatures of one where it shows more detail than noise."""
    gaussian, mean = steiner_curvatures(mesh)
    values: dict[str, Floats] = {}
    for name, power, one_ring in (("gaussian", 2, gaussian), ("mean", 1, mean)):
        step = one_ring - getattr(star, name)
        share = _detail_share(mesh, step * spacing**power, OF_QUADRICS)
        values[name] = getattr(star, name) + np.where(np.isfinite(step), share * step, 0.0)
    return replace(star, spread=ring_deviations(mesh, values["gaussian"]), **values)


def _detail_share(mesh: TriangleMesh, residual: Floats, correlations: tuple[float, float]) -> Floats:
    """(n_vertices,): 0 where the residual is like noise, 1 where neighbours have it in common."""
    known = np.isfinite(residual) & ~mesh.topology.vertex_is_boundary
    middle = float(np.median(np.abs(residual[known]))) if known.any() else 0.0
    largest = LARGEST * 2.0 ** (np.round(STEPS * np.log2(middle)) / STEPS) if middle > 0.0 else 0.0
    r = np.where(known, np.clip(residual, -largest, largest), 0.0)
    product, square = r * _ring_means(mesh, r, 1, itself=False), r * r
    near = _share_of(correlations, _ring_means(mesh, product, PASSES), _ring_means(mesh, square, PASSES))
    component = mesh.topology.components + 1
    whole = _share_of(correlations, *(np.bincount(component, x).astype(np.float64) for x in (product, square)))
    return np.minimum(near, np.round(STEPS * whole[component]) / STEPS)


def _share_of(correlations: tuple[float, float], covariance: Floats, variance: Floats) -> Floats:
    of_noise, of_detail = correlations
    correlation = np.divide(covariance, variance, out=np.zeros_like(variance), where=variance > 0.0)
    return np.clip((correlation - of_noise) / (of_detail - of_noise), 0.0, 1.0)


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
