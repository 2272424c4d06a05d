"""Surfaces of masks: their steps are neither creases nor detail, but noise of the surface that was sampled."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

import rinow
import shapes
from plates import perforated_plate
from rinow.curvature.creases import EdgeTurnings
from rinow.curvature.terraces import beyond_terraces
from rinow.kernels import stencils
from surface_methods import relative_error
from voxels import lattice, marching_cubes, smoothed, squares

RADII = np.array([17.0, 13.0, 10.0])


def is_inside(points):
    """The ellipsoid with these half-axes."""
    return np.sum((points / RADII) ** 2, axis=-1) < 1.0


def exact(vertices):
    """Gaussian and mean curvature of the ellipsoid below some points."""
    x = vertices / np.sqrt(np.sum((vertices / RADII) ** 2, axis=1))[:, None]
    w = np.sum(x**2 / RADII**4, axis=1)
    mean = (np.sum(RADII**2) - np.sum(x**2, axis=1)) / (2.0 * np.prod(RADII) ** 2 * w**1.5)
    return 1.0 / (np.prod(RADII) ** 2 * w**2), mean


def surface(kind, sides=(1.0, 1.0, 1.0)):
    points = lattice(18.0, sides)
    values = is_inside(points).astype(float)
    if kind == "squares":
        vertices, faces = squares(is_inside(points))
        return (vertices - 0.5) * sides + points[0, 0, 0], faces
    if kind == "blurred":
        values = gaussian_filter(values, 0.7 / np.array(sides))
    vertices, faces = marching_cubes(points, values)
    if kind == "smoothed":
        vertices = smoothed(vertices, faces, 5)
    if kind == "swollen":
        vertices = smoothed(vertices, faces, 10, 0.53)
    return vertices, faces


def are_steps(vertices, faces):
    mesh = rinow.TriangleMesh(vertices, faces)
    return EdgeTurnings(mesh).are_steps


@pytest.mark.parametrize("quality", ["best", "fast"])
@pytest.mark.parametrize("kind", ["squares", "raw", "blurred", "smoothed", "swollen"])
def test_steps_of_masks_are_noise(kind, quality):
    """K errs by 0.06 to 0.10 and H by 0.03 to 0.05 here, of rings by much more (benchmarks/bench_masks.py)."""
    mesh = surface(kind)
    curvature = rinow.surface_curvature(mesh, quality=quality)
    gaussian, mean = exact(mesh[0])
    assert relative_error(curvature.gaussian, gaussian) < 0.15
    assert relative_error(curvature.mean, mean) < 0.08
    assert np.mean(np.abs(curvature.gaussian - gaussian) < 2.0 * curvature.spread) > 0.8
    assert kind == "squares" or any("steps" in note for note in curvature.notes)


@pytest.mark.parametrize("kind", ["raw", "blurred", "smoothed"])
def test_steps_of_long_voxels_are_noise(kind):
    # Slices are often farther apart than pixels, here so that eight of them are all there is.
    mesh = surface(kind, (1.0, 1.0, 2.5))
    curvature = rinow.surface_curvature(mesh)
    gaussian, mean = exact(mesh[0])
    assert np.median(np.abs(curvature.gaussian / gaussian - 1.0)) < 0.2
    assert np.median(np.abs(curvature.mean / mean - 1.0)) < 0.12


@pytest.mark.parametrize("sides", [(1.0, 1.0, 1.0), (1.0, 1.0, 2.5), (0.5, 0.8, 1.3)])
def test_surfaces_of_masks_are_known_anywhere(sides):
    rng = np.random.default_rng(3)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    for vertices, faces in (surface("raw", sides), surface("squares", sides)):
        assert are_steps(vertices, faces)
        # Turned, moved far away and rounded to 24 bits, the faces in another order; and a part of it.
        moved = (vertices @ turn + 100.0).astype(np.float32).astype(float)
        assert are_steps(moved, rng.permutation(faces))
        assert are_steps(vertices, faces[np.all(vertices[faces][..., 0] < 2.0, axis=1)])
        assert len(rinow.singular_features((vertices, faces)).crease_edges) == 0


@pytest.mark.parametrize("sides", [4, 6, 8, 12])
def test_parts_with_flat_faces_are_no_masks(sides):
    assert not are_steps(*perforated_plate(8, sides, 0.45)[:2])


def test_grids_blocks_and_smooth_surfaces_are_no_masks():
    x = np.zeros((12, 12, 12), np.bool_)
    x[1:-1, 1:-1, 1:-1] = True
    box = squares(x)
    x[6:, 6:] = False  # an L
    for vertices, faces in (box, squares(x), shapes.irregular_sphere(1000)[:2], surface("swollen"), surface("blurred")):
        assert not are_steps(vertices, faces)


def test_low_steps_are_no_detail_and_a_bump_is():
    V, F = shapes.irregular_sphere(2000)[:2]
    mesh = rinow.TriangleMesh(V, F)
    t, spacing = mesh.topology, np.full(mesh.n_vertices, mesh.mean_edge_length)
    rings = t.neighbour_offsets, t.neighbours
    height = mesh.mean_edge_length * np.where(V[:, 2] > 0.9, 0.4, 0.0)
    missed = np.abs(height) > 0.0
    assert not beyond_terraces(V, rings, spacing, missed, height).any()
    # A bump is told as a whole by its top, and a second one is not.
    height[V[:, 2] > 0.97] *= 2.0
    other = V[:, 2] < -0.9
    found = beyond_terraces(V, rings, spacing, missed | other, height + 0.1 * spacing * other)
    np.testing.assert_array_equal(found, missed)
    # On a graded mesh there are no voxels.
    assert beyond_terraces(V, rings, spacing * np.where(V[:, 0] > 0, 1.0, 3.0), missed | other, height).sum() > 0


def test_unused_vertices_tell_nothing_about_voxels():
    V, F = surface("swollen")
    n, others = len(V), np.random.default_rng(1).normal(size=(99 * len(V), 3))
    alone, among = rinow.surface_curvature((V, F)), rinow.surface_curvature((np.concatenate([V, others]), F))
    np.testing.assert_allclose(among.gaussian[:n], alone.gaussian, rtol=1e-12)  # rounding, in another order of sums
    assert set(alone.notes) <= set(among.notes)


def test_longest_links_are_those_of_a_loop():
    V, F = shapes.irregular_sphere(200)[:2]
    t, longest = rinow.TriangleMesh(V, F).topology, np.empty(len(V))
    stencils.longest_links(V, t.neighbour_offsets, t.neighbours, longest)
    rows = [t.neighbours[i:j] for i, j in zip(t.neighbour_offsets[:-1], t.neighbour_offsets[1:], strict=True)]
    expected = [max(np.linalg.norm(V[j] - V[i]) for j in row) for i, row in enumerate(rows)]
    np.testing.assert_allclose(longest, expected, rtol=1e-14)
