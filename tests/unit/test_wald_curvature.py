"""Wald curvature at a point: model surfaces, Kirk's theorems, and the points where there is none."""

import math

import networkx as nx
import numba
import numpy as np
import pytest

import conformal
import rinow
from metric_shapes import cone, sampled
from rinow import regular_radius, rinow_point_curvature, wald_curvature
from rinow.kernels import spaceform_model

SURFACE = conformal.Disk()


def rays(k, n_rays=6, n_rings=3, step=0.1):
    """Points of S_k at equal distances on rays from point 0: many triples are linear."""
    r = np.r_[0, np.repeat(step * np.arange(1, n_rings + 1), n_rays)]
    theta = np.r_[0, np.tile(2 * np.pi * np.arange(n_rays) / n_rays, n_rings)]
    points = np.empty((len(r), 3))
    for i in range(len(r)):
        spaceform_model.place(r[i], theta[i], k, points[i])
    D = rinow.SpaceForm(k).distance(points[:, None], points)
    aligned = np.abs(np.sin(theta[:, None] - theta)) < 1e-9
    along = np.where(np.cos(theta[:, None] - theta) > 0, np.abs(r[:, None] - r), r[:, None] + r)
    D = np.where(aligned, along, 0.5 * (D + D.T))
    D[0], D[:, 0] = r, r
    return D


# ------------------------------------------------------------------ where the curvature exists


@pytest.mark.parametrize("k", [-1.0, 0.0, 1.0])
@pytest.mark.parametrize("n", [5, 7, 20, 60])
def test_surfaces_of_constant_curvature_have_it(k, n):
    curvature = wald_curvature(sampled(k, n, seed=7), 0, radius=1.0)
    # A share of 1e-12 in the distances and a condition of 100 to 1000.
    assert curvature.value == pytest.approx(k, abs=1e-8)
    assert abs(curvature.value - k) <= 5 * curvature.standard_error
    assert curvature.exists
    assert curvature.n_without_value == 0
    assert curvature.n_quadruples == min(math.comb(min(n, 40), 4), 20000)


@pytest.mark.parametrize("k", [-1.0, 0.0, 1.0])
def test_where_wald_curvature_exists_so_does_modified_with_the_same_value(k):
    # 6.6, and 6.3 and 6.7 with the curvature of Rinow.
    D = rays(k)
    wald, modified = (wald_curvature(D, 0, radius=0.35, kind=kind) for kind in ("wald", "modified"))
    assert wald.exists and modified.exists
    assert (wald.value, modified.value) == pytest.approx((k, k), abs=1e-8)
    assert 100 < modified.n_quadruples < wald.n_quadruples == math.comb(19, 4) - 3 * math.comb(7, 4)
    triangles = rinow_point_curvature(D, 0, radius=0.35)
    assert triangles.exists
    assert triangles.value == pytest.approx(k, abs=1e-7)


def test_agrees_with_triangle_comparison_where_curvature_varies():
    P = SURFACE.sample(24, 0.1, seed=7)
    D, K = SURFACE.distances(P), SURFACE.curvature(P)
    wald, triangles = wald_curvature(D, 0, radius=0.2), rinow_point_curvature(D, 0, radius=0.2)
    assert wald.exists and triangles.exists
    assert wald.value == pytest.approx(K[0], abs=4 * wald.standard_error)
    assert wald.standard_error < 0.02
    assert triangles.value == pytest.approx(wald.value, abs=2 * triangles.standard_error)
    # The mean over quadruples, whose centroids are not at the point, is ten times as far from it.
    assert abs(K.mean() - K[0]) > 5 * abs(wald.value - K[0])


def test_result_has_the_unit_of_curvature():
    D = SURFACE.distances(SURFACE.sample(12, 0.1, seed=8))
    curvature, scaled = wald_curvature(D, 0, radius=1.0), wald_curvature(8 * D, 0, radius=8.0)
    assert 64 * scaled.value == pytest.approx(curvature.value, rel=1e-9)
    assert 64 * scaled.standard_error == pytest.approx(curvature.standard_error, rel=1e-6)


