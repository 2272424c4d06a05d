"""Hausdorff distance: closed forms, witnesses, imperfect meshes, and every refusal."""

import math
import re

import numpy as np
import pytest

import rinow
from golden_files import golden
from naive import hausdorff as naive
from rinow.errors import InvalidInputError, InvalidMeshError, NotAMetricError
from shapes import box, cube, icosphere, irregular_sphere, tetrahedron

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
HALVES = np.array([[0, 1, 2], [0, 2, 3]])


def pair(shape):
    return shape.vertices, shape.faces


def check(A, B, truth, tolerance=1e-4):
    """The interval contains the truth, is as narrow as asked, and its witnesses are at the lower bound."""
    result = rinow.hausdorff_distance(A, B, tolerance=tolerance)
    diagonal = max(np.linalg.norm(np.ptp(np.asarray(V), axis=0)) for V, _ in (A, B))
    assert result.lower <= truth <= result.upper
    assert result.upper - result.lower <= tolerance * diagonal * (1 + 1e-9)
    # the lower bound is the distance of the witnesses less a bound of the rounding
    assert math.dist(result.witness_a, result.witness_b) == pytest.approx(result.lower, abs=1e-10 * diagonal)
    assert max(np.nanmax(result.distances_a), np.nanmax(result.distances_b)) <= result.upper
    return result


def test_point_sets_in_space_have_their_exact_distance():
    A, B = [[0.0, 0.0], [3.0, 0.0]], [[0.0, 1.0], [0.0, 0.0], [3.0, 4.0]]
    result = rinow.hausdorff_distance(A, B)
    assert result.lower == result.upper == 4.0
    assert (result.witness_a, result.witness_b) == (1, 2)
    assert result.distances_a.tolist() == [0.0, 3.0]
    assert result.distances_b.tolist() == [1.0, 0.0, 4.0]
    assert result.directed_a == (3.0, 3.0)
    assert result.directed_b == (4.0, 4.0)


def test_witnesses_of_subsets_are_points_of_the_space():
    space = rinow.MetricSpace.from_points([[0.0], [1.0], [2.0], [7.0]])
    result = rinow.hausdorff_distance([1, 3], [0, 2], space=space)
    assert result.lower == result.upper == 5.0
    assert (result.witness_a, result.witness_b) == (3, 2)
    assert rinow.hausdorff_distance([2], [2], space=space).upper == 0.0
    assert rinow.hausdorff_distance([0], [3], space=space.distances).upper == 7.0


def test_unit_and_position_do_not_matter():
    rng = np.random.default_rng(11)
    A, B = rng.normal(size=(40, 3)), rng.normal(size=(30, 3))
    d = rinow.hausdorff_distance(A, B).upper
    for scale in (2.0**-900, 2.0**900):  # powers of two change no digit
        assert rinow.hausdorff_distance(A * scale, B * scale).upper == d * scale


def test_parallel_squares_are_at_the_distance_of_their_planes():
    result = check((SQUARE, HALVES), (SQUARE + np.array([0, 0, 0.125]), HALVES), 0.125)
    assert result.distances_a.tolist() == [0.125] * 4


def test_surfaces_are_compared_not_their_vertices():
    """One square cut into many parts: the vertices are far apart, the surfaces are the same."""
    fine = box(7)
    result = check(pair(cube()), pair(fine), 0.0, tolerance=1e-9)
    assert np.nanmax(result.distances_b) < 1e-12


def test_a_cube_in_a_larger_cube():
    inner, outer = pair(cube()), (2 * cube().vertices - 0.5, cube().faces)
    check(inner, outer, 3**0.5 / 2)


def test_a_lifted_triangle_is_farthest_inside_a_face():
    """The distance of a square from its four sides is greatest at its centre, where it has no vertex."""
    rim = [(SQUARE[i], SQUARE[(i + 1) % 4]) for i in range(4)]
    V = np.concatenate([[a, b, (a + b) / 2] for a, b in rim])
    F = np.arange(12).reshape(4, 3)
    result = check((SQUARE, HALVES), (V, F), 0.5, tolerance=1e-6)
    np.testing.assert_allclose(result.witness_a, [0.5, 0.5, 0.0], atol=1e-5)
    assert result.distances_a.tolist() == [0.0] * 4


