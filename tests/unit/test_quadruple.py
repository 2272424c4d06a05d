"""Embedding curvatures: golden values, known examples, round trips, and the forms of the result."""

import itertools
import math

import numba
import numpy as np
import pytest

import rinow
from naive import quadruples as naive
from quadruple_shapes import DISTANCES, EPS, GOLDEN, I, J, sampled, semidependent

KIND = {"sd": "semidependent"}
COUNT = {"linear": -1, "not-metric": -2}


def test_golden_counts_and_kinds():
    result = rinow.embedding_curvatures(DISTANCES)
    expected = [COUNT.get(row["status"], len(row["embedding_curvatures"])) for row in GOLDEN]
    assert result.count.tolist() == expected
    for kinds, row in zip(result.kind.tolist(), GOLDEN, strict=True):
        assert [k for k in kinds if k] == [KIND.get(t, t) for t in row["types"]]
    assert (np.isnan(result.values) == (result.kind == "")).all()
    assert (np.isnan(result.condition) == (result.kind == "")).all()


def test_values_agree_with_60_digits():
    values = rinow.embedding_curvatures(DISTANCES).values
    errors = []
    for d, v, row in zip(DISTANCES, values, GOLDEN, strict=True):
        for actual, text in zip(v, row["embedding_curvatures"], strict=False):
            unit = EPS * max(abs(float(text)), 1 / d.max() ** 2)
            errors.append(abs(actual - float(text)) / unit)
    # Rounding the decimals to float64 alone gives a median of 15 units and a maximum of 3.9e4, near linear triples.
    assert len(errors) == 185
    assert np.median(errors) <= 50
    assert max(errors) <= 4e4


def test_golden_semidependent_and_linear_flags():
    assert rinow.is_semidependent(DISTANCES).tolist() == [row["is_sd"] for row in GOLDEN]
    assert rinow.is_linear(DISTANCES).tolist() == [row["status"] == "linear" for row in GOLDEN]
    for order, row in zip(rinow.semidependent_order(DISTANCES).tolist(), GOLDEN, strict=True):
        triples = [[i - 1, m - 1, k - 1] for i, m, k in row["sd_triples"]]
        if row["is_sd"]:
            assert order[:3] in triples or order[2::-1] in triples
            assert sorted(order) == [0, 1, 2, 3]
        else:
            assert order == [-1] * 4


@pytest.mark.parametrize(
    ("distances", "values", "kinds"),
    [
        ([1, 2**0.5, 1, 1, 2**0.5, 1], [0, 2.89244794846], ["nonplanar", "planar"]),
        ([math.pi / 2] * 6, [1.47949977126], ["planar"]),
        (
            [2, 1.27455578231, 1.00434286546, 1.27455578231, 1.00434286546, 0.883546741918],
            [0, 1],
            ["nonplanar", "planar"],
        ),
        ([1.5, 1, 1, 1, 1, 1.5], [math.pi**2 / 9, 0.282315492194 * math.pi**2], ["nonplanar", "planar"]),
        ([1, 1, 1, 2, 2, 2], [], []),
        ([1, 3, 2, 2, 3, 1], [(math.pi / 3) ** 2], ["boundary"]),
        ([1, 2, 0.8, 1, 0.9, 1.2], [(math.pi / 2) ** 2], ["boundary"]),
        ([2, 5, 5, 5, 5, 2], [0.242132641502], ["planar"]),
    ],
)
def test_values_and_kinds_of_examples(distances, values, kinds):
    result = rinow.embedding_curvatures(distances)
    assert result.count == len(values)
    assert result.values[: len(values)] == pytest.approx(values, rel=1e-9, abs=1e-9)
    assert [k for k in result.kind if k] == kinds


def test_agrees_with_the_zeros_of_the_gram_determinant():
    Q = np.random.default_rng(21).uniform(1, 2, (20, 6))
    result = rinow.embedding_curvatures(Q)
    assert (result.count == 2).all()
    for d, values, condition in zip(Q, result.values, result.condition, strict=True):
        expected = naive.embedding_curvatures(d, lowest=-30.0)
        assert len(expected) == np.count_nonzero(values > -30)
        # Terms of the determinant cancel: at k = -30 they are 1e6 times as large as it is nearby.
        expected = pytest.approx(expected, abs=1e6 * EPS * condition.max())
        assert values[values > -30] == expected


@pytest.mark.parametrize("k", [-100.0, -1.0, -1e-6, 0.0, 1e-6, 1.0, 100.0])
@pytest.mark.parametrize("radius", [5e-4, 0.15])
def test_the_curvature_of_sampled_points_is_found(k, radius):
    Q = sampled(k, radius, 3000, seed=22)
    result = rinow.embedding_curvatures(Q)
    diameter = Q.max(axis=1)
    error = np.abs(result.values - k)
    nearest = np.nanargmin(error, axis=1)[:, None]
    # Six distances, each wrong by a few eps: the sum of their effects is below 6 · 4 · condition · eps / diameter².
    allowed = 24 * EPS * (np.take_along_axis(result.condition, nearest, 1)[:, 0] / diameter**2 + abs(k))
    assert (np.nanmin(error, axis=1) <= allowed).all()
    assert (result.count == 2).all()


