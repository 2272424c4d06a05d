"""Creases, corners and cone points of generated parts, at several spacings and noise levels, and none elsewhere."""

import numpy as np
import pytest

import parts
import rinow
import shapes
from feature_scores import features_of, precision_and_recall
from rinow.curvature.barriers import crease_barriers
from rinow.curvature.creases import EdgeTurnings

SOLIDS = parts.with_features()
SMOOTH = {
    "sphere": lambda: shapes.irregular_sphere(1500),
    "coarse sphere": lambda: shapes.icosphere(1),
    "torus": lambda: shapes.irregular_torus(1500),
    "ellipsoid": lambda: shapes.irregular_ellipsoid(1000),
    "saddle": lambda: shapes.open_patch(900),
}


@pytest.mark.parametrize("noise", [0.0, 0.01, 0.02])
@pytest.mark.parametrize("h", [0.3, 0.12])
@pytest.mark.parametrize("name", SOLIDS)
def test_creases_are_found_and_nothing_else(name, h, noise):
    part = parts.noisy(SOLIDS[name](h), noise)
    found = features_of(part)
    assert min(precision_and_recall(found.crease_edges, part.creases)) >= 0.95


@pytest.mark.parametrize("noise", [0.0, 0.01, 0.02])
@pytest.mark.parametrize("h", [0.3, 0.12])
@pytest.mark.parametrize("name", SOLIDS)
def test_corners_and_cone_points_are_found_and_nothing_else(name, h, noise):
    part = parts.noisy(SOLIDS[name](h), noise)
    found = features_of(part)
    assert set(found.corners) == set(part.corners)
    assert set(found.cone_points) == set(part.cone_points)
    # Noise of 2 % tilts each of the six edges at a corner by 0.03 rad or more, most the short ones; a coarse apex has
    # six faces, and the discs around it three rings before the rim: their chords are off by a tenth of the angle.
    expected = part.cone_angles[np.argsort(part.cone_points)]
    np.testing.assert_allclose(found.cone_angles, expected, atol=0.15 + 10 * noise, rtol=0.1)


@pytest.mark.parametrize("noise", [0.0, 0.01, 0.02])
def test_sides_of_three_edges_are_told_from_a_round(noise):
    # Sections of three edges reach over the next crease, which turns by 30° only.
    part = parts.noisy(parts.regular_prism(12, 0.2), noise)
    found = features_of(part)
    assert precision_and_recall(found.crease_edges, part.creases) == (1.0, 1.0)
    assert set(found.corners) == set(part.corners) == set(found.cone_points)


@pytest.mark.parametrize("seed", [3, 5, 8])
def test_thin_plates_have_no_creases_across_their_edges(seed):
    part = parts.noisy(parts.box(0.2, size=(2.0, 1.5, 0.12)), 0.02, seed=seed)
    found = features_of(part)
    assert min(precision_and_recall(found.crease_edges, part.creases)) >= 0.99
    assert set(found.corners) == set(part.corners) == set(found.cone_points)


@pytest.mark.parametrize("seed", [3, 5, 8])
def test_precision_and_recall_over_all_solids(seed):
    found = true = common = 0
    for name, solid in SOLIDS.items():
        part = parts.noisy(solid(0.15), 0.02, seed=seed)
        edges = {tuple(e) for e in features_of(part).crease_edges}
        expected = {tuple(e) for e in part.creases}
        found, true, common = found + len(edges), true + len(expected), common + len(edges & expected)
        assert len(edges ^ expected) <= 0.05 * len(expected), name
    assert common / found >= 0.99 and common / true >= 0.99


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_fillets_are_smooth(noise):
    found = features_of(parts.noisy(parts.rounded_box(26), noise))
    assert len(found.crease_edges) == len(found.corners) == len(found.cone_points) == 0


@pytest.mark.parametrize("noise", [0.0, 0.02, 0.05, 0.1])
@pytest.mark.parametrize("name", SMOOTH)
def test_smooth_surfaces_have_no_features_even_with_noise(name, noise):
    shape = shapes.noisy(SMOOTH[name](), noise)
    found = rinow.singular_features((shape.vertices, shape.faces))
    assert len(found.crease_edges) == len(found.corners) == len(found.cone_points) == 0


