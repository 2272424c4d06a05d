"""Meshes as programs leave them: graded, with noise that neighbours share, with single vertices that stick out."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay, KDTree

import shapes
from rinow import TriangleMesh, surface_curvature
from rinow.curvature.barriers import crease_barriers
from rinow.curvature.sectional import sectional
from rinow.curvature.sheet import patch_sheet
from rinow.curvature.strays import spikes
from rinow.curvature.unresolved import with_detail
from rinow.kernels import covers
from surface_methods import relative_error


def graded_hill(n=4000, seed=21):
    """z = exp(-4 r²)/2 over a square, its triangles six times as long at the corners as on the hill, and its K."""
    rng = np.random.default_rng(seed)
    p = rng.uniform(-1, 1, (40 * n, 2))
    size = 1 + 5 * np.minimum(np.hypot(*p.T), 1.0) ** 2
    p = p[rng.random(len(p)) < size**-2][:n]
    for _ in range(3):  # each point to the mean of its neighbours
        start, near = Delaunay(p).vertex_neighbor_vertices
        mean = np.add.reduceat(p[near], start[:-1]) / np.diff(start)[:, None]
        p = np.where(np.abs(p).max(axis=1, keepdims=True) < 0.95, mean, p)
    e = 0.5 * np.exp(-4 * (p**2).sum(axis=1))
    (x, y), (fx, fy) = p.T, -8 * p.T * e
    fxx, fyy, fxy = (64 * x * x - 8) * e, (64 * y * y - 8) * e, 64 * x * y * e
    F = Delaunay(p).simplices.astype(np.intp)
    return TriangleMesh(np.column_stack([p, e]), F), (fxx * fyy - fxy**2) / (1 + fx**2 + fy**2) ** 2


def moved(mesh, heights):
    """The mesh with its vertices moved along their normals by heights in mean edge lengths."""
    step = mesh.mean_edge_length * heights[:, None] * mesh.vertex_normals
    return TriangleMesh(mesh.vertices + step, mesh.faces)


def torus(n=3000):
    shape = shapes.irregular_torus(n)
    return TriangleMesh(shape.vertices, shape.faces), shape.gaussian


def assert_no_detail(mesh):
    estimate = sectional(mesh)
    np.testing.assert_array_equal(with_detail(mesh, estimate).gaussian, estimate.gaussian)


@pytest.mark.parametrize("noise", (0.02, 0.1))
def test_independent_noise_on_a_graded_mesh_is_no_detail(noise):
    mesh, _ = graded_hill()
    assert_no_detail(moved(mesh, noise * np.random.default_rng(4).normal(size=mesh.n_vertices)))


def test_small_noise_that_neighbours_share_is_hardly_detail():
    mesh, K = torus()
    t, rough = mesh.topology, np.random.default_rng(5).normal(size=mesh.n_vertices)
    for _ in range(2):
        around = np.add.reduceat(rough[t.neighbours], t.neighbour_offsets[:-1]) / np.diff(t.neighbour_offsets)
        rough = 0.5 * (rough + around)
    noisy = moved(mesh, 0.03 * rough / rough.std())
    estimate = sectional(noisy)
    # Rings alone err by more than K itself.
    assert relative_error(with_detail(noisy, estimate).gaussian, K) < 1.3 * relative_error(estimate.gaussian, K)


def cells_of_two_sizes(n=4000, seed=3):
    """The unit sphere, its triangles 2.5 times as long below as above, as cells of an octree are."""
    D, rng = shapes.irregular_sphere(n).vertices, np.random.default_rng(seed)
    tree, kept, below = KDTree(D), np.ones(n, np.bool_), D[:, 2] < 0.0
    for i in rng.permutation(np.flatnonzero(below)):
        if kept[i]:
            near = np.array(tree.query_ball_point(D[i], 7.4 / np.sqrt(n)))
            kept[near[below[near] & (near != i)]] = False
    return TriangleMesh(D[kept], ConvexHull(D[kept]).simplices.astype(np.intp))


@pytest.mark.parametrize("quality", ("best", "fast"))
def test_noise_that_neighbours_share_on_cells_of_two_sizes_is_no_detail(quality):
    mesh = cells_of_two_sizes()
    t, rough = mesh.topology, np.random.default_rng(5).normal(size=mesh.n_vertices)
    starts, counts = t.neighbour_offsets[:-1], np.diff(t.neighbour_offsets)
    for _ in range(3):
        rough = 0.5 * (rough + np.add.reduceat(rough[t.neighbours], starts) / counts)
    spokes = mesh.vertices[t.neighbours] - np.repeat(mesh.vertices, counts, axis=0)
    size = np.add.reduceat(np.linalg.norm(spokes, axis=1), starts) / counts
    V = mesh.vertices * (1.0 + 0.12 * size * rough / rough.std())[:, None]
    found = surface_curvature((V, mesh.faces), quality=quality)
    # Fits over some hundred vertices err by 0.03 to 0.07, small balls, which follow the noise, by 3.
    assert relative_error(found.gaussian, np.ones(mesh.n_vertices)) < 0.1


def test_heights_over_the_fits_are_the_noise():
    mesh, _ = torus()
    heights = 0.05 * np.random.default_rng(6).normal(size=mesh.n_vertices)
    found = sectional(moved(mesh, heights)).height / mesh.mean_edge_length
    # Fits of order 2 to 6 to a hundred points follow a tenth of the noise.
    assert relative_error(found, heights) < 0.35
    assert np.corrcoef(found, heights)[0, 1] > 0.9


def test_radii_of_samples_hold_in_spacings_and_in_length():
    # Vertex 0 has the spacing of the sample, vertex 1 half of it, vertex 2 too but lies at a boundary.
    step = np.log(2.0) / 3.0
    starts, near, one = np.arange(4, dtype=np.int32), np.zeros(3, np.int32), np.array([5], np.int32)
    low, high, top, noise = *np.empty((3, 3), np.int32), np.empty(3)
    scales = np.array([2.0, 1.0, 1.0]), np.array([2.0]), np.array([step, step, np.inf])
    covers.windows(starts, near, one, one, np.ones(1), *scales, 12, low, high, top, noise)
    np.testing.assert_array_equal((low, high), ((5, 5, 5), (5, 8, 5)))
    # The least risk of the sample is that of radius 5 and the second of two orders.
    logs = np.zeros((1, 24))
    logs[0, 11] = -1.0
    radius, order, risk = np.empty(3, np.int32), np.empty(3, np.int32), np.empty(3)
    vertices = np.arange(3, dtype=np.int32)
    covers.choices(vertices, starts, near, logs, *scales, 2, 1, radius, order, risk)
    np.testing.assert_array_equal((radius, order), ((5, 8, 5), (3, 3, 3)))


@pytest.mark.parametrize("quality", ("best", "fast"))
def test_spikes_do_no_harm(quality):
    mesh, K = torus()
    rng = np.random.default_rng(8)
    chosen = rng.choice(mesh.n_vertices, 15, replace=False)
    heights = np.zeros(mesh.n_vertices)
    heights[chosen] = 0.5 * rng.choice((-1, 1), 15)
    spiky = moved(mesh, heights)
    sheet, index = patch_sheet(spiky)
    found, beside = spikes(sheet)
    np.testing.assert_array_equal(np.sort(index[found]), np.sort(chosen))
    assert not np.isin(index[beside], chosen).any()
    # One spike in a ball of a hundred points would be an error of some ten percent around it.  What is left is that
    # of the spikes themselves, which have the curvature of a neighbour: 5 % of K there, at 0.5 % of the vertices.
    curvature = surface_curvature(spiky, quality=quality)
    assert relative_error(curvature.gaussian, K) < 0.02
    assert curvature.notes == (
        "15 vertices were left out, single ones far beside the surface or in the middle of an edge: they have the "
        "values of their neighbours.",
    )


def test_noise_and_smooth_surfaces_have_no_spikes():
    for mesh in (torus()[0], graded_hill()[0]):
        for noise in (0.0, 0.02, 0.1):
            noisy = moved(mesh, noise * np.random.default_rng(9).normal(size=mesh.n_vertices))
            assert not len(spikes(patch_sheet(noisy)[0])[0])


def test_edges_around_spikes_are_no_creases():
    x, y = np.indices((40, 40)).reshape(2, -1)
    p = np.column_stack([x, y]) + np.random.default_rng(10).uniform(-0.2, 0.2, (1600, 2))
    V = np.column_stack([p, 1e-4 * (p**2).sum(axis=1)])
    V[(x % 4 == 2) & (y % 4 == 2), 2] += 0.5
    mesh = TriangleMesh(V, Delaunay(p).simplices.astype(np.intp))
    assert not crease_barriers(mesh).any()
