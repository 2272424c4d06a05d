"""Angles at a point and polar coordinates on model surfaces, cones and graphs; the rule of the paper corrected."""

import math

import networkx as nx
import numpy as np
import pytest

import conformal
import rinow
from rinow import angle_at, polar_coordinates
from rinow.kernels import spaceform_model

SURFACE = conformal.Disk()


def model(k, r, theta):
    """Distances of points of S_k with given polar coordinates, those on one ray exactly linear."""
    points = np.empty((len(r), 3))
    for i in range(len(r)):
        spaceform_model.place(r[i], theta[i], k, points[i])
    D = rinow.SpaceForm(k).distance(points[:, None], points)
    D = np.where(theta[:, None] == theta, np.abs(r[:, None] - r), 0.5 * (D + D.T))
    D[0], D[:, 0] = r, r
    return D


def scattered(n=30, seed=7):
    """Polar coordinates: the origin, a ray with inner points, a point at 1 radian, and random points."""
    rng = np.random.default_rng(seed)
    return np.r_[0, 0.05, 0.1, 0.4, 0.3, rng.uniform(0.1, 0.5, n)], np.r_[0, 0, 0, 0, 1, rng.uniform(0, 2 * math.pi, n)]


@pytest.mark.parametrize("k", [-1.0, 0.0, 1.0])
def test_angle_of_a_hinge(k):
    r, theta = scattered()
    D = model(k, r, theta)
    assert angle_at(D, 0, 3, 4, curvature=k) == pytest.approx(1, abs=1e-12)
    assert angle_at(D, 0, 4, 3, curvature=k) == pytest.approx(1, abs=1e-12)
    # Euclidean comparison from points at 0.05 and 0.1: the next order of K d²/6 is 0.05·0.1 times 0.3².
    assert angle_at(D, 0, 3, 4) == pytest.approx(1, abs=1e-4)
    assert angle_at(D, 0, 3, 2) == 0
    assert math.isnan(angle_at(D, 0, 0, 3))


def test_angle_without_side_points_is_off_by_a_third_of_the_area():
    r, theta = scattered()
    for k in (-0.01, 0.01):
        D = model(k, r, theta)
        area = rinow.SpaceForm(k).area(D[3, 4], r[3], r[4])
        expected = 1 - k * area / 3
        assert angle_at(D[np.ix_([0, 3, 4], [0, 3, 4])], 0, 1, 2) == pytest.approx(expected, abs=1e-7)


def test_angle_on_a_surface_of_variable_curvature_is_the_limit():
    P = np.array([[0.0, 0.0], [0.3, 0.0], [0.1, 0.25]])
    v = SURFACE.directions(P[[0, 0]], P[1:])
    expected = math.acos(v[0] @ v[1] / np.linalg.norm(v[0]) / np.linalg.norm(v[1]))  # conformal: angles are Euclidean
    whole = angle_at(SURFACE.distances(P), 0, 1, 2)
    # Leg points at t and 2t of the way: the error falls with t².
    errors = []
    for t in (0.2, 0.1, 0.05):
        D = SURFACE.distances(np.concatenate([P, SURFACE.flow(P[[0, 0]], np.outer([t, 2 * t], v[0]))]))
        for point, part in ((3, t), (4, 2 * t)):
            D[0, point] = D[point, 0] = part * D[0, 1]
            D[1, point] = D[point, 1] = (1 - part) * D[0, 1]
        D[3, 4] = D[4, 3] = t * D[0, 1]
        errors.append(abs(angle_at(D, 0, 1, 2) - expected))
    assert errors[0] < abs(whole - expected) / 10
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([2, 2], abs=0.3)


@pytest.mark.parametrize("k", [-1.0, 0.0, 1.0])
def test_polar_coordinates(k):
    r, theta = scattered()
    D = model(k, r, theta)
    for p1 in (1, 3):
        coordinates = polar_coordinates(D, 0, p1, 4, curvature=k)
        assert coordinates[:, 0] == pytest.approx(r, abs=1e-15)
        # Points near the direction 0 or π have half of the digits.
        assert coordinates[:, 1] == pytest.approx(theta, abs=1e-6)
    rough = polar_coordinates(D, 0, 3, 4)
    # Euclidean angles followed to the point along the first leg.
    assert rough[:, 1] == pytest.approx(theta, abs=1e-3)


def test_rule_of_the_paper_is_corrected():
    # Erratum 35: p1 at 0, p2 at 60 and q at 40 degrees; the printed rule gives 320 degrees.
    theta = np.radians([0, 0, 60, 40, 320, 100, 200])
    points = np.stack([np.cos(theta), np.sin(theta)], axis=1)
    points[0] = 0
    assert polar_coordinates(points, 0, 1, 2)[1:, 1] == pytest.approx(theta[1:], abs=1e-12)


def test_cone_point_has_less_than_a_full_turn():
    total, u = 4.0, np.array([0.0, 0.0, 0.5, 1.5, 2.0, 3.5])
    turn = np.abs(u[:, None] - u)
    turn = np.minimum(turn, total - turn)
    D = 2 * np.sin(turn / 2)
    D[0], D[:, 0] = 1.0, 1.0
    D[0, 0] = 0.0
    assert [angle_at(D, 0, 1, i) for i in range(1, 6)] == pytest.approx(turn[1, 1:], abs=1e-12)
    assert polar_coordinates(D, 0, 1, 2)[1:5, 1] == pytest.approx([0, 0.5, 1.5, 2.0], abs=1e-12)


def test_angles_of_a_graph_are_0_or_pi():
    star = nx.star_graph(3)
    assert angle_at(star, 0, 1, 2) == pytest.approx(math.pi)
    path = nx.path_graph(6)
    assert angle_at(path, 2, 4, 5) == 0
    assert angle_at(path, 2, 0, 5) == pytest.approx(math.pi)


def test_frames_on_a_line_are_refused():
    for p2 in (2, 3):
        with pytest.raises(rinow.InvalidInputError, match="choose p2 off the line p p1"):
            polar_coordinates([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [-1.0, 0.0]], 0, 1, p2)
    with pytest.raises(rinow.InvalidInputError, match="choose p2 off the line"):
        polar_coordinates([[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]], 0, 1, 0)
    with pytest.raises(rinow.InvalidInputError, match=r"outside 0\.\.2"):
        angle_at([[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]], 0, 1, 3)
