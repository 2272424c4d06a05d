"""The bijection of least total cost, as far as the time reaches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.engine import blocks
from rinow.kernels import assignment

__all__ = ["assigned"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def assigned(costs: Floats, clock: Clock) -> Indices:
    """The column of each row of a square matrix of finite costs; when the time is over, the rest finds a free one.

    As `scipy.optimize.linear_sum_assignment`, which cannot be stopped and may take minutes for some thousand rows.
    """
    n = len(costs)
    columns, rows, before, remaining = (np.empty(n, np.int64) for _ in range(4))
    prices, other_prices, shortest = (np.empty(n) for _ in range(3))
    state = assignment.Assignment(
        np.ascontiguousarray(costs), columns, rows, prices, other_prices, shortest, before, remaining
    )
    assignment.begin(state)
    alone = np.flatnonzero(columns == assignment.FREE)
    for part in blocks(len(alone), n * n, clock):
        assignment.augment_rows(state, alone[part])
    alone, free = np.flatnonzero(columns == assignment.FREE), np.flatnonzero(rows == assignment.FREE)
    columns[alone] = free
    return columns.astype(np.intp)
