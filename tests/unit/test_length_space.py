"""Midpoints, their defect and intrinsic metrics: closed forms, the counter-example to Prop. 2.49, refusals."""

import math
import re

import numpy as np
import pytest

import rinow
from naive.nets import circle
from rinow.errors import InvalidInputError, NotAMetricError


def line(n):
    return np.abs(np.arange(float(n))[:, None] - np.arange(float(n)))


def test_midpoints_of_a_line():
    assert rinow.midpoints(line(9), 1, 7, epsilon=0.0).tolist() == [4]
    assert rinow.midpoints(line(9), 0, 7, epsilon=0.0).tolist() == []
    assert rinow.midpoints(line(9), 0, 7, epsilon=1.0).tolist() == [3, 4]
    assert rinow.midpoints(line(9), 3, 3, epsilon=0.0).tolist() == [3]


def test_opposite_points_of_a_circle_have_two_midpoints():
    assert rinow.midpoints(circle(8), 0, 4, epsilon=1e-12).tolist() == [2, 6]


def test_a_point_at_equal_distances_is_no_midpoint():
    """Definition 2.47 (1) as printed would accept the top of a triangle of sides 2, 2, 2."""
    D = 2.0 * (1 - np.eye(3))
    assert rinow.midpoints(D, 0, 1, epsilon=0.0).tolist() == []
    assert rinow.midpoints(D, 0, 1, epsilon=2.0).tolist() == [0, 1, 2]


def test_defects_of_points_lines_and_circles():
    assert rinow.length_defect([[0.0]]) == 0.0
    assert rinow.length_defect([[0.0, 3.0], [3.0, 0.0]]) == 3.0
    assert rinow.length_defect(line(10)) == 1.0
    assert rinow.length_defect(circle(10)) == pytest.approx(math.pi / 5, rel=1e-12)


def test_the_punctured_plane_has_epsilon_midpoints_only():
    """Prop. 2.49 is false as printed: the metric is intrinsic, but a midpoint of x and -x could only be the origin."""
    epsilons, h = (0.5, 0.25, 0.125), 1 / 16
    grid = np.arange(-1, 1 + h / 2, h)
    points = np.stack(np.meshgrid(grid, grid), axis=-1).reshape(-1, 2)
    points = points[(points != 0).any(axis=1)]
    space = rinow.MetricSpace.from_points(points)
    x = int(np.flatnonzero((points == (1, 0)).all(axis=1))[0])
    y = int(np.flatnonzero((points == (-1, 0)).all(axis=1))[0])
    assert len(rinow.midpoints(space, x, y, epsilon=0.0)) == 0
    for epsilon in epsilons:
        assert len(rinow.midpoints(space, x, y, epsilon=epsilon)) > 0


def test_the_intrinsic_metric_of_a_circle_in_the_plane_is_its_arc_length():
    errors = []
    for n in (50, 100, 200):
        t = np.arange(n) * 2 * np.pi / n
        chords = rinow.MetricSpace.from_points(np.stack([np.cos(t), np.sin(t)], axis=1))
        # steps to one neighbour each way; each chord is short of its arc by (2π/n)³/24
        inner = rinow.intrinsic_metric(chords, 1.5 * 2 * np.pi / n)
        errors.append(np.abs(inner.distances - circle(n)).max())
        assert (inner.distances >= chords.distances - 1e-12).all()
        assert errors[-1] == pytest.approx(n / 2 * (2 * np.pi / n) ** 3 / 24, rel=1e-2)
    assert errors == sorted(errors, reverse=True)


def test_the_intrinsic_metric_of_a_subset():
    inner = rinow.intrinsic_metric(line(9), 2.5, indices=[0, 2, 4, 8], infinite=True)
    assert inner.distances[0].tolist() == [0, 2, 4, math.inf]
    with pytest.raises(NotAMetricError, match="no path from node 0 to node 3"):
        rinow.intrinsic_metric(line(9), 2.5, indices=[0, 2, 4, 8])


BAD = [
    (lambda: rinow.midpoints(line(3), [1], 0, epsilon=0.0), "x has shape (1,); give one index."),
    (lambda: rinow.midpoints(line(3), 0, 1, epsilon="a"), "epsilon has type <U1; give real numbers."),
    (lambda: rinow.midpoints(line(3), 0, 3, epsilon=0.0), "y = 3 is outside 0..2"),
    (lambda: rinow.midpoints(line(3), 0, 1, epsilon=-1.0), "epsilon = -1.0 is not a defect"),
    (lambda: rinow.intrinsic_metric(line(3), 0.0), "step = 0.0 is not a length"),
    (lambda: rinow.intrinsic_metric(line(3), 1.0, indices=[]), "indices has shape (0,)"),
    (
        lambda: rinow.length_defect(rinow.intrinsic_metric(line(3), 1.0, infinite=True)),
        "distances[0, 1] is infinite; take one component.",
    ),
]


@pytest.mark.parametrize(("action", "message"), BAD)
def test_faults_of_arguments_are_named(action, message):
    with pytest.raises(InvalidInputError, match=re.escape(message)):
        action()
