"""The simply connected surface S_k of constant curvature k: one set of formulas for every sign of k.

Everything is written with s_k(x) = sin(√k x)/√k, x or sinh(√-k x)/√-k, which is entire in k: k = 0 is not special.
Lengths enter as u = k x², by a power series for |u| <= 1 and by library functions beyond, so no digit is lost near
k = 0.  A triangle fits into S_k, k > 0, if its perimeter is at most 2π/√k.
"""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.triangles import excess
from rinow.tolerances import TRIANGLE_INEQUALITY

FULL_CIRCLE = math.pi * (1.0 + 1e-14)
"""A semiperimeter √k s up to this is a great circle, rounded."""
FAR = -400.0
"""Below this value of k s² sides are compared by exponentials, which cannot overflow."""
OVERFLOW = 710.0
"""Hyperbolic functions of larger numbers are inf."""
SINE = tuple((-1.0) ** n / math.factorial(2 * n + 1) for n in range(8, -1, -1))
"""Coefficients of sin(√u)/√u, highest power first; the next term is below 1e-17 for |u| <= 1."""
LAG = tuple((-1.0) ** n * (2 * n + 2) / math.factorial(2 * n + 3) for n in range(8, -1, -1))
"""Coefficients of (sin t - t cos t)/t³ at t = √u."""


@kernel
def _polynomial(coefficients, u):
    """Value by Horner's rule."""
    total = 0.0
    for c in coefficients:
        total = total * u + c
    return total


@kernel
def sine(x, k):
    """s_k(x), half the circumference of a circle of radius x over π; inf beyond √-k x = 710."""
    u = k * x * x
    if abs(u) <= 1.0:
        return x * _polynomial(SINE, u)
    t = math.sqrt(abs(u))
    if u < 0.0:
        return x * (math.sinh(t) / t) if t < OVERFLOW else np.inf
    return x * (math.sin(t) / t)


@kernel
def cosine(x, k):
    """c_k(x) = cos(√k x) or cosh(√-k x), the derivative of s_k in x; inf beyond √-k x = 710."""
    u = k * x * x
    if u < 0.0:
        return math.cosh(math.sqrt(-u)) if u > -OVERFLOW * OVERFLOW else np.inf
    return math.cos(math.sqrt(u))


@kernel
def tangent(x, k):
    """t_k(x) = s_k(x)/c_k(x)."""
    u = k * x * x
    if abs(u) <= 1.0:
        return x * _polynomial(SINE, u) / cosine(x, k)
    t = math.sqrt(abs(u))
    return x * (math.tan(t) / t) if u > 0.0 else x * (math.tanh(t) / t)


@kernel
def sine_and_log_derivative(x, k):
    """s_k(x) and the derivative of ln s_k(x) in k, q(x) = (√k x cot(√k x) - 1)/(2k), which is -x²/6 at k = 0."""
    u = k * x * x
    if abs(u) <= 1.0:
        ratio = _polynomial(SINE, u)
        return x * ratio, -0.5 * x * x * (_polynomial(LAG, u) / ratio)
    t = math.sqrt(abs(u))
    if u > 0.0:
        sin = math.sin(t)
        return x * (sin / t), (t * (math.cos(t) / sin) - 1.0) / (2.0 * k)
    if t > OVERFLOW:
        return np.inf, (t - 1.0) / (2.0 * k)
    e = math.exp(t)
    sinh = 0.5 * (e - 1.0 / e)
    return x * (sinh / t), (t * (0.5 * (e + 1.0 / e) / sinh) - 1.0) / (2.0 * k)


@kernel
def log_sine_derivative(x, k):
    """Derivative of ln s_k(x) in k."""
    return sine_and_log_derivative(x, k)[1]


@kernel
def arc(s, c, k):
    """The x in [0, π/√k] with s_k(x) = s and c_k(x) = c; c is not used for k <= 0."""
    t = math.sqrt(abs(k)) * s
    if not t >= 1e-8:
        return math.pi / math.sqrt(k) if k > 0.0 and c < 0.0 else s
    return s * (math.asinh(t) / t) if k < 0.0 else math.atan2(t, c) / math.sqrt(k)


@kernel
def half_excesses(a, b, c):
    """Half the perimeter s and the half excesses s - a, s - b, s - c, none negative, without cancellation."""
    return (
        0.5 * (a + (b + c)),
        0.5 * max(excess(a, b, c), 0.0),
        0.5 * max(excess(b, c, a), 0.0),
        0.5 * max(excess(c, a, b), 0.0),
    )


@kernel
def half_angle(a, b, c, k):
    """Two numbers with the quotient tan(angle opposite a / 2), squares s_k(s-b) s_k(s-c) and s_k(s) s_k(s-a).

    Both are nan when the triangle does not fit into S_k.
    """
    s, s_a, s_b, s_c = half_excesses(a, b, c)
    u = k * s * s
    if u > FULL_CIRCLE * FULL_CIRCLE:
        return np.nan, np.nan
    if u >= FAR:
        over = math.sqrt(sine(s_b, k)) * math.sqrt(sine(s_c, k))
        return over, math.sqrt(max(sine(s, k), 0.0)) * math.sqrt(sine(s_a, k))
    m = math.sqrt(-k)
    over = math.exp(-m * s_a) * math.sqrt(math.expm1(-2.0 * m * s_b) * math.expm1(-2.0 * m * s_c))
    return over, math.sqrt(math.expm1(-2.0 * m * s) * math.expm1(-2.0 * m * s_a))


