"""Check the refutation of a propositional formula: each learned clause must follow by unit propagation.

Variables are 1, 2, ..., n; literal -v is the negation of v.  A formula has pairs of variables that exclude each other,
and clauses, one after the other in one array, each with a 0 behind it.  A learned clause follows from what is known if
making all its literals false leads, by clauses with a single literal left, to a contradiction; then it is known too.
Each clause watches two of its literals that are not false: the first two.  Only when one becomes false it is looked at.
"""

from typing import Any, NamedTuple

from rinow.kernels._jit import inner, kernel

REFUTED, WRONG, UNFINISHED = 0, 1, 2
"""Outcomes: a contradiction without assumptions, a clause that does not follow, neither up to here."""


class Formula(NamedTuple):
    """Exclusions, and clauses in the order in which they are known or learned."""

    excluded_from: Any  # (n + 2,): where the list of variable v begins
    excluded: Any  # (n_exclusions,) int32: the variables that v excludes
    literals: Any  # (n_literals,) int32; the watched ones come to the front of their clause
    starts: Any  # (n_clauses + 1,)
    forgets: Any  # (n_clauses,): the clause that is forgotten in place of learning one, or -1


class State(NamedTuple):
    """What is true, and who watches what."""

    values: Any  # (n + 1,) int8: 1 true, -1 false, 0 open
    trail: Any  # (n,) int32: the true literals in the order of assignment
    length: Any  # (1,): of the trail
    watches: Any  # (2 n + 2,): first watch of each literal; watch 2 c + k is literal k of clause c
    following: Any  # (2 n_clauses,): next watch of the same literal, or -1
    forgotten: Any  # (n_clauses,) bool


@inner
def _truth(state, literal):
    """1 for true, -1 for false, 0 for open."""
    return state.values[literal] if literal > 0 else -state.values[-literal]


@inner
def _assign(state, literal):
    """Make a literal true; whether it was not false."""
    truth = _truth(state, literal)
    if truth == 0:
        state.values[abs(literal)] = 1 if literal > 0 else -1
        state.trail[state.length[0]] = literal
        state.length[0] += 1
    return truth >= 0


@inner
def _watch(formula, state, watch):
    """Put a watch into the list of its literal."""
    literal = formula.literals[formula.starts[watch >> 1] + (watch & 1)]
    side = 2 * abs(literal) + (1 if literal < 0 else 0)
    state.following[watch] = state.watches[side]
    state.watches[side] = watch


@inner
def _looks_away(formula, state, watch):
    """Let a clause watch another literal in place of one that became false; whether it has one."""
    begin = formula.starts[watch >> 1]
    for i in range(begin + 2, formula.starts[(watch >> 1) + 1] - 1):
        if _truth(state, formula.literals[i]) >= 0:
            place = begin + (watch & 1)
            formula.literals[i], formula.literals[place] = formula.literals[place], formula.literals[i]
            _watch(formula, state, watch)
            return True
    return False


@inner
def _alert(formula, state, literal):
    """Look at the clauses that watch a literal which became false; whether none is false."""
    side = 2 * abs(literal) + (1 if literal < 0 else 0)
    previous, watch = -1, state.watches[side]
    while watch >= 0:
        clause, following = watch >> 1, state.following[watch]
        leaves = state.forgotten[clause]
        if not leaves:
            other = formula.literals[formula.starts[clause] + 1 - (watch & 1)]
            if _truth(state, other) <= 0:
                leaves = _looks_away(formula, state, watch)
                if not leaves and not _assign(state, other):
                    return False
        if not leaves:
            previous = watch
        elif previous < 0:
            state.watches[side] = following
        else:
            state.following[previous] = following
        watch = following
    return True


@inner
def _propagates(formula, state, k):
    """Draw all conclusions from the trail from place k on; whether they do not contradict each other."""
    while k < state.length[0]:
        literal = state.trail[k]
        k += 1
        if literal > 0:
            for i in range(formula.excluded_from[literal], formula.excluded_from[literal + 1]):
                if not _assign(state, -formula.excluded[i]):
                    return False
        if not _alert(formula, state, -literal):
            return False
    return True


@inner
def _follows(formula, state, clause):
    """Whether a contradiction follows when all literals of a clause are false; nothing stays assigned."""
    known, consistent = state.length[0], True
    for i in range(formula.starts[clause], formula.starts[clause + 1] - 1):
        consistent = consistent and _assign(state, -formula.literals[i])
    consistent = consistent and _propagates(formula, state, known)
    for k in range(known, state.length[0]):
        state.values[abs(state.trail[k])] = 0
    state.length[0] = known
    return not consistent


@inner
def _accepts(formula, state, clause):
    """Take a clause as known; whether that leads to no contradiction."""
    begin, n_open = formula.starts[clause], 0
    for i in range(begin, formula.starts[clause + 1] - 1):
        truth = _truth(state, formula.literals[i])
        if truth > 0:
            return True
        if truth == 0 and n_open < 2:
            place = begin + n_open
            formula.literals[i], formula.literals[place] = formula.literals[place], formula.literals[i]
            n_open += 1
    if n_open == 2:
        _watch(formula, state, 2 * clause)
        _watch(formula, state, 2 * clause + 1)
        return True
    known = state.length[0]
    return n_open == 1 and _assign(state, formula.literals[begin]) and _propagates(formula, state, known)


@kernel
def check(formula, state, n_given, first, last):
    """What becomes of the clauses from `first` to before `last`, of which the first `n_given` need not follow."""
    for clause in range(first, last):
        if formula.forgets[clause] >= 0:
            state.forgotten[formula.forgets[clause]] = True
        elif clause >= n_given and not _follows(formula, state, clause):
            return WRONG
        elif not _accepts(formula, state, clause):
            return REFUTED
    return UNFINISHED
