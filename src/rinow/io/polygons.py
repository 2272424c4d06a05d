"""Polygons and strips of a file as triangles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._printing import counted
from rinow.errors import FileFormatError, InvalidMeshError

__all__ = ["Runs", "runs_of_offsets", "surface_triangles"]

Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class Runs:
    """Lists of different lengths, one after another, such as the corners of polygons.

    Attributes
    ----------
    items : (n_items,) ndarray
        The items of all lists.
    counts : (n_lists,) ndarray of intp, or int
        How many items each list has, or all lists have.
    """

    items: NDArray[Any]
    counts: Indices | int

    def lengths(self) -> Indices:
        """(n_lists,): how many items each list has."""
        return np.full(len(self.items) // self.counts, self.counts) if isinstance(self.counts, int) else self.counts


def runs_of_offsets(items: NDArray[Any], offsets: NDArray[Any]) -> Runs:
    """Lists of which number i is ``items[offsets[i]:offsets[i + 1]]``.

    Raises
    ------
    FileFormatError
        If the offsets do not rise from 0 to the number of items.
    """
    counts = np.diff(offsets).astype(np.intp)
    if len(offsets) and (offsets[0] != 0 or offsets[-1] != len(items) or (counts < 0).any()):
        raise FileFormatError("the offsets of the polygons do not fit their corners; export the file again.")
    return Runs(items, counts)


def surface_triangles(
    n_vertices: int, polygons: Runs | None, strips: Runs | None = None
) -> tuple[Indices, tuple[str, ...]]:
    """Triangles of polygons, each a fan around its first corner, and of triangle strips.

    Parameters
    ----------
    n_vertices : int
        Number of vertices; corners count from 0.
    polygons, strips : Runs, optional
        Corners of each polygon, and of each strip, in which every second triangle is turned.

    Returns
    -------
    faces : (n_faces, 3) ndarray of intp
        Triangles, in the order of the polygons and strips.
    notes : tuple of str
        What was done to those that are no triangles.

    Raises
    ------
    FileFormatError
        If a corner is not an integer in ``range(n_vertices)``.
    InvalidMeshError
        If there is no triangle.

    Examples
    --------
    >>> faces, notes = surface_triangles(4, Runs(np.array([0, 1, 2, 3]), 4))
    >>> faces.tolist()
    [[0, 1, 2], [0, 2, 3]]
    >>> surface_triangles(4, None, Runs(np.array([0, 1, 2, 3]), 4))[0].tolist()
    [[0, 1, 2], [3, 2, 1]]
    """
    parts: list[Indices] = []
    notes: list[str] = []
    if polygons:
        parts.append(_fans(polygons, n_vertices))
        notes += _notes(polygons)
    if strips and len(strips.items):
        parts.append(_strips(strips, n_vertices))
        notes.append(f"{counted(len(parts[-1]), 'triangle was', 'triangles were')} taken from triangle strips.")
    faces = np.concatenate(parts) if len(parts) > 1 else parts[0] if parts else np.empty((0, 3), np.intp)
    if not len(faces):
        raise InvalidMeshError("the file has no face; for a point cloud use point_cloud_curvature.")
    return faces, tuple(notes)


def _fans(polygons: Runs, n_vertices: int) -> Indices:
    """Triangles of polygons."""
    indices = _as_indices(polygons, n_vertices)
    if isinstance(polygons.counts, int) and polygons.counts == 3:
        return indices.reshape(-1, 3)
    first, j = _triangle_places(polygons.lengths())
    return np.stack([indices[first], indices[first + j + 1], indices[first + j + 2]], axis=1)


def _strips(strips: Runs, n_vertices: int) -> Indices:
    """Triangles of strips."""
    indices = _as_indices(strips, n_vertices)
    first, j = _triangle_places(strips.lengths())
    i, turned = first + j, 2 * (j % 2)
    return np.stack([indices[i + turned], indices[i + 1], indices[i + 2 - turned]], axis=1)


def _as_indices(runs: Runs, n_vertices: int) -> Indices:
    """Corners as integers in ``range(n_vertices)``."""
    if runs.items.dtype.kind == "f":
        _refuse(runs.items != np.floor(runs.items), runs, "which is not an integer")
    _refuse((runs.items < 0) | (runs.items >= n_vertices), runs, f"but the vertices are 0..{n_vertices - 1}")
    return np.ascontiguousarray(runs.items, np.intp)


def _refuse(wrong: NDArray[np.bool_], runs: Runs, fault: str) -> None:
    """Raise for the first wrong corner."""
    if wrong.any():
        i = int(np.argmax(wrong))
        face = np.searchsorted(np.cumsum(runs.lengths()), i, side="right")
        raise FileFormatError(
            f"face {face} names vertex {runs.items[i]:.17g}, {fault}, counted from 0; export it again."
        )


def _triangle_places(counts: Indices) -> tuple[Indices, Indices]:
    """For each triangle: where its polygon starts, and its number within the polygon."""
    n_triangles = np.maximum(counts - 2, 0)
    starts, ends = np.cumsum(counts) - counts, np.cumsum(n_triangles)
    first = np.repeat(starts, n_triangles)
    return first, np.arange(len(first)) - np.repeat(ends - n_triangles, n_triangles)


def _notes(polygons: Runs) -> list[str]:
    """What was done to polygons that are no triangles."""
    counts = polygons.lengths()
    large, small = int((counts > 3).sum()), int((counts < 3).sum())
    notes: list[str] = []
    if large:
        what = "with more than three corners"
        notes.append(
            f"{counted(large, f'face {what} was', f'faces {what} were')} split into triangles, each as a fan around "
            "its first corner; a face that is not convex may come out wrong."
        )
    if small:
        what = "with fewer than three corners"
        notes.append(f"{counted(small, f'face {what} was', f'faces {what} were')} left out.")
    return notes
