"""Curvature of curves approaches that of the smooth curve, at the promised rates, and fails to where it must."""

import math

import numpy as np
import pytest

from rinow import alt_curvature, arc_length, curve_curvature, haantjes_curvature, menger_curvature

KINDS = ("menger", "haantjes", "alt")


def space_curve(position, curvature):
    return lambda t: (np.column_stack(position(t)), curvature(t))


def half_plane_curve(position, velocity, acceleration):
    """Distances and geodesic curvature y kappa_E + x'/v of a curve of the half-plane y > 0 with metric |dz|/y."""

    def curve(t):
        (x, y), (dx, dy), (ddx, ddy) = position(t), velocity(t), acceleration(t)
        v = np.hypot(dx, dy)
        chord = np.hypot(x[:, None] - x, y[:, None] - y)
        D = 2 * np.arcsinh(chord / (2 * np.sqrt(y[:, None] * y)))
        return 0.5 * (D + D.T), np.abs(y * (dx * ddy - dy * ddx) / v**3 + dx / v)

    return curve


PLANE_CIRCLE = space_curve(lambda t: (2 * np.cos(t), 2 * np.sin(t)), lambda t: np.full_like(t, 0.5))
HYPERBOLIC_CIRCLE = half_plane_curve(
    lambda t: (np.sinh(0.7) * np.cos(t), np.cosh(0.7) + np.sinh(0.7) * np.sin(t)),
    lambda t: (-np.sinh(0.7) * np.sin(t), np.sinh(0.7) * np.cos(t)),
    lambda t: (-np.sinh(0.7) * np.cos(t), -np.sinh(0.7) * np.sin(t)),
)
HOROCYCLE = half_plane_curve(lambda t: (t, 1 + 0 * t), lambda t: (1 + 0 * t, 0 * t), lambda t: (0 * t, 0 * t))
EQUIDISTANT = half_plane_curve(
    lambda t: (0.6 * t, 0.8 * t), lambda t: (0.6 + 0 * t, 0.8 + 0 * t), lambda t: (0 * t, 0 * t)
)
CURVES = {
    "helix": space_curve(lambda t: (np.cos(t), np.sin(t), 0.5 * t), lambda t: np.full_like(t, 0.8)),
    "ellipse": space_curve(
        lambda t: (2 * np.cos(t), np.sin(t)), lambda t: 2 / (4 * np.sin(t) ** 2 + np.cos(t) ** 2) ** 1.5
    ),
    "logarithmic spiral": space_curve(
        lambda t: (np.exp(0.3 * t) * np.cos(t), np.exp(0.3 * t) * np.sin(t)), lambda t: np.exp(-0.3 * t) / np.sqrt(1.09)
    ),
    "hyperbolic circle": HYPERBOLIC_CIRCLE,
    "horocycle": HOROCYCLE,
    "equidistant curve": EQUIDISTANT,
    "hyperbolic wave": half_plane_curve(
        lambda t: (t, 2 + np.sin(t)), lambda t: (1 + 0 * t, np.cos(t)), lambda t: (0 * t, -np.sin(t))
    ),
}


def parameters(n, spacing, seed=11):
    """Parameters in [0.3, 1.8], evenly, smoothly or randomly spaced."""
    t = np.linspace(0.0, 1.0, n)
    if spacing == "smooth":
        t = t + 0.1 * np.sin(2 * np.pi * t)
    if spacing == "random":
        t = t + np.random.default_rng(seed).uniform(-0.3, 0.3, n) / n
    return 0.3 + 1.5 * t


def rates(curve, kind, spacing, sizes=(40, 80, 160)):
    """Orders of the median error inside and of the error at the first end, from the coarsest to the finest curve."""
    error = []
    for n in (sizes[0], sizes[-1]):
        data, exact = curve(parameters(n, spacing))
        e = np.abs(curve_curvature(data, kind=kind) - exact)
        error.append((np.median(e[2:-2]), e[0]))
    return np.log(np.divide(*error)) / np.log(sizes[-1] / sizes[0])


@pytest.mark.parametrize("spacing", ["even", "smooth"])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", CURVES)
def test_order_inside_is_2_and_of_alt_4(name, kind, spacing):
    # The next term of the error is two orders higher: at these h it moves the slope by less than 0.2.
    inside, _ = rates(CURVES[name], kind, spacing)
    assert inside == pytest.approx(4 if kind == "alt" else 2, abs=0.2)


