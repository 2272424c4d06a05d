"""Charts of local fits: tori that osculate the surface at the centre of a ball, or the mean plane of the ball."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["DOUBTFUL", "MEAN_ORDER", "WIDER", "Choice", "either", "leads", "log_ratios", "lower"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]

WIDER, MEAN_ORDER = 3, 2
"""A mean plane is tangent, at the centre, to the fit of this order over a ball so many radii larger than that of the
fits over it.  Over a tangent plane a surface that does not keep its curvature rises steeply at one side."""
EXPONENT, ABOVE, FARTHEST = 4.0, 2, 9
"""Power of the ratio of residuals that counts between charts, and how many radii above that chosen they are compared:
there what a fit misses is larger against the noise, which is the same in both charts.  The last is the index of the
largest radius compared, so that no damage farther away makes the choice."""
DOUBTFUL = 2.0
"""Up to this lead, of either chart, a centre that chooses by itself looks in both."""
STEEPEST = 3.0
"""Angle, in radians, from which on nothing over a plane is believed: a surface that turns back is no graph over it, and
what is left of it has residuals and errors that look small."""


class Choice(NamedTuple):
    """For each centre the index of the radius (-1 for none), the order and the expected squared error."""

    radius: Ints
    order: Ints
    risk: Floats

    def at(self, rows: slice | NDArray[np.intp] | Bools) -> Choice:
        """That of some of them."""
        return Choice(self.radius[rows], self.order[rows], self.risk[rows])


def leads(torus: Choice, plane: Choice, logs: Floats, turns: Floats) -> Floats:
    """Logarithm of the squared error that the torus promises over that of the plane, by risks and by `log_ratios`.

    It is positive where the plane is better, nan where one has no fit, and -inf where no plane is believed: `turns` are
    angles by which the normals of the tori turn from the centres to the ends of the balls over planes.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(turns < STEEPEST, np.log(torus.risk) - np.log(plane.risk) - logs, -np.inf)


def either(is_plane: Bools, torus: Choice, plane: Choice) -> Choice:
    """The choices of one chart or the other."""
    return Choice(*(np.where(is_plane, a, b) for a, b in zip(plane, torus, strict=True)))


def lower(torus: Choice, plane: Choice, logs: Floats, turns: Floats) -> tuple[Bools, Choice]:
    """Whether the plane leads, and the choice in the chart that does."""
    is_level = leads(torus, plane, logs, turns) > 0.0
    return is_level, either(is_level, torus, plane)


def log_ratios(torus: tuple[Choice, Floats], plane: tuple[Choice, Floats]) -> Floats:
    """`EXPONENT` times the logarithm of the ratio of the mean square residuals over plane and torus, by centre.

    Of the same points, radius and order, they differ by what the fits miss and not by the noise, and so tell the better
    chart more surely than errors of each that are estimated apart.  Residuals are (m, n_radii, n_orders); the ratio is
    the mean of those for both choices.
    """
    here, last = np.arange(len(torus[1])), min(torus[1].shape[1] - 1, FARTHEST)
    logs = np.full((2, len(here)), np.nan)
    for k, (choice, _) in enumerate((torus, plane)):
        place = here, np.clip(choice.radius + ABOVE, 0, last), np.maximum(choice.order - 2, 0)
        of_torus, of_plane = torus[1][place], plane[1][place]
        is_known = (choice.radius >= 0) & (of_torus > 0.0) & (of_plane > 0.0)
        logs[k, is_known] = np.log(of_plane[is_known] / of_torus[is_known])
    known = np.isfinite(logs)
    return EXPONENT * np.where(known, logs, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
