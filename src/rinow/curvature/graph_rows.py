"""A graph as kernels read it: its arcs in compressed rows, lengths checked, parallel arcs reduced to the shortest."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.kernels import graphs
from rinow.metric_graph import graph_edge_lengths

__all__ = ["Arcs", "as_arcs"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Rows = tuple[Indices, Indices, Floats]

N_BLOCKS = 16
"""Pieces a kernel cuts its work into; each has scratch of its own."""


@dataclass(frozen=True)
class Arcs:
    """Arcs of finite length without loops and parallels, ordered by tail and head; an undirected edge is two arcs.

    Attributes
    ----------
    n_nodes : int
        Number of nodes.
    tails, heads : (n_arcs,) ndarray of intp
        Ends of each arc.
    lengths : (n_arcs,) ndarray of float
        Lengths, none negative.
    is_directed : bool
        Whether an arc leads one way only.
    """

    n_nodes: int
    tails: Indices
    heads: Indices
    lengths: Floats
    is_directed: bool

    @cached_property
    def offsets(self) -> Indices:
        """(n_nodes + 1,): arcs of node u are those from offsets[u] to offsets[u + 1]."""
        return np.searchsorted(self.tails, np.arange(self.n_nodes + 1)).astype(np.intp)

    @cached_property
    def distances(self) -> Floats:
        """(n_arcs,): length of the shortest path from tail to head, at most that of the arc."""
        if len(self.lengths) == 0 or self.lengths.max() <= 2.0 * self.lengths.min():
            return self.lengths  # no detour of two arcs is shorter
        out = np.empty(len(self.lengths))
        graphs.arc_distances(self.offsets, self.heads, self.lengths, N_BLOCKS, out)
        return out

    def rows(self, values: Floats) -> Rows:
        """Compressed rows of the arcs that leave each node, with values of the arcs."""
        return self.offsets, self.heads, values

    def rows_into(self, values: Floats) -> Rows:
        """Compressed rows of the arcs that arrive at each node, with values of the arcs."""
        order = self.by_head
        offsets = np.searchsorted(self.heads[order], np.arange(self.n_nodes + 1)).astype(np.intp)
        return offsets, self.tails[order], values[order]

    @cached_property
    def by_head(self) -> Indices:
        """(n_arcs,): the arcs ordered by head and tail."""
        return np.lexsort((self.tails, self.heads)).astype(np.intp)


def as_arcs(graph: Any, directed: bool | None) -> Arcs:
    """The arcs of a graph; `directed` None asks the graph, and takes a matrix as undirected.

    Raises
    ------
    InvalidInputError
        If `graph` is no graph, or has a negative or undefined length.
    """
    A = graph_edge_lengths(graph)
    if directed is None:
        directed = bool(graph.is_directed()) if hasattr(graph, "is_directed") else False
    n = len(A.indptr) - 1
    tails = np.repeat(np.arange(n), np.diff(A.indptr))
    heads, lengths = np.asarray(A.indices, np.intp), np.asarray(A.data, np.float64)
    if not directed:
        tails, heads = np.concatenate([tails, heads]), np.concatenate([heads, tails])
        lengths = np.concatenate([lengths, lengths])
    keep = (tails != heads) & np.isfinite(lengths)
    tails, heads, lengths = tails[keep], heads[keep], lengths[keep]
    order = np.lexsort((lengths, heads, tails))
    tails, heads, lengths = tails[order], heads[order], lengths[order]
    first = np.ones(len(tails), np.bool_)
    first[1:] = (np.diff(tails) != 0) | (np.diff(heads) != 0)
    return Arcs(n, tails[first], heads[first], lengths[first], directed)
