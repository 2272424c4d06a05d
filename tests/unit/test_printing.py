"""Results and meshes print as one line, whatever their size."""

from dataclasses import fields, is_dataclass

import numpy as np
import pytest
from scipy.sparse import csr_array

import rinow
from shapes import icosphere

V, F = icosphere(2)[:2]
MESH = rinow.TriangleMesh(V, F, {"height": V[:, 2]})
SPACE = rinow.MetricSpace.from_points(np.random.default_rng(0).normal(size=(12, 2)))
RESULTS = (
    MESH,
    rinow.IntrinsicMesh(MESH.faces, MESH.edge_lengths),
    rinow.surface_curvature(MESH, method="angle_defect"),
    rinow.singular_features(MESH),
    rinow.graph_curvature(csr_array(np.array([[0.0, 1.0], [1.0, 0.0]]))),
    rinow.embedding_curvatures(np.ones((20, 6))),
    rinow.fit_curvature(SPACE.distances),
    rinow.hausdorff_distance(np.zeros((9, 3)), np.ones((9, 3))),
    rinow.gromov_hausdorff(SPACE, SPACE),
    rinow.lipschitz_distance(SPACE, SPACE),
    rinow.distance_matrix([SPACE, SPACE]),
    rinow.farthest_point_net(SPACE, size=9),
    rinow.epsilon_graph(SPACE, 10.0),
)


@pytest.mark.parametrize("result", RESULTS, ids=lambda result: type(result).__name__)
def test_a_result_prints_as_one_line_that_names_every_field(result):
    line = repr(result)
    assert "\n" not in line and len(line) < 600
    assert line.startswith(type(result).__name__)
    assert is_dataclass(result) and all(f"{field.name}=" in line for field in fields(result))


def test_numbers_and_short_arrays_are_printed_and_long_arrays_by_shape():
    net = rinow.farthest_point_net(SPACE, size=3)
    assert f"indices={net.indices.tolist()}" in repr(net)
    assert f"covering_radius={net.covering_radius!r}" in repr(net)
    assert "distances=<float64 12>" in repr(net)
    assert f"vertices=<float64 {MESH.n_vertices} x 3>" in repr(MESH)
    assert "kind=<str 20 x 2>" in repr(rinow.embedding_curvatures(np.ones((20, 6))))


def test_vertex_data_that_is_no_mapping_is_refused_in_one_sentence():
    with pytest.raises(rinow.errors.InvalidInputError, match="vertex_data is of type ndarray; give a mapping"):
        rinow.TriangleMesh(V, F, np.ones(len(V)))
