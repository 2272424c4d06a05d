"""The line that says on a terminal that kernels are compiled."""

import io

import numba
import pytest
from numba.core import event

from rinow.kernels import _notice, stencils


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def notice():
    """A notice that hears of compilations, whether or not the line was due before."""
    found = _notice.Notice()
    event.register("numba:compile", found)
    yield found
    event.unregister("numba:compile", found)


@pytest.fixture
def compile_one(monkeypatch):
    """Compile a kernel of rinow that no cache has, with standard error going to a stream."""
    if numba.config.DISABLE_JIT:
        pytest.skip("nothing is compiled")

    def compile_with(stream):
        monkeypatch.setattr("sys.stderr", stream)
        numba.njit(stencils.norm.py_func)((3.0, 4.0, 0.0))
        return stream.getvalue()

    return compile_with


def test_a_terminal_is_told_once(notice, compile_one):
    assert _notice.LINE in compile_one(Terminal())
    assert not notice.is_due
    assert compile_one(Terminal()) == ""


def test_a_pipe_and_functions_of_others_are_not_told(notice, compile_one, monkeypatch):
    assert compile_one(io.StringIO()) == ""
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    numba.njit(lambda x: x + 1)(1)
    assert terminal.getvalue() == ""
    assert notice.is_due
