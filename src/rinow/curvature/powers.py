"""Powers of a step of averaging, and polynomials in them: the estimates of all scales and orders."""

from __future__ import annotations

from math import comb

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.flow import CurvatureFlow

__all__ = ["LADDER", "ORDER", "REFERENCE", "Powers", "combination"]

Floats = NDArray[np.float64]

LADDER = (0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)
"""Numbers of steps m that compete."""
REFERENCE = {1: 1, 2: 1, 3: 2} | {m: LADDER[LADDER.index(m) - 2] for m in LADDER[4:]}
"""The smaller number of steps that the bias is seen against: half of m."""
ORDER = 3
"""Highest order."""
NEEDED = frozenset(j * m for m in LADDER for j in range(1, ORDER + 2))
"""Numbers of steps that some candidate consists of."""


def combination(m: int, order: int) -> dict[int, float]:
    """Coefficients of I - (I - S^m)^order as a polynomial in S: {m: order, 2m: -order(order-1)/2, ...}."""
    return {m * j: float((-1) ** (j + 1) * comb(order, j)) for j in range(1, order + 1)}


class Powers:
    """S^m K for the numbers of steps asked for in ascending order; what is no longer needed is forgotten."""

    def __init__(self, flow: CurvatureFlow, start: Floats) -> None:
        self._flow, self._last = flow, 0
        self._kept = {0: start}

    def __getitem__(self, m: int) -> Floats:
        if m not in self._kept:
            current = self._kept[self._last]
            for i in range(self._last + 1, m + 1):
                current = self._flow.step(current)
                if i in NEEDED:
                    self._kept[i] = current
            self._kept[m], self._last = current, m
        return self._kept[m]

    def combined(self, coefficients: dict[int, float]) -> Floats:
        """Sum of coefficient times S^m K."""
        return sum((c * self[m] for m, c in sorted(coefficients.items())), np.zeros(1))

    def forget(self, below: int) -> None:
        """Drop powers that no candidate of at least `below` steps needs."""
        needed = {j * m for m in LADDER if m >= below for j in range(1, ORDER + 1)} | {self._last}
        needed |= {j * REFERENCE[m] for m in LADDER if m >= max(below, 1) for j in range(1, ORDER + 2)}
        self._kept = {m: values for m, values in self._kept.items() if m in needed}
