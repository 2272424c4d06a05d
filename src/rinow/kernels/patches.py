"""An order of the vertices in which neighbours lie close together in memory."""

import numpy as np

from rinow.kernels._jit import kernel


@kernel
def patch_order(offsets, neighbours, size):
    """Vertices patch by patch; each patch grows breadth first, up to `size`, from a vertex beside the earlier ones."""
    n = offsets.shape[0] - 1
    order, seeds = np.empty(n, np.intp), np.empty(n, np.intp)
    placed, queued = np.zeros(n, np.bool_), np.zeros(n, np.bool_)
    n_placed = n_seeds = next_seed = start = 0
    while n_placed < n:
        if next_seed < n_seeds:
            seed = seeds[next_seed]
            next_seed += 1
        else:  # another component
            seed = start
            start += 1
        if placed[seed]:
            continue
        order[n_placed], placed[seed] = seed, True
        head, last = n_placed, n_placed + size
        n_placed += 1
        while head < n_placed:
            for w in neighbours[offsets[order[head]] : offsets[order[head] + 1]]:
                if not placed[w] and n_placed < last:
                    order[n_placed], placed[w] = w, True
                    n_placed += 1
                elif not placed[w] and not queued[w]:
                    seeds[n_seeds], queued[w] = w, True
                    n_seeds += 1
            head += 1
    return order
