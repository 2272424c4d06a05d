"""Relations between two spaces as sets of pairs that are still possible, and what arc consistency takes away from them.

A pair stays possible only while every x' and every y' has a possible pair compatible with it.  Pairs of a
correspondence within the level never leave, so an emptied row or column refutes the level.
"""

from typing import Any, NamedTuple

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.bitsets import ZERO, bit, contains, discard, lowest_bit, popcount, size

UNFINISHED = -2
"""Mark of a propagation that stopped between two passes."""


class Relation(NamedTuple):
    """Possible pairs, by rows and by columns, with their counts."""

    rows: Any  # (n, words of Y) uint64
    columns: Any  # (m, words of X) uint64
    row_counts: Any  # (n,) int64
    column_counts: Any  # (m,) int64


class Queue(NamedTuple):
    """Rows and columns that lost a pair since they were last looked at, and room to list them."""

    rows: Any  # (n,) bool
    columns: Any  # (m,) bool
    row_list: Any  # (n,) int64
    column_list: Any  # (m,) int64


@kernel
def take_out(relation, x, y):
    """Take the pair (x, y) out."""
    discard(relation.rows[x], y)
    discard(relation.columns[y], x)
    relation.row_counts[x] -= 1
    relation.column_counts[y] -= 1


@kernel
def delete(relation, queue, x, y):
    """Take the pair (x, y) out and mark its row and column."""
    take_out(relation, x, y)
    queue.rows[x] = True
    queue.columns[y] = True


@kernel
def mark_all(queue):
    """Mark every row and column."""
    queue.rows[:] = True
    queue.columns[:] = True


@kernel
def clear(queue):
    """Unmark everything."""
    queue.rows[:] = False
    queue.columns[:] = False


@kernel
def listed(marks, counts, out):
    """Move the marks to a list that ascends by count; return its length."""
    n = 0
    for i in range(marks.shape[0]):
        if not marks[i]:
            continue
        marks[i] = False
        k = n
        while k > 0 and counts[out[k - 1]] > counts[i]:
            out[k] = out[k - 1]
            k -= 1
        out[k] = i
        n += 1
    return n


@kernel
def missing_support(s, places, n_places, runs, prefixes, at, sets):
    """First listed place whose possible pairs are all incompatible with pair s, or -1."""
    for i in range(n_places):
        place = places[i]
        low, high = runs[s, place, 0], runs[s, place, 1]
        found = ZERO
        for w in range(sets.shape[1]):
            found |= (prefixes[at, low, w] ^ prefixes[at, high, w]) & sets[place, w]
        if found == ZERO:
            return place
    return -1


@kernel
def propagate(relation, queue, runs, X, Y, both, weights, most_work):
    """Arc consistency from the marked rows and columns on; what was emptied, and the work.

    The first value is the emptied row x, n + the emptied column, or -1; or UNFINISHED when so much work is done and
    rows or columns are still marked.  The weights of what caused a failure grow.  Without `both` only rows must keep a
    pair.
    """
    n, work = relation.rows.shape[0], 0
    while work < most_work:
        n_rows = listed(queue.rows, relation.row_counts, queue.row_list)
        n_columns = listed(queue.columns, relation.column_counts, queue.column_list)
        if not both:
            n_columns = 0
        if n_rows + n_columns == 0:
            return -1, work
        for x in range(n):
            for w in range(relation.rows.shape[1]):
                word = relation.rows[x, w]
                while word != ZERO:
                    y = (w << 6) + lowest_bit(word)
                    word &= ~bit(y)
                    work += n_rows + n_columns
                    s = runs.slot[x, y]
                    cause = missing_support(s, queue.row_list, n_rows, runs.over_x, Y.prefixes, y, relation.rows)
                    if cause < 0:
                        cause = missing_support(
                            s, queue.column_list, n_columns, runs.over_y, X.prefixes, x, relation.columns
                        )
                        if cause >= 0:
                            cause += n
                    if cause >= 0:
                        delete(relation, queue, x, y)
                        emptied = -1
                        if relation.row_counts[x] == 0:
                            emptied = x
                        elif both and relation.column_counts[y] == 0:
                            emptied = n + y
                        if emptied >= 0:
                            weights[emptied] += 1.0
                            weights[cause] += 1.0
                            clear(queue)
                            return emptied, work
    return UNFINISHED, work


@kernel
def restrict(relation, queue, runs, X, Y, x, y, both):
    """Keep the pairs compatible with (x, y); mark what changed; whether every row, with `both` column, keeps a pair."""
    s = runs.slot[x, y]
    rows = _restrict_sets(s, y, runs.over_x, Y.prefixes, relation.rows, relation.row_counts, queue.rows)
    columns = _restrict_sets(s, x, runs.over_y, X.prefixes, relation.columns, relation.column_counts, queue.columns)
    return rows and (columns or not both)


@kernel
def _restrict_sets(s, at, runs, prefixes, sets, counts, marks):
    """Intersect each set with its run; whether none is empty."""
    alive = True
    for place in range(sets.shape[0]):
        low, high = runs[s, place, 0], runs[s, place, 1]
        count = 0
        for w in range(sets.shape[1]):
            sets[place, w] &= prefixes[at, low, w] ^ prefixes[at, high, w]
            count += popcount(sets[place, w])
        if count != counts[place]:
            counts[place] = count
            marks[place] = True
        alive = alive and count > 0
    return alive


@parallel_kernel
def sweep(relation, queue, n_rows, n_columns, runs, X, Y, doomed):
    """Write to doomed the pairs without support in the listed rows and columns; nothing is changed."""
    for x in prange(relation.rows.shape[0]):
        for w in range(relation.rows.shape[1]):
            word, lost = relation.rows[x, w], ZERO
            while word != ZERO:
                y = (w << 6) + lowest_bit(word)
                word &= ~bit(y)
                s = runs.slot[x, y]
                if (
                    missing_support(s, queue.row_list, n_rows, runs.over_x, Y.prefixes, y, relation.rows) >= 0
                    or missing_support(s, queue.column_list, n_columns, runs.over_y, X.prefixes, x, relation.columns)
                    >= 0
                ):
                    lost |= bit(y)
            doomed[x, w] = lost


@kernel
def delete_all(relation, queue, doomed, both):
    """Take the doomed pairs out; whether every row, and with `both` every column, keeps one."""
    for x in range(doomed.shape[0]):
        for w in range(doomed.shape[1]):
            word = doomed[x, w]
            while word != ZERO:
                y = (w << 6) + lowest_bit(word)
                word &= ~bit(y)
                delete(relation, queue, x, y)
    return relation.row_counts.min() > 0 and (not both or relation.column_counts.min() > 0)


@kernel
def fill(possible, relation):
    """Set the relation from a matrix of bool."""
    relation.rows[:] = ZERO
    relation.columns[:] = ZERO
    for x in range(possible.shape[0]):
        for y in range(possible.shape[1]):
            if possible[x, y]:
                relation.rows[x, y >> 6] |= bit(y)
                relation.columns[y, x >> 6] |= bit(x)
    for x in range(possible.shape[0]):
        relation.row_counts[x] = size(relation.rows[x])
    for y in range(possible.shape[1]):
        relation.column_counts[y] = size(relation.columns[y])


@kernel
def unpack(relation, possible):
    """Write the relation to a matrix of bool."""
    for x in range(possible.shape[0]):
        for y in range(possible.shape[1]):
            possible[x, y] = contains(relation.rows[x], y)
