"""Branch and bound over relations between two spaces: resumable, with restarts, failure weights and isometries."""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import kernel
from rinow.kernels.bitsets import ZERO, bit, contains, first_point, lowest_bit, popcount
from rinow.kernels.correspondences import UNFINISHED, clear, delete, mark_all, propagate, restrict

PAUSED, FOUND, EXHAUSTED = 0, 1, 2
"""Why a search returns: its budget is spent; it stands at a relation that fits; there is none, or none other."""

DEPTH, DESCENDING, VERSION, NODES, LIMIT, TOTAL, REFUTED, SETTLING = range(8)
"""Places in the progress of a search: decisions made; whether it goes down; number of changes of the level; nodes since
the last restart, and how many are allowed; nodes in all; pairs refuted at the root; whether
a propagation is unfinished."""

LONGEST_PROPAGATION = 20_000_000
"""Support tests after which a propagation lets the search look at its budget."""


class Stack(NamedTuple):
    """What was possible before each decision, the decision, and the version of the level it was taken at."""

    rows: Any
    columns: Any
    row_counts: Any
    column_counts: Any
    decisions: Any  # (depth, 2)
    versions: Any  # (depth,)


class Problem(NamedTuple):
    """What does not change during a search, but for the entries of the runs."""

    X: Any  # SortedRows
    Y: Any  # SortedRows
    runs: Any  # Runs
    both: bool  # whether the points of Y must be covered too
    isometries_x: Any  # (k, n), the identity first
    isometries_y: Any  # (l, m)


@kernel
def search(problem, relation, queue, stack, progress, weights, f, g, budget):
    """Go on until the budget of support tests is spent, a fitting relation is found (f and g), or nothing is left."""
    spent = 0
    while spent < budget:
        if progress[SETTLING] == 1:
            spent += _settle(problem, relation, queue, progress, weights, True)
            continue
        if progress[DESCENDING] == 0:
            if progress[DEPTH] == 0:
                return EXHAUSTED
            spent += _backtrack(problem, relation, queue, stack, progress, weights)
            continue
        if progress[NODES] >= progress[LIMIT]:
            spent += _restart(problem, relation, queue, stack, progress, weights)
            continue
        place = _choose(relation, stack, progress[DEPTH], weights, problem.both)
        if place < 0:
            _read(relation, stack, progress[DEPTH], f, g)
            progress[DESCENDING] = 0
            return FOUND
        spent += _decide(problem, relation, queue, stack, progress, weights, place)
    return PAUSED


@kernel
def _decide(problem, relation, queue, stack, progress, weights, place):
    """Push the best pair of the chosen row or column; the work."""
    x, y, work = _best_pair(problem, relation, place)
    depth = progress[DEPTH]
    _save(relation, stack, depth)
    stack.versions[depth] = progress[VERSION]
    stack.decisions[depth, 0], stack.decisions[depth, 1] = x, y
    progress[DEPTH] += 1
    progress[NODES] += 1
    progress[TOTAL] += 1
    clear(queue)
    alive = restrict(relation, queue, problem.runs, problem.X, problem.Y, x, y, problem.both)
    return work + _settle(problem, relation, queue, progress, weights, alive)


@kernel
def _backtrack(problem, relation, queue, stack, progress, weights):
    """Undo the last decision and take its pair, with the images under isometries, out of what is possible; the work."""
    progress[DEPTH] -= 1
    depth = progress[DEPTH]
    if depth == 0:
        progress[REFUTED] += 1
    alive = _recall(problem, relation, queue, stack, progress)
    _refute(problem, relation, queue, stack, depth)
    alive = alive and relation.row_counts.min() > 0 and (not problem.both or relation.column_counts.min() > 0)
    return 1 + _settle(problem, relation, queue, progress, weights, alive)


@kernel
def _restart(problem, relation, queue, stack, progress, weights):
    """Return to the root, keeping the weights and what was refuted there; the work."""
    progress[NODES] = 0
    progress[LIMIT] += progress[LIMIT] // 2
    if progress[DEPTH] == 0:
        return 1
    progress[DEPTH] = 0
    alive = _recall(problem, relation, queue, stack, progress)
    return 1 + _settle(problem, relation, queue, progress, weights, alive)


@kernel
def _settle(problem, relation, queue, progress, weights, alive):
    """Propagate, and set the direction in which the search goes on; the work."""
    emptied, work = -1, 0
    if alive:
        emptied, work = propagate(
            relation, queue, problem.runs, problem.X, problem.Y, problem.both, weights, LONGEST_PROPAGATION
        )
    progress[SETTLING] = 1 if emptied == UNFINISHED else 0
    progress[DESCENDING] = 1 if alive and emptied < 0 else 0
    return work


