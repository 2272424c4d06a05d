"""One line on the terminal when kernels are compiled, which takes a minute after an installation."""

import sys

from numba.core import event

__all__ = ["Notice", "watch"]

LINE = "rinow: compiling kernels, once after installation; up to a minute\n"


class Notice(event.Listener):
    """Writes the line at the first compilation of a kernel of rinow, if somebody watches standard error.

    Kernels that numba finds compiled in its cache are no compilation.
    """

    def __init__(self):
        self.is_due = True

    def on_start(self, event):
        """Write the line where it is due."""
        kernel = event.data["dispatcher"].py_func
        if self.is_due and kernel.__module__.startswith("rinow.") and sys.stderr is not None and sys.stderr.isatty():
            self.is_due = False
            sys.stderr.write(LINE)
            sys.stderr.flush()

    def on_end(self, event):
        """Nothing: the work that follows has its own words."""


def watch():
    """Look out for compilations from now on."""
    event.register("numba:compile", Notice())
