"""Wald curvature at a point: the limit of the embedding curvatures of small quadruples (3.4 and 6.5 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.regions import region
from rinow.embedding.quadruple import EmbeddingCurvatures, embedding_curvatures
from rinow.errors import InvalidInputError

__all__ = ["WaldCurvature", "wald_curvature"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

MAX_POINTS = 40
MAX_QUADRUPLES = 20_000
FEWEST = 5
"""Quadruples that can support a limit: as many as five points have."""
FEWEST_POINTS = 6
"""Points that can tell a gradient of curvature from scatter."""
STEPS = 8
"""Rounds of choosing values and weights; the choice is settled after three or four."""
NORMAL = 1.4826
"""Standard deviation of a normal variable over its median absolute value."""
HUBER = 2.0
"""Residuals beyond this many standard deviations weigh less."""
SCATTER = 0.25
"""Scatter times radius² without a limit: 0.5 at a cone of angle 6 and 1.2 in space; on surfaces it is below 0.2."""
CONTRAST = 2.0
"""Contrast in a space of higher dimension: 5 in space, also for points of a surface with straight distances."""
WITHOUT_VALUE = 0.05
"""Share of quadruples without a value that noise explains: a graph has 0.2 and more."""


@dataclass(frozen=True, slots=True)
class WaldCurvature:
    """Wald curvature at a point.

    Attributes
    ----------
    value : float
        Limit of the embedding curvatures, in 1/length²; nan without a quadruple that has one.
    standard_error : float
        Standard error of `value` from the scatter of the quadruples and the errors of the distances.
    n_quadruples : int
        Number of quadruples used, linear ones and those with two equal points not counted.
    n_without_value : int
        How many of them have no embedding curvature.
    exists : bool
        Whether the data support that there is a limit.
    radius : float
        Radius of the ball that holds the quadruples.
    """

    value: float
    standard_error: float
    n_quadruples: int
    n_without_value: int
    exists: bool
    radius: float


def wald_curvature(
    space: Any,
    point: int,
    *,
    radius: float,
    kind: Literal["wald", "modified"] = "wald",
    rng: np.random.Generator | None = None,
    rtol: float | None = None,
) -> WaldCurvature:
    r"""Curvature of the surface of constant curvature in which small quadruples around a point embed.

    A point has Wald curvature κ if for every ε the non-linear quadruples of some ball around it have an embedding
    curvature within ε of κ; modified (Kirk) if those do in which one point lies between two others.

    Parameters
    ----------
    space : MetricSpace, mesh, (n, n) or (n, d) array_like, or graph
        Distances; a surface with exact geodesic distances of its vertices; points with straight distances, or with
        arcs where at least 25 of them lie on a surface in space; or edge lengths (scipy sparse or networkx) with
        shortest paths.
    point : int
        Index of the point.
    radius : float
        Radius of the ball, in the unit of the distances.  Of more than 40 points in it, 40 are taken, each as far as
        possible from those before it.
    kind : {"wald", "modified"}, default "wald"
        All quadruples, or those with a linear triple (up to `rtol`).
    rng : numpy.random.Generator, optional
        Chooses 20000 of more quadruples; ``default_rng(0)`` by default.
    rtol : float, optional
        Share by which a distance may be wrong.  By default 1e-12, and for a mesh an estimate of what its edges miss of
        the arcs of a smooth surface; 0 takes the mesh as the polyhedron it is.

    Returns
    -------
    curvature : WaldCurvature
        The limit with its standard error, and whether it exists.

    Raises
    ------
    InvalidInputError
        If `space` is none of these, `point` is out of range, `radius` is not positive or `kind` is unknown.

    See Also
    --------
    rinow_curvature : Bounds of the curvature of a region, by comparison of triangles.
    surface_curvature : Curvature at all vertices of a mesh.

    Notes
    -----
    A quadruple has two embedding curvatures in general.  One is close to the curvature of the surface, the other has
    the size of 1/diameter².  The smaller of both in modulus gives a first guess, a weighted median; from then on each
    quadruple counts with the value nearer to what is expected of it.

    Expected is κ plus a multiple of the mean squared distance of its points from p plus a linear function of its
    centroid, in coordinates from the distances (classical scaling); κ is the value at 0.  A centroid off p would
    cost an error of the first order in the radius, so that of κ is of the second.  Fewer than 6 points give the mean.
    A quadruple weighs the inverse square of its error ``2 rtol condition/diameter²`` and of the common scatter;
    residuals above two standard deviations weigh less.  The standard error is the scatter times
    √(number of coefficients/(n - 3)), n points, since their quadruples are not independent.

    `exists` means: at least 5 quadruples, of which at most one in twenty has no value (graphs branch); a scatter below
    1/4 of 1/radius² (at a cone it is about 1.5 times the missing angle over radius²); and convex quadrilaterals that
    agree with triangles with an inner point within two scatters (in a flat space of higher dimension the former
    have negative values, the latter positive ones).

    References
    ----------
    .. [1] A. Wald, "Begründung einer koordinatenlosen Differentialgeometrie der Flächen", 1936; Definition 3.4.
    .. [2] W. A. Kirk, "On curvature of a metric space at a point", Pacific J. Math. 14 (1964); Definition 6.5.

    Examples
    --------
    >>> from rinow import SpaceForm
    >>> sphere = SpaceForm(4.0)
    >>> P = sphere.sample(20, 0.3, np.random.default_rng(7))
    >>> curvature = wald_curvature(sphere.distance(P[:, None], P), 0, radius=0.6)
    >>> round(curvature.value, 6), curvature.n_quadruples, curvature.n_without_value, curvature.exists
    (4.0, 4845, 0, True)

    Space has no Wald curvature, but a modified one:

    >>> grid = np.indices((5, 5, 5)).reshape(3, -1).T
    >>> wald_curvature(grid, 62, radius=2.5).exists
    False
    >>> modified = wald_curvature(grid, 62, radius=2.5, kind="modified")
    >>> abs(modified.value) < 1e-9, modified.exists
    (True, True)
    """
    if kind not in ("wald", "modified"):
        raise InvalidInputError(f'kind = {kind!r} is unknown; choose "wald" or "modified".')
    ball = region(space, point, radius, size=MAX_POINTS, rtol=rtol)
    Q = _all_quadruples(len(ball.indices)) if kind == "wald" else _side_quadruples(ball.distances, ball.rtol)
    if len(Q) > MAX_QUADRUPLES:
        rng = np.random.default_rng(0) if rng is None else rng
        Q = Q[np.sort(rng.choice(len(Q), MAX_QUADRUPLES, replace=False))]
    found = embedding_curvatures(_six_distances(ball.distances, Q))
    n_quadruples, n_without = int((found.count >= 0).sum()), int((found.count == 0).sum())
    some = found.count > 0
    if not some.any():
        return WaldCurvature(np.nan, np.nan, n_quadruples, n_without, False, radius)
    found = EmbeddingCurvatures(found.values[some], found.count[some], found.kind[some], found.condition[some])
    limit = _limit(ball.distances, Q[some], found, ball.rtol)
    exists = n_quadruples >= FEWEST and n_without <= WITHOUT_VALUE * n_quadruples
    exists &= limit.scatter * radius**2 < SCATTER and limit.contrast < CONTRAST
    return WaldCurvature(limit.value, limit.standard_error, n_quadruples, n_without, bool(exists), radius)


def _all_quadruples(n: int) -> Indices:
    """Four different points in every way, ascending."""
    return np.array(list(combinations(range(n), 4)), np.intp).reshape(-1, 4)


def _side_quadruples(D: Floats, rtol: float) -> Indices:
    """Four different points of which one lies between two others."""
    points = np.arange(len(D))
    between = [np.argwhere(np.triu(d[:, None] + d - D <= rtol * D)) for d in D]
    triples = np.array([(v, i, j) for v, pairs in enumerate(between) for i, j in pairs if v not in (i, j)], np.intp)
    triples = triples.reshape(-1, 3)
    Q = np.column_stack([np.repeat(triples, len(D), axis=0), np.tile(points, len(triples))])
    Q = np.sort(Q, axis=1)
    return np.unique(Q[(np.diff(Q, axis=1) > 0).all(axis=1)], axis=0)


def _six_distances(D: Floats, Q: Indices) -> Floats:
    """(n, 6): the distances of the quadruples."""
    i, j = np.triu_indices(4, 1)
    return D[Q[:, i], Q[:, j]]


class _Limit(NamedTuple):
    """The limit with what decides whether it exists."""

    value: float
    standard_error: float
    scatter: float
    contrast: float
    """Difference of the middle convex quadrilateral and the middle triangle with an inner point, over the scatter."""


def _limit(D: Floats, Q: Indices, found: EmbeddingCurvatures, rtol: float) -> _Limit:
    """The curvature at point 0 from quadruples that have one."""
    diameters = _six_distances(D, Q).max(axis=1)[:, None]
    errors = 2 * max(rtol, np.finfo(np.float64).eps) * found.condition / diameters**2
    design = _design(_chart(D)[Q])
    coefficients, nearest = _robust_fit(found.values, errors, design)
    chosen = (np.arange(len(Q)), nearest)
    error, kind = errors[chosen], found.kind[chosen]
    residual, weight = found.values[chosen] - design @ coefficients, 1 / error
    noise, typical = _weighted_median(error, weight), NORMAL * _weighted_median(np.abs(residual), weight)
    squares = 1 / (error**2 + typical**2)
    largest = max(typical, float((squares @ residual**2 / squares.sum()) ** 0.5))
    n_points, n_coefficients = len(np.unique(Q)), len(coefficients)
    known = 0.5 * (n_points - 2) * (n_points - 3)  # distances less the coordinates of plane points, up to motions
    unbiased = (known / max(known - n_coefficients, 0.5)) ** 0.5
    scatter = unbiased * float(np.hypot(largest, noise))
    middles = [_weighted_median(residual[kind == k], weight[kind == k]) for k in ("planar", "nonplanar")]
    contrast = abs(middles[0] - middles[1]) / (unbiased * np.hypot(typical, noise))
    standard_error = scatter * (n_coefficients / max(n_points - 3, 1)) ** 0.5
    return _Limit(float(coefficients[0]), standard_error, scatter, float(np.nan_to_num(contrast)))


def _robust_fit(values: Floats, errors: Floats, design: Floats) -> tuple[Floats, Indices]:
    """Coefficients of a linear model of one value of each row, and which; outliers weigh less (Huber)."""
    rows = np.arange(len(values))
    nearest: Indices = np.nanargmin(np.abs(values), axis=1)
    expected: Floats = np.full(len(values), _weighted_median(values[rows, nearest], 1 / errors[rows, nearest]))
    coefficients: Floats = np.zeros(design.shape[1])
    for _ in range(STEPS):
        nearest = np.nanargmin(np.abs(values - expected[:, None]), axis=1)
        value, error = values[rows, nearest], errors[rows, nearest]
        scatter = NORMAL * _weighted_median(np.abs(value - expected), 1 / error)
        weights = 1 / np.hypot(error, scatter)
        weights *= np.sqrt(HUBER / np.maximum(np.abs(value - expected) * weights, HUBER))
        coefficients = np.asarray(np.linalg.lstsq(design * weights[:, None], value * weights)[0], np.float64)
        expected = design @ coefficients
    return coefficients, nearest


def _design(X: Floats) -> Floats:
    """(n, 1) or (n, 4): 1, centroid and mean square of quadruples of plane points, each column scaled to 1."""
    columns = [np.ones(len(X))]
    if len(np.unique(X.reshape(-1, 2), axis=0)) >= FEWEST_POINTS:
        columns += [*X.mean(axis=1).T, (X**2).sum(axis=2).mean(axis=1)]
    design = np.column_stack(columns)
    return design / np.maximum(np.abs(design).max(axis=0), np.finfo(np.float64).tiny)


def _chart(D: Floats) -> Floats:
    """(n, 2): coordinates of the points around the first one, by classical scaling."""
    gram = 0.5 * (D[0][:, None] ** 2 + D[0] ** 2 - D**2)
    squares, axes = np.linalg.eigh(gram)
    return axes[:, -2:] * np.sqrt(np.maximum(squares[-2:], 0.0))


def _weighted_median(x: Floats, weights: Floats) -> float:
    """The value that half of the weight is below; nan for none."""
    if not len(x):
        return np.nan
    order = np.argsort(x, kind="stable")
    below = np.cumsum(weights[order])
    return float(x[order[np.searchsorted(below, 0.5 * below[-1])]])
