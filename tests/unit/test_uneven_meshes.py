"""Meshes as programs leave them: graded, with correlated noise, with single vertices that stick out."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

import shapes
from rinow import TriangleMesh, surface_curvature
from rinow.curvature.barriers import crease_barriers
from rinow.curvature.sectional import sectional
from rinow.curvature.sheet import patch_sheet
from rinow.curvature.strays import spikes
from rinow.curvature.unresolved import with_detail


def graded_hill(n=4000, seed=21):
    """z = exp(-4 r²)/2, its triangles small on the hill, and six times as long, and stretched, beside it."""
    rng = np.random.default_rng(seed)
    p = rng.uniform(-1, 1, (40 * n, 2))
    size = 0.012 + 0.06 * np.minimum(np.hypot(*p.T), 1.0) ** 2
    p = p[rng.random(len(p)) < (0.012 / size) ** 2][:n]
    for _ in range(3):  # relaxed: each point to the mean of its neighbours
        start, near = Delaunay(p).vertex_neighbor_vertices
        mean = np.add.reduceat(p[near], start[:-1]) / np.diff(start)[:, None]
        p = np.where(np.abs(p).max(axis=1, keepdims=True) < 0.95, mean, p)
    F = Delaunay(p * [1.0, 2.0]).simplices.astype(np.intp)
    e = 0.5 * np.exp(-4 * (p**2).sum(axis=1))
    fx, fy = -8 * p.T * e
    fxx, fyy, fxy = (64 * p[:, 0] ** 2 - 8) * e, (64 * p[:, 1] ** 2 - 8) * e, 64 * p[:, 0] * p[:, 1] * e
    V = np.column_stack([p, e])
    return TriangleMesh(V, F), (fxx * fyy - fxy**2) / (1 + fx**2 + fy**2) ** 2


def relative_error(found, exact, weights):
    return np.sqrt(np.sum(weights * (found - exact) ** 2) / np.sum(weights * exact**2))


def with_noise(mesh, heights):
    return TriangleMesh(mesh.vertices + heights[:, None] * mesh.vertex_normals, mesh.faces)


@pytest.mark.parametrize("noise", (0.02, 0.05, 0.1))
def test_independent_noise_on_a_graded_mesh_is_no_detail(noise):
    mesh, _ = graded_hill()
    noisy = with_noise(mesh, noise * mesh.mean_edge_length * np.random.default_rng(4).normal(size=mesh.n_vertices))
    estimate = sectional(noisy)
    print("changed", np.mean(with_detail(noisy, estimate).gaussian != estimate.gaussian))


def test_small_noise_that_neighbours_share_is_no_detail():
    V, F = shapes.irregular_torus(3000)[:2]
    mesh = TriangleMesh(V, F)
    rough, t = np.random.default_rng(5).normal(size=len(V)), mesh.topology
    for _ in range(2):
        rough = 0.5 * (
            rough + np.add.reduceat(rough[t.neighbours], t.neighbour_offsets[:-1]) / np.diff(t.neighbour_offsets)
        )
    noisy = with_noise(mesh, 0.03 * mesh.mean_edge_length * rough / rough.std())
    estimate = sectional(noisy)
    print("changed", np.mean(with_detail(noisy, estimate).gaussian != estimate.gaussian))


def test_graded():
    mesh, K = graded_hill()
    noisy = with_noise(mesh, 0.03 * mesh.mean_edge_length * np.random.default_rng(4).normal(size=mesh.n_vertices))
    inside = np.abs(mesh.vertices[:, :2]).max(axis=1) < 0.7
    w = np.where(inside, mesh.vertex_areas, 0)
    for q in "best", "fast":
        print(q, relative_error(surface_curvature(noisy, quality=q).gaussian, K, w))
    for k in (2, 3, 4, 5, 6):
        print(k, relative_error(surface_curvature(noisy, radius=k * mesh.mean_edge_length).gaussian, K, w))
