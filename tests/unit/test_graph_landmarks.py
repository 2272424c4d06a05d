"""Landmarks around the nodes of a graph, met halfway, and the curvatures of their quadruples, many at once."""

import networkx as nx
import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import shortest_path

import rinow
from rinow.curvature import graph_wald
from rinow.curvature.graph_rows import as_arcs
from rinow.curvature.graph_wald import N_LANDMARKS, wald_at_nodes
from rinow.embedding.point_set import closest_curvatures, many_closest_curvatures
from rinow.kernels import landmarks


def spaces_of(graph, centres, radius=np.nan, least=200, n_blocks=3):
    """Distances of the landmarks around some nodes, and the radii of their balls."""
    arcs = as_arcs(graph, False)
    n, size = len(centres), N_LANDMARKS + 1
    D, counts, radii = np.full((n, size, size), np.nan), np.empty(n, np.intp), np.empty(n)
    rows = arcs.rows(arcs.lengths)
    landmarks.local_spaces(np.asarray(centres, np.intp), radius, least, rows, n_blocks, D, counts, radii)
    return [matrix[:count, :count] for matrix, count in zip(D, counts, strict=True)], radii


def farthest_first(D, v, radius, least):
    """The same from all distances of the graph: no two of them may be equal."""
    reach = radius if np.isfinite(radius) else np.sort(D[v])[min(least, np.isfinite(D[v]).sum()) - 1]
    ball, chosen = np.flatnonzero(reach >= D[v]), [v]
    while len(chosen) < min(N_LANDMARKS + 1, len(ball)):
        chosen.append(ball[D[np.ix_(ball, chosen)].min(axis=1).argmax()])
    return D[np.ix_(chosen, chosen)]


def weighted(graph, seed):
    """A networkx graph as a matrix with random lengths."""
    A = nx.to_scipy_sparse_array(graph).tocoo()
    return coo_array((np.random.default_rng(seed).uniform(0.1, 3.0, len(A.data)), A.coords), shape=A.shape).tocsr()


GRAPHS = {
    "small world": nx.watts_strogatz_graph(400, 6, 0.1, seed=3),
    "hubs": nx.barabasi_albert_graph(400, 2, seed=3),
    "grid": nx.convert_node_labels_to_integers(nx.grid_2d_graph(20, 20)),
    "parts": nx.gnm_random_graph(400, 360, seed=3),
}


@pytest.mark.parametrize("name", GRAPHS)
@pytest.mark.parametrize(("radius", "least"), [(np.nan, 60), (np.nan, 5), (4.0, 60)])
def test_searches_that_meet_halfway_know_the_shortest_paths(name, radius, least):
    graph = weighted(GRAPHS[name], seed=4)
    D = shortest_path(graph, directed=False)
    found, _ = spaces_of(graph, range(0, 400, 7), radius, least)
    for v, matrix in zip(range(0, 400, 7), found, strict=True):
        # Lengths are added from the other end: rounding.
        np.testing.assert_allclose(matrix, farthest_first(D, v, radius, least), rtol=1e-13, atol=0.0)


@pytest.mark.parametrize("name", GRAPHS)
def test_equal_lengths_are_searched_without_a_heap_to_the_same_distances(name):
    graph = nx.to_scipy_sparse_array(GRAPHS[name]).tocoo()
    rows, columns = (np.append(x, [400 + i]) for i, x in enumerate(graph.coords))
    # Two more nodes, which no other one is joined to, with an edge of another length.
    uneven = coo_array((np.append(graph.data, 2.0), (rows, columns)), shape=(402, 402))
    even, other = spaces_of(graph, range(400), least=40), spaces_of(uneven, range(400), least=40)
    np.testing.assert_array_equal(even[1], other[1])
    for a, b in zip(even[0], other[0], strict=True):
        np.testing.assert_array_equal(a, b)


def test_many_sets_are_fitted_as_each_alone():
    graph, surface = GRAPHS["small world"], rinow.SpaceForm(-1.0)
    points = surface.sample(13 * 40, 1.0, np.random.default_rng(8)).reshape(40, 13, -1)
    of_surface = np.array([surface.distance(P[:, None], P) for P in points])
    of_surface = 0.5 * (of_surface + of_surface.transpose(0, 2, 1))
    of_graph = np.array([D for D in spaces_of(graph, range(200))[0] if len(D) == 13])
    assert np.isnan(closest_curvatures(of_graph)).any()  # the iteration ends at a bound
    for D in (of_surface, of_graph, of_surface * 1e-60):
        np.testing.assert_allclose(many_closest_curvatures(D), closest_curvatures(D), rtol=1e-9)


def test_quadruples_of_the_same_distances_have_the_same_values(monkeypatch):
    arcs = as_arcs(GRAPHS["grid"], False)
    few = wald_at_nodes(arcs, None)
    monkeypatch.setattr(graph_wald, "MOST_CODES", 0)  # each is looked at
    for a, b in zip(few, wald_at_nodes(arcs, None), strict=True):
        np.testing.assert_array_equal(a, b)


def test_progress_counts_the_nodes():
    graph = nx.cycle_graph(1300)
    for kind, calls in (("wald", 3), ("menger", 1)):
        seen = []
        rinow.graph_curvature(graph, kind=kind, progress=lambda *given, seen=seen: seen.append(given))
        assert seen[-1] == (1300, 1300)
        assert len(seen) == calls
        assert seen == sorted(seen)
