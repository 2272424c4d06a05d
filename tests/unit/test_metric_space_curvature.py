"""Curvature at the points of a metric space: surfaces of constant curvature, errors of distances, faults."""

import math

import networkx as nx
import numpy as np
import pytest

import conformal
import shapes
from naive import point_set as naive
from rinow import (
    InvalidInputError,
    MetricSpace,
    NotAMetricError,
    SpaceForm,
    TriangleMesh,
    VertexStatus,
    fit_curvature,
    geodesic_space,
    metric_space_curvature,
)
from rinow.curvature.space_fit import fit_at_first


def sampled(k, n=60, seed=7, radius=1.2, noise=0.0):
    surface = SpaceForm(k)
    P = surface.sample(n, radius, np.random.default_rng(seed))
    D = surface.distance(P[:, None], P)
    errors = np.triu(np.random.default_rng(seed + 1).normal(0, noise, D.shape), 1)
    return MetricSpace(0.5 * (D + D.T) * (1 + errors + errors.T), rtol=0.5 if noise else 1e-9)


# ------------------------------------------------------------------ values


@pytest.mark.parametrize("k", [1.0, 0.0, -1.0, -4.0])
def test_points_of_surfaces_of_constant_curvature_have_it_everywhere(k):
    c = metric_space_curvature(sampled(k))
    # Rounding of 1e-16 in distances over a ball of a third of the unit: 1e-16 * 100 / 0.1.
    np.testing.assert_allclose(c.value, k, atol=1e-10)
    assert (c.status <= VertexStatus.BOUNDARY).all()
    assert (c.standard_error < 1e-10).all()
    assert (c.residual < 1e-14).all()


def test_a_given_radius_is_used():
    c = metric_space_curvature(sampled(1.0), radius=0.8)
    known = c.status <= VertexStatus.BOUNDARY
    np.testing.assert_allclose(c.value[known], 1, atol=1e-10)
    assert np.mean(known) > 0.9
    assert ((0.5 < c.radius[known]) & (c.radius[known] <= 0.8)).all()


def test_one_ball_without_a_gradient_is_the_curvature_of_its_points():
    D = conformal.Disk().distances(conformal.Disk().sample(9, 0.2, seed=7))
    D = D[np.ix_(order := np.argsort(D.max(axis=1)), order)]
    value = fit_at_first(D).values[0]
    # The directions beyond two dimensions are held in the last step; they turn with the curvature by 1e-4.
    assert value == pytest.approx(float(fit_curvature(D).value), rel=1e-3)
    assert value == pytest.approx(naive.curvature(D.tolist(), -20, 20), rel=1e-3)
    assert fit_at_first(D, 1.5).values[0] == pytest.approx(value, rel=1e-3)


def test_gradients_raise_the_order():
    surface, errors = conformal.Disk(), []
    for radius in (0.2, 0.1):
        samples = [surface.sample(12, radius, seed) for seed in range(4)]
        errors.append([fit_at_first(surface.distances(P)).values - surface.curvature(P[0]) for P in samples])
    large, small = np.sqrt(np.mean(np.square(errors), axis=1))
    # A constant misses the gradient, the next the second derivatives, and so on; measured to 0.03.
    assert np.log2(large / small) == pytest.approx([1, 2, 3], abs=0.15)


def test_boundary_points_are_told():
    c = metric_space_curvature(sampled(0.0, n=120))
    P = SpaceForm(0.0).sample(120, 1.2, np.random.default_rng(7))
    r = np.linalg.norm(P, axis=1)
    assert np.mean(c.status[r < 0.8] == VertexStatus.OK) > 0.95
    assert np.mean(c.status[r > 1.15] == VertexStatus.BOUNDARY) > 0.65
    whole = shapes.icosphere(2)
    assert (metric_space_curvature(geodesic_space((whole.vertices, whole.faces))).status == VertexStatus.OK).all()


