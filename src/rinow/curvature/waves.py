"""Averages of all scales and orders, by waves that run as far as the ball averaged over reaches."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.flow import CurvatureFlow
from rinow.kernels import smoothing

__all__ = ["LADDER", "ORDER", "REFERENCE", "Waves", "passed", "window"]

Floats = NDArray[np.float64]

LADDER = (0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)
"""Scales m that compete: each leaves as much noise as m steps S do, with an order as much as 1 - (1 - S^m)^order."""
REFERENCE = {1: 1, 2: 1, 3: 2} | {m: LADDER[LADDER.index(m) - 2] for m in LADDER[4:]}
"""The smaller scale that the bias is seen against: half of m."""
ORDER = 3
"""Highest order."""
REACH = (2.44, 3.16, 3.88, 4.54)
"""Waves of a window of the orders 1 to 4 over the root of its scale."""
POWER = 3.5
"""Of the window (1 - x²)^3.5, the ball with the weights (1 - r²)³ seen from the side."""
LEAST = -0.35
"""Eigenvalues of S lie between this and 1: the mean of three equal values in a row takes -1/3 of alternating ones, as
on grids of long triangles.  Waves grow with what lies beyond, to 1e16 there if this is -0.1."""
KEPT = 8
"""Waves that are kept for the next windows; the others are computed anew, since each takes the memory of a result."""


@cache
def window(scale: int, order: int) -> Floats:
    """(n,): coefficients of the waves whose sum is the average of this scale and order."""
    reach = REACH[order - 1] * np.sqrt(scale)
    x = (np.arange(max(np.ceil(reach), 1.0)) / max(reach, 1.0)) ** 2
    weights = (1.0 - x) ** POWER
    weights[1:] *= 2.0
    terms = np.vander(x, order if scale else 1, increasing=True)
    moments = terms.T * weights @ terms
    return weights * (terms @ np.linalg.solve(moments, np.eye(len(moments))[0]))


def passed(coefficients: Floats, step: Floats) -> Floats:
    """The factor that a sum of waves leaves of a function with the factor `step` under S."""
    angles = np.arccos(np.clip((2.0 * step - 1.0 - LEAST) / (1.0 - LEAST), -1.0, 1.0))
    return np.cos(np.multiply.outer(angles, np.arange(len(coefficients)))) @ coefficients


class Waves:
    r"""Windowed sums of the waves :math:`T_j(X) K` that start from K, for Chebyshev's polynomials T and a step S.

    Notes
    -----
    X is S with its eigenvalues stretched from `LEAST`..1 to -1..1.  If S takes the factor
    :math:`1 - \sigma^2 k^2/2` of a function of frequency k, :math:`T_j(X)` takes :math:`\cos(jck)`, with
    :math:`c^2 = 2\sigma^2/(1 - LEAST)`: it moves K by the distance jc in all directions, as a wave.  A kernel is the
    sum of waves weighted by what it has over each line, whence a kernel that ends at the distance r takes r/c steps,
    and is known to end there; S^m reaches m steps for the same noise.
    """

    def __init__(self, flow: CurvatureFlow, start: Floats) -> None:
        self._flow = flow
        self.start = start
        self._kept = [np.where(flow.has_data, start, flow.step(start))]

    def sums(self, windows: Sequence[Floats]) -> list[Floats]:
        """Of each window the sum of coefficient times wave; nan for a vertex without data around it."""
        totals = [np.zeros(len(self.start)) for _ in windows]
        for j, wave in enumerate(self._first(max(len(c) for c in windows))):
            for total, c in zip(totals, windows, strict=True):
                if j < len(c):
                    smoothing.add_multiple(c[j], wave, total)
        return totals

    def _first(self, n: int) -> Iterator[Floats]:
        """The first n waves."""
        yield from self._kept[:n]
        last, current = self._kept[-2:] if len(self._kept) > 1 else (self._kept[0], self._kept[0])
        for j in range(len(self._kept), n):
            following = self._flow.step(current)
            smoothing.next_wave(current, last, LEAST, j == 1, following)
            last, current = current, following
            if j < KEPT:
                self._kept.append(current)
            yield current
