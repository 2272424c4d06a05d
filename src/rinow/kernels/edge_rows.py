"""Lengths of shortest paths along the edges of a graph from one node, or from several near each other at once.

Nodes wait in two lists (the near-far method): those near the front, in the order of their arrival, and those farther
away.  A node whose distance falls later is taken again, until nothing falls any more.  So the distances are those of
Dijkstra's algorithm to the bit: both end with the least sum of lengths, added from the source on.  Several sources have
their distances side by side, so that one look at an arc serves all of them; their fronts must pass a node at nearly the
same time.
"""

import numpy as np

from rinow.kernels._jit import inner, kernel, lean, parallel_kernel, prange

LANES = 32
"""Sources at once: four cache lines of distances."""


@inner
def work_space(n):
    """Work space for rows of a graph of n nodes: keys, the two lists, and which nodes wait."""
    return np.empty(n), np.empty(n + 1, np.int32), np.empty(n, np.int32), np.zeros(n, np.bool_)


@lean
def _lower(distances, u, v, length):
    """Let the distances of v be at most those by way of u; whether one fell."""
    fell = np.int64(0)
    for i in range(distances.shape[1]):  # not LANES: a loop of unknown length becomes vector code
        fell |= np.int64(distances[u, i] + length < distances[v, i])
    if fell == 0:
        return False
    for i in range(distances.shape[1]):
        s = distances[u, i] + length
        if s < distances[v, i]:
            distances[v, i] = s
    return True


@lean
def _advance(step, keys, near, far, n_far, end):
    """Move nodes up to a step beyond the least key from the far list to the near one; limit, and lengths of both."""
    limit, left = np.inf, 0
    for k in range(n_far):
        limit = min(limit, keys[far[k]])
    limit += step
    for k in range(n_far):
        v = far[k]
        if keys[v] <= limit:  # the step is 0 where all edges are
            near[end] = v
            end = end + 1 if end + 1 < near.shape[0] else 0
        else:
            far[left] = v
            left += 1
    return limit, left, end


@lean
def write_rows(sources, offsets, heads, lengths, step, distances, keys, near, far, waits):
    """Write to distances[v] the lengths of the shortest paths from the sources to v; for the rest see `work_space`."""
    distances[:] = np.inf
    start, end, n_far, limit, n = 0, 0, 0, step, near.shape[0]
    for i in range(sources.shape[0]):
        s = sources[i]
        distances[s, i] = 0.0
        if not waits[s]:
            waits[s], keys[s], near[end] = True, 0.0, s
            end += 1
    while start != end:
        u = near[start]
        start = start + 1 if start + 1 < n else 0
        waits[u] = False
        least = np.inf
        for i in range(distances.shape[1]):
            least = min(least, distances[u, i])
        for a in range(offsets[u], offsets[u + 1]):
            v = heads[a]
            if not _lower(distances, u, v, lengths[a]):
                continue
            key = least + lengths[a]
            if waits[v]:
                keys[v] = min(keys[v], key)
                continue
            waits[v], keys[v] = True, key
            if key < limit:
                near[end] = v
                end = end + 1 if end + 1 < n else 0
            else:
                far[n_far] = v
                n_far += 1
        if start == end and n_far > 0:
            limit, n_far, end = _advance(step, keys, near, far, n_far, end)


@kernel
def write_row(source, offsets, heads, lengths, step, distances, near, far, waits):
    """The same for one source."""
    distances[:] = np.inf
    start, end, n_far, limit, n = 0, 1, 0, step, near.shape[0]
    distances[source], waits[source], near[0] = 0.0, True, source
    while start != end:
        u = near[start]
        start = start + 1 if start + 1 < n else 0
        waits[u] = False
        d = distances[u]
        for a in range(offsets[u], offsets[u + 1]):
            v, new = heads[a], d + lengths[a]
            if not new < distances[v]:
                continue
            distances[v] = new
            if waits[v]:
                continue
            waits[v] = True
            if new < limit:
                near[end] = v
                end = end + 1 if end + 1 < n else 0
            else:
                far[n_far] = v
                n_far += 1
        if start == end and n_far > 0:
            limit, n_far, end = _advance(step, distances, near, far, n_far, end)


@parallel_kernel
def separate_rows(sources, graph, step, out):
    """Write to out[i] the distances of all nodes from source i."""
    _, near, far, waits = work_space(graph[0].shape[0] - 1)
    for i in prange(sources.shape[0]):
        write_row(sources[i], *graph, step, out[i], near, far, waits)
