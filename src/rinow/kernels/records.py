"""Records of varying size in a block of bytes: numbers, and lists led by their length (the body of a PLY file)."""

import numpy as np

from rinow.kernels._jit import kernel


@kernel
def list_length(data, position, size, big_endian):
    """The length that leads a list: an unsigned integer of 1, 2 or 4 bytes, a float64 of 8; -1 if it is no length.

    Signed lengths read the same: a negative one becomes a large one, which no file holds.
    """
    if size == 8:
        value = data[position : position + 8].view(np.float64)[0]
        return np.int64(value) if 0.0 <= value < 2.0**31 and value == np.floor(value) else np.int64(-1)
    n = np.int64(0)
    for k in range(size):
        n = 256 * n + data[position + (k if big_endian else size - 1 - k)]
    return n


@kernel
def list_spans(data, position, n_rows, length_sizes, item_sizes, big_endian, wanted, starts, lengths):
    """Walk n_rows records; write where the items of property `wanted` start and how many there are.

    A property p with length_sizes[p] == 0 is one number.  Return the number of whole records and their end.
    """
    for row in range(n_rows):
        for p in range(length_sizes.shape[0]):
            n = np.int64(1)
            if length_sizes[p] > 0:
                if position + length_sizes[p] > data.shape[0]:
                    return row, position
                n = list_length(data, position, length_sizes[p], big_endian)
                if n < 0:
                    return row, position
                position += length_sizes[p]
            if p == wanted:
                starts[row], lengths[row] = position, n
            position += n * item_sizes[p]
            if position > data.shape[0]:
                return row, position
    return n_rows, position


@kernel
def gather_spans(data, starts, sizes, out):
    """Write the bytes data[starts[i] : starts[i] + sizes[i]] one span after another to out."""
    position = 0
    for i in range(starts.shape[0]):
        for k in range(sizes[i]):
            out[position + k] = data[starts[i] + k]
        position += sizes[i]