@pytest.mark.parametrize("seed", [1, 3, 5, 7])
def test_spikes_bend_to_and_fro_and_are_no_creases(seed):
    mesh = rinow.TriangleMesh(*shapes.open_patch(900)[:2])
    rng, n = np.random.default_rng(seed), mesh.n_vertices
    heights = (rng.random(n) < 0.03) * rng.choice([-1, 1], n) * 0.5 * mesh.mean_edge_length
    spiky = rinow.TriangleMesh(mesh.vertices + mesh.vertex_normals * heights[:, None], mesh.faces)
    assert not len(rinow.singular_features(spiky).crease_edges)


@pytest.mark.parametrize("name", SOLIDS)
def test_crease_angles_of_clean_solids(name):
    part = SOLIDS[name](0.12)
    found = features_of(part)
    slope = {"cone": 1.0, "flat cone": 0.5, "steep cone": 2.0}.get(name)
    if slope is not None:
        # Chords of the rim cut off facets whose tilt differs from the cone's by O(h²/R²).
        np.testing.assert_allclose(found.crease_angles, np.pi - np.arctan(slope), atol=0.06)
    elif "prism" in name:
        n = {"triangular": 3, "pentagonal": 5, "hexagonal": 6}[name.split()[0]]
        assert np.abs(np.subtract.outer(found.crease_angles, [np.pi / 2, 2 * np.pi / n])).min(axis=1).max() < 1e-6
    else:
        # The lids of the cylinder meet facets, not the wall: their tilt is at most that of half a chord, h/2R.
        np.testing.assert_allclose(np.abs(found.crease_angles), np.pi / 2, atol=0.06 if name == "cylinder" else 1e-6)
    # One edge of the L is concave: it has as many pieces as its height, 0.8, has spacings.
    assert np.sum(found.crease_angles < 0) == (round(0.8 / 0.12) if name == "L-shape" else 0)
    np.testing.assert_allclose(found.crease_exponents, -1.0, atol=0.1)


def test_cone_angle_is_that_of_the_unrolled_sector():
    for slope in (0.5, 1.0, 2.0):
        part = parts.cone(0.08, slope=slope)
        # The half-angle has the tangent 1/slope; rings of chords around the apex change the angle by O(h²).
        np.testing.assert_allclose(features_of(part).cone_angles, 2 * np.pi / np.hypot(1, slope), rtol=0.06)


def test_lengths_alone_tell_the_cone_points():
    part = parts.box(0.15)
    mesh = rinow.TriangleMesh(part.vertices, part.faces)
    found = rinow.singular_features(mesh.intrinsic())
    assert set(found.cone_points) == set(part.cone_points)
    np.testing.assert_allclose(found.cone_angles, 1.5 * np.pi, atol=1e-9)
    assert len(found.crease_edges) == len(found.corners) == 0


def test_minimal_triangulations_of_solids_have_all_their_edges():
    for shape, n_creases, n_corners in ((shapes.cube(), 12, 8), (shapes.tetrahedron(), 6, 4)):
        found = features_of(shape)
        assert len(found.crease_edges) == n_creases
        assert len(found.corners) == len(found.cone_points) == n_corners


def test_facets_of_a_cylinder_are_no_creases():
    # Long strips with two triangles each, 12 to 40 around: the normal turns by the same angle at each of them.
    for n in (12, 20, 40):
        t = 2 * np.pi * np.arange(n) / n
        ring = np.stack([np.cos(t), np.sin(t), np.zeros(n)], axis=1)
        V = np.concatenate([ring, ring, np.array([(0, 0, 0), (0, 0, 3)])])
        V[n : 2 * n, 2] = 3.0
        a = np.arange(n)
        b = (a + 1) % n
        lid, bottom = np.full(n, 2 * n + 1), np.full(n, 2 * n)
        F = np.concatenate(
            [np.stack(c, axis=1) for c in ((a, b, b + n), (a, b + n, a + n), (lid, a + n, b + n), (bottom, b, a))]
        )
        found = rinow.singular_features((V, F))
        rims = np.sort(np.concatenate([np.stack([a, b], axis=1), np.stack([a, b], axis=1) + n]), axis=1)
        assert precision_and_recall(found.crease_edges, rims) == (1.0, 1.0)
        assert len(found.corners) == 0


