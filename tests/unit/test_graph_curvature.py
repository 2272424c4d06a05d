"""Curvature of graphs: naive twins, known graphs, directed and weighted ones, space forms, and bad input."""

import math

import networkx as nx
import numpy as np
import pytest
from scipy.sparse import coo_array, csr_array

import rinow
from naive import graphs as naive
from rinow.curvature.graph_rows import as_arcs
from rinow.curvature.graph_wald import wald_at_nodes
from rinow.errors import InvalidInputError

REGULAR_TETRAHEDRON = 3.6505193604  # curvature in which four points have all distances 1: cos = 1/3 of the angle


def as_dicts(graph):
    return {u: {v: data.get("weight", 1.0) for v, data in graph[u].items() if v != u} for u in graph}


def random_graph(seed, n=14, m=38, *, directed=False, weighted=False):
    graph = nx.gnm_random_graph(n, m, seed=seed, directed=directed)
    rng = np.random.default_rng(seed)
    if weighted:
        for _, _, data in graph.edges(data=True):
            data["weight"] = float(rng.uniform(0.3, 2.0))
    return graph


@pytest.mark.parametrize("directed", [False, True])
@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("seed", [3, 4])
def test_edges_by_listing_paths(seed, weighted, directed):
    graph = random_graph(seed, directed=directed, weighted=weighted)
    table = as_dicts(graph)
    haantjes = rinow.graph_curvature(graph, kind="haantjes")
    menger = rinow.graph_curvature(graph, kind="menger")
    assert len(haantjes.edge_index) == graph.number_of_edges()
    for e, (u, v) in enumerate(haantjes.edge_index.tolist()):
        assert graph.has_edge(u, v)
        # Sums of some tens of square roots of numbers near 1.
        assert haantjes.edges[e] == pytest.approx(naive.haantjes(table, u, v), rel=1e-12, abs=1e-12)
        # The law of sines loses half of the digits on flat triangles.
        assert menger.edges[e] == pytest.approx(naive.menger(table, u, v, unweighted=not weighted), rel=1e-7, abs=1e-7)


def test_nodes_are_sums_over_their_edges():
    graph = random_graph(5, directed=True, weighted=True)
    result = rinow.graph_curvature(graph, kind="haantjes")
    for u in graph:
        assert result.nodes[u] == pytest.approx(result.edges[(result.edge_index == u).any(axis=1)].sum(), rel=1e-12)


def test_published_rule_on_graphs_without_lengths():
    graph = nx.karate_club_graph()
    for _, _, data in graph.edges(data=True):
        data.clear()
    result = rinow.graph_curvature(graph, kind="haantjes")
    menger = rinow.graph_curvature(graph, kind="menger")
    for e, (u, v) in enumerate(result.edge_index.tolist()):
        lengths = [len(path) - 1 for path in nx.all_simple_paths(graph, u, v, cutoff=3)]
        assert result.edges[e] == pytest.approx(sum(math.sqrt(k - 1) for k in lengths), rel=1e-12)
        assert menger.edges[e] == pytest.approx(lengths.count(2) / math.sqrt(3), rel=1e-12)


@pytest.mark.parametrize("kind", ["menger", "haantjes"])
def test_trees_and_long_cycles_have_flat_edges(kind):
    for graph in (nx.balanced_tree(3, 3), nx.path_graph(6), nx.cycle_graph(5), nx.star_graph(6)):
        assert (rinow.graph_curvature(graph, kind=kind).edges == 0).all()


def test_edges_of_complete_graphs_and_grids():
    for n in (3, 4, 7):
        # Over an edge there are n - 2 paths of two edges, and (n - 2)(n - 3) of three.
        menger = rinow.graph_curvature(nx.complete_graph(n), kind="menger")
        haantjes = rinow.graph_curvature(nx.complete_graph(n), kind="haantjes")
        np.testing.assert_allclose(menger.edges, (n - 2) / 3**0.5)
        np.testing.assert_allclose(haantjes.edges, n - 2 + 2**0.5 * (n - 2) * (n - 3))
        np.testing.assert_allclose(haantjes.nodes, (n - 1) * haantjes.edges[0])
    # The edge of a square lies in one or two squares, each with a path of three edges around it.
    grid = nx.grid_2d_graph(4, 4)
    result = rinow.graph_curvature(grid, kind="haantjes")
    nodes = np.array(list(grid.nodes))
    ends = nodes[result.edge_index]
    on_border = ((ends == 0).all(axis=1) | (ends == 3).all(axis=1)).any(axis=1)
    np.testing.assert_allclose(result.edges, np.where(on_border, 1, 2) * 2**0.5)
    assert (rinow.graph_curvature(grid, kind="menger").edges == 0).all()


