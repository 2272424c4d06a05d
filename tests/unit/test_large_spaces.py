"""Isometries, spaces of many points, and meshes: certificates, nets, faults."""

import math

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

from clocks import SLOW, Looks
from rinow import MetricSpace, TriangleMesh, distance_matrix, distortion, gromov_hausdorff
from rinow.comparison import large, surfaces
from rinow.comparison.clock import Clock
from rinow.comparison.gromov_hausdorff import first_interval
from rinow.comparison.large_work import Work
from rinow.comparison.surfaces import eccentricity_gap, sample_of
from rinow.comparison.symmetry import isometries
from rinow.errors import InvalidMeshError, NotAMetricError
from rinow.kernels import dives

pytestmark = pytest.mark.usefixtures("compiled_searches")

FOREVER = Clock(math.inf)


def grid(n, height=0.0):
    """A square sheet of n by n vertices, lifted in its middle."""
    u, v = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="ij"))
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    k = i * n + j
    faces = np.concatenate([np.stack([k, k + n, k + n + 1], axis=1), np.stack([k, k + n + 1, k + 1], axis=1)])
    return np.stack([u, v, height * np.sin(math.pi * u) * np.sin(math.pi * v)], axis=1), faces


def test_isometries_of_a_polygon_form_its_dihedral_group():
    steps = np.abs(np.subtract.outer(np.arange(9), np.arange(9)))
    D = np.minimum(steps, 9 - steps).astype(float)
    found = isometries(D, Clock(math.inf))
    assert len(found.images) == len({tuple(f) for f in found.images}) == 18
    assert found.error == 0.0
    for f in found.images:
        assert (D[np.ix_(f, f)] == D).all()
    assert len(found.representatives([])) == 1
    assert len(found.representatives([0])) == 5  # the reflection that fixes 0 joins the other eight in pairs


def test_isometries_of_a_generic_space_are_trivial():
    assert isometries(squareform(pdist(np.random.default_rng(2).random((30, 2)))), Clock(math.inf)).trivial


def test_isometries_up_to_rounding_know_their_error():
    angle = np.arange(7) * (2 * math.pi / 7)
    D = squareform(pdist(np.stack([np.cos(angle), np.sin(angle)], axis=1)))
    found = isometries(D, Clock(math.inf))
    assert len(found.images) == 14
    assert 0 < found.error < 1e-14


class Until(Clock):
    """A clock that stops when the upper bound is at most a goal: the answer does not hang on the machine's speed."""

    def __init__(self, interval, goal):
        super().__init__(120)
        self._interval, self._goal = interval, goal

    @property
    def over(self):
        return super().over or self._interval.upper <= self._goal


@SLOW
def test_dives_find_an_isometry():
    rng = np.random.default_rng(33)
    points = rng.random((150, 3))
    order = rng.permutation(150)
    X, Y = squareform(pdist(points)), squareform(pdist(points[order] * [1.0, 1.0, 1.02]))
    interval = first_interval(X, Y, 0.0)
    truth = distortion(np.stack([order, np.arange(150)], axis=1), X, Y)
    assert interval.upper > 20 * truth
    large.approach(X, Y, interval, Until(interval, 2 * truth))
    assert interval.upper == distortion(interval.pairs, X, Y)
    assert interval.lower <= interval.upper <= 2 * truth


def test_completed_relation_keeps_its_pairs():
    rng = np.random.default_rng(34)
    X, Y = squareform(pdist(rng.random((20, 2)))), squareform(pdist(rng.random((25, 2))))
    partners = np.full(45, dives.LEFT_OVER)
    partners[[3, 5, 8, 20 + 4]] = [1, 0, 7, 2]
    relation = Work(X, Y).completed(partners, Clock(math.inf))
    assert (relation[partners >= 0] == partners[partners >= 0]).all()
    pairs, value = Work(X, Y).measured(relation)
    assert value == distortion(pairs, X, Y)
    assert set(pairs[:, 0]) == set(range(20))
    assert set(pairs[:, 1]) == set(range(25))
    assert {(3, 1), (5, 0), (8, 7), (2, 4)} <= {(x, y) for x, y in pairs}


