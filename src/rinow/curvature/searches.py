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

__all__ = ["Centres", "Found", "Search", "blended", "look", "search_both"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Rows = slice | NDArray[np.intp] | NDArray[np.bool_]

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

    def put(self, rows: Rows, found: Found) -> None:
        """Take over, in place, what some of them found."""
        self.frames[rows], self.least[rows] = found.frames, found.least
        for column, values in zip(self.choice, found.choice, strict=True):
            column[rows] = values


def look(
    search: Search, sheet: balls.Sheet, ladder: Ladder, centres: Centres, start: Found, tasks: Tasks, share: float
) -> Found:
    """What centres find that start from some frames and choices, in the charts of these, a share of the work each.

    The frames, which are large, are written in place.
    """
    frames, choice, low, high = start.frames, start.choice, centres.low, centres.high
    is_level: NDArray[np.bool_] = np.all(frames[:, 9:] == 0.0, axis=1)
    links = members_of_discs(sheet, centres.vertices, centres.vertices, search.around * centres.core)
    tasks.part = share * len(frames) / search.rounds
    for _ in range(search.rounds):
        frames[:] = ladder.frames(sheet, centres.vertices, frames, choice, tasks, is_level)
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


def search_both(
    sheet: balls.Sheet, ladder: Ladder, centres: Centres, charts: tuple[Found, Found], also: NDArray[np.intp],
    beside: NDArray[np.bool_], inside_too: bool, tasks: Tasks,
) -> None:  # fmt: skip
    """Let centres look in their chart, and those of the rows `also` in the other one, in place.

    Centres beside a boundary look, those inside on demand.
    """
    share = 1.0 / max(len(beside) + len(also), 1)
    for found, known, is_beside in ((charts[0], centres, beside), (charts[1], centres.at(also), beside[also])):
        for search, is_own in ((INSIDE, ~is_beside & inside_too), (BESIDE, is_beside)):
            if is_own.any():
                rows = slice(None) if is_own.all() else np.flatnonzero(is_own)  # a view of all costs no memory
                found.put(rows, look(search, sheet, ladder, known.at(rows), found.at(rows), tasks, share))
        found.least[~is_beside] = 1.0  # inside many patches cover a vertex


def blended(here: Found, there: Found, also: NDArray[np.intp]) -> tuple[Found, NDArray[np.intp]]:
    """What was found in one chart, then what in the other one promises an error like that, and the rows of both.

    Charts err differently: two fits that differ show an error that neither of them does, and together err less.  The
    least risk around is that in either chart, so that of two patches at one place the better one weighs much more.
    """
    with np.errstate(invalid="ignore"):
        is_alike = (there.choice.radius >= 0) & (there.choice.risk < ALIKE * here.choice.risk[also])
    rows, there = also[is_alike], there.at(is_alike)
    risk = here.choice.risk[rows]
    with np.errstate(invalid="ignore"):  # without a fit the risk is infinite, and what is around over it is 0
        around = np.fmin(here.least[rows] * risk, there.least * there.choice.risk)
    here.least[rows], there.least[:] = around / risk, around / there.choice.risk
    radius, order = (np.concatenate([a, b]) for a, b in zip(here.choice[:2], there.choice[:2], strict=True))
    choice = Choice(radius, order, np.concatenate([here.choice.risk, there.choice.risk]))
    both = Found(np.concatenate([here.frames, there.frames]), choice, np.concatenate([here.least, there.least]))
    return both, np.concatenate([np.arange(len(here.least)), rows])
