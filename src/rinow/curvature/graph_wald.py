"""Wald curvature at the nodes of a graph: embedding curvatures of quadruples of a node and three landmarks around."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.graph_rows import N_BLOCKS, Arcs
from rinow.embedding.point_set import closest_curvatures
from rinow.embedding.quadruple import embedding_curvatures
from rinow.kernels import landmarks

__all__ = ["wald_at_nodes"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

LEAST_NODES = 200
"""Nodes of a ball: the error of one quadruple is its distortion over the cube of its size."""
N_LANDMARKS = 12
"""Landmarks beside the node; 220 triples of them."""
CHUNK = 512
"""Nodes whose quadruples are held in memory at a time."""
TREE_SLACK = 1e-9
"""Two sums of opposite distances are equal when they differ by this share of the largest: the quadruple is a tree's."""
MAD_TO_SIGMA = 1.4826
PAIRS = np.triu_indices(4, 1)


def wald_at_nodes(arcs: Arcs, radius: float | None, nodes: Indices | None = None) -> tuple[Floats, Floats, Floats]:
    """Curvature, its spread and the radius of the ball at each node.

    Parameters
    ----------
    arcs : Arcs
        An undirected graph.
    radius : float or None
        Radius of the balls in the unit of the lengths; by default the least ball with 200 nodes.
    nodes : (n,) ndarray of intp, optional
        The nodes wanted; by default all.

    Returns
    -------
    values : (n,) ndarray of float
        Median of the embedding curvatures nearest to the curvature fitted to all landmarks; -inf where most
        quadruples are those of a tree; nan where there are none but linear ones.
    spreads : (n,) ndarray of float
        Standard deviation of the single values by their median deviation; nan for less than two finite ones.
    radii : (n,) ndarray of float
        Radius of the ball.
    """
    if nodes is None:
        nodes = np.arange(arcs.n_nodes)
    n = len(nodes)
    values, spreads, radii = np.full(n, np.nan), np.full(n, np.nan), np.zeros(n)
    rows = arcs.rows(arcs.lengths)
    for start in range(0, n, CHUNK):
        centres = nodes[start : start + CHUNK]
        D = np.empty((len(centres), N_LANDMARKS + 1, N_LANDMARKS + 1))
        counts = np.empty(len(centres), np.intp)
        limit = np.nan if radius is None else radius
        landmarks.local_spaces(centres, limit, LEAST_NODES, rows, N_BLOCKS, D, counts, radii[start:])
        for count in np.unique(counts[counts >= 4]):
            chosen = np.flatnonzero(counts == count)
            values[start + chosen], spreads[start + chosen] = _of_spaces(D[chosen][:, :count, :count])
    return values, spreads, radii


def _of_spaces(D: Floats) -> tuple[Floats, Floats]:
    """Median and spread of the curvatures of the quadruples with point 0, for a batch of spaces of one size."""
    triples = np.array(list(combinations(range(1, D.shape[1]), 3)), np.intp)
    quadruples = np.insert(triples, 0, 0, axis=1)
    distances = D[:, quadruples[:, PAIRS[0]], quadruples[:, PAIRS[1]]]
    found = embedding_curvatures(distances)
    # A fit to points of a tree has no minimum; then the root nearer to 0 is taken.
    centre = np.nan_to_num(closest_curvatures(D))[:, None, None]
    away = np.where(np.isnan(found.values), np.inf, np.abs(found.values - centre))
    nearest = np.take_along_axis(found.values, away.argmin(axis=-1)[..., None], axis=-1)[..., 0]
    nearest[_is_tree(distances, found.count)] = -np.inf
    nearest[found.count == -1] = np.nan
    return _medians(nearest)


def _is_tree(distances: Floats, count: NDArray[np.int_]) -> NDArray[np.bool_]:
    """Quadruples of four ends of an H, or three ends of a tripod and its middle: trees have no finite curvature."""
    d12, d13, d14, d23, d24, d34 = np.moveaxis(distances, -1, 0)
    sums = np.sort(np.stack([d12 + d34, d13 + d24, d14 + d23]), axis=0)
    slack = TREE_SLACK * sums[2]
    return (count == 0) | ((count == 1) & (sums[2] - sums[1] <= slack) & (sums[1] - sums[0] > slack))


def _medians(values: Floats) -> tuple[Floats, Floats]:
    """Median of each row without nan, and the standard deviation of its finite values by their median deviation."""
    middle, spread = np.full(len(values), np.nan), np.full(len(values), np.nan)
    for i, row in enumerate(values):
        known = np.sort(row[~np.isnan(row)])
        if len(known):
            middle[i] = known[(len(known) - 1) // 2] if np.isinf(known[len(known) // 2]) else np.median(known)
        finite = known[np.isfinite(known)]
        if len(finite) > 1:
            spread[i] = MAD_TO_SIGMA * np.median(np.abs(finite - np.median(finite)))
    return middle, spread
