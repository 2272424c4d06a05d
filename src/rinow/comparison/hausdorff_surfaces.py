"""The branch and bound that encloses the Hausdorff distance of two surfaces."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.surface_tree import ROUNDING, Surface
from rinow.kernels import hausdorff

__all__ = ["SurfaceDistance", "surface_distance"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

ROUNDS = (128, 4096)
"""Faces treated first and second, the most distant ones, so that the others meet a better lower bound."""


class SurfaceDistance(NamedTuple):
    """The parts of a `HausdorffDistance`, in a frame; pairs are in the order A, B."""

    lower: float
    upper: float
    witnesses: tuple[Floats, Floats]
    distances: tuple[Floats, Floats]
    directed: tuple[tuple[float, float], tuple[float, float]]
    n_pieces: int


class _Direction:
    """The greatest distance of one surface from the other, enclosed face by face."""

    def __init__(self, moving: Surface, fixed: Surface) -> None:
        self.moving, self.fixed = moving, fixed.seen_from(moving.points[moving.order])
        nearest, self.distances = self.fixed.nearest(moving.points, moving.order)
        self.hints = nearest[moving.corner_points]
        n = len(moving.corner_points)
        self.bounds, self.points, self.n_pieces = np.zeros((n, 2)), np.zeros((n, 3)), np.zeros(n, np.intp)
        farthest = moving.order[self.distances[moving.order].argmax()]
        self.lower, self.point = float(self.distances[farthest]), moving.points[farthest]
        order = np.argsort(-self.distances[moving.corner_points].max(axis=1), kind="stable")
        self.rounds = [*np.split(order, ROUNDS)[:2], np.sort(order[ROUNDS[1] :])]

    def refine(self, faces: Indices, lower: float, tolerance: float) -> float:
        """Bound the distance of some faces, up to a tolerance above a lower bound; returns the new lower bound."""
        hausdorff.bound_triangles(
            self.moving.tree.corners,
            faces,
            self.fixed.tree,
            self.hints,
            lower,
            tolerance,
            ROUNDING,
            self.bounds,
            self.points,
            self.n_pieces,
        )
        if len(faces):
            best = faces[self.bounds[faces, 0].argmax()]
            if self.bounds[best, 0] > max(lower, self.lower):
                self.lower, self.point = float(self.bounds[best, 0]), self.points[best]
        return max(lower, self.lower)

    @property
    def enclosure(self) -> tuple[float, float]:
        """Lower and upper bound of the greatest distance, rounding included."""
        return max(self.lower - self.fixed.vagueness, 0.0), float(self.bounds[:, 1].max())


def surface_distance(A: Surface, B: Surface, tolerance: float) -> SurfaceDistance:
    """Bounds of the Hausdorff distance of two surfaces in one frame, at most `tolerance` apart.

    Parameters
    ----------
    A, B : Surface
        The surfaces.
    tolerance : float
        Greatest width of the interval; not less than the rounding of distances.

    Returns
    -------
    distance : SurfaceDistance
        Bounds and witnesses.
    """
    directions = _Direction(A, B), _Direction(B, A)
    vague = max(direction.fixed.vagueness for direction in directions)
    margin = max(tolerance - ROUNDING - vague, 8.0 * ROUNDING)
    lower = max(direction.lower for direction in directions)
    for chunks in zip(*(direction.rounds for direction in directions), strict=True):
        for direction, faces in zip(directions, chunks, strict=True):
            lower = direction.refine(faces, lower, margin)
    a, b = directions
    enclosures = a.enclosure, b.enclosure
    if a.lower >= b.lower:
        witnesses = a.point, B.foot(a.point)
    else:
        witnesses = A.foot(b.point), b.point
    return SurfaceDistance(
        max(enclosure[0] for enclosure in enclosures),
        max(enclosure[1] for enclosure in enclosures),
        witnesses,
        (a.distances, b.distances),
        enclosures,
        int(a.n_pieces.sum() + b.n_pieces.sum()),
    )
