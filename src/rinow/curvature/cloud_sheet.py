"""A point cloud as the fits of patches see it: neighbours, normals of agreeing signs, and the spacing of the points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree

from rinow.curvature.cloud_faces import agreed_triangles
from rinow.curvature.cloud_holes import filled
from rinow.curvature.stencils import N_BLOCKS, NEEDLES
from rinow.kernels import balls, clouds, stencils

__all__ = ["Cloud", "cloud_sheet"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

SKEW = 0.1
"""Shear of the plane along the long axis of a star.  Rectangles of rows of points have two Delaunay triangulations;
all are cut along the same one of their diagonals then, as in a structured mesh."""
ROUND = 0.2
"""Mean distance of a middle from the tangent planes, over that from the points, that shows an inside: 1 for a sphere,
0.4 for a torus, 0 for the graph of a function."""
BORDER_GAP = 2.8
"""Angle between neighbours, in radians, that tells a border: inside, Delaunay triangles have less."""


class Cloud(NamedTuple):
    """A cloud as the fits see it, the triangles on which its stars agree, and which points are at a border."""

    sheet: balls.Sheet
    faces: Indices
    at_border: Bools


def cloud_sheet(points: Floats, distances: Floats, near: Indices) -> Cloud:
    """The sheet of a cloud of distinct finite points, in their order, with their nearest ones.

    Neighbours are those of the Delaunay triangulation of the nearest points, laid over the plane of least squares.
    Normals are the area vectors of these stars, averaged over the neighbours; their signs are carried along the tree
    on which normals turn least; see `_outward` for that of the whole.
    """
    normals, vectors = np.empty_like(points), np.empty_like(points)
    clouds.plane_normals(points, near, normals)
    star, counts, gaps = np.empty_like(near), np.empty(len(points), np.intp), np.empty(len(points))
    clouds.long_axes(points, normals, star, 0 * counts, vectors)
    clouds.stars(points, normals, vectors, 0.0, near, N_BLOCKS, star, counts, gaps)
    normals *= _agreeing_signs(points, normals, _links(star, counts))[:, None]
    clouds.long_axes(points, normals, star, counts, vectors)
    clouds.stars(points, normals, vectors, SKEW, near, N_BLOCKS, star, counts, gaps)
    links = _links(star, counts)
    offsets, neighbours = links.indptr.astype(np.int32), links.indices.astype(np.int32)
    clouds.star_area_vectors(points, normals, star, counts, vectors)
    for _ in range(2):
        stencils.ring_directions(vectors, False, offsets, neighbours, normals)
        vectors = normals.copy()
    sheet = balls.Sheet(points, normals, offsets, neighbours, _spacing(points, distances, offsets, neighbours), True)
    reach, at_border = distances[:, -1], gaps > BORDER_GAP
    faces = agreed_triangles(points, star, counts, reach)
    return Cloud(sheet, filled(points, normals, faces, reach, at_border), at_border)


def _spacing(points: Floats, distances: Floats, offsets: NDArray[np.int32], neighbours: NDArray[np.int32]) -> Floats:
    """Mean distance of neighbours, between the edge of equilateral triangles of the same density and some of it.

    The same rule as for meshes: rows of points need the larger one, clusters must not get too small a one.
    """
    edges, sums = np.empty(len(points)), np.empty(len(points))
    stencils.mean_edge_lengths(points, offsets, neighbours, edges)
    even = np.sqrt(2.0 / np.sqrt(3.0) * np.pi / (distances.shape[1] + 0.5)) * distances[:, -1]
    local = np.clip(edges, even, NEEDLES * even)
    stencils.ring_sums(local, offsets, neighbours, sums)
    return sums / (np.diff(offsets) + 1)


def _links(star: Indices, counts: Indices) -> csr_array:
    """Symmetric neighbourhoods: two points are joined if one is in the star of the other."""
    n = len(star)
    columns = star[np.arange(star.shape[1]) < counts[:, None]]
    rows = np.repeat(np.arange(n), counts)
    directed = csr_array(coo_array((np.ones(len(rows)), (rows, columns)), shape=(n, n)))
    links = csr_array(directed + directed.T)
    links.sort_indices()
    return links


def _agreeing_signs(points: Floats, normals: Floats, links: csr_array) -> Floats:
    """Signs with which normals agree between neighbours, along the tree where they turn least, and point outwards."""
    rows = np.repeat(np.arange(len(points)), np.diff(links.indptr))
    turn = 1.0 - np.abs(np.sum(normals[rows] * normals[links.indices], axis=1))
    # Steps along the surface are preferred to those across a gap between two sheets.
    step = points[links.indices] - points[rows]
    rise = np.abs(np.sum(step * normals[rows], axis=1)) / np.maximum(np.linalg.norm(step, axis=1), 1e-300)
    tree = minimum_spanning_tree(csr_array((1e-6 + turn + rise, links.indices, links.indptr), shape=links.shape))
    _, labels = connected_components(tree, directed=False)
    signs = np.empty(len(points))
    clouds.carry_signs(*_rooted(tree, np.unique(labels, return_index=True)[1]), normals, signs)
    return signs * _outward(points, normals * signs[:, None], labels)[labels]


def _rooted(forest: csr_array, roots: Indices) -> tuple[Indices, Indices]:
    """The nodes of a forest, each after its parent, and their parents; those of the roots are one more node."""
    n = len(forest.indptr) - 1
    at = coo_array(forest)
    rows, columns = np.append(at.coords[0], np.full(len(roots), n)), np.append(at.coords[1], roots)
    tree = csr_array((np.ones(len(rows)), (rows, columns)), shape=(n + 1, n + 1))
    order, parents = breadth_first_order(tree, n, directed=False, return_predecessors=True)
    return np.asarray(order)[1:], np.asarray(parents)


def _outward(points: Floats, normals: Floats, labels: Indices) -> Floats:
    """(n_parts,): signs with which the normals of each part point away from its middle, for the mean of its points.

    Where that is about 0, as on the graph of a function, they point upwards at the highest point.
    """
    counts = np.bincount(labels)
    middles = np.stack([np.bincount(labels, x) for x in points.T], axis=1) / counts[:, None]
    away = points - middles[labels]
    along = np.bincount(labels, np.sum(away * normals, axis=1))
    share = along / np.maximum(np.bincount(labels, np.linalg.norm(away, axis=1)), np.finfo(float).tiny)
    by_height = np.lexsort((points[:, 2], labels))
    upward = normals[by_height[np.cumsum(counts) - 1], 2]
    return np.where(np.where(np.abs(share) > ROUND, share, upward) < 0.0, -1.0, 1.0)
