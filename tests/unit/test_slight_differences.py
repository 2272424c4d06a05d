"""Spaces whose distances differ by less than single precision, or than the isometries that a proof uses."""

import math

import numpy as np
import pytest

from clocks import Looks
from naive import correspondences as naive
from rinow import gromov_hausdorff, lipschitz_distance
from rinow.comparison.warm_start import BijectionTabu, RelationTabu


def nearly_equidistant(rng, n, difference):
    """Distances from 1 to 1 plus a difference."""
    D = np.triu(1.0 + difference * rng.random((n, n)), 1)
    return D + D.T


@pytest.mark.parametrize("difference", [1e-7, 1e-9, 1e-11])
def test_both_distances_are_exact(difference):
    rng = np.random.default_rng(5)
    for n, m in ((4, 4), (5, 5), (3, 5), (2, 4)):
        X, Y = nearly_equidistant(rng, n, difference), nearly_equidistant(rng, m, difference)
        result = gromov_hausdorff(X, Y)
        assert result.exact
        assert result.lower == result.upper == naive.least_distortion(X.tolist(), Y.tolist()) / 2
        if n == m:
            found = lipschitz_distance(X, Y)
            assert found.exact
            assert math.isclose(found.upper, naive.lipschitz_distance(X.tolist(), Y.tolist()), abs_tol=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_isometries_up_to_rounding_leave_no_gap(seed):
    """Proofs that use them hold up to their error; what is left needs another proof."""
    rng = np.random.default_rng(seed + 50)
    X, Y = nearly_equidistant(rng, 2, 1e-9), nearly_equidistant(rng, 5, 1e-9)
    result = gromov_hausdorff(X, Y)
    assert result.exact
    assert result.upper == naive.least_distortion(X.tolist(), Y.tolist()) / 2


def test_tabu_search_ends_where_single_precision_sees_no_difference():
    rng = np.random.default_rng(6)
    X, Y = nearly_equidistant(rng, 7, 1e-9), nearly_equidistant(rng, 7, 1e-9)
    f = np.arange(7)
    for search in (RelationTabu(X, Y, f, f, 1), BijectionTabu(X, Y, f, 1)):
        clock = Looks(1000)
        search.run(10**9, clock)
        assert not clock.over
