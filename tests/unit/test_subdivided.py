"""Faces that were split in their plane: values are those of the mesh before, with any method."""

import numpy as np
import pytest
from scipy.spatial import KDTree

import shapes
from rinow import TriangleMesh, VertexStatus, surface_curvature
from rinow.curvature.redundant import redundant_vertices
from rinow.curvature.subdivided import coarser

ELLIPSOID, AXES = shapes.irregular_ellipsoid(500), np.array(shapes.ELLIPSOID_AXES)
WAYS = [{}, {"quality": "fast"}, *({"method": m} for m in ("intrinsic", "lifted", "wald", "robinson"))]


def split(shape, region, *, open_border=False):
    """Each face of a region in four, and those beside it cut at the new vertices, or left with these on edges."""
    V, F = shape.vertices, shape.faces
    middles, points = {}, list(V)

    def middle(a, b, *, make=False):
        edge = (min(a, b), max(a, b))
        if make and edge not in middles:
            middles[edge] = len(points)
            points.append((V[a] + V[b]) / 2)
        return middles.get(edge)

    for a, b, c in F[region].tolist():
        for u, v in ((a, b), (b, c), (c, a)):
            middle(u, v, make=True)
    faces = []
    for face, is_split in zip(F.tolist(), region.tolist(), strict=True):
        polygon = []
        for u, v in zip(face, face[1:] + face[:1], strict=True):
            m = middle(u, v) if is_split or not open_border else None
            polygon += [u] if m is None else [u, m]
        if len(polygon) == 6:
            a, z, b, x, c, y = polygon
            faces += [(a, z, y), (b, x, z), (c, y, x), (x, y, z)]
            continue
        turn = next((i for i, v in enumerate(polygon) if v >= len(V)), 0)
        polygon = polygon[turn:] + polygon[:turn]
        faces += [(polygon[0], polygon[i], polygon[i + 1]) for i in range(1, len(polygon) - 1)]
    return np.array(points), np.array(faces)


def regions(shape):
    centres = shape.vertices[shape.faces].mean(axis=1)
    return {
        "one": np.arange(len(shape.faces)) == 100,
        "half": centres[:, 0] > 0.0,
        "some": np.random.default_rng(5).random(len(centres)) < 0.3,
        "all": np.ones(len(centres), np.bool_),
    }


def sorted_faces(faces):
    return np.unique(np.sort(faces, axis=1), axis=0)


@pytest.fixture(scope="module", params=WAYS, ids=lambda way: "-".join(way.values()) or "auto")
def way(request):
    return request.param, surface_curvature((ELLIPSOID.vertices, ELLIPSOID.faces), **request.param)


