"""How far curvature changes around a change of the mesh, and that other components change nothing."""

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

import shapes
from rinow import TriangleMesh, surface_curvature
from rinow.kernels import risks

FIELDS = ("gaussian", "mean", "spread")
NOISY = shapes.noisy(shapes.irregular_torus(2500), 0.01)


def largest_change(actual, expected, n=None):
    """Over the root mean square of each field, the largest change at the first n vertices."""
    changes = []
    for field in FIELDS:
        a, b = getattr(actual, field)[:n], getattr(expected, field)[:n]
        changes.append(np.abs(a - b).max() / np.sqrt(np.mean(b * b)))
    return max(changes)


def spacings_from(shape, vertices):
    """(n_vertices,): distance along edges from some vertices, in mean edges."""
    mesh = TriangleMesh(shape.vertices, shape.faces)
    a, b = mesh.topology.edges.T
    lengths = np.linalg.norm(shape.vertices[a] - shape.vertices[b], axis=1)
    graph = csr_array((lengths, (a, b)), shape=(mesh.n_vertices,) * 2)
    return dijkstra(graph, directed=False, indices=vertices, min_only=True) / mesh.mean_edge_length


@pytest.mark.parametrize("quality", ["best", "fast"])
@pytest.mark.parametrize("noise", [0.0, 0.01, 0.05])
def test_other_components_change_nothing(noise, quality):
    # More than 8192 vertices, from where on samples lie less densely, and stretched, so that edge lengths are examined.
    shape = shapes.noisy(shapes.irregular_torus(1000), noise)
    other = shapes.irregular_ellipsoid(8300, axes=(1.0, 1.0, 6.0))
    whole = surface_curvature((shape.vertices, shape.faces), quality=quality)
    for size, x in ((20.0, 200.0), (0.01, 1.0)):  # far away, and inside the tube
        both = shapes.union(shape, other._replace(vertices=size * other.vertices), offset=(x, 0.0, 0.0))
        c = surface_curvature((both.vertices, both.faces), quality=quality)
        # Nothing but the order of sums changes.  Without noise the standard error is one of rounding in part.
        assert largest_change(c, whole, 1000) < (1e-12 if noise else 1e-7)
        np.testing.assert_allclose(c.gaussian[:1000], whole.gaussian, rtol=1e-12, atol=1e-11)


@pytest.mark.parametrize(("quality", "most"), [("best", 28), ("fast", 36)])
def test_a_hole_changes_little_of_a_noisy_surface(quality, most):
    # Balls of up to 9 spacings, means over samples 10 spacings around, and these count for what is 7 spacings around;
    # the spacing varies by a third.
    whole = surface_curvature((NOISY.vertices, NOISY.faces), quality=quality)
    reach = []
    for v in (100, 900, 1700):
        face = (NOISY.faces == v).any(axis=1).argmax()
        c = surface_curvature((NOISY.vertices, np.delete(NOISY.faces, face, axis=0)), quality=quality)
        changed = np.zeros(len(NOISY.vertices), bool)
        for field in FIELDS:
            a, b = getattr(c, field), getattr(whole, field)
            changed |= np.abs(a - b) > 1e-12 * np.sqrt(np.mean(b * b))
        reach.append(spacings_from(NOISY, NOISY.faces[face])[changed].max())
    assert max(reach) < most
    assert np.median(reach) < most - 4


@pytest.mark.parametrize(("noise", "most", "share"), [(0.0, 42, 0.25), (0.01, 52, 0.4)])
def test_a_hole_changes_averages_of_angle_defects_around_it_only(noise, most, share):
    # Windows of up to 20 spacings without noise and 28 with it, and once more half as far to where they have 1e-12 of
    # themselves; the rest is of vertices for which two scales are nearly as good.
    shape = shapes.noisy(shapes.irregular_torus(16_000), noise)
    v = 100
    face = (shape.faces == v).any(axis=1).argmax()
    whole = surface_curvature((shape.vertices, shape.faces), method="intrinsic").gaussian
    with_hole = surface_curvature((shape.vertices, np.delete(shape.faces, face, axis=0)), method="intrinsic").gaussian
    change = np.abs(with_hole - whole) / np.abs(whole).max()
    away = spacings_from(shape, shape.faces[face])
    assert away.max() > 1.3 * most
    assert away[change > 1e-12].max() < most
    assert np.count_nonzero(change > 1e-12) < share * len(change)


@pytest.mark.parametrize("quality", ["best", "fast"])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_the_order_of_faces_changes_rounding_only(noise, quality):
    shape = shapes.noisy(shapes.irregular_torus(2500), noise)
    F = shape.faces[np.random.default_rng(1).permutation(len(shape.faces))]
    c = surface_curvature((shape.vertices, shape.faces), quality=quality)
    d = surface_curvature((shape.vertices, F), quality=quality)
    np.testing.assert_allclose(d.gaussian, c.gaussian, rtol=0, atol=1e-8 * np.abs(c.gaussian).max())
    np.testing.assert_allclose(d.mean, c.mean, rtol=0, atol=1e-8 * np.abs(c.mean).max())


def test_medians_over_linked_rows():
    rng = np.random.default_rng(3)
    values = rng.normal(size=(9, 4))
    values[rng.random(values.shape) < 0.3] = np.nan
    values[:, 3] = np.nan
    starts = np.array([0, 5, 5, 9], np.int32)
    links = rng.integers(0, 9, 9).astype(np.int32)
    out = np.empty((3, 4))
    risks.median_rows(values, links, starts, out)
    for i in range(3):
        for c in range(4):
            known = sorted(x for x in values[links[starts[i] : starts[i + 1]], c].tolist() if x == x)
            np.testing.assert_equal(out[i, c], known[(len(known) - 1) // 2] if known else np.nan)


def test_shrinkage_of_what_is_clear_and_of_what_is_error():
    K, risk = np.array([10.0, 2.0, 1.0, 0.5]), np.ones(4)
    members, starts = np.arange(4, dtype=np.int32), np.arange(5, dtype=np.int32)
    out = np.empty(4)
    risks.disc_shrinkage(starts, members, K, risk, out)
    np.testing.assert_allclose(out, [1.0, (1 - 0.25) / 0.95, 0.0, 0.0], rtol=1e-14)