def test_a_triangle_with_lengths_has_its_inverse_circumradius():
    graph = nx.Graph()
    graph.add_weighted_edges_from([(0, 1, 3.0), (1, 2, 4.0), (0, 2, 5.0)])
    np.testing.assert_allclose(rinow.graph_curvature(graph, kind="menger").edges, 1 / 2.5)
    # Paths 4 + 5 over 3, 3 + 5 over 4, 3 + 4 over 5.
    expected = {(0, 1): (6 / 27) ** 0.5, (1, 2): (4 / 64) ** 0.5, (0, 2): (2 / 125) ** 0.5}
    result = rinow.graph_curvature(graph, kind="haantjes")
    for pair, value in zip(result.edge_index.tolist(), result.edges, strict=True):
        assert value == pytest.approx(expected[tuple(pair)], rel=1e-14)
    unit = nx.complete_graph(3)
    np.testing.assert_allclose(rinow.graph_curvature(unit, kind="menger", weighted=True).edges, 3**0.5)
    np.testing.assert_allclose(rinow.graph_curvature(graph, kind="menger", weighted=False).edges, 3**-0.5)


def test_an_edge_longer_than_its_detour_has_the_distance_of_its_ends():
    graph = nx.Graph()
    graph.add_weighted_edges_from([(0, 1, 1.0), (1, 2, 1.0), (0, 2, 10.0)])
    result = rinow.graph_curvature(graph, kind="haantjes")
    # Between 0 and 2 at distance 2: the detour is straight, the edge itself has (10 - 2)/2³.
    np.testing.assert_allclose(result.edges, [10**0.5, 1.0, 10**0.5])
    assert result.edge_index.tolist() == [[0, 1], [0, 2], [1, 2]]
    np.testing.assert_array_equal(rinow.graph_curvature(graph, kind="menger").edges, 0)


def test_directed_edges_lead_one_way():
    graph = nx.DiGraph([(0, 1), (1, 2), (0, 2), (2, 3), (3, 0)])
    result = rinow.graph_curvature(graph, kind="haantjes")
    values = {tuple(e): v for e, v in zip(result.edge_index.tolist(), result.edges, strict=True)}
    assert values[0, 2] == 1.0  # by 1
    assert sum(values.values()) == 1.0
    both = rinow.graph_curvature(graph, kind="haantjes", directed=False)
    assert both.edges.sum() > 1.0


def test_matrix_and_graph_say_the_same():
    graph = random_graph(9, weighted=True)
    A = nx.to_scipy_sparse_array(graph)
    upper = csr_array(np.triu(A.toarray()))
    for kind in ("menger", "haantjes"):
        expected = rinow.graph_curvature(graph, kind=kind)
        for matrix in (A, upper):
            np.testing.assert_array_equal(rinow.graph_curvature(matrix, kind=kind).edges, expected.edges)


def test_curvature_scales_with_the_lengths():
    graph = random_graph(11, weighted=True)
    scaled = nx.Graph()
    scaled.add_nodes_from(graph)
    scaled.add_weighted_edges_from((u, v, 4.0 * w) for u, v, w in graph.edges(data="weight"))
    for kind, power in (("menger", 1), ("haantjes", 1), ("wald", 2)):
        a, b = rinow.graph_curvature(graph, kind=kind), rinow.graph_curvature(scaled, kind=kind)
        np.testing.assert_allclose(4.0**power * b.nodes, a.nodes, rtol=1e-9)


# ------------------------------------------------------------------ Wald


def test_wald_of_cycles_and_complete_graphs():
    for n in (4, 5, 12, 31):
        # The distances are those of n points of a great circle of length n.
        np.testing.assert_allclose(rinow.graph_curvature(nx.cycle_graph(n)).nodes, (2 * np.pi / n) ** 2, rtol=1e-9)
    for n in (4, 5, 9):
        result = rinow.graph_curvature(nx.complete_graph(n))
        np.testing.assert_allclose(result.nodes, REGULAR_TETRAHEDRON, rtol=1e-9)
        assert np.isnan(result.edges).all() and len(result.edges) == n * (n - 1) // 2
    # Chords of a regular spherical tetrahedron with edge 1: cos(√k) = -1/3.
    assert math.acos(-1 / 3) ** 2 == pytest.approx(REGULAR_TETRAHEDRON, rel=1e-9)


