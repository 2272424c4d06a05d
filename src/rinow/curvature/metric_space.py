"""Curvature at the points of a finite metric space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import as_radius, in_safe_unit, in_unit
from rinow._printing import OneLine
from rinow.curvature.space_fit import N_ORDERS, fit_at_first
from rinow.curvature.status import VertexStatus
from rinow.embedding.point_set import LARGEST_DIAMETER
from rinow.errors import InvalidInputError
from rinow.metric_space import as_metric_space

__all__ = ["MetricSpaceCurvature", "metric_space_curvature"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FIRST_BALL, GROWTH = 8, 1.5
"""Points of the smallest ball that competes, and factor from one to the next."""
FEWEST = 5
"""Points that can tell a curvature and an error."""
MOST = 30
"""Points of a larger ball that are looked at, spread evenly over the ranks of distance."""
INNER = 0.75
"""Radius of the ball that one of given radius is compared with."""
AVERAGED = 9
"""Nearest points whose squared biases are averaged, the point itself among them."""
OWN, NOTABLE = 0.5, 6.0
"""Least share of the own square in that mean, and the square over the variance that counts: others may hide it."""
NEXT_ORDER = 3
"""Power of the radius with which the bias of the highest order grows at least."""
FLOOR = 0.1
"""Share of the variance of a comparison that its square cannot be told from: least squared bias."""
CALIBRATION = 1.3
"""Standard error over the root of the least predicted squared error: the candidate taken is the one that looks best."""
UNDECIDED, UNLIKE = 1.5, 0.05
"""Standard error times radius², and residual over radius, above which nothing is known.  Residuals of points in space
are 0.04 to 0.1, those of grid graphs 0.09."""
ROUNDING = 1e-9
"""Standard error times radius² below which larger balls are not examined."""
FEW = 0.05
"""Share of the points that a larger ball must serve better for a still larger one to be examined."""
CURVED = 2.0
"""Curvature times radius² beyond which a ball does not compete with a smaller one: a hemisphere has 2.5, and errors of
distances grow exponentially in balls of negative curvature."""
BORDER_GAP, BORDER_POINTS = 2.8, 20
"""Angle without a point, in radians, that tells a border, as for point clouds; in the ball of so many points."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MetricSpaceCurvature(OneLine):
    """Curvature at every point of a metric space, in the order of its points.

    Attributes
    ----------
    value : (n_points,) ndarray of float
        Curvature, in 1/length²; nan where undefined.
    standard_error : (n_points,) ndarray of float
        Of the value, by errors of the distances and by changes of curvature.
    status : (n_points,) ndarray of uint8
        Values of `VertexStatus`: OK; BOUNDARY where the points around leave out a wide angle; ISOLATED without
        another point in reach; UNRESOLVED where the distances are not those of a surface of some curvature.
    radius : (n_points,) ndarray of float
        Radius of the ball the value is taken from.
    residual : (n_points,) ndarray of float
        Standard deviation of the distances in the ball from those in the surface fitted, in the unit of length.
    """

    value: Floats
    standard_error: Floats
    status: NDArray[np.uint8]
    radius: Floats
    residual: Floats


