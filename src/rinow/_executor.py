"""Where independent pieces of work run: a protocol that any pool satisfies, and the serial default."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Protocol, TypeVar

__all__ = ["Executor", "SerialExecutor"]

R = TypeVar("R")


class Executor(Protocol):
    """What rinow asks of an executor; `concurrent.futures` pools and dask clients have it."""

    def map(self, function: Callable[..., R], *iterables: Iterable[Any]) -> Iterable[R]:
        """Results of `function` over the zipped iterables, in their order."""
        ...


class SerialExecutor:
    """Run everything in this thread."""

    def map(self, function: Callable[..., R], *iterables: Iterable[Any]) -> Iterator[R]:
        """Results of `function` over the zipped iterables, in their order."""
        return map(function, *iterables)
