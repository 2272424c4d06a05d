"""Angles at a point and polar coordinates on model surfaces, cones and graphs; the rule of the paper corrected."""

import math

import networkx as nx
import numpy as np
import pytest

import conformal
import rinow
import shapes
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
    assert angle_at(D, 0, 3, 4, curvature=0.0) == pytest.approx(1, abs=1e-4)
    # Curvature from 12 points within 0.4, to 1e-9, counts a third of the area of the triangle.
    assert angle_at(D, 0, 3, 4) == pytest.approx(1, abs=1e-9)
    assert angle_at(D[3:][:, 3:], 0, 1, 2) == pytest.approx(angle_at(D, 3, 4, 5, curvature=k), abs=1e-8)
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
def test_polar_coordinates_in_surfaces_of_constant_curvature(k):
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


@pytest.mark.parametrize("shuffled", [False, True])
def test_angles_on_a_flat_mesh_are_exact(shuffled):
    x, y = np.meshgrid(np.arange(7.0), np.arange(5.0))
    V = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    a = (np.arange(4)[:, None] * 7 + np.arange(6)).ravel()
    F = np.concatenate([np.stack([a, a + 1, a + 8], axis=1), np.stack([a, a + 8, a + 7], axis=1)])
    F = np.roll(F, 1, axis=1)[np.random.default_rng(7).permutation(len(F))] if shuffled else F
    for p, p1, p2 in ((17, 19, 5), (0, 6, 33)):  # inside, and at a corner of the boundary
        z = (V[:, 0] - V[p, 0]) + 1j * (V[:, 1] - V[p, 1])
        theta = np.angle(z / z[p1]) * np.sign(np.angle(z[p2] / z[p1]))
        expected = np.stack([np.abs(z), np.where(z == 0, 0, theta % (2 * math.pi))], axis=1)
        assert polar_coordinates((V, F), p, p1, p2) == pytest.approx(expected, abs=1e-9)
        for q in (3, 12, 30):
            assert angle_at((V, F), p, p1, q) == pytest.approx(abs(np.angle(z[q] / z[p1])), abs=1e-12)


def test_angles_on_a_sphere_are_those_of_great_circles():
    shape = shapes.irregular_sphere(1000)
    V, rng = shape.vertices, np.random.default_rng(7)
    p = 17
    near = np.flatnonzero((V @ V[p] > math.cos(0.9)) & (V @ V[p] < math.cos(0.3)))
    q, r = rng.choice(near, (2, 40))
    u = V - (V @ V[p])[:, None] * V[p]
    u /= np.maximum(np.linalg.norm(u, axis=1), 1e-300)[:, None]
    expected = np.arccos(np.clip((u[q] * u[r]).sum(axis=1), -1, 1))
    actual = np.array([angle_at(shape[:2], p, *pair) for pair in zip(q.tolist(), r.tolist(), strict=True)])
    # The faces around a vertex miss K times their area, 4π/1000, of the full turn, unevenly; on the way to a vertex
    # n edges off as much is missing on either side of the path, each time 1/n as far from its end.
    assert np.abs(actual - expected).max() < 4 * 4 * math.pi / 1000
    assert abs(np.mean(actual - expected)) < 0.01
    # Without the faces, from distances: the curvature is estimated.
    angle = np.arccos(np.clip(V @ V.T, -1, 1)) * (1 - np.eye(len(V)))
    some = np.r_[p, near]
    D = angle[np.ix_(some, some)]
    D = 0.5 * (D + D.T)
    place = np.searchsorted(near, [q, r]) + 1
    for i in range(5):
        assert angle_at(D, 0, *place[:, i].tolist()) == pytest.approx(expected[i], abs=1e-5)


def test_corner_of_a_cube_has_three_right_angles():
    cube = shapes.cube()
    V = cube.vertices
    p = 0
    edges = np.flatnonzero(np.isclose(np.linalg.norm(V - V[p], axis=1), np.linalg.norm(V[1:] - V[p], axis=1).min()))
    a, b, c = edges.tolist()
    for q, r in ((a, b), (b, c), (a, c)):
        assert angle_at(cube[:2], p, q, r) == pytest.approx(math.pi / 2, abs=1e-12)
    theta = polar_coordinates(cube[:2], p, a, b)[[a, b, c], 1]
    # Three quarters of a full turn: the last edge is a right angle before the first one.
    assert theta == pytest.approx([0, math.pi / 2, 1.5 * math.pi], abs=1e-12)


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


def test_angles_with_points_that_no_path_leads_to_are_undefined():
    V = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 0, 0], [6, 0, 0], [5, 1, 0]]
    two, none = (V, [[0, 1, 2], [3, 4, 5]]), ([[0, 0, 0], [1, 0, 0], [np.nan, 0, 0]], [[0, 1, 2]])
    assert np.isnan([angle_at(two, 0, 1, 3), angle_at(two, 0, 3, 1), angle_at(none, 0, 1, 2)]).all()
    coordinates = polar_coordinates(two, 0, 1, 2)
    assert np.isinf(coordinates[3:, 0]).all() and np.isnan(coordinates[3:, 1]).all()


def test_frames_on_a_line_are_refused():
    for p2 in (2, 3):
        with pytest.raises(rinow.InvalidInputError, match="choose p2 off the line p p1"):
            polar_coordinates([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [-1.0, 0.0]], 0, 1, p2)
    with pytest.raises(rinow.InvalidInputError, match="choose p2 off the line"):
        polar_coordinates([[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]], 0, 1, 0)
    with pytest.raises(rinow.InvalidInputError, match=r"outside 0\.\.2"):
        angle_at([[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]], 0, 1, 3)
