"""Rinow curvature: the space forms whose triangles are thinner, or thicker, than those of a region (Appendix 2)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import in_unit
from rinow._printing import OneLine
from rinow.curvature.regions import region
from rinow.kernels import comparison

__all__ = ["RinowCurvature", "RinowPointCurvature", "rinow_curvature", "rinow_point_curvature"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

LOWEST = -1e4
"""Upper bounds below this over the squared diameter are reported as -inf: quadrilaterals as in a tree."""
FIRST = 24
"""Points compared first: being well spread, they leave few roots to find among all points."""
FEWEST = 8
"""A ball with fewer points is too small to say anything."""
CONTRAST = 0.1
"""Bounds that differ by more than this over the squared radius contradict a curvature at the point."""


@dataclass(frozen=True, slots=True, repr=False)
class RinowCurvature(OneLine):
    """What the triangles of a region allow its curvature to be.

    Attributes
    ----------
    lower : float
        Largest k such that nothing contradicts curvature at least k, in 1/length²; -inf where geodesics branch, inf
        for a single point.
    upper : float
        Smallest k such that nothing contradicts curvature at most k; -inf if nothing contradicts any k.
    lower_witness : tuple of int
        Four points that contradict every k above `lower`: the first lies in the triangle of the others, or on a side;
        or three points on a great circle.  Empty if there is no bound.
    upper_witness : tuple of int
        Four points that contradict every k below `upper`: the corners of a quadrilateral in their order, of which one
        may lie between its neighbours, on the side of a triangle.  Empty if there is no bound.
    n_points : int
        Number of points compared.
    """

    lower: float
    upper: float
    lower_witness: tuple[int, ...]
    upper_witness: tuple[int, ...]
    n_points: int


@dataclass(frozen=True, slots=True, repr=False)
class RinowPointCurvature(OneLine):
    """Rinow curvature at a point, from balls that shrink to it.

    Attributes
    ----------
    value : float
        Middle between the two bounds of the ball in which they are closest, in 1/length²; nan without one.
    standard_error : float
        Half the width of the interval that holds the bounds of that ball and of the next larger and smaller ones.
    exists : bool
        Whether the data support a limit: the bounds differ by less than a tenth of 1/radius².
    radius : float
        Radius of that ball.
    balls : tuple of RinowCurvature
        Bounds of all balls, from the largest one, each √½ times as wide as the one before.
    """

    value: float
    standard_error: float
    exists: bool
    radius: float
    balls: tuple[RinowCurvature, ...]


def rinow_curvature(
    space_or_mesh: Any,
    points: ArrayLike | None = None,
    *,
    radius: float | None = None,
    rtol: float | None = None,
    max_points: int = 100,
) -> RinowCurvature:
    r"""Bounds of the curvature of a region by comparison of its triangles with those of the surfaces S_k.

    A region has curvature at least k if two points on sides of a triangle are never closer, and at most k if they
    are never farther apart, than in the triangle of S_k with the same sides.

    Parameters
    ----------
    space_or_mesh : MetricSpace, mesh, (n, n) or (n, d) array_like, or graph
        Distances; a surface with exact geodesic distances of its vertices; points with straight distances, or with
        arcs where at least 25 of them lie on a surface in space; or edge lengths (scipy sparse or networkx) with
        shortest paths.
    points : int or (k,) array_like of int, optional
        The points of the region, all by default.
    radius : float, optional
        Take the points within this distance of the one point given.
    rtol : float, optional
        Share by which a distance may be wrong; a contradiction counts only if it stands for all such errors.  By
        default 1e-12, and for a mesh an estimate of what its edges miss of the arcs of a smooth surface, so that the
        bounds are those of that surface; 0 takes the mesh as the polyhedron it is.
    max_points : int, default 100
        Larger regions are represented by this many points, each as far as possible from those before it.

    Returns
    -------
    bounds : RinowCurvature
        Both bounds, in 1/length², and the points that attain them.

    Raises
    ------
    InvalidInputError
        If `space_or_mesh` is none of these, an index is out of range, `radius` comes without one point, or no path
        joins two points of the region.
    NotAMetricError
        If a matrix is not a metric, or a graph is not connected.

    See Also
    --------
    rinow_point_curvature : The limit at a point.
    wald_curvature : The limit of embedding curvatures at a point.

    Notes
    -----
    A sample has few points on sides of its triangles, so all its quadruples are compared, by conditions that are
    equivalent to the definition in a geodesic space: curvature is at least k if the comparison angles in S_k between
    three points at a fourth never sum to more than 2π [2]_, and at most k if for no quadrilateral, at both ends of a
    diagonal, the whole angle exceeds the two beside the diagonal [3]_.  Both are monotone in k.  For four points they
    hold up to the planar and from the nonplanar embedding curvature; where one point lies on a side of a triangle,
    the two bounds are its single embedding curvature, and these quadruples decide the comparison of all pairs of
    side points.

    What is certain: a region that contains the points in a convex neighbourhood with the given distances has no
    curvature bound from below above `lower` and none from above below `upper`.  So on a surface with Gaussian
    curvature K, inf K <= lower and upper <= sup K, up to `rtol`, with equality on S_k; more points bring both closer.
    No finite sample can exclude more curvature between its points.  `lower` exceeds `upper` where the data fit every
    k between, as points of three-dimensional space do.

    A relative error ε moves a bound by about 200 ε/diameter².  The cost is O(n³) angles and O(n⁴) additions; 100
    points take less than a second.

    References
    ----------
    .. [1] W. Rinow, "Die innere Geometrie der metrischen Räume", Springer, 1961; Definition 6.1 of the paper.
    .. [2] Y. Burago, M. Gromov, G. Perelman, "A. D. Alexandrov spaces with curvature bounded below", Russian Math.
       Surveys 47 (1992), 2.3.
    .. [3] S. Alexander, V. Kapovitch, A. Petrunin, "Alexandrov geometry: foundations", AMS, 2024, chapter 9.

    Examples
    --------
    Four points a quarter of the equator of the unit sphere apart, and the pole:

    >>> r = np.pi / 2
    >>> D = [[0, r, 2 * r, r, r], [r, 0, r, 2 * r, r], [2 * r, r, 0, r, r], [r, 2 * r, r, 0, r], [r, r, r, r, 0]]
    >>> bounds = rinow_curvature(D)
    >>> bool(np.isclose(bounds.lower, 1.0)), bool(np.isclose(bounds.upper, 1.0))
    (True, True)

    A tree branches: no lower bound, and every upper bound holds.

    >>> bounds = rinow_curvature([[0, 1, 1, 1], [1, 0, 2, 2], [1, 2, 0, 2], [1, 2, 2, 0]])
    >>> bounds.lower, bounds.lower_witness[0], bounds.upper
    (-inf, 0, -inf)
    """
    sample = region(space_or_mesh, points, radius, size=max_points, rtol=rtol)
    error, n, exponent = sample.rtol, len(sample.indices), int(np.frexp(sample.distances.max())[1])
    D = np.ldexp(sample.distances, -exponent)
    diameter = float(D.max())
    lower, upper = np.inf, LOWEST / diameter**2 if diameter > 0 else -np.inf
    lower_witness = upper_witness = np.full(4, -1)
    for size in sorted({min(n, FIRST), n}):
        part = np.ascontiguousarray(D[:size, :size])
        lower, lower_witness = _extreme(comparison.lower_bounds, part, lower, lower_witness, error)
        upper, upper_witness = _extreme(comparison.upper_bounds, part, upper, upper_witness, error)
    names = [tuple(int(i) for i in sample.indices[w[w >= 0]]) for w in (lower_witness, upper_witness)]
    lower, upper = (float(in_unit(k, -2 * exponent)) for k in (lower, upper if names[1] else -np.inf))
    return RinowCurvature(lower, upper, names[0], names[1], n)


def rinow_point_curvature(
    space_or_mesh: Any, point: int, *, radius: float, rtol: float | None = None, max_points: int = 100
) -> RinowPointCurvature:
    """Rinow curvature at a point: the limit of the bounds of shrinking balls around it.

    Parameters
    ----------
    space_or_mesh : MetricSpace, mesh, (n, n) or (n, d) array_like, or graph
        As for `rinow_curvature`.
    point : int
        Index of the point.
    radius : float
        Radius of the largest ball.
    rtol, max_points
        As for `rinow_curvature`.

    Returns
    -------
    curvature : RinowPointCurvature
        The value in 1/length²; nan, with `exists` false, if the largest ball has fewer than 8 points.

    Raises
    ------
    InvalidInputError, NotAMetricError
        As for `rinow_curvature`.

    See Also
    --------
    rinow_curvature : The bounds of one region.
    wald_curvature : The limit of embedding curvatures at a point.

    Notes
    -----
    The balls shrink by √½ as long as they have 8 points.  By definition 6.2 the curvature κ exists if for every ε a
    ball has curvature at least κ - ε and at most κ + ε.  A small ball knows less (its bounds cross, lower > upper), a
    large one sees curvature vary, so the ball with the closest bounds decides.  Where the bounds cross, they may agree
    by chance; what they change by from ball to ball says how well they know the limit.

    Examples
    --------
    >>> from rinow import SpaceForm
    >>> sphere = SpaceForm(4.0)
    >>> P = sphere.sample(30, 0.3, np.random.default_rng(7))
    >>> curvature = rinow_point_curvature(sphere.distance(P[:, None], P), 0, radius=0.5)
    >>> curvature.exists, round(curvature.value, 6)
    (True, 4.0)
    """
    balls = [rinow_curvature(space_or_mesh, point, radius=radius, rtol=rtol, max_points=max_points)]
    radii = [radius]
    while balls[-1].n_points >= FEWEST:
        radii.append(radii[-1] * 0.5**0.5)
        balls.append(rinow_curvature(space_or_mesh, point, radius=radii[-1], rtol=rtol, max_points=max_points))
    balls = balls[: max(len(balls) - 1, 1)]
    gaps = [abs(ball.upper - ball.lower) if np.isfinite([ball.lower, ball.upper]).all() else np.inf for ball in balls]
    best = int(np.argmin(gaps))
    known = balls[best].n_points >= FEWEST and np.isfinite(gaps[best])
    near = [b for ball in balls[max(best - 1, 0) : best + 2] for b in (ball.lower, ball.upper) if np.isfinite(b)]
    return RinowPointCurvature(
        value=0.5 * (balls[best].lower + balls[best].upper) if known else np.nan,
        standard_error=0.5 * (max(near) - min(near)) if known else np.nan,
        exists=bool(known and gaps[best] * radii[best] * radii[best] < CONTRAST),
        radius=radii[best],
        balls=tuple(balls),
    )


def _extreme(
    kernel: Callable[..., None], D: Floats, start: float, witness: Indices, rtol: float
) -> tuple[float, Indices]:
    """The tightest bound of all rows, with its witness; those given if none is tighter."""
    bounds, witnesses = np.empty(len(D)), np.empty((len(D), 4), np.intp)
    kernel(D, start, rtol, bounds, witnesses)
    tightest = int(np.abs(bounds - start).argmax()) if np.isfinite(start) else int(bounds.argmin())
    found = witnesses[tightest]
    return (float(bounds[tightest]), found) if found[0] >= 0 else (start, witness)
