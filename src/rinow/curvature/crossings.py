"""Non-manifold edges, of three faces or more: which two of them are one sheet that goes on beyond the edge."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.kernels.adjacency import NONMANIFOLD
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["partners_across"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

STRAIGHT, CLEAR = np.radians(30.0), np.radians(20.0)
"""Two faces go on into each other if they turn by less than the first, and each with any other of the edge by the
second more: three soap films that meet under 120 degrees are three sheets, and so is what leaves along a tangent."""
CROWD = 8
"""Faces of an edge that are compared with each other."""


def partners_across(mesh: TriangleMesh | IntrinsicMesh) -> Indices:
    """(3 n_faces,): `Topology.partners`, and the partners of half-edges where one surface goes on across another.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface; edge lengths alone tell nothing about it.
    """
    partners = mesh.topology.partners
    h = np.flatnonzero(partners == NONMANIFOLD)
    if isinstance(mesh, IntrinsicMesh) or not len(h):
        return partners
    ends = np.sort(mesh.topology.halfedge_ends(h), axis=1)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    h, ends = h[order], ends[order]
    away = _directions_from_edge(mesh, h, ends)
    own, other = (np.concatenate(x) for x in zip(*_pairs_of_edges(ends), strict=True))
    turn = np.pi - np.arccos(np.clip(np.sum(away[own] * away[other], axis=1), -1.0, 1.0))
    order = np.lexsort((turn, own))
    own, other, turn = own[order], other[order], turn[order]
    first = np.flatnonzero(np.diff(own, prepend=-1))  # each has at least two others
    best, clear = other[first], turn[first + 1] - turn[first] >= CLEAR
    is_pair = (turn[first] <= STRAIGHT) & clear & clear[best] & (best[best] == np.arange(len(h)))
    result = partners.copy()
    result[h[is_pair]] = h[best[is_pair]]
    return result


def _pairs_of_edges(ends: Indices) -> list[tuple[Indices, Indices]]:
    """Rows of equal ends, each with each other, both ways."""
    pairs: list[tuple[Indices, Indices]] = []
    for step in range(1, min(CROWD, len(ends))):
        i = np.flatnonzero(np.all(ends[step:] == ends[:-step], axis=1))
        pairs += [(i, i + step), (i + step, i)]
    return pairs


def _directions_from_edge(mesh: TriangleMesh, halfedges: Indices, ends: Indices) -> Floats:
    """(k, 3): unit vectors in the faces of half-edges, at right angles to the edge."""
    V = mesh.vertices
    along = V[ends[:, 1]] - V[ends[:, 0]]
    to = V[mesh.faces[halfedges // 3, (halfedges % 3 + 2) % 3]] - V[ends[:, 0]]
    to = to - along * (np.sum(to * along, axis=1) / np.sum(along * along, axis=1))[:, None]
    return to / np.maximum(np.linalg.norm(to, axis=1), np.finfo(float).tiny)[:, None]
