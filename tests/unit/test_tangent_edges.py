"""Tangent edges: faces of a part that join smoothly have their own curvature on each side."""

import numpy as np
import pytest

import rinow
from rinow.curvature.creases import EdgeTurnings
from rinow.curvature.tangent_edges import tangent_edges
from voxels import lattice, marching_cubes

RADIUS, ROUND, HEIGHT = 1.0, 0.25, 3.0
AROUND, ROWS = 50, 7


def rounded_cylinder():
    """A cylinder with round rims as modellers mesh it, and K at its vertices: two values where faces join.

    Its caps are fans without a vertex inside, its wall is one row of rectangles, its rims are strips of a torus.
    """
    phi = np.linspace(0.0, np.pi / 2, ROWS + 1)
    rho, z = RADIUS - ROUND + ROUND * np.sin(phi), ROUND * np.cos(phi)
    rho, z = np.concatenate([rho, rho[::-1]]), np.concatenate([HEIGHT - ROUND + z, ROUND - z[::-1]])
    on_torus = np.sin(phi) / (ROUND * (RADIUS - ROUND + ROUND * np.sin(phi)))
    low, high = on_torus.copy(), on_torus.copy()
    low[0] = low[-1] = 0.0
    t = 2.0 * np.pi * np.arange(AROUND) / AROUND
    vertices = np.stack([np.outer(rho, np.cos(t)), np.outer(rho, np.sin(t)), np.repeat(z[:, None], AROUND, 1)], axis=2)
    i, j = np.meshgrid(np.arange(len(z) - 1), np.arange(AROUND), indexing="ij")
    a, b = (i * AROUND + j).ravel(), (i * AROUND + (j + 1) % AROUND).ravel()
    c, d = a + AROUND, b + AROUND
    k = np.arange(1, AROUND - 1)
    top = np.stack([0 * k, k, k + 1], axis=1)
    faces = np.concatenate([np.stack([a, c, d], 1), np.stack([a, d, b], 1), top, (len(z) - 1) * AROUND + top[:, ::-1]])
    bounds = np.stack([np.concatenate([low, low[::-1]]), np.concatenate([high, high[::-1]])])
    return vertices.reshape(-1, 3), faces, np.repeat(bounds, AROUND, axis=1)


def tangent(vertices, faces):
    mesh = rinow.TriangleMesh(vertices, faces)
    return mesh.topology.edges[tangent_edges(mesh, EdgeTurnings(mesh))]


def test_they_are_where_the_faces_of_a_rounded_cylinder_join():
    vertices, faces, _ = rounded_cylinder()
    edges = np.sort(tangent(vertices, faces), axis=1)
    rings = edges // AROUND
    assert np.array_equal(rings[:, 0], rings[:, 1])
    assert np.array_equal(np.bincount(rings[:, 0]), np.bincount(np.repeat([0, ROWS, ROWS + 1, 2 * ROWS + 1], AROUND)))


@pytest.mark.parametrize(("quality", "rms"), [("best", 0.02), ("fast", 0.06)])
def test_curvature_of_roundings_is_theirs(quality, rms):
    vertices, faces, (low, high) = rounded_cylinder()
    curvature = rinow.surface_curvature((vertices, faces), quality=quality)
    errors = np.maximum(np.maximum(low - curvature.gaussian, curvature.gaussian - high), 0.0)
    assert np.sqrt(np.mean(errors**2)) < rms * np.sqrt(np.mean(high**2))
    assert np.all(curvature.status == rinow.VertexStatus.OK)


def test_a_radius_is_kept_across_them():
    vertices, faces, _ = rounded_cylinder()
    curvature = rinow.surface_curvature((vertices, faces), radius=0.2)
    assert np.all(curvature.radius[np.isfinite(curvature.gaussian)] <= 0.2 + 1e-12)


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_units_and_motions_change_none(scale):
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    vertices, faces, _ = rounded_cylinder()
    moved = scale * vertices @ turn.T + scale
    assert np.array_equal(tangent(moved, faces), tangent(vertices, faces))


