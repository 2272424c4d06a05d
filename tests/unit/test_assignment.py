"""Linear assignment against scipy's, and what is left of it when the time is over."""

import math

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from clocks import Looks
from rinow.comparison import engine as engine_module
from rinow.comparison.assignment import assigned
from rinow.comparison.clock import Clock

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
