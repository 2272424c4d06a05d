"""Proofs of a clause-learning solver: right ones pass, forged ones do not, and what a result says about them."""

import math

import numpy as np
import pytest
from pysat.solvers import Solver
from scipy.spatial.distance import pdist, squareform

from clocks import SLOW
from metric_shapes import polygon, segment
from naive import unit_propagation as naive
from rinow import find_approximation, find_epsilon_isometry, gromov_hausdorff, lipschitz_distance
from rinow.comparison import satisfiability, steps
from rinow.comparison.clock import Clock
from rinow.comparison.engine import BIJECTION, MAP, RELATION, Engine
from rinow.comparison.interval import Interval
from rinow.comparison.refutation import is_refuted
from rinow.comparison.satisfiability import Satisfiability
from rinow.comparison.subsets import SubsetBound

FOREVER = Clock(math.inf)


def random_formula(rng, n_variables=9, n_clauses=34, share=0.1):
    """Variables that exclude each other, and clauses of three literals."""
    table = np.triu(rng.random((n_variables, n_variables)) < share, 1)
    table |= table.T
    variables = np.argsort(rng.random((n_clauses, n_variables)), axis=1)[:, :3] + 1
    return [np.flatnonzero(row) + 1 for row in table], (variables * rng.choice([-1, 1], variables.shape)).tolist()


def as_clauses(exclusions, clauses):
    """The whole formula as clauses."""
    return [[-v, -int(w)] for v, others in enumerate(exclusions, 1) for w in others if v < w] + clauses


def proof_of(clauses):
    """The proof of Glucose, or None if the formula can be satisfied."""
    with Solver(name="glucose4", bootstrap_with=clauses, with_proof=True) as solver:
        return None if solver.solve() else solver.get_proof()


def forged(rng, proof, n_variables):
    """A proof with some lines changed, left out or put in."""
    lines = [line for line in proof if rng.random() < 0.8]
    for _ in range(3):
        literals = rng.permutation(n_variables)[: rng.integers(4)] + 1
        literals *= rng.choice([-1, 1], len(literals))
        lines.insert(int(rng.integers(len(lines) + 1)), " ".join(map(str, [*literals, 0])))
    return lines


def test_proofs_of_random_formulas():
    """Right proofs pass; changed ones fare as with the naive twin, which forgets nothing, and false ones never pass."""
    rng, passed, rejected = np.random.default_rng(31), 0, 0
    for _ in range(120):
        formula = random_formula(rng)
        proof = proof_of(as_clauses(*formula))
        if proof is None:
            proof = ["1 0", "-1 0", "0"]
            assert not is_refuted(*formula, proof, FOREVER)
        else:
            assert is_refuted(*formula, proof, FOREVER)
            passed += 1
        lines = [line for line in forged(rng, proof, 9) if not line.startswith("d")]
        expected = naive.is_refuted(as_clauses(*formula), lines)
        assert is_refuted(*formula, lines, FOREVER) == expected
        rejected += not expected
    assert passed > 20
    assert rejected > 20


def test_every_step_must_follow():
    exclusions, clauses = [np.array([2]), np.array([1]), np.array([], np.intp)], [[1, 3], [2, 3], [-3, 1, 2]]
    assert not is_refuted(exclusions, clauses, ["0"], FOREVER)
    assert not is_refuted(exclusions, clauses, ["1 0"], FOREVER)  # true in one solution, but does not follow
    assert not is_refuted(exclusions, clauses, ["3 0"], FOREVER)  # follows, and refutes nothing
    clauses.append([-3])
    assert is_refuted(exclusions, clauses, [], FOREVER)
    assert not is_refuted(exclusions, clauses[:-1], ["3 0", "d 3 0", "-3 0", "0"], FOREVER)
    assert not is_refuted(exclusions, clauses[:-1], ["17 0", "-17 0", "0"], FOREVER)  # no such variable
    assert is_refuted(exclusions, clauses[:-1], ["3 0"], Clock(0.0)) is None


def test_a_forgotten_clause_is_not_used():
    """Nothing excludes two of four combinations of 1 and 2; the learned clauses that do so are forgotten."""
    nothing = [np.array([], np.intp)] * 4
    clauses = [[1, 2, 3], [1, 2, -3], [1, -2, 4], [1, -2, -4], [-1, 2, 3], [-1, 2, -3], [-1, -2, 4], [-1, -2, -4]]
    learned = ["1 2 0", "-2 1 0", "-1 2 0"]
    assert is_refuted(nothing, clauses, [*learned, "1 0", "0"], FOREVER)
    assert is_refuted(nothing, clauses, ["1 2 0", "-2 1 0", "1 0", "d 1 -2 0", "d 2 1 0", "2 0"], FOREVER)
    assert not is_refuted(nothing, clauses, ["1 2 0", "d 2 1 0", "1 0"], FOREVER)


