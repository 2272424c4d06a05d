"""Robinson's approximation: golden values, closed special forms, intervals that hold the curvature."""

import math

import numba
import numpy as np
import pytest

import rinow
from naive import robinson as naive
from quadruple_shapes import GOLDEN
from rinow.kernels import spaceform

EPS = 2.0**-53
COLUMN = np.array([[-1, 0, 1, 2], [0, -1, 3, 4], [1, 3, -1, 5], [2, 4, 5, -1]])


def in_order(d, order):
    """Distances of the points taken in another order."""
    i, j = np.triu_indices(4, 1)
    return d[COLUMN[order[i], order[j]]]


def semidependent(largest, n, seed, size=1.0):
    """Quadruples with |κ| diameter² below about `largest`, thin and wide, and their κ."""
    rng = np.random.default_rng(seed)
    a, c, b = rng.uniform(0.05, 0.5, (3, n))
    alpha = rng.uniform(0.02, math.pi - 0.02, n)
    thin = rng.uniform(size=n) < 0.3  # the extremal shapes: an isosceles triangle with a short third side
    alpha[thin], b[thin] = 10.0 ** rng.uniform(-4, -1, thin.sum()), a[thin]
    k = largest * rng.uniform(-1, 1, n)
    e = [spaceform.side(*row) for row in zip(a, b, alpha, k, strict=True)]
    f = [spaceform.side(*row) for row in zip(c, b, math.pi - alpha, k, strict=True)]
    return size * np.stack([a, a + c, e, c, b, f], axis=1), k / size**2


def test_values_agree_with_60_digits():
    n = 0
    for row in GOLDEN:
        d = np.array([float(x) for x in row["distances"].values()])
        for case in row["robinson"]:
            q = in_order(d, np.array([case[name] - 1 for name in ("p1", "p2", "p3", "p4")]))
            result = rinow.robinson_curvature(q, verify=True)
            if not row["embedding_curvatures"]:
                assert np.isnan([result.value, result.lower, result.upper]).all()
                continue
            n += 1
            exact = float(row["embedding_curvatures"][0])
            assert result.lower <= exact <= result.upper
            value = rinow.robinson_curvature(q).value
            # Rounded distances move κ by up to 1e5 units; K moves alike, for it is κ to first order.
            assert value == pytest.approx(float(case["K"]), rel=1e-12, abs=1e5 * EPS / d.max() ** 2)
    assert n >= 40


def test_agrees_with_the_angles():
    Q, _ = semidependent(2.0, 200, seed=31)
    wide = np.abs(Q[:, 2] - np.abs(Q[:, 0] - Q[:, 4])) > 0.01  # the naive angle loses its digits in thin triangles
    expected = [naive.curvature(d) for d in Q[wide]]
    assert rinow.robinson_curvature(Q[wide]).value == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_special_forms_of_the_formula():
    a, b, e, f = 1.0, 0.8, 1.2, 1.1
    isosceles = rinow.robinson_curvature([a, 2 * a, e, a, b, f]).value
    over = 12 * (2 * a**2 + 2 * b**2 - e**2 - f**2)
    under = 8 * a**2 * b**2 - (a**2 + b**2 - e**2) ** 2 - (a**2 + b**2 - f**2) ** 2
    assert isosceles == pytest.approx(over / under, rel=1e-14)
    right = rinow.robinson_curvature([a, 2 * a, e, a, a, 2**0.5 * a]).value
    expected = 12 * (2 * a**2 - e**2) / (4 * a**4 + 4 * a**2 * e**2 - e**4)
    assert right == pytest.approx(expected, rel=1e-14)
    assert rinow.robinson_curvature([2, 4, 2.5, 2, 2, 8**0.5]).value == pytest.approx(0.16808404, rel=1e-2)


@pytest.mark.parametrize("largest", [1e-8, 1e-3, 0.1, 0.5, 4.0])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e4])
def test_intervals_hold_the_curvature(largest, size):
    Q, k = semidependent(largest, 1500, seed=32, size=size)
    width = np.full(len(Q), np.inf)
    for order in (1, 2, 3):
        result = rinow.robinson_curvature(Q, order=order)
        assert (result.lower <= k).all()
        assert (k <= result.upper).all()
        assert (result.upper - result.lower <= width).all()
        width = result.upper - result.lower
        sharp = rinow.robinson_curvature(Q, order=order, verify=True)
        assert (np.maximum(result.lower, sharp.lower) == sharp.lower).all()
        assert (np.minimum(result.upper, sharp.upper) == sharp.upper).all()
        assert (sharp.lower <= k).all()
        assert (k <= sharp.upper).all()
        assert (sharp.lower <= sharp.value).all()
        assert (sharp.value <= sharp.upper).all()