def test_wald_of_trees_and_lines():
    tree = rinow.graph_curvature(nx.balanced_tree(3, 4))
    assert (tree.nodes == -np.inf).all()
    assert np.isnan(rinow.graph_curvature(nx.path_graph(9)).nodes).all()
    assert np.isnan(rinow.graph_curvature(nx.complete_graph(3)).nodes).all()


def test_wald_of_grids_tends_to_the_flat_plane_of_city_blocks():
    # Quadruples of the plane with city-block distances have curvatures of both signs, all of order 1/diameter².
    coarse, fine = (rinow.graph_curvature(nx.grid_2d_graph(n, n)) for n in (5, 13))
    assert np.nanmedian(np.abs(fine.nodes)) < 0.25 * np.nanmedian(np.abs(coarse.nodes))
    assert (np.abs(fine.nodes) < 4 / 12**2 * np.pi**2).all()


def random_geometric_graph(curvature, n, degree, seed):
    """Points of a disk of radius 1 in S_k, joined below a distance; the central 40 nodes, and the distortion."""
    surface = rinow.SpaceForm(curvature)
    points = surface.sample(n, 1.0, np.random.default_rng(seed))
    D = surface.distance(points[:, None], points)
    reach = np.sort(D, axis=1)[:, degree].mean()
    i, j = np.nonzero((reach > D) & (D > 0))
    graph = coo_array((D[i, j], (i, j)), shape=D.shape)
    centre = np.argsort(D.max(axis=1))[:40]
    space = rinow.MetricSpace.from_graph(graph, infinite=True)
    apart = D[centre] > 1.2 * reach
    return graph, centre, np.mean(space.distances[centre][apart] / D[centre][apart]) - 1


@pytest.mark.parametrize("curvature", [1.0, 0.0, -1.0])
def test_random_geometric_graphs_recover_their_curvature_as_the_distortion_falls(curvature):
    errors, distortions = [], []
    for n, degree in ((300, 10), (700, 28), (900, 60)):
        graph, centre, distortion = random_geometric_graph(curvature, n, degree, seed=12)
        nodes = wald_at_nodes(as_arcs(graph, False), None, centre)[0]
        errors.append(float(np.median(np.abs(nodes - curvature))))
        distortions.append(float(distortion))
    assert distortions[0] > distortions[1] > distortions[2]
    assert errors[0] > errors[1] > errors[2]
    # At a distortion of half a percent over balls of radius 0.5: δ/r² = 0.02, ten times that in single quadruples.
    assert errors[2] < 0.2


def test_wald_radius_and_spread():
    result = rinow.graph_curvature(nx.cycle_graph(12), radius=6.0)
    np.testing.assert_array_equal(result.radius, 6.0)
    np.testing.assert_allclose(result.spread, 0.0, atol=1e-9)
    # Within a quarter of a great circle all quadruples are linear.
    assert np.isnan(rinow.graph_curvature(nx.cycle_graph(12), radius=3.0).nodes).all()


def test_components_and_isolated_nodes():
    graph = nx.disjoint_union(nx.complete_graph(5), nx.cycle_graph(6))
    graph.add_node(11)
    result = rinow.graph_curvature(graph)
    np.testing.assert_allclose(result.nodes[:5], REGULAR_TETRAHEDRON, rtol=1e-9)
    np.testing.assert_allclose(result.nodes[5:11], (np.pi / 3) ** 2, rtol=1e-9)
    assert np.isnan(result.nodes[11])
    assert rinow.graph_curvature(graph, kind="menger").nodes[11] == 0.0


# ------------------------------------------------------------------ degenerate and bad input


def test_loops_parallels_and_zero_lengths():
    graph = nx.MultiGraph([(0, 0), (0, 1), (0, 1), (1, 2), (2, 0)])
    graph.add_edge(0, 1, weight=1.0)
    result = rinow.graph_curvature(graph, kind="haantjes")
    np.testing.assert_array_equal(result.edges, 1.0)
    zero = coo_array((np.array([0.0, 1.0, 1.0]), (np.array([0, 1, 0]), np.array([1, 2, 2]))), shape=(3, 3))
    for kind in ("menger", "haantjes"):
        assert np.isnan(rinow.graph_curvature(zero, kind=kind).edges[0])
    assert len(rinow.graph_curvature(nx.empty_graph(3), kind="menger").edges) == 0
    assert np.isnan(rinow.graph_curvature(nx.empty_graph(3)).nodes).all()


