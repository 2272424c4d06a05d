"""The Lipschitz distance of finite metric spaces, and the dilatation of maps."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import as_indices
from rinow._printing import OneLine
from rinow.comparison import steps
from rinow.comparison.affine_bijections import offer_affine_bijections
from rinow.comparison.bounds import matching_bound
from rinow.comparison.clock import Clock
from rinow.comparison.engine import BIJECTION, Engine, worst_of
from rinow.comparison.interval import Interval
from rinow.comparison.large_bijections import offer_bijections
from rinow.errors import InvalidInputError
from rinow.kernels import distortion
from rinow.kernels.compatibility import sorted_ratio
from rinow.metric_space import MetricSpace, both_distances

__all__ = ["LipschitzDistance", "MetricSpace", "as_map", "dilatation", "infinitely_far", "lipschitz_distance"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

AFFINE = 0.2
"""Share of the time for bijections near affine maps, which come first."""

SEARCHED, OFFERED = 1500, 0.5
"""Points of spaces whose bijections are searched: one step of a search is cubic, and looks at no clock.  Beyond that
some are found by assignment, in this share of the time."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LipschitzDistance(OneLine):
    """Bounds of a Lipschitz distance with their certificates.

    Attributes
    ----------
    lower, upper : float
        The distance lies between them; a number without unit, inf for spaces of unequal size.
    exact : bool
        Whether the two are equal, up to 1e-12.
    bijection : (n,) ndarray of int
        Image of each point of X; `upper` is the logarithm of the larger dilatation of this map and its inverse.  Empty
        for spaces of unequal size.
    lower_bound_by : str
        What proved `lower`: "non-negativity", "size", "eccentricities", "sorted distances", "matching", "arc
        consistency", "search" or "satisfiability".
    proof_checked : bool or None
        Whether the proof that a clause-learning solver gave for `lower` was checked; None if `lower` needs none.
    """

    lower: float
    upper: float
    exact: bool
    bijection: Indices
    lower_bound_by: str
    proof_checked: bool | None = None


def lipschitz_distance(X: Any, Y: Any, *, time_limit: float = 60.0, verify: bool = False) -> LipschitzDistance:
    r"""Lipschitz distance: how much the distances must be stretched to turn one space into the other.

    The least value of :math:`\log\max(\mathrm{dil} f, \mathrm{dil} f^{-1})` over the bijections f: X → Y.

    Parameters
    ----------
    X, Y : MetricSpace or (n, n) array_like of float
        Two finite metric spaces, or their distance matrices.
    time_limit : float, default 60
        Seconds after which the search stops with the bounds reached so far; with 0 the bounds that cost no search.
        One step may overrun it by some tenths of a second.  Bijections of more than 1500 points are not searched: some
        are found by assigning points at nearly the same place, or whose distances from a few matched points agree.
    verify : bool, default False
        Have the clause-learning solver write down its proof, and check it: that takes two or three times as long
        as finding it.  A refutation with a wrong proof is not used.

    Returns
    -------
    result : LipschitzDistance
        `lower` and `upper`, `exact` if they are equal, `bijection` that has `upper`, `lower_bound_by`, `proof_checked`.
        Both bounds are inf for spaces of unequal size, and if coincident points (distance 0) of the one do not fit
        those of the other; `upper` is inf as long as no bijection is known that fits them.

    Raises
    ------
    InvalidInputError
        If an argument is not a space, is empty, the limit is negative or nan, or two distances differ by a factor
        above 1e308.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    dilatation : Recomputes the certificate of `upper`.
    gromov_hausdorff : The distance for spaces of any size.

    Notes
    -----
    The engine of `gromov_hausdorff`, with pairs (x, y), (x', y') compatible when the ratio of their distances is at
    most the level both ways.  The sorted distances from x and from its image agree within that ratio, which leaves
    few images to begin with; a perfect matching must exist among them.  For finite spaces the distance is 0 exactly
    for isometric ones [1]_, Section 7.2.

    References
    ----------
    .. [1] D. Burago, Y. Burago, S. Ivanov, "A Course in Metric Geometry", 2001.

    Examples
    --------
    A path of three edges, and the same path with its last edge doubled:

    >>> X = [[0, 1, 2, 3], [1, 0, 1, 2], [2, 1, 0, 1], [3, 2, 1, 0]]
    >>> Y = [[0, 1, 2, 4], [1, 0, 1, 3], [2, 1, 0, 2], [4, 3, 2, 0]]
    >>> result = lipschitz_distance(X, Y)
    >>> result.exact, round(result.upper, 6), result.bijection
    (True, 0.693147, array([0, 1, 2, 3]))
    """
    clock = Clock.of(time_limit)
    DX, DY = both_distances(X, Y)
    if len(DX) != len(DY):
        return infinitely_far()
    _check_ratios(DX, DY)
    interval = _first_interval(DX, DY, verify=verify)
    offer_affine_bijections(DX, DY, interval, clock.part(AFFINE * clock.left))
    if len(DX) > SEARCHED:
        offer_bijections(DX, DY, interval, clock.part(OFFERED * clock.left))
    if not interval.closed and not clock.over:
        engine = Engine(DX, DY, BIJECTION, clock=clock)
        interval.raise_lower(engine.row_bound, "sorted distances")
        if not clock.over:
            interval.raise_lower(matching_bound(engine.row_levels, clock), "matching")
        if len(DX) <= SEARCHED:
            steps.close(engine, interval, clock)
    f = np.empty(len(DX), np.intp)
    f[interval.pairs[:, 0]] = interval.pairs[:, 1]
    lower, upper = math.log(interval.lower), math.log(interval.upper)
    return LipschitzDistance(lower, upper, interval.exact, f, interval.by, interval.proof_checked)


