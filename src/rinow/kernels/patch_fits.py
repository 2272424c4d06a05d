"""Fits about the centres of patches: tables of their errors for all orders and radii, frames, and curvatures."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels import nested_fits
from rinow.kernels._jit import lean
from rinow.kernels.nested_fits import N_ORDERS
from rinow.kernels.osculating_torus import offset_forms

N_BIASES = N_ORDERS - 2
"""Orders whose bias is seen by comparison with the order two above."""
GAUSSIAN, MEAN, BOTH = 0, 1, 2
"""Whose errors the tables hold: of K, of H, or the root of the squares of those of K and of H times the curvedness of
the surface.  Both together are less often small by chance than either, and K alone tells no error of a minimal surface
that bends it alike in all directions."""
LOPSIDED = 0.3
"""Distance of the mean of the points from the centre, over the radius, from which on odd terms bias the centre too.

It is 0.42 for half a disc.  There the next order shows the bias, with much less variance than the order two above.
"""
PLAIN, FARTHER = 20.0, 60.0
"""Over such a ball the order two above, and those farther above, count for what their squared differences exceed so
many times the variance."""
WORSE = 30.0
"""Leverage over that of two orders below from which on an order tells less than that: of few rows of points it
interpolates what it cannot resolve."""
STEEP = 0.3
"""Largest squared slope of a fit over its torus: a steeper one has a curvature, and an error, near 0 by its volume."""


class Tables(NamedTuple):
    """One row for each centre and radius of its window, lengths in the spacing of the centre.

    variance (T, 7): of the curvatures, nan without a fit; bias (T, 5): squared differences to a higher order;
    bias_variance (T, 5): their variances; leverage (T, 7): points times variance of the mean curvature for unit noise;
    step (T, 7): squared differences to the same order in the next smaller ball, less their variances;
    step_variance, second and noise (T, 7), or no rows: for unknown noise these variances, which then are still to be
    subtracted, the variance of second order, and the residual variance.
    """

    variance: np.ndarray
    bias: np.ndarray
    bias_variance: np.ndarray
    leverage: np.ndarray
    step: np.ndarray
    step_variance: np.ndarray
    second: np.ndarray
    noise: np.ndarray


@lean
def forms_at_centre(jet, k1, k2):
    """`offset_forms` at u = 0."""
    return offset_forms((1.0, 0.0, 0.0), k1, k2, jet[0], jet[1], jet[2], jet[3], jet[4], jet[5])


@lean
def curvature_and_gradients(jet, k1, k2):
    """K, H, gradients of both by (f11, f12, f22), and the factor of f11 f22 - f12^2 in K."""
    g11, g12, g22, l, m, n, volume = forms_at_centre(jet, k1, k2)
    area = (1.0 - k1 * jet[0]) * (1.0 - k2 * jet[0])
    d = volume * volume
    p, q = area / (d * volume), 0.5 * area / (d * volume)
    gaussian, mean = (l * n - m * m) / d, 0.5 * (g22 * l - 2.0 * g12 * m + g11 * n) / d
    return gaussian, mean, (p * n, -2.0 * p * m, p * l), (q * g22, -2.0 * q * g12, q * g11), area * area / (d * d)


@lean
def quadratic_form(g, c):
    """g^T C g for the covariances C11, C12, C13, C22, C23, C33."""
    a, b, d = g[0], g[1], g[2]
    total = a * a * c[0] + b * b * c[3] + d * d * c[5] + 2.0 * (a * b * c[1] + a * d * c[2] + b * d * c[4])
    return max(total, 0.0)


@lean
def write_no_row(t, tables):
    """Write nan for a ball that has no points beyond the one below it."""
    tables.variance[t, :] = np.nan
    tables.bias[t, :] = np.nan
    tables.bias_variance[t, :] = np.nan
    tables.leverage[t, :] = 0.0
    tables.step[t, :] = np.nan
    if tables.second.shape[0]:
        tables.step_variance[t, :] = np.nan
        tables.second[t, :] = np.nan
        tables.noise[t, :] = np.nan


@lean
def shares(errors_of, curvedness):
    """Factors of K and of H in the errors asked for."""
    if errors_of == MEAN:
        return 0.0, 1.0
    return 1.0, curvedness if errors_of == BOTH else 0.0


@lean
def write_weighted(gaussian, mean, of_gaussian, of_mean, share, values, gradients):
    """Write K and H and their gradients times their shares."""
    values[0], values[1] = share[0] * gaussian, share[1] * mean
    for k in range(3):
        gradients[0, k], gradients[1, k] = share[0] * of_gaussian[k], share[1] * of_mean[k]


@lean
def sum_of_forms(gradients, share, c):
    """Variance of both by the covariances of the second derivatives."""
    total = quadratic_form(gradients[0], c)
    return total + quadratic_form(gradients[1], c) if share[1] > 0.0 else total


@lean
def squared_difference(a, b, first, second):
    """Squared distance of (a, b) from the pair of another fit."""
    return (a - first) ** 2 + (b - second) ** 2


@lean
def write_row(t, count, top, share, k1, k2, s2, fit, tables, values, gradients):
    """Write one row of the tables from the orders 2..top of one ball, for noise of variance s2."""
    known = tables.second.shape[0] == 0
    write_no_row(t, tables)
    for d in range(2, top + 1):
        i = d - 2
        jet, c = fit.jets[d], fit.covariances[d]
        gaussian, mean, of_gaussian, of_mean, factor = curvature_and_gradients(jet, k1, k2)
        write_weighted(gaussian, mean, of_gaussian, of_mean, share, values[d], gradients[d])
        if not jet[1] * jet[1] + jet[2] * jet[2] <= STEEP:
            values[d] = np.nan
            continue
        linear = s2 * sum_of_forms(gradients[d], share, c)
        second = (share[0] * s2 * factor) ** 2 * (c[0] * c[5] + c[2] * c[2] + 2.0 * c[3] * c[3])
        tables.variance[t, i] = linear + second if known else linear
        tables.leverage[t, i] = count * quadratic_form(of_mean, c)
        if not known:
            tables.second[t, i] = second
            spare = count - nested_fits.TERMS[d]
            enough = spare >= max(4, nested_fits.TERMS[d] // 2)
            tables.noise[t, i] = fit.residuals[d] / spare if enough else np.nan


@lean
def excess_over(d, above, times, share, s2, fit, values, gradients):
    """What orders d and `above` differ by, squared and less so many times its variance, and that variance.

    They are nested fits of least squares, so that the variance of the difference is that of the variances.
    """
    if math.isnan(values[above, 0]):
        return np.nan, np.nan
    more = sum_of_forms(gradients[d], share, fit.covariances[above])
    v = s2 * max(more - sum_of_forms(gradients[d], share, fit.covariances[d]), 0.0)
    return squared_difference(values[d, 0], values[d, 1], values[above, 0], values[above, 1]) - times * v, v


@lean
def write_biases(t, reach, top, share, s2, fit, tables, values, gradients):
    """Write what orders differ by from the order two above, or over a lopsided ball from the next one.

    Over a lopsided ball orders may agree with the next by chance, or drift from one to the next: what any order above
    shows plainly counts.
    """
    known = tables.second.shape[0] == 0
    lopsided = fit.origin[0] ** 2 + fit.origin[1] ** 2 > (LOPSIDED * reach) ** 2
    lag = 1 if lopsided else 2
    for d in range(2, min(top - lag, N_BIASES + 1) + 1):
        if math.isnan(values[d, 0]):
            continue
        excess, v = excess_over(d, d + lag, 1.0 if known else 0.0, share, s2, fit, values, gradients)
        if lopsided and known:
            for above in range(d + 2, top + 1):
                if above > d + 2 and tables.leverage[t, above - 2] > WORSE * tables.leverage[t, above - 4]:
                    break
                times = PLAIN if above == d + 2 else FARTHER
                excess = max(excess, excess_over(d, above, times, share, s2, fit, values, gradients)[0])
        tables.bias[t, d - 2], tables.bias_variance[t, d - 2] = excess, v


@lean
def write_steps(t, reach, top, share, s2, fit, tables, values, gradients, smaller):
    """Write what the orders 2..top differ by from those in a smaller ball, which is then replaced by this one.

    Of least squares over nested balls the larger one has no covariance with the difference, whose variance v therefore
    is the difference of the variances; what exceeds 2v counts.  Truncation errors grow with the radius r like r^(d+1)
    times the root of the leverage, unless the points of the smaller ball lie much worse: the squared difference is
    divided between both by the squares of that.
    """
    known = tables.second.shape[0] == 0
    for d in range(2, top + 1):
        if math.isnan(values[d, 0]):
            continue
        before, c, leverage = smaller[d], fit.covariances[d], tables.leverage[t, d - 2]
        if before[9] > 0.0 and leverage > 0.0:
            part = 1.0 / (1.0 + (before[8] / reach) ** (2 * (d + 1)) * before[9] / leverage)
            less = sum_of_forms(gradients[d], share, before[2:8]) - sum_of_forms(gradients[d], share, c)
            v = 2.0 * s2 * max(less, 0.0)
            e2 = squared_difference(values[d, 0], values[d, 1], before[0], before[1])
            tables.step[t, d - 2] = part * (e2 - (v if known else 0.0))
            if not known:
                tables.step_variance[t, d - 2] = part * v
        before[0], before[1], before[8], before[9] = values[d, 0], values[d, 1], reach, leverage
        for k in range(6):
            before[2 + k] = c[k]


@lean
def write_rows(t, points, n, reaches, order, share, k1, k2, s2, fit, tables, values, gradients, smaller):
    """Write one row for each of some nested balls from row t on; of one-sided ones each has an origin of its own."""
    before, apart = 0.0, False
    smaller[:] = 0.0
    if order >= 2:
        apart = nested_fits.place_origin(points, n, reaches[-1], fit)
        if not apart:
            nested_fits.add_moments(points, n, reaches, order, fit)
    for k in range(len(reaches)):
        if apart:
            nested_fits.place_origin(points, n, reaches[k], fit)
            nested_fits.add_moments(points, n, reaches[k : k + 1], order, fit)
        shell = 0 if apart else k
        count = fit.counts[shell] if order >= 2 else 0.0
        top = nested_fits.highest_order(count, order)
        if count == before or top < 2:
            write_no_row(t + k, tables)
            continue
        before = count
        top = nested_fits.fit_orders(shell, reaches[k], top, fit)
        write_row(t + k, count, top, share, k1, k2, s2, fit, tables, values, gradients)
        write_biases(t + k, reaches[k], top, share, s2, fit, tables, values, gradients)
        write_steps(t + k, reaches[k], top, share, s2, fit, tables, values, gradients, smaller)