@pytest.mark.parametrize("kind", ["wald", "menger", "haantjes"])
def test_an_edge_of_infinite_length_is_none(kind):
    graph = nx.complete_graph(5)
    graph[0][1]["weight"] = np.inf
    result = rinow.graph_curvature(graph, kind=kind)
    graph.remove_edge(0, 1)
    expected = rinow.graph_curvature(graph, kind=kind, weighted=False)
    np.testing.assert_array_equal(result.edge_index, expected.edge_index)
    np.testing.assert_array_equal(result.nodes, expected.nodes)


@pytest.mark.parametrize(
    ("graph", "options", "message"),
    [
        (nx.path_graph(3), {"kind": "forman"}, "kind = 'forman' is unknown; choose from wald, menger, haantjes"),
        (nx.path_graph(3), {"radius": -1}, "radius = -1 is not a positive length"),
        (nx.path_graph(3), {"radius": 1.0, "kind": "menger"}, "not for kind 'menger'"),
        (csr_array([[0.0, -1.0], [0.0, 0.0]]), {}, r"graph\[0, 1\] = -1.0 is not a length"),
        ([[0, 1], [1, 0]], {}, "give a scipy sparse matrix or a networkx graph"),
        (csr_array((2, 3)), {}, "give a square matrix"),
    ],
)
def test_faults_of_arguments_are_named(graph, options, message):
    with pytest.raises(InvalidInputError, match=message):
        rinow.graph_curvature(graph, **options)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 3.0, 7e5])
def test_a_detour_as_long_as_the_edge_up_to_rounding_has_no_curvature(unit):
    graph = nx.Graph()
    # 0.1 + 0.2 is 0.30000000000000004, and (0.1 + 0.2) + 0.3 is not 0.1 + (0.2 + 0.3).
    graph.add_weighted_edges_from([(0, 1, 0.1 * unit), (1, 2, 0.2 * unit), (0, 2, 0.3 * unit)])
    graph.add_weighted_edges_from([(2, 3, 0.3 * unit), (0, 3, 0.6 * unit), (1, 3, 0.5 * unit)])
    assert (rinow.graph_curvature(graph, kind="menger").edges == 0.0).all()
    haantjes = rinow.graph_curvature(graph, kind="haantjes")
    # Of the five paths from 0 to 3 only 0, 2, 1, 3 of length 1.0 is longer than 0.6.
    ends = haantjes.edge_index.tolist().index([0, 3])
    assert haantjes.edges[ends] * unit == pytest.approx(math.sqrt((1.0 - 0.6) / 0.6**3), rel=1e-12)


def test_a_thin_triangle_keeps_its_curvature():
    graph = nx.Graph()
    height = 1e-5
    graph.add_weighted_edges_from([(0, 1, math.hypot(1, height)), (1, 2, math.hypot(1, height)), (0, 2, 2.0)])
    assert rinow.graph_curvature(graph, kind="menger").edges == pytest.approx(np.full(3, 2e-5), rel=1e-5)


class Igraph:
    """What rinow asks of a graph of igraph."""

    def __init__(self, n, edges, weights=None, *, directed=False):
        self._edges, self._n, self._directed = edges, n, directed
        self.es = self
        self._weights = weights

    def vcount(self):
        return self._n

    def get_edgelist(self):
        return self._edges

    def is_directed(self):
        return self._directed

    def attributes(self):
        return [] if self._weights is None else ["weight"]

    def __getitem__(self, name):
        return {"weight": self._weights}[name]


@pytest.mark.parametrize("directed", [False, True])
@pytest.mark.parametrize("weighted", [False, True])
def test_graphs_of_igraph(directed, weighted):
    graph = random_graph(6, directed=directed, weighted=weighted)
    weights = [data.get("weight") for _, _, data in graph.edges(data=True)]
    other = Igraph(len(graph), list(graph.edges), weights if weighted else None, directed=directed)
    for kind in ("wald", "menger", "haantjes"):
        expected, found = (rinow.graph_curvature(g, kind=kind) for g in (graph, other))
        np.testing.assert_array_equal(found.nodes, expected.nodes)
        np.testing.assert_array_equal(found.edge_index, expected.edge_index)
    assert len(rinow.graph_curvature(Igraph(3, []), kind="menger").nodes) == 3


def test_a_wrong_length_is_named_by_the_labels_of_its_ends():
    graph = nx.Graph([("a", "b"), ("b", "c")])
    graph["b"]["c"]["weight"] = -2
    with pytest.raises(InvalidInputError, match=r"graph\['b', 'c'\] = -2.0 is not a length"):
        rinow.graph_curvature(graph)
