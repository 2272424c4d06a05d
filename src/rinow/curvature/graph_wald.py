"""Wald curvature at the nodes of a graph: embedding curvatures of quadruples of a node and three landmarks around."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.graph_rows import N_BLOCKS, Arcs
from rinow.embedding.point_set import many_closest_curvatures
from rinow.embedding.quadruple import embedding_curvatures
from rinow.kernels import landmarks

__all__ = ["wald_at_nodes"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

LEAST_NODES = 200
"""Nodes of a ball: the error of one quadruple is its distortion over the cube of its size."""
N_LANDMARKS = 12
"""Landmarks beside the node; 220 triples of them."""
CHUNK, MOST_CALLS = 512, 64
"""Nodes whose landmarks are sought by one call of the kernel, unless that makes more calls: each looks at all nodes of
the graph before.  Of so many the quadruples are held in memory at a time."""
MOST_CODES = 1 << 10
"""Different lengths below which those of a quadruple, as digits, make one number."""
TREE_SLACK = 1e-9
"""Two sums of opposite distances are equal when they differ by this share of the largest: the quadruple is a tree's."""
MAD_TO_SIGMA = 1.4826
PAIRS = np.triu_indices(4, 1)


def wald_at_nodes(
    arcs: Arcs,
    radius: float | None,
    nodes: Indices | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> tuple[Floats, Floats, Floats]:
    """Curvature, its spread and the radius of the ball at each node.

    Parameters
    ----------
    arcs : Arcs
        An undirected graph.
    radius : float or None
        Radius of the balls in the unit of the lengths; by default the least ball with 200 nodes.
    nodes : (n,) ndarray of intp, optional
        The nodes wanted; by default all.
    progress : callable, optional
        Called with the number of nodes done and that of all wanted.

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
    rows, limit = arcs.rows(arcs.lengths), np.nan if radius is None else radius
    step = max(CHUNK, -(-n // MOST_CALLS))
    for start in range(0, n, step):
        centres = nodes[start : start + step]
        D = np.empty((len(centres), N_LANDMARKS + 1, N_LANDMARKS + 1))
        counts = np.empty(len(centres), np.intp)
        landmarks.local_spaces(centres, limit, LEAST_NODES, rows, N_BLOCKS, D, counts, radii[start:])
        for count in np.unique(counts[counts >= 4]):
            of_size = np.flatnonzero(counts == count)
            for chosen in np.split(of_size, range(CHUNK, len(of_size), CHUNK)):
                values[start + chosen], spreads[start + chosen] = _of_spaces(D[chosen][:, :count, :count])
        if progress is not None:
            progress(start + len(centres), n)
    return values, spreads, radii


def _of_spaces(D: Floats) -> tuple[Floats, Floats]:
    """Median and spread of the curvatures of the quadruples with point 0, for a batch of spaces of one size."""
    triples = np.array(list(combinations(range(1, D.shape[1]), 3)), np.intp)
    quadruples = np.insert(triples, 0, 0, axis=1)
    distances = D[:, quadruples[:, PAIRS[0]], quadruples[:, PAIRS[1]]]
    values, count, is_tree = _curvatures(distances.reshape(-1, 6), np.unique(D))
    # A fit to points of a tree has no minimum; then the root nearer to 0 is taken.
    centre = np.repeat(np.nan_to_num(many_closest_curvatures(D)), len(quadruples))[:, None]
    away = np.where(np.isnan(values), np.inf, np.abs(values - centre))
    nearest = np.take_along_axis(values, away.argmin(axis=1)[:, None], axis=1)[:, 0]
    nearest[is_tree] = -np.inf
    nearest[count == -1] = np.nan
    return _medians(nearest.reshape(len(D), -1))


def _curvatures(distances: Floats, lengths: Floats) -> tuple[Floats, NDArray[np.intp], NDArray[np.bool_]]:
    """(m, 2), (m,), (m,): embedding curvatures of quadruples, their numbers, and whether they are those of a tree.

    Of quadruples with the same distances, as most of a graph without lengths are, one is looked at; `lengths` are all
    their distances, ascending.
    """
    place: Any = slice(None)
    if len(lengths) < MOST_CODES:
        numbers = np.searchsorted(lengths, distances) @ len(lengths) ** np.arange(6)
        _, first, place = np.unique(numbers, return_index=True, return_inverse=True)
        distances = distances[first]
    found = embedding_curvatures(distances)
    return found.values[place], found.count[place], _is_tree(distances, found.count)[place]


def _is_tree(distances: Floats, count: NDArray[np.int_]) -> NDArray[np.bool_]:
    """Quadruples of four ends of an H, or three ends of a tripod and its middle: trees have no finite curvature."""
    d12, d13, d14, d23, d24, d34 = np.moveaxis(distances, -1, 0)
    sums = np.sort(np.stack([d12 + d34, d13 + d24, d14 + d23]), axis=0)
    slack = TREE_SLACK * sums[2]
    return (count == 0) | ((count == 1) & (sums[2] - sums[1] <= slack) & (sums[1] - sums[0] > slack))


def _medians(values: Floats) -> tuple[Floats, Floats]:
    """Median of each row without nan, and the standard deviation of its finite values by their median deviation."""
    middle, n_finite = _middle(values), np.isfinite(values).sum(axis=1)
    finite = np.where(np.isfinite(values), values, np.nan)
    spread = MAD_TO_SIGMA * _middle(np.abs(finite - _middle(finite)[:, None]))
    return middle, np.where(n_finite > 1, spread, np.nan)


def _middle(values: Floats) -> Floats:
    """Median of each row without nan; of two of which one is infinite, the lesser."""
    rows, ordered = np.arange(len(values)), np.sort(values, axis=1)
    count = np.count_nonzero(~np.isnan(values), axis=1)
    low, high = (ordered[rows, np.maximum(i, 0)] for i in ((count - 1) // 2, count // 2))
    with np.errstate(invalid="ignore"):
        return np.where(np.isinf(low) | np.isinf(high), low, 0.5 * (low + high))
