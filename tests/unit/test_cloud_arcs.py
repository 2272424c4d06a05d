"""Arcs along a surface from points in space."""

import numpy as np
import pytest

import rinow
from rinow.curvature.clouds import arc_distances

CHOSEN = np.arange(10)


def turned(points, seed):
    """The same points, rotated and shifted."""
    rng = np.random.default_rng(seed)
    return points @ np.linalg.qr(rng.normal(size=(3, 3)))[0] + rng.normal(size=3)


@pytest.mark.parametrize("k", [0.25, 1.0, 4.0])
def test_arcs_of_a_sphere_are_great_circles(k):
    surface = rinow.SpaceForm(k)
    points = surface.sample(200, 0.2, np.random.default_rng(7))
    arcs, rtol = arc_distances(turned(points * [1, 1, k**0.5], 8), CHOSEN)
    expected = surface.distance(points[CHOSEN, None], points[CHOSEN])
    off = ~np.eye(10, dtype=bool)
    assert np.abs(arcs / np.where(off, expected, 1) - 1)[off].max() < rtol < 1e-2
    assert (arcs == arcs.T).all()
    assert not arcs.diagonal().any()


def test_arcs_of_a_cylinder_are_those_of_the_unrolled_plane():
    u, v = np.random.default_rng(9).uniform(-0.2, 0.2, (2, 200))
    points = np.stack([np.cos(u), np.sin(u), v], axis=1)
    arcs, rtol = arc_distances(turned(points, 10), CHOSEN)
    expected = np.hypot(u[CHOSEN, None] - u[CHOSEN], v[CHOSEN, None] - v[CHOSEN])
    off = ~np.eye(10, dtype=bool)
    assert np.abs(arcs / np.where(off, expected, 1) - 1)[off].max() < rtol < 1e-3


def test_chords_of_a_plane_stay():
    points = np.concatenate([np.random.default_rng(11).uniform(-1, 1, (60, 2)), np.zeros((60, 1))], axis=1)
    arcs, rtol = arc_distances(points, CHOSEN)
    assert arcs == pytest.approx(np.linalg.norm(points[CHOSEN, None] - points[CHOSEN], axis=2), rel=1e-13)
    assert rtol == pytest.approx(1e-12)


def test_points_that_fill_space_have_no_arcs():
    points = np.random.default_rng(12).uniform(-1, 1, (300, 3))
    assert arc_distances(points, CHOSEN) is None
    assert arc_distances(points[:24] * [1, 1, 0], CHOSEN) is None
