"""Wald, modified Wald and Rinow curvature of meshes, clouds and graphs that sample smooth surfaces; and of a cube."""

import math

import networkx as nx
import numpy as np
import pytest

import rinow
import shapes
from rinow.geodesics.distances import geodesic_distances, geodesic_space

SURFACES = {
    "sphere": shapes.irregular_sphere(1000),
    "regular sphere": shapes.icosphere(3),
    "torus": shapes.irregular_torus(2500),
    "ellipsoid": shapes.irregular_ellipsoid(1600),
}
POINTS = {"sphere": (17,), "regular sphere": (17,), "torus": (0, 700), "ellipsoid": (1000,)}
EDGES = {"sphere": 5, "regular sphere": 5, "torus": 4, "ellipsoid": 5}
"""Radius of the balls in edge lengths; those of the torus stay on one side of its tube."""


def mesh_of(shape):
    return rinow.TriangleMesh(shape.vertices, shape.faces)


def edge(mesh):
    return float(np.sqrt(2 * mesh.vertex_areas.mean()))


@pytest.mark.parametrize("name", SURFACES)
def test_wald_modified_and_rinow_curvature_agree_with_gauss(name):
    # Wald's theorem 3.18, and Kirk's 6.3, 6.7 and 6.8 on surfaces of variable curvature.
    mesh, K = mesh_of(SURFACES[name]), SURFACES[name].gaussian
    radius = EDGES[name] * edge(mesh)
    for p in POINTS[name]:
        wald, modified = (rinow.wald_curvature(mesh, p, radius=radius, kind=kind) for kind in ("wald", "modified"))
        triangles = rinow.rinow_point_curvature(mesh, p, radius=radius, max_points=60)
        assert wald.exists and modified.exists
        assert wald.value == pytest.approx(K[p], abs=3 * wald.standard_error)
        assert wald.standard_error * radius**2 < 0.15
        assert modified.value == pytest.approx(wald.value, abs=3 * wald.standard_error + modified.standard_error)
        assert triangles.value == pytest.approx(wald.value, abs=3 * wald.standard_error + 2 * triangles.standard_error)


@pytest.mark.parametrize("name", SURFACES)
def test_bounds_of_a_region_hold_the_curvature_of_the_smooth_surface(name):
    mesh, K = mesh_of(SURFACES[name]), SURFACES[name].gaussian
    radius = EDGES[name] * edge(mesh)
    p = POINTS[name][-1]
    bounds = rinow.rinow_curvature(mesh, p, radius=radius, max_points=60)
    inside = K[geodesic_distances(mesh, [p])[0] <= radius]
    # With the errors of the chords allowed for, nothing contradicts the extremes of curvature in the ball.
    assert bounds.lower >= inside.min() - 1e-9
    assert bounds.upper <= inside.max() + 1e-9
    exact = rinow.rinow_curvature(mesh, p, radius=radius, max_points=60, rtol=0.0)
    assert exact.lower < bounds.lower and exact.upper > bounds.upper  # the polyhedron itself has corners


def test_witness_of_a_mesh_shows_the_bound():
    mesh = mesh_of(SURFACES["ellipsoid"])
    bounds = rinow.rinow_curvature(mesh, 17, radius=5 * edge(mesh), rtol=0.0)
    for witness, bound in ((bounds.lower_witness, bounds.lower), (bounds.upper_witness, bounds.upper)):
        D = geodesic_space(mesh, witness).distances
        values = rinow.embedding_curvatures(D[np.triu_indices(4, 1)]).values
        # The bound is an embedding curvature of its witness, by other equations: thin quadruples lose half the digits.
        assert np.nanmin(np.abs(values - bound)) < 1e-6 * max(abs(bound), D.max() ** -2)


def test_lengths_suffice():
    shape = shapes.irregular_torus(600)
    mesh = mesh_of(shape)
    lengths = np.linalg.norm(mesh.vertices[mesh.faces[:, [1, 2, 0]]] - mesh.vertices[mesh.faces[:, [2, 0, 1]]], axis=2)
    intrinsic = rinow.IntrinsicMesh(mesh.faces, lengths)
    radius = 3 * edge(mesh)
    for function in (rinow.wald_curvature, rinow.rinow_curvature):
        a, b = (function(m, 300, radius=radius, rtol=1e-4) for m in (mesh, intrinsic))
        field = "value" if function is rinow.wald_curvature else "lower"
        assert getattr(a, field) == pytest.approx(getattr(b, field), rel=1e-6)
    assert rinow.wald_curvature(intrinsic, 300, radius=radius).value == pytest.approx(
        shape.gaussian[300], abs=0.2 / radius**2
    )


