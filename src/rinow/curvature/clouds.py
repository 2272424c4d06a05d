"""Points that lie on a surface in space: lengths of arcs along it from straight distances."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from rinow import tolerances

__all__ = ["arc_distances"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

QUARTIC = np.add.outer(np.arange(5), np.arange(5)) <= 4
"""Which products of powers of x and y a polynomial of degree 4 has: 15."""
NEEDED = 25
"""Points that determine the coefficients and show how well they fit."""
FLATNESS = 0.05
"""Largest residual, over the radius, of points that lie on a surface; those that fill a ball have 0.4."""


def arc_distances(points: Floats, chosen: Indices) -> tuple[Floats, float] | None:
    r"""Lengths of the shortest arcs between points of a surface patch.

    Parameters
    ----------
    points : (n, 3) ndarray of float
        All points of the patch.
    chosen : (m,) ndarray of intp
        Those whose distances are wanted.

    Returns
    -------
    distances : (m, m) ndarray of float
        Symmetric, with zero diagonal.
    rtol : float
        About the share by which they are off.

    Notes
    -----
    None is returned for fewer than 25 points, and if they are not on a surface: their distances from the polynomial of
    degree 4 over a plane that fits them best have a root mean square above a twentieth of the radius.

    The arc over a chord c is that of a circle with the normal curvature κ of the polynomial in the middle of the chord
    and in its direction: :math:`(2/\kappa)\arcsin(\kappa c/2)`, in the limit :math:`c(1 + (\kappa c)^2/24)` (Haantjes).
    A misfit σ of the polynomial changes κ by about 8σ/radius², the bends of the arc that the circle leaves out change
    its length by up to 0.003 (κc)⁴.
    """
    if len(points) < NEEDED:
        return None
    X = points - points.mean(axis=0)
    X = X @ np.linalg.svd(X, full_matrices=False)[2].T
    radius = float(np.linalg.norm(X, axis=1).max())
    x, y, z = X.T / radius
    powers = polynomial.polyvander2d(x, y, [4, 4])[:, QUARTIC.ravel()]
    coefficients = np.linalg.lstsq(powers, z)[0]
    misfit = float((((z - powers @ coefficients) ** 2).sum() / (len(z) - len(coefficients))) ** 0.5)
    if not misfit <= FLATNESS:
        return None
    height = np.zeros(QUARTIC.shape)
    height[QUARTIC] = coefficients
    chords, curvatures = _chords(X[chosen] / radius, height)
    half = np.clip(0.5 * curvatures * chords, 1e-12, 1.0)
    rtol = 3 * misfit * float(curvatures.max()) + 3e-3 * float(2 * half.max()) ** 4
    return radius * chords * np.arcsin(half) / half, max(rtol, tolerances.COMPARISON)


def _chords(X: Floats, height: Floats) -> tuple[Floats, Floats]:
    """Lengths of all chords near the graph of a polynomial, and its normal curvatures, without sign, along them."""
    middle, chord = 0.5 * (X[:, None] + X), X[:, None] - X
    u, v = chord[..., 0], chord[..., 1]

    def derivative(i: int, j: int) -> Floats:
        c = polynomial.polyder(polynomial.polyder(height, i, axis=0), j, axis=1)
        return np.asarray(polynomial.polyval2d(middle[..., 0], middle[..., 1], c), np.float64)

    p, q = derivative(1, 0), derivative(0, 1)
    second = derivative(2, 0) * u * u + 2 * derivative(1, 1) * u * v + derivative(0, 2) * v * v
    first = np.maximum(u * u + v * v + (p * u + q * v) ** 2, np.finfo(np.float64).tiny)
    return np.linalg.norm(chord, axis=-1), np.abs(second / first) / np.sqrt(1 + p * p + q * q)
