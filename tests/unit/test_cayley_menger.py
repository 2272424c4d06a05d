"""Simplices from their edge lengths against exact determinants, coordinates and golden values."""

import itertools
import math

import numpy as np
import pytest

import rinow
from golden_files import golden
from naive import cayley_menger as naive
from quadruple_shapes import matrix
from rinow.kernels import triangles

GOLDEN = golden("quadruples")
NO_LENGTHS = [
    [[0, 1, 1], [1, 0, np.nan], [1, np.nan, 0]],
    [[0, 1, 1], [1, 0, -1], [1, -1, 0]],
    [[0, 1, 1], [1, 0, 1], [1, 2, 0]],
    [[0, 1, 1], [1, 1, 1], [1, 1, 0]],
    [[0, 1, np.inf], [1, 0, np.inf], [np.inf, np.inf, 0]],
]
SQUARE = 2 * np.abs(np.sin(np.subtract.outer(range(4), range(4)) * math.pi / 4))


def simplices(n, dimension, count, seed):
    """Points and their distances."""
    points = np.random.default_rng(seed).normal(size=(count, n, dimension))
    return points, np.linalg.norm(points[:, :, None] - points[:, None], axis=-1)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 6])
def test_random_simplices_agree_with_exact_determinants(n):
    points, D = simplices(n, max(n - 1, 1), 20, seed=3)
    # Errors are a few roundings, times the longest edge over the least height, squared: below 1e6 here.
    expected = [float(naive.bordered(d)) for d in D.tolist()]
    assert rinow.cayley_menger_determinant(D) == pytest.approx(expected, rel=1e-9)
    edges = (points[:, 1:] - points[:, :1])[:, :, : n - 1]
    volume = np.abs(np.linalg.det(edges)) / math.factorial(n - 1)
    assert rinow.simplex_volume(D) == pytest.approx(volume, rel=1e-9)
    assert rinow.is_euclidean_simplex(D).all()
    if n > 1:
        assert rinow.simplex_volume(D) == pytest.approx([naive.volume(d) for d in D.tolist()], rel=1e-9)
        expected = [naive.circumradius(d) for d in D.tolist()]
        assert rinow.circumradius(D) == pytest.approx(expected, rel=1e-9)


def test_simplices_agree_with_60_digits():
    for row in GOLDEN["simplices"]:
        n = row["dim"] + 1
        D = matrix([float(x) for x in row["distances"].values()], n)
        flat = 1e-12 * max(1.0, float(row["circumradius"]) / D.max()) ** 2
        assert rinow.cayley_menger_determinant(D) == pytest.approx(float(row["cayley_menger"]), rel=flat)
        assert rinow.simplex_volume(D) == pytest.approx(float(row["volume"]), rel=flat)
        assert rinow.circumradius(D) == pytest.approx(float(row["circumradius"]), rel=flat)


def test_quadruples_agree_with_60_digits():
    D = np.array([matrix([float(x) for x in row["distances"].values()], 4) for row in GOLDEN["quadruples"]])
    diameter = D.max(axis=(1, 2))
    expected = np.array([float(row["D"]) for row in GOLDEN["quadruples"]])
    # The distances are rounded: 6 relative errors of eps/2 on terms that sum to less than 100 diameter^6.
    assert np.abs(rinow.cayley_menger_determinant(D / diameter[:, None, None]) - expected / diameter**6).max() < 1e-14
    is_tetrahedron = [row["tetrahedron"] for row in GOLDEN["quadruples"]]
    assert rinow.is_euclidean_simplex(D).tolist() == is_tetrahedron
    for d, row in zip(D, GOLDEN["quadruples"], strict=True):
        if row["tetrahedron"]:
            # Rounding the distances moves a flat tetrahedron by eps diameter^6 / determinant.
            flat = 1e-15 * d.max() ** 6 / float(row["D"])
            assert rinow.simplex_volume(d) == pytest.approx(float(row["volume"]), rel=1e-13 + 10 * flat)
            assert rinow.circumradius(d) == pytest.approx(float(row["circumradius"]), rel=1e-13 + 100 * flat)