@pytest.mark.parametrize("kind", [RELATION, BIJECTION, MAP])
def test_refutations_of_levels(kind):
    """Just below the least level the proof passes; held against the distances at that level, it fails."""
    rng = np.random.default_rng(33)
    for _ in range(4):
        X, Y = (squareform(pdist(rng.random((6, 2)))) for _ in range(2))
        engine = Engine(X, Y, kind, both=kind != MAP)
        level, worst = math.inf, math.inf
        with Satisfiability(engine, np.ones((6, 6), np.bool_), 10.0, FOREVER, verify=True) as solver:
            while True:
                refuted, pairs = solver.run(FOREVER)
                if refuted:
                    break
                worst = engine.worst_of(pairs)
                level = float(np.nextafter(worst, 0.0))
                solver.lower_level(level, FOREVER)
            interval = Interval(np.empty((0, 2), np.intp), worst, verify=True)
            assert solver.refutes(interval, FOREVER)
            assert interval.proof_checked is True
            assert interval.lower == worst
            late = Interval(np.empty((0, 2), np.intp), worst, verify=True)
            assert solver.refutes(late, Clock(0.0))
            assert late.proof_checked is False
            solver.lower_level(worst, FOREVER)
            assert not solver.refutes(Interval(np.empty((0, 2), np.intp), 9.0, verify=True), FOREVER)


@SLOW
def test_result_tells_whether_the_proof_was_checked(monkeypatch):
    """A circle is not a segment; a wrong proof is not used, and one that was not checked in time is said to be so."""
    X, Y = polygon(12), segment(13, math.pi)
    level = 2 * gromov_hausdorff(X, Y, time_limit=math.inf).upper

    def closed(*, verify, right=None):
        engine = Engine(X, Y)
        interval = Interval(np.empty((0, 2), np.intp), level, verify=verify)
        if right is not None:
            monkeypatch.setattr(satisfiability, "is_refuted", lambda *_: right[0])
        symmetries = steps.isometries(X, FOREVER), steps.isometries(Y, FOREVER)
        steps.satisfiability(engine, interval, FOREVER, engine.row_levels <= interval.upper, symmetries)
        return interval.exact, interval.proof_checked

    assert closed(verify=False) == (True, False)
    assert closed(verify=True) == (True, True)
    assert closed(verify=True, right=[None]) == (True, False)
    assert closed(verify=True, right=[False]) == (False, None)


@SLOW
def test_verified_distances():
    for X, Y in ((polygon(7), segment(6, math.pi)), (polygon(6), polygon(6) * 1.5)):
        plain, verified = (gromov_hausdorff(X, Y, time_limit=math.inf, verify=v) for v in (False, True))
        assert verified.upper == plain.upper
        assert verified.exact
        assert verified.proof_checked in (None, True)
    result = lipschitz_distance(polygon(6), polygon(6) * 1.5, time_limit=math.inf, verify=True)
    assert result.exact
    assert result.proof_checked is None


@SLOW
def test_maps_of_subsets_are_verified():
    """Maps of a circle to a segment: arc consistency stops below the least distortion."""
    bound = SubsetBound(polygon(12), segment(13, math.pi), 0.0, verify=True)
    bound.improve(Clock(600.0))
    assert bound.interval.by == "satisfiability"
    assert bound.interval.proof_checked is True


def test_a_no_is_verified(monkeypatch):
    """Of an approximation and of a map that arc consistency leaves open; a wrong proof leaves the question open."""
    X, Y = polygon(7), segment(6, math.pi)
    questions = [(find_approximation, (X, Y, 0.0, 1.5)), (find_epsilon_isometry, (X, Y, 1.4))]
    for ask, arguments in questions:
        plain, verified = (ask(*arguments, time_limit=math.inf, verify=v) for v in (False, True))
        assert (plain.found, plain.proof_checked) == (False, False)
        assert (verified.found, verified.proof_checked) == (False, True)
    monkeypatch.setattr(satisfiability, "is_refuted", lambda *_: False)
    for ask, arguments in questions:
        wrong = ask(*arguments, time_limit=math.inf, verify=True)
        assert (wrong.found, wrong.proof_checked) == (None, None)
