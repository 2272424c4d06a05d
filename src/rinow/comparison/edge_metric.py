"""The metric of paths along the edges of a mesh, one row of distances at a time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

from rinow.comparison.clock import Clock
from rinow.kernels import edge_rows

__all__ = ["EdgeMetric"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

STEP = 4.0
"""Length of a step of the kernels, in mean lengths of the edges."""

ROWS = 16
"""Rows between two looks at the clock."""


class EdgeMetric:
    """The shortest paths of a connected graph, renumbered so that neighbours are near each other in memory.

    The order is that of Cuthill and McKee, reversed.

    Attributes
    ----------
    order, place : (n,) ndarray of int
        The old number of each node, and the new number of each old one.
    graph : tuple of ndarray
        Compressed rows of neighbours of the renumbered nodes: offsets, heads, lengths.
    step : float
        Length of a step of the kernels.
    """

    def __init__(self, graph: csr_array) -> None:
        self.order = np.asarray(reverse_cuthill_mckee(graph, symmetric_mode=True), np.intp)
        self.place = np.argsort(self.order)
        g = csr_array(graph[self.order][:, self.order])
        g.sort_indices()
        self.graph = g.indptr.astype(np.int32), g.indices.astype(np.int32), g.data.astype(np.float64)
        lengths = self.graph[2]
        longest = float(lengths.max(initial=0.0))
        self.step = STEP * longest * float((lengths / longest).mean()) if longest > 0.0 else 0.0  # sums may overflow
        n = len(self)
        self._work = np.empty(n + 1, np.int32), np.empty(n, np.int32), np.zeros(n, np.bool_)

    def __len__(self) -> int:
        return len(self.order)

    def row(self, point: int) -> Floats:
        """(n,): distances of a point from all, both by their old numbers."""
        distances = np.empty(len(self))
        edge_rows.write_row(self.place[point], *self.graph, self.step, distances, *self._work)
        return distances[self.place]

    def rows(self, nodes: Indices, clock: Clock) -> Floats | None:
        """(k, n): distances of nodes from all, both by their new numbers; None if the time is over before."""
        out = np.empty((len(nodes), len(self)))
        for start in range(0, len(nodes), ROWS):
            if clock.over:
                return None
            part = slice(start, start + ROWS)
            edge_rows.separate_rows(nodes[part], self.graph, self.step, out[part])
        return out
