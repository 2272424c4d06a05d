"""Stars of the points of a cloud: how far they agree, which points face each other, and the signs of normals."""

import numpy as np
import pytest

import shapes
from naive import cloud_stars as naive
from rinow.curvature.cloud_facing import facing
from rinow.curvature.cloud_layers import cleaned, nearest_points
from rinow.curvature.cloud_signs import outward
from rinow.curvature.cloud_stars import Stars, agreement, first_stars, links_of

SIDE = 20
"""Points along each side of a wall; the outermost four rows see its rim."""


def wall(gap, seed=1):
    """Two sheets of uneven squares of side 1, a gap apart; 0 or 1 for each point."""
    rng = np.random.default_rng(seed)
    squares = np.stack(np.meshgrid(np.arange(SIDE + 0.0), np.arange(SIDE + 0.0)), axis=-1).reshape(-1, 2)
    sheets = [np.column_stack([squares + rng.uniform(-0.2, 0.2, squares.shape), np.full(SIDE**2, z)]) for z in (0, gap)]
    return np.concatenate(sheets), np.repeat([0, 1], SIDE**2)


def box(gap):
    """The same wall with one or more rows of points around it; these are of sheet 2."""
    points, sheet = wall(gap)
    x = np.arange(SIDE - 1.0)
    corner, last = np.zeros(SIDE - 1), SIDE - 1.0
    around = np.column_stack([np.r_[x, corner + last, last - x, corner], np.r_[corner, x, corner + last, last - x]])
    heights = np.linspace(0, gap, round(gap) + 1)[1:-1]
    rows = [np.column_stack([around, np.full(len(around), z)]) for z in heights]
    rim = np.concatenate(rows) if rows else np.empty((0, 3))
    return np.concatenate([points, rim]), np.concatenate([sheet, np.full(len(rim), 2)])


def is_inside(points):
    return np.abs(points[:, :2] - (SIDE - 1) / 2).max(axis=1) < SIDE / 2 - 4


def lists(stars):
    return [row[:count].tolist() for row, count in zip(stars.points, stars.counts, strict=True)]


@pytest.mark.parametrize("name", ["surface", "noise", "volume"])
def test_agreement_is_that_of_sets_of_triangles(name):
    rng = np.random.default_rng(4)
    torus = shapes.irregular_torus(500)
    points = {
        "surface": torus.vertices,
        "noise": shapes.noisy(torus, 0.3).vertices,
        "volume": rng.normal(size=(300, 3)),
    }[name]
    stars = first_stars(points, nearest_points(points).indices)[1]
    found = agreement(stars)
    np.testing.assert_array_equal(found, naive.agreement(lists(stars)))
    least, most = {"surface": (0.9, 1), "noise": (0.3, 0.9), "volume": (0, 0.3)}[name]  # and so the three cases differ
    assert least < found.mean() < most


def test_agreement_of_short_stars():
    # Two points of each other only, one of none, and a triangle that all of its corners have.
    rows = [[1], [0], [], [4, 5], [5, 3], [3, 4]]
    table = np.zeros((6, 2), np.intp)
    for row, star in zip(table, rows, strict=True):
        row[: len(star)] = star
    stars = Stars(table, np.array([len(star) for star in rows]), np.zeros(6))
    np.testing.assert_array_equal(agreement(stars), [0, 0, 0, 1, 1, 1])
    assert naive.agreement(rows) == [0, 0, 0, 1, 1, 1]


@pytest.mark.parametrize("gap", [1.5, 2.0, 3.0])
@pytest.mark.parametrize("shape", [wall, box])
def test_no_neighbours_across_a_wall(shape, gap):
    points, sheet = shape(gap)
    near = nearest_points(points).indices
    ahead, agreed = facing(points, near)
    own, inside = np.arange(len(points))[:, None], is_inside(points) & (sheet < 2)
    is_across, was_across = sheet[ahead] != sheet[:, None], sheet[near] != sheet[:, None]
    assert was_across[inside].any()
    # A bare sheet ends: its rim has no normal that turns around it, and errs by a few rows.
    assert is_across[inside].any(axis=1).mean() <= (0.05 if shape is wall else 0)
    assert (ahead == near)[inside][~was_across[inside]].mean() > 0.99
    np.testing.assert_array_equal(ahead[ahead != near], np.broadcast_to(own, near.shape)[ahead != near])
    assert agreed[inside].mean() > 0.98


def test_no_neighbours_across_between_spheres_one_spacing_apart():
    # Here the first planes see both, stars agree on a quarter, and the sheets are told by following them outwards.
    n = 1500
    r = 1 - np.sqrt(4 * np.pi / n)
    turn = np.linalg.qr(np.random.default_rng(9).normal(size=(3, 3)))[0]
    inner = r * shapes.irregular_sphere(int(n * r * r)).vertices @ turn
    points = np.concatenate([shapes.irregular_sphere(n).vertices, inner])
    is_outer = np.arange(len(points)) < n
    assert facing(points, nearest_points(points).indices)[1].mean() < 0.5
    near, is_stray, is_lost = cleaned(points)
    assert not is_stray.any() and not is_lost.any()
    assert (is_outer[near.indices] == is_outer[:, None]).all()


def test_sheets_nearer_than_a_spacing_are_not_told():
    # Planes through the first points see both sheets then, and stars say so; of one sheet they agree everywhere.
    points, sheet = wall(0.7)
    inside = is_inside(points)
    assert facing(points, nearest_points(points).indices)[1][inside].mean() < 0.5
    alone = points[sheet == 0]
    assert facing(alone, nearest_points(alone).indices)[1][inside[sheet == 0]].min() == 1


def signed(points):
    near = nearest_points(points).indices
    normals, stars = first_stars(points, near)
    return outward(points, normals, links_of(stars))


@pytest.mark.parametrize("gap", [1.5, 2.0, 3.0])
def test_normals_on_the_sides_of_a_wall_are_opposite(gap):
    points, sheet = box(gap)
    inside = is_inside(points) & (sheet < 2)
    assert (signed(points)[inside, 2] * np.where(sheet[inside] == 1, 1, -1) > 0.5).all()


@pytest.mark.parametrize("shape", [shapes.tetrahedron, lambda: shapes.icosphere(0), lambda: shapes.icosphere(2)])
def test_normals_of_a_sphere_of_few_points_point_outwards(shape):
    # On a tetrahedron the normals of neighbours make more than a right angle, and are mirror images all the same.
    points = shape().vertices
    points = points - points.mean(axis=0)
    points /= np.linalg.norm(points, axis=1)[:, None]
    links = links_of(first_stars(points, nearest_points(points).indices)[1])
    for seed in range(5):
        signs = np.random.default_rng(seed).choice([-1.0, 1.0], len(points))
        np.testing.assert_array_equal(outward(points, points * signs[:, None], links), points)


def test_order_and_rotation_leave_who_faces_whom():
    points, _ = box(1.5)
    rng = np.random.default_rng(6)
    order = rng.permutation(len(points))
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    near = nearest_points(points).indices
    ahead, agreed = facing(points, near)
    places = np.empty(len(points), np.intp)
    places[order] = np.arange(len(points))
    for moved in (points[order], points[order] @ turn + [3, 1, 2]):
        other, share = facing(moved, places[near[order]])
        # Corners of the box that the sum of the tree reaches otherwise are the exceptions.
        assert np.mean(np.sort(order[other], axis=1) == np.sort(ahead[order], axis=1)) > 0.99
        assert np.mean(share == agreed[order]) > 0.99
