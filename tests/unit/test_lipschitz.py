"""Lipschitz distance and dilatation: brute force, closed forms, certificates, bad input."""

import math

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.spatial.distance import pdist, squareform

from clocks import SLOW
from golden_files import golden
from naive import correspondences as naive
from rinow import MetricSpace, dilatation, gromov_hausdorff, lipschitz_distance, uniform_distance
from rinow.comparison import large_bijections, lipschitz
from rinow.comparison.bounds import matching_bound
from rinow.comparison.clock import Clock
from rinow.comparison.interval import Interval
from rinow.comparison.large_bijections import offer_bijections
from rinow.errors import InvalidInputError, NotAMetricError

LINE = [[0, 1, 2], [1, 0, 1], [2, 1, 0]]


def cloud(rng, n):
    """Distances of random points of the plane."""
    return squareform(pdist(rng.random((n, 2))))


def check_certificate(result, X, Y):
    """The map is a bijection, and the larger dilatation of it and its inverse is the upper bound."""
    assert sorted(result.bijection) == list(range(len(X)))
    both = max(dilatation(result.bijection, X, Y), dilatation(np.argsort(result.bijection), Y, X))
    assert result.upper == math.log(max(both, 1.0))
    assert 0 <= result.lower <= result.upper


@pytest.mark.parametrize("seed", range(70, 90))
def test_equals_all_permutations(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 7))
    X, Y = (np.zeros((1, 1)),) * 2 if n == 1 else (cloud(rng, n), cloud(rng, n))
    result = lipschitz_distance(X, Y)
    check_certificate(result, X, Y)
    assert result.exact
    assert result.upper == naive.lipschitz_distance(X.tolist(), Y.tolist())


@pytest.mark.parametrize(
    "case", [c for c in golden("gromov_hausdorff") if c.get("lipschitz")], ids=lambda case: str(case["name"])
)
def test_values_of_closed_forms_are_found_and_proved(case):
    result = lipschitz_distance(case["DX"], case["DY"])
    check_certificate(result, case["DX"], case["DY"])
    assert result.exact
    assert abs(result.upper - case["lipschitz"]) <= 1e-12  # the logarithm is rounded


def test_a_space_and_its_multiple():
    """A space and its multiple by c are at distance |log c|."""
    X = cloud(np.random.default_rng(5), 9)
    assert lipschitz_distance(X, 4 * X).upper == math.log(4)
    assert lipschitz_distance(X, X / 4).lower == math.log(4)


def test_shuffled_copy_is_found():
    rng = np.random.default_rng(8)
    X, order = cloud(rng, 25), rng.permutation(25)
    result = lipschitz_distance(X, X[np.ix_(order, order)])
    assert result.exact
    assert result.upper == 0.0
    assert (order[result.bijection] == np.arange(25)).all()


def test_unequal_sizes_are_infinitely_far():
    result = lipschitz_distance(LINE, [[0, 1], [1, 0]])
    assert result.lower == result.upper == math.inf
    assert result.exact
    assert len(result.bijection) == 0
    assert result.lower_bound_by == "size"


def test_coincident_points_of_one_space_only():
    result = lipschitz_distance([[0, 0, 1], [0, 0, 1], [1, 1, 0]], LINE)
    assert result.lower == result.upper == math.inf
    assert result.exact
    assert not lipschitz_distance([[0, 0, 1], [0, 0, 1], [1, 1, 0]], LINE, time_limit=0).exact
    both = lipschitz_distance([[0, 0, 1], [0, 0, 1], [1, 1, 0]], [[0, 2, 2], [2, 0, 0], [2, 0, 0]])
    assert both.exact
    assert both.upper == math.log(2)


@pytest.mark.parametrize("seed", range(90, 110))
def test_equals_all_permutations_where_points_coincide(seed):
    """Points of a line with repetitions; of every second one a shuffled multiple, so that the distance is finite."""
    rng = np.random.default_rng(seed)
    X, Y = (squareform(pdist(rng.integers(0, 4, (5, 1)).astype(float))) for _ in range(2))
    if seed % 2:
        order = rng.permutation(5)
        Y = 1.5 * X[np.ix_(order, order)]
    result = lipschitz_distance(X, Y)
    check_certificate(result, X, Y)
    assert result.exact
    assert result.lower == result.upper == naive.lipschitz_distance(X.tolist(), Y.tolist())