@pytest.mark.parametrize("gap", [1e-3, 0.1, 1.0])
def test_concentric_polyhedra(gap):
    """A polyhedron and its multiple: the corners of the outer one are farthest, and their foot is a point of a face.

    For the enlarged tetrahedron the corner is nearest to the corner; the distance is gap times the circumradius.
    """
    t = tetrahedron()
    check(pair(t), ((1 + gap) * t.vertices, t.faces), gap * 3**0.5)


def test_concentric_spheres():
    """The truth lies between the vertices of one sphere and the sphere round the other one."""
    inner, outer = irregular_sphere(2000), irregular_sphere(1500, radius=1.25, seed=9)
    result = rinow.hausdorff_distance(pair(inner), pair(outer))
    depth = [1 - np.abs(np.linalg.det(s.vertices[s.faces])).min() for s in (inner, outer)]
    assert 0.25 <= result.upper
    assert result.lower <= 0.25 + max(depth)


def test_identical_meshes_are_at_distance_0():
    for shape in (icosphere(2), irregular_sphere(500), box(3)):
        result = rinow.hausdorff_distance(pair(shape), pair(shape))
        assert result.lower == result.upper == 0.0


def test_the_order_of_vertices_and_faces_does_not_matter():
    rng = np.random.default_rng(5)
    s, u = irregular_sphere(300), irregular_sphere(400, seed=3)
    move, turn = rng.permutation(300), rng.permutation(len(s.faces))
    shuffled = s.vertices[np.argsort(move)], move[s.faces][turn]
    a, b = rinow.hausdorff_distance(pair(s), pair(u)), rinow.hausdorff_distance(shuffled, pair(u))
    np.testing.assert_allclose(b.distances_a[move], a.distances_a, atol=1e-13)  # rounding of the foot points
    assert a.lower <= b.upper
    assert b.lower <= a.upper


def test_swapping_the_surfaces_swaps_the_result():
    s, u = pair(irregular_sphere(200)), pair(irregular_sphere(300, radius=1.1, seed=3))
    a, b = rinow.hausdorff_distance(s, u), rinow.hausdorff_distance(u, s)
    assert a.lower <= b.upper
    assert b.lower <= a.upper
    np.testing.assert_allclose(a.distances_a, b.distances_b, atol=1e-13)


def test_points_against_a_surface():
    points = np.array([[0.5, 0.5, 2.0], [0.25, 0.5, -1.0]])
    result = rinow.hausdorff_distance(points, (SQUARE, HALVES), tolerance=1e-5)
    truth = max(math.dist(points[1], (1, y, 0)) for y in (0, 1))
    assert result.distances_a.tolist() == [2.0, 1.0]
    assert result.directed_a[0] == pytest.approx(2.0, abs=1e-12)
    assert result.lower <= max(2.0, min(truth, math.dist(points[0], (1, 0, 0)))) <= result.upper


def test_vertices_off_the_surface_have_no_distance():
    V = np.concatenate([SQUARE, [[9.0, 9.0, 9.0], [np.nan, 0, 0]]])
    F = np.concatenate([HALVES, [[0, 1, 5], [2, 2, 3]]])
    result = rinow.hausdorff_distance((V, F), (SQUARE, HALVES))
    assert result.upper == 0.0
    np.testing.assert_array_equal(result.distances_a, [0, 0, 0, 0, np.nan, np.nan])


def test_faces_without_area_are_segments_and_points_of_the_surface():
    V = np.concatenate([SQUARE, [[2.0, 0, 0], [3.0, 0, 0], [3.0, 0, 0]]])
    result = rinow.hausdorff_distance((V, np.concatenate([HALVES, [[4, 5, 6]]])), (SQUARE, HALVES))
    assert result.lower <= 2.0 <= result.upper
    assert result.upper - result.lower < 1e-3
    point = np.full((3, 3), 4.0), [[0, 1, 2]]
    check(point, point, 0.0)
    check(point, (SQUARE, HALVES), math.dist((4, 4, 4), (0, 0, 0)))


