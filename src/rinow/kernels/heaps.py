"""A binary heap in a row of records: the least distance stands first."""

import numpy as np

from rinow.kernels._jit import kernel

ENTRY = np.dtype([("distance", np.float64), ("slot", np.int64)])


@kernel
def push(heap, n, distance, slot):
    """Add an entry to the first n."""
    i = n
    while i > 0 and distance < heap[(i - 1) // 2]["distance"]:
        up = (i - 1) // 2
        heap[i]["distance"], heap[i]["slot"] = heap[up]["distance"], heap[up]["slot"]
        i = up
    heap[i]["distance"], heap[i]["slot"] = distance, slot


@kernel
def pop(heap, n):
    """Remove the least of the first n entries, which must not be empty, and return its slot."""
    slot = heap[0]["slot"]
    distance, last = heap[n - 1]["distance"], heap[n - 1]["slot"]
    i, child = 0, 1
    while child < n - 1:
        if child + 1 < n - 1 and heap[child + 1]["distance"] < heap[child]["distance"]:
            child += 1
        if distance <= heap[child]["distance"]:
            break
        heap[i]["distance"], heap[i]["slot"] = heap[child]["distance"], heap[child]["slot"]
        i, child = child, 2 * child + 1
    heap[i]["distance"], heap[i]["slot"] = distance, last
    return slot
