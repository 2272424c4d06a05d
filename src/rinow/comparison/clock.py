"""Time limits of searches that can stop at any time."""

from __future__ import annotations

import time

from rinow._arrays import as_number
from rinow.errors import InvalidInputError

__all__ = ["Clock", "TimeOver"]


class TimeOver(Exception):  # noqa: N818 - no error: who set the limit goes on with what there is
    """Ends the iteration of a library that has no limit of its own."""


class Clock:
    """Time left until a deadline."""

    def __init__(self, seconds: float) -> None:
        self._start = time.monotonic()
        self.seconds = float(seconds)

    @classmethod
    def of(cls, time_limit: float) -> Clock:
        """The clock of a user's time limit.

        Raises
        ------
        InvalidInputError
            If the limit is no number, negative or nan.
        """
        seconds = as_number(time_limit, "time_limit")
        if not seconds >= 0.0:
            raise InvalidInputError(f"time_limit = {time_limit} is not a time; give seconds >= 0, or math.inf.")
        return cls(seconds)

    @property
    def elapsed(self) -> float:
        """Seconds since the start."""
        return time.monotonic() - self._start

    @property
    def left(self) -> float:
        """Seconds left, 0 when the time is over."""
        return max(self.seconds - self.elapsed, 0.0)

    @property
    def over(self) -> bool:
        """Whether no time is left."""
        return self.elapsed >= self.seconds

    def part(self, seconds: float) -> Clock:
        """A clock with at most so many seconds of what is left."""
        return Clock(min(seconds, self.left))
