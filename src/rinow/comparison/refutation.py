"""Check a refutation that a clause-learning solver wrote down, by unit propagation alone (DRUP).

What has to be trusted is that the formula says what it should; how the solver came to its clauses does not matter.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.kernels import unit_propagation

__all__ = ["is_refuted"]

Indices = NDArray[np.intp]
Literals = NDArray[np.int32]

SLICE = 1000
"""Clauses between two looks at the clock: some tenths of a second."""


def is_refuted(
    exclusions: Sequence[Indices], clauses: Sequence[Sequence[int]], proof: Sequence[str], clock: Clock
) -> bool | None:
    """Whether a proof refutes a formula; None if the time is over before.

    Variable v = 1, 2, ... excludes each variable in exclusions[v - 1], and conversely; of each clause a literal is
    true.  A line of the proof is a learned clause that ends with 0, or a clause to forget, which has a "d" in front.  A
    literal occurs once in a clause; where it is repeated, a right proof may not be recognised.
    """
    n, given = len(exclusions), _literals("".join(" ".join(map(str, (*clause, 0))) + " " for clause in clauses))
    learned = _literals(" ".join(proof).replace("d", ""))
    literals = np.concatenate([given, learned])
    if np.abs(literals).max(initial=0) > n:
        return False
    starts = np.concatenate([[0], np.flatnonzero(literals == 0) + 1])
    forgets = _forgotten(literals, starts, len(clauses), [line.startswith("d") for line in proof])
    excluded_from = np.concatenate([[0, 0], np.cumsum([len(others) for others in exclusions])])
    excluded = np.concatenate([np.empty(0, np.int32), *exclusions]).astype(np.int32)
    formula = unit_propagation.Formula(excluded_from, excluded, literals, starts, forgets)
    n_clauses = len(forgets)
    state = unit_propagation.State(
        np.zeros(n + 1, np.int8), np.zeros(n, np.int32), np.zeros(1, np.int64),
        np.full(2 * n + 2, -1), np.full(2 * n_clauses, -1), np.zeros(n_clauses, np.bool_),
    )  # fmt: skip
    for first in range(0, n_clauses, SLICE):
        if clock.over:
            return None
        last = min(first + SLICE, n_clauses)
        outcome = unit_propagation.check(formula, state, len(clauses), first, last)
        if outcome != unit_propagation.UNFINISHED:
            return outcome == unit_propagation.REFUTED
    return False


def _literals(text: str) -> Literals:
    """Numbers with blanks between them."""
    return np.fromstring(text, dtype=np.int32, sep=" ") if text.strip() else np.empty(0, np.int32)


def _forgotten(literals: Literals, starts: Indices, n_given: int, forgetting: Sequence[bool]) -> Indices:
    """For each line that forgets a learned clause its number, itself for one that was given, else -1.

    The literals come in any order, so clauses are told apart by sums of random numbers.  A coincidence forgets the
    wrong clause; that, and not to forget one, cannot make a wrong proof right.
    """
    names = np.random.default_rng(20).integers(
        2**63, size=2 * int(np.abs(literals).max(initial=0)) + 1, dtype=np.uint64
    )
    keys = np.add.reduceat(names[literals], starts[:-1])[n_given:].tolist() if len(literals) else []
    forgets = np.full(len(starts) - 1, -1)
    known: dict[int, int] = {}
    for clause, (key, forget) in enumerate(zip(keys, forgetting, strict=True), n_given):
        if forget:
            forgets[clause] = known.pop(key, clause)
        else:
            known[key] = clause
    return forgets
