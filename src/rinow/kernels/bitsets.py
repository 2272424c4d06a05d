"""Sets of points as rows of 64-bit words: point j is bit j % 64 of word j // 64."""

from typing import Any

import numpy as np
from numba import config
from numba.core import types
from numba.extending import intrinsic

from rinow.kernels._jit import kernel

ONE, ZERO, LOW = np.uint64(1), np.uint64(0), np.uint64(63)

if config.DISABLE_JIT:

    def popcount(word: Any) -> int:
        """Number of bits that are set."""
        return int(word).bit_count()

    def lowest_bit(word: Any) -> int:
        """Place of the lowest bit of a word that is not 0."""
        return (int(word) & -int(word)).bit_length() - 1

else:

    @intrinsic
    def popcount(typing_context, word):
        """Number of bits that are set: one machine instruction that numba offers no other way to."""

        def generate(context, builder, signature, arguments):
            return builder.ctpop(arguments[0])

        return types.int64(types.uint64), generate

    @intrinsic
    def lowest_bit(typing_context, word):
        """Place of the lowest bit of a word that is not 0."""

        def generate(context, builder, signature, arguments):
            return builder.cttz(arguments[0], context.get_constant(types.boolean, True))

        return types.int64(types.uint64), generate


@kernel
def bit(j):
    """The word with bit j % 64."""
    return ONE << (np.uint64(j) & LOW)


@kernel
def contains(words, j):
    """Whether point j is in the set."""
    return (words[j >> 6] & bit(j)) != ZERO


@kernel
def insert(words, j):
    """Put point j into the set."""
    words[j >> 6] |= bit(j)


@kernel
def discard(words, j):
    """Take point j out of the set."""
    words[j >> 6] &= ~bit(j)


@kernel
def size(words):
    """Number of points in the set."""
    total = 0
    for w in range(words.shape[0]):
        total += popcount(words[w])
    return total


@kernel
def prefixes(order, out):
    """Write to out[i, k] the set of the first k points of order[i]."""
    for i in range(order.shape[0]):
        out[i, 0] = ZERO
        for k in range(order.shape[1]):
            out[i, k + 1] = out[i, k]
            insert(out[i, k + 1], order[i, k])


@kernel
def first_point(words):
    """First point of a set, -1 if it is empty."""
    for w in range(words.shape[0]):
        if words[w] != ZERO:
            return (w << 6) + lowest_bit(words[w])
    return -1
