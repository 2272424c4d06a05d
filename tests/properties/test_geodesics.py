"""Geodesic distances equal their naive twin on any list of triangles, and behave like distances."""

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import rinow
import shapes
from naive import geodesics as naive
from rinow.geodesics.exact import ExactGeodesics
from strategies import face_lists

# Rounding of a few additions, times the condition of a near miss of a vertex (the twin lays out strips by lengths).
RTOL = 1e-9


def _lengths(V, faces):
    ends = V[faces]
    return np.linalg.norm(np.roll(ends, -1, axis=1) - np.roll(ends, 1, axis=1), axis=2)


def _twin(V, faces):
    D = np.linalg.norm(V[:, None] - V, axis=2)
    return np.array(naive.geodesic_distances(len(V), [tuple(f) for f in faces.tolist()], lambda i, j: D[i, j]))


@settings(max_examples=40)
@given(face_lists(max_vertices=7, max_faces=5), st.integers(0, 2**32 - 1))
def test_any_faces_equal_the_naive_twin(case, seed):
    n, faces = case
    V = np.random.default_rng(seed).normal(size=(n, 3))
    L = _lengths(V, faces)
    half = L.sum(axis=1) / 2
    assume(((half[:, None] - L).min(axis=1) > 1e-3 * half).all())  # the twin knows lengths only
    expected = _twin(V, faces)
    np.testing.assert_allclose(rinow.geodesic_distances((V, faces), np.arange(n)), expected, rtol=RTOL)
    by_lengths = rinow.IntrinsicMesh(faces, L, n)
    np.testing.assert_allclose(rinow.geodesic_distances(by_lengths, np.arange(n)), expected, rtol=RTOL)


@settings(max_examples=25)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 1.0), st.floats(-6.0, 6.0))
def test_renumbering_turned_faces_and_similarity_change_the_unit_only(seed, amount, exponent):
    """Renumbering, turned faces and a similarity change nothing but the unit."""
    rng = np.random.default_rng(seed)
    V, F, *_ = shapes.noisy(shapes.irregular_torus(80), amount, seed=seed)
    n, scale = len(V), 10.0**exponent
    expected = rinow.geodesic_distances((V, F), np.arange(n))
    order, turn = rng.permutation(n), np.linalg.qr(rng.normal(size=(3, 3)))[0]
    place = np.argsort(order)
    flipped = rng.random(len(F)) < 0.5
    G = place[np.where(flipped[:, None], F[:, [0, 2, 1]], F)][rng.permutation(len(F))]
    actual = rinow.geodesic_distances((scale * V[order] @ turn, G), np.arange(n))
    np.testing.assert_allclose(actual, scale * expected[np.ix_(order, order)], rtol=1e-9)
    # d(s, v) = d(v, s): the two ways run through different windows
    np.testing.assert_allclose(expected, expected.T, rtol=1e-11)


@settings(max_examples=25)
@given(st.integers(0, 2**32 - 1), st.floats(0.01, 3.0))
def test_balls_are_the_part_of_the_rows_within_the_radius(seed, radius):
    V, F, *_ = shapes.noisy(shapes.open_patch(100), 0.3, seed=seed)
    geodesics = ExactGeodesics((V, F))
    rows = geodesics.distances(np.arange(len(V)))
    clear = np.abs(rows - radius) > 1e-12 * radius
    balls = geodesics.distances(np.arange(len(V)), max_distance=radius)
    inside = np.zeros(rows.shape, bool)
    coo = balls.tocoo()
    inside[coo.row, coo.col] = True
    np.testing.assert_array_equal(inside[clear], (rows <= radius)[clear])
    np.testing.assert_allclose(balls.toarray()[inside], rows[inside], rtol=1e-13)
