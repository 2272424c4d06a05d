"""Settings of the whole test run."""

import os

import numpy as np
import pytest
from hypothesis import settings

import rinow
from rinow.comparison.clock import Clock
from rinow.comparison.gromov_hausdorff import first_interval
from rinow.comparison.large import approach

# No deadline: the first example of a kernel compiles it.  The same examples each time in CI, fresh ones at a desk.
settings.register_profile("rinow", deadline=None, derandomize=bool(os.environ.get("CI")))
settings.load_profile("rinow")


@pytest.fixture(scope="session")
def compiled_searches() -> None:
    """The kernels of the searches, compiled: tests with a time limit must not spend it on that."""
    rng = np.random.default_rng(0)
    X, Y = (rinow.MetricSpace.from_points(rng.random((9, 2))) for _ in range(2))
    rinow.gromov_hausdorff(X, Y)
    rinow.lipschitz_distance(X, Y)
    approach(X.distances, Y.distances, first_interval(X.distances, Y.distances, 0.0), Clock(0.1))