def test_every_entry_of_a_batch_is_the_single_one():
    _, D = simplices(4, 3, 6, seed=4)
    batch = D.reshape(2, 3, 4, 4)
    for function in (rinow.cayley_menger_determinant, rinow.simplex_volume, rinow.circumradius):
        assert function(batch).tolist() == [[function(d) for d in row] for row in batch]


@pytest.mark.parametrize("n", [3, 4, 5])
def test_labels_do_not_matter(n):
    _, D = simplices(n, n - 1, 1, seed=6)
    for order in itertools.permutations(range(n)):
        permuted = D[0][np.ix_(order, order)]
        assert rinow.cayley_menger_determinant(permuted) == pytest.approx(rinow.cayley_menger_determinant(D[0]))
        assert rinow.circumradius(permuted) == pytest.approx(rinow.circumradius(D[0]), rel=1e-12)


def test_needle_triangles_keep_all_digits():
    # Sides 1, 1, 1e-9: area 5e-10 sqrt(1 - 2.5e-19), circumradius abc/(4 area).
    needle = matrix([1.0, 1.0, 1e-9], 3)
    assert rinow.simplex_volume(needle) == pytest.approx(5e-10, rel=1e-15)
    assert rinow.circumradius(needle) == pytest.approx(0.5, rel=1e-15)
    a, b, c = 2.0, 1.0 + 1e-9, 1.0
    assert rinow.simplex_volume(matrix([a, b, c], 3)) == pytest.approx(triangles.triangle_area(a, b, c), rel=1e-14)


def test_flat_simplices_have_volume_0_and_an_infinite_radius():
    for n, dimension in ((3, 1), (4, 2), (5, 3), (5, 2), (7, 5)):
        _, D = simplices(n, dimension, 100, seed=8)
        scale = D.max(axis=(1, 2)) ** (n - 1)
        # A squared height of 4 roundings leaves the root of that.
        assert (rinow.simplex_volume(D) <= 1e-7 * scale).all()
        assert np.isinf(rinow.circumradius(D)).all()
        assert not rinow.is_euclidean_simplex(D).any()
    assert rinow.cayley_menger_determinant(np.zeros((4, 4))) == 0
    assert rinow.cayley_menger_determinant(np.zeros((3, 3))) == 0
    assert rinow.simplex_volume(np.zeros((5, 5))) == 0
    assert not rinow.is_euclidean_simplex(np.zeros((2, 2)))


def test_metrics_without_a_simplex():
    tripod = matrix([1, 1, 1, 2, 2, 2], 4)
    assert rinow.cayley_menger_determinant(tripod) == pytest.approx(-32, rel=1e-14)
    assert np.isnan(rinow.simplex_volume(tripod))
    assert np.isnan(rinow.circumradius(tripod))
    # A positive determinant, but a triple that fails the triangle inequality.
    wrong = matrix([1, 1, 3, 3, 1, 5], 4)
    assert rinow.cayley_menger_determinant(wrong) == pytest.approx(468, rel=1e-14)
    assert np.isnan(rinow.simplex_volume(wrong))
    assert not rinow.is_euclidean_simplex(wrong)
    for D in (tripod, wrong, matrix([1, 1, 3], 3)):
        assert rinow.is_euclidean_simplex(D) == naive.is_simplex(D.tolist())


@pytest.mark.parametrize("n", [3, 4])
def test_a_bad_matrix_is_nan_and_leaves_the_others(n):
    bad = np.zeros((len(NO_LENGTHS), n, n))
    bad[:, :3, :3] = NO_LENGTHS
    D = np.concatenate([bad, 1 - np.eye(n)[None]])
    for function in (rinow.cayley_menger_determinant, rinow.simplex_volume, rinow.circumradius):
        assert np.isnan(function(D)).tolist() == [True] * len(bad) + [False]
    assert rinow.is_euclidean_simplex(D).tolist() == [False] * len(bad) + [True]
    assert not rinow.is_cospherical(D).any()


