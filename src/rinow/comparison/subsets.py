"""Lower bounds from maps of finite subsets: they hold for whole spaces of which only nets are known.

Let A be a finite subset of X, and B a subset of Y that comes within r of every point of Y.  A correspondence of X and Y
of distortion δ gives every a in A a partner in Y; let f(a) be a point of B within r of it.  Two of these distances
differ from those of the partners by at most 2r, so dis f <= δ + 2r, and

    2 d_GH(X, Y) >= min over maps f: A → B of dis f  -  2r.

The covering radius of A does not enter: A need not be a net.  So the bound of a circle and a sphere costs the fineness
of the circle alone.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rinow import tolerances
from rinow.comparison.clock import Clock
from rinow.comparison.engine import MAP, Engine, worst_of
from rinow.comparison.interval import Interval
from rinow.comparison.large_work import farthest_points
from rinow.comparison.satisfiability import Satisfiability, solver_installed
from rinow.comparison.steps import bisect_by_consistency
from rinow.comparison.symmetry import Isometries, isometries

__all__ = ["SubsetBound", "bound_by_subsets", "spread_points", "sum_to_opposite"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

SIZES = ((8, 24), (13, 24), (20, 36), (30, 36), (30, 50), (45, 72), (60, 100), (90, 150), (135, 200), (200, 300))
"""Points of A and of B, from round to round; all points of Y where they are not many more."""

FEW = 1.5
"""All points of Y serve as B up to this multiple of the number asked for."""

POOL = 400
"""Farthest points of a space among which A is chosen."""

OPPOSITE = 0.15
"""Opposite points are found up to this share of the diameter: nets hold them only roughly."""

STEP, NARROW, LEAST_RISE = 0.25, 0.03, 0.005
"""Share of the open interval by which the next level is higher; shares of its upper end at which it is left, or a rise
is not worth a proof."""

ROUND, PROBE = 0.7, 0.5
"""Share of the time left for one pair of subsets, and of that for one level."""


class SubsetBound:
    """Maps from a subset A of one space to a net B of the other: an interval for their least distortion."""

    def __init__(self, DA: Floats, DB: Floats, at_least: float, *, verify: bool = False) -> None:
        self.engine = Engine(DA, DB, MAP, both=False)
        f = self.engine.row_levels.argmin(axis=1)
        maps = [np.stack([np.arange(len(DA)), image], axis=1) for image in (f, np.zeros(len(DA), np.intp))]
        pairs = min(maps, key=self.engine.worst_of)
        value = self.engine.worst_of(pairs)
        self.interval = Interval(pairs, value, lower=min(at_least, value), verify=verify)
        self._symmetries: tuple[Isometries, Isometries] | None = None

    def improve(self, clock: Clock) -> None:
        """Raise the lower end by arc consistency, then by a clause-learning solver at rising levels.

        A level that takes too long is given up for one nearer to what is proved.
        """
        interval, step = self.interval, STEP
        interval.raise_lower(self.engine.row_bound, "sorted distances")
        bisect_by_consistency(self.engine, interval, clock.part(0.3 * clock.left))
        while solver_installed() and not clock.over:
            rise = step * (interval.upper - interval.lower)
            if interval.upper - interval.lower <= NARROW * interval.upper or rise <= LEAST_RISE * interval.upper:
                return
            if not self._probe(interval.lower + rise, clock):
                step *= 0.5

    def _probe(self, level: float, clock: Clock) -> bool:
        """Decide one level; whether that succeeded."""
        interval, engine, probing = self.interval, self.engine, clock.part(PROBE * clock.left)
        left = engine.consistent(level, probing)
        if left is None:
            interval.refuted(level, engine, "arc consistency")
            return True
        if self._symmetries is None:
            trivial = Isometries(np.arange(len(engine.DX))[None], 0.0)
            self._symmetries = trivial, isometries(engine.DY, probing)
        with Satisfiability(engine, left, level, probing, self._symmetries, verify=interval.verify) as solver:
            refuted, pairs = solver.run(probing)
            accepted = refuted and solver.refutes(interval, clock)
        if pairs is not None:
            interval.offer(pairs, worst_of(MAP, engine.DX, engine.DY, pairs))
        return accepted or pairs is not None


def bound_by_subsets(
    DX: Floats, DY: Floats, radii: tuple[float, float], lower: float, clock: Clock, *, verify: bool = False
) -> tuple[float, bool | None]:
    """Lower bound of twice the distance of two spaces that lie within the given radii of the points of DX and DY.

    Larger and larger subsets are mapped, both ways, until the time is over; `lower` is a bound that is known.  The
    second value is that of `Interval.proof_checked`.
    """
    proof_checked = None
    opposites = abs(sum_to_opposite(DX) - sum_to_opposite(DY)) <= OPPOSITE * max(DX.max(), DY.max())
    sequences = [spread_points(D, SIZES[-1][0], opposites=opposites) for D in (DX, DY)]
    nets = [farthest_points(D, SIZES[-1][1]) for D in (DX, DY)]
    finished: set[tuple[int, int, int]] = set()
    for k, m in SIZES:
        for way, (D, E, radius) in enumerate(((DX, DY, radii[1]), (DY, DX, radii[0]))):
            A, B = sequences[way][:k], nets[1 - way][:m] if len(E) > FEW * m else np.arange(len(E))
            loss = 2.0 * (radius + float(E[B].min(axis=0).max()))
            DA = D[np.ix_(A, A)]
            if clock.over or (way, len(A), len(B)) in finished or DA.max() - loss <= lower:
                continue
            bound = SubsetBound(DA, E[np.ix_(B, B)], lower + loss, verify=verify)
            bound.improve(clock.part(ROUND * clock.left))
            if bound.interval.lower - loss > lower:
                lower, proof_checked = bound.interval.lower - loss, bound.interval.proof_checked
            finished.add((way, len(A), len(B)))
    return lower, proof_checked


def spread_points(D: Floats, k: int, *, opposites: bool) -> Indices:
    r"""Up to k points with few that the others make superfluous, beginning with the ends of a diameter.

    Each is farthest from those before it.  Where points of both spaces have opposites,
    :math:`d(x, z) + d(x', z) = c` for all z with one c, the opposite of an image of x is an image of x' without more
    distortion.  So only one of the two is taken.
    """
    pool = farthest_points(D, POOL)
    P = D[np.ix_(pool, pool)]
    chosen, novelty = [0], P[0].copy()
    if opposites:
        novelty = np.minimum(novelty, _from_opposite(P, 0))
    while len(chosen) < k and novelty.max() > tolerances.COMPARISON * P.max():
        a = int(novelty.argmax())
        chosen.append(a)
        np.minimum(novelty, P[a], out=novelty)
        if opposites:
            np.minimum(novelty, _from_opposite(P, a), out=novelty)
        novelty[a] = 0.0
    return pool[chosen]


def sum_to_opposite(D: Floats) -> float:
    """The sum of the distances from a point and its opposite one, if every point has one, roughly; else nan."""
    pool = farthest_points(D, POOL // 2)
    P = D[np.ix_(pool, pool)]
    if any(_from_opposite(P, a).min() > OPPOSITE * P.max() for a in range(len(P))):
        return math.nan
    return float(P.max(axis=1).mean())


def _from_opposite(D: Floats, a: int) -> Floats:
    """How far each point is from being opposite to a: half the range of the sums of the distances from both."""
    sums = D + D[a]
    return 0.5 * (sums.max(axis=1) - sums.min(axis=1))
