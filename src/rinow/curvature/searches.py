"""Searches: centres of patches look for order, radius and chart by themselves."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.centres import members_of_discs
from rinow.curvature.charts import Choice
from rinow.curvature.patch_tasks import Tasks
from rinow.curvature.scale import Ladder, curvedness_of, select
from rinow.kernels import balls

__all__ = ["BESIDE", "INSIDE", "OF_GAUSSIAN", "Centres", "Found", "Search", "look"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Rows = NDArray[np.intp] | NDArray[np.bool_]

NARROW = 5
"""Another time only so many radii more and less than that chosen are looked at."""
PASSES = 2
"""Averages of squared differences over the centres around."""
OF_GAUSSIAN = 0.8
"""Squared error of K over that of K and H together if k1 and k2 err alike: k2 dk1 + k1 dk2 has four times the variance
of the curvedness times (dk1 + dk2)/2."""
ALIKE = 8.0
"""Ratio of risks up to which fits in both charts are blended: beyond it the lesser has nearly all the weight."""


class Search(NamedTuple):
    """How often centres look for order and radius, and by biases how far around.

    Each round starts from frames of the fits chosen before; `around` is in radii a patch covers.
    """

    rounds: int
    around: float


INSIDE, BESIDE = Search(1, 2.2), Search(2, 4.5)
"""Centres inside and beside a boundary; there they lie in a strip and their first frames are poor."""


class Centres(NamedTuple):
    """Vertices that patches lie around, and by row what is known of each before a search.

    `core` are the radii that patches cover, `low` and `high` the radii and `top` the orders to look at, `noise` is its
    variance, `curvedness` that of the tori.
    """

    vertices: Ints
    core: Floats
    low: Ints
    high: Ints
    top: Ints
    noise: Floats
    curvedness: Floats

    def at(self, rows: Rows) -> Self:
        """Some of them."""
        return self._make(column[rows] for column in self)


class Found(NamedTuple):
    """Frames, choice and, of centres that have searched, the least risk around over their own."""

    frames: Floats
    choice: Choice
    least: Floats

    def at(self, rows: Rows) -> Found:
        """Some of them."""
        return Found(self.frames[rows], self.choice.at(rows), self.least[rows])

    def put(self, rows: NDArray[np.intp], found: Found) -> None:
        """Take over, in place, what some of them found."""
        self.frames[rows], self.least[rows] = found.frames, found.least
        for column, values in zip(self.choice, found.choice, strict=True):
            column[rows] = values


def look(
    search: Search, sheet: balls.Sheet, ladder: Ladder, centres: Centres, start: Found, tasks: Tasks, share: float
) -> Found:
    """What centres find that start from some frames and choices, in the charts of these, a share of the work each."""
    if not len(centres.vertices):
        return start
    frames, choice, low, high = start.frames, start.choice, centres.low, centres.high
    is_level: NDArray[np.bool_] = np.all(frames[:, 9:] == 0.0, axis=1)
    links = members_of_discs(sheet, centres.vertices, centres.vertices, search.around * centres.core)
    tasks.part = share * len(frames) / search.rounds
    for _ in range(search.rounds):
        frames = ladder.frames(sheet, centres.vertices, frames, choice, tasks, is_level)
        bend = np.where(is_level, centres.curvedness, curvedness_of(frames))
        window = low, high, centres.top, centres.noise
        found = select(sheet, ladder, centres.vertices, frames, bend, window, links, PASSES, tasks)
        choice = found._replace(risk=OF_GAUSSIAN * found.risk)
        has_fit = found.radius >= 0
        low = np.where(has_fit, np.maximum(low, found.radius - NARROW), low)
        high = np.where(has_fit, np.minimum(high, found.radius + NARROW), high)
    tasks.part = 1.0
    with np.errstate(invalid="ignore"):
        least = np.minimum.reduceat(choice.risk[links[1]], links[0][:-1]) / choice.risk
    return Found(frames, choice, least)


def blended(here: Found, there: Found, is_open: NDArray[np.bool_]) -> tuple[Found, NDArray[np.intp]]:
    """What was found in one chart, then what in the other promises an error like that, and the rows of both.

    Charts err differently: two fits that differ show an error that neither of them does, and together err less.  The
    least risk around is that in either chart, so that of two patches at one place the better one weighs much more.
    """
    with np.errstate(invalid="ignore"):
        is_alike = is_open & (there.choice.radius >= 0) & (there.choice.risk < ALIKE * here.choice.risk)
        around = np.fmin(here.least * here.choice.risk, np.where(is_alike, there.least * there.choice.risk, np.nan))
        parts = [found._replace(least=around / found.choice.risk) for found in (here, there)]
    also = np.flatnonzero(is_alike)
    rows = np.concatenate([np.arange(len(is_open)), also])
    one, other = parts[0], parts[1].at(also)
    radius, order = (np.concatenate([a, b]) for a, b in zip(one.choice[:2], other.choice[:2], strict=True))
    choice = Choice(radius, order, np.concatenate([one.choice.risk, other.choice.risk]))
    return Found(np.concatenate([one.frames, other.frames]), choice, np.concatenate([one.least, other.least])), rows
