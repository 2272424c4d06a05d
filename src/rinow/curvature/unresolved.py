"""Detail that a mesh barely resolves, such as the folds of a cortex, told from noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.angle_defect import angle_defect, longest_edges, ring_deviations
from rinow.curvature.creases import EdgeTurnings
from rinow.curvature.estimate import Estimate
from rinow.curvature.stencils import N_BLOCKS, empty_frames, ring_means, stencil_surface
from rinow.curvature.terraces import beyond_terraces
from rinow.kernels import quadrics, ring_jets
from rinow.mesh import TriangleMesh

__all__ = ["EVERYWHERE", "single_rings", "with_detail"]

Floats = NDArray[np.float64]

OF_HEIGHTS = (0.05, 0.2)
"""Correlations of the heights of neighbours over the fits up to which these are noise, and from which detail."""
SMALL = 0.1
"""Heights, in spacings, that show no detail: their square is added to the variance."""
DEEP, DEPTH = 6.0, (0.8, 1.0)
"""Heights that are neither SMALL nor so many times the noise of the fits are noise below the first of these shares of
the lesser one, and may be detail above the second: small balls see at least a third of noise that neighbours share."""
OF_FITS, OF_CUBICS, OF_QUARTICS = (-0.05, 0.05), (-0.1, 0.1), (0.1, 0.3)
"""Correlations of neighbours up to which a difference is noise, and from which detail: of quadrics or quartics from
fits, of single rings from cubics, of quartics from cubics.  White noise has -0.14, -0.25 and -0.1."""
LEFT = (0.2, 0.1)
"""Correlations of single rings' differences from quartics from which on these have missed detail, down to noise."""
HALF = 0.5
"""Largest share of single rings: folds that a cubic flattens, these exaggerate as much."""
PASSES = 10
"""Averages over rings of neighbours: some hundred vertices decide together, if their component as a whole agrees."""
NEAR = 2
"""The same for the part that a vertex has in what some hundred say: none beside a crease that they see."""
EVERYWHERE = (PASSES, NEAR)
"""Averages of which the least counts where folds are no deeper than they are all around and close by."""
LARGEST = 3.0
"""Residuals are cut at this multiple of their median modulus, lest a few bad stars decide."""
STEPS = 8
"""What a whole mesh or component says is rounded to so many parts, or parts of an octave: a local change of the mesh
then leaves it as it is, unless it lies at a border."""


def with_detail(mesh: TriangleMesh, estimate: Estimate, passes: tuple[int, ...] = (PASSES,)) -> Estimate:
    """An estimate by fits, with the curvature of rings where fits over larger balls have smoothed detail away.

    Folds are as deep as the least of the averages over so many rings says: on a mesh, which is cut at its creases, some
    hundred vertices; of points `EVERYWHERE`, for the creases between their faces are in the mesh.

    Notes
    -----
    One rule decides everything.  The curvatures of rings are second differences of the positions.  Of independent noise
    their errors at neighbouring vertices are anticorrelated: one vertex moved outwards raises its own and lowers those
    around it.  So where the difference of two estimates is positively correlated between neighbours it is detail that
    one of them has missed.

    - Heights of the vertices over the first fits, before smaller balls took their place.  Independent noise leaves them
      uncorrelated on every triangulation, and what is small beside the spacing, and not large beside the noise, is
      noise too, correlated or not.
    - Steps of voxels are common to neighbours as well, but low (`terraces`).
    - Quartics of three rings against fits, the first and those in their place: with detail in between, rings are taken.
    - Single rings against cubics of three rings, which they are averaged with as far as those miss detail.
    - Quartics against cubics.  They come nearest to the truth, if there is detail in between, and if they in turn leave
      no detail to single rings; if they do, then waves are too short for any polynomial.
    """
    if estimate.mean is None or estimate.height is None or estimate.spacing is None or estimate.noise is None:
        return estimate
    spacing, first = estimate.spacing, estimate.mean if estimate.first_mean is None else estimate.first_mean
    height = np.clip(estimate.height / spacing, -1.0, 1.0)
    if not np.fmax.reduce(np.abs(height), initial=0.0) > SMALL * OF_HEIGHTS[0] ** 0.5:  # no correlation exceeds that
        return estimate
    share = _common_share(mesh, height, OF_HEIGHTS, SMALL)
    if not share.any():
        return estimate
    square = np.nan_to_num(height) ** 2
    depth = np.sqrt(np.minimum.reduce([ring_means(mesh, square, n) for n in passes]))
    least = np.fmin(SMALL, DEEP * estimate.noise / spacing)
    share = np.minimum(share, _share_of(DEPTH, depth, least))
    share[~np.isfinite(estimate.gaussian) | mesh.topology.vertex_is_boundary] = 0.0  # half a star shows too little
    rings, has_steps = (mesh.topology.neighbour_offsets, mesh.topology.neighbours), share > 0.0
    if has_steps.any() and not EdgeTurnings(mesh).are_steps:
        has_steps &= ~beyond_terraces(mesh.vertices, rings, spacing, has_steps, estimate.height)
    share[has_steps] = 0.0
    if not share.any():
        return estimate.with_steps(has_steps)
    star, jets = _two_rings(mesh), np.empty((mesh.n_vertices, 2, 2))
    ring_jets.ring_jets(stencil_surface(mesh), N_BLOCKS, jets)
    for mean in (first, estimate.mean):
        missed = _without_outliers(mesh, (jets[:, 1, 1] - mean) * spacing)
        share = np.minimum(share, _common_share(mesh, missed, OF_FITS))
    share[~np.isfinite(star.gaussian)] = 0.0
    if not share.any():
        return estimate.with_steps(has_steps)
    return _blend(estimate, _with_detail_of_rings(mesh, star, jets, spacing), share).with_steps(has_steps)