def test_far_from_the_origin_the_interval_widens_by_the_rounding_of_the_input_only():
    s, u = irregular_sphere(200), irregular_sphere(300, radius=1.1, seed=3)
    a = rinow.hausdorff_distance(pair(s), pair(u))
    shift = np.array([1e9, -2e9, 3e9])
    b = rinow.hausdorff_distance((s.vertices + shift, s.faces), (u.vertices + shift, u.faces))
    rounding = 4e-7 * 3**0.5  # of coordinates near 3e9
    assert b.lower - rounding <= a.upper
    assert a.lower <= b.upper + rounding
    apart = rinow.hausdorff_distance(pair(s), (s.vertices + np.array([1e9, 0, 0]), s.faces))
    assert apart.lower <= 1e9 <= apart.upper
    assert apart.upper - apart.lower < 1e-3


def test_needles_keep_the_certificate():
    """A face with an angle of 1e-9: its plane is unknown, so the lower bound gives way."""
    V = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1e-9, 0], [0, 0, 1]])
    F = [[0, 1, 2], [0, 1, 3]]
    W = V + np.array([0, 0.25, 0])
    result = rinow.hausdorff_distance((V, F), (W, F))
    truth, _ = naive.enclosure(W[F].tolist(), V[F].tolist(), 16)
    assert result.lower <= 0.25
    assert result.upper >= truth


def test_a_finer_tolerance_narrows_the_interval():
    s, u = pair(irregular_sphere(300)), pair(irregular_sphere(200, seed=4))
    widths = []
    for tolerance in (1e-2, 1e-4, 1e-6, 1e-9):
        result = rinow.hausdorff_distance(s, u, tolerance=tolerance)
        widths.append(result.upper - result.lower)
        assert widths[-1] <= tolerance * 2 * 3**0.5
    assert widths == sorted(widths, reverse=True)


def test_pieces_that_stand_upright_on_their_triangle_come_to_an_end():
    """Two crossing soups, found at random: carving alone made pieces ever narrower, but never shorter."""
    A, B = ((np.array(m["vertices"]), np.array(m["faces"])) for m in golden("hausdorff_upright").values())
    coarse = rinow.hausdorff_distance(A, B, tolerance=1e-3)
    fine = rinow.hausdorff_distance(A, B, tolerance=1e-6)
    assert coarse.lower <= fine.lower <= fine.upper <= coarse.upper
    assert fine.upper - fine.lower <= 1e-6 * 4


LENGTHS = rinow.IntrinsicMesh([[0, 1, 2]], [[1.0, 1.0, 1.0]])
REFUSALS = [
    (([], [[0.0]]), {}, "A has shape (0,); give one point per row, shape (n, d)."),
    ((np.empty((0, 2)), [[0.0, 0]]), {}, "A is empty; the Hausdorff distance needs at least one point in each set."),
    (([[0.0]], [[np.inf]]), {}, "B[0, 0] = inf is not finite; remove the point."),
    (([[0.0]], [[0.0, 1]]), {}, "A has points of dimension 1, B of dimension 2; give the same."),
    (([[0.0]], [[0.0]]), {"tolerance": 0.0}, "tolerance = 0.0 is not positive; give"),
    (([[0.0]], [[0.0]]), {"tolerance": "1"}, "tolerance has type <U1; give real numbers"),
    ((np.empty((2, 0)), np.empty((2, 0))), {}, "A is empty; the Hausdorff distance"),
    (([0, 2], [1]), {"space": [[0, 1], [1, 0]]}, "A[1] = 2 is outside 0..1; indices count from 0."),
    (([0], []), {"space": [[0, 1], [1, 0]]}, "B has shape (0,); give one list of at least one index."),
    (([[0.0, 0]], (SQUARE, HALVES)), {}, "A has shape (1, 2); give one point per row, shape (n, 3)."),
]


@pytest.mark.parametrize(("sets", "options", "message"), REFUSALS)
def test_faults_of_arguments_are_named(sets, options, message):
    with pytest.raises(InvalidInputError, match=f"^{re.escape(message)}"):
        rinow.hausdorff_distance(*sets, **options)


def test_refusals_of_meshes_and_metrics():
    with pytest.raises(InvalidMeshError, match="IntrinsicMesh, but positions are needed"):
        rinow.hausdorff_distance(LENGTHS, (SQUARE, HALVES))
    with pytest.raises(InvalidMeshError, match=r"^B has no face with three different finite vertices"):
        rinow.hausdorff_distance((SQUARE, HALVES), (SQUARE, [[0, 0, 1]]))
    with pytest.raises(NotAMetricError, match="exceeds"):
        rinow.hausdorff_distance([0], [1], space=[[0, 1, 4], [1, 0, 2], [4, 2, 0]])
