"""Steps and waves of the curvature flow: what they keep, how far they reach, and that they do not grow."""

import numpy as np
import pytest

import shapes
from rinow import TriangleMesh
from rinow.curvature import waves as waves_module
from rinow.curvature.averages import squared_bias
from rinow.curvature.disagreement import proven_bias
from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.intrinsic import CALIBRATION, intrinsic_curvature
from rinow.curvature.waves import LADDER, LEAST, REACH, Waves, passed, window
from surface_methods import NOISY_TORUS, curvature_by_lengths


def test_total_curvature_is_kept_by_every_step():
    flow = CurvatureFlow(TriangleMesh(NOISY_TORUS.vertices, NOISY_TORUS.faces))
    once = flow.step(flow.defect_densities)
    total = np.sum(np.abs(flow.areas * flow.defect_densities))
    # The balance is approximate; without it the step misses 2 % of the absolute total.
    assert abs(np.sum(flow.areas * once)) < 0.005 * total
    np.testing.assert_allclose(flow.step(np.ones(len(once))), 1, atol=1e-12)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_windows_keep_polynomials_of_their_order(order):
    for m in LADDER[2:]:
        c, j = window(m, order), np.arange(len(window(m, order)))
        assert len(c) == np.ceil(REACH[order - 1] * np.sqrt(m))
        moments = [np.sum(c * j ** (2.0 * i)) / np.sum(np.abs(c) * j ** (2.0 * i)) for i in range(order + 1)]
        np.testing.assert_allclose(np.sum(c), 1, atol=1e-12)
        np.testing.assert_allclose(moments[1:order], 0, atol=1e-12)
        assert abs(moments[order]) > 1e-3  # and of no higher one
        # What passes is nearly that of order-fold heat flow with the same noise, without its tails.
        S = np.linspace(LEAST, 1, 200)
        assert np.abs(passed(c, S) - (1 - (1 - np.abs(S) ** m) ** order)).max() < 0.3


def test_waves_are_polynomials_in_the_step():
    flow = CurvatureFlow(TriangleMesh(NOISY_TORUS.vertices, NOISY_TORUS.faces))
    waves, c = Waves(flow, flow.defect_densities), window(4, 3)
    for _ in range(2):  # anew, and from waves that were kept
        found = waves.sums([window(32, 3), c])[1]
    powers = [flow.defect_densities]
    for _ in c[1:]:
        powers.append(flow.step(powers[-1]))
    stretched = np.polynomial.Polynomial([-(1 + LEAST) / (1 - LEAST), 2 / (1 - LEAST)])
    expected = np.polynomial.Chebyshev(c).convert(kind=np.polynomial.Polynomial)(stretched).coef @ powers
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(powers[0]).max())  # coefficients of up to 1e4


@pytest.mark.parametrize("order", [1, 3])
def test_no_window_reaches_further_than_its_steps_and_next_to_nothing_beyond_its_waves(order):
    shape = shapes.irregular_torus(8000)
    mesh = TriangleMesh(shape.vertices, shape.faces)
    flow, start = CurvatureFlow(mesh), np.zeros(mesh.n_vertices)
    start[0] = 1.0
    c = window(16, order)
    kernel = np.abs(Waves(flow, start).sums([c])[0])
    away = np.linalg.norm(shape.vertices - shape.vertices[0], axis=1) / np.sqrt(2 / (1 - LEAST) * flow.step_variances)
    assert kernel[away > 1.5 * len(c)].max() < 1e-3 * kernel.max()
    assert kernel[away > 2.8 * len(c)].max(initial=0.0) < 1e-13 * kernel.max()


def long_grid(n, stretch):
    """A paraboloid over n by n points in rows that are so many times further apart than the points in them."""
    i = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]))
    x, y = (np.indices((n, n)).reshape(2, -1) - (n - 1) / 2) * np.array([[1.0], [1 / stretch]]) / n
    faces = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return TriangleMesh(np.column_stack([x, y, (x * x + y * y) / 2]), faces)


def test_waves_do_not_grow_where_three_values_in_a_row_are_averaged():
    flow = CurvatureFlow(long_grid(24, 50))
    start = np.where(flow.has_data, (-1.0) ** np.arange(24 * 24), 0.0)  # alternating along the rows
    assert flow.step(start)[flow.has_data].min() < -0.25
    for m in (16, 128):
        assert np.nanmax(np.abs(Waves(flow, start).sums([window(m, 3)])[0])) < 1


def test_waves_that_grow_are_no_candidates_or_have_the_spread_of_it(monkeypatch):
    flow = CurvatureFlow(TriangleMesh(NOISY_TORUS.vertices, NOISY_TORUS.faces))
    exact = np.abs(NOISY_TORUS.gaussian).max()
    monkeypatch.setattr(waves_module, "LEAST", 0.1)  # some of what S does lies beyond
    assert np.abs(Waves(flow, flow.defect_densities).sums([window(64, 3)])[0]).max() > 1e5 * exact
    found = curvature_by_lengths(NOISY_TORUS)
    assert np.mean(np.abs(found.gaussian - NOISY_TORUS.gaussian) < 2 * found.spread) > 0.9
    assert np.abs(found.gaussian).max() < 5 * exact


def test_no_squared_bias_is_so_small_that_two_spreads_do_not_hold_the_difference_from_the_reference():
    flow = CurvatureFlow(TriangleMesh(NOISY_TORUS.vertices, NOISY_TORUS.faces))
    spike = np.zeros(len(NOISY_TORUS.vertices))
    spike[5] = 1e9
    squared = squared_bias(1, spike, flow, np.ones(len(spike)))
    assert 2 * CALIBRATION * np.sqrt(squared[5]) >= 1e9 * (1 - 1e-12)


def test_every_boundary_vertex_beside_the_interior_has_a_value():
    assert np.isfinite(intrinsic_curvature(long_grid(24, 5)).gaussian).all()


def test_a_bias_is_proved_by_most_vertices_around_and_by_no_wild_one():
    flow = CurvatureFlow(TriangleMesh(NOISY_TORUS.vertices, NOISY_TORUS.faces))
    n, rng = len(NOISY_TORUS.vertices), np.random.default_rng(3)
    noise = rng.normal(size=n)
    assert np.isnan(proven_bias(noise, np.ones(n), flow)).all()
    wild = noise.copy()
    wild[0] = 1e6
    assert np.isnan(proven_bias(wild, np.ones(n), flow)).all()
    away = np.linalg.norm(NOISY_TORUS.vertices - NOISY_TORUS.vertices[0], axis=1)
    found = proven_bias(noise + 10.0 * (away < 0.6), np.ones(n), flow)
    assert np.all(np.abs(found[away < 0.1] - 100.0) < 30.0)  # the square of 10, averaged over some rings
    assert np.isnan(found[away > 1.5]).all()