def test_polish_takes_conflicts_out_and_changes_one_end_of_a_pair():
    rng = np.random.default_rng(36)
    D = squareform(pdist(rng.random((30, 2))))
    work, level = Work(D, D), 0.1
    start = np.concatenate([np.arange(30), np.arange(30)])
    start[[2, 11, 45]] = [np.argsort(D[2])[9], np.argsort(D[11])[9], np.argsort(D[15])[9]]
    start[20] = dives.ABSENT
    polished = work.polished(start, level)
    assert len(work.conflicts(start, level)) > 0
    assert len(work.conflicts(polished, level)) == 0
    assert polished[20] == dives.ABSENT
    assert work.measured(polished)[1] <= level * (1 + 1e-6)  # single precision


@SLOW
def test_shuffled_mesh_is_isometric_to_itself():
    V, F = grid(6)
    order = np.random.default_rng(35).permutation(len(V))
    result = gromov_hausdorff((V, F), TriangleMesh(V[np.argsort(order)], order[F]))
    assert result.exact
    assert result.upper == 0.0
    assert result.covering_radii == (0.0, 0.0)


def test_mesh_with_loose_vertices_is_its_used_vertices():
    V, F = grid(3)
    loose = np.concatenate([[[9.0, 9.0, 9.0]], V])
    result = gromov_hausdorff((V, F), (loose, F + 1))
    assert result.upper == 0.0
    assert set(result.correspondence[:, 1]) == set(range(1, 10))


def test_meshes_in_two_parts_are_refused():
    V, F = grid(3)
    two = np.concatenate([V, V + 5]), np.concatenate([F, F + 9])
    for name, pair in (("X", (two, [[0.0]])), ("Y", ([[0.0]], two))):
        with pytest.raises(NotAMetricError, match=f"^{name}: mesh has no path from vertex 0 to vertex 9") as caught:
            gromov_hausdorff(*pair)
        assert caught.value.witness == (0, 9)
    with pytest.raises(NotAMetricError, match=r"^spaces\[1\]: mesh has no path"):
        distance_matrix([(V, F), two])


def test_mesh_without_a_face_that_takes_part():
    with pytest.raises(InvalidMeshError, match="mesh has no face with three different finite vertices"):
        gromov_hausdorff((grid(2)[0], [[0, 0, 1]]), grid(2))


@SLOW
def test_interval_of_nets_contains_the_distance_of_the_meshes(monkeypatch):
    A, B = grid(6), grid(6, 0.8)
    exact = gromov_hausdorff(A, B, time_limit=20)
    monkeypatch.setattr(surfaces, "ALL_VERTICES", 10)
    monkeypatch.setattr(surfaces, "LARGEST_NET", 14)
    monkeypatch.setattr("rinow.comparison.gromov_hausdorff.whole_relation", lambda *_: None)  # that of the nets stays
    result = gromov_hausdorff(A, B, time_limit=5)
    assert not result.exact
    assert min(result.covering_radii) > 0
    assert result.lower <= exact.lower
    assert exact.upper <= result.upper
    D = [sample_of(mesh, FOREVER, FOREVER, FOREVER) for mesh in (A, B)]
    monkeypatch.setattr(surfaces, "ALL_VERTICES", 1000)
    full = [MetricSpace(sample_of(mesh, FOREVER, FOREVER, FOREVER).distances) for mesh in (A, B)]
    spaces = [space.subspace(sample.indices) for space, sample in zip(full, D, strict=True)]
    half = distortion(
        [[list(D[0].indices).index(x), list(D[1].indices).index(y)] for x, y in result.correspondence], *spaces
    )
    assert result.upper == half / 2 + max(result.covering_radii)


