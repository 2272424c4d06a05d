"""The families of estimates together: each vertex takes its curvature from the ones with the least expected error."""

from __future__ import annotations

from typing import Any

import numpy as np

from rinow.curvature.estimate import Estimate, Floats
from rinow.curvature.intrinsic import intrinsic_curvature
from rinow.curvature.sectional import QUALITIES, sectional
from rinow.curvature.stencils import ring_means
from rinow.curvature.unresolved import with_detail
from rinow.kernels import curves, monge
from rinow.mesh import TriangleMesh

__all__ = ["auto"]

QUIET = 1e-3
"""Noise of the positions, in spacings, up to which edge lengths may tell more than positions."""
WORTH, PASSES = {"best": 0.2, "fast": 0.3}, 10
"""Share of the vertices around that must be able to gain before the edge lengths are examined, and the averages over
rings of neighbours by which it is told: some hundred vertices decide together."""
RESOLVED, FLAT = 3e-4, 1e-3
"""Expected error of K, in units of the larger squared curvature, but at least (FLAT/spacing)², below which edge lengths
have nothing to add."""
HALF = 0.5
"""Largest share of edge lengths at folds that only rings resolve: neither knows there how much it errs."""
LARGEST_BALL = 4
"""Steps of the largest ball of edge lengths that is examined: on quiet structured meshes small ones win."""


def auto(mesh: TriangleMesh, *, quality: str = "best", **options: Any) -> Estimate:
    r"""Curvature from positions and edge lengths, blended at each vertex by the expected errors.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    quality : {"best", "fast"}, optional
        With "fast" fewer radii compete, and edge lengths only where many of the vertices around may gain.
    **options
        As for `sectional`.

    Returns
    -------
    estimate : Estimate
        That of `sectional`, its Gaussian curvature averaged with that of `intrinsic`.

    Notes
    -----
    The fits of `sectional` resolve a surface when a ball of few spacings is enough for their order; on meshes stretched
    in one direction the long edges make balls large.  Structured meshes of that kind have accurate angle defects
    nevertheless.  The expected squared error of the latter is that of `intrinsic` plus
    :math:`(K \max_e (\kappa_e c_e)^2/12)^2` for the chords c of normal curvature κ that stand for geodesics, which edge
    lengths alone cannot show.  The weights are the inverse squared errors, as far as defects have no noise of chords
    that had to be taken out of them: without structure errors of neighbouring defects do not cancel.

    Edge lengths are examined only where this last term leaves room for a gain at a fifth of the vertices around (with
    "fast", a third), where fits are not accurate to the fourth digit anyway, and where the positions have next to no
    noise; with noise the fits, which average over more data, win in any case.

    Where fits call detail noise that rings of neighbouring vertices have in common, estimates from one to three rings
    are taken (`rinow.curvature.unresolved`), and edge lengths count for at most as much as these.  The spread of an
    average holds the difference of its parts, as if one of them were right and its share the probability of that.
    """
    estimate = sectional(mesh, quality=quality, **options)
    if options.get("radius") is not None:
        return estimate
    detailed = with_detail(mesh, estimate)
    most = np.where(detailed.gaussian == estimate.gaussian, 1.0, HALF)
    return _with_edge_lengths(mesh, detailed, most, quality)


def _with_edge_lengths(mesh: TriangleMesh, estimate: Estimate, most: Floats, quality: str) -> Estimate:
    """The estimate, its K averaged with that of edge lengths, by at most a share, where these may gain."""
    k1, k2, noise, spacing, risk = estimate.k1, estimate.k2, estimate.noise, estimate.spacing, estimate.risk
    if k1 is None or k2 is None or noise is None or spacing is None or risk is None:
        return estimate
    chords = estimate.gaussian**2 * np.square(_chord_errors(mesh, estimate))
    largest = np.fmax(np.fmax(np.abs(k1), np.abs(k2)), FLAT / spacing)
    hopeful = (risk > np.fmax(chords, (RESOLVED * largest**2) ** 2)) & (noise < QUIET * spacing)
    hopeful &= ~mesh.topology.vertex_is_boundary
    if not hopeful.any():
        return estimate
    hopeful &= ring_means(mesh, hopeful.astype(np.float64), PASSES) > WORTH[quality]
    if not hopeful.any():
        return estimate
    with np.errstate(divide="ignore", invalid="ignore"):
        found = intrinsic_curvature(mesh, most_steps=LARGEST_BALL)
    other = found.variance + found.squared_bias + chords
    hopeful &= np.isfinite(other) & np.isfinite(found.gaussian)
    difference = np.where(hopeful, found.gaussian - estimate.gaussian, 0.0)
    share = np.divide(risk, risk + other, out=np.zeros_like(risk), where=hopeful & (risk > 0.0))
    share = np.minimum(share * (1.0 - np.nan_to_num(found.on_arcs)), most)
    spread = np.where(share > 0.5, QUALITIES[quality].calibration * np.sqrt(other), estimate.spread)
    spread = np.hypot(spread, np.sqrt(share * (1.0 - share)) * difference)
    return estimate.with_gaussian(estimate.gaussian + share * difference, spread)


def _chord_errors(mesh: TriangleMesh, estimate: Estimate) -> Floats:
    """(n_vertices,): relative error of K that the chords of the edges make, by the normal curvatures along them."""
    t, errors = mesh.topology, np.empty(mesh.n_vertices)
    principal: list[Any] = [estimate.k1, estimate.k2, estimate.direction1, estimate.direction2, errors[:0, None]]
    frames = monge.PrincipalFrames(*principal)
    curves.chord_errors(mesh.vertices, t.neighbour_offsets, t.neighbours, frames, errors)
    return errors
