"""Metric spaces: axioms with their witnesses, graphs, subspaces."""

import subprocess
import sys

import networkx as nx
import numpy as np
import pytest
from scipy.sparse import coo_array, csr_array

import rinow
from naive import metric_space as naive
from rinow.metric_space import as_metric_space


def random_metric(n, seed):
    """Any symmetric matrix with entries in [1, 2] is a metric."""
    D = np.random.default_rng(seed).uniform(1, 2, (n, n))
    D = np.triu(D, 1)
    return D + D.T


def test_a_space_copies_and_freezes_its_distances():
    D = random_metric(6, seed=3)
    space = rinow.MetricSpace(D)
    D[0, 1] = 7.0
    assert space.distances[0, 1] != 7.0
    assert not space.distances.flags.writeable
    with pytest.raises(AttributeError):
        space.distances = D
    assert len(space) == 6
    assert repr(space).startswith("MetricSpace(n_points=6, diameter=")


def test_eccentricities_radius_and_diameter():
    space = rinow.MetricSpace.from_points([[0.0], [1.0], [3.0], [7.0]])
    assert space.eccentricities.tolist() == [7, 6, 4, 7]
    assert (space.radius, space.diameter) == (4, 7)
    one = rinow.MetricSpace([[0.0]])
    assert (len(one), one.radius, one.diameter) == (1, 0, 0)


@pytest.mark.parametrize("seed", range(20, 26))
def test_the_witness_is_the_triple_with_the_largest_excess(seed):
    rng = np.random.default_rng(seed)
    D = random_metric(40, seed)
    i, j = rng.choice(40, 2, replace=False)
    D[i, j] = D[j, i] = rng.uniform(4.1, 5)
    excess, triple = naive.worst_triple(D.tolist())
    with pytest.raises(rinow.NotAMetricError, match="exceeds") as failure:
        rinow.MetricSpace(D)
    assert failure.value.witness == triple
    assert f"distances[{triple[0]}, {triple[2]}] = {D[i, j]:.17g}" in str(failure.value)
    rinow.MetricSpace(D, rtol=1.01 * excess / D.max())
    with pytest.raises(rinow.NotAMetricError):
        rinow.MetricSpace(D, rtol=0.99 * excess / D.max())


@pytest.mark.parametrize("pair", [(0, 299), (15, 16), (17, 280), (290, 299), (255, 256)])
def test_the_witness_is_found_in_every_block(pair):
    D = random_metric(300, seed=5)
    i, j = pair
    D[i, j] = D[j, i] = 4.5
    with pytest.raises(rinow.NotAMetricError) as failure:
        rinow.MetricSpace(D)
    assert failure.value.witness == (i, (D[i] + D[j]).argmin(), j)


def test_rounding_is_relative_to_the_diameter():
    for scale in (1e-150, 1.0, 1e150):
        rinow.MetricSpace(scale * np.array([[0, 1, 2 + 1e-10], [1, 0, 1], [2 + 1e-10, 1, 0]]))
        with pytest.raises(rinow.NotAMetricError, match="exceeds"):
            rinow.MetricSpace(scale * np.array([[0, 1, 2 + 1e-8], [1, 0, 1], [2 + 1e-8, 1, 0]]))


@pytest.mark.parametrize(
    ("matrix", "message", "witness"),
    [
        ([[0, 1], [2, 0]], "transpose", (0, 1)),
        ([[0, -1], [-1, 0]], "negative", (0, 1)),
        ([[0, np.nan], [np.nan, 0]], "not finite", (0, 1)),
        ([[0, np.inf], [np.inf, 0]], "not finite", (0, 1)),
        ([[0, 1], [1, 0.5]], "diagonal", (1, 1)),
    ],
)
def test_every_axiom_has_its_witness(matrix, message, witness):
    with pytest.raises(rinow.NotAMetricError, match=message) as failure:
        rinow.MetricSpace(matrix)
    assert failure.value.witness == witness


def test_wrong_arrays_are_refused():
    for bad in (np.zeros((2, 3)), np.zeros((0, 0)), np.zeros(4), "abc", [[0, 1j], [1j, 0]]):
        with pytest.raises(rinow.InvalidInputError, match="distances"):
            rinow.MetricSpace(bad)


def test_repeated_points_are_allowed():
    assert rinow.MetricSpace(np.zeros((3, 3))).diameter == 0
    space = rinow.MetricSpace.from_points([[1.0, 2.0], [1.0, 2.0], [4.0, 6.0]])
    assert space.distances.tolist() == [[0, 0, 5], [0, 0, 5], [5, 5, 0]]
    assert rinow.MetricSpace.from_points([[1.0, 2.0]]).distances.tolist() == [[0]]


def test_subspaces_keep_the_order_of_the_indices():
    space = rinow.MetricSpace(random_metric(6, seed=4))
    part = space.subspace([4, 0, 4])
    assert part.distances.tolist() == space.distances[[4, 0, 4]][:, [4, 0, 4]].tolist()
    for bad in ([6], [-1], [], [[0, 1]], 2, [0.5]):
        with pytest.raises(rinow.InvalidInputError, match="indices"):
            space.subspace(bad)


def test_points_must_be_finite_and_exist():
    with pytest.raises(rinow.InvalidInputError, match=r"points\[1, 0\] = nan is not finite"):
        rinow.MetricSpace.from_points([[0.0], [np.nan]])
    with pytest.raises(rinow.InvalidInputError, match="empty"):
        rinow.MetricSpace.from_points(np.empty((0, 3)))
    with pytest.raises(rinow.InvalidInputError, match="one point per row"):
        rinow.MetricSpace.from_points([0.0, 1.0])


