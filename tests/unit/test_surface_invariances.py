"""surface_curvature in other units and places, of soups, inside out, in tasks and by an executor."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import shapes
from rinow import VertexStatus
from rinow.curvature import patch_tasks
from surface_methods import METHODS, SPHERE, curvature


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("scale", [1e-150, 1e-40, 1e-3, 1e3, 1e40, 1e150])
def test_any_unit_of_length(method, scale):
    shape = shapes.noisy(shapes.irregular_ellipsoid(600), 0.002)
    c, d = curvature(shape, method=method), curvature(shape._replace(vertices=shape.vertices * scale), method=method)
    np.testing.assert_allclose(d.gaussian * scale * scale, c.gaussian, rtol=1e-10)
    np.testing.assert_allclose(d.mean * scale, c.mean, rtol=1e-10)
    np.testing.assert_allclose(d.radius / scale, c.radius, rtol=1e-7)  # weighted by risks, which have single precision
    np.testing.assert_allclose(d.shape_index, c.shape_index, rtol=1e-6)
    np.testing.assert_allclose(d.spread * scale * scale, c.spread, rtol=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_powers_of_two_change_no_bit(method):
    c, d = curvature(SPHERE, method=method), curvature(SPHERE._replace(vertices=SPHERE.vertices * 1024), method=method)
    np.testing.assert_array_equal(d.gaussian * 1024**2, c.gaussian)
    np.testing.assert_array_equal(d.spread * 1024**2, c.spread)


@pytest.mark.parametrize("method", METHODS)
def test_far_from_the_origin(method):
    c, d = curvature(SPHERE, method=method), curvature(SPHERE._replace(vertices=SPHERE.vertices + 1e6), method=method)
    # Positions keep 1e-10, heights of circles are 1e-2 of a radius of 0.5: 1e-8; angles of the star 1e-9 over 1e-2.
    np.testing.assert_allclose(d.gaussian, c.gaussian, rtol=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_soup_is_welded_for_the_computation(method):
    shape = shapes.soup(shapes.irregular_sphere(300))
    c = curvature(shape, method=method)
    whole = curvature(shapes.irregular_sphere(300), method=method)
    # The welded vertices come in the order of the soup, and with them the sums over stars.
    index = shapes.irregular_sphere(300).faces.ravel()
    np.testing.assert_allclose(c.gaussian, whole.gaussian[index], rtol=1e-9)
    np.testing.assert_array_equal(c.status, VertexStatus.OK)
    assert "300 points for 1788 vertices" in c.notes[0]


def test_tasks_and_executor_change_nothing(monkeypatch):
    expected = curvature(SPHERE, method="sectional")
    monkeypatch.setattr(patch_tasks, "CENTRES_PER_TASK", 100)
    with ThreadPoolExecutor(1) as pool:
        c = curvature(SPHERE, method="sectional", executor=pool)
    np.testing.assert_array_equal(c.gaussian, expected.gaussian)
    np.testing.assert_array_equal(c.direction1, expected.direction1)