def test_open_crease_ends_at_the_boundary():
    x, y = (g.ravel() for g in np.meshgrid(np.arange(11.0), np.arange(9.0), indexing="ij"))
    V = np.stack([x, y, np.abs(x - 5.0)], axis=1)  # a valley along x = 5
    F = shapes._grid_faces(11, 9, None, closed=False)
    found = rinow.singular_features((V, F))
    expected = np.stack([45 + np.arange(8), 46 + np.arange(8)], axis=1)
    np.testing.assert_array_equal(found.crease_edges, expected)
    np.testing.assert_allclose(found.crease_angles, -np.pi / 2)
    assert len(found.corners) == len(found.cone_points) == 0


@pytest.mark.parametrize("noise", [0.0, 0.02])
@pytest.mark.parametrize(("steps", "slope"), [(8, 0.8), (16, 0.8), (16, -0.6)])
def test_crease_that_fades_is_found_where_it_is_sharp(steps, slope, noise):
    x, y = (g.ravel() for g in np.meshgrid(*(np.linspace(-1, 1, 2 * steps + 1),) * 2, indexing="ij"))

    def height(x, y):
        s = np.clip(-y, 0, 1)
        return -slope * np.abs(x) * s * s * (3 - 2 * s)

    F = shapes._grid_faces(2 * steps + 1, 2 * steps + 1, None, closed=False)
    shape = shapes.noisy(shapes.without_curvature(np.stack([x, y, height(x, y)], axis=1), F), noise)
    found = {tuple(e) for e in rinow.singular_features((shape.vertices, shape.faces)).crease_edges}
    line = np.flatnonzero(x == 0)
    edges = np.stack([line[:-1], line[1:]], axis=1)
    angles = 2 * np.arctan(np.abs(height(1.0, y[edges].mean(axis=1))))
    # Edges of 40° start a line, which may end a step after or before the angle of 20° that an edge needs.
    assert {tuple(e) for e in edges[angles > np.radians(40)]} <= found
    assert found <= {tuple(e) for e in edges[angles > np.radians(8)]}


@pytest.mark.parametrize("defect", [0.1, 0.3, 1.0, 3.0])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_apexes_of_flat_and_steep_cones(defect, noise):
    # Slopes of 0.18 to 1.6: the flank has the cone angle 2π sin(half-angle), its six faces at the apex a tenth less.
    slope = np.sqrt((1 - defect / (2 * np.pi)) ** -2 - 1)
    found = features_of(parts.noisy(parts.cone(0.1, slope=slope), noise))
    assert len(found.cone_points) == 1
    np.testing.assert_allclose(found.cone_angles, 2 * np.pi - defect, atol=0.02 + 10 * noise, rtol=0.1)


def test_barriers_are_the_creases_by_edges_of_the_mesh():
    part = parts.noisy(parts.cylinder(0.15), 0.02)
    mesh = rinow.TriangleMesh(part.vertices, part.faces)
    is_crease = crease_barriers(mesh)
    assert is_crease.shape == (mesh.topology.n_edges,)
    assert min(precision_and_recall(np.sort(mesh.topology.edges[is_crease], axis=1), part.creases)) >= 0.95


def test_noise_of_heights_is_estimated_from_edges_that_turn_to_and_fro():
    shape = shapes.noisy(shapes.box(20), 0.03)
    mesh = rinow.TriangleMesh(shape.vertices, shape.faces)
    # Quartiles of ten numbers; the median over the mesh is good to a tenth, but not beside the creases.
    assert np.median(EdgeTurnings(mesh).height_noise) == pytest.approx(0.03 * mesh.mean_edge_length, rel=0.2)


def test_table_for_notebooks():
    found = features_of(parts.box(0.3))
    assert "corners" in found._repr_html_()