@pytest.mark.parametrize("open_border", [False, True])
@pytest.mark.parametrize("region", ["one", "half", "some", "all"])
def test_split_faces_change_no_value(way, region, open_border):
    options, clean = way
    n = len(ELLIPSOID.vertices)
    W, G = split(ELLIPSOID, regions(ELLIPSOID)[region], open_border=open_border)
    c = surface_curvature((W, G), **options)
    np.testing.assert_array_equal(c.status, VertexStatus.OK)
    np.testing.assert_allclose(c.gaussian[:n], clean.gaussian, rtol=1e-6)
    assert any(note.startswith(f"{len(W) - n} vertices were left out") for note in c.notes)
    # A new vertex, in the middle of an edge, has the mean of the values of its ends.
    edges = np.unique(np.sort(ELLIPSOID.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    middle = KDTree(W[edges].mean(axis=1)).query(W[n:])[1]
    np.testing.assert_allclose(c.gaussian[n:], c.gaussian[edges[middle]].mean(axis=1), rtol=1e-6)


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("shape", [ELLIPSOID, shapes.icosphere(2), shapes.irregular_torus(1500)])
def test_the_mesh_before_is_found(shape, single):
    W, G = split(shape, regions(shape)["half"])
    W, G = split(shapes.Shape(W, G, W, W), np.ones(len(G), np.bool_))  # with vertices within faces
    found = coarser(TriangleMesh(W.astype(np.float32) if single else W, G))
    np.testing.assert_array_equal(sorted_faces(found.mesh.faces), sorted_faces(shape.faces))
    assert not found.mesh.topology.face_flips.any()
    np.testing.assert_array_equal(found.vertices, np.arange(len(shape.vertices), len(W)))
    assert (found.weights > -0.05).all()  # quadrilaterals have some beside the shorter diagonal
    assert (np.count_nonzero(found.weights, axis=1) > 2).any()
    places = np.einsum("nk,nkd->nd", found.weights, W[found.corners])
    np.testing.assert_allclose(places, W[found.vertices], atol=1e-6)


@pytest.mark.parametrize("options", [{}, {"method": "intrinsic"}])
def test_values_within_faces_change_gradually(options):
    shape = shapes.irregular_ellipsoid(2000)
    W, G = split(shape, np.ones(len(shape.faces), np.bool_))
    W, G = split(shapes.Shape(W, G, W, W), np.ones(len(G), np.bool_))
    n, c = len(shape.vertices), surface_curvature((W, G), **options)
    places = W[n:] / np.linalg.norm(W[n:] / AXES, axis=1)[:, None]
    K = np.prod(AXES**-2) / np.sum((places / AXES**2) ** 2, axis=1) ** 2
    error = np.sqrt(np.mean((c.gaussian[n:] - K) ** 2) / np.mean(K**2))
    # Corners have an error of 1 % at most, and what a quarter of an edge changes is 10 %.
    assert error < 0.02, error
    assert np.mean(np.abs(c.gaussian[n:] - K) <= 2.0 * c.spread[n:]) > 0.9


def test_numbers_and_orientation_do_not_matter():
    W, G = split(ELLIPSOID, regions(ELLIPSOID)["some"])
    rng = np.random.default_rng(6)
    order = rng.permutation(len(W))
    faces = np.argsort(order)[G][rng.permutation(len(G))]
    faces[::3] = faces[::3, ::-1]
    for options in ({"method": "intrinsic"}, {"method": "lifted"}):
        c, d = surface_curvature((W, G), **options), surface_curvature((W[order], faces), **options)
        np.testing.assert_allclose(d.gaussian, c.gaussian[order], rtol=1e-6)


def test_an_open_surface_is_found_but_for_faces_with_two_sides_at_the_rim():
    patch = shapes.open_patch(400)
    W, G = split(patch, np.ones(len(patch.faces), np.bool_))
    found = coarser(TriangleMesh(W, G))
    in_corner = (TriangleMesh(patch.vertices, patch.faces).topology.partners.reshape(-1, 3) < 0).sum(axis=1) == 2
    kept = np.setdiff1d(np.arange(len(patch.vertices), len(W)), found.vertices)
    assert len(kept) <= 3 * in_corner.sum()
    beside = patch.faces[in_corner]
    for _ in range(5):  # quadrics of two rings, lengths by those of neighbours, and two sweeps
        beside = patch.faces[np.isin(patch.faces, beside).any(axis=1)]
    for options in ({"method": "lifted"}, {"method": "wald"}):
        c, clean = surface_curvature((W, G), **options), surface_curvature((patch.vertices, patch.faces), **options)
        compared = (clean.status == VertexStatus.OK) & ~np.isin(np.arange(len(patch.vertices)), beside)
        np.testing.assert_allclose(c.gaussian[: len(compared)][compared], clean.gaussian[compared], rtol=1e-6)


def grid(n_u, n_v, places, *, closed=False):
    """A grid of places(u, v) for u and v from 0 to 1."""
    u, v = np.meshgrid(np.arange(n_u) / (n_u - (not closed)), np.linspace(0, 1, n_v), indexing="ij")
    i = np.arange(n_u * n_v).reshape(n_u, n_v)
    i = np.concatenate([i, i[:1]]) if closed else i
    a, b, c, d = (x.ravel() for x in (i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]))
    V = np.stack(np.broadcast_arrays(*places(u, v)), axis=-1).reshape(-1, 3)
    return V, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def half_cylinder():
    """An irregular mesh of a half cylinder; its straight sides are rulings."""
    n_u, n_v = 30, 20
    i, j = np.indices((n_u, n_v)).reshape(2, -1)
    rng = np.random.default_rng(7)
    inner = (i > 0) & (i < n_u - 1) & (j > 0) & (j < n_v - 1)
    u, v = np.array([i, j]) + np.where(inner, rng.uniform(-0.3, 0.3, (2, len(i))), 0.0)
    a = (np.arange(n_u - 1)[:, None] * n_v + np.arange(n_v - 1)).ravel()
    b, c, d = a + n_v, a + n_v + 1, a + 1
    turn = rng.random(len(a)) < 0.5
    faces = [np.where(turn, x, y) for x, y in ((a, a), (b, b), (d, c), (b, a), (c, c), (d, d))]
    u *= np.pi / (n_u - 1)
    return np.stack([np.cos(u), np.sin(u), 0.1 * v], axis=1), np.concatenate(
        np.array(faces).reshape(2, 3, -1), axis=1
    ).T


TURN = 2 * np.pi
KEPT = {
    "plane": grid(12, 12, lambda u, v: (u, v, 0.0)),
    "cylinder": grid(24, 12, lambda u, v: (np.cos(TURN * u), np.sin(TURN * u), 2 * v), closed=True),
    "cone": shapes.cone(24, 4, 0.3)[:2],
    "saddle": grid(21, 21, lambda u, v: (u, v, (u - 0.5) * (v - 0.5))),
    "hyperboloid": grid(
        40,
        12,
        lambda u, v: (
            np.cos(TURN * u) - (v - 0.5) * np.sin(TURN * u),
            np.sin(TURN * u) + (v - 0.5) * np.cos(TURN * u),
            v - 0.5,
        ),
        closed=True,
    ),
    "plateau": grid(41, 41, lambda u, v: (u, v, np.maximum(0.05, 0.1 * np.sin(TURN * u) * np.cos(TURN * v)))),
    "box": shapes.box(4)[:2],
    "half_cylinder": half_cylinder(),
}


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("name", KEPT)
def test_flat_parts_and_ruled_surfaces_keep_their_vertices(name, single):
    V, F = KEPT[name]
    assert coarser(TriangleMesh(V.astype(np.float32) if single else V, F)) is None


def test_heights_in_steps_keep_nearly_all_vertices():
    V, F = grid(41, 41, lambda u, v: (u, v, np.round(20 * np.sin(5 * u) * np.cos(4 * v)) / 200))
    found = coarser(TriangleMesh(V, F))
    assert found is None or len(found.vertices) < 0.005 * len(V)


@pytest.mark.parametrize(
    "height",
    [
        lambda u, v: ((u - 0.5) ** 3 - 3 * (u - 0.5) * (v - 0.5) ** 2) * 2,
        lambda u, v: 0.1 * np.sin(TURN * u) * np.cos(3 * v),
    ],
)
def test_points_of_inflection_on_symmetric_grids_are_on_the_surface(height):
    """Half the vertices have four neighbours; on lines of inflection they are amid two of these, to the last digit."""
    n = 21
    V, _ = grid(n, n, lambda u, v: (u, v, height(u, v)))
    i, j = (k.ravel() for k in np.indices((n - 1, n - 1)))
    a, b, c, d = i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1
    turn = (i + j) % 2 == 0
    one, other = np.where(turn, [a, b, d], [a, b, c]).T, np.where(turn, [b, c, d], [a, c, d]).T
    assert not redundant_vertices(TriangleMesh(V, np.concatenate([one, other])))
