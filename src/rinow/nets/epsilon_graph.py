"""Graphs on nets that approximate a length space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from rinow._arrays import as_indices
from rinow._printing import OneLine
from rinow.geodesics.length_space import as_step, step_graph
from rinow.metric_space import as_metric_space, finite_distances
from rinow.nets.farthest_point import farthest_point_net

__all__ = ["EpsilonGraph", "epsilon_graph"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_ENTRIES = 1 << 22  # of the rows of shortest paths held at one time


@dataclass(frozen=True, slots=True, repr=False)
class EpsilonGraph(OneLine):
    r"""Graph on a net of a space whose shortest paths approximate the distances.

    Attributes
    ----------
    graph : (k, k) scipy.sparse.csr_array of float
        Points of the net at distances below ε, joined by edges with these lengths.
    indices : (k,) ndarray of intp
        The points of the net in the space.
    delta : float
        Covering radius of the net, in the unit of length.
    error_bound : float
        The least number with :math:`d_X \le d_G \le d_X + error_bound` on the net, measured over all pairs; inf for a
        graph in several parts.
    is_fine_enough : bool
        Whether δ < ε²/(4 diam): on a length space this alone makes the error less than ε.
    """

    graph: csr_array
    indices: Indices
    delta: float
    error_bound: float
    is_fine_enough: bool


def epsilon_graph(space: Any, epsilon: float, *, indices: ArrayLike | None = None) -> EpsilonGraph:
    r"""Graph that approximates a length space: a net, with edges between points closer than ε.

    Parameters
    ----------
    space : MetricSpace or (n_points, n_points) array_like of float
        A finite space, as a rule points of a length space that lie close together.
    epsilon : float
        Edges are shorter than this, positive, in the unit of length.
    indices : (k,) array_like of int, optional
        The net; by default farthest points until δ < ε²/(4 diam).

    Returns
    -------
    graph : EpsilonGraph
        The graph, its net and the error of its distances.

    Raises
    ------
    InvalidInputError
        If `epsilon` is not positive, `indices` is empty or out of range, or a distance is infinite.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    farthest_point_net : The net.
    rinow.length_defect : How far a finite space is from a length space.

    Notes
    -----
    Theorem 2.51 of the paper: for a δ-net of a compact length space X with δ < ε²/(4 diam X)

    .. math:: d_X \le d_G \le d_X + ε

    on the net, since a shortest path of length ℓ, cut into at most 2ℓ/ε + 1 parts of length ε/2 at most, has corners of
    the net within δ of the cuts, and each inner one adds 2δ at most.  The printed proof also has δ < (ε²/4) diam X,
    with which the graph may have no edge at all.  Corollary 2.52 claims more than follows: the *vertices* lie in X, but
    in general no isometric image of the graph does.

    A finite space is no length space: where it has gaps near ε the theorem does not apply, whatever δ.  So the error is
    measured: shortest paths from all k points, O(k (k + n_edges) log k).

    Examples
    --------
    A circle of length 2π, given by 200 of its points, and a graph on 40 of them:

    >>> t = np.arange(200) * (2 * np.pi / 200)
    >>> arcs = np.abs(t[:, None] - t)
    >>> circle = np.minimum(arcs, 2 * np.pi - arcs)
    >>> result = epsilon_graph(circle, 1.0, indices=np.arange(0, 200, 5))
    >>> print(f"{result.delta:.4f} {result.is_fine_enough} {result.error_bound:.4f}")
    0.0628 True 0.0000
    """
    whole = as_metric_space(space)
    D, step = finite_distances(whole), as_step(epsilon, "epsilon")
    fine = step * (step / (4.0 * whole.diameter)) if whole.diameter > 0.0 else np.inf
    if indices is None:
        chosen = farthest_point_net(whole, radius=float(np.nextafter(fine, 0.0))).indices
    else:
        chosen = as_indices(indices, len(D), "indices")
    subset = whole.subspace(chosen).distances
    graph = step_graph(subset, step)
    delta = _covering_radius(D, chosen)
    return EpsilonGraph(graph, chosen, delta, _error(graph, subset), bool(delta < fine))


def _covering_radius(D: Floats, chosen: Indices) -> float:
    """Greatest distance of a point from the chosen ones."""
    return float(D[:, chosen].min(axis=1).max())


def _error(graph: csr_array, D: Floats) -> float:
    """Greatest excess of a shortest path over the distance."""
    worst, step = 0.0, max(_ENTRIES // len(D), 1)
    for first in range(0, len(D), step):
        rows = np.arange(first, min(first + step, len(D)))
        worst = max(worst, float((dijkstra(graph, indices=rows) - D[rows]).max()))
    return worst
