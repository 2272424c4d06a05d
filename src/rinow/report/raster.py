"""A depth-buffered picture of triangles in plain numpy: exact pixel coverage, any number of faces.

A painter's ordering of polygons (what plotting libraries offer) tears where faces interlock and takes minutes on
a million faces; a depth buffer does neither.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import rows_are_finite

__all__ = ["camera", "rasterize", "shade"]

Floats = NDArray[np.float64]
ROUNDING = 1e-3
"""Pixels, far more than rounding may move a place by."""
_PIXELS_AT_ONCE = 4_000_000
"""Pixels expanded in one block; bounds the memory at some 300 MB."""


def camera(towards: Floats, up: Floats) -> Floats:
    """(3, 3) rows right, up, towards the viewer, for a viewer far away in direction `towards`."""
    z = towards / np.linalg.norm(towards)
    x = np.cross(up, z)
    x = x / np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])


def rasterize(points: Floats, faces: NDArray[np.intp], size: tuple[int, int]) -> tuple[NDArray[np.intp], Floats]:
    """Which face is seen in each pixel, and where in it.

    Parameters
    ----------
    points : (n, 3) ndarray of float
        Column and row in pixels, and depth; the greatest depth is nearest to the viewer.
    faces : (n_faces, 3) ndarray of intp
        Triangles; those with non-finite points are skipped.
    size : (int, int)
        Rows and columns of the picture.

    Returns
    -------
    face : (rows, columns) ndarray of intp
        Index of the nearest face, -1 where there is none.
    weights : (rows, columns, 3) ndarray of float
        Barycentric coordinates of the pixel's centre in that face.
    """
    rows, columns = size
    depth = np.full(rows * columns, -np.inf)
    nearest = np.full(rows * columns, -1, np.intp)
    P = points.take(faces, axis=0)
    with np.errstate(invalid="ignore"):
        index = np.flatnonzero(_may_hold_a_centre(P[:, :, 0], columns) & _may_hold_a_centre(P[:, :, 1], rows))
        P = P.take(index, axis=0)
        edge_on = _cross(P[:, 1, :2] - P[:, 0, :2], P[:, 2, :2] - P[:, 0, :2]) == 0.0
        proper = np.flatnonzero(rows_are_finite(P.reshape(-1, 9)) & ~edge_on)
    index, P = index[proper], P.take(proper, axis=0)
    planes = _planes(P)
    # Upper bound of the pixels of a face, to cut the work into blocks.
    (left, right), (low, high) = _range(P[:, :, 0]), _range(P[:, :, 1])
    width = right - left + 2.0
    cost = np.cumsum(np.minimum(width, columns) * np.minimum(high - low + 2.0, rows))
    cuts = np.searchsorted(cost, np.arange(_PIXELS_AT_ONCE, cost[-1] if len(cost) else 0, _PIXELS_AT_ONCE))
    for block in np.split(np.arange(len(index)), np.unique(cuts)):
        f, pixel = _covered_pixels(P[block], rows, columns)
        f = block[f]
        z = planes[f, 0] * (pixel % columns + 0.5) + planes[f, 1] * (pixel // columns + 0.5) + planes[f, 2]
        np.maximum.at(depth, pixel, z)
        won = z == depth[pixel]
        nearest[pixel[won]] = index[f[won]]
    return nearest.reshape(size), _barycentric(points, faces, nearest, columns).reshape(rows, columns, 3)


def _range(values: Floats) -> tuple[Floats, Floats]:
    """Least and greatest of the three values of each row; numpy reduces short rows one by one."""
    a, b, c = values.T
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


def _may_hold_a_centre(places: Floats, n: int) -> NDArray[np.bool_]:
    """Whether a centre of the n pixels may lie between three places; most small faces have none."""
    low, high = _range(places)
    return (np.ceil(low - 0.5 - ROUNDING) <= np.floor(high - 0.5 + ROUNDING)) & (high >= 0) & (low <= n)


def _planes(P: Floats) -> Floats:
    """(n_faces, 3): coefficients a, b, c of depth = a x + b y + c."""
    u, v = P[:, 1] - P[:, 0], P[:, 2] - P[:, 0]
    determinant = _cross(u, v)
    a = (u[:, 2] * v[:, 1] - u[:, 1] * v[:, 2]) / determinant
    b = (u[:, 0] * v[:, 2] - u[:, 2] * v[:, 0]) / determinant
    return np.stack([a, b, P[:, 0, 2] - a * P[:, 0, 0] - b * P[:, 0, 1]], axis=1)


def _covered_pixels(P: Floats, rows: int, columns: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs (face, pixel) for every pixel centre inside a face, by spans along the rows."""
    low, high = _range(P[:, :, 1])
    first = np.clip(np.ceil(low - 0.5), 0, rows).astype(np.intp)
    last = np.clip(np.floor(high - 0.5) + 1, 0, rows).astype(np.intp)
    f, y = _expand(first, last)
    left, right = np.full(len(f), np.inf), np.full(len(f), -np.inf)
    for k in range(3):
        a, b = P[f, k], P[f, (k + 1) % 3]
        t = (y + 0.5 - a[:, 1]) / np.where(a[:, 1] == b[:, 1], np.inf, b[:, 1] - a[:, 1])
        crossed = (a[:, 1] != b[:, 1]) & (t >= 0) & (t <= 1)
        x = a[:, 0] + t * (b[:, 0] - a[:, 0])
        left = np.where(crossed, np.minimum(left, x), left)
        right = np.where(crossed, np.maximum(right, x), right)
    hit = left <= right
    f, y, left, right = f[hit], y[hit], left[hit], right[hit]
    start = np.clip(np.ceil(left - 0.5), 0, columns).astype(np.intp)
    stop = np.clip(np.floor(right - 0.5) + 1, 0, columns).astype(np.intp)
    span, x = _expand(start, stop)
    return f[span], y[span] * columns + x