@kernel
def angle(a, b, c, k):
    """Angle opposite a of the triangle with the sides a, b, c in S_k, in [0, π].

    It is nan when the perimeter exceeds 2π/√k.  Sides that fail the triangle inequality give the linear limit,
    0 or π; a side of length 0 the limit of isosceles triangles: 0 opposite it, π/2 at its ends, π/3 if all are 0.
    """
    if b == 0.0 or c == 0.0:
        return math.pi / 3.0 if a == 0.0 and b == c else math.pi / 2.0
    over, under = half_angle(a, b, c, k)
    return 2.0 * math.atan2(over, under)


@kernel
def angle_and_derivative(a, b, c, k):
    """The angle opposite a and its derivative in k, (sin(angle)/2) (q(s-b) + q(s-c) - q(s) - q(s-a)).

    The derivative is Area/3 at k = 0, positive, 0 for linear sides, inf where the perimeter is 2π/√k.
    """
    if b == 0.0 or c == 0.0:
        return angle(a, b, c, k), 0.0
    over, under = half_angle(a, b, c, k)
    alpha = 2.0 * math.atan2(over, under)
    if over == 0.0:
        return alpha, 0.0
    s, s_a, s_b, s_c = half_excesses(a, b, c)
    if s_a == 0.0:
        return alpha, 0.0
    if under == 0.0:
        return alpha, np.inf
    half_sine = over * under / (over * over + under * under)
    slope = log_sine_derivative(s_b, k) - log_sine_derivative(s, k)
    slope += log_sine_derivative(s_c, k) - log_sine_derivative(s_a, k)
    return alpha, half_sine * slope


@kernel
def side(b, c, alpha, k):
    """Side opposite the angle alpha: s_k(a/2)² = (s_k((b-c)/2) cos(alpha/2))² + (s_k((b+c)/2) sin(alpha/2))²."""
    half_sum, half_difference = 0.5 * (b + c), 0.5 * (b - c)
    co, si = math.cos(0.5 * alpha), math.sin(0.5 * alpha)
    if k * half_sum * half_sum < FAR:
        return _far_side(b, c, si, k)
    chord = math.hypot(sine(half_difference, k) * co, sine(half_sum, k) * si)
    complement = math.hypot(cosine(half_difference, k) * co, cosine(half_sum, k) * si)
    return 2.0 * arc(chord, complement, k)


@kernel
def _far_side(b, c, half_angle_sine, k):
    """The same for k = -m² << 0: sinh²(ma/2) = sinh²(m(b-c)/2) + sinh(mb) sinh(mc) sin²(alpha/2), by logarithms."""
    m = math.sqrt(-k)
    difference = 0.5 * m * abs(b - c)
    first = difference + math.log(-math.expm1(-2.0 * difference)) if difference > 0.0 else -np.inf
    faces = math.expm1(-2.0 * m * b) * math.expm1(-2.0 * m * c)
    product = half_angle_sine * math.sqrt(faces)
    second = 0.5 * m * (b + c) + math.log(product) if product > 0.0 else -np.inf
    larger, smaller = max(first, second), min(first, second)
    if larger < 20.0:
        return 2.0 * math.asinh(0.5 * math.hypot(math.exp(first), math.exp(second))) / m
    return (2.0 * larger + math.log1p(math.exp(2.0 * (smaller - larger)))) / m


@kernel
def area(a, b, c, k):
    """Area 4 atan(k r)/k with r² = t(s/2) t((s-a)/2) t((s-b)/2) t((s-c)/2), t = t_k (L'Huilier); Heron's at k = 0.

    It is nan when the perimeter exceeds 2π/√k, and half the surface, 2π/k, when it is equal to that.
    """
    s, s_a, s_b, s_c = half_excesses(a, b, c)
    if k * s * s > FULL_CIRCLE * FULL_CIRCLE:
        return np.nan
    r = math.sqrt(abs(tangent(0.5 * s, k))) * math.sqrt(tangent(0.5 * s_a, k))
    r *= math.sqrt(tangent(0.5 * s_b, k)) * math.sqrt(tangent(0.5 * s_c, k))
    return 4.0 * math.atan(k * r) / k if abs(k * r) > 1e-9 else 4.0 * r


@kernel
def is_triangle(a, b, c):
    """Whether a, b, c are lengths that satisfy the triangle inequality up to rounding; not if one is nan or inf."""
    longest = max(a, b, c)
    return min(a, b, c) >= 0.0 and longest < np.inf and 2.0 * longest - (a + b + c) <= TRIANGLE_INEQUALITY * longest


@parallel_kernel
def angles(a, b, c, k, out):
    """Write the angles opposite a, nan for three numbers that are no triangle."""
    for i in prange(out.shape[0]):
        out[i] = angle(a[i], b[i], c[i], k) if is_triangle(a[i], b[i], c[i]) else np.nan


@parallel_kernel
def sides(b, c, alpha, k, out):
    """Write the sides opposite alpha, nan for a negative or undefined length."""
    for i in prange(out.shape[0]):
        out[i] = side(b[i], c[i], alpha[i], k) if b[i] >= 0.0 and c[i] >= 0.0 else np.nan


@parallel_kernel
def areas(a, b, c, k, out):
    """Write the areas, nan for three numbers that are no triangle."""
    for i in prange(out.shape[0]):
        out[i] = area(a[i], b[i], c[i], k) if is_triangle(a[i], b[i], c[i]) else np.nan
