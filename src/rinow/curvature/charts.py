"""Charts of local fits: tori that osculate the surface at the centre of a ball, or the mean plane of the ball."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["MEAN_ORDER", "WIDER", "Choice", "log_ratios", "lower"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]

WIDER, MEAN_ORDER = 3, 2
"""A mean plane is tangent, at the centre, to the fit of this order over a ball so many radii larger than that of the
fits over it.  Over a tangent plane a surface that does not keep its curvature rises steeply at one side."""
EXPONENT, ABOVE = 4.0, 2
"""Power of the ratio of residuals that counts between charts, and how many radii above that chosen they are compared:
there what a fit misses is larger against the noise, which is the same in both charts."""


class Choice(NamedTuple):
    """For each centre the index of the radius (-1 for none), the order and the expected squared error."""

    radius: Ints
    order: Ints
    risk: Floats


def lower(torus: Choice, plane: Choice, logs: Floats) -> tuple[Bools, Choice]:
    """Whether the plane promises less, by risks and by `log_ratios`, and the choice in that chart."""
    is_level = plane.risk * np.exp(logs) < torus.risk
    return is_level, Choice(*(np.where(is_level, a, b) for a, b in zip(plane, torus, strict=True)))


def log_ratios(choices: tuple[Choice, Choice], torus: Floats, plane: Floats, links: tuple[Ints, Ints]) -> Floats:
    """`EXPONENT` times the mean logarithm of the ratio of the mean square residuals over plane and torus, by centre.

    Of the same points, radius and order, they differ by what the fits miss and not by the noise, and so tell the better
    chart more surely than errors of each that are estimated apart.  Residuals are (m, n_radii, n_orders); they are
    compared for both choices and averaged over the centres linked to each.
    """
    here, last = np.arange(len(torus)), torus.shape[1] - 1
    logs = np.full((2, len(torus)), np.nan)
    for k, choice in enumerate(choices):
        place = here, np.clip(choice.radius + ABOVE, 0, last), np.maximum(choice.order - 2, 0)
        a, b = plane[place], torus[place]
        is_known = (choice.radius >= 0) & (a > 0.0) & (b > 0.0)
        logs[k, is_known] = np.log(a[is_known] / b[is_known])
    known = np.isfinite(logs)
    means = np.where(known, logs, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    sums = np.add.reduceat(means[links[1]], links[0][:-1]) if len(means) else means
    return EXPONENT * sums / np.diff(links[0])
