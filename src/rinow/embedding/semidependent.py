"""Semidependent quadruples: one point lies between two others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import as_quadruples, in_unit, rows_in_own_unit
from rinow._printing import OneLine
from rinow.errors import InvalidInputError
from rinow.kernels import quadruples as kernels
from rinow.kernels import robinson

__all__ = ["RobinsonCurvature", "is_semidependent", "robinson_curvature", "semidependent_order"]

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Indices = NDArray[np.intp]


def is_semidependent(quadruples: ArrayLike) -> Flags:
    """Whether some point of a quadruple lies between two others, all four not being on a line.

    Parameters
    ----------
    quadruples : (..., 6) array_like of float
        Distances d12, d13, d14, d23, d24, d34.

    Returns
    -------
    is_semidependent : (...) ndarray of bool
        True if d_ik = d_ij + d_jk for some triple, up to rounding (an excess below 1e-13 of its shortest side, or of
        1/100 of its longest one).  False for a linear quadruple, for one with two points at distance 0, and for a
        row that is not a metric.

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong.

    Examples
    --------
    >>> is_semidependent([[1, 2, 2, 1, 1.5, 2], [1, 1, 1, 1, 1, 1], [1, 2, 3, 1, 2, 1]])
    array([ True, False, False])
    """
    return (semidependent_order(quadruples)[..., 0] >= 0)[()]


def semidependent_order(quadruples: ArrayLike) -> Indices:
    """Order of the points of a quadruple in which the second lies between the first and the third.

    Parameters
    ----------
    quadruples : (..., 6) array_like of float
        Distances d12, d13, d14, d23, d24, d34.

    Returns
    -------
    order : (..., 4) ndarray of intp
        Indices 0 to 3 of the points in Robinson's order, d13 = d12 + d23; -1 where `is_semidependent` is false.
        Where several triples are linear, the one of a middle point common to most of them.

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong.

    Examples
    --------
    Point 4 lies between 1 and 2, point 3 beside them:

    >>> semidependent_order([2, 2, 1, 2, 1, 1.5])
    array([0, 3, 1, 2])
    """
    shape, Q = as_quadruples(quadruples)
    relations, order = np.empty(len(Q), np.int8), np.empty((len(Q), 4), np.intp)
    kernels.relations(Q, relations, order)
    order[np.isin(relations, (kernels.LINEAR, kernels.COINCIDENT))] = -1
    return order.reshape(*shape, 4)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RobinsonCurvature(OneLine):
    """Approximate embedding curvature of a batch of semidependent quadruples, and intervals that hold the true one.

    Attributes
    ----------
    value : (...) ndarray of float
        Approximation, in 1/length².
    lower, upper : (...) ndarray of float
        Ends of the interval; -inf or inf where nothing is proved.
    """

    value: Floats
    lower: Floats
    upper: Floats


def robinson_curvature(quadruples: ArrayLike, *, order: int = 1, verify: bool = False) -> RobinsonCurvature:
    r"""Rational approximation of the embedding curvature of quadruples whose second point lies between first and third.

    Parameters
    ----------
    quadruples : (..., 6) array_like of float
        Distances d12, d13, d14, d23, d24, d34 with d13 = d12 + d23, see `semidependent_order`.
    order : {1, 2, 3}, default 1
        Robinson's formula, or with one or two further terms: the error is of the order 2, 4 or 6 in the diameter.
    verify : bool, default False
        Sharpen the intervals to the accuracy of the distances, by the exact angles at both ends, and move the values
        into them.

    Returns
    -------
    RobinsonCurvature
        `value`, `lower` and `upper`; nan for a row in another order, one without curvature (a second triple with
        the same middle point), a linear quadruple, or a row that is not a metric.  The value is inf for four
        points on a circle.

    Raises
    ------
    InvalidInputError
        If the shape or the type is wrong, or `order` is not 1, 2 or 3.

    See Also
    --------
    embedding_curvatures : The exact values.

    Notes
    -----
    With the Euclidean angles α between d12 and d24, and α' between d23 and d24, Robinson's formula [1]_ is

    .. math:: K = \frac{6 (\cos\alpha + \cos\alpha')}{d_{24} (d_{12} \sin^2\alpha + d_{23} \sin^2\alpha')}.

    It has the sign of the curvature κ and is never less: :math:`K = \kappa + M\kappa^2/15 + N\kappa^3/1260 + \dots`
    with M, N rational in the distances; order 2 is :math:`2K/(1 + \sqrt{1 + 4MK/15})`, order 3 is
    :math:`K - MK^2/15 + (2M^2/225 - N/1260)K^3`.  For :math:`|K|\,\mathrm{diam}^2 \le 0.2`,
    :math:`K - \kappa \le 0.2083\,\kappa^2 \mathrm{diam}^2`, and order 2 is off by at most
    :math:`0.042\,|K|^3 \mathrm{diam}^4`.  These constants were found as maxima over a family of three parameters, on a
    grid and at its extremal corner; they are not formally proved.  Beyond that range the interval only tells the
    sign, unless `verify` is set: there an end counts if the two angles in S_k at that end sum to less (more) than
    π by more than an error of 4 roundings in each distance can explain.
    Departures from [2]_: sin is squared in its error bound, whose constant is replaced as above; neither needs the
    quantity λ.

    References
    ----------
    .. [1] J. V. Robinson, according to L. M. Blumenthal, K. Menger, "Studies in Geometry", 1970.
    .. [2] E. Saucan, "Surface Triangulation - the Metric Approach", 2004, section 4.2.

    Examples
    --------
    The fourth point sees the ends of a segment of length 2 at distance 1.3 instead of √2: positive curvature.

    >>> quadruple = [1, 2, 1.3, 1, 1, 2**0.5]
    >>> result = robinson_curvature(quadruple, verify=True)
    >>> float(round(result.lower, 12)), float(round(result.upper, 12))
    (0.441996092534, 0.441996092534)
    """
    if order not in (1, 2, 3):
        raise InvalidInputError(f"order = {order!r}; give 1, 2 or 3.")
    shape, Q = as_quadruples(quadruples)
    Q, exponents = rows_in_own_unit(Q)
    value, lower, upper = np.empty(len(Q)), np.empty(len(Q)), np.empty(len(Q))
    robinson.robinsons(Q, int(order), value, lower, upper)
    if verify:
        robinson.verified_robinsons(Q, value, lower, upper)
    value, lower, upper = (in_unit(x, -2 * exponents).reshape(shape)[()] for x in (value, lower, upper))
    return RobinsonCurvature(value, lower, upper)
