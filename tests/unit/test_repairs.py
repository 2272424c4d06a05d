"""Faults that change nothing: what is there twice, seams, fins, and sheets that meet."""

import numpy as np
import pytest

import shapes
from rinow import IntrinsicMesh, TriangleMesh, VertexStatus, singular_features, surface_curvature
from rinow.curvature.repairs import repaired, sheets_of
from rinow.study.totals import surface_totals

SHAPE = shapes.irregular_ellipsoid(700)
V, F = SHAPE.vertices, SHAPE.faces
WAYS = [{}, {"quality": "fast"}, {"method": "intrinsic"}, {"method": "lifted"}, {"method": "wald"}]


def same(actual, expected, index=slice(None)):
    for field in ("gaussian", "mean", "spread", "radius", "status"):
        np.testing.assert_array_equal(getattr(actual, field), getattr(expected, field)[index])


@pytest.fixture(scope="module", params=WAYS, ids=lambda way: "-".join(way.values()) or "auto")
def way(request):
    return request.param, surface_curvature((V, F), **request.param)


def cut_in_half():
    """The ellipsoid with two rows of vertices where the halves meet, and the vertex of each before."""
    upper = V[F].mean(axis=1)[:, 2] > 0
    shared = np.intersect1d(F[upper], F[~upper])
    new, faces = np.arange(len(V)), F.copy()
    new[shared] = len(V) + np.arange(len(shared))
    faces[upper] = new[F[upper]]
    return np.concatenate([V, V[shared]]), faces, np.concatenate([np.arange(len(V)), shared])


@pytest.mark.parametrize("turned", [False, True])
def test_faces_listed_twice_count_once(way, turned):
    options, clean = way
    for rows in ([5], np.flatnonzero(V[F].mean(axis=1)[:, 0] > 0.3), np.arange(len(F))):
        again = F[rows][:, ::-1] if turned else F[rows]
        c = surface_curvature((V, np.concatenate([F, again])), **options)
        same(c, clean)
        what = "face has" if len(rows) == 1 else "faces have"
        were = "was" if len(rows) == 1 else "were"
        assert c.notes[0] == f"{len(rows)} {what} the same vertices as another one, and {were} left out."


def test_seams_are_closed(way):
    options, clean = way
    W, faces, origin = cut_in_half()
    n = len(W) - len(V)
    beside = W.copy()
    beside[len(V) :] *= 1.0 + 1e-10  # as sines of 0 and of 2π differ
    for place in (W, beside):
        c = surface_curvature((place, faces), **options)
        same(c, clean, origin)
        assert c.notes[0].startswith(f"{n} vertices lie on others, across a seam")


def test_seams_have_no_features_and_no_boundary():
    W, faces, origin = cut_in_half()
    assert len(singular_features((W, faces)).crease_edges) == 0
    totals = surface_totals(TriangleMesh(W, faces), surface_curvature((V, F)).gaussian[origin])
    assert (totals.euler_characteristic, totals.boundary_edges, totals.components) == (2, 0, 1)


def test_poles_of_a_grid_are_one_vertex():
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 25), np.linspace(0, np.pi, 13), indexing="ij")
    W = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)], axis=-1).reshape(-1, 3)
    i = np.arange(25 * 13).reshape(25, 13)
    a, b, c, d = (x.ravel() for x in (i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]))
    curvature = surface_curvature((W, np.concatenate([np.stack([a, c, b], 1), np.stack([a, d, c], 1)])))
    assert not curvature.status.any()
    np.testing.assert_allclose(curvature.gaussian, 1.0, rtol=1e-9)


def test_sheets_that_lie_on_each_other_are_not_joined():
    disc = shapes.open_patch(200)
    n = len(disc.vertices)
    for again in (disc.faces, disc.faces[:, ::-1]):
        mesh = TriangleMesh(np.concatenate([disc.vertices] * 2), np.concatenate([disc.faces, n + again]))
        assert repaired(mesh)[0] is mesh
    for shift, is_joined in ((0.0, True), (1e-3, False)):  # two sides of one edge, and a gap
        square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1 + shift, 0, 0), (1 + shift, 1, 0), (2, 0, 0)])
        mesh = TriangleMesh(square, [[0, 1, 2], [0, 2, 3], [4, 6, 5]])
        assert (repaired(mesh)[0].n_vertices == 5) is is_joined


def test_vertices_joined_by_an_edge_without_length_are_one(way):
    options, _ = way
    a, b, c = F[10]
    for gap in (0.0, 1e-9):
        W = V.copy()
        W[a] = W[b] + gap * W[c]
        curvature = surface_curvature((W, F), **options)
        expected = surface_curvature((W, np.where(a == F, b, F)), **options)
        np.testing.assert_allclose(np.delete(curvature.gaussian, a), np.delete(expected.gaussian, a), rtol=1e-6)
        assert curvature.gaussian[a] == curvature.gaussian[b]
    lengths = TriangleMesh(np.where(np.arange(len(V))[:, None] == a, V[b], V), F).edge_lengths
    assert repaired(IntrinsicMesh(F, lengths))[0].n_vertices == len(V) - 1


def test_short_edges_beside_long_ones_stay():
    W = shapes.irregular_ellipsoid(100).vertices
    for mesh in (TriangleMesh(W * (1.0, 1.0, 1e-4), shapes.irregular_ellipsoid(100).faces), TriangleMesh(V, F)):
        assert repaired(mesh) == (mesh, None, ())


