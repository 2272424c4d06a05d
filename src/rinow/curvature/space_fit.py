"""The curvature at a point from the distances of points around it, as a constant or with its first derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rinow.embedding.misfit import Misfit, least_misfit

__all__ = ["N_ORDERS", "UNKNOWNS", "LocalFit", "fit_at_first"]

Floats = NDArray[np.float64]

UNKNOWNS = (1, 3, 6)
"""Numbers fitted: the curvature, its gradient, its second derivatives."""
N_ORDERS = len(UNKNOWNS)
SPARE = 3
"""Conditions beyond the unknowns that a fit needs, so that its residual tells the noise."""
STEPS = 2
"""Steps of the Gauss-Newton method from the curvature of a smaller ball."""
LOWEST, HIGHEST = -100.0, np.pi**2
"""Curvatures in units of 1/diameter² between which the iteration is kept; a sphere of the highest is a great circle."""
SINGULAR = 1e-10
"""Directions of the regression below this share of the largest do not count."""


@dataclass(frozen=True, slots=True)
class LocalFit:
    """Estimates of increasing order at one point; nan for an order with too many unknowns.

    Attributes
    ----------
    values, variances : (3,) ndarray of float
        The curvature, and its variance by errors of the distances.
    differences : (3,) ndarray of float
        Variance of the difference of each value from that of the highest order.
    residual : float
        Standard deviation of the distances from the model of the highest order.
    gap : float
        Widest angle at point 0 that holds no other point.
    """

    values: Floats
    variances: Floats
    differences: Floats
    residual: float
    gap: float


def fit_at_first(D: Floats, start: float = np.nan) -> LocalFit | None:
    r"""Curvature at point 0 from a distance matrix; None where no surface of constant curvature is near.

    Parameters
    ----------
    D : (n, n) ndarray of float
        Distances.
    start : float, optional
        A curvature near that of the surface, which saves most of the steps of the iteration.

    Notes
    -----
    In a surface with the curvature K(y), y normal coordinates around a point, the squared distance of x and z differs
    from that in the plane, to the first order in K, by

    .. math:: -2 A^2 \int_0^1\!\int_0^1 (1 - s) s K(s(x + t(z - x))) ds dt, \quad A = x \times z,

    which is :math:`-A^2 (K/3 + \nabla K\cdot(x + z)/12 + \dots)`.  What the closest surface of constant curvature
    leaves of the Gram matrix beyond two dimensions is regressed on these terms.
    """
    scale = float(D.max())
    misfit = least_misfit(D / scale) if np.isnan(start) else _improved(D / scale, start * scale**2)
    if misfit is None or np.isnan(misfit.step):
        return None
    n_conditions = (len(D) - 2) * (len(D) - 3) // 2
    n_orders = sum(u + SPARE <= n_conditions for u in UNKNOWNS)
    if n_orders == 0:
        return None
    terms = _terms(misfit)
    values, variances, differences = (np.full(N_ORDERS, np.nan) for _ in range(3))
    weights: list[Floats] = []
    noise = 0.0
    for order, unknowns in enumerate(UNKNOWNS[:n_orders]):
        inverse = np.linalg.pinv(terms[:unknowns].reshape(unknowns, -1).T, SINGULAR)
        found = inverse @ misfit.rest.ravel()
        rest = misfit.rest - np.tensordot(found, terms[:unknowns], axes=1)
        noise = misfit.noise(float(np.vdot(rest, rest)), unknowns)
        values[order] = misfit.k + found[0]
        weights.append(inverse[0].reshape(misfit.rest.shape))
    for order, W in enumerate(weights):
        variances[order] = noise * misfit.effect_on(W)
        differences[order] = noise * misfit.effect_on(W - weights[-1])
    gap = _widest_gap(misfit.coordinates())
    return LocalFit(values / scale**2, variances / scale**4, differences / scale**4, noise**0.5 * scale, gap)


def _improved(D: Floats, k: float) -> Misfit | None:
    """The misfit after some steps from k; the regression takes one more.  None if they lead too far."""
    here = Misfit.at(D, k)
    for _ in range(STEPS):
        k = here.k + here.step
        if not LOWEST < k < HIGHEST:
            return None
        here = Misfit.at(D, k)
    return here


def _widest_gap(X: Floats) -> float:
    """Widest angle at the origin between neighbouring directions of points."""
    directions = np.sort(np.arctan2(X[:, 1], X[:, 0]))
    return float(np.diff(directions, append=directions[0] + 2 * np.pi).max())


def _terms(misfit: Misfit) -> Floats:
    """(6, n, n): what each unknown adds to the Gram matrix beyond two dimensions."""
    X, P = misfit.coordinates(), misfit.projector
    x, y = X.T
    squares = (np.outer(x, y) - np.outer(y, x)) ** 2
    factors = [np.full_like(squares, 1 / 6)]
    factors += [(c[:, None] + c) / 24 for c in (x, y)]
    for a, b in ((x, x), (x, y), (y, y)):
        factors.append(((a * b)[:, None] + a * b + (np.outer(a, b) + np.outer(b, a)) / 2) / 120)
    return np.stack([P @ (squares * factor) @ P for factor in factors])