def test_wrong_shapes_raise():
    functions = (
        rinow.cayley_menger_determinant,
        rinow.simplex_volume,
        rinow.circumradius,
        rinow.is_euclidean_simplex,
        rinow.is_cospherical,
    )
    for function in functions:
        for bad in (np.zeros(4), np.zeros((3, 4)), np.zeros((2, 0, 0)), "abc"):
            with pytest.raises(rinow.InvalidInputError, match="distances"):
                function(bad)
        assert function(np.empty((0, 4, 4))).shape == (0,)
    with pytest.raises(rinow.InvalidInputError, match="at least 3 points"):
        rinow.is_cospherical([[0, 1], [1, 0]])


def test_the_determinant_of_a_triangle_is_minus_16_squared_areas():
    _, D = simplices(3, 2, 50, seed=13)
    area = [triangles.triangle_area(d[0, 1], d[1, 2], d[2, 0]) for d in D]
    assert rinow.cayley_menger_determinant(D) == pytest.approx(-16 * np.square(area), rel=1e-12)


def test_all_faces_without_a_tetrahedron():
    D = matrix([1, 1, 1, 1.9, 1.9, 1.9], 4)
    faces = [np.delete(np.delete(D, i, axis=0), i, axis=1) for i in range(4)]
    assert rinow.is_euclidean_simplex(faces).all()
    assert rinow.cayley_menger_determinant(D) < 0
    assert not rinow.is_euclidean_simplex(D)


def test_the_centre_of_the_circumsphere_makes_a_flat_simplex():
    # D(c, p1 .. p4) = -2 R² D(p1 .. p4) - Δ(p1 .. p4) = 0 for the centre c.
    for d in simplices(4, 3, 20, seed=14)[1]:
        radius = rinow.circumradius(d)
        centred = np.zeros((5, 5))
        centred[0, 1:] = centred[1:, 0] = radius
        centred[1:, 1:] = d
        squares = np.linalg.det(d**2)
        assert -2 * radius**2 * rinow.cayley_menger_determinant(d) == pytest.approx(squares, rel=1e-9)
        assert abs(rinow.cayley_menger_determinant(centred)) <= 1e-13 * max(radius, d.max()) ** 8 * 1e3


def test_four_points_have_eight_gram_determinants():
    # Four points: the bordered determinant is 8 times the Gram determinant of the edges at one of them.
    points, D = simplices(4, 3, 50, seed=9)
    edges = points[:, 1:] - points[:, :1]
    gram = np.linalg.det(edges @ edges.transpose(0, 2, 1))
    assert rinow.cayley_menger_determinant(D) == pytest.approx(8 * gram, rel=1e-10)


def test_jacobi_identity_in_its_corrected_form():
    # D(123) D(124) = M² + D(12) D(1234), M the minor of row 3, column 4; the paper prints another last factor.
    for d in simplices(4, 3, 20, seed=10)[1]:
        B = np.ones((5, 5))
        B[0, 0], B[1:, 1:] = 0, d**2
        minor = np.linalg.det(np.delete(np.delete(B, 3, axis=0), 4, axis=1))
        D = rinow.cayley_menger_determinant
        left = D(d[:3, :3]) * D(d[np.ix_([0, 1, 3], [0, 1, 3])])
        assert left == pytest.approx(minor**2 + D(d[:2, :2]) * D(d), rel=1e-12)