def _two_rings(mesh: TriangleMesh) -> Estimate:
    """The curvature of quadrics through two rings."""
    q = empty_frames(mesh.n_vertices)
    quadrics.ring_quadrics(np.arange(mesh.n_vertices), stencil_surface(mesh), False, N_BLOCKS, q)
    gaussian, mean, reach = q.k1 * q.k2, 0.5 * (q.k1 + q.k2), longest_edges(mesh)
    spread = ring_deviations(mesh, gaussian)
    return Estimate(gaussian, spread, reach, mean, q.k1, q.k2, q.direction1, q.direction2)


def _with_detail_of_rings(mesh: TriangleMesh, star: Estimate, jets: Floats, spacing: Floats) -> Estimate:
    """The stars with curvatures of cubics, moved towards single rings and quartics where those show detail."""
    single, cubic, quartic = single_rings(mesh), jets[:, 0], jets[:, 1]

    def share(step: Floats, correlations: tuple[float, float]) -> Floats:
        return _common_share(mesh, _without_outliers(mesh, step[:, 1] * spacing), correlations)

    values = cubic + _times(HALF * share(single - cubic, OF_CUBICS), single - cubic)
    of_quartic = np.minimum(share(quartic - cubic, OF_QUARTICS), share(single - quartic, LEFT))
    values += _times(of_quartic, quartic - values)
    values = np.where(np.isfinite(values), values, np.stack((star.gaussian, star.mean), axis=1))  # type: ignore[arg-type]
    gaussian, mean = np.ascontiguousarray(values.T)
    gaussian -= _excess(mesh, gaussian)
    spread, radius = ring_deviations(mesh, gaussian), ring_jets.N_RINGS * star.radius
    return replace(star, gaussian=gaussian, mean=mean, spread=spread, radius=radius)


def _excess(mesh: TriangleMesh, gaussian: Floats) -> Floats:
    """(n_vertices,): by what curvatures exceed angle defects over areas, in the mean of some hundred vertices.

    An error of a vertex bends the surface alike in all directions, so that its square is added to the product of
    the principal curvatures, whatever its sign.  The sum of the defects is right for any errors (Gauss and Bonnet).
    Each vertex has its part by the excess near it: flat faces have none of that of the creases between them.
    """
    areas, whole = mesh.vertex_areas, 2.0 * np.pi
    known = np.isfinite(gaussian) & mesh.topology.vertex_is_manifold & ~mesh.topology.vertex_is_boundary
    excess = np.where(known, np.clip(gaussian * areas, -whole, whole) - mesh.vertex_angle_defects, 0.0)
    area = np.where(known, areas, 0.0)
    size = _quotient(ring_means(mesh, np.abs(excess), NEAR), ring_means(mesh, area, NEAR))
    return size * _quotient(ring_means(mesh, excess, PASSES), ring_means(mesh, size * area, PASSES))


def _quotient(a: Floats, b: Floats) -> Floats:
    return np.divide(a, b, out=np.zeros_like(a), where=b > 0.0)


