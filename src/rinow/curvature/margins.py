"""Averages of angle defects beside a boundary: what their end there leaves of the noise, and weights that fade out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra

from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.length_noise import LengthNoise
from rinow.curvature.waves import ORDER, REFERENCE, Waves, window
from rinow.geodesics.edge_graph import edge_graph
from rinow.kernels.margins import jump_squares

__all__ = ["SUPPORT", "Margins", "growth"]

Floats = NDArray[np.float64]

Faded = tuple[Floats, Floats]
"""Averages and the share of their weights that is left, nan where that is next to none."""
SUPPORT = 10.0
"""Squared radius of the ball over the variance of the weights (1 - (d/radius)²)³ in it along one axis."""
WIDTH = 0.4
"""Width of the margin over the radius of the ball averaged over."""
LEAST = 0.1
"""Share of the weights that must be left."""
JUMPS = 6.5, 4.4
"""Standard error over that of an average that no boundary is near to, less 1, over the share of the weights that is
lost, for the first and the higher orders: as measured on a square with independent errors of its lengths."""
FOLDED = 2.0
"""S reflects at a boundary, so that a ball reaches it twice: squares count four times, over an area that is half."""


class Margins:
    r"""How averages of angle defects end where no defects are known: at a boundary.

    Errors of a length enter four defects with the sum 0, so that they cancel in averages whose weights vary slowly.
    Where weights end with a jump the errors of all lengths along it stay.  A length of which they change the weighted
    sum of defects by j has the part :math:`g^2 j^2` in the variance of an average with the kernel g, which is
    :math:`\int g^2` times the mean of j² per area with the weights g².  In balls of 16 spacings that is four hundred
    times the variance in the interior.  So there is a second average, with weights that fade out towards the boundary,
    over two fifths of the radius of the ball, divided by what is left of their sum.  Its variance is about ten times
    that in the interior, and it is the average of a point hardly further inside than the first.

    Parameters
    ----------
    flow : CurvatureFlow
        The mesh.
    noise : LengthNoise
        What noise of its lengths does.
    start : (n_vertices,) ndarray of float
        What is averaged.
    most_steps : int
        The largest scale.
    """

    def __init__(self, flow: CurvatureFlow, noise: LengthNoise, start: Floats, most_steps: int) -> None:
        self.flow, self.start = flow, start
        reach = float(np.sqrt(SUPPORT * most_steps * np.fmax.reduce(noise.step, initial=0.0)))
        self._distances = _end_distances(flow, WIDTH * reach)
        self._done = 0
        self._known: dict[int, list[Faded]] = {}
        self.exist = bool(np.isfinite(self._distances).any())
        if self.exist:
            squares = np.empty(len(start))
            jump_squares(flow.has_data.astype(np.float64), flow.spacing, flow.metric, squares)
            self._columns = np.column_stack([squares, flow.areas])

    def jumps(self, m: int) -> Floats | None:
        """(n_vertices,): squares of jumps per area in balls of scale m, no less than the last one; None without any."""
        if not self.exist:
            return None
        passes = max(m // 2, 1)
        self._columns, self._done = self.flow.means(self._columns, passes - self._done), passes
        squares, areas = self._columns.T
        return FOLDED * np.divide(squares, areas, out=np.zeros(len(areas)), where=areas > 0.0)

    def averages(self, m: int, radius: Floats) -> list[Faded]:
        """The averages of this scale over balls of a radius, for the orders 1 to 3."""
        windows = _windows(m)
        with np.errstate(all="ignore"):
            part = np.clip(self._distances / (WIDTH * radius), 0.0, 1.0)
        left = np.where(self.flow.has_data, part * part * (3.0 - 2.0 * part), 0.0)
        weights = Waves(self.flow, left).sums(windows)
        totals = Waves(self.flow, left * self.start).sums(windows)
        for weight, total in zip(weights, totals, strict=True):
            weight[~(weight > LEAST)] = np.nan
            total /= weight
        self._known[m] = list(zip(totals, weights, strict=True))
        return self._known[m]

    def reference(self, m: int, order: int) -> Faded:
        """What the average of this scale and order is compared with: half the scale, an order more if there is one."""
        half = REFERENCE[m]
        for scale in [scale for scale in self._known if scale < half]:
            del self._known[scale]
        if half not in self._known:
            whole = np.ones(len(self.start))
            self._known[half] = [(values, whole) for values in Waves(self.flow, self.start).sums(_windows(half))]
        return self._known[half][min(order + 1, ORDER) - 1]


def _windows(m: int) -> list[Floats]:
    """Of the orders 1 to 3."""
    return [window(m, order) for order in range(1, ORDER + 1)]


def growth(left: Floats, order: int) -> Floats:
    """Variance over that in the interior of an average with so much left of its weights."""
    return np.square(1.0 + JUMPS[min(order, 2) - 1] * np.fmax(1.0 - left, 0.0))


def _end_distances(flow: CurvatureFlow, reach: float) -> Floats:
    """(n_vertices,): distance along edges, up to `reach`, from where no defect is known; inf beyond."""
    t = flow.mesh.topology
    ends = np.flatnonzero(~flow.has_data & (np.diff(t.neighbour_offsets) > 0))
    if not len(ends):
        return np.full(len(flow.areas), np.inf)
    return np.asarray(dijkstra(edge_graph(flow.mesh), indices=ends, min_only=True, limit=reach))
