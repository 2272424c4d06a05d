"""A triangulated surface, or a set of points, prepared for the question how far it is from a point."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.errors import InvalidInputError
from rinow.kernels import box_trees
from rinow.kernels.box_trees import BoxTree
from rinow.mesh import TriangleMesh

__all__ = ["Frame", "Surface", "frame_of", "surface_of_mesh", "surface_of_points"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

ROUNDING = 64 * 2.0**-53
"""Error of a distance between points of a frame of size 1."""

SAMPLE = 128
"""Points asked for the part that a surface surrounds most widely."""

LARGEST_SIZE = 1e307
"""Half the extent of sets whose distances are numbers."""


@dataclass(frozen=True, slots=True)
class Frame:
    """Coordinates in which sets lie around the origin and have a size near 1; all but the shift is exact."""

    centre: Floats
    unit: float  # a power of two

    def enter(self, points: Floats) -> Floats:
        """The same points in this frame."""
        return (points - self.centre) / self.unit

    def leave(self, points: Floats) -> Floats:
        """Points of this frame in the user's coordinates."""
        return points * self.unit + self.centre


def frame_of(*sets: Floats) -> Frame:
    """The frame of the box around some point sets.

    Raises
    ------
    InvalidInputError
        If distances between points may be too large for a number.
    """
    least = np.min([points.min(axis=0) for points in sets], axis=0)
    greatest = np.max([points.max(axis=0) for points in sets], axis=0)
    centre = 0.5 * least + 0.5 * greatest
    size = float((greatest - centre).max())
    if size > LARGEST_SIZE:
        raise InvalidInputError(
            f"points lie {size:.3g} from their middle, and some distances are no number; scale them."
        )
    return Frame(centre, float(2.0 ** np.frexp(size)[1]) if size > 0.0 else 1.0)


@dataclass(frozen=True, slots=True)
class Surface:
    """Triangles in a frame, sorted into a tree; a point of a cloud is a triangle with three equal corners.

    Attributes
    ----------
    points : (n_points, 3) ndarray of float
        Positions in the frame; rows that are not on the surface hold anything.
    order : (n_used,) ndarray of intp
        The points on the surface, neighbours close together.
    corner_points : (n_triangles, 3) ndarray of intp
        Corners of the triangles in the order of the tree.
    tree : BoxTree
        The triangles.
    """

    points: Floats
    order: Indices
    corner_points: Indices
    tree: BoxTree

    def nearest(self, points: Floats, order: Indices) -> tuple[Indices, Floats]:
        """Nearest triangle (n,) and distance (n,) of the listed points; -1 and nan for the others."""
        nearest, distances = np.full(len(points), -1, np.intp), np.full(len(points), np.nan)
        box_trees.nearest_triangles(self.tree, points, order, nearest, distances)
        return nearest, distances

    def seen_from(self, points: Floats) -> Surface:
        """The same surface, made ready for questions from the part of some points that it surrounds most widely.

        Boxes nearly as far from a point as the nearest one are many if the point is near the centre of a sphere; the
        directions in which they lie tell more.  Neighbours in the list lie close together, so that a part which no
        sample hits has few points, and costs little.
        """
        sample = points[:: -(-len(points) // SAMPLE)]
        _, gaps = self.nearest(sample, np.arange(len(sample)))
        deepest = gaps.argmax()
        part = sample[np.linalg.norm(sample - sample[deepest], axis=1) <= 0.5 * gaps[deepest]]
        eye = 0.5 * (part.min(axis=0) + part.max(axis=0))
        clear = float(self.nearest(eye[None], np.zeros(1, np.intp))[1][0])
        if clear == 0.0:
            return self
        views = np.empty((len(self.tree.boxes), box_trees.VIEW))
        tree = self.tree._replace(eye=eye, views=views, clear=clear)
        box_trees.bound_views(tree)
        return replace(self, tree=tree)

    def foot(self, point: Floats) -> Floats:
        """(3,): the point of the surface nearest to a point."""
        nearest, _ = self.nearest(point[None, :], np.zeros(1, np.intp))
        return np.array(box_trees.foot_on_triangle(self.tree.corners, nearest[0], *point))

    @property
    def vagueness(self) -> float:
        """By how much a computed distance may exceed the true one: rounding in the thinnest triangles.

        A foot point on a triangle with the angle s is wrong by rounding / s, and by no more than the triangle is thin.
        """
        C = self.tree.corners.reshape(-1, 3, 3)
        b, c = C[:, 1] - C[:, 0], C[:, 2] - C[:, 0]
        longest = np.maximum(np.linalg.norm(b, axis=1), np.linalg.norm(c, axis=1))
        squares = np.linalg.norm(b, axis=1) * np.linalg.norm(c, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            sine = np.linalg.norm(np.cross(b, c), axis=1) / squares
            error = np.minimum(ROUNDING / sine, sine + ROUNDING) * longest
        return ROUNDING + float(np.nanmax(error, initial=0.0))


def surface_of_mesh(mesh: TriangleMesh, frame: Frame) -> Surface:
    """The surface made by the faces that take part; there is at least one."""
    return _sorted(frame.enter(mesh.vertices), mesh.faces[mesh.topology.face_used])


def surface_of_points(points: Floats, frame: Frame) -> Surface:
    """A cloud of points in space."""
    return _sorted(frame.enter(points), np.repeat(np.arange(len(points), dtype=np.intp)[:, None], 3, axis=1))


def _sorted(points: Floats, triangles: Indices) -> Surface:
    """The tree over some triangles."""
    corners: Any = points[triangles].reshape(-1, 9)
    depth = max(int(np.ceil(np.log2(len(corners) / box_trees.LEAF))), 0)
    order = np.empty(len(corners), np.intp)
    box_trees.sort_into_tree(corners, depth, order)
    corners = np.ascontiguousarray(corners[order])
    boxes = np.empty((2 << depth, box_trees.BOX))
    box_trees.bound_boxes(corners, depth, boxes)
    corner_points = np.ascontiguousarray(triangles[order])
    used, first = np.unique(corner_points, return_index=True)
    tree = BoxTree(corners, order, boxes, depth, np.zeros(3), np.empty((0, box_trees.VIEW)), 0.0)
    return Surface(points, used[np.argsort(first)], corner_points, tree)