def test_box_is_flat_inside_its_faces_and_bent_at_its_corners():
    box = shapes.box(8)
    mesh = mesh_of(box)
    extreme = (np.isclose(np.abs(box.vertices - 0.5 * (box.vertices.max(0) + box.vertices.min(0))), 0.5)).sum(axis=1)
    middle = 0.5 * (box.vertices.max(0) + box.vertices.min(0))
    far_from_corners = np.abs(np.abs(box.vertices - middle)).sum(axis=1)
    corner = int(np.flatnonzero(extreme == 3)[0])
    face = int(np.argmin(np.where(extreme == 1, far_from_corners, np.inf)))
    ridge = int(np.argmin(np.where(extreme == 2, far_from_corners, np.inf)))
    for p in (face, ridge):  # an edge is bent in space, not in itself
        for kind in ("wald", "modified"):
            flat = rinow.wald_curvature(mesh, p, radius=0.3, kind=kind, rtol=1e-12)
            assert flat.exists
            assert flat.value == pytest.approx(0, abs=1e-6)
        bounds = rinow.rinow_curvature(mesh, p, radius=0.3, rtol=1e-12)
        assert (bounds.lower, bounds.upper) == pytest.approx((0, 0), abs=1e-6)
        assert rinow.regular_radius(mesh, p, rtol=1e-12) > 0.3
    assert not rinow.wald_curvature(mesh, corner, radius=0.3).exists
    assert not rinow.rinow_point_curvature(mesh, corner, radius=0.5).exists


def test_regular_radius_of_a_sphere():
    mesh = mesh_of(SURFACES["regular sphere"])
    # An upper bound by distances up to the error of the chords, 4e-4: 200 of it for the curvature, half for the radius.
    assert rinow.regular_radius(mesh, 17, max_points=16) == pytest.approx(math.pi / 4, rel=0.05)


def test_weighted_graph_and_cloud_of_a_sphere():
    rng = np.random.default_rng(7)
    sphere = rinow.SpaceForm(1.0)
    P = sphere.sample(30, 0.5, rng)
    D = sphere.distance(P[:, None], P)
    D = 0.5 * (D + D.T)
    graph = nx.Graph()
    graph.add_nodes_from(range(30))
    graph.add_weighted_edges_from((i, j, D[i, j]) for i in range(30) for j in range(i))
    for space in (D, rinow.MetricSpace(D), graph):
        curvature = rinow.wald_curvature(space, 0, radius=0.6)
        assert curvature.exists and curvature.value == pytest.approx(1, abs=1e-7)
        bounds = rinow.rinow_curvature(space, 0, radius=0.6)
        assert (bounds.lower, bounds.upper) == pytest.approx((1, 1), abs=1e-7)
        assert rinow.regular_radius(space, 0) >= 0.6
        assert rinow.angle_at(space, 0, 1, 2) == pytest.approx(rinow.angle_at(D, 0, 1, 2, curvature=1.0), abs=1e-7)
        assert rinow.polar_coordinates(space, 0, 1, 2)[:, 0] == pytest.approx(D[0])
    cloud = sphere.sample(500, 0.5, rng)
    assert rinow.wald_curvature(cloud, 0, radius=0.3).value == pytest.approx(1, abs=0.02)
    bounds = rinow.rinow_curvature(cloud, 0, radius=0.3)
    assert bounds.upper <= 1 <= bounds.lower
    assert (
        bounds.lower - bounds.upper < 0.5
    )  # the polynomial is sure of arcs to 1e-4: 200 of it over the diameter squared


def test_vertex_of_another_component_is_not_in_the_ball():
    two = shapes.two_components()
    mesh = mesh_of(two)
    own = geodesic_distances(mesh, [0])[0]
    curvature = rinow.wald_curvature(mesh, 0, radius=float(own[np.isfinite(own)].max()) / 3)
    assert curvature.n_quadruples > 0
    assert math.isnan(rinow.angle_at(mesh, 0, 1, int(np.flatnonzero(np.isinf(own))[0])))
