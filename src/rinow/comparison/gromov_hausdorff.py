"""The Gromov-Hausdorff distance of finite metric spaces: exact where that is feasible, else a certified interval."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import as_floats, as_number
from rinow._printing import OneLine
from rinow.comparison import bounds, large, steps
from rinow.comparison.alignment import align
from rinow.comparison.clock import Clock
from rinow.comparison.engine import RELATION, Engine, worst_of
from rinow.comparison.interval import Interval
from rinow.comparison.subsets import bound_by_subsets
from rinow.comparison.surfaces import Sample, eccentricity_gap, samples_of
from rinow.comparison.whole_eccentricities import Eccentricities, gap_of_eccentricities
from rinow.comparison.whole_meshes import whole_relation
from rinow.errors import InvalidInputError
from rinow.metric_space import MetricSpace

__all__ = ["GromovHausdorff", "MetricSpace", "gromov_hausdorff"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

SHARE_OF_NETS, SHARE_OF_MESHES, SHARE_BESIDE_A_MATRIX = 0.3, 0.2, 0.85
"""Share of the time for the comparison of nets: of spaces, of two meshes, and of a mesh with a matrix.  The rest goes
into maps of subsets, and for two meshes into these:"""

SHARE_OF_SUBSETS, SHARE_OF_ECCENTRICITIES = 0.05, 0.2
"""Shares of the time then left for maps of subsets and eccentricities; the rest is for a relation of all vertices."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class GromovHausdorff(OneLine):
    """Bounds of a Gromov-Hausdorff distance with their certificates.

    Attributes
    ----------
    lower, upper : float
        The distance lies between them, in the unit of length of the spaces.
    exact : bool
        Whether the two are equal, up to a share of 1e-12.
    correspondence : (k, 2) ndarray of int
        Pairs (x, y) that cover both spaces; half their distortion is `upper`.  Where nets are compared they cover the
        nets, and `upper` is half their distortion plus the larger covering radius, or half the larger diameter if that
        is less.  Of meshes they cover all vertices where that leads to less: `upper` is then at least half their
        distortion, which is bounded by the rows of some of them.
    lower_bound_by : str
        What proved `lower`: "non-negativity", "diameter", "eccentricities", "packing", "single linkage", "sorted
        distances", "arc consistency", "search", "satisfiability", "persistence" or "maps of subsets".
    covering_radii : tuple of float
        How far a point of each space may be from the points that were compared.
    proof_checked : bool or None
        Whether the proof that a clause-learning solver gave for `lower` was checked; None if `lower` needs none.
    """

    lower: float
    upper: float
    exact: bool
    correspondence: Indices
    lower_bound_by: str
    covering_radii: tuple[float, float] = (0.0, 0.0)
    proof_checked: bool | None = None


