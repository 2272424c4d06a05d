"""The same question for a solver that learns clauses.

It refutes what parity or winding numbers forbid, where a search does not end.  One variable stands for each pair that
may occur; every point has a clause of its pairs, every two incompatible pairs have one too.  python-sat brings the
solver; without it this step is left out.
"""

from __future__ import annotations

import importlib.util
import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import BIJECTION, MAP, Engine
from rinow.comparison.interval import Interval
from rinow.comparison.refutation import is_refuted
from rinow.comparison.symmetry import Isometries

__all__ = ["Satisfiability", "solver_installed"]

Indices = NDArray[np.intp]
Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

LARGEST_VARIABLES, LARGEST_CLAUSES = 20_000, 6_000_000
"""Size that still fits: about a gigabyte and half a minute to set up."""

SAMPLE = 50
"""Pairs whose conflicts are counted before any clause is made."""

FIRST_CONFLICTS = 200
"""Conflicts between the first two looks at the clock; then as many as fit into some tenths of a second."""


def solver_installed() -> bool:
    """Whether python-sat can be imported."""
    return importlib.util.find_spec("pysat") is not None


class Satisfiability:
    """A solver for one engine at falling levels; what it learned at one level it keeps at the next.

    `ready` is false if the problem is too large or the time was over before it was set up.  With `verify` it writes
    down its proof.
    """

    def __init__(
        self,
        engine: Engine,
        possible: Flags,
        level: float,
        clock: Clock,
        isometries: tuple[Isometries, Isometries] | None = None,
        near: tuple[Flags, Flags] | None = None,
        *,
        verify: bool = False,
    ) -> None:
        from pysat.solvers import Solver  # the import takes long

        self.engine, self.pairs = engine, np.argwhere(possible)
        self._solver: Any = Solver(name="glucose4", with_proof=verify)
        self._verify, self._given = verify, list[list[int]]()
        self._conflicts = FIRST_CONFLICTS
        self._level, self._clauses = math.inf, 0
        self.error = 0.0
        variables = np.zeros(engine.shape, np.intp)
        variables[possible] = np.arange(1, len(self.pairs) + 1)
        self.ready = len(self.pairs) <= LARGEST_VARIABLES and self._expected_clauses(level) <= LARGEST_CLAUSES
        if self.ready:
            self._cover(variables, near)
            self._break_symmetry(variables, isometries)
            self.lower_level(level, clock)

    def __enter__(self) -> Satisfiability:
        return self

    def __exit__(self, *_: object) -> None:
        self._solver.delete()

    def _expected_clauses(self, level: float) -> float:
        """Number of clauses of incompatible pairs, from a sample."""
        x, y = self.pairs.T
        sample = np.linspace(0, len(x) - 1, min(len(x), SAMPLE)).astype(np.intp)
        DX, DY, kind = self.engine.DX, self.engine.DY, self.engine.kind
        wrong = [np.count_nonzero(_discrepancies(kind, DX[x[s], x], DY[y[s], y]) > level) for s in sample]
        return 0.5 * len(x) * float(np.mean(wrong)) if wrong else 0.0

    def lower_level(self, level: float, clock: Clock) -> None:
        """Forbid the pairs of pairs that agree to the last level but not to this one."""
        DX, DY, kind = self.engine.DX, self.engine.DY, self.engine.kind
        x, y = self.pairs.T
        for s in range(len(self.pairs)):
            worse = _discrepancies(kind, DX[x[s], x[s + 1 :]], DY[y[s], y[s + 1 :]])
            wrong = (worse > level) & (worse <= self._level)
            if self._level == math.inf and kind in (BIJECTION, MAP):
                wrong |= (x[s + 1 :] == x[s]) | ((y[s + 1 :] == y[s]) if kind == BIJECTION else False)
            others = np.flatnonzero(wrong) + s + 2
            self._clauses += len(others)
            if self._clauses > LARGEST_CLAUSES or (s % 8 == 0 and clock.over):
                self.ready = False
                return
            self._solver.append_formula([-(s + 1), -int(o)] for o in others)
        self._level = level

    def run(self, clock: Clock) -> tuple[bool, Indices | None]:
        """Solve until the time is over; whether the level is refuted, and a relation that fits it."""
        while self.ready and not clock.over:
            self._solver.conf_budget(self._conflicts)
            before = clock.elapsed
            answer = self._solver.solve_limited()
            if answer is False:
                return True, None
            if answer is True:
                model = np.array(self._solver.get_model()[: len(self.pairs)])
                return False, self.pairs[model > 0]
            spent = clock.elapsed - before
            self._conflicts = max(20, int(self._conflicts * min(2.0, 0.3 / max(spent, 1e-3))))
        return False, None

    def refutes(self, interval: Interval, clock: Clock) -> bool:
        """Raise a lower bound by the refutation, unless its proof is found to be wrong; whether that was done."""
        right = self.proof_is_right(clock)
        if right is not False:
            interval.refuted(self._level, self.engine, "satisfiability", self.error, right is True)
        return right is not False

    def proof_is_right(self, clock: Clock) -> bool | None:
        """Whether a check confirms the refutation; None if none was asked for or the time is over before.

        For the check incompatible pairs are found again from the distances; the clauses for points and symmetry are
        what the solver was given.
        """
        if not self._verify:
            return None
        exclusions = [self._incompatible(s) for s in range(len(self.pairs)) if not clock.over]
        return None if clock.over else is_refuted(exclusions, self._given, self._solver.get_proof(), clock)

    def _incompatible(self, s: int) -> Indices:
        """The variables of the pairs that cannot stand beside a pair."""
        DX, DY, kind = self.engine.DX, self.engine.DY, self.engine.kind
        x, y = self.pairs.T
        wrong = _discrepancies(kind, DX[x[s], x], DY[y[s], y]) > self._level
        if kind in (BIJECTION, MAP):
            wrong |= (x == x[s]) | ((y == y[s]) if kind == BIJECTION else False)
        wrong[s] = False
        return np.flatnonzero(wrong) + 1

    def _cover(self, variables: Indices, near: tuple[Flags, Flags] | None) -> None:
        """A pair for every point that must be covered, or for some point near it."""
        if near is None:
            self._add(row[row > 0].tolist() for row in variables)
            if self.engine.both:
                self._add(column[column > 0].tolist() for column in variables.T)
            return
        for close, table in zip(near, (variables, variables.T), strict=True):
            self._add(table[ball][table[ball] > 0].tolist() for ball in close)

    def _add(self, clauses: Iterable[list[int]]) -> None:
        added = list(clauses)
        self._given += added
        self._solver.append_formula(added)

    def _break_symmetry(self, variables: Indices, isometries: tuple[Isometries, Isometries] | None) -> None:
        """Where a space is homogeneous, place two points of the other one in it.

        For a homogeneous X: y0 belongs to x0, and y1 to a representative under the isometries that fix x0.  Other pairs
        of y1 stay allowed: they may be needed to cover X.  Where only X must be covered, y0 may belong to nothing: then
        it is Y that must be homogeneous.
        """
        if isometries is None:
            return
        ways = list(zip(isometries, (variables, variables.T), strict=True))
        for symmetric, table in ways if self.engine.both else ways[1:]:
            if symmetric.transitive and table.shape[1] > 1:
                counts = (table > 0).sum(axis=0)
                y0, y1 = (int(y) for y in np.argsort(counts, kind="stable")[:2])
                x0 = int(symmetric.representatives([])[0])
                orbit = table[symmetric.representatives([x0]), y1]
                self._add([[int(table[x0, y0])] if table[x0, y0] else []])
                self._add([orbit[orbit > 0].tolist()])
                self.error = 2.0 * symmetric.error
                return


def _discrepancies(kind: int, a: Floats, b: Floats) -> Floats:
    """The measure of `kernels.compatibility.discrepancy` for arrays."""
    if kind != BIJECTION:
        return np.abs(a - b)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(a == b, 1.0, np.maximum(a / b, b / a))
