"""Caps: triangles with an angle of π, the apex of which lies amid the opposite edge."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.edits import EditedFaces, apex
from rinow.kernels import triangles
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["ON_EDGE", "AmidEdge", "cap_faces", "without_caps"]

Indices = NDArray[np.intp]
Mesh = TriangleMesh | IntrinsicMesh

ON_EDGE = 1e-10
"""How much the two shorter sides of a face exceed the longest, over it, where the vertex between them lies on it: it is
beside it by no more than 1e-5, what rounding to 32 bits leaves of a spacing of a hundredth."""


class AmidEdge(NamedTuple):
    """A vertex on the straight line between two others, at the time that it was found there."""

    vertex: int
    start: int
    end: int


def cap_faces(mesh: Mesh) -> Indices:
    """Faces whose sides are longer than 0, the longest the sum of the two others up to rounding; ascending."""
    is_linear = np.empty(mesh.n_faces, np.bool_)
    triangles.linear_faces(mesh.edge_lengths, ON_EDGE, is_linear)
    found = np.flatnonzero(is_linear)
    return found[mesh.topology.face_used[found]]


def without_caps(mesh: Mesh) -> tuple[Mesh, list[AmidEdge]]:
    """The same surface without caps where that can be had, and the vertices amid an edge that they had.

    The longest edge of a cap is flipped, so that its neighbour is split at the apex: no area, no angle and no distance
    on the surface changes.  At a boundary the cap is left out, unless a vertex has no other face.
    """
    waiting = cap_faces(mesh)
    if not len(waiting):
        return mesh, []
    longest = np.argmax(mesh.edge_lengths[waiting], axis=1)
    amid = {int(f): int(mesh.faces[f, k]) for f, k in zip(waiting, longest, strict=True)}
    edited, found = EditedFaces(mesh), []
    is_done = False
    while amid and not is_done:  # a cap beside a cap waits until that is turned
        is_done = True
        for f, t in list(amid.items()):
            a, b = (v for v in edited.face(f) if v != t)
            beside = edited.on_edge(a, b) - {f}
            if len(beside) > 1 or beside & amid.keys():
                continue
            if beside and not _flip(edited, f, min(beside), AmidEdge(t, a, b)):
                continue
            if not beside:
                if any(edited.star(v) == {f} for v in (t, a, b)):
                    continue
                edited.replace([f], [], {})
            found.append(AmidEdge(t, a, b))
            del amid[f]
            is_done = False
    return edited.result(), found


def _flip(edited: EditedFaces, cap: int, other: int, place: AmidEdge) -> bool:
    """Flip the longest edge of a cap, unless the new edge is there already."""
    t, a, b = place
    c = apex(edited.face(other), a, b)
    if edited.on_edge(t, c):
        return False
    at, tb = edited.length(a, t), edited.length(t, b)
    ab = at + tb
    square = (edited.length(b, c) ** 2 * at + edited.length(a, c) ** 2 * tb) / ab - at * tb  # Stewart
    x, y, z = edited.face(other)
    halves = [(t if x == v else x, t if y == v else y, t if z == v else z) for v in (b, a)]
    edited.replace([cap, other], halves, {frozenset((t, c)): sqrt(max(square, 0.0))})
    return True
