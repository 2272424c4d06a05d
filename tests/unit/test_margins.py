"""Averages of angle defects at boundaries: the noise that stays there, and what is done about it."""

import numpy as np
import pytest

import shapes
from rinow import IntrinsicMesh, TriangleMesh, surface_curvature
from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.length_noise import LengthNoise
from rinow.curvature.margins import Margins, growth
from rinow.curvature.waves import Waves, window
from rinow.kernels.margins import jump_squares

SQUARE = shapes.open_patch(1600)
FLAT = TriangleMesh(SQUARE.vertices * [1.0, 1.0, 0.0], SQUARE.faces)
ERROR = 1e-6


def disturbed_defects(rng):
    """Angle defects of the flat square by errors of its lengths of standard deviation 1."""
    ends = np.sort(np.stack([np.roll(FLAT.faces, -k, axis=1)[:, :2] for k in (1, 2, 0)], axis=1), axis=2)
    edges, sides = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    lengths = FLAT.edge_lengths + ERROR * rng.normal(size=len(edges))[sides.reshape(-1, 3)]
    return IntrinsicMesh(FLAT.faces, lengths, FLAT.n_vertices).vertex_angle_defects / ERROR


def test_jumps_of_weights_make_the_variance_of_a_weighted_sum_of_defects():
    flow, rng = CurvatureFlow(FLAT), np.random.default_rng(5)
    defects = [np.where(flow.has_data, disturbed_defects(rng), 0.0) for _ in range(400)]
    for weights in (np.ones(FLAT.n_vertices), 1.0 + FLAT.vertices[:, 0], np.exp(-4.0 * FLAT.vertices[:, 1] ** 2)):
        weights, squares = np.where(flow.has_data, weights, 0.0), np.empty(FLAT.n_vertices)
        jump_squares(weights, np.zeros(FLAT.n_vertices), flow.metric, squares)  # of errors that do not know lengths
        assert np.var([weights @ d for d in defects]) == pytest.approx(squares.sum(), rel=0.25)  # 3.5 of 1/√200
    jump_squares(flow.has_data.astype(float), np.zeros(FLAT.n_vertices), flow.metric, squares)
    assert squares[np.max(np.abs(FLAT.vertices), axis=1) < 0.8].max() < 1e-12  # constant weights have none inside


@pytest.mark.parametrize("m", [8, 16, 32])
def test_the_variance_of_averages_is_known_at_boundaries(m):
    flow, rng = CurvatureFlow(FLAT), np.random.default_rng(6)
    noise, c = LengthNoise.of(flow), window(m, 1)
    edge = np.max(np.abs(FLAT.vertices), axis=1)
    is_beside = flow.has_data & (edge > 0.85) & (np.min(np.abs(FLAT.vertices), axis=1) < 0.5)
    radius = np.sqrt(10.0 * m * noise.step)
    even, faded = np.zeros((2, FLAT.n_vertices))
    for _ in range(30):
        K = np.divide(disturbed_defects(rng), flow.areas, out=np.zeros(len(even)), where=flow.has_data)
        even += Waves(flow, K).sums([c])[0] ** 2 / 30
        values, left = Margins(flow, noise, K, 128).averages(m, radius)[0]
        faded += values**2 / 30
    inside = noise.variance(c)
    expected = inside + noise.variance_by_jumps(c, Margins(flow, noise, K, 128).jumps(m))
    for found, known in ((even, expected), (faded, inside * growth(left, 1))):
        # The squares of jumps are averaged over rings instead of balls, and growth is that of one triangulation.
        assert 0.4 < np.mean(found[is_beside]) / np.mean(known[is_beside]) < 2.5
    assert np.mean(even[is_beside]) > 2.0 * np.mean(faded[is_beside]) > 4.0 * np.mean(inside[is_beside])


@pytest.mark.parametrize(("noise", "most"), [(0.01, 0.1), (0.05, 0.5)])
def test_boundaries_do_not_spoil_averages_of_angle_defects(noise, most):
    # Before weights faded out errors were up to K itself with noise of 5 %, with spreads of a third of that.
    shape = shapes.noisy(shapes.open_patch(2500), noise, seed=3)
    c = surface_curvature((shape.vertices, shape.faces), method="intrinsic")
    error = np.abs(c.gaussian - shape.gaussian)
    assert np.sqrt(np.mean(error**2) / np.mean(shape.gaussian**2)) < most
    assert np.mean(error < 2.0 * c.spread) > 0.9
