"""Hausdorff distance against its naive twins: neighbourhoods, samples, and the axioms of a metric."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rinow
from naive import hausdorff as naive
from rinow.comparison.surface_tree import frame_of, surface_of_mesh
from rinow.mesh import TriangleMesh

COORDINATES = st.integers(-8, 8)
POINTS = st.lists(st.tuples(COORDINATES, COORDINATES), min_size=1, max_size=12)


@given(POINTS, POINTS)
def test_neighbourhood_form_and_max_min_form_agree(A, B):
    result = rinow.hausdorff_distance(np.array(A, float), np.array(B, float))
    expected = naive.by_neighbourhoods(A, B, math.dist)
    assert result.lower == result.upper == pytest.approx(expected, rel=1e-15)
    assert math.dist(A[result.witness_a], B[result.witness_b]) == pytest.approx(expected, rel=1e-15)


@given(POINTS, st.data())
def test_subsets_of_a_space(points, data):
    space = rinow.MetricSpace.from_points(np.array(points, float))
    subset = st.lists(st.integers(0, len(points) - 1), min_size=1, max_size=8)
    A, B = data.draw(subset), data.draw(subset)
    result = rinow.hausdorff_distance(A, B, space=space)
    assert result.upper == naive.by_neighbourhoods(A, B, lambda i, j: space.distances[i, j])
    assert space.distances[result.witness_a, result.witness_b] == result.upper
    assert result.witness_a in A
    assert result.witness_b in B
    assert (result.upper == 0.0) == ({points[i] for i in A} == {points[i] for i in B})


@given(POINTS, POINTS, POINTS)
def test_triangle_inequality(A, B, C):
    d = [rinow.hausdorff_distance(np.array(X, float), np.array(Y, float)).upper for X, Y in ((A, B), (B, C), (A, C))]
    assert d[2] <= (d[0] + d[1]) * (1 + 1e-15)


def random_surface(seed, kind):
    """A few triangles: apart, in one plane, thin, or with corners in common."""
    rng = np.random.default_rng(seed)
    V = rng.uniform(-1, 1, (7, 3))
    if kind == 1:
        V[:, 2] = 0.0
    if kind == 2:
        V[:, 1:] *= 1e-3
    if kind == 3:
        V = np.round(2 * V) / 2
    F = np.array([rng.permutation(7)[:3] for _ in range(rng.integers(1, 6))])
    return V, F


@pytest.mark.parametrize("kinds", [(0, 0), (0, 1), (1, 1), (1, 3), (2, 0), (3, 3), (2, 2)])
def test_the_interval_meets_that_of_dense_samples(kinds):
    for seed in range(6):
        (V, F), (W, G) = random_surface(seed, kinds[0]), random_surface(100 + seed, kinds[1])
        result = rinow.hausdorff_distance((V, F), (W, G), tolerance=1e-3)
        lower, upper = naive.enclosure(V[F].tolist(), W[G].tolist(), 12)
        assert lower <= result.upper
        assert result.lower <= upper
        diagonal = max(np.linalg.norm(np.ptp(X[np.unique(T)], axis=0)) for X, T in ((V, F), (W, G)))
        assert result.upper - result.lower <= 1e-3 * diagonal * (1 + 1e-12)
        assert naive.distance_to_surface(result.witness_a.tolist(), V[F].tolist()) < 1e-12
        assert naive.distance_to_surface(result.witness_b.tolist(), W[G].tolist()) < 1e-12
        assert math.dist(result.witness_a, result.witness_b) == pytest.approx(result.lower, abs=1e-9)


@settings(max_examples=50)
@given(st.integers(0, 10**6), st.integers(0, 3))
def test_distances_from_a_surface(seed, kind):
    V, F = random_surface(seed, kind)
    mesh = TriangleMesh(V, F)
    P = np.random.default_rng(seed + 1).uniform(-2, 2, (20, 3))
    frame = frame_of(V, P)
    surface = surface_of_mesh(mesh, frame)
    _, actual = surface.nearest(frame.enter(P), np.arange(20))
    expected = [naive.distance_to_surface(p, V[F].tolist()) for p in P.tolist()]
    np.testing.assert_allclose(actual * frame.unit, expected, atol=1e-12)  # needles: rounding / angle


def test_threads_do_not_change_a_bit():
    import numba

    from shapes import irregular_sphere

    s, u = irregular_sphere(2000), irregular_sphere(1500, seed=9)
    before = numba.get_num_threads()
    results = []
    try:
        for n in (1, before):
            numba.set_num_threads(n)
            results.append(rinow.hausdorff_distance((s.vertices, s.faces), (u.vertices, u.faces)))
    finally:
        numba.set_num_threads(before)
    a, b = results
    assert (a.lower, a.upper) == (b.lower, b.upper)
    np.testing.assert_array_equal(a.distances_a, b.distances_a)
    np.testing.assert_array_equal(a.witness_a, b.witness_a)