@pytest.mark.parametrize("name", ["ellipse", "logarithmic spiral", "hyperbolic wave"])
@pytest.mark.parametrize(("kind", "order"), [("menger", 1), ("haantjes", 1), ("alt", 3)])
def test_order_at_random_spacing(name, kind, order):
    # Random gaps change from size to size: the slope of the median scatters by about 0.2.
    inside, _ = rates(CURVES[name], kind, "random", sizes=(40, 320))
    assert inside == pytest.approx(order, abs=0.4)


@pytest.mark.parametrize(("kind", "order"), [("menger", 1), ("haantjes", 1), ("alt", 3)])
def test_order_at_the_ends(kind, order):
    _, end = rates(CURVES["logarithmic spiral"], kind, "even")
    assert end == pytest.approx(order, abs=0.1)


@pytest.mark.parametrize("kind", ["menger", "alt"])
def test_plane_circle_is_exact(kind):
    for n in (20, 160):
        points, exact = PLANE_CIRCLE(parameters(n, "random"))
        h = np.linalg.norm(np.diff(points, axis=0), axis=1).min()
        # Coordinates of size 2 are rounded by 2 eps, which moves a circle through points h apart by 2 eps/h²; times
        # 10 for the three points of a triple and, at the ends, the extrapolation.
        np.testing.assert_allclose(curve_curvature(points, kind=kind), exact, rtol=0, atol=20 * 2.2e-16 / h**2)


def test_geodesic_curvatures_of_the_hyperbolic_plane():
    # The formula behind the rates above gives coth of the radius, 1, and tanh of the distance from the geodesic.
    t = parameters(5, "even")
    np.testing.assert_allclose(HYPERBOLIC_CIRCLE(t)[1], 1 / np.tanh(0.7), rtol=1e-14)
    np.testing.assert_allclose(HOROCYCLE(t)[1], 1.0, rtol=1e-14)
    np.testing.assert_allclose(EQUIDISTANT(t)[1], np.tanh(np.arccosh(1 / 0.8)), rtol=1e-14)


@pytest.mark.parametrize("name", CURVES)
def test_alt_equals_haantjes(name):
    # Theorem 5.8 of the paper.  Both are within the larger error, that of Haantjes curvature, of each other.
    data, exact = CURVES[name](parameters(200, "smooth"))
    alt, haantjes = (curve_curvature(data, kind=kind)[2:-2] for kind in ("alt", "haantjes"))
    assert np.abs(alt - haantjes).max() <= 1.01 * np.abs(haantjes - exact[2:-2]).max() < 1e-3


@pytest.mark.parametrize(
    ("chord", "coefficient"),
    [(lambda x: 2 * math.sin(x / 2), -1 / 160), (lambda x: 2 * math.asinh(x / 2), -9 / 160)],
    ids=["circle", "horocycle"],
)
def test_haantjes_curvature_of_arcs_of_unit_curvature(chord, coefficient):
    # d = l - l³/24 + l⁵/1920 and l - l³/24 + 9 l⁵/1920; the next term is smaller by l² = 0.01.
    assert haantjes_curvature(0.1, chord(0.1)) - 1 == pytest.approx(coefficient * 0.01, rel=0.02)
    assert arc_length(chord(0.1), 1.0) == pytest.approx(0.1, rel=9 / 1920 * 1e-4 * 1.01)


def test_two_equal_sides_without_their_arcs_lose_a_quarter():
    # Why curve_curvature replaces sides by arcs.
    x = 1e-2
    points = np.array([[math.cos(t), math.sin(t)] for t in (-x, 0.0, x)])
    L, d = 4 * math.sin(x / 2), 2 * math.sin(x)
    assert haantjes_curvature(L, d) ** 2 == pytest.approx(0.75, abs=x**2)
    assert curve_curvature(points, kind="haantjes") == pytest.approx(1.0, abs=x**2)


def wiggle(x):
    """A graph with Alt curvature 1 at 0 whose second derivative near 0 runs between 0 and 2: 1 - sin(1/x) + O(x)."""
    x = np.asarray(x, np.float64)
    return x * x / 2 + x**4 * np.sin(1 / np.where(x == 0, 1, x))