def infinitely_far() -> LipschitzDistance:
    """The distance of spaces of unequal size."""
    return LipschitzDistance(math.inf, math.inf, True, np.empty(0, np.intp), "size")


def _check_ratios(DX: Floats, DY: Floats) -> None:
    """Ratios of distances that are not 0 must be finite."""
    least = min(float(D.min(initial=np.inf, where=D > 0.0)) for D in (DX, DY))
    greatest = float(max(DX.max(), DY.max()))
    if greatest / float(np.finfo(np.float64).max) > least:
        raise InvalidInputError(
            f"distances of X and Y reach from {least:.3g} to {greatest:.3g}, a ratio without a number; scale a space."
        )


def _first_interval(DX: Floats, DY: Floats, *, verify: bool) -> Interval:
    """The better one of the identity and the map that keeps the order of the mean distances.

    From below the eccentricities, in order, differ by the factor at most: the list of one space is that of the images.
    """
    by_mean = np.argsort(DX.mean(axis=1), kind="stable"), np.argsort(DY.mean(axis=1), kind="stable")
    maps = [np.stack(by_mean, axis=1), np.repeat(np.arange(len(DX))[:, None], 2, axis=1)]
    values = [worst_of(BIJECTION, DX, DY, pairs) for pairs in maps]
    best = int(np.argmin(values))
    interval = Interval(maps[best], max(values[best], 1.0), lower=1.0, verify=verify)
    ratio = float(sorted_ratio(np.sort(DX.max(axis=1)), np.sort(DY.max(axis=1))))
    interval.raise_lower(ratio, "eccentricities")
    return interval


def dilatation(f: ArrayLike, X: Any, Y: Any) -> float:
    """Dilatation of a map: the largest ratio of the distance of two images to that of the points.

    Parameters
    ----------
    f : (n,) array_like of int
        Index of the image in Y of each point of X.
    X, Y : MetricSpace or square array_like of float
        The spaces, of n and m points.

    Returns
    -------
    dilatation : float
        At least 0; inf where coincident points have images apart, 0 for a constant map.

    Raises
    ------
    InvalidInputError
        If `f` has another length than X, or an index is out of range.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    distortion, lipschitz_distance

    Notes
    -----
    The map is Lipschitz with this constant and no smaller one; it is bi-Lipschitz with the constants 1 / dil(f⁻¹) and
    dil(f).  dil(g ∘ f) <= dil(g) dil(f) for f: X → Y and g: Y → Z, which the paper prints for maps of other spaces.

    Examples
    --------
    >>> dilatation([0, 2, 1], [[0, 1, 2], [1, 0, 1], [2, 1, 0]], [[0, 1, 2], [1, 0, 1], [2, 1, 0]])
    2.0
    """
    DX, DY = both_distances(X, Y)
    image = as_map(f, len(DX), len(DY))
    stretches = np.empty(len(DX))
    distortion.largest_stretches(DX, DY, image, stretches)
    return float(stretches.max())


def as_map(f: ArrayLike, n: int, m: int) -> Indices:
    """One index below m for each of n points."""
    image = as_indices(f, m, "f")
    if image.shape != (n,):
        raise InvalidInputError(f"f has shape {image.shape}; give one image for each of the {n} points of X.")
    return image
