"""Loops over `prange`, shared out among the threads of Python.

Numba's own parallel loops do the same, but take three times as long to compile: each becomes several functions with
all arrays taken apart, and everything it calls is compiled into each of them.  Here a loop is compiled once, for a part
of its range, and threads without the lock of Python run the parts.  What stands before the loop is done for each part:
arrays that are made there are work space of one thread.
"""

import ast
import copy
import inspect
import itertools
import os
import textwrap
import warnings
from concurrent.futures import ThreadPoolExecutor

import numba
from numba.core.errors import NumbaWarning

PARTS = 4
"""Parts of a loop for each thread: threads that are done early take those of the others."""


class Parallel:
    """A function whose last statement is a loop over `prange`; a call runs the loop on `numba.get_num_threads()`."""

    def __init__(self, function, options):
        self.function = function
        self.options = options
        self.compiled = None
        self.__doc__, self.__name__, self.__wrapped__ = function.__doc__, function.__name__, function

    def __call__(self, *args):
        """Run all parts of the loop."""
        if self.compiled is None:
            self.compiled = numba.njit(nogil=True, **self.options)(of_a_part(self.function))
        n_threads = number_of_threads()
        if n_threads == 1:
            self.compiled(0, 1, *args)
            return
        n_parts = PARTS * n_threads
        numbers = itertools.count()

        def work():
            """Take parts until none is left."""
            while (part := next(numbers)) < n_parts:
                self.compiled(part, n_parts, *args)

        others = [threads().submit(work) for _ in range(n_threads - 1)]
        try:
            work()
        finally:
            for other in others:
                if not other.cancel():
                    other.result()


_asked = []


def number_of_threads():
    """As `numba.get_num_threads`, which when first called looks for libraries of threads and warns of old ones.

    None of them is used here, and such ones come with others' packages.
    """
    if not _asked:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", NumbaWarning)
            _asked.append(numba.get_num_threads())
    return numba.get_num_threads()


def of_a_part(function):
    """The function with two more arguments: the number of a part of the range of its loop, and how many there are."""
    lines, first = inspect.getsourcelines(function)
    tree = ast.parse(textwrap.dedent("".join(lines)))
    ast.increment_lineno(tree, first - 1)
    definition = tree.body[0]
    definition.decorator_list = []
    definition.args.args[:0] = [ast.arg(name) for name in ("part_", "n_parts_")]
    loop = definition.body[-1]
    if not isinstance(loop, ast.For) or ast.unparse(loop.iter.func) != "prange" or len(loop.iter.args) != 1:
        raise SyntaxError(f"{function.__qualname__} does not end in a loop over prange(n).")
    size = ast.copy_location(ast.Assign([ast.Name("n_", ast.Store())], loop.iter.args[0]), loop)
    share = ast.parse("range(n_ * part_ // n_parts_, n_ * (part_ + 1) // n_parts_)", mode="eval").body
    loop.iter = copy.deepcopy(share)
    for node in ast.walk(loop.iter):
        ast.copy_location(node, loop)
    definition.body.insert(-1, size)
    names = {}
    exec(compile(ast.fix_missing_locations(tree), inspect.getsourcefile(function), "exec"), function.__globals__, names)
    return names[function.__name__]


_threads = []


def threads():
    """The threads beside the calling one, started when first needed."""
    if not _threads:
        _threads.append(ThreadPoolExecutor(max(numba.config.NUMBA_NUM_THREADS - 1, 1), "rinow"))
    return _threads[0]


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_threads.clear)  # a fork has none of its parent's threads
