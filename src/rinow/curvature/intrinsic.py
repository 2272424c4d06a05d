"""Gaussian curvature from edge lengths alone, its scale and order chosen at every vertex."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.angle_defect import longest_edges
from rinow.curvature.arcs import without_chords
from rinow.curvature.averages import SUPPORT, Averages, Candidate
from rinow.curvature.disagreement import proven_bias
from rinow.curvature.estimate import Estimate
from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.length_noise import LengthNoise
from rinow.curvature.margins import Margins
from rinow.curvature.unseen import unseen_error
from rinow.curvature.waves import LADDER, Waves
from rinow.kernels import patch_order
from rinow.kernels.risks import CLEAR
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["IntrinsicCurvature", "intrinsic", "intrinsic_curvature"]

Floats = NDArray[np.float64]

SHRINK_PASSES = 12
"""Repetitions of the mean over a ring that average squared errors."""
CALIBRATION = 1.5
"""Spread over the root of the least predicted squared error: the candidate chosen is the one that looks best."""
FLAT_RINGS, FLAT_DEFECT = 3, 1e-10
"""A vertex with defects below this within so many rings is flat."""
IDLE = 2
"""Scales in a row without a smaller error at any vertex after which larger ones are left out."""
PROVED = 8
"""Least scale that is held against the best of the smaller ones: below, none holds enough to miss a bump."""
LARGE, FAR, PATCH = 20_000, 20, 200
"""Vertices from which their order matters, the share of all of them that numbers of neighbours then may be apart, and
vertices of a patch."""
UNSEEN = 1.0 / 12.0 + 1.0 / 8.0
"""Relative error of K by chords and flat triangles of the side c on an umbilic, in units of K c²; see `intrinsic`."""


@dataclass(frozen=True, slots=True)
class IntrinsicCurvature:
    """Gaussian curvature at each vertex, with the parts of its predicted squared error.

    Attributes
    ----------
    gaussian : (n_vertices,) ndarray of float
        In 1/length²; nan where no interior vertex is near.
    variance, squared_bias : (n_vertices,) ndarray of float
        Expected squared error by noise of the lengths, and by the average over a neighbourhood: what the choice of
        scale and order is made by.
    unseen : (n_vertices,) ndarray of float
        Squared error that this choice does not see: `rinow.curvature.unseen`.
    radius : (n_vertices,) ndarray of float
        Radius of the ball averaged over.
    on_arcs : (n_vertices,) ndarray of float
        Share of the error of chords that is removed: see `rinow.curvature.arcs`.
    """

    gaussian: Floats
    variance: Floats
    squared_bias: Floats
    unseen: Floats
    radius: Floats
    on_arcs: Floats


def intrinsic_curvature(
    mesh: TriangleMesh | IntrinsicMesh, *, radius: float | None = None, most_steps: int = LADDER[-1]
) -> IntrinsicCurvature:
    """Gaussian curvature from edge lengths, with the parts of its squared error; see `intrinsic`.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface; only edge lengths are used.
    radius : float, optional
        Radius of the balls in units of length, or the nearest to it that competes; by default the best of all.
    most_steps : int, optional
        Largest scale that competes, in units of that of one step.

    Returns
    -------
    IntrinsicCurvature
        Values and their predicted squared errors at every vertex.

    Notes
    -----
    Every step reads the values around each vertex.  A large mesh whose neighbours have distant numbers is computed in
    an order in which they are close, so that these are in the cache; that changes nothing but rounding.
    """
    order = _closer_order(mesh)
    if order is None:
        return _in_given_order(mesh, radius, most_steps)
    found = _in_given_order(_renumbered(mesh, order), radius, most_steps)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return IntrinsicCurvature(*(getattr(found, field.name)[rank] for field in fields(found)))


def _closer_order(mesh: TriangleMesh | IntrinsicMesh) -> NDArray[np.intp] | None:
    """Vertices patch by patch, or None if the mesh is small or its neighbours have close numbers already."""
    if mesh.n_vertices < LARGE:
        return None
    used = mesh.faces[mesh.topology.face_used]
    if not len(used) or np.median(np.abs(used[:, 0] - used[:, 1])) * FAR < mesh.n_vertices:
        return None
    return patch_order.patch_order(mesh.topology.neighbour_offsets, mesh.topology.neighbours, PATCH)


def _renumbered(mesh: TriangleMesh | IntrinsicMesh, order: NDArray[np.intp]) -> IntrinsicMesh:
    """The mesh with order[i] as vertex i, faces in the order of their vertices."""
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    faces = rank[mesh.faces]
    by_vertex = np.argsort(faces.min(axis=1), kind="stable")
    return IntrinsicMesh(faces[by_vertex], mesh.edge_lengths[by_vertex], mesh.n_vertices)


def _in_given_order(mesh: TriangleMesh | IntrinsicMesh, radius: float | None, most_steps: int) -> IntrinsicCurvature:
    """The curvature computed in the order of the vertices."""
    flow = CurvatureFlow(mesh)
    noise = LengthNoise.of(flow)
    start, shares = without_chords(flow, noise)
    waves = Waves(flow, start)
    tau2 = noise.level(flow, waves)
    averages = Averages(flow, noise, waves, tau2, Margins(flow, noise, start, most_steps))
    n = mesh.n_vertices
    bias, unseen, radii = np.zeros((3, n))
    best = IntrinsicCurvature(np.full(n, np.nan), np.full(n, np.inf), bias, unseen, radii, shares)
    wanted = None if radius is None else _nearest_rung(radius, noise)
    idle = 0
    for m in LADDER[: bisect_right(LADDER, most_steps)]:
        here = None if wanted is None else wanted == m
        if here is None or here.any():
            candidates = averages.of_scale(m)
            if m >= PROVED:
                candidates = (_beside(best, candidate, flow) for candidate in candidates)
            improved = [_improve(best, candidate, here) for candidate in candidates]
            idle = 0 if any(improved) else idle + 1
        if idle == IDLE and here is None:
            break
    del waves, averages  # with those it keeps: what follows takes the most memory
    best.gaussian[_is_flat(flow) & np.isfinite(best.gaussian)] = 0.0
    _shrink(best, flow)
    scale = best.radius**2 / SUPPORT
    best.unseen[:] = unseen_error(flow, noise, start, tau2, best.gaussian, best.squared_bias, scale)
    for values in (best.variance, best.squared_bias, best.unseen, best.radius):
        values[~np.isfinite(best.gaussian)] = np.nan
    return best


def _nearest_rung(radius: float, noise: LengthNoise) -> Floats:
    """(n_vertices,): the number of steps of the ladder whose ball has nearly that radius."""
    with np.errstate(all="ignore"):
        steps = np.square(radius / np.sqrt(SUPPORT * noise.step))
    between = np.sqrt(np.multiply(LADDER[1:], np.maximum(LADDER[:-1], 0.5)))
    return np.asarray(LADDER)[np.searchsorted(between, np.nan_to_num(steps))]


def _is_flat(flow: CurvatureFlow) -> NDArray[np.bool_]:
    """(n_vertices,): no defect of the vertices with data within three rings differs from 0 by more than rounding."""
    curved = flow.has_data & (np.abs(flow.mesh.vertex_angle_defects) > FLAT_DEFECT)
    return flow.means(curved.astype(np.float64), FLAT_RINGS) == 0.0


def _shrink(best: IntrinsicCurvature, flow: CurvatureFlow) -> None:
    """Pull values towards 0 where, around a vertex, their squares are no larger than the errors predicted (Stein)."""
    risk = best.variance + best.squared_bias
    total = flow.means(best.gaussian**2, SHRINK_PASSES)
    error = flow.means(np.where(np.isfinite(risk), np.minimum(risk, total), np.nan), SHRINK_PASSES)
    with np.errstate(all="ignore"):
        best.gaussian[:] *= np.where(total > 0.0, np.clip((1.0 - error / total) / (1.0 - CLEAR), 0.0, 1.0), 1.0)


def _beside(best: IntrinsicCurvature, candidate: Candidate, flow: CurvatureFlow) -> Candidate:
    """The candidate, with the bias that what it differs by from the best of smaller ones proves, beyond chords."""
    values, variance, bias, radius = candidate
    expected = CALIBRATION**2 * (best.variance + best.squared_bias) + variance
    expected += np.square(UNSEEN * np.square(best.gaussian) * np.square(flow.spacing))  # by chords
    return values, variance, np.fmax(bias, proven_bias(values - best.gaussian, expected, flow)), radius


def _improve(best: IntrinsicCurvature, candidate: Candidate, where: NDArray[np.bool_] | None) -> bool:
    """Take the candidate wherever its predicted squared error is smaller; whether it is anywhere."""
    better = candidate[1] + candidate[2] < best.variance + best.squared_bias
    if where is not None:
        better &= where
    for kept, offered in zip((best.gaussian, best.variance, best.squared_bias, best.radius), candidate, strict=True):
        kept[better] = offered[better]
    return bool(better.any())


def intrinsic(mesh: TriangleMesh | IntrinsicMesh, *, radius: float | None = None) -> Estimate:
    r"""Gaussian curvature of a surface known by its edge lengths, the scale and order chosen at every vertex.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface; only edge lengths are used.
    radius : float, optional
        Radius of the balls averaged over; by default chosen at every vertex.

    Returns
    -------
    estimate : Estimate
        `gaussian` everywhere but at vertices that are not manifold or far from any interior vertex; at the boundary
        from the interior nearby.  `spread` is 1.5 times the root of the predicted squared error, with what
        the choice does not see (`rinow.curvature.unseen`), and no less than the error of chords.

    Notes
    -----
    By Gauss and Bonnet every metric curvature at a scale is a weighted mean of angle defects.  Here the weights are
    polynomials in one small operator S, a regression over 2.1 spacings in the developed metric that

    - keeps constants, and linear functions away from the boundary: it adds no error of first order,
    - keeps the total curvature, so that its weights vary smoothly from defect to defect and the noise of each
      length, which enters four defects with the sum 0, cancels.

    The candidates :math:`K_{m,r}` are averages of the defects over areas with weights that end at a distance, of
    order 2r in it, for r = 1, 2, 3, and with as much noise as the mean :math:`(I - (I - S^m)^r) K` by heat flow for
    m = 0, 1, 2, 3, 4, 6, ... 128: see `rinow.curvature.waves`, and `rinow.curvature.margins` for boundaries.  At each
    vertex the one with the least sum of variance and squared bias is taken.  The variance is that of `LengthNoise`,
    its level from the residuals of small fits.  The
    squared bias of :math:`K_{m,r}` is the mean over a neighbourhood of :math:`(K_{m/2,r+1} - K_{m,r})^2`,
    less the variance of this difference.  At the end the values are multiplied by
    :math:`(1 - \langle error^2 \rangle / \langle K^2 \rangle) / 0.95`, cut to between 0 and 1 (after James and
    Stein); a surface without defects has K = 0.

    K is the defects over areas of the arcs whose chords the edges are, as far as an irregular mesh shows the normal
    curvatures κ: see `rinow.curvature.arcs`.  A regular mesh of chords has a metric that no comparison tells from that
    of a smooth surface.  A chord c is short by the share :math:`(κ c)^2/24` (Haantjes), which changes K by twice that,
    and the area of a triangle with K in it is larger by about :math:`K c^2/8` than that of the flat one.  Lengths do
    not know κ there, only that its largest square is at least \|K\|: the share of the error
    :math:`K^2 c^2 (1/12 + 1/8)` that is not corrected is added to the spread, for the rest the next order, with
    :math:`(K c^2)^2` in the place of :math:`\|K\| c^2`.
    """
    found = intrinsic_curvature(mesh, radius=radius)
    square = np.abs(found.gaussian) * np.square(longest_edges(mesh))
    chords = UNSEEN * np.abs(found.gaussian) * square * (1.0 - found.on_arcs + found.on_arcs * square)
    spread = np.sqrt(CALIBRATION**2 * (found.variance + found.squared_bias + found.unseen) + chords * chords)
    return Estimate(found.gaussian, spread, found.radius)
