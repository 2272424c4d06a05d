"""Local edits of a mesh: a few faces replaced by others, at a cost that does not grow with the mesh."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["EditedFaces", "Face", "apex"]

Mesh = TriangleMesh | IntrinsicMesh
Face = tuple[int, int, int]


class EditedFaces:
    """The faces of a mesh while some of them are replaced: what is not touched costs nothing.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The mesh; it stays as it is.
    """

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self._rows = mesh.topology.corner_offsets, mesh.topology.vertex_corners
        self._stars: dict[int, set[int]] = {}
        self._new: dict[int, Face | None] = {}
        self._lengths: dict[frozenset[int], float] = {}
        self._n_faces = mesh.n_faces

    @property
    def positions(self) -> NDArray[np.float64]:
        """(n_vertices, 3): positions of the vertices; (0, 3) for a mesh that is known by lengths."""
        return self.mesh.vertices if isinstance(self.mesh, TriangleMesh) else np.empty((0, 3))

    def star(self, vertex: int) -> set[int]:
        """The numbers of the faces around a vertex that take part."""
        if vertex not in self._stars:
            offsets, corners = self._rows
            around = corners[offsets[vertex] : offsets[vertex + 1]] // 3
            self._stars[vertex] = set(around.tolist())
        return self._stars[vertex]

    def face(self, number: int) -> Face:
        """The vertices of a face."""
        face = self._new.get(number)
        if face is None:
            a, b, c = self.mesh.faces[number].tolist()
            return a, b, c
        return face

    def on_edge(self, a: int, b: int) -> set[int]:
        """The numbers of the faces that have both vertices."""
        return self.star(a) & self.star(b)

    def length(self, a: int, b: int) -> float:
        """Length of an edge, or with positions the distance of any two vertices."""
        if isinstance(self.mesh, TriangleMesh):
            return float(np.linalg.norm(self.mesh.vertices[a] - self.mesh.vertices[b]))
        known = self._lengths.get(frozenset((a, b)))
        if known is not None:
            return known
        number = min(f for f in self.on_edge(a, b) if f < self.mesh.n_faces)
        third = self.mesh.faces[number].tolist().index(apex(self.face(number), a, b))
        return float(self.mesh.edge_lengths[number, third])

    def replace(self, old: Iterable[int], new: Iterable[Face], lengths: dict[frozenset[int], float]) -> list[int]:
        """Put faces in the place of others, with the lengths of their edges, and return their numbers."""
        old, new = sorted(old), list(new)
        if isinstance(self.mesh, IntrinsicMesh):
            edges = {frozenset(e) for x, y, z in (*map(self.face, old), *new) for e in ((x, y), (y, z), (z, x))}
            known = {edge: lengths[edge] if edge in lengths else self.length(*edge) for edge in edges}
            self._lengths.update(known)
        for number in old:
            for vertex in self.face(number):
                self.star(vertex).discard(number)
            self._new[number] = None
        numbers = old[: len(new)] + list(range(self._n_faces, self._n_faces + len(new) - len(old)))
        for number, face in zip(numbers, new, strict=True):
            for vertex in face:
                self.star(vertex).add(number)
            self._new[number] = face
        self._n_faces += max(len(new) - len(old), 0)
        return numbers

    def result(self) -> Mesh:
        """The mesh with the new faces; what took the place of a face is where it was."""
        if not self._new:
            return self.mesh
        kept = np.ones(self._n_faces, np.bool_)
        faces = np.concatenate([self.mesh.faces, np.zeros((self._n_faces - self.mesh.n_faces, 3), np.intp)])
        for number, face in self._new.items():
            kept[number] = face is not None
            faces[number] = face or 0
        if isinstance(self.mesh, TriangleMesh):
            return TriangleMesh(self.mesh.vertices, faces[kept])
        sides = np.concatenate([self.mesh.edge_lengths, np.zeros((self._n_faces - self.mesh.n_faces, 3))])
        for number, face in self._new.items():
            if face is not None:
                a, b, c = face
                sides[number] = self.length(b, c), self.length(c, a), self.length(a, b)
        return IntrinsicMesh(faces[kept], sides[kept], self.mesh.n_vertices)


def apex(face: Face, a: int, b: int) -> int:
    """The vertex of a face that is none of two others."""
    return next(v for v in face if v not in (a, b))
