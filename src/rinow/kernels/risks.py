"""Choice of order and radius at centres: squared bias plus variance, averaged over the centres around."""

import math

import numpy as np

from rinow.kernels._jit import inner, parallel_kernel, prange
from rinow.kernels.nested_fits import N_ORDERS
from rinow.kernels.patch_fits import N_BIASES, WORSE

KAPPA = 0.2
"""The squared bias is at least this share of the variance of the comparison that shows it."""
DECAY = 10.0
"""The bias of the two highest orders is at most that of two orders below, and this times the ratio seen there."""
ODD = 0.5
"""The squared bias of an odd order is at least this share of the lesser one of the even orders beside it."""
UNSEEN = 0.3
"""Bias, over the inverse square of the radius, of a quadric where nothing is there to compare it with."""
CLEAR = 0.05
"""Share of squared errors in mean squares up to which there is nothing to gain by shrinkage: then no value depends on
those around."""
ROUNDING, MIDDLE = 1e-13, 5.0
"""Error of K by rounding, over the inverse square of the spacing, and the radius to take if all are that good."""


@parallel_kernel
def average_rows(values, spacing, power, rows, low, high, links, starts, out):
    """Write the mean of each entry over a centre and those linked to it, at the same radius; nan is left out.

    An entry is in the unit spacing^-power of its own centre, and so is the mean.
    """
    for i in prange(len(low)):
        width, near = values.shape[1], links[starts[i] : starts[i + 1]]
        totals, counts = np.empty(width), np.empty(width)
        for k in range(high[i] - low[i] + 1):
            totals[:], counts[:] = 0.0, 0.0
            for n in near:
                j = low[i] + k - low[n]
                if 0 <= j <= high[n] - low[n]:
                    unit, row = (spacing[i] / spacing[n]) ** power, values[rows[n] + j]
                    for c in range(width):
                        is_known = not math.isnan(row[c])
                        totals[c] += row[c] * unit if is_known else 0.0
                        counts[c] += 1.0 if is_known else 0.0
            for c in range(width):
                out[rows[i] + k, c] = totals[c] / counts[c] if counts[c] > 0.0 else np.nan


@parallel_kernel
def median_rows(values, links, starts, out):
    """Write the lower median of each entry over a centre and those linked to it; nan is left out."""
    for i in prange(len(out)):
        sorted_values = np.empty(starts[i + 1] - starts[i])
        for c in range(values.shape[1]):
            count = 0
            for m in range(starts[i], starts[i + 1]):
                x, j = values[links[m], c], count
                if math.isnan(x):
                    continue
                while j > 0 and sorted_values[j - 1] > x:
                    sorted_values[j] = sorted_values[j - 1]
                    j -= 1
                sorted_values[j] = x
                count += 1
            out[i, c] = sorted_values[(count - 1) // 2] if count else np.nan


@inner
def squared_biases(t, ratio, upper, tables, bias, bias_variance, step, out):
    """Write the squared bias of each order; where the order two above is missing, from the next larger ball `upper`.

    A truncation error of order d is at most r^(d+1) times the square root of points times variance.  Orders over a ball
    too large for any of them may agree with each other by chance, and the two highest have none above; but a bias that
    grows like r^d differs from that of a smaller ball by most of itself.  Odd terms hardly reach the second derivatives
    at the centre, so that an odd order errs about as the even ones beside it.
    """
    for i in range(N_BIASES):
        own = not math.isnan(tables.variance[t, i + 2]) and not math.isnan(bias[t, i])
        if own:
            out[i] = max(bias[t, i], KAPPA * bias_variance[t, i])
        elif upper >= 0 and tables.leverage[upper, i] > 0.0:
            out[i] *= ratio ** (2 * (i + 3)) * tables.leverage[t, i] / tables.leverage[upper, i]
        else:
            out[i] = np.nan
    for i in range(N_BIASES, N_ORDERS):
        lower = out[i - 4]
        out[i] = out[i - 2] * min(1.0, DECAY * out[i - 2] / lower) if lower > 0.0 else out[i - 2]
        most = WORSE * tables.leverage[t, i - 2]
        if tables.leverage[t, i] > most > 0.0:
            out[i] *= tables.leverage[t, i] / most
    for i in range(N_ORDERS):
        if step[t, i] > out[i]:
            out[i] = step[t, i]
    for i in range(1, N_ORDERS, 2):
        beside = min(out[i - 1], out[i + 1])
        if beside > 0.0:
            out[i] = max(out[i], ODD * beside)


@parallel_kernel
def least_risks(
    rows, low, high, reaches, factors, tables, variance, bias, bias_variance, step, radius, order, risk, logs
):
    """Write radius index (-1: none), order and value of the least risk of each centre; logs (n, R, 7) unless empty."""
    for i in prange(len(low)):
        biases = np.empty(N_ORDERS)
        biases[:] = np.nan
        best, best_radius, best_order, upper, last, fallback = np.inf, -1, 0, -1, 0, -1
        for k in range(high[i] - low[i], -1, -1):
            t = rows[i] + k
            if math.isnan(tables.variance[t, 0]):
                continue
            ratio = reaches[low[i] + k] / reaches[last] if upper >= 0 else 1.0
            squared_biases(t, ratio, upper, tables, bias, bias_variance, step, biases)
            upper, last = t, low[i] + k
            floor = ROUNDING * ROUNDING * (1.0 + math.log(reaches[low[i] + k] * factors[i] / MIDDLE) ** 2)
            for d in range(N_ORDERS):
                if math.isnan(tables.variance[t, d]) or math.isnan(biases[d]):
                    continue
                value = max(max(tables.variance[t, d], variance[t, d]) + biases[d], floor)
                if len(logs):
                    logs[i, low[i] + k, d] = math.log(value)
                if value <= best:  # the highest order below the error of rounding
                    best, best_radius, best_order = value, low[i] + k, d + 2
            if best_order == 0:
                fallback = low[i] + k
        if best_order == 0 and fallback >= 0:
            t = rows[i] + fallback - low[i]
            guess = UNSEEN / (reaches[fallback] * factors[i]) ** 2
            best_radius, best_order, best = fallback, 2, tables.variance[t, 0] + guess * guess
        radius[i], order[i], risk[i] = best_radius, best_order, best


@inner
def shrinkage(share):
    """Factor for values whose squares hold such a share of error: 1 up to `CLEAR`, 0 from 1 on."""
    return min(max((1.0 - share) / (1.0 - CLEAR), 0.0), 1.0)


@parallel_kernel
def disc_shrinkage(starts, members, gaussian, risk, out):
    """Write the shrinkage for the share n / sum(K^2 / risk) over the n values of each disc; 1 without any."""
    for i in prange(len(starts) - 1):
        total, count = 0.0, 0
        for k in range(starts[i], starts[i + 1]):
            x = gaussian[members[k]]
            if not math.isnan(x):
                total += x * x / risk[members[k]]
                count += 1
        out[i] = shrinkage(count / total) if total > 0.0 else 1.0


@parallel_kernel
def vertex_means(starts, near, values, out):
    """Write the mean of the values of the samples near each vertex; 1 without."""
    for v in prange(len(starts) - 1):
        total = 0.0
        for k in range(starts[v], starts[v + 1]):
            total += values[near[k]]
        out[v] = total / (starts[v + 1] - starts[v]) if starts[v + 1] > starts[v] else 1.0
