"""Faces of parts with few rows of vertices between their creases: rims, strips, and the stars between."""

from itertools import pairwise

import numpy as np
import pytest

import rinow
from rinow import VertexStatus


def belt(first, second):
    """Triangles between two rings of vertices, given as numbers and angles in turns, of any two counts."""
    (a, s), (b, t) = first, second
    i, j, faces = 0, 0, []
    while i < len(a) or j < len(b):
        ahead = (s[i + 1] if i + 1 < len(s) else 1.0 + s[0], t[j + 1] if j + 1 < len(t) else 1.0 + t[0])
        if j == len(b) or (i < len(a) and ahead[0] <= ahead[1]):
            faces.append((a[i % len(a)], a[(i + 1) % len(a)], b[j % len(b)]))
            i += 1
        else:
            faces.append((a[i % len(a)], b[(j + 1) % len(b)], b[j % len(b)]))
            j += 1
    return faces


def solid(radii, heights, counts, phases=(0.0,) * 9):
    """A solid of revolution with rings of vertices at its profile and flat lids, and the rings."""
    rings, points, faces, start = [], [], [], 0
    for radius, height, n, phase in zip(radii, heights, counts, phases, strict=False):
        turns = (np.arange(n) + phase) / n
        points.append(np.stack([radius * np.cos(2 * np.pi * turns), radius * np.sin(2 * np.pi * turns)], axis=1))
        points[-1] = np.column_stack([points[-1], np.full(n, height)])
        rings.append((start + np.arange(n), turns))
        start += n
    for one, two in pairwise(rings):
        faces += belt(one, two)
    for ring, turned in ((rings[0][0], True), (rings[-1][0], False)):
        lid = [(ring[0], ring[k], ring[k + 1]) for k in range(1, len(ring) - 1)]
        faces += [f[::-1] for f in lid] if turned else lid
    return np.concatenate(points), np.array(faces), [ring for ring, _ in rings]


@pytest.mark.parametrize("quality", ["best", "fast"])
@pytest.mark.parametrize("n", [12, 40])
def test_two_rows_of_vertices_are_enough_for_a_cone(n, quality):
    V, F, rings = solid((1.0, 0.5), (0.0, 1.0), (n, n))
    c = rinow.surface_curvature((V, F), quality=quality)
    np.testing.assert_array_equal(c.gaussian, 0.0)
    slope = 1.0 / np.hypot(1.0, 0.5)
    for ring, radius in zip(rings, (1.0, 0.5), strict=True):
        np.testing.assert_allclose(c.mean[ring], 0.5 * slope / radius, rtol=1e-9)
        np.testing.assert_array_equal(c.k2[ring], 0.0)
    lines = V[rings[1]] - V[rings[0]]
    cosines = np.sum(lines * c.direction2[rings[0]], axis=1) / np.linalg.norm(lines, axis=1)
    np.testing.assert_allclose(np.abs(cosines), 1.0, atol=1e-9)


@pytest.mark.parametrize("quality", ["best", "fast"])
def test_rims_of_a_cone_with_a_row_between_that_fits_neither_are_not_curved(quality):
    V, F, rings = solid((1.0, 0.75, 0.5), (0.0, 0.5, 1.0), (32, 26, 32), (0.0, 0.3, 0.11))
    c = rinow.surface_curvature((V, F), quality=quality)
    for ring, radius in ((rings[0], 1.0), (rings[2], 0.5)):
        assert np.all(c.status[ring] == VertexStatus.BOUNDARY)
        errors = np.abs(c.gaussian[ring]) * radius**2
        assert np.median(errors) < 0.02
        assert np.all((errors < 0.2) | (errors < 3.0 * c.spread[ring] * radius**2))


def test_strips_say_that_nothing_shows_how_they_bend_between_their_rims():
    """A loft from a circle to an ellipse: H and K of the ruled surface, by central differences."""
    n, e = 24, 1e-4
    u = 2 * np.pi * np.arange(n) / n

    def at(u, z):
        return np.stack([(1 - 0.2 * z) * np.cos(u), (1 - 0.5 * z) * np.sin(u), z + 0 * u], axis=-1)

    V = np.concatenate([at(u, 0.0), at(u, 1.0)])
    a, b = np.arange(n), (np.arange(n) + 1) % n
    wall = np.concatenate([np.stack([a, b, b + n], 1), np.stack([a, b + n, a + n], 1)])
    k = np.arange(1, n - 1)
    lid = np.stack([0 * k, k, k + 1], axis=1)
    c = rinow.surface_curvature((V, np.concatenate([wall, lid[:, ::-1], lid + n])))
    for ring, z in ((a, 0.0), (a + n, 1.0)):
        along, bend = (at(u + e, z) - at(u - e, z)) / (2 * e), (at(u + e, z) - 2 * at(u, z) + at(u - e, z)) / e**2
        across = at(u, 1.0) - at(u, 0.0)
        twist = ((at(u + e, 1.0) - at(u + e, 0.0)) - (at(u - e, 1.0) - at(u - e, 0.0))) / (2 * e)
        normal = np.cross(along, across)
        area = np.linalg.norm(normal, axis=1)
        L, M = (-np.sum(x * normal, axis=1) / area for x in (bend, twist))
        K = -((M / area) ** 2)
        H = (L * np.sum(across**2, axis=1) - 2 * M * np.sum(along * across, axis=1)) / (2 * area**2)
        assert np.all(np.abs(c.gaussian[ring] - K) < 2.0 * c.spread[ring])
        np.testing.assert_allclose(c.mean[ring], H, atol=0.05 * np.abs(H).max())


@pytest.mark.parametrize("quality", ["best", "fast"])
def test_narrow_roundings_beside_long_rectangles_are_not_silently_flat(quality):
    """A round of seven rows, whose radius is a fifth of the height of the wall beside it: K of each row inside."""
    t = np.linspace(0.0, np.pi / 2, 7)
    radii, heights = np.append(1.0, 0.7 + 0.3 * np.cos(t)), np.append(0.0, 1.5 + 0.3 * np.sin(t))
    V, F, rings = solid(radii, heights, (24,) * 8)
    c = rinow.surface_curvature((V, F), quality=quality)
    inside = np.concatenate(rings[2:-1])
    K = np.repeat(np.cos(t[1:-1]) / (0.3 * (0.7 + 0.3 * np.cos(t[1:-1]))), 24)
    errors = np.abs(c.gaussian[inside] - K)
    assert np.mean((errors > 0.2 * K) & (errors > 3.0 * c.spread[inside])) < 0.15


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_motions_and_units_change_no_rim(scale):
    V, F, _ = solid((1.0, 0.7, 0.5), (0.0, 0.6, 1.0), (50, 28, 32), (0.0, 0.37, 0.11))
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    one, two = rinow.surface_curvature((V, F)), rinow.surface_curvature((scale * V @ turn.T, F))
    np.testing.assert_allclose(two.gaussian * scale**2, one.gaussian, atol=1e-6)
    np.testing.assert_allclose(two.mean * scale, one.mean, atol=1e-6)
