"""Linear assignment against scipy's, and what is left of it when the time is over."""

import math

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import pdist, squareform

from clocks import Looks
from rinow import lipschitz_distance
from rinow.comparison import engine as engine_module
from rinow.comparison import steps
from rinow.comparison.affine_bijections import offer_affine_bijections
from rinow.comparison.assignment import assigned
from rinow.comparison.clock import Clock
from rinow.comparison.engine import BIJECTION, worst_of
from rinow.comparison.interval import Interval

RNG = np.random.default_rng(91)
COSTS = {
    "one": np.array([[2.5]]),
    "random": RNG.random((40, 40)),
    "of either sign": RNG.normal(size=(25, 25)),
    "many ties": RNG.integers(0, 3, (30, 30)).astype(float),
    "all equal": np.ones((12, 12)),
    "one wanted by all": np.add.outer(np.zeros(20), np.arange(20.0)),
    "squares of distances": np.subtract.outer(RNG.random(50), RNG.random(50)) ** 2,
}


@pytest.mark.parametrize("name", COSTS)
def test_the_total_is_the_least(name):
    costs = COSTS[name]
    columns, n = assigned(costs, Clock(math.inf)), len(costs)
    assert sorted(columns) == list(range(n))
    least = costs[linear_sum_assignment(costs)].sum()
    assert math.isclose(costs[np.arange(n), columns].sum(), least, rel_tol=1e-12, abs_tol=1e-12)


def test_when_the_time_is_over_the_map_is_a_bijection_all_the_same(monkeypatch):
    monkeypatch.setattr(engine_module, "BLOCK", 2500)  # one row of augmentation between two looks
    costs = COSTS["squares of distances"]
    totals = []
    for looks in (0, 1, 5, 1000):
        columns = assigned(costs, Looks(looks))
        assert sorted(columns) == list(range(50))
        totals.append(costs[np.arange(50), columns].sum())
    assert totals[-1] <= min(totals)
    assert totals[-1] < totals[0]


@pytest.mark.parametrize("factors", [(1.0, 0.75, 0.5), (1.2, 1.0, 0.8), (0.9, 0.9, 0.9)])
def test_affine_images_of_shuffled_points_are_found(factors, monkeypatch):
    rng = np.random.default_rng(92)
    points = rng.normal(size=(300, 3)) * [3.0, 2.0, 1.0]
    shuffled = rng.permutation(300)
    X, Y = squareform(pdist(points)), squareform(pdist((points * factors)[shuffled]))
    partners = np.stack([np.arange(300), np.argsort(shuffled)], axis=1)
    interval = Interval(np.stack([np.arange(300)] * 2, axis=1), math.inf, lower=1.0)
    offer_affine_bijections(X, Y, interval, Clock(math.inf))
    assert interval.upper <= worst_of(BIJECTION, X, Y, partners)  # another one may be better still
    over = Interval(partners[::-1], math.inf, lower=1.0)
    offer_affine_bijections(X, Y, over, Clock(0.0))
    assert over.upper == math.inf
    monkeypatch.setattr(steps, "close", lambda *_: None)  # no search
    assert lipschitz_distance(X, Y, time_limit=math.inf).upper == math.log(interval.upper)