@pytest.mark.parametrize("looks", [0, 1, 12])
def test_small_mesh_becomes_a_net_when_the_time_is_over(monkeypatch, looks):
    """One point more than looks at the clock that allowed one; the intervals hold, and half the diameter is enough."""
    mesh, other = grid(5, 0.5), grid(5)
    full = sample_of(mesh, FOREVER, FOREVER, FOREVER)
    assert (full.indices == np.arange(25)).all()
    assert full.covering_radius == 0.0
    net = sample_of(mesh, Clock(0), Looks(looks), FOREVER)
    assert len(net.indices) == looks + 2
    assert (net.distances == full.distances[np.ix_(net.indices, net.indices)]).all()
    assert net.covering_radius == full.distances[net.indices].min(axis=0).max()
    assert net.diameter_bound >= full.distances.max()
    exact = gromov_hausdorff(mesh, other, time_limit=math.inf)
    monkeypatch.setattr(surfaces, "SMALL_NET", 0)
    rough = gromov_hausdorff(mesh, other, time_limit=0)
    assert rough.lower <= exact.lower <= exact.upper <= rough.upper
    assert not rough.exact


def test_mesh_whose_distances_take_too_long_is_compared_by_a_net(monkeypatch):
    monkeypatch.setattr(surfaces, "SMALL_NET", 2)
    monkeypatch.setattr(surfaces, "LARGEST_NET", 9)
    full = sample_of(grid(5), FOREVER, FOREVER, FOREVER)
    net = sample_of(grid(5), FOREVER, FOREVER, Looks(4))
    assert len(full.indices) == 25 and len(net.indices) == 9
    assert net.covering_radius == full.distances[net.indices].min(axis=0).max()


def test_coincident_vertices_of_a_mesh_are_all_taken():
    V = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 1, 0]]
    full = sample_of((V, [[0, 1, 2], [1, 3, 2]]), FOREVER, FOREVER, FOREVER)
    assert (full.indices == np.arange(4)).all()
    assert full.distances[2, 3] == full.covering_radius == 0.0


def test_eccentricity_bounds_of_a_net_hold_for_all_vertices(monkeypatch):
    full = sample_of(grid(7, 0.5), FOREVER, FOREVER, FOREVER)
    monkeypatch.setattr(surfaces, "ALL_VERTICES", 10)
    monkeypatch.setattr(surfaces, "LARGEST_NET", 6)
    net = sample_of(grid(7, 0.5), FOREVER, FOREVER, FOREVER)
    low, high = net.eccentricity_bounds
    true = full.distances.max(axis=1)
    assert (low <= true + 1e-12).all()  # rounding of sums of two distances
    assert (true <= high + 1e-12).all()
    assert eccentricity_gap(net, full) <= 1e-12
    assert net.covering_radius == full.distances[net.indices].min(axis=0).max()


def arc_metric(n, length):
    steps = np.abs(np.arange(n)[:, None] - np.arange(n))
    return np.minimum(steps, n - steps) * length / n


def test_nets_of_circles_of_two_lengths_tell_their_diameters_without_the_larger_radius():
    # Ends of a diameter of the large circle, 4 apart, have partners in the small one, of diameter 1 + 2 r at most.
    small, large, radii = arc_metric(20, 2.0), arc_metric(16, 8.0), (0.05, 0.25)
    for spaces, r in (((small, large), radii), ((large, small), radii[::-1])):
        found = gromov_hausdorff(*spaces, covering_radii=r, time_limit=0)
        assert found.lower_bound_by == "eccentricities"
        assert found.lower == pytest.approx((4.0 - (1.0 + 2 * 0.05)) / 2, rel=1e-9)
        assert found.lower <= (4.0 - 1.0) / 2 <= found.upper  # scaling has the distortion 3; no map has less


def test_eccentricities_of_nets_hold_for_every_denser_net():
    rng = np.random.default_rng(11)
    points = [rng.uniform(size=(40, 2)), rng.uniform(size=(40, 2)) * [3.0, 0.5]]
    whole = [MetricSpace.from_points(p) for p in points]
    exact = gromov_hausdorff(*whole, time_limit=0)
    for k in (5, 10, 20):
        parts = [space.subspace(range(k)) for space in whole]
        radii = tuple(float(space.distances[:, :k].min(axis=1).max()) for space in whole)
        found = eccentricity_gap(*(sample_of(part, FOREVER, FOREVER, FOREVER) for part in parts), radii)
        assert found <= eccentricity_gap(*(sample_of(space, FOREVER, FOREVER, FOREVER) for space in whole)) + 1e-12
        assert found / 2 <= exact.upper