@kernel
def _save(relation, stack, depth):
    """Keep a copy of what is possible."""
    stack.rows[depth] = relation.rows
    stack.columns[depth] = relation.columns
    stack.row_counts[depth] = relation.row_counts
    stack.column_counts[depth] = relation.column_counts


@kernel
def _recall(problem, relation, queue, stack, progress):
    """Return to the copy at the present depth, made valid for the present level; whether it has no empty row."""
    depth = progress[DEPTH]
    relation.rows[:] = stack.rows[depth]
    relation.columns[:] = stack.columns[depth]
    relation.row_counts[:] = stack.row_counts[depth]
    relation.column_counts[:] = stack.column_counts[depth]
    clear(queue)
    if stack.versions[depth] == progress[VERSION]:
        return True
    alive = True
    for d in range(depth):
        x, y = stack.decisions[d, 0], stack.decisions[d, 1]
        alive = restrict(relation, queue, problem.runs, problem.X, problem.Y, x, y, problem.both) and alive
    for d in range(depth):  # two decisions may disagree at the new level
        alive = alive and contains(relation.rows[stack.decisions[d, 0]], stack.decisions[d, 1])
    mark_all(queue)
    return alive


@kernel
def _refute(problem, relation, queue, stack, depth):
    """Delete the pair decided last and its images under the isometries that fix the earlier decisions."""
    x, y = stack.decisions[depth, 0], stack.decisions[depth, 1]
    for i in range(problem.isometries_x.shape[0]):
        if not fixes(problem.isometries_x[i], stack.decisions, depth, 0):
            continue
        image_x = problem.isometries_x[i, x]
        for j in range(problem.isometries_y.shape[0]):
            image_y = problem.isometries_y[j, y]
            if contains(relation.rows[image_x], image_y) and fixes(problem.isometries_y[j], stack.decisions, depth, 1):
                delete(relation, queue, image_x, image_y)


@kernel
def fixes(isometry, decisions, depth, side):
    """Whether an isometry leaves every decided point of its side in place."""
    for d in range(depth):
        if isometry[decisions[d, side]] != decisions[d, side]:
            return False
    return True


@kernel
def _choose(relation, stack, depth, weights, both):
    """Undecided row, or n + column, with the fewest possible pairs for its weight; -1 if all have one."""
    n, m = relation.rows.shape[0], relation.columns.shape[0]
    covered = np.zeros(n + m, np.bool_)
    for d in range(depth):
        covered[stack.decisions[d, 0]] = True
        covered[n + stack.decisions[d, 1]] = True
    best, chosen = np.inf, -1
    for place in range(n + m if both else n):
        count = relation.row_counts[place] if place < n else relation.column_counts[place - n]
        if count > 1 and not covered[place] and count / weights[place] < best:
            best, chosen = count / weights[place], place
    return chosen


@kernel
def _best_pair(problem, relation, place):
    """Pair of a row or column that leaves the most pairs possible; the work."""
    n = relation.rows.shape[0]
    own = relation.rows[place] if place < n else relation.columns[place - n]
    best, best_x, best_y, tried = -1, 0, 0, 0
    for w in range(own.shape[0]):
        word = own[w]
        while word != ZERO:
            other = (w << 6) + lowest_bit(word)
            word &= ~bit(other)
            x, y = (place, other) if place < n else (other, place - n)
            left = _pairs_left(problem, relation, x, y)
            tried += 1
            if left > best:
                best, best_x, best_y = left, x, y
    return best_x, best_y, tried * n


@kernel
def _pairs_left(problem, relation, x, y):
    """Number of possible pairs that are compatible with (x, y)."""
    s, total = problem.runs.slot[x, y], 0
    for i in range(relation.rows.shape[0]):
        low, high = problem.runs.over_x[s, i, 0], problem.runs.over_x[s, i, 1]
        for w in range(relation.rows.shape[1]):
            total += popcount((problem.Y.prefixes[y, low, w] ^ problem.Y.prefixes[y, high, w]) & relation.rows[i, w])
    return total


@kernel
def _read(relation, stack, depth, f, g):
    """Read a map each way from rows and columns with one pair, and from the decisions."""
    for x in range(f.shape[0]):
        f[x] = first_point(relation.rows[x])
    for y in range(g.shape[0]):
        g[y] = first_point(relation.columns[y])
    for d in range(depth):
        x, y = stack.decisions[d, 0], stack.decisions[d, 1]
        f[x], g[y] = y, x
