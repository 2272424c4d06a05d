"""Wald curvature at a point: the limit of the embedding curvatures of small quadruples (3.4 and 6.5 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import as_number, in_safe_unit, in_unit
from rinow._printing import OneLine
from rinow.curvature.regions import region
from rinow.curvature.wald_limit import limit_at_first
from rinow.embedding.quadruple import EmbeddingCurvatures, embedding_curvatures
from rinow.errors import InvalidInputError

__all__ = ["WaldCurvature", "wald_curvature"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

MAX_QUADRUPLES = 20_000
FEWEST = 5
"""Quadruples that can support a limit: as many as five points have."""
SCATTER = 0.25
"""Scatter times radius² without a limit: 0.5 at a cone of angle 6 and 1.2 in space; on surfaces it is below 0.2."""
CONTRAST = 2.0
"""Contrast in a space of higher dimension: 5 in space, also for points of a surface with straight distances."""
WITHOUT_VALUE = 0.05
"""Share of quadruples without a value that noise explains: a graph has 0.2 and more."""


@dataclass(frozen=True, slots=True, repr=False)
class WaldCurvature(OneLine):
    """Wald curvature at a point.

    Attributes
    ----------
    value : float
        Limit of the embedding curvatures, in 1/length²; nan without a quadruple that has one.  `n_quadruples`
        is 0 where the ball holds too few points or, for modified curvature, no point between two others.
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
    max_points: int = 40,
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
        Radius of the ball, in the unit of the distances.
    kind : {"wald", "modified"}, default "wald"
        All quadruples, or those with a linear triple (up to `rtol`).
    rng : numpy.random.Generator, optional
        Chooses 20000 of more quadruples; ``default_rng(0)`` by default.
    rtol : float, optional
        Share by which a distance may be wrong.  By default 1e-12, and for a mesh an estimate of what its edges miss of
        the arcs of a smooth surface; 0 takes the mesh as the polyhedron it is.
    max_points : int, default 40
        Of more points in the ball this many are taken, each as far as possible from those before it.

    Returns
    -------
    curvature : WaldCurvature
        The limit with its standard error, and whether it exists.

    Raises
    ------
    InvalidInputError
        If `space` is none of these, `point` is out of range, `radius` is not positive or `kind` is unknown.
    NotAMetricError
        If a matrix is not a metric, or a graph is not connected.

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
    A quadruple weighs the inverse square of its error, about ``√2 rtol condition/diameter²``, and of the common
    scatter; residuals above two standard deviations weigh less.  The standard error is both, scatter and middle error,
    times √(number of coefficients/(n - 3)), n points, since their quadruples are not independent.

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
    radius = as_number(radius, "radius")
    ball = region(space, point, radius, size=max_points, rtol=rtol)
    D, exponent = in_safe_unit(ball.distances)
    Q = (_all_quadruples if kind == "wald" else _side_quadruples)(D, ball.rtol)
    if len(Q) > MAX_QUADRUPLES:
        rng = np.random.default_rng(0) if rng is None else rng
        Q = Q[np.sort(rng.choice(len(Q), MAX_QUADRUPLES, replace=False))]
    sixes = _six_distances(D, Q)
    found = embedding_curvatures(sixes)
    n_quadruples, n_without = int((found.count >= 0).sum()), int((found.count == 0).sum())
    some = found.count > 0
    if not some.any():
        return WaldCurvature(np.nan, np.nan, n_quadruples, n_without, False, radius)
    found = EmbeddingCurvatures(found.values[some], found.count[some], found.kind[some], found.condition[some])
    limit = limit_at_first(D, Q[some], found, _errors(sixes[some], found, ball.rtol))
    exists = n_quadruples >= FEWEST and n_without <= WITHOUT_VALUE * n_quadruples
    length = float(in_unit(radius, -exponent))
    exists &= limit.scatter * length * length < SCATTER and limit.contrast < CONTRAST
    value, error = (float(in_unit(x, -2 * exponent)) for x in (limit.value, limit.standard_error))
    return WaldCurvature(value, error, n_quadruples, n_without, bool(exists), radius)


def _all_quadruples(D: Floats, rtol: float) -> Indices:
    """Four different points in every way, ascending."""
    return np.array(list(combinations(range(len(D)), 4)), np.intp).reshape(-1, 4)


def _side_quadruples(D: Floats, rtol: float) -> Indices:
    """Four different points of which one lies between two others, ascending."""
    excess = D[:, :, None] + D[:, None, :] - D  # [v, i, j]: of i, v, j
    triples = np.argwhere(excess <= rtol * D)
    v, i, j = triples.T
    triples = triples[(i < j) & (v != i) & (v != j)]
    Q = np.column_stack([np.repeat(triples, len(D), axis=0), np.tile(np.arange(len(D)), len(triples))])
    Q = np.sort(Q, axis=1)
    return np.unique(Q[(np.diff(Q, axis=1) > 0).all(axis=1)], axis=0)


def _six_distances(D: Floats, Q: Indices) -> Floats:
    """(n, 6): the distances of the quadruples."""
    i, j = np.triu_indices(4, 1)
    return D[Q[:, i], Q[:, j]]


def _errors(sixes: Floats, found: EmbeddingCurvatures, rtol: float) -> Floats:
    """(n, 2): standard deviation of each value if distances are off by up to the share `rtol`, uniformly.

    Two values at the distance s are ± √(s²/4 + x), x linear in the distances: the linear error e, large where s is
    small, becomes √(s²/4 + s e) - s/2.
    """
    diameters = sixes.max(axis=1, keepdims=True)
    linear = 2**0.5 * max(rtol, np.finfo(np.float64).eps) * found.condition / diameters**2
    s = np.where(found.count == 2, found.values[:, 1] - found.values[:, 0], np.inf)[:, None]
    with np.errstate(invalid="ignore"):
        return np.where(np.isfinite(s), 2 * linear / (1 + np.sqrt(1 + 4 * linear / s)), linear)
