"""Stars of the points of a cloud: neighbours around each normal, and how far those of different points agree."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from rinow.curvature.stencils import N_BLOCKS
from rinow.kernels import clouds, stencils

__all__ = ["FEW", "Stars", "agreement", "first_stars", "links_of", "normals_of", "stars_over"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


FEW = 12
"""Points to which the first plane is fitted: two rings would see around edges."""


class Stars(NamedTuple):
    """Row v of `points` begins with the counts[v] neighbours of v around its normal; `gaps` are their widest angles."""

    points: Indices
    counts: Indices
    gaps: Floats


def stars_over(
    points: Floats, normals: Floats, near: Indices, before: Stars | None = None, skew: Floats | None = None
) -> Stars:
    """Neighbours in the Delaunay triangulations of the nearest points, each laid over the plane across its normal.

    The plane of point v is sheared by skew[v] along the long axis of its star before.
    """
    n = len(points)
    star, counts, gaps, axes = np.empty_like(near), np.zeros(n, np.intp), np.empty(n), np.empty_like(points)
    clouds.long_axes(points, normals, *((star, counts) if before is None else before[:2]), axes)
    skew = np.zeros(n) if skew is None else skew
    clouds.stars(points, normals, axes, skew, near, N_BLOCKS, star, counts, gaps)
    return Stars(star, counts, gaps)


def first_stars(points: Floats, near: Indices) -> tuple[Floats, Stars]:
    """Unit normals, of any signs, of the planes through the first few points near each one, and the stars over them."""
    normals = np.empty_like(points)
    clouds.plane_normals(points, near, FEW, normals)
    return normals, stars_over(points, normals, near)


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


def agreement(stars: Stars) -> Floats:
    """(n,): share of the triangles of each star that are in the stars of all their corners; 0 for none."""
    out = np.empty(len(stars.points))
    clouds.agreement(stars.points, stars.counts, out)
    return out
