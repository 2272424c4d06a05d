"""What averages of angle defects at a large scale miss, as smaller scales prove: a bump or a turn of a tube is flat."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.flow import CurvatureFlow

__all__ = ["proven_bias"]

Floats = NDArray[np.float64]

PROOF, PASSES = 3.0, 5
"""Squared difference over that expected, in the mean over so many rings, from which on it proves a bias."""
MOST = 9.0
"""What a vertex counts in this mean at most, lest one with a wild value speaks for all around."""


def proven_bias(difference: Floats, expected: Floats, flow: CurvatureFlow) -> Floats:
    """(n_vertices,): squared bias of values by what they differ by from those of smaller scales; nan without a proof.

    Parameters
    ----------
    difference, expected : (n_vertices,) ndarray of float
        Of the values of two scales, and the square of it that both expect.
    flow : CurvatureFlow
        The mesh.

    Notes
    -----
    A scale and its half, by which biases are seen otherwise, agree where both hold so much of the surface that what
    bends in it has the total curvature 0.
    """
    columns = np.empty((len(difference), 2))  # of long arrays no more than needed is kept
    ratios, excess = columns.T
    np.square(difference, out=excess)
    with np.errstate(divide="ignore", invalid="ignore"):  # values that agree exactly, without noise, prove nothing
        np.minimum(excess / expected, MOST, out=ratios)
    excess -= expected
    columns[~np.isfinite(ratios)] = np.nan
    ratios, excess = flow.means(columns, PASSES).T
    return np.where(ratios > PROOF, excess, np.nan)
