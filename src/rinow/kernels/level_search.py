"""Branch and bound at one level between spaces with few distances, such as numbers of steps in graphs.

For each point and each distance of the other space the points at a distance that agrees are listed once, as bits.  So
one decision costs an intersection for each row and column.  What the pairs of a row support is united once for each
distance; then every other row is intersected with the union for its distance from that row.  Each node is a
hundred times cheaper than with the runs of `compatibility`, which any distances have.
"""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import inner, kernel
from rinow.kernels.bitsets import ONE, ZERO, bit, contains, first_point, insert, lowest_bit, popcount
from rinow.kernels.correspondence_search import EXHAUSTED, FOUND, PAUSED, fixes
from rinow.kernels.correspondences import Relation, take_out

DEPTH, NODES, LIMIT, REFUTED = range(4)
"""Places in the progress: decisions made; nodes since the last restart, and how many are allowed; pairs refuted at the
root."""

THOROUGH_DEPTH, LARGE_COUNT = 1, 12
"""Decisions up to which every row supports the others; below them only rows with few pairs left, since others rarely
exclude anything.  So many pairs are united, the support by more of them is looked up where these do not suffice."""


class Side(NamedTuple):
    """One space, and which of its points agree with the distances of the other one."""

    codes: Any  # (n, n) int: the distances, as places in the list of those that occur
    near: Any  # (n, n_distances of the other space * words) uint64: the sets for one point stand in one row


class Problem(NamedTuple):
    """What does not change during a search."""

    X: Any  # Side
    Y: Any  # Side
    isometries_x: Any  # (k, n), the identity first
    isometries_y: Any  # (l, m)


class Stack(NamedTuple):
    """What is possible at each depth, the decisions that led there, and room for the marks of changed rows."""

    rows: Any  # (depth, n, words of Y)
    columns: Any  # (depth, m, words of X)
    row_counts: Any
    column_counts: Any
    decisions: Any  # (depth, 2)
    changed_rows: Any  # (n,) bool
    changed_columns: Any  # (m,) bool
    near_row: Any  # (n_distances of X * words of Y,): what the pairs of a row support
    near_column: Any  # (n_distances of Y * words of X,)


@kernel
def agreeing(distances, values, level, out):
    """Write to out[i, a] the set of points at a distance from i within the level of values[a]."""
    for i in range(distances.shape[0]):
        for a in range(values.shape[0]):
            out[i, a] = ZERO
            for j in range(distances.shape[0]):
                if abs(values[a] - distances[i, j]) <= level:
                    insert(out[i, a], j)


@kernel
def begin(problem, stack, weights):
    """Arc consistency at the root; whether it does not refute the level."""
    stack.changed_rows[:] = True
    stack.changed_columns[:] = True
    return _propagate(problem, stack, 0, weights)[0]


@kernel
def search(problem, stack, progress, weights, budget):
    """Go on until so many words of sets are compared, a relation is found (the decisions), or nothing is left."""
    spent = 0
    while spent < budget:
        if progress[NODES] >= progress[LIMIT]:
            progress[DEPTH] = progress[NODES] = 0
            progress[LIMIT] += progress[LIMIT] // 2
        depth = progress[DEPTH]
        place = _choose(stack, depth, weights)
        if place < 0:
            return FOUND
        progress[NODES] += 1
        alive, work = _decide(problem, stack, depth, place, weights)
        spent += work
        if alive:
            progress[DEPTH] += 1
            continue
        while not alive:
            alive, work = _refute(problem, stack, progress[DEPTH], weights)
            spent += work
            progress[REFUTED] += 1 if progress[DEPTH] == 0 else 0
            if not alive and progress[DEPTH] == 0:
                return EXHAUSTED
            if not alive:
                progress[DEPTH] -= 1
    return PAUSED


@inner
def _relation(stack, depth):
    """What is possible after so many decisions."""
    return Relation(stack.rows[depth], stack.columns[depth], stack.row_counts[depth], stack.column_counts[depth])


@inner
def _choose(stack, depth, weights):
    """Row, or n + column, without a decision and with the fewest possible pairs for its weight; -1 if all have one."""
    n, m = stack.rows.shape[1], stack.columns.shape[1]
    decided = np.zeros(n + m, np.bool_)
    for d in range(depth):
        decided[stack.decisions[d, 0]] = True
        decided[n + stack.decisions[d, 1]] = True
    best, chosen = np.inf, -1
    for place in range(n + m):
        count = stack.row_counts[depth, place] if place < n else stack.column_counts[depth, place - n]
        if not decided[place] and count / weights[place] < best:
            best, chosen = count / weights[place], place
    return chosen


@inner
def _decide(problem, stack, depth, place, weights):
    """Decide for the first pair of a row or column and write what it leaves; whether that is not nothing; the work."""
    n = stack.rows.shape[1]
    x = place if place < n else first_point(stack.columns[depth, place - n])
    y = place - n if place >= n else first_point(stack.rows[depth, place])
    stack.decisions[depth, 0], stack.decisions[depth, 1] = x, y
    X, Y, now, after = problem.X, problem.Y, _relation(stack, depth), _relation(stack, depth + 1)
    rows = (now.rows, now.row_counts, after.rows, after.row_counts, stack.changed_rows)
    emptied = _intersect(*rows, Y.near[y], X.codes[x])
    if emptied < 0:
        columns = (now.columns, now.column_counts, after.columns, after.column_counts, stack.changed_columns)
        emptied = _intersect(*columns, X.near[x], Y.codes[y])
        emptied += n if emptied >= 0 else 0
    compared = stack.rows.shape[1] * stack.rows.shape[2] + stack.columns.shape[1] * stack.columns.shape[2]
    if emptied >= 0:
        weights[emptied] += 1.0
        return False, compared
    alive, work = _propagate(problem, stack, depth + 1, weights)
    return alive, work + compared


