"""Haantjes curvature: by how much an arc is longer than its chord."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow import tolerances
from rinow._arrays import as_floats
from rinow.errors import InvalidInputError

__all__ = ["arc_length", "haantjes_curvature"]

Floats = NDArray[np.float64]


def haantjes_curvature(arc_lengths: ArrayLike, chords: ArrayLike) -> Floats:
    r"""Haantjes curvature of arcs from their lengths and chords.

    It is the quotient whose limit, as the arc shrinks to a point, is the curvature of
    the curve at that point.

    Parameters
    ----------
    arc_lengths : (...) array_like of float
        Length of each arc.
    chords : (...) array_like of float
        Distance of its ends, in the same unit.  The shapes broadcast.

    Returns
    -------
    curvature : (...) ndarray of float
        In 1/length, from 0 (arc = chord) to √24/arc.  It is nan where the arc is not
        positive and finite, the chord negative or nan, or the chord longer than the arc
        by more than a 1e-9th.

    Raises
    ------
    InvalidInputError
        If the shapes do not broadcast or the values are not real numbers.

    See Also
    --------
    arc_length : The way back, from chord and curvature.
    curve_curvature : Haantjes curvature of a polyline.

    Notes
    -----
    For an arc of length :math:`l` and its chord :math:`d` (Definition 5.5 of [1]_)

    .. math:: \kappa^2 = 24 (l - d) / l^3.

    On a circle the value is too small by the share :math:`(\kappa l)^2/160`; lengths
    rounded to 16 digits change it by up to about :math:`10^{-15}/(\kappa l)^2`.  Both
    errors are below 1e-8 where an arc turns by :math:`\kappa l` = 0.0005 to 0.001 and
    below 1e-3 from 1e-6 to 0.4.  The lengths must be those of the arcs themselves: the
    sum of the sides of an inscribed polyline is too short by a fixed share of
    :math:`l - d` however fine it is, which `curve_curvature` corrects.

    References
    ----------
    .. [1] E. Saucan, "Surface triangulation: the metric approach", 2004, section 5;
       J. Haantjes, "Distance geometry. Curvature in abstract metric spaces",
       Indag. Math. 9 (1947).

    Examples
    --------
    An arc of 0.1 radian of the unit circle:

    >>> import numpy as np, rinow
    >>> print(round(float(rinow.haantjes_curvature(0.1, 2 * np.sin(0.05))), 5))
    0.99994
    """
    arcs, d = _broadcast(arc_lengths, "arc_lengths", chords, "chords")
    with np.errstate(all="ignore"):
        share = (arcs - d) / arcs
        defined = (arcs > 0.0) & (d >= 0.0) & (share >= -tolerances.TRIANGLE_INEQUALITY)
        curvature = np.sqrt(24.0 * np.maximum(share, 0.0)) / arcs
    return np.where(defined & np.isfinite(arcs), curvature, np.nan)[()]


def arc_length(chords: ArrayLike, curvature: ArrayLike) -> Floats:
    r"""Lengths of arcs from their chords and curvature: the Haantjes lift.

    It turns the straight distances of points of a curve or surface into lengths along
    it, to third order.

    Parameters
    ----------
    chords : (...) array_like of float
        Distance of the ends of each arc.
    curvature : (...) array_like of float
        Curvature of the arc, in 1/length; its sign does not matter.  The shapes
        broadcast.

    Returns
    -------
    arc_lengths : (...) ndarray of float
        In the unit of the chords and never shorter.  It is nan where the chord is
        negative or either value nan, and inf beyond the largest number.

    Raises
    ------
    InvalidInputError
        If the shapes do not broadcast or the values are not real numbers.

    See Also
    --------
    haantjes_curvature : The way back, from arc and chord.

    Notes
    -----
    Definition 5.5 of [1]_ fixes the length :math:`l` over a chord :math:`c` to third
    order and no further, whatever the curve or the space:

    .. math:: l = c\,(1 + (\kappa c)^2/24) + O(c^4),

    with :math:`O(c^5)` where :math:`\kappa` is the curvature in the middle of the arc.
    The next term belongs to the curve: :math:`9(\kappa c)^4/1920` of the chord on a
    circle, whose arc is exactly :math:`(2/\kappa)\arcsin(\kappa c/2)`, and
    :math:`(\kappa c)^4/1920` on a horocycle of the hyperbolic plane.  The lift is
    within 1e-6 there for :math:`\kappa c \le 0.1`, and defined for any :math:`\kappa c`.

    References
    ----------
    .. [1] E. Saucan, "Surface triangulation: the metric approach", 2004, section 5.

    Examples
    --------
    >>> import rinow
    >>> rinow.arc_length([0.1, 0.2], 1.0)
    array([0.10004167, 0.20033333])
    """
    c, kappa = _broadcast(chords, "chords", curvature, "curvature")
    with np.errstate(over="ignore", invalid="ignore"):
        return np.where(c >= 0.0, c * (1.0 + (kappa * c) ** 2 / 24.0), np.nan)[()]


def _broadcast(x: ArrayLike, x_name: str, y: ArrayLike, y_name: str) -> tuple[Floats, Floats]:
    """Two arrays of real numbers, brought to one shape."""
    a, b = as_floats(x, x_name), as_floats(y, y_name)
    try:
        a, b = np.broadcast_arrays(a, b)
    except ValueError:
        message = f"{x_name} and {y_name} have shapes {a.shape} and {b.shape}; give one of each for every arc."
        raise InvalidInputError(message) from None
    return a, b
