"""The command `rinow`: parses arguments, maps errors to one sentence and an exit code."""

from __future__ import annotations

import gc
import io
import os
import signal
import sys
from collections.abc import Sequence
from typing import NoReturn

from cyclopts import App, CycloptsError, Parameter, UnusedCliTokensError

from rinow._version import __version__
from rinow.errors import RinowError

__all__ = ["app", "main", "run"]

OBJECTS_BETWEEN_COLLECTIONS = 100_000
"""Searching its many objects for cycles is a sixth of the time that compiling takes."""
OK, BAD_INPUT, USAGE, INTERRUPTED, TERMINATED = 0, 1, 2, 130, 143

app = App(
    name="rinow",
    version=__version__,
    help="Metric geometry of surfaces and finite metric spaces: distances in, curvature and shape distance out.",
    default_parameter=Parameter(negative=()),  # each flag has one form
)
SUMMARIES = {
    "demo": "Compute the curvature of the shipped mesh `spot`; write a PLY, a PNG and a page into the current folder.",
    "info": "Count the parts and the faults of a mesh, or of points without faces.",
    "curvature": "Compute the curvature at every vertex of a mesh or point of a cloud or metric space, in the order of "
    "the file.\n\n"
    "Convex with outward normal is positive.",
    "features": "Find the cone points, creases and corners of a mesh.\n\n"
    "Angles are in radians in files and JSON and in degrees in the table; convex is positive.",
    "graph": "Compute the curvature of the nodes and edges of a graph by the lengths of its edges.",
    "quadruple": "Print all surfaces of constant curvature in which four points have the given distances.",
    "compare": "Bound the distance of two meshes, point sets or distance matrices from below and from above.",
    "net": "Choose vertices of a mesh that are nowhere far from the rest, by exact geodesic distances, or points by "
    "theirs.",
}
"""What the docstrings of the commands begin with, known without importing what they need."""
for name, summary in SUMMARIES.items():
    app.command(f"rinow.cli.{name}:{name}", help=summary)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    It is 0 when done, 1 for bad input and 2 for wrong usage, either in one line on stderr; 130 after Ctrl-C and 143
    after a signal to end, which say nothing.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    try:
        app(words, exit_on_error=False, print_error=False, result_action="return_value")
        sys.stdout.flush()
    except CycloptsError as error:
        return _fail(_usage(error, words), USAGE)
    except RinowError as error:
        return _fail(str(error))
    except MemoryError:
        return _fail("the machine has too little memory for this input; simplify the mesh or use a larger machine.")
    except BrokenPipeError:
        _drop_output()  # the reader has gone, and that is its right
    except OSError as error:  # of meshes and tables, readers and writers tell
        if error.filename is not None:
            return _fail(f"{error.filename}: {error.strerror or error}; check the file and its folder.")
        _drop_output()
        return _fail(f"the output cannot be written: {error.strerror or error}; make room or send it elsewhere.")
    except KeyboardInterrupt:
        return INTERRUPTED
    except SystemExit as stop:  # --help, --version and a signal to end
        return stop.code if isinstance(stop.code, int) else OK
    return OK


def _usage(error: CycloptsError, words: Sequence[str]) -> str:
    """What is wrong with the arguments, and where to read what they are."""
    command = " ".join(("rinow", *(error.command_chain or ())))
    fault = str(error)
    if isinstance(error, UnusedCliTokensError):
        fault = f"{' '.join(error.unused_tokens or ())} is more than {command} takes."
    if "-" in words:
        fault = "- names no file, and rinow reads and writes files only, no pipes; give the name of one."
    return f"{fault} {command} --help lists the arguments."


def _fail(sentence: str, code: int = BAD_INPUT) -> int:
    """Print one line on stderr and return the exit code."""
    sys.stderr.write(f"rinow: {' '.join(sentence.split())}\n")
    return code


def _drop_output() -> None:
    """Send what stdout still holds nowhere, which would fail again at the exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _terminated(number: int, frame: object) -> NoReturn:
    """Unwind, so that no half-written file is left."""
    raise SystemExit(TERMINATED)


def run() -> None:
    """Entry point of the installed command."""
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    signal.signal(signal.SIGTERM, _terminated)
    if sys.stdout is None:  # closed by the caller
        sys.stdout = open(os.devnull, "w", encoding="utf-8")
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")  # a locale without ² or a letter of a name still gets the rest
    sys.exit(main())