@inner
def _refute(problem, stack, depth, weights):
    """Delete the pair decided at a depth and its images under the isometries that fix the earlier decisions.

    Whether something is left, and the work.
    """
    relation, (x, y) = _relation(stack, depth), (stack.decisions[depth, 0], stack.decisions[depth, 1])
    stack.changed_rows[:] = False
    stack.changed_columns[:] = False
    for i in range(problem.isometries_x.shape[0]):
        if not fixes(problem.isometries_x[i], stack.decisions, depth, 0):
            continue
        for j in range(problem.isometries_y.shape[0]):
            image_x, image_y = problem.isometries_x[i, x], problem.isometries_y[j, y]
            if contains(relation.rows[image_x], image_y) and fixes(problem.isometries_y[j], stack.decisions, depth, 1):
                _delete(relation, stack, image_x, image_y)
    if relation.row_counts.min() == 0 or relation.column_counts.min() == 0:
        return False, 1
    return _propagate(problem, stack, depth, weights)


@inner
def _delete(relation, stack, x, y):
    """Take a pair out and mark its row and column."""
    take_out(relation, x, y)
    stack.changed_rows[x] = True
    stack.changed_columns[y] = True


@inner
def _intersect(sets, counts, out, out_counts, changed, near, codes):
    """Intersect the sets with those of points near enough, and mark what changed; the place of an empty one, or -1."""
    for i in range(sets.shape[0]):
        count = 0
        for w in range(sets.shape[1]):
            out[i, w] = sets[i, w] & near[codes[i] * sets.shape[1] + w]
            count += popcount(out[i, w])
        out_counts[i] = count
        changed[i] = count != counts[i]
        if count == 0:
            return i
    return -1


@inner
def _propagate(problem, stack, depth, weights):
    """Delete what the marked rows and columns do not support, until none is marked; whether all keep a pair; the work.

    The weights of an emptied row or column and of the one that emptied it grow.
    """
    relation, n, m = _relation(stack, depth), stack.rows.shape[1], stack.columns.shape[1]
    most = n + m if depth <= THOROUGH_DEPTH else LARGE_COUNT
    work, changed = 0, True
    while changed:
        changed = False
        for place in range(n + m):
            marks, at = (stack.changed_rows, place) if place < n else (stack.changed_columns, place - n)
            if not marks[at]:
                continue
            marks[at] = False
            if (relation.row_counts[at] if place < n else relation.column_counts[at]) > most:
                continue
            changed = True
            own, union = (relation.rows, stack.near_row) if place < n else (relation.columns, stack.near_column)
            work += own.shape[0] * own.shape[1] + LARGE_COUNT * union.shape[0]
            if place < n:
                rows = (relation.rows, at, problem.Y.near, problem.X.codes[at], stack.near_row)
                emptied = _support(relation, stack, *rows, True)
            else:
                columns = (relation.columns, at, problem.X.near, problem.Y.codes[at], stack.near_column)
                emptied = _support(relation, stack, *columns, False)
            if emptied >= 0:
                weights[emptied] += 1.0
                weights[place] += 1.0
                return False, work
    return True, work


@inner
def _support(relation, stack, sets, at, near, codes, union, by_rows):
    """Delete the pairs that agree with no pair of the row (column) at a place; an emptied row or n + column, or -1."""
    last = _unite(sets, at, near, union)
    for i in range(sets.shape[0]):
        for w in range(sets.shape[1]):
            without = sets[i, w] & ~union[codes[i] * sets.shape[1] + w]
            while without != ZERO:
                j = (w << 6) + lowest_bit(without)
                without &= without - ONE
                if _supported(sets, at, near, codes[i], j, last):
                    continue
                x, y = (i, j) if by_rows else (j, i)
                _delete(relation, stack, x, y)
                if relation.row_counts[x] == 0:
                    return x
                if relation.column_counts[y] == 0:
                    return relation.rows.shape[0] + y
    return -1


@inner
def _unite(sets, at, near, union):
    """Write to `union` what is near the first points of a set, for each distance; the last of these points."""
    union[:] = ZERO
    taken, last = 0, -1
    for w in range(sets.shape[1]):
        word = sets[at, w]
        while word != ZERO and taken < LARGE_COUNT:
            last = (w << 6) + lowest_bit(word)
            word &= word - ONE
            taken += 1
            for v in range(union.shape[0]):
                union[v] |= near[last, v]
    return last


@inner
def _supported(sets, at, near, code, j, last):
    """Whether point j is near a point of a set after the last one that was united."""
    for w in range((last + 1) >> 6, sets.shape[1]):
        word = sets[at, w] & near[j, code * sets.shape[1] + w]
        if w == (last + 1) >> 6:
            word &= ~(bit(last + 1) - ONE)
        if word != ZERO:
            return True
    return False
