"""Distortion, uniform distance, ε-isometries, (ε, δ)-approximations and collections of spaces."""

import math
from concurrent.futures import ThreadPoolExecutor
from itertools import product

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

from naive import correspondences as naive
from rinow import (
    distance_matrix,
    distortion,
    find_approximation,
    find_epsilon_isometry,
    gromov_hausdorff,
    lipschitz_distance,
    uniform_distance,
)
from rinow.errors import InvalidInputError, NotAMetricError

LINE = [[0, 1, 2], [1, 0, 1], [2, 1, 0]]


def cloud(rng, n):
    """Distances of random points of the plane."""
    return squareform(pdist(rng.random((n, 2))))


def test_distortion_equals_its_naive_twin():
    rng = np.random.default_rng(4)
    X, Y = cloud(rng, 6), cloud(rng, 7)
    pairs = np.stack([rng.integers(6, size=9), rng.integers(7, size=9)], axis=1)
    assert distortion(pairs, X, Y) == naive.distortion(pairs.tolist(), X.tolist(), Y.tolist())
    f = rng.integers(7, size=6)
    assert distortion(f, X, Y) == distortion(np.stack([np.arange(6), f], axis=1), X, Y)


def test_distortion_of_a_common_parametrisation():
    """Remark 2.33 corrected: maps f: Z → X and g: Z → Y; distortion 0 exactly for isometric images."""
    rng = np.random.default_rng(14)
    X = cloud(rng, 5)
    f = rng.integers(5, size=8)
    g = np.array([2, 0, 1, 4, 3])[f]
    Y = X[np.ix_(np.argsort([2, 0, 1, 4, 3]), np.argsort([2, 0, 1, 4, 3]))]
    assert distortion(np.stack([f, g], axis=1), X, Y) == 0.0


def test_composition_adds_distortions():
    rng = np.random.default_rng(15)
    X, Y, Z = cloud(rng, 6), cloud(rng, 5), cloud(rng, 7)
    f, g = rng.integers(5, size=6), rng.integers(7, size=5)
    assert distortion(g[f], X, Z) <= distortion(f, X, Y) + distortion(g, Y, Z) + 1e-15


@pytest.mark.parametrize(
    ("relation", "message"),
    [
        (np.empty((0, 2), int), "relation is empty"),
        ([[0, 3]], r"relation\[0, 1\] = 3 is outside 0\.\.2"),
        ([[0, 1, 2]], "give 2 indices per row"),
        ([0, 1], r"f has shape \(2,\)"),
        ([[0.5, 1]], "give integer indices"),
    ],
)
def test_faults_of_relations_are_named(relation, message):
    with pytest.raises(InvalidInputError, match=message):
        distortion(relation, LINE, LINE)


def test_uniform_distance_and_the_implications_of_remark_2_39():
    """Lipschitz closeness bounds uniform closeness, which bounds Gromov-Hausdorff closeness."""
    rng = np.random.default_rng(16)
    X = cloud(rng, 7)
    Y = squareform(pdist(rng.random((7, 2)) * 1e-3)) + X
    ratio = np.log((Y + np.eye(7)) / (X + np.eye(7))).max()
    assert uniform_distance(X, Y) <= (math.exp(ratio) - 1) * X.max() * (1 + 1e-12)
    assert gromov_hausdorff(X, Y).upper <= uniform_distance(X, Y) / 2
    assert lipschitz_distance(X, Y).upper <= ratio + 1e-12
    with pytest.raises(InvalidInputError, match="X has 7 points and Y 3"):
        uniform_distance(X, LINE)


def maps_within(X, Y, epsilon):
    """Whether some map is an ε-isometry, by trying all."""
    n, m = len(X), len(Y)
    return any(
        naive.distortion(list(enumerate(f)), X, Y) <= epsilon
        and all(min(Y[y][z] for z in f) <= epsilon for y in range(m))
        for f in product(range(m), repeat=n)
    )