def test_verified_intervals_are_as_sharp_as_the_distances():
    Q, k = semidependent(3.0, 500, seed=33)
    result = rinow.robinson_curvature(Q, verify=True)
    condition = rinow.embedding_curvatures(Q).condition[:, 0]
    width = (result.upper - result.lower) * Q.max(axis=1) ** 2
    # Eight excesses, each wrong by 4 roundings of a perimeter, in the worst case all in one direction.
    assert (width <= 2000 * EPS * condition).all()
    expected = [naive.exact_curvature(d, -4.0, 4.0) for d in Q[:50]]
    assert result.value[:50] == pytest.approx(expected, abs=1e-3)
    assert np.median(np.abs(result.value[:50] - expected)) < 1e-9
    assert np.abs(k - result.value).max() < 1e-3


def test_the_sign_is_that_of_the_curvature_and_the_value_never_less():
    Q, k = semidependent(4.0, 2000, seed=34)
    value = rinow.robinson_curvature(Q).value
    clear = np.abs(k) > 1e-3
    assert (np.sign(value) == np.sign(k))[clear].all()
    assert (value >= k)[clear].all()


def test_beyond_the_proved_range_only_the_sign_is_known():
    Q, k = semidependent(40.0, 300, seed=35)
    far = np.abs(rinow.robinson_curvature(Q).value) * Q.max(axis=1) ** 2 > 0.3
    result = rinow.robinson_curvature(Q[far])
    positive = k[far] > 0
    assert (result.lower[positive] == 0).all()
    assert (result.upper[positive] == np.inf).all()
    assert (result.lower[~positive] == -np.inf).all()
    assert (result.upper[~positive] == 0).all()
    verified = rinow.robinson_curvature(Q[far], verify=True)
    assert np.isfinite(verified.lower).all()
    assert np.isfinite(verified.upper).all()


def test_rows_in_another_order_or_without_curvature_are_nan():
    rows = {
        "right order": [1, 2, 1.3, 1, 1, 2**0.5],
        "other order": [2, 1, 2**0.5, 1, 1.3, 1],
        "no linear triple": [1, 1.9, 1.3, 1, 1, 2**0.5],
        "branching": [1, 2, 2, 1, 1, 1.5],
        "tripod": [1, 2, 2, 1, 1, 2],
        "linear": [1, 2, 3, 1, 2, 1],
        "fourth point at the second": [1, 2, 1, 1, 0, 1],
        "first point at the second": [0, 1, 1, 1, 1, 1],
        "not a metric": [1, 2, 3, 1, 1, 1.5],
        "negative": [-1, 0, 1, 1, 1, 1],
        "nan": [1, 2, np.nan, 1, 1, 1.5],
        "inf": [1, 2, np.inf, 1, np.inf, 1.5],
    }
    for verify in (False, True):
        result = rinow.robinson_curvature(list(rows.values()), verify=verify)
        for values in (result.value, result.lower, result.upper):
            assert np.isnan(values).tolist() == [False] + [True] * (len(rows) - 1)


def test_great_circles_and_lunes():
    # Four points of a circle: K is inf; the lune and the circle have κ at the end of its range.
    circle = rinow.robinson_curvature([1, 3, 2, 2, 3, 1], verify=True)
    assert circle.lower <= (math.pi / 3) ** 2 <= circle.upper < np.inf
    lune = rinow.robinson_curvature([1, 2, 0.8, 1, 0.9, 1.2], verify=True)
    assert lune.lower <= (math.pi / 2) ** 2 <= lune.upper
    assert lune.upper - lune.lower < 1e-12


def test_shapes_and_arguments():
    assert rinow.robinson_curvature(np.ones((2, 3, 6))).upper.shape == (2, 3)
    assert rinow.robinson_curvature(np.ones((0, 6)), verify=True).value.shape == (0,)
    with pytest.raises(rinow.InvalidInputError, match="quadruples"):
        rinow.robinson_curvature([1, 2, 3])
    for order in (0, 4, "first", 1.5):
        with pytest.raises(rinow.InvalidInputError, match="order"):
            rinow.robinson_curvature(np.ones(6), order=order)


@pytest.mark.skipif(numba.config.DISABLE_JIT or numba.config.NUMBA_NUM_THREADS < 2, reason="needs two threads")
def test_one_and_two_threads_give_the_same_bits():
    Q, _ = semidependent(1.0, 500, seed=36)
    results = []
    for n_threads in (1, 2):
        numba.set_num_threads(n_threads)
        results.append(rinow.robinson_curvature(Q, order=3, verify=True))
    numba.set_num_threads(numba.config.NUMBA_NUM_THREADS)
    for name in ("value", "lower", "upper"):
        assert np.array_equal(getattr(results[0], name), getattr(results[1], name))