def gromov_hausdorff(
    X: Any,
    Y: Any,
    *,
    time_limit: float = 60.0,
    rtol: float = 0.0,
    covering_radii: tuple[float, float] = (0.0, 0.0),
    verify: bool = False,
) -> GromovHausdorff:
    r"""Gromov-Hausdorff distance: how far two metric spaces are from being isometric.

    A correspondence is a set R of pairs (x, y) in which every point of both spaces occurs; its distortion is the
    largest :math:`|d(x, x') - d(y, y')|` over two of its pairs.  The distance is half the least distortion.

    Parameters
    ----------
    X, Y : MetricSpace, (n, n) array_like of float, or mesh
        Two finite metric spaces, or their distance matrices, in one unit of length; repeated points are allowed.  A
        mesh (`TriangleMesh`, `IntrinsicMesh`, ``(V, F)`` pair or object with vertices and faces) stands for its
        vertices with the lengths of the shortest paths along edges; vertices without a face are left out.  Of a mesh of
        more than 3000 vertices, or where the time is short, a net of the vertices is compared.
    time_limit : float, default 60
        Seconds after which the search stops with the bounds reached so far; with 0 the bounds that cost no search.
        One step may overrun it by some tenths of a second.
    rtol : float, default 0
        Stop as soon as ``upper - lower <= rtol * upper``; with 0 only when the two are equal.
    covering_radii : (float, float), default (0, 0)
        Each argument stands for a larger space, of which every point is within this distance of one of its points, in
        the unit of the distances: the interval is that of the larger spaces, surfaces or curves say, of which X and Y
        are nets.
    verify : bool, default False
        Have the clause-learning solver write down its proofs, and check them: that takes two or three times as long as
        finding them.  A refutation with a wrong proof is not used.

    Returns
    -------
    result : GromovHausdorff
        `lower` and `upper` in the unit of the distances, `exact` if they are equal, the `correspondence` that has
        `upper` (its distortion is ``2 * upper``, less where only nets are known), `lower_bound_by`, the name of what
        proved `lower`, `covering_radii` and `proof_checked`.

    Raises
    ------
    InvalidInputError
        If an argument is not a space, is empty, or a limit or covering radius is negative or nan.
    NotAMetricError
        If a matrix is not a metric (build a `MetricSpace` with another `rtol` where rounding shall be forgiven), or the
        faces of a mesh are not connected.
    InvalidMeshError
        If no face of a mesh takes part, or its distances are no numbers.

    See Also
    --------
    distortion : Recomputes the certificate of `upper`.
    lipschitz_distance : By ratios in place of differences.
    hausdorff_distance : Of sets in one space.

    Notes
    -----
    The search deletes pairs without support until every remaining pair is compatible with some pair of every point (arc
    consistency), branches on a point with few possible partners, and restarts with what it learned about the points
    that cause failures.  It begins below the distortion of a relation found by tabu search.  Everything is compared
    by the float64 operations that measure a distortion, so `lower` holds for the distances as stored.  Random clouds
    of 100 points in the plane take seconds; the time grows exponentially in the worst case.
    :math:`|\mathrm{diam} X - \mathrm{diam} Y| / 2 \le d_{GH} \le \max(\mathrm{diam} X, \mathrm{diam} Y) / 2`.

    The larger spaces of which X and Y are nets with covering radii r and s differ in distance by at most max(r, s) from
    the nets: let every point x of the one have the partner of a net point p(x) within r, and every y of the other the
    partner of a q(y) within s; then d(x, q(y)) and d(p(x), y) change by r + s at most, distances within one space by 2r
    and 2s.  The same argument leads from the larger spaces to the nets.

    From below more is true: for a finite subset A of X and a correspondence of distortion δ, let f(a) be a point of the
    net of Y nearest to a partner of a; then :math:`\mathrm{dis} f \le \delta + 2s`.  Hence :math:`2 d_{GH} \ge \min
    \mathrm{dis} f - 2s` over the maps f of A into the net, without r, and the same the other way round ("maps of
    subsets").  Of spaces of thousands of points, a dozen points and those farthest from them and from their partners
    are mapped into all of the other space where the lower bound stays below half the upper one; this has the same name.

    Relations of all vertices of large meshes are too large to be measured.  Let δ(i) be the largest
    :math:`|d(x_i, x_j) - d(y_i, y_j)|` over the pairs j of a relation, which the distances from x_i and from y_i alone
    tell.  By the triangle inequality :math:`\delta(j) \le \delta(i) + d(x_i, x_j) + d(y_i, y_j)`; the least right side
    over some pairs i bounds δ(j), and the largest of these bounds the distortion.

    An interval that stays open is raised by holes that one space has and the other one lacks ("persistence") if the
    extra of this name is installed (GUDHI) and a second is left.

    References
    ----------
    .. [1] D. Burago, Y. Burago, S. Ivanov, "A Course in Metric Geometry", 2001, Theorem 7.3.25.

    Examples
    --------
    The corners of a unit square and of a regular triangle with the same side:

    >>> square, triangle = [[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 0], [1, 0], [0.5, 0.75**0.5]]
    >>> X, Y = MetricSpace.from_points(square), MetricSpace.from_points(triangle)
    >>> result = gromov_hausdorff(X, Y)
    >>> result.exact, round(result.upper, 6), result.lower_bound_by
    (True, 0.5, 'packing')

    A circle of length 4 and its diameter as spaces, known by nets of 8 and 9 points:

    >>> steps = abs(np.arange(16)[:, None] - np.arange(16))
    >>> circle, segment = np.minimum(steps, 16 - steps)[::2, ::2] / 4, steps[:9, :9] / 4
    >>> result = gromov_hausdorff(circle, segment, covering_radii=(1 / 4, 1 / 8))
    >>> result.lower_bound_by, result.lower <= 2 / 3 <= result.upper
    ('maps of subsets', True)
    """
    clock = Clock.of(time_limit)
    if not 0.0 <= as_number(rtol, "rtol") < 1.0:
        raise InvalidInputError(f"rtol = {rtol} is not a relative tolerance; give a number from 0 to below 1.")
    beyond = _checked_radii(covering_radii)
    samples = samples_of(X, Y, clock)
    radii = samples[0].covering_radius + beyond[0], samples[1].covering_radius + beyond[1]
    meshes = all(sample.metric is not None for sample in samples)
    of_nets = SHARE_OF_NETS if sum(beyond) > 0.0 else SHARE_OF_MESHES if meshes else SHARE_BESIDE_A_MATRIX
    share = 1.0 if sum(radii) == 0.0 else of_nets
    interval = first_interval(samples[0].distances, samples[1].distances, rtol, verify=verify)
    _compare(samples[0].distances, samples[1].distances, interval, clock.part(share * clock.left))
    upper, exact = 0.5 * interval.upper, interval.exact
    proved = Proved(0.5 * interval.lower, interval.by, interval.proof_checked)
    if sum(radii) > 0.0:
        diameters = [sample.diameter_bound + 2.0 * r for sample, r in zip(samples, beyond, strict=True)]
        upper, exact = min(upper + max(radii), 0.5 * max(diameters)), False
        share = SHARE_OF_SUBSETS if meshes and sum(beyond) == 0.0 else 1.0
        proved = _proved_beyond(samples, proved, beyond, clock.part(share * clock.left), verify=verify)
    pairs = _named_pairs(samples, interval)
    if meshes and radii != beyond:
        proved = _proved_by_eccentricities(samples, proved, beyond, clock.part(SHARE_OF_ECCENTRICITIES * clock.left))
        upper, radii, pairs = _with_all_vertices(samples, interval, upper, beyond, clock)
    return GromovHausdorff(proved.lower, upper, exact, pairs, proved.by, radii, proved.proof_checked)