@pytest.mark.parametrize("seed", range(30, 34))
def test_graph_distances_are_shortest_paths(seed):
    rng = np.random.default_rng(seed)
    n, m = 15, 40
    tails, heads = rng.integers(0, n, (2, m))
    lengths = rng.uniform(0, 1, m) * (rng.uniform(0, 1, m) > 0.2)  # some edges have length 0
    ring = np.arange(n)
    tails, heads, lengths = np.r_[tails, ring], np.r_[heads, (ring + 1) % n], np.r_[lengths, np.full(n, 2.0)]
    expected = naive.shortest_paths(n, list(zip(tails.tolist(), heads.tolist(), lengths.tolist(), strict=True)))
    graphs = [coo_array((lengths, (tails, heads)), shape=(n, n)), nx.MultiDiGraph(), nx.MultiGraph()]
    for graph in graphs[1:]:
        graph.add_nodes_from(range(n))
        graph.add_weighted_edges_from(zip(tails, heads, lengths, strict=True))
    for graph in graphs:
        actual = rinow.MetricSpace.from_graph(graph).distances
        assert actual == pytest.approx(np.array(expected), rel=1e-14)  # at most 15 additions
        assert (actual == actual.T).all()
        rinow.MetricSpace(actual)


def test_graph_without_weights_counts_edges():
    space = rinow.MetricSpace.from_graph(nx.petersen_graph())
    assert space.diameter == 2
    space = rinow.MetricSpace.from_graph(nx.path_graph(["a", "c", "b"]))
    assert space.distances.tolist() == [[0, 1, 2], [1, 0, 1], [2, 1, 0]]
    assert rinow.MetricSpace.from_graph(nx.empty_graph(1)).diameter == 0


def test_disconnected_graphs_have_a_witness_or_infinite_distances():
    graph = nx.Graph([(0, 1), (2, 3)])
    with pytest.raises(rinow.NotAMetricError, match="no path from node 0 to node 2") as failure:
        rinow.MetricSpace.from_graph(graph)
    assert failure.value.witness == (0, 2)
    space = rinow.MetricSpace.from_graph(graph, infinite=True)
    assert space.distances[0].tolist() == [0, 1, np.inf, np.inf]
    assert space.diameter == np.inf
    assert space.subspace([2, 3]).diameter == 1


def test_wrong_graphs_are_refused():
    with pytest.raises(rinow.InvalidInputError, match=r"graph\[0, 1\] = -1.0 is not a length"):
        rinow.MetricSpace.from_graph(csr_array(np.array([[0, -1.0], [0, 0]])))
    with pytest.raises(rinow.InvalidInputError, match="nan is not a length"):
        rinow.MetricSpace.from_graph(csr_array(np.array([[0, np.nan], [0, 0]])))
    with pytest.raises(rinow.InvalidInputError, match="square"):
        rinow.MetricSpace.from_graph(csr_array(np.ones((2, 3))))
    with pytest.raises(rinow.InvalidInputError, match="at least one node"):
        rinow.MetricSpace.from_graph(nx.Graph())
    with pytest.raises(rinow.InvalidInputError, match="graph is a ndarray"):
        rinow.MetricSpace.from_graph(np.zeros((2, 2)))
    with pytest.raises(rinow.InvalidInputError, match="graph"):
        rinow.MetricSpace.from_graph(nx.Graph([(0, 1, {"weight": "far"})]))


def test_coercion_keeps_spaces_and_refuses_meshes():
    space = rinow.MetricSpace.from_points([[0.0], [1.0]])
    assert as_metric_space(space) is space
    assert len(as_metric_space([[0, 1], [1, 0]])) == 2
    mesh = rinow.TriangleMesh(np.eye(3), [[0, 1, 2]])
    with pytest.raises(rinow.InvalidInputError, match="geodesic_space"):
        as_metric_space(mesh)


def test_networkx_is_not_imported_unless_used():
    code = "import sys, rinow.metric_space; sys.exit('networkx' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_graph_is_no_distance_matrix():
    for graph in (csr_array(np.eye(3)), nx.path_graph(3)):
        with pytest.raises(rinow.errors.InvalidInputError, match=r"MetricSpace\.from_graph of a graph"):
            rinow.length_defect(graph)


@pytest.mark.parametrize("rtol", [-1.0, np.nan, np.inf, "a", None, [0.1]])
def test_rtol_is_a_number(rtol):
    with pytest.raises(rinow.InvalidInputError, match=r"^rtol "):
        rinow.MetricSpace([[0, 1], [1, 0]], rtol=rtol)


@pytest.mark.parametrize(
    ("spaces", "metric", "message"),
    [
        (None, "lipschitz", "spaces is of type NoneType; give a list of spaces."),
        (np.array(0.1), "lipschitz", "spaces is of type ndarray; give"),
        ([[[0.0]]], ["lipschitz"], "is unknown; give one of"),
    ],
)
def test_collections_are_lists_with_a_metric_by_name(spaces, metric, message):
    with pytest.raises(rinow.InvalidInputError, match=message):
        rinow.distance_matrix(spaces, metric=metric)


def test_the_largest_numbers_are_distances():
    largest = np.finfo(np.float64).max
    assert rinow.MetricSpace([[0, largest], [largest, 0]]).diameter == largest


def test_masked_distances_are_missing():
    D = np.ma.array([[0.0, 1.0], [1.0, 0.0]], mask=[[False, True], [True, False]])
    with pytest.raises(rinow.NotAMetricError, match=r"distances\[0, 1\] = nan is not finite"):
        rinow.MetricSpace(D)
    assert rinow.MetricSpace(np.ma.array([[0, 2], [2, 0]])).diameter == 2.0
