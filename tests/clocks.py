"""Clocks that do not depend on the speed of the machine."""

import math

from rinow.comparison.clock import Clock


class Looks(Clock):
    """A clock that is over after so many looks."""

    def __init__(self, looks):
        super().__init__(math.inf)
        self.looks = looks

    @property
    def over(self):
        self.looks -= 1
        return self.looks < 0
