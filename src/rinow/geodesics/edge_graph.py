"""Shortest paths along the edges of a mesh: quick upper bounds of geodesic distances."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["edge_distances", "edge_graph"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def edge_graph(mesh: TriangleMesh | IntrinsicMesh) -> csr_array:
    """The edges of a mesh as a graph.

    Returns
    -------
    graph : (n_vertices, n_vertices) scipy.sparse.csr_array of float
        Symmetric, with one entry each way for each edge, its length; an edge of length 0 is a stored zero.
    """
    t = mesh.topology
    f, k = np.divmod(t.edge_halfedges, 3)
    i, j = t.edges.T
    lengths = np.tile(mesh.edge_lengths[f, (k + 2) % 3], 2)
    ends = np.concatenate([i, j]), np.concatenate([j, i])
    return coo_array((lengths, ends), shape=(mesh.n_vertices, mesh.n_vertices)).tocsr()


def edge_distances(mesh: TriangleMesh | IntrinsicMesh, sources: Indices, max_distance: float = math.inf) -> Floats:
    """(n_sources, n_vertices): lengths of shortest paths along edges; inf where there is none within `max_distance`."""
    return dijkstra(edge_graph(mesh), indices=sources, limit=max_distance).reshape(len(sources), mesh.n_vertices)