def test_ratios_beyond_the_range_of_numbers():
    with pytest.raises(InvalidInputError, match=r"reach from 1e-200 to 2e\+200, a ratio without a number"):
        lipschitz_distance(np.array(LINE) * 1e-200, np.array(LINE) * 1e200)


def test_no_time_gives_bounds_at_once():
    rng = np.random.default_rng(6)
    X, Y = cloud(rng, 30), cloud(rng, 30)
    result = lipschitz_distance(X, Y, time_limit=0)
    check_certificate(result, X, Y)
    assert not result.exact


def test_matching_bound_needs_different_images():
    """Each point has a good image, but two have only the same one."""
    assert matching_bound(np.array([[1.0, 5.0, 6.0], [1.0, 4.0, 6.0], [9.0, 9.0, 2.0]])) == 4.0


def test_dilatation_equals_its_naive_twin_and_composes():
    rng = np.random.default_rng(17)
    X, Y, Z = cloud(rng, 6), cloud(rng, 5), cloud(rng, 4)
    f, g = rng.integers(5, size=6), rng.integers(4, size=5)
    assert dilatation(f, X, Y) == naive.dilatation(X.tolist(), Y.tolist(), f.tolist())
    assert dilatation(g[f], X, Z) <= dilatation(g, Y, Z) * dilatation(f, X, Y) * (1 + 1e-12)  # Prop. 2.8; rounding


def test_dilatation_of_constant_and_tearing_maps():
    assert dilatation([1, 1, 1], LINE, LINE) == 0.0
    assert dilatation([0, 1], [[0, 0], [0, 0]], [[0, 1], [1, 0]]) == math.inf


def test_faults_of_arguments_are_named():
    with pytest.raises(InvalidInputError, match=r"f has shape \(2,\)"):
        dilatation([0, 1], LINE, LINE)
    with pytest.raises(InvalidInputError, match=r"f\[2\] = 3 is outside 0\.\.2"):
        dilatation([0, 1, 3], LINE, LINE)
    with pytest.raises(NotAMetricError, match="is negative"):
        lipschitz_distance([[0, -1], [-1, 0]], [[0, 1], [1, 0]])
    with pytest.raises(InvalidInputError, match="time_limit = -2"):
        lipschitz_distance(LINE, LINE, time_limit=-2)


@pytest.mark.parametrize("compare", [lipschitz_distance, gromov_hausdorff, uniform_distance])
def test_errors_say_which_space_they_are_about(compare):
    apart = MetricSpace.from_graph(csr_array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]), infinite=True)
    for name, pair in (("X", (apart, LINE)), ("Y", (LINE, apart))):
        with pytest.raises(NotAMetricError, match=rf"^{name}: distances\[0, 2\] is infinite") as caught:
            compare(*pair)
        assert caught.value.witness == (0, 2)
    with pytest.raises(NotAMetricError, match=r"^Y: distances\[0, 1\] = -1 is negative"):
        compare(LINE, [[0, -1], [-1, 0]])
    with pytest.raises(InvalidInputError, match=r"^X: space is a csr_array; give a MetricSpace"):
        compare(csr_array(LINE), LINE)


def test_no_search_knows_that_eccentricities_differ():
    X = cloud(np.random.default_rng(15), 30)
    result = lipschitz_distance(X, 3 * X[::-1, ::-1], time_limit=0)
    assert (result.lower, result.lower_bound_by) == (math.log(3), "eccentricities")


@SLOW
def test_bijections_of_many_points_follow_from_those_of_few(monkeypatch):
    """A shuffled copy is found from four anchors, a copy in another unit too; nothing is begun without time."""
    monkeypatch.setattr(large_bijections, "ANCHORS", 4)
    rng = np.random.default_rng(17)
    X = squareform(pdist(rng.random((30, 2))))
    order = rng.permutation(30)
    for factor in (1.0, 2.0):
        Y = factor * X[np.ix_(order, order)]
        for seconds, value in ((math.inf, factor), (0.0, math.inf)):
            interval = Interval(np.stack([np.arange(30)] * 2, axis=1), math.inf, lower=1.0)
            offer_bijections(X, Y, interval, Clock(seconds))
            assert interval.upper == value
    whole = lipschitz_distance(X, Y, time_limit=math.inf)
    monkeypatch.setattr(lipschitz, "SEARCHED", 20)
    assert lipschitz_distance(X, Y, time_limit=math.inf).upper == whole.upper == math.log(2.0)