@pytest.mark.parametrize(("make", "share"), [(shapes.irregular_torus, 0.25), (shapes.irregular_ellipsoid, 0.2)])
def test_geodesic_distances_of_coarse_meshes(make, share):
    shape = make(200)
    c = metric_space_curvature(geodesic_space((shape.vertices, shape.faces)))
    known = c.status <= VertexStatus.BOUNDARY
    assert np.mean(known) > 0.9
    # Chords of 200 vertices: the star alone is off by 40 %.
    error = np.median(np.abs(c.value - shape.gaussian)[known]) / np.median(np.abs(shape.gaussian))
    assert error < share


# ------------------------------------------------------------------ errors of distances


@pytest.mark.parametrize("k", [1.0, 0.0, -1.0])
def test_standard_error_covers_the_error_of_noisy_distances(k):
    shares, errors = [], []
    for seed in (10, 20, 30):
        c = metric_space_curvature(sampled(k, seed=seed, noise=1e-3))
        known = c.status <= VertexStatus.BOUNDARY
        shares.append(np.mean((np.abs(c.value - k) < 2 * c.standard_error)[known]))
        errors.append(np.median(np.abs(c.value - k)[known]))
        assert np.mean(known) > 0.8
    # Neighbours share their distances, so 60 points are few independent ones.
    assert np.mean(shares) > 0.85
    assert np.mean(errors) < 0.03  # 1e-3 of the distances; single quadruples of neighbours are off by 1


def test_standard_error_covers_a_curvature_that_varies():
    surface = conformal.Disk()
    P = surface.sample(40, 0.25, seed=7)
    c = metric_space_curvature(surface.distances(P))
    exact = surface.curvature(P)
    ok = c.status == VertexStatus.OK
    assert np.mean((np.abs(c.value - exact) < 2 * c.standard_error)[ok]) > 0.8
    assert np.median(np.abs(c.value - exact)[ok]) < 0.05 * np.ptp(exact)


# ------------------------------------------------------------------ invariance


def test_order_and_unit_do_not_matter():
    space = sampled(1.0, n=40, noise=1e-3)
    c = metric_space_curvature(space)
    p = np.random.default_rng(9).permutation(40)
    again = metric_space_curvature(space.subspace(p))
    np.testing.assert_allclose(again.value, c.value[p], rtol=1e-7)
    np.testing.assert_array_equal(again.status, c.status[p])
    for scale in (8.0, 1e-6):
        scaled = metric_space_curvature(MetricSpace(space.distances * scale, rtol=0.5))
        np.testing.assert_allclose(scaled.value * scale**2, c.value, rtol=1e-6)
        np.testing.assert_allclose(scaled.standard_error * scale**2, c.standard_error, rtol=1e-6)
        np.testing.assert_allclose(scaled.radius / scale, c.radius)


def test_repeated_points_count_once():
    space = sampled(1.0, n=30)
    c = metric_space_curvature(space.subspace(np.repeat(np.arange(30), 2)))
    np.testing.assert_array_equal(c.value[::2], c.value[1::2])
    np.testing.assert_allclose(c.value[::2], metric_space_curvature(space).value, atol=1e-12)


# ------------------------------------------------------------------ where there is none


@pytest.mark.parametrize(
    "space",
    [
        MetricSpace.from_points(np.random.default_rng(7).uniform(-1, 1, (60, 3))),
        MetricSpace.from_graph(nx.grid_2d_graph(6, 6)),
        MetricSpace.from_graph(nx.balanced_tree(2, 4)),
        MetricSpace.from_graph(nx.cycle_graph(20)),
        MetricSpace.from_points(np.arange(12.0)[:, None]),
        MetricSpace.from_points(np.random.default_rng(7).uniform(-1, 1, (4, 2))),
    ],
    ids=["space", "grid", "tree", "cycle", "line", "four points"],
)
def test_spaces_that_are_no_surfaces_have_no_value(space):
    c = metric_space_curvature(space)
    assert (c.status == VertexStatus.UNRESOLVED).all()
    assert np.isnan(c.value).all() and np.isnan(c.standard_error).all()


