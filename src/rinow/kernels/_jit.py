"""One compilation policy for all kernels."""

import numba
from numba import prange

__all__ = ["kernel", "parallel_kernel", "prange"]

kernel = numba.njit(cache=True, error_model="numpy")
parallel_kernel = numba.njit(cache=True, error_model="numpy", parallel=True)
