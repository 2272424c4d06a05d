"""Rows of edges along which a coarse mesh of a round bends: no creases."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

import rinow
from rinow.curvature.barriers import crease_barriers
from rinow.curvature.creases import EdgeTurnings
from rinow.kernels import rounds
from surface_methods import relative_error
from voxels import lattice, marching_cubes

RADII = np.array([37.0, 25.0, 15.0])


def sliced(sides):
    """The ellipsoid with these half-axes as the level set of a smooth function on voxels with these sides."""
    points = lattice(38.0, sides)
    V, F = marching_cubes(points, 1.5 - np.sum((points / RADII) ** 2, axis=-1))
    return rinow.TriangleMesh(V, F)


def ridge(angle, side, seed=1, noise=0.0):
    """Two halves of a paraboloid whose normals meet at an angle, in degrees, where x = 0; side is that of triangles."""
    n, rng = round(1 / side), np.random.default_rng(seed)
    u = np.linspace(-1.0, 1.0, 2 * n + 1)
    x = np.stack(np.meshgrid(u, u), axis=-1).reshape(-1, 2)
    inner = (np.abs(x) < 1.0 - 1e-9).all(axis=1)[:, None] * (np.abs(x[:, :1]) > 1e-9)
    x = x + inner * rng.uniform(-0.3, 0.3, x.shape) * side
    z = -np.tan(np.radians(angle / 2)) * np.abs(x[:, 0]) - 0.5 * np.sum(x**2, axis=1)
    V = np.column_stack([x, z]) + noise * side * rng.normal(size=(len(x), 3))
    return rinow.TriangleMesh(V, Delaunay(x).simplices.astype(np.intp)), np.abs(x[:, 0]) < 1e-9


def votes(mesh, edges):
    turnings, out = EdgeTurnings(mesh), np.empty(len(edges))
    place = mesh.vertices, mesh.faces, turnings.normals, mesh.topology.partners, turnings.halfedges
    rounds.bends_of_rounds(edges, *place, 2, out)
    return out


@pytest.mark.parametrize("quality", ["best", "fast"])
@pytest.mark.parametrize("sides", [(1.0, 1.0, 2.5), (1.0, 1.0, 4.0)])
def test_rows_of_thick_slices_are_no_creases(sides, quality):
    mesh = sliced(sides)
    assert not crease_barriers(mesh).any()
    x = mesh.vertices / np.sqrt(np.sum((mesh.vertices / RADII) ** 2, axis=1))[:, None]
    K = 1.0 / (np.prod(RADII) * np.sum(x**2 / RADII**4, axis=1)) ** 2
    found = rinow.surface_curvature(mesh, quality=quality)
    # K is largest at the ends of the ellipsoid, where a slice is as thick as half the radius of curvature.
    assert relative_error(found.gaussian, K) < 0.2
    np.testing.assert_array_equal(found.status, rinow.VertexStatus.OK)


@pytest.mark.parametrize("noise", [0.0, 0.02])
@pytest.mark.parametrize(("angle", "side"), [(20.0, 0.05), (30.0, 0.05), (30.0, 0.1), (40.0, 0.05)])
def test_ridges_of_smooth_sides_are_creases(angle, side, noise):
    mesh, on_ridge = ridge(angle, side, noise=noise)
    edges = np.flatnonzero(on_ridge[mesh.topology.edges].all(axis=1))
    is_row = votes(mesh, edges) > 0.5
    if noise:  # a single edge may turn by nearly half as much beside it; most edges of a line decide
        assert np.mean(is_row) < 0.25
    else:
        assert not is_row.any()
        np.testing.assert_array_equal(np.flatnonzero(crease_barriers(mesh)), edges)


@pytest.mark.parametrize("turned", [False, True])
def test_rows_of_a_prism_are_told_whatever_the_width_of_its_facets(turned):
    angles = np.cumsum(np.radians([0, 14, 11, 16, 12, 15, 12, 14, 10, 15]))
    x, rows = np.stack([np.cos(angles), np.sin(angles)], axis=1), np.arange(0.0, 2.0, 0.05)
    V = np.column_stack([np.tile(x, (len(rows), 1)), np.repeat(rows, len(x))])
    i = (np.arange(len(rows) - 1)[:, None] * len(x) + np.arange(len(x) - 1)).ravel()
    F = np.concatenate([np.stack(f, axis=1) for f in ((i, i + 1, i + len(x) + 1), (i, i + len(x) + 1, i + len(x)))])
    mesh = rinow.TriangleMesh(V, F[:, ::-1] if turned else F)
    a, b = mesh.topology.edges.T
    column = a % len(x)
    along = np.flatnonzero((column == b % len(x)) & (column > 1) & (column < len(x) - 2))
    np.testing.assert_allclose(votes(mesh, along)[(V[a[along], 2] > 0.3) & (V[a[along], 2] < 1.6)], 1.0)
