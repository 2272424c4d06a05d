"""What goes to the terminal: tables on stdout, progress on stderr only where somebody watches."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, SpinnerColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bar
from rich.table import Table

from rinow.study.surface import CurvatureStudy, field_unit

__all__ = ["console", "print_counts", "print_json", "print_notes", "print_study", "working"]


Progress = Callable[[int, int], object]


@contextmanager
def working(task: str) -> Generator[Progress]:
    """Show the name of the task on a terminal; nothing in a pipe or a log.

    Yields a function of how much is done and the total, for tasks that know; the bar runs along for the others.
    """
    if not sys.stderr.isatty():
        yield _unseen
        return
    columns = SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn()
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        line = bar.add_task(task, total=None)
        yield lambda done, total: bar.update(line, completed=done, total=total)


def _unseen(done: int, total: int) -> None:
    """Progress that nobody watches."""


def print_json(record: Mapping[str, Any]) -> None:
    """One JSON object on stdout; numbers that are not finite become null."""
    sys.stdout.write(json.dumps(_plain(record), indent=2, allow_nan=False) + "\n")


def _plain(value: Any) -> Any:
    """The same value in types that JSON has."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


class _Stdout(Console):
    def on_broken_pipe(self) -> None:
        """Leave it to `main`: a reader that has seen enough is no error, as rich would have it."""
        raise BrokenPipeError


def console() -> Console:
    """Stdout; in a pipe wide enough that no cell is cut."""
    return _Stdout() if sys.stdout.isatty() else _Stdout(width=120)


def print_counts(title: str, counts: Mapping[str, Any]) -> None:
    """A table of two columns."""
    out = console()
    table = Table("", "value", title=title, min_width=min(len(title), out.width))
    for name, value in counts.items():
        table.add_row(name.replace("_", " "), f"{value:,}" if isinstance(value, int) else f"{value:.6g}")
    table.columns[1].justify = "right"
    out.print(table)


def print_study(title: str, study: CurvatureStudy) -> None:
    """A table of the fields with their units and percentiles, and how many vertices or points have each status."""
    table = Table(title=title)
    table.add_column("field")
    table.add_column("unit")
    percentiles = study.percentiles()
    for p in next(iter(percentiles.values())):
        table.add_column({"0": "least", "50": "median", "100": "greatest"}.get(p, f"{p} %"), justify="right")
    for name, levels in percentiles.items():
        table.add_row(name, field_unit(name, study.unit), *(f"{v:z.4g}" for v in levels.values()))
    out = console()
    out.print(table)
    status = ", ".join(f"{n:,} {name}" for name, n in study.status_counts().items())
    seconds = ", ".join(f"{step} {s:.2f} s" for step, s in study.seconds.items())
    out.print(f"method {study.curvature.method}; {study.places}: {status}; {seconds}", highlight=False)
    print_notes(study.notes)


def print_notes(notes: tuple[str, ...]) -> None:
    """Notes, one a line."""
    for note in notes:
        console().print(f"note: {note}", highlight=False, markup=False)
