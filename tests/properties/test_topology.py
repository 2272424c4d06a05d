"""Adjacency equals its naive twin on any list of triangles, faults included."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from naive import topology as naive
from rinow.topology import Topology
from strategies import face_lists


def _topology(n, faces):
    return Topology(faces, n, np.ones(len(faces), bool))


@given(face_lists())
def test_edges_agree_with_the_naive_twin(case):
    n, faces = case
    t = _topology(n, faces)
    expected = naive.edge_faces(faces.tolist())
    actual = {
        frozenset(e): (b, m) for e, b, m in zip(t.edges.tolist(), t.edge_is_boundary, t.edge_is_manifold, strict=True)
    }
    assert actual == {e: (len(f) == 1, len(f) <= 2) for e, f in expected.items()}


@given(face_lists())
def test_partners_share_their_edge(case):
    n, faces = case
    t = _topology(n, faces)
    ends = [frozenset(e) for e in t.halfedge_ends(np.arange(3 * len(faces))).tolist()]
    for h, g in enumerate(t.partners):
        if g >= 0:
            assert t.partners[g] == h != g
            assert ends[g] == ends[h]


@given(face_lists())
def test_components_and_euler_characteristic(case):
    n, faces = case
    t = _topology(n, faces)
    assert t.components.tolist() == naive.components(faces.tolist(), n)
    assert t.n_components == max(t.components) + 1
    assert t.euler_characteristic == naive.euler_characteristic(faces.tolist())


@given(face_lists())
def test_vertex_manifoldness(case):
    n, faces = case
    t = _topology(n, faces)
    assert t.vertex_is_manifold.tolist() == [naive.vertex_is_manifold(faces.tolist(), v) for v in range(n)]


def _check_neighbours(t, n, faces):
    for v in range(n):
        row = t.neighbours[t.neighbour_offsets[v] : t.neighbour_offsets[v + 1]].tolist()
        assert len(row) == len(set(row))
        assert set(row) == {w for face in faces.tolist() if v in face for w in face} - {v}


@given(face_lists())
def test_neighbours_are_those_of_the_faces(case):
    n, faces = case
    _check_neighbours(_topology(n, faces), n, faces)


@given(face_lists(), st.data())
def test_orientation_is_consistent_after_flips(case, data):
    n, faces = case
    t = _topology(n, faces)
    turned = np.where(t.face_flips[:, None], faces[:, ::-1], faces)
    again = _topology(n, turned)
    ends = again.halfedge_ends(np.arange(3 * len(faces)))
    agree = all(ends[h].tolist() == ends[g][::-1].tolist() for h, g in enumerate(again.partners) if g >= 0)
    assert agree == t.is_orientable
    random_flips = np.array(data.draw(st.lists(st.booleans(), min_size=len(faces), max_size=len(faces))))
    assert _topology(n, np.where(random_flips[:, None], faces[:, ::-1], faces)).is_orientable == t.is_orientable


@given(face_lists(), st.permutations(range(8)))
def test_relabelling_changes_no_count(case, order):
    n, faces = case
    order = np.array([i for i in order if i < n])
    t, u = _topology(n, faces), _topology(n, order[faces])
    assert u.euler_characteristic == t.euler_characteristic
    assert u.n_components == t.n_components
    np.testing.assert_array_equal(u.vertex_is_manifold[order], t.vertex_is_manifold)
    np.testing.assert_array_equal(u.vertex_is_boundary[order], t.vertex_is_boundary)


@given(st.integers(2, 60), st.integers(0, 3), st.integers(0, 2**32))
def test_vertices_with_many_corners(n, copies, seed):
    """A fan of n triangles around one vertex, some of them repeated, numbered at random."""
    rng = np.random.default_rng(seed)
    rim = np.arange(1, n + 1)
    faces = np.stack([np.zeros(n, int), rim, np.roll(rim, 1)], axis=1)
    faces = np.concatenate([faces, faces[rng.integers(0, n, copies)]])
    faces = rng.permutation(rng.permutation(n + 1)[faces])
    t = _topology(n + 1, faces)
    expected = naive.edge_faces(faces.tolist())
    for h, ends in enumerate(t.halfedge_ends(np.arange(3 * len(faces))).tolist()):
        found = expected[frozenset(ends)]
        if len(found) == 2:
            assert t.partners[h] // 3 == found[found[0] == h // 3]
        else:
            assert t.partners[h] == (-1 if len(found) == 1 else -2)
    _check_neighbours(t, n + 1, faces)
