"""The three angles at one point of a quadruple, in S_k: the equations that an embedding curvature solves.

With the Gromov products g of a triple and half its perimeter s (`quadruples.gromov_products`), the angle at v between
i and j has cot²(angle/2) = s_k(s) s_k(g_v) / (s_k(g_i) s_k(g_j)).  Its logarithm neither overflows nor cancels, for
any k and any thin or wide angle, and its derivatives are sums of logarithmic derivatives of s_k.
"""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.quadruples import COINCIDENT, NOT_A_METRIC, other_three, other_two, read_quadruple
from rinow.kernels.spaceform import FAR, FULL_CIRCLE, log_sine_derivative, sine_and_log_derivative


@kernel
def decay_and_log_derivative(x, k):
    """1 - exp(-2√-k x), which is s_k(x) without its growth, and the derivative of ln s_k(x) in k; for k < 0."""
    t = math.sqrt(-k) * x
    decay = -math.expm1(-2.0 * t)
    return decay, (t * (2.0 - decay) / decay - 1.0) / (2.0 * k) if decay > 0.0 else 0.0


@kernel
def log_cotangent(s, g, g1, g2, k):
    """The logarithm of cot(angle/2) and its derivative in k; -inf for the angle π, inf for the angle 0."""
    if k * s * s >= FAR:
        exponent = 0.0
        (over1, q1), (over2, q2) = sine_and_log_derivative(s, k), sine_and_log_derivative(g, k)
        (under1, q3), (under2, q4) = sine_and_log_derivative(g1, k), sine_and_log_derivative(g2, k)
    else:
        exponent = math.sqrt(-k) * g
        (over1, q1), (over2, q2) = decay_and_log_derivative(s, k), decay_and_log_derivative(g, k)
        (under1, q3), (under2, q4) = decay_and_log_derivative(g1, k), decay_and_log_derivative(g2, k)
    slope = 0.5 * ((q1 - q3) + (q2 - q4))
    if under1 == 0.0 or under2 == 0.0:
        return np.inf, slope
    ratio = (over1 / under1) * (over2 / under2)
    return (exponent + 0.5 * math.log(ratio) if ratio > 0.0 else -np.inf), slope


@kernel
def around(a, b, c):
    """Value of ln(cot A cot B + cot B cot C + cot C cot A), half angles, and its derivatives in the logarithms a, b, c.

    It is 0 where the angles sum to 2π, negative where they exceed that.
    """
    x, y, z = b + c, c + a, a + b
    top = max(x, y, z)
    x, y, z = math.exp(x - top), math.exp(y - top), math.exp(z - top)
    total = x + y + z
    return top + math.log(total), (y + z) / total, (z + x) / total, (x + y) / total


@kernel
def across(a, b, c):
    """-ln(cot A/cot B + cot A/cot C + 1/(cot B cot C)), and its derivatives; 0 where A = B + C, negative for A less."""
    x, y, z = a - b, a - c, -b - c
    top = max(x, y, z)
    x, y, z = math.exp(x - top), math.exp(y - top), math.exp(z - top)
    total = x + y + z
    return -top - math.log(total), -(x + y) / total, (x + z) / total, (y + z) / total


@kernel
def three_triples(v, o):
    """The points t whose omission leaves the three triples at v; o comes first if it is one of them."""
    i, j, m = other_three(v)
    if o == j:
        return j, i, m
    return (m, i, j) if o == m else (i, j, m)


@kernel
def balance(v, o, k, G):
    """The value of `around` (o < 0) or `across` (A between the neighbours of v other than o), and its derivative in k.

    Both decrease in k: the first from inf to its zero at the planar embedding curvature, the second to its zero at the
    nonplanar one, where v and o are opposite corners.
    """
    i, j, m = three_triples(v, o)
    a, da = log_cotangent(G[i, i], G[i, v], G[i, j], G[i, m], k)
    b, db = log_cotangent(G[j, j], G[j, v], G[j, i], G[j, m], k)
    c, dc = log_cotangent(G[m, m], G[m, v], G[m, i], G[m, j], k)
    value, wa, wb, wc = around(a, b, c) if o < 0 else across(a, b, c)
    return value, wa * da + wb * db + wc * dc


@kernel
def angle_sum(v, k, G):
    """Sum of the three angles at v."""
    total = 0.0
    for t in three_triples(v, -1):
        i, j = other_two(v, t)
        total += 2.0 * math.atan(math.exp(-log_cotangent(G[t, t], G[t, v], G[t, i], G[t, j], k)[0]))
    return total


@kernel
def cotangent(x, k):
    """Derivative of ln s_k(x) in x."""
    return (1.0 + 2.0 * k * log_sine_derivative(x, k)) / x


@kernel
def _side_derivatives(weight, s, g, g1, g2, k):
    """Derivatives of weight · ln cot(angle/2) in the side opposite v and in the sides from v to i and to j."""
    if weight == 0.0:
        return 0.0, 0.0, 0.0
    weight *= 0.25
    c, c_v, c_i, c_j = cotangent(s, k), cotangent(g, k), cotangent(g1, k), cotangent(g2, k)
    return weight * (c - c_v - c_i - c_j), weight * (c + c_v - c_i + c_j), weight * (c + c_v + c_i - c_j)


@kernel
def condition(v, o, k, G):
    """Largest derivative of a zero k of `balance` in a distance, by the implicit function theorem."""
    i, j, m = three_triples(v, o)
    a, da = log_cotangent(G[i, i], G[i, v], G[i, j], G[i, m], k)
    b, db = log_cotangent(G[j, j], G[j, v], G[j, i], G[j, m], k)
    c, dc = log_cotangent(G[m, m], G[m, v], G[m, i], G[m, j], k)
    _, a, b, c = around(a, b, c) if o < 0 else across(a, b, c)
    slope = a * da + b * db + c * dc
    a, a_j, a_m = _side_derivatives(a, G[i, i], G[i, v], G[i, j], G[i, m], k)
    b, b_i, b_m = _side_derivatives(b, G[j, j], G[j, v], G[j, i], G[j, m], k)
    c, c_i, c_j = _side_derivatives(c, G[m, m], G[m, v], G[m, i], G[m, j], k)
    largest = max(abs(a), abs(b), abs(c), abs(b_i + c_i), abs(a_j + c_j), abs(a_m + b_m))
    return largest / abs(slope)


@parallel_kernel
def planarities(quadruples, k, tolerance, out):
    """Write whether the angles of each quadruple in the surface of its k sum to 2π at some point, up to tolerance."""
    for row in prange(quadruples.shape[0]):
        G = np.empty((4, 4))
        scale, relation, _ = read_quadruple(quadruples[row], G)
        u = k[row] / (scale * scale)
        s = max(G[0, 0], G[1, 1], G[2, 2], G[3, 3])
        out[row] = False
        if relation != NOT_A_METRIC and relation != COINCIDENT and u * s * s <= FULL_CIRCLE * FULL_CIRCLE:
            for v in range(4):
                out[row] |= abs(angle_sum(v, u, G) - 2.0 * math.pi) <= tolerance
