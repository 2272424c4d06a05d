"""Values travel: to other processes, into copies, and a metric space wherever its distances may go."""

import copy
import pickle

import numpy as np
import pytest

import rinow
import shapes

SPHERE = shapes.icosphere(1)
MESH = rinow.TriangleMesh(SPHERE.vertices, SPHERE.faces, {"height": SPHERE.vertices[:, 2]}, ("made by hand",))
SPACE = rinow.MetricSpace.from_points(SPHERE.vertices)


class OtherProcess:
    """A pool that packs what it is given, as one of processes does."""

    def map(self, function, *arguments):
        return map(pickle.loads(pickle.dumps(function)), *(map(pickle.loads, map(pickle.dumps, a)) for a in arguments))


@pytest.mark.parametrize("copied", [lambda x: pickle.loads(pickle.dumps(x)), copy.deepcopy, copy.copy])
def test_copies_of_meshes_and_spaces_are_equal_and_frozen(copied):
    mesh, lengths, space = copied(MESH), copied(MESH.intrinsic()), copied(SPACE)
    np.testing.assert_array_equal(mesh.vertices, MESH.vertices)
    np.testing.assert_array_equal(mesh.vertex_data["height"], MESH.vertex_data["height"])
    assert mesh.notes == MESH.notes
    np.testing.assert_array_equal(lengths.edge_lengths, MESH.edge_lengths)
    assert lengths.n_vertices == MESH.n_vertices
    np.testing.assert_array_equal(space.distances, SPACE.distances)
    for array in (mesh.vertices, mesh.faces, lengths.edge_lengths, space.distances):
        assert not array.flags.writeable
    with pytest.raises(TypeError):
        mesh.vertex_data["height"] = 0


def test_meshes_are_compared_in_other_processes():
    larger = rinow.TriangleMesh(1.5 * SPHERE.vertices, SPHERE.faces)
    here = rinow.distance_matrix([MESH, larger], metric="hausdorff")
    there = rinow.distance_matrix([MESH, larger], metric="hausdorff", executor=OtherProcess())
    np.testing.assert_array_equal(there.upper, here.upper)


def test_a_space_stands_for_its_distances():
    D = SPACE.distances
    assert rinow.fit_curvature(SPACE).value == rinow.fit_curvature(D).value
    assert rinow.menger_curvature(SPACE, [[0, 1, 2]]) == rinow.menger_curvature(D, [[0, 1, 2]])
    corners = SPACE.subspace([0, 1, 2, 3])
    assert rinow.simplex_volume(corners) == rinow.simplex_volume(corners.distances)
    np.testing.assert_array_equal(rinow.curve_curvature(SPACE), rinow.curve_curvature(D))
