"""Linear assignment by shortest augmenting paths (Jonker, Volgenant 1987), some rows at a time."""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import kernel

FREE = -1


class Assignment(NamedTuple):
    """Rows and columns that belong together, prices that prove it, and scratch."""

    cost: Any  # (n, n) float64
    column_of: Any  # (n,) int64, FREE while a row has none
    row_of: Any  # (n,) int64
    row_price: Any  # (n,)
    column_price: Any  # (n,)
    shortest: Any  # (n,) length of the shortest path to each column
    before: Any  # (n,) int64: row from which that path comes
    remaining: Any  # (n,) int64: columns not reached yet


@kernel
def begin(a):
    """Prices below all costs, and each row to its cheapest column if that is free."""
    n = a.cost.shape[0]
    a.column_price[:] = np.inf
    for i in range(n):
        for j in range(n):
            a.column_price[j] = min(a.column_price[j], a.cost[i, j])
    a.column_of[:], a.row_of[:] = FREE, FREE
    for i in range(n):
        least, best = np.inf, 0
        for j in range(n):
            gap = a.cost[i, j] - a.column_price[j]
            if gap < least:
                least, best = gap, j
        a.row_price[i] = least
        if a.row_of[best] == FREE:
            a.row_of[best], a.column_of[i] = i, best


@kernel
def _path_from(a, start):
    """Shortest path from a row to a free column, by reduced costs: the column, its length, and how many are left."""
    n_left = a.cost.shape[0]
    for j in range(n_left):
        a.remaining[j], a.shortest[j] = j, np.inf
    i, length = start, 0.0
    while True:
        least, place = np.inf, -1
        offset = length - a.row_price[i]
        for k in range(n_left):
            j = a.remaining[k]
            total = offset + a.cost[i, j] - a.column_price[j]
            if total < a.shortest[j]:
                a.shortest[j], a.before[j] = total, i
            if a.shortest[j] < least or (a.shortest[j] == least and a.row_of[j] == FREE):
                least, place = a.shortest[j], k
        length, column = least, a.remaining[place]
        n_left -= 1
        a.remaining[place], a.remaining[n_left] = a.remaining[n_left], column
        if a.row_of[column] == FREE:
            return column, length, n_left
        i = a.row_of[column]


@kernel
def augment(a, start):
    """Give a row a column; others may change theirs.  Costs are finite."""
    column, length, n_left = _path_from(a, start)
    a.row_price[start] += length
    for k in range(n_left, a.cost.shape[0]):
        j = a.remaining[k]
        if j != column:
            a.row_price[a.row_of[j]] += length - a.shortest[j]
            a.column_price[j] -= length - a.shortest[j]
    while True:
        i = a.before[column]
        a.row_of[column] = i
        a.column_of[i], column = column, a.column_of[i]
        if i == start:
            return


@kernel
def augment_rows(a, rows):
    """The same for some rows without a column."""
    for t in range(rows.shape[0]):
        augment(a, rows[t])
