"""Searches for a correspondence below one level of distortion: brute force, and agreement with clause learning."""

import math

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

from clocks import SLOW, Looks, unlimited
from metric_shapes import hops, polygon, random_space
from naive import correspondences as naive
from rinow import distortion
from rinow.comparison import level_search, steps
from rinow.comparison.clock import Clock
from rinow.comparison.engine import Engine
from rinow.comparison.gromov_hausdorff import first_interval
from rinow.comparison.level_search import LevelSearch
from rinow.comparison.levels import Levels
from rinow.comparison.satisfiability import Satisfiability
from rinow.comparison.symmetry import isometries
from rinow.kernels import level_search as kernels


def test_levels_are_the_differences_of_distances():
    rng = np.random.default_rng(61)
    X, Y = random_space(rng, 6), random_space(rng, 5)
    levels, gaps = Levels(X, Y), np.unique(np.abs(X.reshape(-1, 1) - Y.reshape(1, -1)))
    for level in (0.0, *gaps, 0.3, 1.7, 99.0):
        assert levels.above(level) == min(gaps[gaps > level], default=math.inf)
        assert levels.up_to(level) == max(gaps[gaps <= level])
    assert levels.few
    assert not Levels(*(squareform(pdist(rng.random((40, 2)))) for _ in range(2))).few


@pytest.mark.parametrize("seed", range(90, 102))
def test_climbing_from_below_gives_the_distance_of_graphs(seed):
    rng = np.random.default_rng(seed)
    X, Y = (hops(rng, n) for n in rng.integers(2, 6, 2))
    exact = naive.least_distortion(X.tolist(), Y.tolist())
    interval = first_interval(X, Y, 0.0)
    interval.lower = 0.0
    engine, clock = Engine(X, Y), Clock(math.inf)
    steps.climb(engine, interval, clock, (isometries(X, clock), isometries(Y, clock)))
    assert interval.lower == interval.upper == exact
    assert distortion(interval.pairs, X, Y) == exact


@SLOW
def test_longer_and_longer_tabu_searches_meet_a_low_level():
    rng = np.random.default_rng(13)
    X, Y = hops(rng, 40, share=0.05), hops(rng, 40, share=0.05)
    least = unlimited(X, Y).upper * 2
    interval = first_interval(X, Y, 0.0)
    assert interval.upper > least
    interval.lower = least
    steps.insist(Engine(X, Y), interval, Clock(math.inf))
    assert distortion(interval.pairs, X, Y) == interval.upper == least


@pytest.mark.parametrize("seed", range(110, 122))
def test_search_at_one_level_agrees_with_brute_force(seed):
    rng = np.random.default_rng(seed)
    X, Y = (hops(rng, n, share=0.2) if seed % 3 else polygon(n) for n in rng.integers(2, 6, 2))
    engine, clock = Engine(X, Y), Clock(math.inf)
    symmetries = isometries(X, clock), isometries(Y, clock)
    exact = naive.least_distortion(X.tolist(), Y.tolist())
    for level in np.unique(np.abs(X.reshape(-1, 1) - Y.reshape(1, -1))):
        search = LevelSearch(engine, level, symmetries)
        refuted, pairs = search.run(clock) if search.consistent else (True, None)
        assert refuted == (level < exact - 1e-12)  # polygons: distances that should be equal differ by rounding
        if pairs is not None:
            assert distortion(pairs, X, Y) <= level


@SLOW
@pytest.mark.parametrize("n", [40, 70, 130])
def test_search_at_one_level_begins_with_what_arc_consistency_leaves(n):
    """The engine for any distances comes to the same pairs by runs of sorted rows."""
    rng = np.random.default_rng(n)
    X, Y = hops(rng, n, share=0.5 / n), hops(rng, n - 2, share=0.5 / n)
    engine, clock, partly = Engine(X, Y), Clock(math.inf), 0
    symmetries = isometries(X, Clock(0.0)), isometries(Y, Clock(0.0))
    for level in range(1, int(max(X.max(), Y.max()))):
        search, expected = LevelSearch(engine, float(level), symmetries), engine.consistent(float(level), clock)
        assert search.consistent == (expected is not None)
        if expected is not None:
            np.testing.assert_array_equal(search.possible(), expected)
            partly += not np.array_equal(expected, engine.row_levels <= level)
    assert partly > 0  # at some level it deletes pairs, but not all of a point


@SLOW
def test_search_at_one_level_agrees_with_clause_learning():
    """Spaces of up to 24 points, beyond what brute force can do: sets larger than those that are united."""
    decided = set()
    for seed in range(130, 142):
        rng = np.random.default_rng(seed)
        X, Y = (hops(rng, n, share=0.15) for n in rng.integers(16, 25, 2))
        engine, clock = Engine(X, Y), Clock(math.inf)
        symmetries = isometries(X, clock), isometries(Y, clock)
        for level in (1.0, 2.0):
            search = LevelSearch(engine, level, symmetries)
            refuted, _ = search.run(clock) if search.consistent else (True, None)
            with Satisfiability(engine, engine.row_levels <= level, level, clock) as solver:
                assert solver.run(clock)[0] == refuted
            decided.add(refuted)
    assert decided == {True, False}


def test_a_slice_of_the_search_is_as_long_for_large_spaces(monkeypatch):
    """Sets of hundreds of points are several words; a slice counted them as one, and took seconds."""
    rng = np.random.default_rng(7)
    spaces = []
    for n in (200, 190):
        D = rng.integers(5, 11, size=(n, n)).astype(float)
        D = np.minimum(D, D.T)
        np.fill_diagonal(D, 0.0)
        spaces.append(D)
    identities = tuple(isometries(D, Clock(0.0)) for D in spaces)
    search = LevelSearch(Engine(*spaces), 4.0, identities)
    # After the first decision each of the 390 rows and columns is held against all others: more words than a slice.
    monkeypatch.setattr(level_search, "SLICE", 390 * 190 * 3 - 1)
    search.run(Looks(1))
    assert search._progress[kernels.NODES] == 1