def single_rings(mesh: TriangleMesh) -> Floats:
    r"""(n_vertices, 2): Gaussian and mean curvature by Steiner's formula; nan where the star is not one closed fan.

    Notes
    -----
    The parallel surface of a convex polyhedron at distance ε has the area
    :math:`A + ε \sum_e l_e θ_e + ε^2 \sum_i δ_i`, for lengths l and turnings θ of its edges and angle defects δ; that
    of a smooth one is :math:`A + 2ε \int H + ε^2 \int K`.  Half of each edge belongs to each of its ends:
    :math:`K_i = δ_i / A_i` and :math:`H_i = \sum_{e \ni i} l_e θ_e / (4 A_i)`.  Without a consistent orientation there
    is no mean curvature.  No other estimate looks at less of the surface, so none smooths less of its detail.
    """
    t, edges = mesh.topology, mesh.topology.edges
    bends = EdgeTurnings(mesh).turnings * np.linalg.norm(np.subtract(*mesh.vertices[edges.T]), axis=1)
    total = 0.25 * np.bincount(edges.ravel(), np.repeat(bends, 2), mesh.n_vertices)
    mean, areas = np.full(mesh.n_vertices, np.nan), mesh.vertex_areas
    is_closed = t.vertex_is_manifold & ~t.vertex_is_boundary & (areas > 0.0)
    if t.is_orientable:
        np.divide(total, areas, out=mean, where=is_closed)
    return np.stack((np.where(is_closed, angle_defect(mesh).gaussian, np.nan), mean), axis=1)


def _common_share(
    mesh: TriangleMesh, residual: Floats, correlations: tuple[float, float], least: float = 0.0
) -> Floats:
    """(n_vertices,): 0 where neighbours have a residual in common as the first correlation says, 1 as the second.

    A residual much below `least` is in common to none.
    """
    r = np.where(np.isfinite(residual) & ~mesh.topology.vertex_is_boundary, residual, 0.0)
    product, square = r * ring_means(mesh, r, 1, itself=False), r * r + least * least
    component = mesh.topology.components + 1
    whole = _share_of(correlations, *(np.bincount(component, x).astype(np.float64) for x in (product, square)))
    whole = np.round(STEPS * whole) / STEPS
    if not whole.any():
        return np.zeros(mesh.n_vertices)
    near = _share_of(correlations, ring_means(mesh, product, PASSES), ring_means(mesh, square, PASSES))
    return np.minimum(near, whole[component])


def _without_outliers(mesh: TriangleMesh, residual: Floats) -> Floats:
    known = np.isfinite(residual) & ~mesh.topology.vertex_is_boundary
    middle = float(np.median(np.abs(residual[known]))) if known.any() else 0.0
    largest = LARGEST * 2.0 ** (np.round(STEPS * np.log2(middle)) / STEPS) if middle > 0.0 else 0.0
    return np.clip(residual, -largest, largest)


def _share_of(correlations: tuple[float, float], covariance: Floats, variance: Floats) -> Floats:
    none, full = correlations
    correlation = np.divide(covariance, variance, out=np.full_like(variance, none), where=variance > 0.0)
    return np.clip((correlation - none) / (full - none), 0.0, 1.0)


def _times(share: Floats, step: Floats) -> Floats:
    """Steps (n_vertices, 2) by their shares; none where the step is unknown."""
    return np.where(np.isfinite(step), share[:, None] * step, 0.0)


def _blend(fit: Estimate, star: Estimate, share: Floats) -> Estimate:
    """Both by their shares, which are taken for probabilities, and the directions and scale of the larger one."""
    mix = {name: getattr(fit, name) + _step(fit, star, name, share) for name in ("gaussian", "mean")}
    half = np.sqrt(np.maximum(mix["mean"] ** 2 - mix["gaussian"], 0.0))
    mix |= {"k1": mix["mean"] + half, "k2": mix["mean"] - half}
    variance = share * star.spread**2 + (1.0 - share) * (fit.spread**2 + share * (star.gaussian - fit.gaussian) ** 2)
    mix["spread"] = np.where(share > 0.0, np.sqrt(variance), fit.spread)
    if fit.risk is not None:
        mix["risk"] = np.where(share > 0.0, variance, fit.risk)
    mostly = share > 0.5
    for name in ("radius", "direction1", "direction2"):
        ours, theirs = getattr(fit, name), getattr(star, name)
        mix[name] = np.where(mostly if ours.ndim == 1 else mostly[:, None], theirs, ours)
    return replace(fit, **mix)


def _step(fit: Estimate, star: Estimate, name: str, share: Floats) -> Floats:
    return np.where(share > 0.0, share * (getattr(star, name) - getattr(fit, name)), 0.0)
