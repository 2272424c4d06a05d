"""Loops over `prange` in parts, and kernels without an entry for Python."""

import multiprocessing
from concurrent.futures import ThreadPoolExecutor

import numba
import numpy as np
import pytest

from rinow.kernels import _jit, stencils
from rinow.kernels._jit import inner, kernel, parallel_kernel, prange
from rinow.kernels._parallel import Parallel, of_a_part

NEEDS_JIT = pytest.mark.skipif(numba.config.DISABLE_JIT, reason="tests how kernels are compiled")


@inner
def shifted(x, by):
    """A number and another."""
    return x + by


@kernel
def twice_shifted(x, by):
    """The double of what the inner kernel gives."""
    return 2 * shifted(x, by)


@parallel_kernel
def count_up(by, out):
    """Write the index and a shift."""
    start = by - 1
    for i in prange(len(out)):
        out[i] += shifted(i, start) + 1


def loop_then_more(out):
    """Not a driver: something follows the loop."""
    for i in prange(len(out)):
        out[i] = i
    out[0] = 7


def loop_of_two_ends(out):
    """Not a driver: the range has two ends."""
    for i in prange(1, len(out)):
        out[i] = i


@pytest.fixture(params=[1, numba.config.NUMBA_NUM_THREADS])
def n_threads(request):
    numba.set_num_threads(request.param)
    yield request.param
    numba.set_num_threads(numba.config.NUMBA_NUM_THREADS)


@pytest.mark.parametrize("n", [0, 1, 3, 1000])
def test_each_index_of_a_loop_is_taken_once(n, n_threads):
    out = np.zeros(n, np.int64)
    count_up(5, out)
    np.testing.assert_array_equal(out, np.arange(n) + 5)


def test_same_bits_for_any_number_of_threads():
    rng = np.random.default_rng(7)
    offsets = np.arange(0, 4001, 4)
    neighbours, values = rng.integers(0, 1000, 4000), rng.random(1000)
    found = []
    for n in (1, numba.config.NUMBA_NUM_THREADS):
        numba.set_num_threads(n)
        found.append(np.empty(1000))
        stencils.ring_sums(values, offsets, neighbours, found[-1])
    assert found[0].tobytes() == found[1].tobytes()


def test_threads_of_a_caller_may_run_loops_at_once():
    def run(by):
        out = np.zeros(5000, np.int64)
        count_up(by, out)
        return out

    with ThreadPoolExecutor(4) as pool:
        for by, out in enumerate(pool.map(run, range(20))):
            np.testing.assert_array_equal(out, np.arange(5000) + by)


def _sum_in_fork(n):
    out = np.zeros(n, np.int64)
    count_up(1, out)
    return int(out.sum())


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="no fork here")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_fork_has_threads_of_its_own():
    assert _sum_in_fork(10) == 55
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.apply_async(_sum_in_fork, (10,)).get(timeout=300) == 55


def test_inner_kernels_can_be_called_by_kernels_and_from_python():
    assert twice_shifted(3, 4) == 14
    assert shifted(3, 4) == 7
    assert shifted(3.5, 4) == 7.5
    assert twice_shifted(3.5, 4) == 15.0


@NEEDS_JIT
def test_a_driver_keeps_its_name_and_docstring():
    assert isinstance(count_up, Parallel)
    assert (count_up.__name__, count_up.__doc__) == ("count_up", "Write the index and a shift.")


@pytest.mark.parametrize("function", [loop_then_more, loop_of_two_ends])
def test_what_does_not_end_in_a_loop_over_prange_is_refused(function):
    with pytest.raises(SyntaxError, match=f"{function.__name__} does not end in a loop over prange"):
        of_a_part(function)


@pytest.mark.parametrize("n_parts", [1, 3, 8])
def test_parts_of_a_loop_cover_it(n_parts):
    out = np.zeros(10, np.int64)
    part = of_a_part(count_up.__wrapped__ if isinstance(count_up, Parallel) else count_up)
    for k in range(n_parts):
        part(k, n_parts, 5, out)
    np.testing.assert_array_equal(out, np.arange(10) + 5)


def test_without_a_folder_for_compiled_kernels_they_are_compiled_each_time(monkeypatch):
    def refuse(**options):
        raise RuntimeError("cannot cache function: no locator available")

    monkeypatch.setattr(_jit.numba, "njit", refuse)
    with pytest.warns(UserWarning, match="set NUMBA_CACHE_DIR to a folder that you may write to"):
        assert not _jit.can_keep(_jit.can_keep)
