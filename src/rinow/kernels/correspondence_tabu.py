"""Tabu search for a pair of maps f: X → Y, g: Y → X whose graphs together have small distortion.

The excess of a pair over a target t is max(0, |d(x, x') - d(y, y')| - t).  A table holds for every (x, y) the sum of
its excesses with all n + m pairs of the two graphs; one move changes the image of one point and updates two rows of
numbers a point.  The table is in single precision: it only guides the search, what is found is measured in double.
"""

from typing import Any, NamedTuple

import numpy as np

from rinow.kernels._jit import kernel

CANDIDATES = 24
"""Pairs in conflict that are looked at before a move."""

NO_CONFLICT = np.float32(1e-6)
"""Excess, in diameters, that counts as none: rounding of sums in single precision."""

MOVE, TOTAL_STALL = 0, 1
"""Places in the counters: moves made; moves since the total was last improved."""


class Tabu(NamedTuple):
    """State of one search; distances are in units of the larger diameter."""

    X: Any  # (n, n) float32
    Y: Any  # (m, m) float32
    table: Any  # (n, m) float32
    f: Any  # (n,)
    g: Any  # (m,)
    until_f: Any  # (n, m) int64: move until which an image is forbidden
    until_g: Any  # (m, n) int64
    random: Any  # (1,) uint64
    counters: Any  # (2,) int64
    totals: Any  # (2,) float64: present and best total


@kernel
def random_below(state, n):
    """Random integer in [0, n) by xorshift (Marsaglia 2003)."""
    word = state[0]
    word ^= (word << np.uint64(13)) & np.uint64(0xFFFFFFFFFFFFFFFF)
    word ^= word >> np.uint64(7)
    word ^= (word << np.uint64(17)) & np.uint64(0xFFFFFFFFFFFFFFFF)
    state[0] = word
    return int((word >> np.uint64(11)) % np.uint64(n))


@kernel
def keep_at_random(state, found, item, kept):
    """Keep the next item of a sequence, of which `found` came before, so that all are kept with the same chance."""
    if found < kept.shape[0]:
        kept[found] = item
    else:
        place = random_below(state, found + 1)
        if place < kept.shape[0]:
            kept[place] = item


@kernel
def excess(a, b, t):
    """By how much two distances differ beyond t."""
    gap = abs(a - b) - t
    return gap if gap > np.float32(0.0) else np.float32(0.0)


@kernel
def _add_pair(tabu, x, y, t):
    """Add the excesses of the pair (x, y) to the table."""
    for a in range(tabu.table.shape[0]):
        d, row, out = tabu.X[x, a], tabu.Y[y], tabu.table[a]
        for b in range(out.shape[0]):
            out[b] += excess(d, row[b], t)


@kernel
def _replace_pair(tabu, x, y, new_x, new_y, t):
    """Replace the excesses of one pair in the table by those of another."""
    old_row, new_row = tabu.Y[y], tabu.Y[new_y]
    for a in range(tabu.table.shape[0]):
        old, new, out = tabu.X[x, a], tabu.X[new_x, a], tabu.table[a]
        for b in range(out.shape[0]):
            out[b] += excess(new, new_row[b], t) - excess(old, old_row[b], t)


@kernel
def rebuild(tabu, t):
    """Compute table and total afresh."""
    tabu.table[:] = np.float32(0.0)
    for x in range(tabu.f.shape[0]):
        _add_pair(tabu, x, tabu.f[x], t)
    for y in range(tabu.g.shape[0]):
        _add_pair(tabu, tabu.g[y], y, t)
    tabu.totals[0] = _total(tabu)


@kernel
def _total(tabu):
    """Sum of the excesses of all pairs."""
    total = 0.0
    for x in range(tabu.f.shape[0]):
        total += tabu.table[x, tabu.f[x]]
    for y in range(tabu.g.shape[0]):
        total += tabu.table[tabu.g[y], y]
    return total


@kernel
def _conflicts(tabu, chosen):
    """Choose up to CANDIDATES pairs in conflict at random; how many were chosen and how many there are."""
    n, m, found = tabu.f.shape[0], tabu.g.shape[0], 0
    for p in range(n + m):
        value = tabu.table[p, tabu.f[p]] if p < n else tabu.table[tabu.g[p - n], p - n]
        if value > NO_CONFLICT:
            keep_at_random(tabu.random, found, p, chosen)
            found += 1
    return min(found, CANDIDATES), found


@kernel
def _best_move(tabu, chosen, n_chosen, t):
    """Pair and new image with the best change of the total among those that are not forbidden; the change."""
    n, move = tabu.f.shape[0], tabu.counters[MOVE]
    best, pair, image = np.inf, -1, -1
    for c in range(n_chosen):
        p = chosen[c]
        here = tabu.f[p] if p < n else tabu.g[p - n]
        row = tabu.Y[here] if p < n else tabu.X[here]
        until = tabu.until_f[p] if p < n else tabu.until_g[p - n]
        now = tabu.table[p, here] if p < n else tabu.table[here, p - n]
        for image_new in range(row.shape[0]):
            value = tabu.table[p, image_new] if p < n else tabu.table[image_new, p - n]
            change = value - excess(np.float32(0.0), row[image_new], t) - now
            if change < best and image_new != here:
                allowed = until[image_new] <= move or tabu.totals[0] + 2.0 * change < tabu.totals[1]
                if allowed:
                    best, pair, image = change, p, image_new
    return best, pair, image


@kernel
def _make_move(tabu, p, image, t, tenure):
    """Give a point its new image and forbid the old one for a while."""
    n = tabu.f.shape[0]
    until = tabu.counters[MOVE] + tenure
    if p < n:
        _replace_pair(tabu, p, tabu.f[p], p, image, t)
        tabu.until_f[p, tabu.f[p]] = until
        tabu.f[p] = image
    else:
        y = p - n
        _replace_pair(tabu, tabu.g[y], y, image, y, t)
        tabu.until_g[y, tabu.g[y]] = until
        tabu.g[y] = image


@kernel
def note_best(tabu):
    """Note the total if it is less than all before, beyond rounding; whether it is."""
    if not tabu.totals[0] < tabu.totals[1] - 1e-7:
        return False
    tabu.totals[1] = tabu.totals[0]
    tabu.counters[TOTAL_STALL] = 0
    return True


@kernel
def descend(tabu, t, n_moves, best_f, best_g):
    """Make up to n_moves moves; whether the target was met.  The maps with the least total are kept."""
    chosen = np.empty(CANDIDATES, np.int64)
    for _ in range(n_moves):
        n_chosen, found = _conflicts(tabu, chosen)
        if found == 0:
            return True
        change, p, image = _best_move(tabu, chosen, n_chosen, t)
        tabu.counters[MOVE] += 1
        tabu.counters[TOTAL_STALL] += 1
        if p < 0:
            continue
        _make_move(tabu, p, image, t, 7 + random_below(tabu.random, 10) + found // 2)
        tabu.totals[0] += 2.0 * change
        if tabu.counters[MOVE] % 1024 == 0:
            rebuild(tabu, t)
        if note_best(tabu):
            best_f[:] = tabu.f
            best_g[:] = tabu.g
    return False


@kernel
def perturb(tabu, n_changes):
    """Give random images to some points."""
    n, m = tabu.f.shape[0], tabu.g.shape[0]
    for _ in range(n_changes):
        p = random_below(tabu.random, n + m)
        if p < n:
            tabu.f[p] = random_below(tabu.random, m)
        else:
            tabu.g[p - n] = random_below(tabu.random, n)
