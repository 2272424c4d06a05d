"""The levels that count: differences of a distance of X and one of Y.

The distortion of a relation is one of them.  Where they are few, as for numbers of steps in graphs, a search goes from
one to the next: nothing is gained between two of them.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["Levels"]

Floats = NDArray[np.float64]


class Levels:
    """Differences of the distances of two spaces, without listing them all."""

    def __init__(self, DX: Floats, DY: Floats) -> None:
        self._a, self._b = np.unique(DX), np.unique(DY)

    @property
    def few(self) -> bool:
        """Whether both spaces have so few distances that differences are far apart."""
        return len(self._a) * len(self._b) <= 10_000

    def above(self, level: float) -> float:
        """Least difference above a level; inf if there is none."""
        gaps = self._near(level)
        return float(gaps[gaps > level].min(initial=math.inf))

    def up_to(self, level: float) -> float:
        """Greatest difference that is not above a level, which is at least 0; -inf if there is none."""
        gaps = self._near(level)
        return float(gaps[gaps <= level].max(initial=-math.inf))

    def _near(self, level: float) -> Floats:
        """Differences among which are the nearest ones on both sides of a level."""
        gaps: list[Floats] = []
        for side in (level, -level):
            place = np.searchsorted(self._b, self._a + side)
            for shift in (-2, -1, 0, 1):
                gaps.append(np.abs(self._a - self._b[np.clip(place + shift, 0, len(self._b) - 1)]))
        return np.concatenate(gaps)