# ------------------------------------------------------------------ where it does not


def test_space_has_modified_but_no_wald_curvature():
    # Counter-example 6.4: not because of linear quadruples, but because those of a tetrahedron are unbounded.
    grid = np.indices((5, 5, 5)).reshape(3, -1).T
    for scale in (1.0, 1e-3):
        wald = wald_curvature(scale * grid, 62, radius=2.5 * scale)
        assert not wald.exists
        assert wald.standard_error > 0.01 / (2.5 * scale) ** 2
    modified = wald_curvature(grid, 62, radius=2.5, kind="modified")
    assert modified.exists
    assert modified.value == pytest.approx(0, abs=1e-10)
    triangles = rinow_point_curvature(grid, 62, radius=2.5)
    assert triangles.exists
    assert triangles.value == pytest.approx(0, abs=1e-9)
    points = np.random.default_rng(7).uniform(-1, 1, (50, 3))
    assert not wald_curvature(points, 0, radius=1.5).exists
    assert wald_curvature(points, 0, radius=1.5, kind="modified").n_quadruples == 0


@pytest.mark.parametrize("radius", [0.5, 0.25, 0.1])
def test_straight_distances_of_a_curved_surface_have_no_limit(radius):
    rng = np.random.default_rng(7)
    points = rinow.SpaceForm(1.0).sample(300, radius, rng)
    points[0] = 0
    assert not wald_curvature(rinow.MetricSpace.from_points(points), 0, radius=radius).exists


def test_points_of_a_surface_in_space_have_the_curvature_of_the_surface():
    rng = np.random.default_rng(7)
    sphere = rinow.SpaceForm(4.0).sample(400, 0.3, rng) * [1, 1, 2]
    x, y = rng.uniform(-0.3, 0.3, (2, 400))
    saddle = np.stack([x, y, 0.5 * (x * x - y * y)], axis=1)
    sphere[0] = saddle[0] = 0
    for points, expected in ((sphere, 4.0), (saddle, -1.0), (saddle * [1, 1, 0], 0.0)):
        curvature = wald_curvature(points, 0, radius=0.25)
        assert curvature.exists
        # The polynomial has degree 4, so lengths are off by (κc)⁴ and more, and each share counts 100/diameter².
        assert curvature.value == pytest.approx(expected, abs=0.01 * abs(expected) + 1e-9)


@pytest.mark.parametrize("exponent", [1.2, 1.8, 2.2, 3.0, np.inf])
@pytest.mark.parametrize("n", [8, 40])
def test_normed_planes_that_are_not_euclidean_have_none(exponent, n):
    # They are flat at no scale: a plane of norm p looks the same however small the ball.
    points = np.random.default_rng(7).uniform(-1, 1, (n, 2))
    points[0] = 0
    D = np.linalg.norm(points[:, None] - points, ord=exponent, axis=2)
    for radius in (1.5, 1.5e-4):
        assert not wald_curvature(D * (radius / 1.5), 0, radius=radius).exists
        assert not rinow_point_curvature(D * (radius / 1.5), 0, radius=radius).exists


@pytest.mark.parametrize("angle", [3.0, 5.0, 6.0, 7.0, 8.0])
@pytest.mark.parametrize("n", [20, 60])
def test_cone_points_have_no_wald_curvature(angle, n):
    assert not wald_curvature(cone(angle, n, seed=7), 0, radius=1.0).exists


def test_beside_a_cone_point_the_surface_is_flat():
    D = cone(5.0, 200, seed=7)
    beside = int(np.argmin(np.abs(D[0] - 0.7)))
    curvature = wald_curvature(D, beside, radius=0.2)
    assert curvature.exists
    assert curvature.value == pytest.approx(0, abs=1e-7)


