"""Fits about the centres of patches: tables of their errors for all orders and radii, frames, and curvatures."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels import nested_fits
from rinow.kernels._jit import inner
from rinow.kernels.nested_fits import N_ORDERS
from rinow.kernels.osculating_torus import offset_forms

N_BIASES = N_ORDERS - 2
"""Orders whose bias is seen by comparison with the order two above."""
STEEP = 0.3
"""Largest squared slope of a fit over its torus: a steeper one has a curvature, and an error, near 0 by its volume."""


class Tables(NamedTuple):
    """One row for each centre and radius of its window, lengths in the spacing of the centre.

    variance (T, 7): of the curvature, nan without a fit; bias (T, 5): squared differences to the order two above;
    bias_variance (T, 5): their variances; leverage (T, 7): points times variance of the mean curvature for unit noise;
    jump (T, 7): squared differences to the quadric of the least ball that also has order 4, nan before it;
    second (T, 7) and noise (T, 7), or no rows: variance of second order and residual variance, for unknown noise.
    """

    variance: np.ndarray
    bias: np.ndarray
    bias_variance: np.ndarray
    leverage: np.ndarray
    jump: np.ndarray
    second: np.ndarray
    noise: np.ndarray


@inner
def forms_at_centre(jet, k1, k2):
    """`offset_forms` at u = 0."""
    return offset_forms((1.0, 0.0, 0.0), k1, k2, jet[0], jet[1], jet[2], jet[3], jet[4], jet[5])


@inner
def curvature_and_gradients(jet, k1, k2):
    """K, H, gradients of both by (f11, f12, f22), and the factor of f11 f22 - f12^2 in K."""
    g11, g12, g22, l, m, n, volume = forms_at_centre(jet, k1, k2)
    area = (1.0 - k1 * jet[0]) * (1.0 - k2 * jet[0])
    d = volume * volume
    p, q = area / (d * volume), 0.5 * area / (d * volume)
    gaussian, mean = (l * n - m * m) / d, 0.5 * (g22 * l - 2.0 * g12 * m + g11 * n) / d
    return gaussian, mean, (p * n, -2.0 * p * m, p * l), (q * g22, -2.0 * q * g12, q * g11), area * area / (d * d)


@inner
def quadratic_form(g, c):
    """g^T C g for the covariances C11, C12, C13, C22, C23, C33."""
    a, b, d = g
    total = a * a * c[0] + b * b * c[3] + d * d * c[5] + 2.0 * (a * b * c[1] + a * d * c[2] + b * d * c[4])
    return max(total, 0.0)


@inner
def write_no_row(t, tables):
    """Write nan for a ball that has no points beyond the one below it."""
    tables.variance[t, :] = np.nan
    tables.bias[t, :] = np.nan
    tables.bias_variance[t, :] = np.nan
    tables.leverage[t, :] = 0.0
    tables.jump[t, :] = np.nan
    if tables.second.shape[0]:
        tables.second[t, :] = np.nan
        tables.noise[t, :] = np.nan


@inner
def write_row(t, count, top, is_mean, k1, k2, s2, fit, tables, values, gradients):
    """Write one row of the tables from the orders 2..top of one ball, for noise of variance s2."""
    known = tables.second.shape[0] == 0
    write_no_row(t, tables)
    for d in range(2, top + 1):
        i = d - 2
        jet, c = fit.jets[d], fit.covariances[d]
        gaussian, mean, of_gaussian, of_mean, factor = curvature_and_gradients(jet, k1, k2)
        values[d], gradient = (mean, of_mean) if is_mean else (gaussian, of_gaussian)
        gradients[d, 0], gradients[d, 1], gradients[d, 2] = gradient
        if not jet[1] * jet[1] + jet[2] * jet[2] <= STEEP:
            values[d] = np.nan
            continue
        linear = s2 * quadratic_form(gradient, c)
        second = 0.0
        if not is_mean:
            second = (s2 * factor) ** 2 * (c[0] * c[5] + c[2] * c[2] + 2.0 * c[3] * c[3])
        tables.variance[t, i] = linear + second if known else linear
        tables.leverage[t, i] = count * quadratic_form(of_mean, c)
        if not known:
            tables.second[t, i] = second
            spare = count - nested_fits.TERMS[d]
            enough = spare >= max(4, nested_fits.TERMS[d] // 2)
            tables.noise[t, i] = fit.residuals[d] / spare if enough else np.nan
    for d in range(2, top - 1):
        if not math.isnan(values[d]) and not math.isnan(values[d + 2]):
            above, below = fit.covariances[d + 2], fit.covariances[d]
            gradient = (gradients[d, 0], gradients[d, 1], gradients[d, 2])
            v = s2 * max(quadratic_form(gradient, above) - quadratic_form(gradient, below), 0.0)
            e = values[d] - values[d + 2]
            tables.bias_variance[t, d - 2] = v
            tables.bias[t, d - 2] = e * e - (v if known else 0.0)


@inner
def write_rows(t, points, n, reaches, order, is_mean, k1, k2, s2, fit, tables, values, gradients):
    """Write one row for each of some nested balls from row t on; of one-sided ones each has an origin of its own."""
    before, reference, apart = 0.0, np.nan, False
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
        write_row(t + k, count, top, is_mean, k1, k2, s2, fit, tables, values, gradients)
        if math.isnan(reference) and not math.isnan(tables.bias[t + k, 0]):
            reference = values[2]
        for d in range(2, top + 1):
            tables.jump[t + k, d - 2] = (values[d] - reference) ** 2
