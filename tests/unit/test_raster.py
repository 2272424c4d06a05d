"""The depth buffer covers exactly the pixels inside a triangle and shows the nearest one."""

import numpy as np
import pytest

from rinow.report.figures import colour_limit, colour_scale, surface_figure
from rinow.report.raster import camera, rasterize


def _inside(triangle, x, y):
    """Sign test of a point against the three sides."""
    signs = []
    for k in range(3):
        a, b = triangle[k], triangle[(k + 1) % 3]
        signs.append((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]))
    return min(signs) >= 0 or max(signs) <= 0


def test_nearest_face_in_every_pixel():
    rng = np.random.default_rng(11)
    points = rng.uniform(-5, 35, size=(30, 3))
    faces = np.arange(30).reshape(10, 3)
    actual, weights = rasterize(points, faces, (28, 31))
    for row in range(28):
        for column in range(31):
            best, nearest = -np.inf, -1
            for f, (a, b, c) in enumerate(points[faces]):
                if _inside((a, b, c), column + 0.5, row + 0.5):
                    w = np.linalg.solve(
                        np.array([[*a[:2], 1], [*b[:2], 1], [*c[:2], 1]]).T, [column + 0.5, row + 0.5, 1]
                    )
                    z = w @ [a[2], b[2], c[2]]
                    if z > best:
                        best, nearest, expected = z, f, w
            assert actual[row, column] == nearest
            if nearest >= 0:
                np.testing.assert_allclose(weights[row, column], expected, atol=1e-9)


def test_nonfinite_and_invisible_faces_are_skipped():
    points = np.array([[np.nan, 0, 0], [5, 0, 0], [0, 5, 0], [-9, -9, 0], [-8, -9, 0], [-9, -8, 0]])
    face, _ = rasterize(points, np.array([[0, 1, 2], [3, 4, 5], [1, 1, 2]]), (6, 6))
    assert (face == -1).all()


def test_camera_is_a_rotation():
    view = camera(np.array([1.0, 2, 0.5]), np.array([0.0, 0, 1]))
    np.testing.assert_allclose(view @ view.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(view) == pytest.approx(1.0)


def test_colours_are_symmetric_and_clipped():
    values = np.concatenate([np.linspace(-1, 2, 1001), [1e9, np.nan, np.inf]])
    assert colour_limit(values) == pytest.approx(2.0, rel=0.05)
    assert colour_limit(np.array([np.nan])) == 1.0
    assert colour_limit(np.zeros(4)) == 1.0


def test_a_dense_part_counts_by_its_area():
    values = np.concatenate([np.linspace(1, 2, 101), np.full(900, 50.0), [np.nan]])
    areas = np.concatenate([np.full(101, 1.0), np.full(900, 1e-3), [1e6]])
    # 0.009 of the area has nine of ten values.
    scale = colour_scale(values, areas, signed=False)
    assert (scale.low, scale.high) == pytest.approx((1.02, 2.0), abs=0.02) and scale.rule.endswith("of the area")
    even = np.ones(len(values))
    assert colour_limit(values, even) == pytest.approx(colour_limit(values), rel=1e-3)
    assert colour_limit(values, 0 * even) == colour_limit(values)
    assert colour_limit(1e200 * values, 1e-200 * areas) == pytest.approx(1e200 * colour_limit(values, areas))


def test_colours_of_fields_that_are_never_negative_go_from_percentile_to_percentile():
    scale = colour_scale(np.append(np.linspace(1, 2, 101), [np.nan, 50.0]), signed=False)
    assert (scale.low, scale.high) == pytest.approx((1.02, 1.98), abs=0.02)
    for values in (np.full(3, 7.0), np.zeros(3), np.array([np.nan])):
        scale = colour_scale(values, signed=False)
        assert scale.low < scale.high
    assert colour_scale(np.array([-3.0, 1.0]), signed=True).low == -colour_limit(np.array([-3.0, 1.0]))


def test_figure_with_undefined_values_and_positions():
    V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [np.nan, 0, 0]])
    F = np.array([[0, 1, 2], [1, 2, 3]])
    figure = surface_figure(V, F, np.array([-1.0, np.nan, 2, np.nan]), label="K, in 1/length²", title="t", up="y")
    assert "undefined at 2 of 4" in figure.axes[-1].get_ylabel()
    assert figure.axes[0].images[0].get_array()[..., 3].max() == 1.0