@pytest.mark.parametrize("seed", range(30, 42))
def test_epsilon_isometry_equals_all_maps(seed):
    rng = np.random.default_rng(seed)
    X, Y = cloud(rng, int(rng.integers(2, 5))), cloud(rng, int(rng.integers(2, 5)))
    epsilon = float(rng.uniform(0.1, 0.6))
    result = find_epsilon_isometry(X, Y, epsilon)
    assert result.found == maps_within(X.tolist(), Y.tolist(), epsilon)
    if result.found:
        assert distortion(result.map, X, Y) <= epsilon
        assert Y[result.map].min(axis=0).max() <= epsilon
        assert gromov_hausdorff(X, Y).upper <= 1.5 * epsilon  # Cor. 2.37 (ii)


def test_epsilon_isometry_from_a_small_distance():
    """Cor. 2.37 (i): d_GH < ε gives a 2ε-isometry, of distortion below 2ε."""
    rng = np.random.default_rng(45)
    X, Y = cloud(rng, 8), cloud(rng, 7)
    assert find_epsilon_isometry(X, Y, 2 * gromov_hausdorff(X, Y).upper).found


def nets_within(X, Y, epsilon, delta):
    """Whether some set of pairs makes the spaces (ε, δ)-approximations, by trying all sets."""
    pairs = [(x, y) for x in range(len(X)) for y in range(len(Y))]
    for bits in range(1, 1 << len(pairs)):
        chosen = [p for k, p in enumerate(pairs) if bits >> k & 1]
        if naive.distortion(chosen, X, Y) < delta:
            near_x = all(min(X[x][a] for a, _ in chosen) <= epsilon for x in range(len(X)))
            if near_x and all(min(Y[y][b] for _, b in chosen) <= epsilon for y in range(len(Y))):
                return True
    return False


@pytest.mark.parametrize("seed", range(50, 62))
def test_approximation_equals_all_sets_of_pairs(seed):
    rng = np.random.default_rng(seed)
    X, Y = cloud(rng, 3), cloud(rng, int(rng.integers(2, 4)))
    epsilon, delta = rng.uniform(0.0, 0.4), rng.uniform(0.05, 0.4)
    result = find_approximation(X, Y, epsilon, delta)
    assert result.found == nets_within(X.tolist(), Y.tolist(), epsilon, delta)
    if result.found:
        assert distortion(result.pairs, X, Y) < delta
        assert X[result.pairs[:, 0]].min(axis=0).max() <= epsilon
        assert Y[result.pairs[:, 1]].min(axis=0).max() <= epsilon
        assert gromov_hausdorff(X, Y).upper <= 2 * epsilon + delta / 2  # Prop. 2.42 (1)


def test_proposition_2_42_converse():
    rng = np.random.default_rng(65)
    X, Y = cloud(rng, 9), cloud(rng, 8)
    epsilon = 1.01 * gromov_hausdorff(X, Y).upper
    assert find_approximation(X, Y, 5 * epsilon, 5 * epsilon).found


def test_undecided_without_time():
    rng = np.random.default_rng(66)
    X, Y = cloud(rng, 12), cloud(rng, 12)
    half = gromov_hausdorff(X, Y).upper
    assert find_epsilon_isometry(X, Y, 1.2 * half, time_limit=0).found is None
    assert find_approximation(X, Y, 0.0, 2 * half, time_limit=0).found is None


def test_faults_of_scales_are_named():
    with pytest.raises(InvalidInputError, match="epsilon = -1"):
        find_epsilon_isometry(LINE, LINE, -1.0)
    with pytest.raises(InvalidInputError, match="delta = 0"):
        find_approximation(LINE, LINE, 0.1, 0.0)
    with pytest.raises(InvalidInputError, match="epsilon has type <U1; give real numbers"):
        find_epsilon_isometry(LINE, LINE, "1")
    with pytest.raises(InvalidInputError, match="delta has type object; give real numbers"):
        find_approximation(LINE, LINE, 0.1, None)


