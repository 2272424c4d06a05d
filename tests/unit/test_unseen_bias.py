"""Balls with too few vertices for a second order: nothing shows the bias there, and a guess of it moves no value."""

import numpy as np
import pytest

import shapes
from rinow import VertexStatus, point_cloud_curvature, surface_curvature

QUALITIES = ("best", "fast")


@pytest.mark.parametrize("quality", QUALITIES)
@pytest.mark.parametrize("factor", [1.8, 2.0])
def test_a_radius_that_holds_two_rings_finds_the_sphere(quality, factor):
    """Such balls have 13 to 19 vertices, enough for a quadric over a torus and no more: on a sphere next to exact."""
    mesh = shapes.icosphere(3)[:2]
    c = surface_curvature(mesh, radius=factor * 0.15, quality=quality)  # the edges are 0.14 to 0.16 long
    assert np.all(c.status == VertexStatus.OK)
    assert np.abs(c.gaussian - 1).max() < 1e-3
    assert np.abs(c.mean - 1).max() < 1e-3


def test_the_guess_of_the_bias_counts_in_radii():
    """0.3 over the squared radius, whatever the edges; times 1.4 √0.8, and more away from the centres of patches."""
    radius = 0.3
    spread = surface_curvature(shapes.icosphere(3)[:2], radius=radius).spread
    guess = 1.4 * np.sqrt(0.8) * 0.3 / radius**2
    assert np.all((guess < spread) & (spread < 3 * guess))


@pytest.mark.parametrize("quality", QUALITIES)
def test_forty_two_vertices_of_a_sphere(quality):
    c = surface_curvature(shapes.icosphere(1)[:2], quality=quality)
    error = np.abs(c.gaussian - 1)
    assert error.max() < (0.02 if quality == "best" else 0.1)
    assert np.all(error < 2 * c.spread)


def test_fifty_points_of_a_sphere():
    rng = np.random.default_rng(50)
    points = rng.normal(size=(50, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    c = point_cloud_curvature(points)
    assert np.nanmax(np.abs(c.gaussian - 1)) < 0.06
    assert np.all(c.status == VertexStatus.OK)
