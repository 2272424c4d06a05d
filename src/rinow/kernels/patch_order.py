"""Orders of the vertices in which neighbours lie close together in memory."""

import numpy as np

from rinow.kernels._jit import kernel, lean, parallel_kernel, prange

DIGITS = 1 << 11
"""Values of a digit that numbers are sorted by."""


@lean
def spread_bits(x):
    """The ten bits of a number with two zeros before each."""
    x = (x | x << 16) & 0x030000FF
    x = (x | x << 8) & 0x0300F00F
    x = (x | x << 4) & 0x030C30C3
    return (x | x << 2) & 0x09249249


@parallel_kernel
def morton_codes(points, low, size, codes):
    """Write the place of each point's cell, of a grid of 1024³, on a curve through neighbouring cells."""
    for i in prange(len(points)):
        code = 0
        for axis in range(3):
            cell = min(int((points[i, axis] - low[axis]) / size * 1024), 1023)
            code |= spread_bits(cell) << axis
        codes[i] = code


@kernel
def stable_order(keys, order):
    """Write the stable order of keys of 32 bits: they are sorted by their digits of 11 bits, the last ones first."""
    n, last = len(keys), DIGITS - 1
    places, pairs, spare = np.zeros((3, DIGITS + 1), np.int64), np.empty(n, np.int64), np.empty(n, np.int64)
    for i in range(n):
        key = np.int64(keys[i])
        pairs[i] = key << 31 | i
        for k in range(3):
            places[k, (key >> 11 * k & last) + 1] += 1
    for k in range(3):
        for digit in range(DIGITS):
            places[k, digit + 1] += places[k, digit]
        for i in range(n):
            digit = pairs[i] >> 31 + 11 * k & last
            spare[places[k, digit]] = pairs[i]
            places[k, digit] += 1
        pairs, spare = spare, pairs
    for i in range(n):
        order[i] = pairs[i] & 0x7FFFFFFF


@parallel_kernel
def spread_out(rows, index, out):
    """Write each row to the place that the index says."""
    for i in prange(len(rows)):
        for k in range(rows.shape[1]):
            out[index[i], k] = rows[i, k]


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