def metric_space_curvature(space: Any, *, radius: float | None = None) -> MetricSpaceCurvature:
    r"""Curvature at each point of a finite metric space that is, or nearly is, part of a surface.

    Parameters
    ----------
    space : MetricSpace or (n_points, n_points) array_like of float
        Distances, in any unit of length; a `MetricSpace` of a graph may have inf between its parts.
    radius : float, optional
        Radius of the ball around each point, positive, in the unit of length; by default the one with the least
        expected error, at each point.

    Returns
    -------
    curvature : MetricSpaceCurvature
        `value`, `standard_error` and `status` of each point, the radius used and the residual of the distances.
        Points at distance 0 from each other have the same values.

    Raises
    ------
    InvalidInputError
        If `space` is neither a space nor a square matrix, `radius` is not positive, or the distances reach less than
        1e-152 or more than 1e152.
    NotAMetricError
        If the matrix is not a metric.

    See Also
    --------
    wald_curvature : The limit at one point, over all quadruples, and whether it exists.
    fit_curvature : The one curvature that fits all points of a space best.
    graph_curvature : Curvature at the nodes of a graph.

    Notes
    -----
    The points of a ball are fitted by the surface of constant curvature that comes closest (`fit_curvature`), and what
    this leaves by a curvature that varies, with its gradient, or with its second derivatives too.  The variance of each
    of the three estimates follows from the residual of the distances, there or around; the squared bias is the mean,
    over the nearest points, of the square of the difference from the highest order (of that order, from the ball
    before, and from what constants over both tend to), less the variance of this difference; half of the own square
    counts if it is notable.  Balls hold 8, 12, 18, ... nearest points, of more than 30 an even choice of 30.  The ball
    and the order with the least sum of variance and squared bias are taken.  On points of S_k the value is k up to
    rounding.

    The status is UNRESOLVED, with nan, for fewer than five points, for points of a line, and where the standard error
    exceeds 1.5/radius² or the residual 5 % of the radius: the space is not like a surface at that scale (nodes of a
    tree, points in space).  The cost is about 2 ms for each ball, at most 2.5 log(n/5) of them for each point.

    References
    ----------
    .. [1] A. Wald, "Begründung einer koordinatenlosen Differentialgeometrie der Flächen", 1936; Definition 3.4.

    Examples
    --------
    Points of a sphere of radius 2, known by their distances:

    >>> from rinow import SpaceForm
    >>> sphere = SpaceForm(0.25)
    >>> points = sphere.sample(30, 1.0, np.random.default_rng(5))
    >>> D = sphere.distance(points[:, None], points)
    >>> curvature = metric_space_curvature((D + D.T) / 2)
    >>> bool(np.allclose(curvature.value, 0.25))
    True
    """
    D = as_metric_space(space).distances
    reach = None if radius is None else as_radius(radius)
    extent = float(D[np.isfinite(D)].max())
    if extent and not 1.0 / LARGEST_DIAMETER < extent < LARGEST_DIAMETER:
        raise InvalidInputError(f"distances reach {extent:.3g}, and their curvature is no number; scale them.")
    D, exponent = in_safe_unit(D)
    reach = None if reach is None else float(in_unit(reach, -exponent))
    first = (D == 0.0).argmax(axis=1)  # the first of several points at distance 0
    distinct, place = np.unique(first, return_inverse=True)
    found = _of_distinct(D[np.ix_(distinct, distinct)], reach)
    at = place.ravel()
    return MetricSpaceCurvature(
        in_unit(found.value[at], -2 * exponent),
        in_unit(found.standard_error[at], -2 * exponent),
        found.status[at],
        in_unit(found.radius[at], exponent),
        in_unit(found.residual[at], exponent),
    )


def _of_distinct(D: Floats, radius: float | None) -> MetricSpaceCurvature:
    """The curvature at points none of which coincide."""
    order = np.argsort(D, axis=1, kind="stable")  # the point itself comes first, alone at distance 0
    near = np.take_along_axis(D, order, axis=1)
    best = np.full((4, len(D)), np.nan)  # value, risk, radius, residual
    best[1] = np.inf
    gaps, last = np.full(len(D), np.nan), None
    for is_candidate, sizes in _balls(near, radius):
        ball = _Ball.of(D, order, near, sizes, np.full(len(D), np.nan) if last is None else last.values[:, 0])
        gaps = np.where(np.isnan(gaps) | (sizes <= BORDER_POINTS), ball.gaps, gaps)
        improved = ball.improve(best, last, order) if is_candidate else np.ones(len(D), np.bool_)
        last = ball
        with np.errstate(invalid="ignore"):
            is_settled = np.sqrt(best[1]) * best[2] ** 2 < ROUNDING
        examined = sizes.max() > BORDER_POINTS // GROWTH and np.isfinite(best[1]).any()
        if examined and np.mean(improved & ~is_settled) < FEW:
            break
    value, error = best[0], CALIBRATION * np.sqrt(best[1])
    status = np.where(gaps > BORDER_GAP, VertexStatus.BOUNDARY, VertexStatus.OK).astype(np.uint8)
    is_surface = (error * best[2] ** 2 < UNDECIDED) & (best[3] < UNLIKE * best[2])
    status[~is_surface] = VertexStatus.UNRESOLVED
    status[_sizes_within(near, np.inf if radius is None else radius) == 1] = VertexStatus.ISOLATED
    for field in (value, error, best[2], best[3]):
        field[status >= VertexStatus.ISOLATED] = np.nan
    return MetricSpaceCurvature(value, error, status, best[2], best[3])


def _sizes_within(near: Floats, radius: float) -> Indices:
    """(n,): numbers of points within a radius, those infinitely far not counted."""
    return np.count_nonzero((near <= radius) & np.isfinite(near), axis=1)


def _balls(near: Floats, radius: float | None) -> list[tuple[bool, Indices]]:
    """Numbers of points in growing balls, and whether a value may be taken from them."""
    if radius is not None:
        return [(False, _sizes_within(near, INNER * radius)), (True, _sizes_within(near, radius))]
    available = _sizes_within(near, np.inf)
    sizes, balls = float(FIRST_BALL), list[tuple[bool, Indices]]()
    while sizes < GROWTH * available.max():
        balls.append((True, np.minimum(int(sizes), available)))
        sizes *= GROWTH
    return balls or [(True, available)]