def _expand(start: NDArray[np.intp], stop: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """All pairs (i, j) with start[i] <= j < stop[i]."""
    count = np.maximum(stop - start, 0)
    i = np.repeat(np.arange(len(start)), count)
    before = np.cumsum(count) - count
    return i, np.arange(len(i)) - before[i] + start[i]


def _barycentric(points: Floats, faces: NDArray[np.intp], nearest: NDArray[np.intp], columns: int) -> Floats:
    """(n_pixels, 3): weights of the corners of the face seen at each pixel's centre, 0 where there is none."""
    weights = np.zeros((len(nearest), 3))
    pixel = np.flatnonzero(nearest >= 0)
    a, b, c = (points[faces[nearest[pixel], k], :2] for k in range(3))
    p = np.stack([pixel % columns + 0.5, pixel // columns + 0.5], axis=1)
    whole = _cross(b - a, c - a)
    beta, gamma = _cross(p - a, c - a) / whole, _cross(b - a, p - a) / whole
    weights[pixel] = np.clip(np.stack([1.0 - beta - gamma, beta, gamma], axis=1), 0.0, 1.0)
    return weights


def _cross(u: Floats, v: Floats) -> Floats:
    """Twice the signed area spanned by plane vectors."""
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def shade(
    vertices: Floats, faces: NDArray[np.intp], colours: Floats, view: Floats, *, pixels: int, zoom: float
) -> NDArray[Any]:
    """Square RGBA picture of a mesh in a colour per vertex, lit from the viewer, anti-aliased two by two.

    Parameters
    ----------
    vertices : (n, 3) ndarray of float
        Positions, centred at the point that comes to the middle of the picture.
    faces : (n_faces, 3) ndarray of intp
        Triangles; both sides are shown.
    colours : (n, 3) ndarray of float
        Red, green, blue in [0, 1].
    view : (3, 3) ndarray of float
        Rows right, up, towards the viewer: see `camera`.
    pixels : int
        Side of the picture.
    zoom : float
        Pixels for one unit of length.
    """
    n = 2 * pixels
    seen = vertices @ view.T
    points = np.stack([n / 2 + 2 * zoom * seen[:, 0], n / 2 - 2 * zoom * seen[:, 1], 2 * zoom * seen[:, 2]], axis=1)
    face, weights = rasterize(points, faces, (n, n))
    hit = face >= 0
    corners = faces[face[hit]]
    picture = np.zeros((n, n, 4))
    picture[hit, :3] = np.einsum("ij,ijk->ik", weights[hit], colours[corners])
    a, b, c = (zoom * seen[corners[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    facing = np.abs(normal[:, 2]) / np.where(length == 0.0, 1.0, length)
    picture[hit, :3] *= (0.6 + 0.4 * facing)[:, None]
    picture[hit, 3] = 1.0
    premultiplied = picture.reshape(pixels, 2, pixels, 2, 4).mean(axis=(1, 3))
    alpha = premultiplied[..., 3:]
    return np.concatenate([premultiplied[..., :3] / np.where(alpha == 0.0, 1.0, alpha), alpha], axis=2)
