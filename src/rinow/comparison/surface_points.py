"""Points inside the faces of a mesh, made vertices of it without changing its surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.surface_tree import frame_of, surface_of_mesh
from rinow.kernels.box_trees import foot_on_triangle
from rinow.mesh import TriangleMesh

__all__ = ["insert_points"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

AT_CORNER = 1e-9
"""A point is the corner of a face when its barycentric coordinate there is above 1 minus this: below, the angles at the
new vertex would be rounding."""


def insert_points(mesh: TriangleMesh, positions: Floats) -> tuple[TriangleMesh, Indices]:
    """Cut the faces at the points of the surface nearest to some positions.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, with at least one face that takes part.
    positions : (n, 3) ndarray of float
        Finite positions, on the surface or beside it.

    Returns
    -------
    mesh : TriangleMesh
        The same surface; the old vertices come first.  A point on an edge leaves a face without area.
    indices : (n,) ndarray of intp
        The vertex at the point nearest to each position.
    """
    frame = frame_of(mesh.vertices[mesh.topology.vertex_is_used], positions)
    surface = surface_of_mesh(mesh, frame)
    nearest, _ = surface.nearest(frame.enter(positions), np.arange(len(positions)))
    face_numbers = np.flatnonzero(mesh.topology.face_used)[surface.tree.order]
    vertices, faces = [*mesh.vertices], mesh.faces.tolist()
    parts: dict[int, list[int]] = {}  # of the faces that were cut
    indices = np.empty(len(positions), np.intp)
    for i, t in enumerate(nearest):
        foot = frame.leave(np.array(foot_on_triangle(surface.tree.corners, t, *frame.enter(positions[i]))))
        of_face = parts.setdefault(int(face_numbers[t]), [int(face_numbers[t])])
        coordinates = [_barycentric(foot, np.array([vertices[v] for v in faces[f]])) for f in of_face]
        best = int(np.argmax([c.min() for c in coordinates]))
        face, c = of_face[best], coordinates[best]
        a, b, d = faces[face]
        if c.max() > 1.0 - AT_CORNER:
            indices[i] = faces[face][int(c.argmax())]
            continue
        indices[i] = p = len(vertices)
        vertices.append(foot)
        faces[face] = [a, b, p]
        of_face += [len(faces), len(faces) + 1]
        faces += [[b, d, p], [d, a, p]]
    return TriangleMesh(np.array(vertices), faces), indices


def _barycentric(point: Floats, corners: Floats) -> Floats:
    """(3,): barycentric coordinates of a point of a triangle; of one without area those of the nearest corner."""
    sides = corners[1:] - corners[0]
    normal = np.cross(*sides)
    square = float(normal @ normal)
    if square == 0.0:
        return np.eye(3)[np.linalg.norm(corners - point, axis=1).argmin()]
    w = point - corners[0]
    b, c = float(normal @ np.cross(w, sides[1])) / square, float(normal @ np.cross(sides[0], w)) / square
    return np.array([1.0 - b - c, b, c])