def test_graphs_that_branch_have_no_wald_curvature():
    star = wald_curvature(nx.star_graph(5), 0, radius=1.0)
    assert (star.n_quadruples, star.n_without_value, star.exists) == (15, 10, False)
    assert star.value > 0  # four leaves are equidistant
    assert not wald_curvature(nx.grid_2d_graph(9, 9), 40, radius=4).exists
    circle = wald_curvature(nx.cycle_graph(40), 0, radius=8)
    assert (circle.n_quadruples, circle.exists) == (0, False)
    assert math.isnan(circle.value)


def test_too_few_points_have_no_limit():
    assert not wald_curvature(sampled(1.0, 4, seed=7), 0, radius=1.0).exists
    alone = wald_curvature([[0, 0, 0], [5, 5, 5]], 1, radius=1.0)
    assert (alone.n_quadruples, alone.exists, math.isnan(alone.value)) == (0, False, True)


# ------------------------------------------------------------------ errors of the distances


def test_scatter_from_errors_of_the_distances_is_not_taken_for_a_missing_limit():
    D, rng = sampled(1.0, 40, seed=7), np.random.default_rng(8)
    noise = np.triu(rng.uniform(-1e-4, 1e-4, D.shape), 1)
    space = rinow.MetricSpace(D * (1 + noise + noise.T), rtol=1e-3)
    curvature = wald_curvature(space, 0, radius=1.0, rtol=1e-4)
    assert curvature.exists
    assert curvature.value == pytest.approx(1, abs=4 * curvature.standard_error)
    assert curvature.standard_error < 0.1


def test_random_choice_of_quadruples():
    D = SURFACE.distances(SURFACE.sample(30, 0.1, seed=9))
    default, seeded = wald_curvature(D, 0, radius=1.0), wald_curvature(D, 0, radius=1.0, rng=np.random.default_rng(0))
    other = wald_curvature(D, 0, radius=1.0, rng=np.random.default_rng(11))
    assert default == seeded
    assert other.value != default.value
    assert other.value == pytest.approx(default.value, abs=default.standard_error)


def test_same_bits_on_one_and_two_threads():
    D, threads = SURFACE.distances(SURFACE.sample(15, 0.1, seed=9)), numba.get_num_threads()
    both = wald_curvature(D, 0, radius=1.0), regular_radius(D, 0)
    numba.set_num_threads(1)
    try:
        assert (wald_curvature(D, 0, radius=1.0), regular_radius(D, 0)) == both
    finally:
        numba.set_num_threads(threads)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"radius": 0.0}, "radius > 0"),
        ({"radius": math.nan}, "radius > 0"),
        ({"radius": 1.0, "kind": "kirk"}, "kind = 'kirk' is unknown"),
        ({"radius": 1.0, "point": 4}, r"^point = 4 is outside 0\.\.3"),
    ],
)
def test_faults_are_named(arguments, message):
    with pytest.raises(rinow.InvalidInputError, match=message):
        wald_curvature(np.ones((4, 4)) - np.eye(4), **{"point": 0, **arguments})


@pytest.mark.parametrize("exponent", [-498, -330, 330, 498])
def test_value_follows_the_unit_of_length_to_the_ends_of_the_range(exponent):
    """Multiplying by a power of two is exact, so the curvature is that of the unit, times a power of two."""
    D = sampled(4.0, 14, 7, radius=0.3)
    expected = wald_curvature(D, 0, radius=0.6)
    actual = wald_curvature(np.ldexp(D, exponent), 0, radius=np.ldexp(0.6, exponent))
    assert np.isclose(np.ldexp(actual.value, 2 * exponent), expected.value, rtol=1e-9)
    assert actual.exists and expected.exists


def test_radius_that_is_no_number_is_refused():
    with pytest.raises(rinow.errors.InvalidInputError, match="radius"):
        wald_curvature(np.eye(5, 3), 0, radius="a")
