"""Tabu search for a bijection f: X → Y under which the logarithms of the distances agree.

As in `correspondence_tabu` a table holds for every (x, y) the sum of its excesses over a target with all pairs (k,
f(k)); a move exchanges the images of two points.
"""

import numpy as np

from rinow.kernels._jit import kernel
from rinow.kernels.correspondence_tabu import (
    CANDIDATES,
    MOVE,
    NO_CONFLICT,
    TOTAL_STALL,
    excess,
    keep_at_random,
    note_best,
    random_below,
)


@kernel
def rebuild(tabu, t):
    """Compute table and total afresh."""
    tabu.table[:] = np.float32(0.0)
    for k in range(tabu.f.shape[0]):
        for a in range(tabu.f.shape[0]):
            d, row, out = tabu.X[k, a], tabu.Y[tabu.f[k]], tabu.table[a]
            for b in range(out.shape[0]):
                out[b] += excess(d, row[b], t)
    total = 0.0
    for k in range(tabu.f.shape[0]):
        total += tabu.table[k, tabu.f[k]]
    tabu.totals[0] = total


@kernel
def change_of_exchange(tabu, i, j, t):
    """Change of the total when i and j exchange their images."""
    fi, fj, zero = tabu.f[i], tabu.f[j], np.float32(0.0)
    own = excess(zero, tabu.Y[fi, fj], t)
    across = excess(tabu.X[i, j], zero, t)
    together = excess(tabu.X[i, j], tabu.Y[fi, fj], t)
    after = tabu.table[i, fj] + tabu.table[j, fi] - 2.0 * (own + across)
    return 2.0 * (after - tabu.table[i, fi] - tabu.table[j, fj] + 2.0 * together)


@kernel
def _exchange(tabu, i, j, t):
    """Exchange the images of i and j in map and table."""
    fi, fj = tabu.f[i], tabu.f[j]
    row_i, row_j = tabu.Y[fi], tabu.Y[fj]
    for a in range(tabu.f.shape[0]):
        di, dj, out = tabu.X[i, a], tabu.X[j, a], tabu.table[a]
        for b in range(out.shape[0]):
            out[b] += (
                excess(di, row_j[b], t) + excess(dj, row_i[b], t) - excess(di, row_i[b], t) - excess(dj, row_j[b], t)
            )
    tabu.f[i], tabu.f[j] = fj, fi


@kernel
def _conflicts(tabu, chosen):
    """Choose up to CANDIDATES points in conflict at random; how many were chosen and how many there are."""
    found = 0
    for k in range(tabu.f.shape[0]):
        if tabu.table[k, tabu.f[k]] > NO_CONFLICT:
            keep_at_random(tabu.random, found, k, chosen)
            found += 1
    return min(found, CANDIDATES), found


@kernel
def _best_exchange(tabu, chosen, n_chosen, t):
    """Best exchange that is not forbidden; its change."""
    move, best, first, second = tabu.counters[MOVE], np.inf, -1, -1
    for c in range(n_chosen):
        i = chosen[c]
        for j in range(tabu.f.shape[0]):
            if j == i:
                continue
            change = change_of_exchange(tabu, i, j, t)
            if change < best:
                free = tabu.until_f[i, tabu.f[j]] <= move or tabu.until_f[j, tabu.f[i]] <= move
                if free or tabu.totals[0] + change < tabu.totals[1]:
                    best, first, second = change, i, j
    return best, first, second


@kernel
def descend(tabu, t, n_moves, best_f):
    """Make up to n_moves exchanges; whether the target was met.  The map with the least total is kept."""
    chosen = np.empty(CANDIDATES, np.int64)
    for _ in range(n_moves):
        n_chosen, found = _conflicts(tabu, chosen)
        if found == 0:
            return True
        change, i, j = _best_exchange(tabu, chosen, n_chosen, t)
        tabu.counters[MOVE] += 1
        tabu.counters[TOTAL_STALL] += 1
        if i < 0:
            continue
        until = tabu.counters[MOVE] + 7 + random_below(tabu.random, 10) + found // 2
        tabu.until_f[i, tabu.f[i]] = until
        tabu.until_f[j, tabu.f[j]] = until
        _exchange(tabu, i, j, t)
        tabu.totals[0] += change
        if tabu.counters[MOVE] % 1024 == 0:
            rebuild(tabu, t)
        if note_best(tabu):
            best_f[:] = tabu.f
    return False


@kernel
def perturb(tabu, n_changes):
    """Exchange the images of random points."""
    n = tabu.f.shape[0]
    for _ in range(n_changes):
        i, j = random_below(tabu.random, n), random_below(tabu.random, n)
        tabu.f[i], tabu.f[j] = tabu.f[j], tabu.f[i]
