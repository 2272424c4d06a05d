"""Clocks and searches that do not depend on the speed of the machine."""

import math
from functools import partial

import numba
import pytest

from rinow import gromov_hausdorff
from rinow.comparison.clock import Clock

SLOW = pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="takes minutes in plain Python")

unlimited = partial(gromov_hausdorff, time_limit=math.inf)
"""What a test expects to be exact must not depend on the speed of the machine."""


class Looks(Clock):
    """A clock that is over after so many looks."""

    def __init__(self, looks):
        super().__init__(math.inf)
        self.looks = looks

    @property
    def over(self):
        self.looks -= 1
        return self.looks < 0
