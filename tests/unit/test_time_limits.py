"""Steps look at the clock after a bounded amount of work: counted, not timed."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

import rinow
from clocks import Looks
from rinow.comparison import alignment, large_work, lipschitz, steps
from rinow.comparison import clock as clock_module
from rinow.comparison import engine as engine_module
from rinow.comparison.affine_bijections import offer_affine_bijections
from rinow.comparison.alignment import align, coordinates
from rinow.comparison.bounds import matching_bound
from rinow.comparison.clock import Clock, TimeOver
from rinow.comparison.engine import BIJECTION, Engine, Search
from rinow.comparison.gromov_hausdorff import first_interval
from rinow.comparison.interval import Interval
from rinow.comparison.large_work import Work
from rinow.comparison.satisfiability import Satisfiability
from rinow.comparison.surfaces import geodesics_within
from rinow.comparison.symmetry import isometries
from rinow.errors import InvalidInputError
from rinow.geodesics import exact
from rinow.kernels import compatibility, dives
from shapes import icosphere

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


def test_first_dives_come_in_parts(monkeypatch):
    """A dive for a net of lists that hold most points took seconds of its own: of trees with 2,000 nodes, 5."""
    X, Y = spaces(60, 50)
    level = 0.5
    whole, promising = Work(X, Y).begun(level, Clock(math.inf))
    monkeypatch.setattr(large_work, "EXAMINED", dives.TRIALS * large_work.TRIES * 110 * 60 * 2)
    calls = recorded(monkeypatch, dives, "many_descents", lambda a: a[4])
    again, still_promising = Work(X, Y).begun(level, Clock(math.inf))
    assert len(calls) > 4
    assert calls[0] >= 2  # lists are shorter than all points
    assert (again == whole).all()
    assert still_promising == promising
    assert max(looks for looks in range(12) if Work(X, Y).begun(level, Looks(looks)) is None) > 4


def test_places_of_points_stop_with_the_clock():
    """Eigenvalues that lie close together take hundreds of rounds."""
    rng = np.random.default_rng(3)
    D = rng.integers(5, 11, size=(alignment.DENSE + 1,) * 2).astype(float)
    D = np.minimum(D, D.T)
    np.fill_diagonal(D, 0.0)
    with pytest.raises(TimeOver):
        coordinates(D, Looks(30))
    E = D[::-1, ::-1].copy()
    interval = first_interval(D, E, 0.0)
    before = interval.upper
    for offer in (align, offer_affine_bijections):
        offer(D, E, interval, Looks(30))
        assert interval.upper == before


def test_isometries_stop_with_the_clock():
    steps = np.abs(np.subtract.outer(np.arange(9), np.arange(9)))
    D = np.minimum(steps, 9 - steps).astype(float)
    some = isometries(D, Looks(40))
    assert 1 <= len(some.images) < 18
    for f in some.images:
        assert (D[np.ix_(f, f)] == D).all()


def test_matching_bound_stops_below_the_level_that_it_seeks():
    levels = np.random.default_rng(3).random((30, 30))
    whole = matching_bound(levels)
    bounds = [matching_bound(levels, Looks(looks)) for looks in range(12)]
    assert bounds[0] == max(levels.min(axis=0).max(), levels.min(axis=1).max())  # each has a partner
    assert bounds == sorted(bounds)
    assert bounds[-1] == whole


def test_bijections_of_many_points_are_bounded_but_not_searched(monkeypatch):
    X, Y = spaces(12, 12)
    exactly = rinow.lipschitz_distance(X, Y)
    monkeypatch.setattr(lipschitz, "SEARCHED", 11)
    monkeypatch.setattr(engine_module, "sorted_rows", None)  # cubic memory
    result = rinow.lipschitz_distance(X, Y)
    assert 0.0 < result.lower <= exactly.lower <= exactly.upper <= result.upper
    f = result.bijection
    assert result.upper == math.log(max(rinow.dilatation(f, X, Y), rinow.dilatation(np.argsort(f), Y, X)))


def test_sets_of_sorted_rows_count_as_memory(monkeypatch):
    X, Y = spaces(20, 20)
    engine, possible = Engine(X, Y, BIJECTION), np.eye(20, dtype=bool)
    assert engine.fits(possible)
    monkeypatch.setattr(engine_module, "TABLE_BYTES", 4 * 20 * 40 + 2 * 20**3 // 8 - 1)
    assert not engine.fits(possible)


def test_geodesic_distances_stop_at_the_second_look(monkeypatch):
    """The first sources may have to wait for compiled code, so that they tell nothing about the others."""
    mesh = icosphere(3)
    surface = rinow.TriangleMesh(mesh.vertices, mesh.faces)
    asked, distances = [], exact.ExactGeodesics.distances

    def counted(self, sources, **options):
        asked.append(len(sources))
        return distances(self, sources, **options)

    monkeypatch.setattr(exact.ExactGeodesics, "distances", counted)
    message = r"distances of 642 vertices take about \S+ s, too much for the time limit; allow \d+ s, or simplify"
    for looks, blocks in ((0, 2), (3, 5)):
        asked.clear()
        with pytest.raises(InvalidInputError, match=message):
            geodesics_within(surface, Looks(looks))
        assert asked == [64] * blocks
    whole = geodesics_within(surface, Looks(20))
    assert (whole.distances == rinow.geodesic_space(surface).distances).all()


def test_few_geodesic_distances_need_no_time():
    mesh = icosphere(1)
    assert len(geodesics_within(rinow.TriangleMesh(mesh.vertices, mesh.faces), Clock(0.0))) == 42


def test_solver_goes_on_while_it_finds_relations(monkeypatch):
    """Each relation is worth the share of what is left, anew: here each takes a fifth of the whole time."""
    X, Y = spaces(6, 6)
    engine, now, shares = Engine(X, Y, BIJECTION), [0.0], []
    rng = np.random.default_rng(3)
    maps = [np.stack([np.arange(6), rng.permutation(6)], axis=1) for _ in range(5)]
    maps.sort(key=engine.worst_of, reverse=True)

    class Solver(Satisfiability):
        def __init__(self, *_, **__):
            self.ready, self._left = True, iter(maps[1:])

        def __exit__(self, *_):
            """Nothing to delete."""

        def lower_level(self, *_):
            """The maps are given."""

        def run(self, clock):
            shares.append(clock.seconds)
            now[0] += 20.0
            return False, None if clock.over else next(self._left)

    monkeypatch.setattr(clock_module, "time", SimpleNamespace(monotonic=lambda: now[0]))
    monkeypatch.setattr(steps, "Satisfiability", Solver)
    monkeypatch.setattr(steps, "solver_installed", lambda: True)
    monkeypatch.setattr(steps, "polish", lambda *_: None)
    interval = Interval(maps[0], engine.worst_of(maps[0]), lower=1.0)
    everything = np.ones((6, 6), np.bool_)
    steps.satisfiability(engine, interval, Clock(100.0), everything, (isometries(X, Clock(1.0)),) * 2)
    assert shares == pytest.approx([40.0, 32.0, 24.0, 16.0])
    assert interval.upper == engine.worst_of(maps[3])
