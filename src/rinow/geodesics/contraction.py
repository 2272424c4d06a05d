"""Vertices joined by edges without length are one point of a surface: a path spends nothing between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from rinow import tolerances
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["Contraction", "contraction"]

Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class Contraction:
    """A mesh in which one vertex stands for all that are at one point.

    Attributes
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The mesh, of as many vertices; those that another one stands for have no face.
    first : (n_vertices,) ndarray of intp
        The vertex that stands for each vertex.
    """

    mesh: TriangleMesh | IntrinsicMesh
    first: Indices

    def expanded(self, offsets: Indices, vertices: Indices) -> tuple[Indices, Indices, Indices]:
        """Balls with all vertices in place of those that stand for them.

        Offsets, vertices, and for each of these the entry of the given balls that it comes from.
        """
        by_point = np.argsort(self.first, kind="stable")
        sizes = np.bincount(self.first, minlength=len(self.first))
        ends = np.cumsum(sizes)
        n_each = sizes[vertices]
        entry = np.repeat(np.arange(len(vertices)), n_each)
        totals = np.concatenate([[0], np.cumsum(n_each)])
        place = np.arange(totals[-1]) - totals[entry]
        return totals[offsets], by_point[(ends - sizes)[vertices][entry] + place], entry


def contraction(mesh: TriangleMesh | IntrinsicMesh) -> Contraction | None:
    """The mesh without edges of length 0; None if it has none.

    A face with one such edge is a line, which stays as the side of a face beside it; where there is none, its vertices
    are left as they are.
    """
    t = mesh.topology
    faces, lengths = mesh.faces[t.face_used], mesh.edge_lengths[t.face_used]
    zero = lengths <= tolerances.ZERO_EDGE * lengths.max(initial=0.0)
    if not zero.any():
        return None
    kept = np.ones(mesh.n_vertices, np.bool_)  # vertices that may be united with others
    while True:
        first = _first_of_each_point(faces, zero, kept)
        alone = _lines_without_a_face(first[faces], mesh.n_vertices)
        if not alone.any():
            break
        kept[np.isin(first, first[faces[alone]])] = False
    if (first == np.arange(mesh.n_vertices)).all():
        return None
    F = first[mesh.faces]
    if isinstance(mesh, TriangleMesh):
        return Contraction(TriangleMesh(mesh.vertices, F), first)
    return Contraction(IntrinsicMesh(F, mesh.edge_lengths, mesh.n_vertices), first)


def _first_of_each_point(faces: Indices, zero: Bools, kept: Bools) -> Indices:
    """(n_vertices,): the least of the vertices that edges of length 0 join with each vertex."""
    n = len(kept)
    ends = np.concatenate([faces[zero[:, k]][:, [(k + 1) % 3, (k + 2) % 3]] for k in range(3)])
    i, j = ends[kept[ends].all(axis=1)].T
    point = connected_components(csr_array((np.ones(len(i)), (i, j)), shape=(n, n)), directed=False)[1]
    return np.unique(point, return_index=True)[1][point].astype(np.intp)


def _lines_without_a_face(faces: Indices, n_vertices: int) -> Bools:
    """(n_faces,): faces with two different vertices that no face with three has."""
    pairs = np.sort(np.stack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]], axis=1), axis=2)
    differ = pairs[..., 0] != pairs[..., 1]
    keys = pairs[..., 0] * n_vertices + pairs[..., 1]
    proper = differ.all(axis=1)
    return (differ & ~np.isin(keys, keys[proper])).any(axis=1)
