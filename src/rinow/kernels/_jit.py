"""One compilation policy for all kernels.

A scalar kernel that only kernels call is `inner`: the code that makes Python objects numbers and arrays is left out,
which for named tuples of many arrays takes longer to compile than the kernel itself.  If it makes no array it is
`lean`: numba then does not count who has the arrays it looks at, which takes a locked addition for each row of a loop.
A driver is a `parallel_kernel`.
"""

import warnings

import numba
from numba import prange

from rinow.kernels import _notice
from rinow.kernels._parallel import Parallel

__all__ = ["inlined", "inner", "kernel", "lean", "parallel_kernel", "prange"]


def can_keep(function):
    """Whether numba may write compiled kernels, beside their source or at home; warn if not."""
    try:
        numba.njit(cache=True)(function)
    except RuntimeError:
        warnings.warn(
            "no folder to keep compiled kernels in: each run compiles them again; "
            "set NUMBA_CACHE_DIR to a folder that you may write to.",
            stacklevel=2,
        )
        return False
    return True


_notice.watch()

POLICY = {"cache": can_keep(can_keep), "error_model": "numpy", "no_cfunc_wrapper": True}

kernel = numba.njit(**POLICY)

inlined = numba.njit(**POLICY, inline="always")
"""For formulas in loops over many points: written in place of their calls, for loops with calls stay scalar code."""


def inner(function, **options):
    """Compile a kernel for kernels; Python can call it too, but compiles a caller for it first."""
    compiled = numba.njit(**POLICY, no_cpython_wrapper=True, **options)(function)
    if numba.config.DISABLE_JIT:
        return compiled

    caller = []

    def from_python(*args, **kwargs):
        """What numba shall call from Python for arguments of these types: a kernel that calls the kernel."""
        if not caller:
            caller.append(numba.njit(lambda *given: compiled(*given)))
        return caller[0]

    # There is no entry for Python: neither look for one nor add one.
    compiled._insert = lambda *entry, **options: None
    compiled._compile_for_args = from_python
    return compiled


def lean(function):
    """Compile an inner kernel that makes no array; numba refuses one that does."""
    return inner(function, _nrt=False)


def parallel_kernel(function):
    """Compile a loop over `prange`, the last statement of a function without a result, for all threads."""
    return function if numba.config.DISABLE_JIT else Parallel(function, POLICY)