@pytest.mark.parametrize("k", [-9.0, -1.0, 0.0, 1.0, 4.0])
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e5])
def test_quadruples_with_a_linear_triple_have_one_value(k, size):
    Q, expected = semidependent(k, 300, seed=23, size=size)
    result = rinow.embedding_curvatures(Q)
    assert (result.count == 1).all()
    assert (result.kind[:, 0] == "semidependent").all()
    allowed = 24 * EPS * (result.condition[:, 0] / Q.max(axis=1) ** 2 + abs(expected))
    assert (np.abs(result.values[:, 0] - expected) <= allowed).all()
    assert rinow.semidependent_order(Q).tolist() == [[0, 1, 2, 3]] * len(Q)


def test_two_values_approach_each_other_near_a_linear_triple():
    # p1 = (-1, 0), p3 = (1, 0), p4 = (0, 1), p2 = (0, h): in the plane, and at -0.12445, -0.012043 for h = 0.01, 0.001.
    for h, other in ((1e-2, -0.12445), (1e-3, -0.012043)):
        side = math.hypot(1, h)
        result = rinow.embedding_curvatures([side, 2, 2**0.5, side, 1 - h, 2**0.5])
        assert result.values == pytest.approx([other, 0], rel=1e-3, abs=1e-12)


def test_labels_do_not_matter():
    Q = np.concatenate([DISTANCES, sampled(-1.0, 0.5, 50, seed=24)])
    expected = rinow.embedding_curvatures(Q)
    D = np.zeros((len(Q), 4, 4))
    D[:, I, J] = D[:, J, I] = Q
    for order in itertools.permutations(range(4)):
        actual = rinow.embedding_curvatures(D[:, order][:, :, order][:, I, J])
        assert (actual.count == expected.count).all()
        assert (actual.kind == expected.kind).all()
        scale = Q.max(axis=1)[:, None] ** 2
        allowed = 20 * EPS * (expected.condition / scale + np.abs(expected.values))
        assert (np.abs(actual.values - expected.values) <= allowed)[expected.kind != ""].all()


def test_scaling_by_powers_of_two_is_exact():
    expected = rinow.embedding_curvatures(DISTANCES)
    for exponent in (-200, -3, 100):
        actual = rinow.embedding_curvatures(np.ldexp(DISTANCES, exponent))
        assert np.array_equal(actual.values, np.ldexp(expected.values, -2 * exponent), equal_nan=True)
        assert np.array_equal(actual.condition, expected.condition, equal_nan=True)


def test_a_bad_row_is_marked_and_leaves_the_others():
    good = [1.0, 1.1, 1.2, 1.3, 1.4, 1.7]
    rows = [good, [np.nan, *good[1:]], [np.inf, *good[1:]], [-1.0, *good[1:]], [5.0, *good[1:]], good]
    result = rinow.embedding_curvatures(rows)
    assert result.count.tolist() == [2, -2, -2, -2, -2, 2]
    assert np.isnan(result.values[1:5]).all()
    assert (result.kind[1:5] == "").all()
    assert np.array_equal(result.values[0], result.values[5])
    assert rinow.is_linear(rows).tolist() == rinow.is_semidependent(rows).tolist() == [False] * 6
    # The triangle inequality may fail by 1e-9 of the diameter.
    assert rinow.embedding_curvatures([1 + 5e-10, 0.5, 0.8, 0.5, 0.8, 0.9]).count == 1
    assert rinow.embedding_curvatures([1 + 5e-9, 0.5, 0.8, 0.5, 0.8, 0.9]).count == -2


def test_shapes_of_the_result():
    result = rinow.embedding_curvatures(np.ones((2, 3, 6)))
    shapes = (result.values.shape, result.count.shape, result.kind.shape, result.condition.shape)
    assert shapes == ((2, 3, 2), (2, 3), (2, 3, 2), (2, 3, 2))
    assert rinow.embedding_curvatures(np.ones((0, 6))).values.shape == (0, 2)
    assert rinow.semidependent_order(np.ones((2, 3, 6))).shape == (2, 3, 4)
    functions = (rinow.embedding_curvatures, rinow.is_linear, rinow.is_semidependent, rinow.semidependent_order)
    for function in functions:
        for bad in ([1, 2, 3], np.ones((6, 2)), 1.0, ["a"] * 6):
            with pytest.raises(rinow.InvalidInputError, match="quadruples"):
                function(bad)
    with pytest.raises(rinow.InvalidInputError, match="fit"):
        rinow.is_planar(np.ones((2, 6)), [1.0, 2.0, 3.0])


@pytest.mark.skipif(numba.config.DISABLE_JIT or numba.config.NUMBA_NUM_THREADS < 2, reason="needs two threads")
def test_one_and_two_threads_give_the_same_bits():
    Q = sampled(1.0, 0.5, 1000, seed=29)
    results = []
    for n_threads in (1, 2):
        numba.set_num_threads(n_threads)
        results.append(rinow.embedding_curvatures(Q))
    numba.set_num_threads(numba.config.NUMBA_NUM_THREADS)
    assert np.array_equal(results[0].values, results[1].values)
    assert np.array_equal(results[0].condition, results[1].condition)
