"""Steps look at the clock after a bounded amount of work: counted, not timed."""

import math

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

from clocks import Looks
from rinow.comparison import engine as engine_module
from rinow.comparison import large_work
from rinow.comparison.clock import Clock
from rinow.comparison.engine import Engine, Search
from rinow.comparison.large_work import Work
from rinow.comparison.symmetry import isometries
from rinow.kernels import compatibility, dives

pytestmark = pytest.mark.usefixtures("compiled_searches")


def spaces(n, m):
    rng = np.random.default_rng(44)
    return squareform(pdist(rng.random((n, 2)))), squareform(pdist(rng.random((m, 2))))


def recorded(monkeypatch, module, name, size):
    """Replace a kernel by one that records how much each call has to do."""
    kernel, work = getattr(module, name), []

    def call(*arguments):
        work.append(size(arguments))
        return kernel(*arguments)

    monkeypatch.setattr(module, name, call)
    return work


def test_rows_and_runs_come_in_blocks(monkeypatch):
    X, Y = spaces(12, 10)
    monkeypatch.setattr(engine_module, "BLOCK", 600)
    rows = recorded(monkeypatch, compatibility, "row_discrepancies", lambda a: len(a[2]))
    runs = recorded(monkeypatch, compatibility, "write_runs", lambda a: len(a[4]))
    whole = Engine(X, Y)
    assert rows == [2] * 6  # rows of 10 · 22 distances
    part = Engine(X, Y, clock=Looks(3))
    assert rows[6:] == [2, 2, 2]
    assert (part.row_levels[:6] == whole.row_levels[:6]).all()
    assert (part.row_levels[6:] == 0).all()
    assert part.row_bound <= whole.row_bound
    level = 0.3
    left = whole.consistent(level, Clock(math.inf))
    assert max(runs) == 27  # pairs of 22 runs
    runs.clear()
    stopped = whole.consistent(level, Looks(3))
    assert len(runs) == 2  # one look before the tables are made
    assert (stopped == (whole.row_levels <= level)).all()
    assert left is None or (left <= stopped).all()


def test_search_without_all_runs_proves_nothing(monkeypatch):
    X, Y = spaces(8, 8)
    whole = Engine(X, Y)
    monkeypatch.setattr(engine_module, "BLOCK", 100)
    search = Search(whole, np.ones((8, 8), np.bool_), 1e-6, Looks(2))
    assert search.run(Clock(math.inf)) == (False, None)
    assert search.possible().all()


def test_completion_of_maps_comes_in_blocks(monkeypatch):
    X, Y = spaces(30, 25)
    partners = np.full(55, dives.LEFT_OVER)
    partners[[3, 5, 8]] = [1, 0, 7]
    partners[[31, 30, 37]] = [3, 5, 8]
    whole = Work(X, Y).completed(partners, Clock(math.inf))
    monkeypatch.setattr(large_work, "EXAMINED", 30 * 6 * 4)
    calls = recorded(monkeypatch, dives, "complete", lambda a: len(a[0]))
    again = Work(X, Y).completed(partners, Clock(math.inf))
    assert max(calls) <= 8
    assert (again == whole).all()
    calls.clear()
    assert Work(X, Y).completed(partners, Looks(2)) is None
    assert len(calls) == 2


def test_isometries_stop_with_the_clock():
    steps = np.abs(np.subtract.outer(np.arange(9), np.arange(9)))
    D = np.minimum(steps, 9 - steps).astype(float)
    some = isometries(D, Looks(40))
    assert 1 <= len(some.images) < 18
    for f in some.images:
        assert (D[np.ix_(f, f)] == D).all()
