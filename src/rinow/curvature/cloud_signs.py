"""Signs of the normals of a point cloud: that of one point tells those of its neighbours, and so on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree

from rinow.kernels import clouds

__all__ = ["outward"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

ROUND = 0.2
"""Mean distance of a middle from the tangent planes, over that from the points, that shows an inside: 1 for a sphere,
0.4 for a torus, 0 for the graph of a function."""


def outward(points: Floats, normals: Floats, links: csr_array) -> Floats:
    """Normals with signs that agree along the tree of links on which they turn least, and point outwards.

    Parameters
    ----------
    points, normals : (n, 3) ndarray of float
        Positions and unit normals of any signs.
    links : (n, n) csr_array
        Which points are neighbours.

    Returns
    -------
    normals : (n, 3) ndarray of float
        The same with signs.

    Notes
    -----
    The reflection that swaps two points of a circle swaps its normals.  So a normal is expected to be the mirror image
    of that of its neighbour, across a wall as around an edge.
    """
    rows = np.repeat(np.arange(len(points)), np.diff(links.indptr))
    step = points[links.indices] - points[rows]
    step /= np.maximum(np.linalg.norm(step, axis=1), np.finfo(float).tiny)[:, None]
    here, there = np.sum(step * normals[rows], axis=1), np.sum(step * normals[links.indices], axis=1)
    turn = 1.0 - np.abs(np.sum(normals[rows] * normals[links.indices], axis=1) - 2.0 * here * there)
    # Steps along the surface are preferred to those across a gap between two sheets.
    rise = np.maximum(np.abs(here), np.abs(there))
    tree = minimum_spanning_tree(csr_array((1e-6 + turn + rise, links.indices, links.indptr), shape=links.shape))
    _, labels = connected_components(tree, directed=False)
    signs = np.empty(len(points))
    clouds.carry_signs(*_rooted(tree, np.unique(labels, return_index=True)[1]), points, normals, signs)
    normals = normals * signs[:, None]
    return normals * _signs_of_parts(points, normals, labels)[labels, None]


def _rooted(forest: csr_array, roots: Indices) -> tuple[Indices, Indices]:
    """The nodes of a forest, each after its parent, and their parents; those of the roots are one more node."""
    n = len(forest.indptr) - 1
    at = coo_array(forest)
    rows, columns = np.append(at.coords[0], np.full(len(roots), n)), np.append(at.coords[1], roots)
    tree = csr_array((np.ones(len(rows)), (rows, columns)), shape=(n + 1, n + 1))
    order, parents = breadth_first_order(tree, n, directed=False, return_predecessors=True)
    return np.asarray(order)[1:], np.asarray(parents)


def _signs_of_parts(points: Floats, normals: Floats, labels: Indices) -> Floats:
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
