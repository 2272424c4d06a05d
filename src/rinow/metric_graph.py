"""Metric graphs: a graph whose edges have lengths."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.sparse import coo_array, csr_array, issparse

from rinow._arrays import as_floats
from rinow.errors import InvalidInputError

__all__ = ["graph_edge_lengths"]


def graph_edge_lengths(graph: Any) -> csr_array:
    """The lengths of the edges as a sparse matrix; zeros are kept, parallel edges reduced to the shortest."""
    labels: Sequence[Any] | None = None
    tails: Any
    heads: Any
    if issparse(graph):
        edges = coo_array(graph)
        tails, heads, lengths = edges.row, edges.col, edges.data
        n_rows, n_columns = graph.shape
    elif hasattr(graph, "get_edgelist") and hasattr(graph, "vcount"):  # igraph's
        listed, n_rows = graph.get_edgelist(), graph.vcount()
        tails, heads = zip(*listed, strict=True) if listed else ((), ())
        lengths = graph.es["weight"] if "weight" in graph.es.attributes() else [1.0] * len(listed)
        n_columns = n_rows
    elif hasattr(graph, "nodes") and hasattr(graph, "edges"):
        labels = list(graph.nodes)
        number = {node: i for i, node in enumerate(labels)}
        rows = [(number[u], number[v], w) for u, v, w in graph.edges(data="weight", default=1.0)]
        tails, heads, lengths = zip(*rows, strict=True) if rows else ((), (), ())
        n_rows = n_columns = len(number)
    else:
        raise InvalidInputError(
            f"graph is a {type(graph).__name__}; give a scipy sparse matrix or a networkx graph or one of igraph "
            "(of an array whose zeros are no edges, scipy.sparse.csr_array)."
        )
    if n_rows != n_columns or n_rows == 0:
        raise InvalidInputError(
            f"graph has shape ({n_rows}, {n_columns}); give a square matrix with at least one node."
        )
    weights = as_floats(lengths, "graph")
    wrong = np.flatnonzero(~(weights >= 0))
    if len(wrong):
        e = wrong[0]
        ends = int(tails[e]), int(heads[e])
        tail, head = ends if labels is None else (labels[i] for i in ends)
        raise InvalidInputError(f"graph[{tail!r}, {head!r}] = {weights[e]} is not a length; give numbers >= 0.")
    order = np.lexsort((weights, heads, tails))
    pairs = np.stack([tails, heads]).astype(np.intp)[:, order]
    shortest = np.r_[True, (np.diff(pairs) != 0).any(axis=0)][: len(order)]
    return csr_array((weights[order][shortest], pairs[:, shortest]), shape=(n_rows, n_rows))