def test_fins_are_left_out(way):
    options, clean = way
    a, b = F[10, :2]
    for tip in (2.0 * V[a], 0.5 * (V[a] + V[b]), np.array([1e4, 0.0, 0.0])):
        c = surface_curvature((np.concatenate([V, [tip]]), np.concatenate([F, [[a, b, len(V)]]])), **options)
        np.testing.assert_array_equal(c.gaussian[:-1], clean.gaussian)
        assert np.isnan(c.gaussian[-1])
        assert (c.status[[a, b]] == VertexStatus.NONMANIFOLD).all()
        assert "1 face stands on an edge of two others and was left out." in c.notes


def test_single_faces_around_one_edge_stay():
    W = [(0, 0, 0), (0, 0, 1), (1, 0, 0), (-1, 1, 0), (-1, -1, 0)]
    mesh = TriangleMesh(W, [[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    sheets = sheets_of(mesh)
    assert (sheets.mesh.n_faces, sheets.mesh.topology.n_components) == (3, 3)
    np.testing.assert_array_equal(np.bincount(sheets.origin), [3, 3, 1, 1, 1])


def test_surfaces_that_touch_at_a_vertex_do_not_see_each_other(way):
    options, clean = way
    v = 33
    new = np.arange(len(V)) + len(V)
    new[v] = v
    c = surface_curvature((np.concatenate([V, 2 * V[v] - V]), np.concatenate([F, new[F[:, ::-1]]])), **options)
    np.testing.assert_allclose(c.gaussian[: len(V)], clean.gaussian, rtol=1e-8)
    assert c.status[v] == VertexStatus.NONMANIFOLD
    assert any(note.startswith("At 1 vertex sheets of the surface meet") for note in c.notes)


@pytest.mark.parametrize("quality", ["best", "fast"])
def test_a_wall_on_a_surface_does_not_bend_it(quality):
    # A paraboloid, and a cylinder that stands on its middle row.
    n = 13
    i = np.arange(n * n).reshape(n, n)
    a, b, c, d = (x.ravel() for x in (i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]))
    grid = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    x, y = (t.ravel() for t in np.meshgrid(np.arange(n) - 6.0, np.arange(n) - 6.0, indexing="ij"))
    floor, wall = np.stack([x, y, 0.02 * (x * x + y * y)], 1), np.stack([x, 0 * x, 0.02 * x * x + y + 6.0], 1)
    foot = i[:, 6][(x + 6).astype(int)]
    new = np.where(y == -6.0, foot, len(x) + np.arange(len(x)))
    c = surface_curvature((np.concatenate([floor, wall]), np.concatenate([grid, new[grid]])), quality=quality)
    expected = 0.04**2 / (1 + 0.04**2 * (x * x + y * y)) ** 2
    off = (y != 0) & (c.status[: n * n] == VertexStatus.OK)
    np.testing.assert_allclose(c.gaussian[: n * n][off], expected[off], rtol=0.01)
    assert (c.status[i[:, 6]] == VertexStatus.NONMANIFOLD).all()


def standing_on(path, height, rows):
    """A sheet of `rows` rows above a row of vertices of the ellipsoid, after its vertices and faces."""
    p = np.concatenate([V, *(V[path] * (1 + height * (k + 1)) for k in range(rows))])
    i = np.concatenate([[path], len(V) + np.arange(rows * len(path)).reshape(rows, -1)])
    a, b, c, d = i[:-1, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel(), i[1:, :-1].ravel()
    return p, np.concatenate([F, np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def path_of_edges(n):
    """Vertices in a row along edges, about straight."""
    t, path = TriangleMesh(V, F).topology, [int(np.argmax(V[:, 2]))]
    while len(path) < n:
        near = t.neighbours[t.neighbour_offsets[path[-1]] : t.neighbour_offsets[path[-1] + 1]]
        path.append(int(near[np.argmax(V[near, 0] - np.abs(V[near, 1]))]))
    return np.array(path)


@pytest.mark.parametrize("sides", [(1,), (1, -1)], ids=["wall", "crossing"])
def test_a_sheet_that_stands_on_a_surface_does_not_cut_it(way, sides):
    options, clean = way
    path = path_of_edges(7)
    W, G = standing_on(path, 0.1 * sides[0], 4)
    if len(sides) == 2:  # it goes on below
        below, faces = standing_on(path, -0.1, 4)
        more = np.where(faces[len(F) :] < len(V), faces[len(F) :], faces[len(F) :] + len(W) - len(V))
        W, G = np.concatenate([W, below[len(V) :]]), np.concatenate([G, more])
    c = surface_curvature((W, G), **options)
    off = np.setdiff1d(np.arange(len(V)), path)
    np.testing.assert_allclose(c.gaussian[off], clean.gaussian[off], rtol=1e-6)
    assert (c.status[off] == VertexStatus.OK).all()
    assert (c.status[path] == VertexStatus.NONMANIFOLD).all()
    if len(sides) == 1:
        np.testing.assert_allclose(c.gaussian[path], clean.gaussian[path], rtol=1e-6)


def test_films_that_meet_under_equal_angles_are_three_sheets():
    u = np.radians([0, 120, 240])
    p = np.concatenate([[(0, 0, 0), (0, 0, 1)], np.stack([np.cos(u), np.sin(u), 0.5 + 0 * u], axis=1)])
    u = np.radians([0, 175, 190])  # and two that leave the first one alike
    q = np.concatenate([p[:2], np.stack([np.cos(u), np.sin(u), 0.5 + 0 * u], axis=1)])
    q[:, 0] += 5
    F = np.array([(0, 1, 2), (0, 1, 3), (0, 1, 4)])
    t = sheets_of(TriangleMesh(np.concatenate([p, q]), np.concatenate([F, F + 5]))).mesh.topology
    assert t.n_components == 6
