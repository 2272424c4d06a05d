"""Maps by relaxation: the matching that changes distances least in the mean, sought among fractional ones.

The mean square of |d(x, x') - d(y, y')| over the pairs of a matching is a quadratic function of its matrix, and makes
sense for every matrix of weights.  Conditional gradients (M. Frank, P. Wolfe, 1956) lead down: the best direction is a
matching, found by linear assignment.  Nothing is proved; it finds copies with noise of metrics that no space of few
dimensions holds, which a local search does not.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from rinow.comparison.clock import Clock

__all__ = ["relaxed_maps"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

STEPS = 40
"""Most steps from one start; most searches end at a matching before."""


def relaxed_maps(DX: Floats, DY: Floats, levels: Floats, clock: Clock) -> Iterator[tuple[Indices, Indices]]:
    """Maps f: X → Y and g: Y → X from two starts: all weights equal, and half way to the rows that agree best."""
    n, m = levels.shape
    scale = float(max(DX.max(), DY.max())) or 1.0
    X, Y = DX / scale, DY / scale
    equal = np.full((n, m), 1.0 / max(n, m))
    for start in (equal, 0.5 * (equal + _matching(levels))):
        if not clock.over:
            yield _maps(_descend(X, Y, start, clock), DX, DY)


def _descend(X: Floats, Y: Floats, P: Floats, clock: Clock) -> Floats:
    """Weights from which no matching leads down, or as far as the steps and the time reach."""
    squares_x, squares_y = X * X, Y * Y

    def change(A: Floats) -> Floats:
        return (squares_x @ A.sum(axis=1))[:, None] + squares_y @ A.sum(axis=0) - 2.0 * (X @ A @ Y)

    for _ in range(STEPS):
        gradient = 2.0 * change(P)
        step = _matching(gradient) - P
        slope, bend = float((gradient * step).sum()), float((change(step) * step).sum())
        if slope >= -1e-9 or clock.over:  # of the order of the number of points when it begins
            break
        P = P + step * (min(1.0, -slope / (2.0 * bend)) if bend > 0.0 else 1.0)
    return P


def _matching(costs: Floats) -> Floats:
    """The cheapest matching of the smaller side as a matrix of 0 and 1."""
    P = np.zeros_like(costs)
    P[linear_sum_assignment(costs)] = 1.0
    return P


def _maps(P: Floats, DX: Floats, DY: Floats) -> tuple[Indices, Indices]:
    """Both maps of the heaviest matching; points it leaves out take the image of the nearest one that it has."""
    xs, ys = linear_sum_assignment(P, maximize=True)
    f, g = ys[DX[:, xs].argmin(axis=1)], xs[DY[:, ys].argmin(axis=1)]
    f[xs], g[ys] = ys, xs  # also where points coincide
    return f, g
