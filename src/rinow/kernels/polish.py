"""Tabu search that moves the partners in a relation of large spaces to points near them, until no two pairs disagree.

The excess of a pair over a level t is the sum of max(0, |d(x, x') - d(y, y')| - t) over the pairs (x', y').  A move
takes a pair with excess, mostly the worst, to the best of the points near its free end.  There is no table: a move
costs as many steps as there are pairs, for each point that is tried.
"""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import inner, kernel
from rinow.kernels.correspondence_tabu import NO_CONFLICT, excess, random_below

WORST_OF, UPHILL, TENURE = 4, 8, 10
"""One move in so many takes any pair instead of the worst; one move uphill in so many is made; least moves of rest."""

RENEWED = 1000
"""Moves after which the excesses are computed anew: rounding of sums in single precision."""


class Polish(NamedTuple):
    """State of a search; the first pairs have a free end in Y, the others in X."""

    X: Any  # (n, n) float32
    Y: Any  # (m, m) float32
    near_x: Any  # (n, k) int32: the points nearest to each point, itself first
    near_y: Any  # (m, k) int32
    xs: Any  # (p,): the pairs
    ys: Any  # (p,)
    n_free_y: Any  # (1,): how many pairs have their free end in Y
    excesses: Any  # (p,) float32
    until: Any  # (p,): move until which a pair rests
    random: Any  # (1,) uint64


@inner
def _excess_of(row_x, row_y, xs, ys, t, limit):
    """Sum of the excesses of a pair with these distances, or some value from the limit on."""
    total, n = np.float32(0.0), xs.shape[0]
    for start in range(0, n, 64):
        for q in range(start, min(start + 64, n)):
            total += excess(row_x[xs[q]], row_y[ys[q]], t)
        if total >= limit:
            break
    return total


@kernel
def renew(polish, t):
    """Compute all excesses; their sum."""
    total = 0.0
    for p in range(polish.xs.shape[0]):
        x, y = polish.xs[p], polish.ys[p]
        polish.excesses[p] = _excess_of(polish.X[x], polish.Y[y], polish.xs, polish.ys, t, np.float32(np.inf))
        total += polish.excesses[p]
    return total


@inner
def _chosen_pair(polish, move):
    """The pair with the greatest excess that does not rest, or now and then any that has some; -1 if there is none."""
    any_pair, found, chosen, worst = random_below(polish.random, WORST_OF) == 0, 0, -1, NO_CONFLICT
    for p in range(polish.xs.shape[0]):
        if polish.excesses[p] <= NO_CONFLICT or polish.until[p] > move:
            continue
        found += 1
        if any_pair:
            if random_below(polish.random, found) == 0:
                chosen = p
        elif polish.excesses[p] > worst:
            chosen, worst = p, polish.excesses[p]
    return chosen


@inner
def _best_move(polish, p, t):
    """The pair in which pair p is changed best, and its excess."""
    x, y, least = polish.xs[p], polish.ys[p], np.float32(np.inf)
    best_x, best_y = x, y
    for k in range(1, polish.near_y.shape[1] if p < polish.n_free_y[0] else polish.near_x.shape[1]):
        a, b = (x, polish.near_y[y, k]) if p < polish.n_free_y[0] else (polish.near_x[x, k], y)
        own = excess(polish.X[a, x], polish.Y[b, y], t)
        value = _excess_of(polish.X[a], polish.Y[b], polish.xs, polish.ys, t, least + own) - own
        if value < least:
            least, best_x, best_y = value, a, b
    return best_x, best_y, least


@inner
def _replace(polish, p, x, y, value, t):
    """Change a pair and the excesses of all others; the sum of them all."""
    old_x, old_y, new_x, new_y = polish.X[polish.xs[p]], polish.Y[polish.ys[p]], polish.X[x], polish.Y[y]
    total = 0.0
    for q in range(polish.xs.shape[0]):
        a, b = polish.xs[q], polish.ys[q]
        if q != p:
            polish.excesses[q] += excess(new_x[a], new_y[b], t) - excess(old_x[a], old_y[b], t)
            total += max(polish.excesses[q], np.float32(0.0))
    polish.xs[p], polish.ys[p], polish.excesses[p] = x, y, value
    return total + value


@kernel
def search(polish, t, n_moves, best_total, best_xs, best_ys):
    """Make so many moves, or fewer when nothing is left to move; the least sum of excesses, whose pairs are written."""
    for move in range(n_moves):
        p = _chosen_pair(polish, move)
        if p < 0:
            continue
        x, y, value = _best_move(polish, p, t)
        polish.until[p] = move + TENURE + random_below(polish.random, 2 * TENURE)
        if value > polish.excesses[p] and random_below(polish.random, UPHILL) > 0:
            continue
        total = _replace(polish, p, x, y, value, t)
        if move % RENEWED == RENEWED - 1:
            total = renew(polish, t)
        if total < best_total:
            best_total = total
            best_xs[:], best_ys[:] = polish.xs, polish.ys
            if total <= NO_CONFLICT:
                break
    return best_total
