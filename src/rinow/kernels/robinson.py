"""Robinson's rational approximation of the curvature of a quadruple with a linear triple, and intervals that hold it.

The points are p, q, r, s with q between p and r: the row a = pq, pr, e = ps, c = qr, b = qs, f = rs.  At q, two
triangles make up a straight angle in S_k for k = κ; each enters by products of its excesses.
"""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.comparison_angles import log_cotangent
from rinow.kernels.embedding_curvatures import root
from rinow.kernels.quadruples import gromov_products, power_of_two
from rinow.kernels.spaceform import log_sine_derivative
from rinow.kernels.triangles import excess
from rinow.tolerances import LINEAR_TRIPLE, METRIC_TRIANGLE_INEQUALITY

INPUT_ERROR = 4.0 * 2.0**-52
"""Relative error of each distance that the enclosures allow for."""
ROUNDING = 32.0 * 2.0**-53
"""Error of the straightness by the rounding of its eight factors."""
MAX_CHORDS = 8
DOMAIN = 0.2
"""The error terms hold for |K| diameter² up to this."""
FIRST_ORDER, SECOND_ORDER = 0.2083, 0.042
"""Largest (K - κ)/(κ² diameter²) and |K2 - κ|/(|K|³ diameter⁴) there."""


@kernel
def corner(a, b, e, slack):
    """Products 2ab cos A and 16 area², how far each moves by errors in the sides; whether A < π in a triangle.

    A is opposite e.  The other sides may exceed the sum of two by slack.
    """
    p, q, r, s = a + b + e, excess(e, a, b), excess(a, b, e), excess(b, e, a)
    is_corner = q > LINEAR_TRIPLE * max(min(a, b), 0.01 * e) and min(r, s) >= -slack
    r, s = max(r, 0.0), max(s, 0.0)
    faces = r * s
    return 0.5 * (p * q - faces), p * q * faces, p * p, p * (q * faces + p * (q * (r + s) + faces)), is_corner


@kernel
def is_straight(a, c, pr, e, f, slack):
    """Whether pr = a + c up to rounding, and pr, e, f satisfy the triangle inequality up to slack."""
    gap = a + c - pr
    straight = -slack <= gap <= LINEAR_TRIPLE * max(min(a, c), 0.01 * pr)
    return straight and pr - e - f <= slack and abs(e - f) - pr <= slack and min(a, c, e, f) >= 0.0


@kernel
def moments(a, b, x):
    """The quantities a² + b² + x/2 and 8(a⁴ + b⁴) + 5a²b² + 4(a² + b²)x + 3x²/4 for x = 2ab cos A."""
    t = a * a + b * b
    return t + 0.5 * x, 8.0 * t * t - 11.0 * a * a * b * b + 4.0 * t * x + 0.75 * x * x


@kernel
def of_order(K, M, N, order):
    """Approximations of κ with errors of the order 2, 4, 6 in the diameter, if K = κ + M κ²/15 + N κ³/1260 + ..."""
    if order == 1:
        return K
    if order == 2:
        return 2.0 * K / (1.0 + math.sqrt(max(1.0 + 4.0 / 15.0 * M * K, 0.0)))
    return K * (1.0 - K * (M / 15.0 - K * (2.0 * M * M / 225.0 - N / 1260.0)))


@kernel
def enclosure(K, M, error, square, order):
    """Interval that holds κ by the bounds of the error; square is diameter².

    Outside their domain it is the half line of the sign that κ has in common with K, or all numbers if K may be 0.
    """
    if not (abs(K) + error) * square <= DOMAIN:
        return (0.0 if K > error else -np.inf), (0.0 if K < -error else np.inf)
    lower, upper = 2.0 * K / (1.0 + math.sqrt(1.0 + 4.0 * FIRST_ORDER * square * K)) - error, K + error
    if order > 1:
        middle, radius = of_order(K, M, 0.0, 2), SECOND_ORDER * abs(K) ** 3 * square * square + 1.5 * error
        lower, upper = max(lower, middle - radius), min(upper, middle + radius)
    return lower, upper


