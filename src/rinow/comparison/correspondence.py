"""Distortion of relations, and the uniform distance of two metrics on one set."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import as_index_tuples
from rinow.comparison.engine import RELATION, worst_of
from rinow.comparison.lipschitz import as_map
from rinow.errors import InvalidInputError
from rinow.metric_space import both_distances

__all__ = ["as_relation", "distortion", "uniform_distance"]

Indices = NDArray[np.intp]


def distortion(relation: ArrayLike, X: Any, Y: Any) -> float:
    r"""Distortion of a relation or map: the largest difference of two distances that it makes correspond.

    Parameters
    ----------
    relation : (k, 2) or (n,) array_like of int
        Pairs of indices (x, y), or the image in Y of each point of X.
    X, Y : MetricSpace or square array_like of float
        The spaces, of n and m points, in one unit of length.

    Returns
    -------
    distortion : float
        Largest :math:`|d(x, x') - d(y, y')|` over two pairs, in the unit of the spaces; 0 for a single pair.

    Raises
    ------
    InvalidInputError
        If `relation` has another shape, is empty or an index is out of range.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    gromov_hausdorff : Half the least distortion of a relation in which every point occurs.
    dilatation : The same for ratios.

    Notes
    -----
    The relation need not cover the spaces.  dis(S ∘ R) <= dis R + dis S.  The cost is O(k²).

    Examples
    --------
    A segment of length 3 with its middle, and its ends alone; the middle corresponds to either end:

    >>> X, Y = [[0, 1.5, 3], [1.5, 0, 1.5], [3, 1.5, 0]], [[0, 3], [3, 0]]
    >>> distortion([[0, 0], [1, 0], [2, 1]], X, Y), distortion([0, 1, 1], X, Y)
    (1.5, 1.5)
    """
    DX, DY = both_distances(X, Y)
    return worst_of(RELATION, DX, DY, as_relation(relation, len(DX), len(DY)))


def as_relation(relation: ArrayLike, n: int, m: int) -> Indices:
    """Pairs (x, y) with x < n and y < m, from pairs or from a map."""
    array = np.asarray(relation)
    if array.ndim == 1:
        return np.stack([np.arange(n), as_map(array, n, m)], axis=1)
    pairs = as_index_tuples(array, width=2, n_points=max(n, m), name="relation")
    if not len(pairs):
        raise InvalidInputError("relation is empty; give at least one pair (x, y).")
    for column, size in ((0, n), (1, m)):
        wrong = np.flatnonzero(pairs[:, column] >= size)
        if len(wrong):
            k = int(wrong[0])
            raise InvalidInputError(
                f"relation[{k}, {column}] = {pairs[k, column]} is outside 0..{size - 1}; give pairs (x, y)."
            )
    return pairs


def uniform_distance(X: Any, Y: Any) -> float:
    r"""Uniform distance of two metrics on one set: the largest difference between them.

    Parameters
    ----------
    X, Y : MetricSpace or (n, n) array_like of float
        The same n points with two metrics.

    Returns
    -------
    distance : float
        Largest \|d_X(i, j) - d_Y(i, j)\|, in the unit of the spaces.

    Raises
    ------
    InvalidInputError
        If the spaces differ in size.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    gromov_hausdorff : At most half of it.
    lipschitz_distance

    Notes
    -----
    Lipschitz convergence implies uniform convergence of bounded spaces, \|d_X - d_Y\| <= (e^d - 1) diam with the
    Lipschitz distance d of the identity, and not conversely; the paper prints the reverse (Remark 2.16).  On one
    finite set the two agree.

    Examples
    --------
    >>> uniform_distance([[0, 1], [1, 0]], [[0, 3], [3, 0]])
    2.0
    """
    DX, DY = both_distances(X, Y)
    if len(DX) != len(DY):
        raise InvalidInputError(f"X has {len(DX)} points and Y {len(DY)}; give two metrics on one set.")
    return float(np.abs(DX - DY).max())
