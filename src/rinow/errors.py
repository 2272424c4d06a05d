"""Every exception rinow raises on purpose; all derive from `RinowError`."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import Any

__all__ = [
    "ConvergenceError",
    "FileFormatError",
    "InvalidInputError",
    "InvalidMeshError",
    "MissingDependencyError",
    "NotAMetricError",
    "RinowError",
    "naming",
]


class RinowError(Exception):
    """Base of all errors of this package; its message is one sentence: what, where, why, what to do."""


class InvalidInputError(RinowError, ValueError):
    """An argument has a wrong shape, type, range or value."""


class InvalidMeshError(InvalidInputError):
    """Vertices, faces or edge lengths do not describe a mesh."""


class NotAMetricError(InvalidInputError):
    """Distances violate an axiom of a metric; `witness` holds the indices of the points that show it."""

    def __init__(self, message: str, witness: tuple[int, ...] = ()) -> None:
        super().__init__(message)
        self.witness = witness


class FileFormatError(RinowError):
    """A file cannot be read or written in its format."""


class ConvergenceError(RinowError):
    """An iteration stopped early; `best` holds the best result so far."""

    def __init__(self, message: str, best: Any = None) -> None:
        super().__init__(message)
        self.best = best


class MissingDependencyError(RinowError, ImportError):
    """An optional package is needed; the message names the extra that brings it."""


@contextmanager
def naming(argument: str) -> Generator[None]:
    """Put the name of an argument before the message of an error about its value."""
    try:
        yield
    except InvalidInputError as error:
        error.args = (f"{argument}: {error}",)
        raise
