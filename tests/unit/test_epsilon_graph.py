"""Graphs on nets of length spaces: Theorem 2.51 as corrected, its counter-example, refusals."""

import math
import re

import numpy as np
import pytest

import rinow
from naive import nets as naive
from rinow.errors import InvalidInputError


def test_the_printed_bound_leaves_a_graph_without_edges():
    """X = [0, 100], ε = 1/2: δ = 1 is below (ε²/4) diam = 6.25, but not below ε²/(4 diam) = 0.000625."""
    points = np.linspace(0, 100, 1001)[:, None]
    space = rinow.MetricSpace.from_points(points)
    graph = rinow.epsilon_graph(space, 0.5, indices=np.arange(0, 1001, 20))
    assert graph.delta == pytest.approx(1.0)
    assert graph.graph.nnz == 0
    assert graph.error_bound == math.inf
    assert not graph.is_fine_enough


def test_the_graph_joins_the_points_closer_than_epsilon():
    D = naive.circle(12)
    result = rinow.epsilon_graph(D, 2.5 * math.pi / 6, indices=range(12))
    assert result.graph.nnz == 12 * 4
    assert result.delta == 0.0
    assert result.graph[0, 2] == D[0][2]
    assert result.error_bound == pytest.approx(0.0, abs=1e-14)


def test_a_coarse_sample_is_no_length_space():
    """All points are in the net, so δ = 0; but the sample has gaps, and the error says so."""
    result = rinow.epsilon_graph(naive.circle(12), 0.4, indices=range(12))
    assert result.delta == 0.0
    assert result.error_bound == math.inf


def test_the_default_net_is_fine_enough():
    D = naive.circle(400)
    result = rinow.epsilon_graph(D, 1.0)
    assert result.delta < 1.0 / (4 * math.pi)
    assert result.is_fine_enough
    assert len(result.indices) < 400
    assert result.delta == naive.covering_radius(D, result.indices.tolist())
    assert result.error_bound <= 1.0


def test_one_point_has_an_exact_graph_without_edges():
    result = rinow.epsilon_graph([[0.0]], 1.0)
    assert (result.graph.shape, result.delta, result.error_bound) == ((1, 1), 0.0, 0.0)


def test_points_at_distance_0_are_joined():
    result = rinow.epsilon_graph([[0, 0, 1], [0, 0, 1], [1, 1, 0]], 2.0, indices=[0, 1, 2])
    assert result.graph.nnz == 6
    assert result.error_bound == 0.0


BAD = [
    (lambda: rinow.epsilon_graph([[0.0]], 0.0), "epsilon = 0.0 is not a length; give a positive number."),
    (lambda: rinow.epsilon_graph([[0.0]], 1.0, indices=[1]), "indices[0] = 1 is outside 0..0"),
    (lambda: rinow.epsilon_graph([[0.0]], 1.0, indices=[]), "indices has shape (0,)"),
    (
        lambda: rinow.epsilon_graph(rinow.intrinsic_metric([[0, 1], [1, 0]], 0.5, infinite=True), 1.0),
        "distances[0, 1] is infinite; take one component.",
    ),
]


@pytest.mark.parametrize(("action", "message"), BAD)
def test_faults_of_arguments_are_named(action, message):
    with pytest.raises(InvalidInputError, match=re.escape(message)):
        action()
