"""The state of an anytime comparison: what is proved from below, what was measured from above."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rinow import tolerances
from rinow.comparison.engine import BIJECTION, Engine

__all__ = ["Interval", "next_difference"]

Indices = NDArray[np.intp]


class Interval:
    """Bounds of the least level of a relation, the relation that has the upper one, and what proved the lower one."""

    def __init__(
        self, pairs: Indices, upper: float, *, lower: float = 0.0, rtol: float = 0.0, verify: bool = False
    ) -> None:
        self.pairs, self.upper = pairs, upper
        self.lower, self.by = lower, "non-negativity"
        self.proof_checked: bool | None = None  # None if the lower bound needs no solver
        self.rtol, self.verify = rtol, verify

    @property
    def closed(self) -> bool:
        """Whether the interval is as short as was asked for."""
        return self._within(max(self.rtol, tolerances.EXACT))

    @property
    def exact(self) -> bool:
        """Whether the bounds are equal, up to the rounding of isometries that a proof used."""
        return self._within(tolerances.EXACT)

    def _within(self, share: float) -> bool:
        """Whether the width is at most a share of the upper bound, which may be infinite."""
        return self.lower == self.upper or self.upper - self.lower <= share * self.upper < math.inf

    @property
    def wanted(self) -> float:
        """Level whose refutation closes the interval."""
        return min(float(np.nextafter(self.upper, -math.inf)), self.upper * (1.0 - self.rtol))

    def raise_lower(self, value: float, by: str, proof_checked: bool | None = None) -> None:
        """Take a better lower bound; values above the upper bound are its rounding."""
        if value > self.lower:
            self.lower, self.by, self.proof_checked = min(value, self.upper), by, proof_checked

    def refuted(
        self, level: float, engine: Engine, by: str, error: float = 0.0, proof_checked: bool | None = None
    ) -> None:
        """Take note that no relation fits a level: the bound is the next level that two distances can have.

        It is lower by the error of a proof that used isometries up to rounding.
        """
        self.raise_lower(min(next_difference(engine, level), self.upper) - error, by, proof_checked)

    def offer(self, pairs: Indices, value: float) -> bool:
        """Take a relation if it is better than the best one."""
        if value >= self.upper:
            return False
        self.pairs, self.upper = pairs, value
        self.lower = min(self.lower, value)
        return True


def next_difference(engine: Engine, level: float) -> float:
    """Least discrepancy of a distance of X and one of Y that is above a level; inf if there is none."""
    return float(np.nextafter(level, math.inf)) if engine.kind == BIJECTION else engine.levels.above(level)
