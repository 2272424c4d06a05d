"""Curvature of graphs: Wald's at nodes, Menger's and Haantjes's of edges and nodes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import as_radius, in_safe_unit, in_unit
from rinow._printing import OneLine
from rinow.curvature.graph_rows import N_BLOCKS, Arcs, as_arcs
from rinow.curvature.graph_wald import wald_at_nodes
from rinow.errors import InvalidInputError
from rinow.kernels import graphs

__all__ = ["GraphCurvature", "graph_curvature"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

KINDS = ("wald", "menger", "haantjes")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class GraphCurvature(OneLine):
    """Curvature of a graph, in the order of its nodes and of `edge_index`.

    Attributes
    ----------
    nodes : (n,) ndarray of float
        Curvature at the nodes: in 1/length² for "wald", else the sum over the edges at the node, in 1/length.
    edges : (m,) ndarray of float
        Curvature of the edges, in 1/length; nan for "wald".
    edge_index : (m, 2) ndarray of intp
        Ends of the edges, ascending; the smaller node first, or tail and head if the graph is directed.
    spread : (n,) ndarray of float
        Standard deviation of the curvatures of the single quadruples at the node; nan for the other kinds.
    radius : (n,) ndarray of float
        Radius of the ball around the node that was looked at, a length; nan for the other kinds.
    kind : str
        The kind.
    """

    nodes: Floats
    edges: Floats
    edge_index: Indices
    spread: Floats
    radius: Floats
    kind: str


def graph_curvature(
    graph: Any,
    *,
    kind: str = "wald",
    radius: float | None = None,
    directed: bool | None = None,
    weighted: bool | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> GraphCurvature:
    r"""Curvature of a graph as a metric space: Wald's at nodes, Menger's or Haantjes's of edges and nodes.

    Parameters
    ----------
    graph : scipy sparse matrix of shape (n, n), or networkx or igraph graph
        The entries, or the edge attribute "weight" (1 where it is missing), are the lengths of the edges.  Loops
        and edges of infinite length are left out; of parallel edges the shortest counts.
    kind : {"wald", "menger", "haantjes"}, optional
        "wald": the embedding curvature of quadruples of the node and three others around it.  "menger": the sum of
        the Menger curvatures of the triangles over an edge.  "haantjes": the sum of the Haantjes curvatures of the
        simple paths of up to three edges between the ends of an edge.
    radius : float, optional
        Radius of the ball for "wald", in the unit of the lengths; by default the least ball with 200 nodes.
    directed : bool, optional
        Whether edges lead one way; by default as the graph says, and not for a matrix.  "wald" needs a
        symmetric distance, and lets every edge lead both ways.
    weighted : bool, optional
        Whether the lengths count.  By default they do unless all of them are 1; without lengths they are taken as 1.
    progress : callable, optional
        Called with the number of nodes done and their total.

    Returns
    -------
    curvature : GraphCurvature
        `nodes`, `edges` and `edge_index`.

    Raises
    ------
    InvalidInputError
        If `graph` is no graph, a length is negative or nan, `kind` is unknown, or `radius` is not positive or not
        for this kind.

    See Also
    --------
    fit_curvature : The curvature that fits any finite metric space best.

    Notes
    -----
    Distances are lengths of shortest paths, also between the ends of an edge that is longer than a detour.

    *Menger* [1]_.  An edge has :math:`\sum_T 1/R(T)` over its triangles, R the circumradius of a Euclidean triangle
    with these distances.  In a graph without lengths a triangle counts :math:`1/\sqrt 3`, as in the authors' own
    program: that is the circumradius of the unit triangle, not its inverse :math:`\sqrt 3`, which `weighted=True`
    gives.

    *Haantjes* [1]_.  An edge whose ends have distance d has :math:`\sum_\pi \sqrt{(l(\pi) - d)/d^3}` over the simple
    paths π of at most three edges, of length l(π); without lengths that is one for each triangle and √2 for each
    path of three edges.  The factor √24 of Haantjes's definition is left out, as in [1]_.  It is nan for d = 0.

    In a directed graph, paths and triangles over the edge uv lead from u to v; a triangle whose distances fail the
    triangle inequality counts 0.  The value at a node is the sum over its edges, of both directions.

    *Wald*.  Twelve landmarks as far from each other as the ball allows, the node first, have :math:`\binom{12}{3}`
    quadruples with the node.  Of the embedding curvatures of each the one nearest to `fit_curvature` of all
    landmarks is taken, and the median of these is the value.  Quadruples of a tree (four ends of an H, or a tripod
    and its middle) count as -inf, the limit of the curvatures of near ones; those on a line do not count.  On
    graphs whose distances are those of a surface up to small distortion the value is the curvature of the surface.

    Known values: a cycle of n unit edges has (2π/n)² at its nodes (its distances are those of a great circle), a
    complete graph 3.650519 from four nodes on (a regular tetrahedron of edge 1), an inner node of a tree -inf; with
    "menger" and "haantjes" an edge of a tree or of a cycle of five and more has 0, one of the complete graph of n
    nodes (n - 2)/√3 and (n - 2) + √2 (n - 2)(n - 3), an inner edge of the square grid 0 and 2√2.

    The cost is O(Σ over edges uv of the edges at the neighbours of u) for the edges, without listing a path.  "wald"
    searches about the ball from twelve landmarks for each node, which meet halfway: for each 10,000 nodes with three
    edges a node some 5 seconds on two cores, or 20 where hubs make each ball a large part of the graph.

    References
    ----------
    .. [1] E. Saucan, A. Samal, J. Jost, "A simple differential geometry for complex networks", Network Science 9
           (2021), arXiv:2004.11112.
    .. [2] J. F. du Plessis, X. D. Arsiwalla, "A cosine rule-based discrete sectional curvature for graphs", Journal
           of Complex Networks 11 (2023), arXiv:2212.04406.

    Examples
    --------
    >>> import networkx as nx
    >>> result = graph_curvature(nx.complete_graph(4), kind="haantjes")
    >>> result.edge_index[:2].tolist(), result.edges[:2].round(6).tolist()
    ([[0, 1], [0, 2]], [4.828427, 4.828427])
    >>> graph_curvature(nx.cycle_graph(12)).nodes[:2].round(6)
    array([0.274156, 0.274156])
    """
    if kind not in KINDS:
        raise InvalidInputError(f"kind = {kind!r} is unknown; choose from {', '.join(KINDS)}.")
    if radius is not None:
        radius = _checked_radius(radius, kind)
    arcs = as_arcs(graph, False if kind == "wald" else directed)
    unweighted = not weighted if weighted is not None else bool((arcs.lengths == 1.0).all())
    if weighted is False:
        arcs = Arcs(arcs.n_nodes, arcs.tails, arcs.heads, np.ones_like(arcs.lengths), arcs.is_directed)
    lengths, exponent = in_safe_unit(arcs.lengths)
    arcs = Arcs(arcs.n_nodes, arcs.tails, arcs.heads, lengths, arcs.is_directed)
    one_way = arcs.is_directed | (arcs.tails < arcs.heads)
    edge_index = np.stack([arcs.tails[one_way], arcs.heads[one_way]], axis=1)
    undefined = np.full(arcs.n_nodes, np.nan)
    if kind == "wald":
        reach = None if radius is None else float(in_unit(radius, -exponent))
        nodes, spread, radii = wald_at_nodes(arcs, reach, progress=progress)
        nodes, spread, radii = in_unit(nodes, -2 * exponent), in_unit(spread, -2 * exponent), in_unit(radii, exponent)
        return GraphCurvature(nodes, np.full(len(edge_index), np.nan), edge_index, spread, radii, kind)
    chosen = np.flatnonzero(one_way)
    edges = _menger(arcs, chosen, unweighted) if kind == "menger" else _haantjes(arcs, chosen)
    edges = in_unit(edges, -exponent)
    if progress is not None:
        progress(arcs.n_nodes, arcs.n_nodes)
    sums = np.asarray(np.bincount(edge_index.ravel(), np.repeat(edges, 2), arcs.n_nodes), np.float64)
    return GraphCurvature(sums, edges, edge_index, undefined, undefined.copy(), kind)


def _checked_radius(radius: float, kind: str) -> float:
    length = as_radius(radius)
    if kind != "wald":
        raise InvalidInputError(
            f"radius = {radius!r} is not for kind {kind!r}, which looks at single edges; leave it out."
        )
    return length


def _menger(arcs: Arcs, chosen: Indices, unweighted: bool) -> Floats:
    """Menger curvature of chosen arcs."""
    d, out = arcs.distances, np.empty(len(arcs.tails))
    order = _ordered_by_head(arcs, chosen)
    graphs.menger_curvatures(
        order, arcs.tails, arcs.heads, d, unweighted, *arcs.rows(d), arcs.rows_into(d), N_BLOCKS, out
    )
    return out[chosen]


def _haantjes(arcs: Arcs, chosen: Indices) -> Floats:
    """Haantjes curvature of chosen arcs."""
    w, out = arcs.lengths, np.empty(len(arcs.tails))
    order = _ordered_by_head(arcs, chosen)
    graphs.haantjes_curvatures(
        order, arcs.tails, arcs.heads, w, arcs.distances, *arcs.rows(w), arcs.rows_into(w), N_BLOCKS, out
    )
    return out[chosen]


def _ordered_by_head(arcs: Arcs, chosen: Indices) -> Indices:
    """Chosen arcs in an order in which those with the same head follow each other."""
    is_chosen = np.zeros(len(arcs.tails), np.bool_)
    is_chosen[chosen] = True
    return arcs.by_head[is_chosen[arcs.by_head]]