def arc_and_chord(x0, x1):
    x = np.linspace(x0, x1, 20001)
    y = wiggle(x)
    return math.fsum(np.hypot(np.diff(x), np.diff(y))), math.hypot(x1 - x0, y[-1] - y[0])


PEAKS = [(1 / ((2 * k + 0.5 * sign) * math.pi), 1.0 - sign) for k in (4, 16) for sign in (1, -1)]


@pytest.mark.parametrize("h", [0.04, 0.004])
def test_alt_curvature_without_menger_curvature_alt(h):
    # Divided differences of f(x)/x = x/2 + x³ sin(1/x) are 1/2 + O(x): every triple with the point 0 tends to 1.
    x = np.concatenate([[0.0], h * np.array([-1, -0.8, -0.55, -0.3, -0.1, 0.15, 0.35, 0.6, 0.75, 1])])
    points = np.column_stack([x, wiggle(x)])
    D = np.linalg.norm(points[:, None] - points, axis=-1)
    i, j = np.triu_indices(len(x) - 1, 1)
    K = menger_curvature(0.5 * (D + D.T), np.column_stack([0 * i, i + 1, j + 1]))
    assert np.abs(K - 1).max() < 3 * h
    order = np.argsort(x)
    assert alt_curvature(points[order], int(np.argmin(np.abs(x[order])))) == pytest.approx(1, abs=3 * h)


@pytest.mark.parametrize(("x", "curvature"), PEAKS)
def test_alt_curvature_without_menger_curvature_menger(x, curvature):
    # Triples beside 0, as near to it as one likes, give 0 or 2: the Menger curvature at 0 does not exist.
    t = x + 0.05 * x**2 * np.array([-1, 0, 1])
    assert curve_curvature(np.column_stack([t, wiggle(t)]))[1] == pytest.approx(curvature, abs=12 * x**2 + 0.01)


@pytest.mark.parametrize(("x", "curvature"), PEAKS)
def test_alt_curvature_without_menger_curvature_haantjes(x, curvature):
    # Theorem 5.8 needs arcs that contain the point: these tend to 1, arcs beside it to 0 and 2 like the triples.
    for ends in ((-x, x), (-x / 3, x), (0.0, x)):
        assert haantjes_curvature(*arc_and_chord(*ends)) == pytest.approx(1, abs=3 * x)
    d = 0.05 * x**2
    assert haantjes_curvature(*arc_and_chord(x - d, x + d)) == pytest.approx(curvature, abs=12 * x**2 + 0.03)


@pytest.mark.parametrize("kind", KINDS)
def test_corner_diverges_like_the_inverse_spacing(kind):
    side = np.linspace(0, 1, 9)
    points = np.concatenate([np.column_stack([side, 0 * side]), np.column_stack([1 + 0 * side, side])[1:]])
    coarse, fine = (curve_curvature(points[::step], kind=kind).max() for step in (2, 1))
    assert fine == pytest.approx(2 * coarse, rel=1e-12)


def koch(generation):
    """Vertices of the snowflake curve over [0, 1], as complex numbers."""
    z = np.array([0, 1], complex)
    for _ in range(generation):
        step = np.diff(z) / 3
        new = np.stack([z[:-1], z[:-1] + step, z[:-1] + step * (1 + np.exp(1j * np.pi / 3)), z[1:] - step], axis=1)
        z = np.append(new.ravel(), 1)
    return z


@pytest.mark.parametrize("kind", KINDS)
def test_snowflake_has_no_curvature(kind):
    # Not rectifiable: from one generation to the next the length grows by 4/3 and, at the tip, the curvature by 3.
    lengths, tips = [], []
    for generation in (2, 3, 4):
        z = koch(generation)
        lengths.append(np.abs(np.diff(z)).sum())
        tips.append(curve_curvature(np.column_stack([z.real, z.imag]), kind=kind)[len(z) // 2])
    np.testing.assert_allclose(np.divide(lengths[1:], lengths[:-1]), 4 / 3, rtol=1e-13)
    np.testing.assert_allclose(np.divide(tips[1:], tips[:-1]), 3, rtol=1e-11)