def test_noise_and_smooth_surfaces_have_none():
    rng = np.random.default_rng(3)
    vertices, faces, _ = rounded_cylinder()
    assert len(tangent(vertices + 1e-4 * rng.normal(size=vertices.shape), faces)) == 0
    t = np.linspace(0.0, np.pi, 40)[1:-1]
    p = 2.0 * np.pi * np.arange(60) / 60
    heights = np.repeat(np.cos(t)[:, None], 60, axis=1)
    sphere = np.stack([np.outer(np.sin(t), np.cos(p)), np.outer(np.sin(t), np.sin(p)), heights], axis=2)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(len(t) - 1), np.arange(60), indexing="ij"))
    a, b = i * 60 + j, i * 60 + (j + 1) % 60
    quads = np.concatenate([np.stack([a, a + 60, b + 60], 1), np.stack([a, b + 60, b], 1)])
    assert len(tangent(sphere.reshape(-1, 3), quads)) == 0


def pipe_elbow(around=24, along=8, radius=0.3, bend=1.0, leg=1.5):
    """A quarter of a torus between two cylinders of one row each, open at its ends, and bounds of K at its vertices."""
    t = np.linspace(0.0, np.pi / 2, along + 1)
    out = np.stack([np.cos(t), np.sin(t), 0.0 * t], axis=1)
    out = np.concatenate([out[:1], out, out[-1:]])
    centres = bend * out
    centres[0, 1], centres[-1, 0] = -leg, -leg
    u = 2.0 * np.pi * np.arange(around) / around
    ring = np.cos(u)[None, :, None] * out[:, None] + np.sin(u)[None, :, None] * np.array([0.0, 0.0, -1.0])
    vertices = (centres[:, None] + radius * ring).reshape(-1, 3)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(len(out) - 1), np.arange(around), indexing="ij"))
    a, b = i * around + j, i * around + (j + 1) % around
    faces = np.concatenate([np.stack([a, b, b + around], 1), np.stack([a, b + around, a + around], 1)])
    on_torus = np.tile(np.cos(u) / (radius * (bend + radius * np.cos(u))), (len(out), 1))
    on_torus[[0, -1]] = 0.0
    low, high = np.minimum(on_torus, 0.0), np.maximum(on_torus, 0.0)
    low[2:-2] = high[2:-2] = on_torus[2:-2]
    return vertices, faces, (low.ravel(), high.ravel())


def test_they_are_where_cylinders_of_long_rectangles_go_on_as_a_torus():
    vertices, faces, _ = pipe_elbow()
    rings = np.sort(tangent(vertices, faces), axis=1) // 24
    assert np.array_equal(rings[:, 0], rings[:, 1])
    assert np.array_equal(np.bincount(rings[:, 0], minlength=11), np.where(np.isin(np.arange(11), (1, 9)), 24, 0))


def test_torus_between_cylinders_has_its_own_curvature():
    vertices, faces, (low, high) = pipe_elbow()
    curvature = rinow.surface_curvature((vertices, faces))
    inside = np.repeat(np.arange(11), 24) % 10 != 0
    errors = np.maximum(np.maximum(low - curvature.gaussian, curvature.gaussian - high), 0.0)[inside]
    assert np.sqrt(np.mean(errors**2)) < 0.03 / 0.3**2
    assert np.mean(errors <= 2.0 * curvature.spread[inside]) > 0.9


def test_lines_between_facets_of_marching_cubes_end_anywhere_and_are_none():
    # Symmetric cells have coplanar triangles, which end at slivers.
    points = lattice(18.0)
    vertices, faces = marching_cubes(points, 1.5 - np.sum((points / 15.0) ** 2, axis=-1))
    assert len(tangent(vertices, faces)) == 0
    np.testing.assert_allclose(rinow.surface_curvature((vertices, faces)).gaussian, 1.0 / 15.0**2, rtol=0.02)
