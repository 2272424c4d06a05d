"""Stars of the points of a cloud: neighbours around each normal, and how far those of different points agree."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from rinow.curvature.stencils import N_BLOCKS
from rinow.kernels import clouds, stencils

__all__ = ["Stars", "agreement", "links_of", "normals_of", "stars_over", "triangles_of"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


class Stars(NamedTuple):
    """Row v of `points` begins with the counts[v] neighbours of v around its normal; `gaps` are their widest angles."""

    points: Indices
    counts: Indices
    gaps: Floats


def stars_over(points: Floats, normals: Floats, near: Indices, before: Stars | None = None, skew: float = 0.0) -> Stars:
    """Neighbours in the Delaunay triangulations of the nearest points, each laid over the plane across its normal.

    The planes are sheared by `skew` along the long axes of the stars before.
    """
    n = len(points)
    star, counts, gaps, axes = np.empty_like(near), np.zeros(n, np.intp), np.empty(n), np.empty_like(points)
    clouds.long_axes(points, normals, *((star, counts) if before is None else before[:2]), axes)
    clouds.stars(points, normals, axes, skew, near, N_BLOCKS, star, counts, gaps)
    return Stars(star, counts, gaps)


def links_of(stars: Stars) -> csr_array:
    """Symmetric neighbourhoods: two points are joined if one is in the star of the other."""
    n = len(stars.points)
    columns = stars.points[np.arange(stars.points.shape[1]) < stars.counts[:, None]]
    rows = np.repeat(np.arange(n), stars.counts)
    directed = csr_array(coo_array((np.ones(len(rows)), (rows, columns)), shape=(n, n)))
    links = csr_array(directed + directed.T)
    links.sort_indices()
    return links


def normals_of(points: Floats, normals: Floats, stars: Stars, links: csr_array, rounds: int) -> Floats:
    """Area vectors of the stars that face the way of the normals, averaged over the neighbours some times; units."""
    offsets, neighbours = links.indptr.astype(np.int32), links.indices.astype(np.int32)
    vectors = np.empty_like(points)
    clouds.star_area_vectors(points, normals, stars.points, stars.counts, vectors)
    for _ in range(rounds):
        averages = np.empty_like(points)
        stencils.ring_directions(vectors, False, offsets, neighbours, averages)
        vectors = averages
    return vectors


def triangles_of(stars: Stars) -> tuple[Indices, Indices, Indices, Indices]:
    """The triangles of successive neighbours in all stars.

    Returns
    -------
    owners : (n_triangles,) ndarray of intp
        The point whose star each triangle is in.
    corners : (n_triangles, 3) ndarray of intp
        Its corners, the one of least index first.
    number : (n_triangles,) ndarray of intp
        Equal for equal triangles.
    votes : (n_triangles,) ndarray of intp
        How many stars it is in: three where those of its corners agree.
    """
    n = len(stars.points)
    owners, place = np.nonzero(np.arange(stars.points.shape[1]) < stars.counts[:, None])
    second, third = stars.points[owners, place], stars.points[owners, (place + 1) % stars.counts[owners]]
    corners = np.stack([owners, second, third], axis=1)
    first = corners.argmin(axis=1)
    corners = np.take_along_axis(corners, (first[:, None] + np.arange(3)) % 3, axis=1)
    sides = np.unique(corners[:, 0] * n + corners[:, 1], return_inverse=True)[1]
    _, number, votes = np.unique(sides * n + corners[:, 2], return_inverse=True, return_counts=True)
    return owners, corners, number, votes[number]


def agreement(stars: Stars) -> Floats:
    """(n,): share of the triangles of each star that are in the stars of all their corners; 0 for none."""
    owners, _, _, votes = triangles_of(stars)
    return np.bincount(owners, votes == 3, len(stars.points)) / np.maximum(stars.counts, 1)
