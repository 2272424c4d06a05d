"""Trees of boxes of the Hausdorff distance: few are looked into, and a view tells no more than is true."""

import numpy as np
import pytest

import rinow
from naive import hausdorff as naive
from rinow.comparison.surface_tree import frame_of, surface_of_mesh
from rinow.kernels import box_trees
from shapes import irregular_sphere


@pytest.mark.parametrize("size", [0.5, 0.02, 1e-4, 1e-8, 1e-15])
def test_a_surface_near_the_centre_of_a_sphere(size):
    """All faces of the sphere are nearly as near; some of them have no area."""
    outer, inner = irregular_sphere(300, seed=6), irregular_sphere(40, seed=7)
    faces = np.concatenate([outer.faces, [[0, 1, 1], [2, 3, 2]], outer.faces[:3, [0, 0, 1]]])
    positions = size * (inner.vertices + 0.5)
    result = rinow.hausdorff_distance((positions, inner.faces), (outer.vertices, faces))
    triangles = outer.vertices[outer.faces].tolist()
    expected = [naive.distance_to_surface(p, triangles) for p in positions.tolist()]
    np.testing.assert_allclose(result.distances_a, expected, rtol=1e-13)  # rounding of products
    assert result.upper - result.lower <= 1e-4 * 2 * 3**0.5


def leaves_looked_into(surface, point):
    """How many boxes without children may hold the triangle nearest to a point; without views, and with them."""
    leaves = 1 << surface.tree.depth
    nearest = surface.nearest(point[None], np.zeros(1, np.intp))[1][0] ** 2
    boxes = np.arange(leaves, 2 * leaves)
    return [
        sum(gap(i) < nearest for i in boxes)
        for gap in (
            lambda i: box_trees.box_gap(surface.tree.boxes, i, *point),
            lambda i: box_trees.gap_of(surface.tree, i, *point, box_trees.is_surrounded(surface.tree, *point)),
        )
    ]


@pytest.mark.parametrize("size", [0.1, 1e-2, 1e-4, 1e-6])
def test_few_boxes_of_a_sphere_are_looked_into_from_near_its_centre(size):
    sphere, inner = irregular_sphere(3000, seed=6), size * irregular_sphere(60, seed=7).vertices
    frame = frame_of(sphere.vertices)
    surface = surface_of_mesh(rinow.TriangleMesh(sphere.vertices, sphere.faces), frame).seen_from(frame.enter(inner))
    without, seen = np.mean([leaves_looked_into(surface, p) for p in frame.enter(inner)], axis=0)
    assert seen <= 0.01 * (1 << surface.tree.depth)
    assert without >= (1 if size > 0.05 else 20) * seen


@pytest.mark.parametrize("size", [1e-2, 1e-6])
def test_few_boxes_are_looked_into_from_a_tiny_part_of_a_mesh_that_reaches_outside(size):
    sphere, inner = irregular_sphere(3000, seed=6), size * irregular_sphere(60, seed=7).vertices
    outer = 1.5 * irregular_sphere(1000, seed=8).vertices
    frame = frame_of(sphere.vertices, outer)
    surface = surface_of_mesh(rinow.TriangleMesh(sphere.vertices, sphere.faces), frame)
    surface = surface.seen_from(frame.enter(np.concatenate([outer, inner])))
    without, seen = np.mean([leaves_looked_into(surface, p) for p in frame.enter(inner)], axis=0)
    assert seen <= 0.01 * (1 << surface.tree.depth)
    assert without >= 20 * seen


def test_a_view_tells_no_more_than_is_true():
    """Also of needles, whose nearest point to the eye is vague, and of triangles through the eye."""
    rng = np.random.default_rng(27)
    V = rng.uniform(-1, 1, (60, 3))
    V[20:40] = V[:20] + 1e-9 * rng.normal(size=(20, 3))
    F = np.concatenate([rng.permutation(60).reshape(20, 3), np.arange(60).reshape(3, 20).T, [[0, 0, 1], [5, 5, 5]]])
    surface = surface_of_mesh(rinow.TriangleMesh(V, F[:-2]), frame_of(V))
    for eye in (np.full(3, 0.1), V[7] / 2, V[41]):
        tree = surface.tree._replace(eye=eye, views=np.empty((len(surface.tree.boxes), box_trees.VIEW)))
        box_trees.bound_views(tree)
        for point in eye + rng.normal(size=(30, 3)) * np.logspace(-12, 0, 30)[:, None]:
            gaps = np.array([box_trees.triangle_gap(tree.corners, t, *point) for t in range(len(tree.corners))])
            for level in range(tree.depth + 1):
                for j in range(1 << level):
                    part = gaps[j * len(gaps) >> level : (j + 1) * len(gaps) >> level]
                    assert box_trees.gap_of_view(tree, (1 << level) + j, *point) <= part.min() * (1 + 1e-12) + 1e-30