@kernel
def robinson(d, order):
    """K or an approximation of higher order, and an interval that holds κ; nan unless q lies between p and r only."""
    a, pr, e, c, b, f = d[0], d[1], d[2], d[3], d[4], d[5]
    longest = max(a, pr, e, c, b, f)
    if not longest < np.inf:
        return np.nan, np.nan, np.nan
    slack = METRIC_TRIANGLE_INEQUALITY * longest
    x, xx, dx, dxx, is_corner_p = corner(a, b, e, slack)
    y, yy, dy, dyy, is_corner_r = corner(c, b, f, slack)
    if not (is_corner_p and is_corner_r and is_straight(a, c, pr, e, f, slack)):
        return np.nan, np.nan, np.nan
    total = c * xx + a * yy
    if total == 0.0:
        return np.inf, 0.0, np.inf
    K = 12.0 * (c * x + a * y) / total
    error = INPUT_ERROR * (12.0 * (c * dx + a * dy) + abs(K) * (c * dxx + a * dyy)) / total
    M = N = 0.0
    if order > 1:
        (m, n), (m_r, n_r) = moments(a, b, x), moments(c, b, y)
        M, N = (c * xx * m + a * yy * m_r) / total, (c * xx * n + a * yy * n_r) / total
    lower, upper = enclosure(K, M, error, longest * longest, order)
    return of_order(K, M, N, order), lower, upper


@kernel
def straightness(k, G):
    """ln(cot A/2 · cot A'/2) in S_k for the two angles at q: decreasing in k, 0 where they make up a straight angle."""
    right = log_cotangent(G[0, 0], G[0, 1], G[0, 2], G[0, 3], k)[0]
    return right + log_cotangent(G[2, 2], G[2, 1], G[2, 0], G[2, 3], k)[0]


@kernel
def straightness_derivative(k, G):
    """Derivative of the straightness in k, and a bound of what errors in the distances and rounding do to it."""
    slope, error = 0.0, 0.0
    for t in range(0, 4, 2):
        for x in range(4):
            q = log_sine_derivative(G[t, x], k)
            slope += 0.5 * q if x == t or x == 1 else -0.5 * q
            error += 0.5 * G[t, t] / G[t, x] * abs(1.0 + 2.0 * k * q) if G[t, x] > 0.0 else np.inf
    return slope, INPUT_ERROR * error + ROUNDING


@kernel
def exact_curvature(k, G, k_max):
    """Zero of the straightness, its slope and the error there; by the chord method from k, or from afar if k is nan."""
    if not np.isnan(k):
        slope, error = straightness_derivative(k, G)
        for _ in range(MAX_CHORDS):
            value = straightness(k, G)
            k -= value / slope
            if abs(value) <= 0.1 * error < np.inf:
                return k, slope, error
    k = root(1, -1, k_max, 0.0, math.sqrt(k_max), G)
    k = k_max if np.isnan(k) else k
    slope, error = straightness_derivative(k, G)
    return k, slope, error


@kernel
def verified(d, value, lower, upper, G):
    """The value moved into a sharper interval, whose ends are proved by the sign of the straightness there."""
    if np.isnan(value):
        return value, lower, upper
    scale = power_of_two(max(d[1], d[2], d[4], d[5]))
    gromov_products(d, scale, G)
    G[3, 1] = 0.0
    unit = scale * scale
    k_max = (math.pi / max(G[0, 0], G[1, 1], G[2, 2], G[3, 3])) ** 2
    start = value / unit if -np.inf < lower and upper < np.inf else np.nan
    k, slope, error = exact_curvature(start, G, k_max)
    radius = 2.0 * error / abs(slope)
    if radius < np.inf and straightness(k - radius, G) > error:
        lower = max(lower, (k - radius) * unit)
    if k + radius >= k_max:
        upper = min(upper, k_max * (1.0 + 3.0 * INPUT_ERROR) * unit)
    elif straightness(k + radius, G) < -error:
        upper = min(upper, (k + radius) * unit)
    return min(max(value, lower), upper), lower, upper


@parallel_kernel
def robinsons(quadruples, order, value, lower, upper):
    """Write value and interval of each row."""
    for row in prange(quadruples.shape[0]):
        value[row], lower[row], upper[row] = robinson(quadruples[row], order)


@parallel_kernel
def verified_robinsons(quadruples, value, lower, upper):
    """Sharpen the value and the interval of each row."""
    for row in prange(quadruples.shape[0]):
        G = np.empty((4, 4))
        value[row], lower[row], upper[row] = verified(quadruples[row], value[row], lower[row], upper[row], G)