@pytest.mark.parametrize("metric", ["gromov_hausdorff", "lipschitz", "uniform"])
def test_distance_matrix_holds_the_single_distances(metric):
    rng = np.random.default_rng(71)
    spaces = [cloud(rng, 4) for _ in range(4)]
    seen = []
    result = distance_matrix(spaces, metric=metric, progress=lambda done, total: seen.append((done, total)))
    assert seen == [(k, 6) for k in range(1, 7)]
    single = {
        "gromov_hausdorff": lambda X, Y: gromov_hausdorff(X, Y).upper,
        "lipschitz": lambda X, Y: lipschitz_distance(X, Y).upper,
        "uniform": uniform_distance,
    }[metric]
    for i, j in product(range(4), repeat=2):
        value = single(spaces[max(i, j)], spaces[min(i, j)]) if i != j else 0
        assert result.upper[i, j] == result.lower[i, j] == value


def test_distance_matrix_in_threads_is_the_same():
    rng = np.random.default_rng(72)
    spaces = [cloud(rng, n) for n in (3, 5, 4)]
    with ThreadPoolExecutor(2) as pool:
        parallel = distance_matrix(spaces, executor=pool)
    assert (parallel.upper == distance_matrix(spaces).upper).all()


def test_hausdorff_distances_of_point_sets_and_meshes():
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    faces = [[0, 1, 2], [0, 2, 3]]
    lifted = square + np.array([0.0, 0.0, 3.0])
    points = distance_matrix([square, lifted, square[:3]], metric="hausdorff")
    assert (points.lower == points.upper).all()
    assert points.upper.tolist() == [[0, 3, 1], [3, 0, math.sqrt(10)], [1, math.sqrt(10), 0]]
    mixed = distance_matrix([(square, faces), (lifted, faces)], metric="hausdorff", tolerance=1e-6)
    assert mixed.lower[0, 1] <= 3 <= mixed.upper[0, 1] <= mixed.lower[0, 1] + 1e-6 * math.sqrt(2)
    with pytest.raises(InvalidInputError, match=r"spaces\[1\]\[0, 1\] = nan is not finite"):
        distance_matrix([square, [[0.0, math.nan, 0.0]]], metric="hausdorff")
    flat = square[:, :2]
    with pytest.raises(InvalidInputError, match="A has points of dimension 2, B of dimension 3"):
        distance_matrix([square, flat], metric="hausdorff")


def test_gromov_hausdorff_distances_of_meshes():
    V, F = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), [[0, 1, 2], [0, 2, 3]]
    result = distance_matrix([(V, F), (3 * V, F), [[0.0]]])
    assert result.upper[0, 2] == result.lower[0, 2] == 1.0  # two corners have two edges between them
    assert result.upper[0, 1] == 2.0  # the diameters differ by 4


def test_faults_of_collections_are_named():
    with pytest.raises(InvalidInputError, match="spaces is empty"):
        distance_matrix([])
    with pytest.raises(InvalidInputError, match="metric = 'other' is unknown"):
        distance_matrix([LINE], metric="other")
    for option, message in (
        ({"time_limit": -1.0}, "time_limit = -1.0 is not a time"),
        ({"tolerance": 0.0}, "tolerance = 0.0 is not positive"),
        ({"executor": 3}, "executor of type int has no map"),
        ({"progress": 3}, "progress is of type int; give a function"),
    ):
        with pytest.raises(InvalidInputError, match=message):
            distance_matrix([LINE], **option)
    with pytest.raises(NotAMetricError, match=r"spaces\[1\]: distances\[0, 1\] = 1 differs") as caught:
        distance_matrix([LINE, [[0, 1], [2, 0]]])
    assert caught.value.witness == (0, 1)
    with pytest.raises(InvalidInputError, match=r"spaces\[0\]: distances is empty"):
        distance_matrix([[], LINE], metric="lipschitz")
