"""Holes of the triangles of a point cloud, where the stars of some points disagree: filled inside the cloud."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.kernels import clouds

__all__ = ["filled", "taken"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

ROUNDS = 4
"""Each round fills every second corner of a hole: four are enough for twenty."""


def filled(points: Floats, normals: Floats, faces: Indices, reach: Floats, at_border: Bools) -> Indices:
    """Triangles, and more of them at the corners of their holes.

    Parameters
    ----------
    points, normals : (n, 3) ndarray of float
        Positions and unit normals.
    faces : (n_faces, 3) ndarray of intp
        Triangles in the order around these normals; no directed side is in two of them.
    reach : (n,) ndarray of float
        Largest diameter of the circle of a new triangle, by its corner.
    at_border : (n,) ndarray of bool
        Points at whose corners there is nothing to fill.

    Returns
    -------
    faces : (n_faces + n_new, 3) ndarray of intp
        The same and the new ones, which keep their orientation.

    Notes
    -----
    At a corner of a hole the next triangle is that of its two sides, if they make less than a straight angle.  Those
    that close a hole come first, then small circles before large ones.
    """
    n = len(points)
    for _ in range(ROUNDS):
        ears, closes = _ears(points, normals, faces, at_border)
        diameters = np.empty(len(ears))
        clouds.circle_diameters(points, ears, diameters)
        order = np.lexsort((diameters, ~closes))
        order = order[diameters[order] < reach[ears[order, 1]]]
        more = taken(n, np.concatenate([faces, ears[order]]))
        if len(more) == len(faces):
            break
        faces = more
    return faces


def taken(n_points: int, faces: Indices) -> Indices:
    """Triangles, in their order, but none with a directed side of one before, or at a point that those before close."""
    starts, ends = faces, np.roll(faces, -1, axis=1)
    codes, numbers = np.unique(np.stack([starts * n_points + ends, ends * n_points + starts]), return_inverse=True)
    sides, backwards = numbers.reshape(2, -1, 3)
    reverse, is_taken = np.empty(len(codes), np.intp), np.empty(len(faces), np.bool_)
    reverse[sides], reverse[backwards] = backwards, sides
    clouds.take_triangles(faces, sides, reverse, n_points, is_taken)
    return faces[is_taken]


def _ears(points: Floats, normals: Floats, faces: Indices, at_border: Bools) -> tuple[Indices, Bools]:
    """The triangles of two successive sides of a hole, with the corner between them second; which have all three."""
    n = len(points)
    starts, ends = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    open_side = ~np.isin(ends * n + starts, starts * n + ends)
    tails, heads = ends[open_side], starts[open_side]  # the hole is to the left of its sides
    order = np.argsort(tails, kind="stable")
    tails, heads = tails[order], heads[order]
    first, last = np.searchsorted(tails, heads, "left"), np.searchsorted(tails, heads, "right")
    came = np.repeat(np.arange(len(heads)), last - first)
    goes = np.arange(len(came)) - np.repeat(np.cumsum(last - first) - last, last - first)
    x, y, z = tails[came], heads[came], heads[goes]
    angle = _angles(points[z] - points[y], points[x] - points[y], normals[y])
    nearest = np.lexsort((angle, came))
    nearest = nearest[np.unique(came[nearest], return_index=True)[1]]
    nearest = nearest[(angle[nearest] < np.pi) & ~at_border[y[nearest]] & (x != z)[nearest]]
    x, y, z = x[nearest], y[nearest], z[nearest]
    return np.stack([x, y, z], axis=1), np.isin(z * n + x, tails * n + heads)


def _angles(a: Floats, b: Floats, normals: Floats) -> Floats:
    """Angles from vectors to others around the normals, from 0 to 2π."""
    along = np.sum(a * b, axis=1) - np.sum(a * normals, axis=1) * np.sum(b * normals, axis=1)
    return np.arctan2(np.sum(np.cross(normals, a) * b, axis=1), along) % (2.0 * np.pi)