def _named_pairs(samples: tuple[Sample, Sample], interval: Interval) -> Indices:
    """(k, 2): the pairs of points of the samples, as points of the spaces or vertices of the meshes."""
    return np.stack([sample.indices[k] for sample, k in zip(samples, interval.pairs.T, strict=True)], axis=1)


def _with_all_vertices(
    samples: tuple[Sample, Sample], interval: Interval, upper: float, beyond: tuple[float, float], clock: Clock
) -> tuple[float, tuple[float, float], Indices]:
    """An upper bound for two meshes by a relation of all vertices, or by nets that are compared longer.

    The radii within which its pairs reach all points, and these pairs.
    """
    whole = whole_relation(*samples, interval.pairs, clock)
    if whole is not None:
        whole.improve(clock)
        if 0.5 * whole.upper + max(beyond) < upper:
            return 0.5 * whole.upper + max(beyond), beyond, whole.pairs(*samples)
    radii = samples[0].covering_radius + beyond[0], samples[1].covering_radius + beyond[1]
    if not interval.closed and not clock.over:  # what the whole relation left
        _compare(samples[0].distances, samples[1].distances, interval, clock)
        upper = min(upper, 0.5 * interval.upper + max(radii))
    return upper, radii, _named_pairs(samples, interval)


def _checked_radii(covering_radii: tuple[float, float]) -> tuple[float, float]:
    """Two finite radii that are not negative."""
    radii = as_floats(covering_radii, "covering_radii")
    if radii.shape != (2,) or not (np.isfinite(radii) & (radii >= 0.0)).all():
        raise InvalidInputError(f"covering_radii = {covering_radii} are not two lengths >= 0; give one for each space.")
    return float(radii[0]), float(radii[1])


