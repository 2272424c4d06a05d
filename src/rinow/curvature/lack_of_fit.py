"""What fits miss, as their residuals tell: waves that a large ball holds whole are seen by no comparison of its orders.

Over a ball of several wave lengths low orders see a plane, and agree: with the next order, and with the next ball.
But they leave more than noise.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["squared_biases_by_residuals"]

Floats = NDArray[np.float64]

ALONE = 4.0
"""Mean squares up to so many times the noise are noise; those of more than twice as much are counted."""
ENOUGH = 35
"""Fits, of all radii and orders, that leave noise alone if it is noise, and no error of the best of them."""
BEND = 16.0
"""Second derivative of a polynomial at the centre of the unit disc, over its largest value, if a quadric sees nothing
of it: T_4 has T_4''(0) = -16."""


def squared_biases_by_residuals(ratios: Floats, noise: Floats, reaches: Floats, bend: Floats, of_mean: bool) -> Floats:
    """Least squared bias of K (or of H) of each fit, by what it leaves; nan where that is no more than noise.

    Parameters
    ----------
    ratios : (m, n_radii, n_orders) ndarray of float
        Mean square residuals over the noise, of the fit itself or of most around it, whichever is less; nan without a
        fit.
    noise, bend : (m,) ndarray of float
        Variance of the noise and curvedness, in spacings.
    reaches : (n_radii,) ndarray of float
        Radii, in spacings.
    of_mean : bool
        Whether the error is that of H.

    Notes
    -----
    What an order misses over a ball and not over smaller ones has an amplitude a, by its residual, and bends over the
    largest ball that the order fits, of radius r: by 16 a / r² or so.
    """
    with np.errstate(invalid="ignore"):
        fits = ratios <= ALONE
        missed = np.where(ratios > 2.0 * ALONE, ratios - 2.0 * ALONE, np.nan)
    missed[fits.sum(axis=(1, 2)) < ENOUGH] = np.nan
    within = np.maximum(np.where(fits, reaches[:, None], 0.0).max(axis=1, keepdims=True), reaches[0])
    error = BEND * np.sqrt(noise[:, None, None] * missed) / within**2
    return error**2 if of_mean else (error * (error + 2.0 * bend[:, None, None])) ** 2
