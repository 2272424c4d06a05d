"""Single vertices far beside a surface change no value of the rest; tips, corners and noise are none."""

import numpy as np
import pytest

import parts
import shapes
from rinow import TriangleMesh, VertexStatus, surface_curvature
from rinow.curvature.outliers import outlying_vertices
from rinow.curvature.vertex_removal import without_strays

SHAPE = shapes.irregular_ellipsoid(700)
V, F = SHAPE.vertices, SHAPE.faces
MESH = TriangleMesh(V, F)
WAYS = [{}, {"quality": "fast"}, *({"method": m} for m in ("intrinsic", "lifted", "wald", "robinson"))]


@pytest.fixture(scope="module", params=WAYS, ids=lambda way: "-".join(way.values()) or "auto")
def way(request):
    """A method, and the values of the mesh whose star of vertex 300 is filled: what is known without it."""
    filled = without_strays(moved(300, 5.0), [])[0]
    clean = surface_curvature((filled.vertices, filled.faces), **request.param)
    return request.param, clean


def moved(vertex, height, aside=0.0):
    W, normal = V.copy(), MESH.vertex_normals[vertex]
    across = np.cross(normal, (0.3, 0.5, 0.7))
    W[vertex] += MESH.mean_edge_length * (height * normal + aside * across / np.linalg.norm(across))
    return TriangleMesh(W, F)


@pytest.mark.parametrize(("height", "aside"), [(5.0, 0.0), (-2.0, 0.0), (0.5, 0.0), (0.0, 1.5), (1.0, 1.0)])
def test_a_vertex_that_was_moved_changes_no_other_value(way, height, aside):
    options, clean = way
    c = surface_curvature(moved(300, height, aside), **options)
    rest = np.arange(len(V)) != 300
    np.testing.assert_allclose(c.gaussian[rest], clean.gaussian[rest], rtol=1e-6)
    assert (c.status == VertexStatus.OK).all()
    around = MESH.topology.neighbours[MESH.topology.neighbour_offsets[300] : MESH.topology.neighbour_offsets[301]]
    assert c.gaussian[300] in c.gaussian[around]
    assert any(note.startswith("1 vertex was left out") for note in c.notes)


def test_without_it_the_curvature_is_as_good_as_that_of_the_whole():
    scale = np.sqrt(np.mean(SHAPE.gaussian**2))
    for options, most in (({}, 0.05), ({"quality": "fast"}, 0.05), ({"method": "intrinsic"}, 0.15)):
        clean = surface_curvature((V, F), **options)
        c = surface_curvature(moved(300, 5.0), **options)
        rest = np.arange(len(V)) != 300
        assert np.abs(c.gaussian - clean.gaussian)[rest].max() < most * scale


def test_the_angle_defect_is_that_of_the_mesh_as_it_is():
    mesh = moved(300, 5.0)
    c = surface_curvature(mesh, method="angle_defect")
    np.testing.assert_allclose(c.gaussian * mesh.vertex_areas, mesh.vertex_angle_defects, atol=1e-12)


def test_tips_and_corners_are_no_outliers():
    solids = [
        shapes.tetrahedron(),
        shapes.cube(),
        shapes.box(4),
        shapes.cone(6),
        shapes.cone(24),
        shapes.cone(24, 8, 3.0),
    ]
    solids += [parts.l_shape(0.3), parts.cylinder(0.3)]
    for solid in solids:
        assert outlying_vertices(TriangleMesh(solid.vertices, solid.faces)) == []


def test_smooth_surfaces_and_noise_have_none():
    for noise in (0.0, 0.01, 0.03):
        for shape in (shapes.irregular_torus(2500), shapes.irregular_ellipsoid(2500)):
            noisy = shapes.noisy(shape, noise)
            assert outlying_vertices(TriangleMesh(noisy.vertices, noisy.faces)) == []


def test_large_noise_makes_no_outliers():
    """Of sixty draws with up to a fifth of the spacing one may be left with a fold as wide as its noise explains."""
    shape = shapes.irregular_ellipsoid(2500)
    noisy = [shapes.noisy(shape, noise, seed) for noise in (0.1, 0.15, 0.2) for seed in range(20)]
    assert sum(len(outlying_vertices(TriangleMesh(mesh.vertices, mesh.faces))) for mesh in noisy) <= 1


def test_several_are_found_at_any_numbering_and_orientation():
    W = V.copy()
    for v, height in ((100, 3.0), (300, -1.0), (500, 0.7)):
        W[v] = moved(v, height).vertices[v]
    assert sorted(outlying_vertices(TriangleMesh(W, F))) == [100, 300, 500]
    order = np.random.default_rng(3).permutation(len(V))
    again = TriangleMesh(W[order], np.argsort(order)[F][:, ::-1])
    assert sorted(order[outlying_vertices(again)]) == [100, 300, 500]