@dataclass(frozen=True, slots=True)
class _Ball:
    """The fits over a ball around each point: arrays (n, 3) by order, (n,) by point; nan without a fit."""

    values: Floats
    variances: Floats
    differences: Floats
    residuals: Floats
    gaps: Floats
    radii: Floats

    @classmethod
    def of(cls, D: Floats, order: Indices, near: Floats, sizes: Indices, starts: Floats) -> _Ball:
        """The fits over the `sizes` nearest points, which `order` lists and `near` has the distances of."""
        n = len(D)
        by_order, by_point = np.full((3, n, N_ORDERS), np.nan), np.full((3, n), np.nan)
        for i, size in enumerate(sizes):
            if size < FEWEST:
                continue
            ranks = np.unique(np.linspace(0, size - 1, min(size, MOST)).round().astype(np.intp))
            points = order[i, ranks]
            block = D[np.ix_(points, points)]
            fit = fit_at_first(block, starts[i]) if np.isfinite(block).all() else None
            if fit is not None:
                by_order[:, i] = fit.values, fit.variances, fit.differences
                by_point[:, i] = fit.residual, fit.gap, near[i, size - 1]
        return cls(*by_order, *by_point)

    def squared_biases(self, smaller: _Ball | None, order: Indices) -> Floats:
        """(n, 3): mean over the nearest points of the squares of the differences, less their variances.

        Differences are those from the highest order; of that itself from the smaller ball, or from the order below.
        """
        rows = np.arange(len(self.values))
        top = np.maximum(np.isfinite(self.values).sum(axis=1) - 1, 0)
        squares = (self.values - self.values[rows, top][:, None]) ** 2
        noise = self.differences.copy()
        if smaller is None:
            reference, before, ratio = self, np.maximum(top - 1, 0), np.zeros(len(top))
        else:
            reference, before = smaller, np.maximum(np.isfinite(smaller.values).sum(axis=1) - 1, 0)
            with np.errstate(all="ignore"):
                ratio = (smaller.radii / self.radii) ** NEXT_ORDER
        with np.errstate(all="ignore"):
            factor = 1.0 / np.maximum(1.0 - ratio, FLOOR) ** 2
            squares[rows, top] = factor * (self.values[rows, top] - reference.values[rows, before]) ** 2
            noise[rows, top] = factor * reference.variances[rows, before]
        biases = np.maximum(_local_squares(squares, noise, order), FLOOR * noise)
        if smaller is not None:
            is_second = top == N_ORDERS - 1
            biases[is_second, -1] = np.maximum(biases[:, -1], self._bend(smaller, order))[is_second]
        return biases

    def _bend(self, smaller: _Ball, order: Indices) -> Floats:
        """(n,): squares of the bias of second derivatives, as far as constants over the two balls do not confirm them.

        A constant differs from a smooth curvature by the square of the radius, so that those over two balls tell it as
        well.  Of a polyhedron, only the vertices are curved: second derivatives there make a bump of each.
        """
        with np.errstate(all="ignore"):
            share = (smaller.radii / self.radii) ** 2
            limit = (smaller.values[:, 0] - share * self.values[:, 0]) / (1.0 - share)
            variance = (smaller.variances[:, 0] + share**2 * self.variances[:, 0]) / (1.0 - share) ** 2
            squares, noise = (self.values[:, -1] - limit) ** 2, variance + self.variances[:, -1]
        noise[~np.isfinite(noise)] = np.nan  # no smaller ball
        return np.nan_to_num(_local_squares(squares[:, None], noise[:, None], order)[:, 0])

    def improve(self, best: Floats, smaller: _Ball | None, order: Indices) -> NDArray[np.bool_]:
        """Enter the estimates with a smaller risk than the best so far; where there was one."""
        variances = np.fmax(self.variances, _local_means(np.sqrt(self.variances), order) ** 2)
        risks = variances + self.squared_biases(smaller, order)
        with np.errstate(invalid="ignore"):
            is_curved = np.abs(self.values) * self.radii[:, None] ** 2 > CURVED
        risks[~np.isfinite(self.values + risks) | (is_curved & np.isfinite(best[1])[:, None])] = np.inf
        chosen = risks.argmin(axis=1)
        rows = np.arange(len(risks))
        better = risks[rows, chosen] < best[1]
        found = np.stack([self.values[rows, chosen], risks[rows, chosen], self.radii, self.residuals])
        best[:, better] = found[:, better]
        return better


def _local_squares(squares: Floats, noise: Floats, order: Indices) -> Floats:
    """(n, k): mean of the squares less their variance at the nearest points, at least a share of a notable own one."""
    return np.fmax(_local_means(squares - noise, order), OWN * (squares - NOTABLE * noise))


def _local_means(values: Floats, order: Indices) -> Floats:
    """(n, 3): mean of the finite values at the nearest points."""
    near = values[order[:, :AVERAGED]]
    known = np.isfinite(near)
    with np.errstate(all="ignore"):
        return np.where(known, near, 0.0).sum(axis=1) / known.sum(axis=1)
