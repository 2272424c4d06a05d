"""Height fields whose heights are whole multiples of a step: rounding, and no shape."""

import numpy as np
import pytest

import shapes
from rinow import TriangleMesh, VertexStatus, singular_features, surface_curvature
from rinow.curvature.levels import levels_of
from surface_methods import relative_error

TURN = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]


def height_field(height, n=64):
    """Vertices and faces of a graph over a square grid of spacing 1."""
    x, y = np.mgrid[:n, :n].reshape(2, -1).astype(float)
    return np.stack([x, y, height(x, y)], axis=1), shapes._grid_faces(n, n, None, closed=False)


def depth_image(step, n=96):
    """A ball of radius 1 at distance 3 before a camera, its depths in whole steps of so many pixels; and its pixels."""
    pixel = 1.4 / n
    rays = np.stack(np.broadcast_arrays(*(np.mgrid[:n, :n] / (n - 1) - 0.5) * 0.45, 1.0), axis=-1).reshape(-1, 3)
    along, square = 3.0 * rays[:, 2], np.sum(rays**2, axis=1)
    depth = (along - np.sqrt(along**2 - 8.0 * square)) / square
    depth = np.round(depth / (step * pixel)) * step * pixel
    return rays * depth[:, None], shapes._grid_faces(n, n, None, closed=False)


@pytest.mark.parametrize("quality", ("best", "fast"))
@pytest.mark.parametrize("step", (0.2, 0.5, 1.0))
@pytest.mark.parametrize("turn", (np.eye(3), TURN), ids=("upright", "turned"))
def test_depths_in_steps_are_those_of_a_smooth_surface(step, quality, turn):
    V, F = depth_image(step)
    found = surface_curvature((V @ turn.T, F), quality=quality)
    inner = ~TriangleMesh(V, F).topology.vertex_is_boundary
    assert (found.status[inner] == VertexStatus.OK).all()
    assert relative_error(found.gaussian[inner], np.ones(inner.sum())) < 0.15
    assert relative_error(np.abs(found.mean[inner]), np.ones(inner.sum())) < 0.1
    assert np.mean(np.abs(found.gaussian - 1.0)[inner] < 2.0 * found.spread[inner]) > 0.95
    assert any("whole multiples" in note for note in found.notes)


@pytest.mark.parametrize("step", (0.4, 0.7))
def test_steps_are_found_in_any_unit_and_position(step):
    V, F = height_field(lambda x, y: np.round(2.0 * np.sin(x / 9.0) * np.cos(y / 11.0) / step) * step)
    for scale in (1e-3, 1e3):
        levels = levels_of(TriangleMesh(scale * (V @ TURN.T + 5.0), F))
        assert levels.step == pytest.approx(scale * step, rel=1e-6)
        assert abs(levels.upright @ TURN[:, 2]) == pytest.approx(1.0, abs=1e-9)


def test_a_cliff_of_many_steps_is_a_crease_and_single_steps_are_none():
    V, F = height_field(lambda x, y: np.round((0.1 * x + 0.004 * y * y) / 0.3 + 12.0 * (x > 31.5)) * 0.3)
    rows = np.arange(len(V)) // 64
    creases = singular_features((V, F)).crease_edges
    assert len(creases) > 100
    assert (np.abs(rows[creases] - 31.5) < 2.0).all()


@pytest.mark.parametrize(
    "height",
    [
        lambda x, y: 20.0 - np.abs(x - 32.0) * 0.5,  # a roof
        lambda x, y: 0.5 * np.maximum(np.abs(x - 32.0), np.abs(y - 32.0)),  # a pyramid
        lambda x, y: 0.5 * x + 0.25 * y,  # a plane
        lambda x, y: 5.0 * np.sin(x / 9.0) * np.cos(y / 11.0),
        lambda x, y: np.round(5.0 * np.sin(x / 9.0) * np.cos(y / 11.0), 2),  # digits of a file
    ],
)
def test_even_grids_of_few_planes_and_fine_digits_are_no_levels(height):
    V, F = height_field(height)
    assert levels_of(TriangleMesh(V, F)) is None
    assert levels_of(TriangleMesh(V @ TURN.T, F)) is None


@pytest.mark.parametrize(
    "shape", [shapes.box(12), shapes.cone(60, 40), shapes.icosphere(4), shapes.irregular_torus(1000)]
)
def test_parts_are_no_levels(shape):
    assert levels_of(TriangleMesh(shape.vertices, shape.faces)) is None