@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_points_of_a_sphere_are_cospherical(dimension):
    points, _ = simplices(dimension + 2, dimension, 200, seed=11)
    points /= np.linalg.norm(points, axis=-1, keepdims=True)
    distances = np.linalg.norm(points[:, :, None] - points[:, None], axis=-1)
    assert rinow.is_cospherical(distances).all()
    points[:, 0] *= 1 + 1e-6
    distances = np.linalg.norm(points[:, :, None] - points[:, None], axis=-1)
    assert not rinow.is_cospherical(distances).all()
    assert rinow.is_cospherical(distances, rtol=1e-5).all()


def test_points_of_a_hyperplane_are_cospherical_others_not():
    assert rinow.is_cospherical(simplices(5, 2, 100, seed=12)[1]).all()
    assert rinow.is_cospherical(simplices(4, 1, 100, seed=12)[1]).all()
    assert not rinow.is_cospherical(simplices(5, 3, 100, seed=12)[1]).any()
    assert not rinow.is_cospherical(simplices(4, 2, 100, seed=12)[1]).any()
    assert not rinow.is_cospherical(simplices(3, 1, 100, seed=12)[1]).any()
    assert not rinow.is_cospherical(simplices(4, 3, 100, seed=12)[1]).any()
    assert rinow.is_cospherical(SQUARE)
    assert not rinow.is_cospherical(matrix([1, 1, 1, 2, 2, 2], 4))


@pytest.mark.parametrize("edge", [1e-100, 1e-80, 1.0, 1e80, 1e100])
def test_volume_is_a_number_where_its_square_is_none(edge):
    D = edge * (1.0 - np.eye(4))
    np.testing.assert_allclose(rinow.simplex_volume(D), edge**3 / (6.0 * 2.0**0.5), rtol=1e-12)


@pytest.mark.parametrize("exponent", [-400, -3, 3, 400])
def test_which_triangles_are_flat_does_not_depend_on_the_unit(exponent):
    excess = np.array([-1e-6, -1e-12, -1e-15, 0.0, 1e-15, 1e-12])
    D = np.zeros((len(excess), 3, 3))
    D[:, 0, 1], D[:, 1, 2], D[:, 0, 2] = 1.0, 1e-3, 1.001 - excess
    D += np.swapaxes(D, 1, 2)
    expected, actual = rinow.simplex_volume(D), rinow.simplex_volume(np.ldexp(D, exponent))
    np.testing.assert_array_equal(np.ldexp(actual, -2 * exponent), expected)
    assert np.isnan(expected[0]) and expected[-1] > 0.0


@pytest.mark.parametrize("exponent", [-1000, -400, 400, 1000])
def test_what_a_simplex_is_does_not_depend_on_the_unit(exponent):
    rng = np.random.default_rng(3)
    for n in (2, 3, 4, 5):
        points = rng.normal(size=(4, n, n - 1))
        D = np.linalg.norm(points[:, :, None] - points[:, None], axis=3)
        scaled = np.ldexp(D, exponent)
        np.testing.assert_array_equal(np.ldexp(rinow.circumradius(D), exponent), rinow.circumradius(scaled))
        assert rinow.is_euclidean_simplex(scaled).all()
        if n >= 3:
            flat = np.ldexp(rinow.MetricSpace.from_points(points[0, :, : n - 2]).distances, exponent)
            assert not rinow.is_euclidean_simplex(flat)
            assert np.isinf(rinow.circumradius(flat))
            sphere = points[0, :, : n - 2] / np.linalg.norm(points[0, :, : n - 2], axis=1, keepdims=True)
            round_set = np.linalg.norm(sphere[:, None] - sphere, axis=2)
            assert rinow.is_cospherical(np.ldexp(round_set, exponent))


@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_a_determinant_out_of_range_keeps_its_sign(n):
    D = 1.0 - np.eye(n)
    assert rinow.cayley_menger_determinant(1e200 * D) == (-1.0) ** n * np.inf
    assert rinow.cayley_menger_determinant(1e-200 * D) == 0.0
    assert rinow.cayley_menger_determinant(np.ldexp(D, 50)) == np.ldexp(
        rinow.cayley_menger_determinant(D), 100 * n - 100
    )