def test_lonely_points_are_isolated():
    assert metric_space_curvature([[0.0]]).status.tolist() == [VertexStatus.ISOLATED]
    assert metric_space_curvature(np.zeros((3, 3))).status.tolist() == [VertexStatus.ISOLATED] * 3
    far = metric_space_curvature(sampled(0.0, n=20), radius=1e-6)
    assert (far.status == VertexStatus.ISOLATED).all()


def test_components_are_spaces_of_their_own():
    D = np.full((61, 61), np.inf)
    D[:30, :30], D[30:60, 30:60], D[60, 60] = sampled(1.0, n=30).distances, sampled(-1.0, n=30).distances, 0
    graph = nx.Graph()
    graph.add_nodes_from(range(61))
    graph.add_weighted_edges_from((i, j, D[i, j]) for i, j in np.argwhere(np.isfinite(D)) if i < j)
    c = metric_space_curvature(MetricSpace.from_graph(graph, infinite=True))
    np.testing.assert_allclose(c.value[:60], np.repeat([1, -1], 30), atol=1e-9)
    assert c.status[60] == VertexStatus.ISOLATED


def test_faults_are_named():
    for radius in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InvalidInputError, match="not a positive length; leave it out"):
            metric_space_curvature(np.ones((4, 4)) - np.eye(4), radius=radius)
    for scale in (1e-200, 1e200):
        with pytest.raises(InvalidInputError, match="their curvature is no number; scale them"):
            metric_space_curvature(scale * (np.ones((6, 6)) - np.eye(6)))
    with pytest.raises(NotAMetricError, match="triangle inequality"):
        metric_space_curvature([[0, 1, 4], [1, 0, 2], [4, 2, 0]])
    with pytest.raises(InvalidInputError, match="geodesic_space makes one of a mesh"):
        metric_space_curvature(nx_mesh())


def nx_mesh():
    from rinow import TriangleMesh

    shape = shapes.tetrahedron()
    return TriangleMesh(shape.vertices, shape.faces)


@pytest.mark.parametrize("exponent", [-498, -330, 330, 498])
def test_value_follows_the_unit_of_length_to_the_ends_of_the_range(exponent):
    """Multiplying by a power of two is exact, so the curvature is that of the unit, times a power of two."""
    D = sampled(4.0, 14, 7, radius=0.3).distances
    expected = metric_space_curvature(D)
    actual = metric_space_curvature(np.ldexp(D, exponent))
    np.testing.assert_array_equal(actual.status, expected.status)
    np.testing.assert_allclose(np.ldexp(actual.value, 2 * exponent), expected.value, rtol=1e-9)
    np.testing.assert_allclose(np.ldexp(actual.radius, -exponent), expected.radius, rtol=1e-9)


@pytest.fixture(scope="module")
def polyhedron():
    """Distances along an irregular mesh of a torus, its curvature, and the mean edge."""
    shape = shapes.irregular_torus(600, seed=3)
    mesh = TriangleMesh(shape.vertices, shape.faces)
    return geodesic_space(mesh), shape.gaussian, mesh.edge_lengths.mean()


@pytest.mark.parametrize(("n_edges", "least", "most"), [(1.5, 0.98, 0.003), (None, 0.935, 0.02)])
def test_vertices_of_a_polyhedron_are_no_bumps(polyhedron, n_edges, least, most):
    # All curvature is at the vertices: second derivatives once doubled it, and the ball before agreed with that.  Means
    # over the points around hid what their variances, of which one may be huge, do not explain.
    space, K, edge = polyhedron
    found = metric_space_curvature(space, radius=None if n_edges is None else n_edges * edge)
    known = found.status == VertexStatus.OK
    errors = (np.abs(found.value - K) / found.standard_error)[known]
    assert np.mean(known) > 0.95
    assert np.mean(errors < 2.0) > least
    assert np.mean(errors > 3.0) < most