class Proved(NamedTuple):
    """A lower bound and what proved it."""

    lower: float
    by: str
    proof_checked: bool | None = None


def _proved_beyond(
    samples: tuple[Sample, Sample], samples_proved: Proved, beyond: tuple[float, float], clock: Clock, *, verify: bool
) -> Proved:
    """The best lower bound of the distance of spaces of which only the samples are known."""
    X, Y = samples[0].distances, samples[1].distances
    radii = samples[0].covering_radius + beyond[0], samples[1].covering_radius + beyond[1]
    best = max(
        Proved(0.0, "non-negativity"),
        samples_proved._replace(lower=samples_proved.lower - max(radii)),
        Proved(0.5 * eccentricity_gap(*samples, beyond), "eccentricities"),
        key=lambda proved: proved.lower,
    )
    twice, proof_checked = bound_by_subsets(X, Y, radii, 2.0 * best.lower, clock, verify=verify)
    return Proved(0.5 * twice, "maps of subsets", proof_checked) if 0.5 * twice > best.lower else best


def _proved_by_eccentricities(
    samples: tuple[Sample, Sample], proved: Proved, beyond: tuple[float, float], clock: Clock
) -> Proved:
    """The better one of a lower bound and that by the eccentricities of all vertices of two meshes."""
    X, Y = (Eccentricities.of(sample, metric) for sample in samples if (metric := sample.metric) is not None)
    gap = gap_of_eccentricities(X, Y, 2.0 * proved.lower, clock, beyond)
    return Proved(0.5 * gap, "eccentricities") if 0.5 * gap > proved.lower else proved


def _compare(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """Improve the interval of the distortion of two spaces of which all distances are known."""
    if interval.closed or clock.over:
        return
    interval.raise_lower(bounds.packing_bound(DX, DY), "packing")
    interval.raise_lower(bounds.single_linkage_bound(DX, DY), "single linkage")
    align(DX, DY, interval, clock.part(0.2 * clock.left))
    if len(DX) * len(DY) * (len(DX) + len(DY)) < large.LARGE:
        engine = Engine(DX, DY, clock=clock.part(0.3 * clock.left))
        interval.raise_lower(engine.row_bound, "sorted distances")
        steps.close(engine, interval, clock)
    else:
        large.approach(DX, DY, interval, clock)


def first_interval(DX: Floats, DY: Floats, rtol: float, *, verify: bool = False) -> Interval:
    """What can be said at once: two bounds from below, and the better of a few maps."""
    by_eccentricity = np.argsort(DX.max(axis=1), kind="stable"), np.argsort(DY.max(axis=1), kind="stable")
    candidates = [_monotone(*by_eccentricity)]
    if len(DX) == len(DY):
        candidates.append(np.repeat(np.arange(len(DX))[:, None], 2, axis=1))
    values = [worst_of(RELATION, DX, DY, pairs) for pairs in candidates]
    best = int(np.argmin(values))
    interval = Interval(candidates[best], values[best], rtol=rtol, verify=verify)
    interval.raise_lower(bounds.diameter_bound(DX, DY), "diameter")
    interval.raise_lower(bounds.eccentricity_bound(DX, DY), "eccentricities")
    return interval


def _monotone(xs: Indices, ys: Indices) -> Indices:
    """Pairs that run through two lists at the same pace."""
    k = max(len(xs), len(ys))
    return np.stack([xs[np.arange(k) * len(xs) // k], ys[np.arange(k) * len(ys) // k]], axis=1)
