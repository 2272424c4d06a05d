"""Cracks between faces, and vertices amid an edge: values are those of the mesh without them."""

from itertools import pairwise

import numpy as np
import pytest

import shapes
from rinow import TriangleMesh, VertexStatus, singular_features, surface_curvature
from rinow.curvature.redundant import redundant_vertices
from rinow.curvature.repairs import repair, repaired

SHAPE = shapes.irregular_ellipsoid(700)
V, F = SHAPE.vertices, SHAPE.faces
WAYS = [{}, {"quality": "fast"}, *({"method": m} for m in ("intrinsic", "lifted", "wald", "robinson"))]
LENGTHS = [{"method": m} for m in ("intrinsic", "wald", "robinson")]


@pytest.fixture(scope="module", params=WAYS, ids=lambda way: "-".join(way.values()) or "auto")
def way(request):
    return request.param, surface_curvature((V, F), **request.param)


def split_on_one_side(shape, face, shares, *, caps=False):
    """Vertices on the first edge of a face for its neighbour only; with caps the gap is filled by faces without area.

    The new vertices, in the order of the edge, are the last ones.
    """
    W, G = shape.vertices, shape.faces
    a, b = G[face, :2]
    other = np.flatnonzero(((a == G).any(axis=1) & (b == G).any(axis=1)) & (np.arange(len(G)) != face))[0]
    apex = G[other][(G[other] != a) & (G[other] != b)][0]
    points = [(1 - s) * W[a] + s * W[b] for s in shares]
    chain = [a, *range(len(W), len(W) + len(points)), b]
    new = [(q, p, apex) for p, q in pairwise(chain)]
    if caps:
        new += [(p, q, b) for p, q in pairwise(chain[:-1])]
    return np.concatenate([W, points]), np.concatenate([np.delete(G, other, axis=0), new]), (a, b)


def split_within(face, kind):
    """A vertex that is put into a face, or on its first edge for both sides."""
    a, b, c = F[face]
    t = len(V)
    if kind == "face":
        new = [(a, b, t), (b, c, t), (c, a, t)]
        return np.concatenate([V, [V[[a, b, c]].mean(axis=0)]]), np.concatenate([np.delete(F, face, axis=0), new])
    W, G, _ = split_on_one_side(SHAPE, face, (0.5,))
    row = np.flatnonzero((G == F[face]).all(axis=1))[0]
    return W, np.concatenate([np.delete(G, row, axis=0), [(a, t, c), (t, b, c)]])


def lat_long(n, start, stop, shift=0.0):
    """A zone of the unit sphere, n vertices around."""
    rows = n // 6
    theta, u = np.linspace(start, stop, rows + 1)[:, None], shift + 2 * np.pi * np.arange(n) / n
    p = np.stack([np.sin(theta) * np.cos(u), np.sin(theta) * np.sin(u), np.cos(theta) + 0 * u], axis=2).reshape(-1, 3)
    i, j = np.indices((rows, n)).reshape(2, -1)
    a, b, c, d = i * n + j, (i + 1) * n + j, (i + 1) * n + (j + 1) % n, i * n + (j + 1) % n
    return p, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def zones(n, m, shift=0.0):
    """Two zones that meet at the equator, with a row of vertices each."""
    (p, f), (q, g) = lat_long(n, np.pi / 6, np.pi / 2), lat_long(m, np.pi / 2, 5 * np.pi / 6, shift)
    return TriangleMesh(np.concatenate([p, q]), np.concatenate([f, len(p) + g]))


@pytest.mark.parametrize("caps", [False, True])
@pytest.mark.parametrize("shares", [(0.5,), (0.3,), (0.25, 0.5, 0.75)])
def test_vertices_on_an_edge_change_no_other_value(way, shares, caps):
    options, clean = way
    W, G, (a, b) = split_on_one_side(SHAPE, 100, shares, caps=caps)
    c = surface_curvature((W, G), **options)
    np.testing.assert_array_equal(c.status, VertexStatus.OK)
    # The order of the faces is another one, and with it rounding; where noise is nothing but rounding, so is the choice
    # that depends on it.
    np.testing.assert_allclose(c.gaussian[: len(V)], clean.gaussian, rtol=1e-6)
    s = np.array(shares)
    for name in ("gaussian", "mean"):
        at_a, at_b = getattr(clean, name)[[a, b]]
        np.testing.assert_allclose(getattr(c, name)[len(V) :], (1 - s) * at_a + s * at_b, rtol=1e-6)
    spread, step = (
        (1 - s) * clean.spread[a] + s * clean.spread[b],
        s * (1 - s) * (clean.gaussian[b] - clean.gaussian[a]),
    )
    np.testing.assert_allclose(c.spread[len(V) :], np.hypot(spread, step), rtol=1e-4)
    left_out = "1 vertex was left out" if len(shares) == 1 else f"{len(shares)} vertices were left out"
    assert any(note.startswith(left_out) for note in c.notes)
    assert any(note.startswith("1 crack, where") for note in c.notes) is not caps


@pytest.mark.parametrize("kind", ["face", "edge"])
def test_vertices_put_into_a_face_or_an_edge_change_no_other_value(way, kind):
    options, clean = way
    c = surface_curvature(split_within(100, kind), **options)
    np.testing.assert_array_equal(c.status, VertexStatus.OK)
    np.testing.assert_allclose(c.gaussian[:-1], clean.gaussian, rtol=1e-6)
    np.testing.assert_allclose(c.gaussian[-1], c.gaussian[F[100][: 3 if kind == "face" else 2]].mean(), rtol=1e-6)
    assert any(note.startswith("1 vertex was left out") for note in c.notes)


def test_patterns_of_flat_and_ruled_surfaces_are_kept():
    # Squares with their centres: the centres have four neighbours on two lines.
    i, j = np.indices((9, 9)).reshape(2, -1)
    k = np.arange(72).reshape(8, 9)[:, :8].ravel()
    mid = 81 + np.arange(64)
    faces = np.concatenate(
        [np.stack([x, y, mid], axis=1) for x, y in ((k, k + 9), (k + 9, k + 10), (k + 10, k + 1), (k + 1, k))]
    )
    x, y = (
        np.concatenate([i, i.reshape(9, 9)[:8, :8].ravel() + 0.5]),
        np.concatenate([j, j.reshape(9, 9)[:8, :8].ravel() + 0.5]),
    )
    plane, cylinder = np.stack([x, y, 0 * x], axis=1), np.stack([np.cos(x / 9), np.sin(x / 9), y / 9], axis=1)
    for W in (plane, cylinder):
        assert redundant_vertices(TriangleMesh(W, faces)) == []
    # The rulings of a saddle are the sides of squares that are turned by 45 degrees.
    saddle = np.stack([x, y, (x * x - y * y) / 20], axis=1)
    assert redundant_vertices(TriangleMesh(saddle, faces)) == []


@pytest.mark.parametrize("options", LENGTHS, ids=lambda way: way["method"])
def test_faces_without_area_are_seen_by_lengths(options):
    W, G, _ = split_on_one_side(SHAPE, 100, (0.25, 0.5, 0.75), caps=True)
    mesh = TriangleMesh(W, G)
    by_lengths, by_positions = surface_curvature(mesh.intrinsic(), **options), surface_curvature(mesh, **options)
    np.testing.assert_array_equal(by_lengths.status, by_positions.status)
    np.testing.assert_allclose(by_lengths.gaussian, by_positions.gaussian, rtol=1e-6)


def test_vertices_of_a_finer_side_are_vertices_of_the_surface():
    sphere = shapes.irregular_sphere(700)
    W, G, _ = split_on_one_side(sphere, 100, (0.2, 0.5, 0.8))
    W /= np.linalg.norm(W, axis=1)[:, None]
    mesh = repaired(TriangleMesh(W, G))[0]
    assert mesh.topology.is_closed
    assert mesh.topology.euler_characteristic == 2
    for options, most in (({}, 1e-9), ({"quality": "fast"}, 1e-9), ({"method": "intrinsic"}, 1e-3)):
        c = surface_curvature((W, G), **options)
        np.testing.assert_array_equal(c.status, VertexStatus.OK)
        np.testing.assert_allclose(c.gaussian, 1.0, rtol=most)


@pytest.mark.parametrize(("n", "m"), [(96, 48), (48, 36), (41, 36)])
def test_zones_that_meet_with_different_rows_are_one_surface(n, m):
    mesh = zones(n, m)
    surface, index, _, amid = repair(mesh)
    shared = np.gcd(n, m)
    assert surface.n_vertices == mesh.n_vertices - shared
    assert surface.topology.edge_is_boundary.sum() == n + m
    assert surface.topology.vertex_is_manifold.all()
    assert not amid  # all of them are on the surface
    np.testing.assert_allclose(surface.vertices[index], mesh.vertices, atol=1e-12)
    c = surface_curvature(mesh)
    on_rim = np.abs(mesh.vertices[:, 2]) > np.cos(np.pi / 6) - 1e-9
    np.testing.assert_array_equal(c.status == VertexStatus.BOUNDARY, on_rim)
    np.testing.assert_allclose(c.gaussian[~on_rim], 1.0, rtol=1e-6)


def test_rows_without_a_common_vertex_stay_open():
    mesh = zones(41, 36, 0.01)
    assert repaired(mesh) == (mesh, None, ())


def test_a_plate_is_joined_to_a_longer_one_as_far_as_it_reaches():
    # The side of the first ends amid an edge of the second.
    p = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (1, 1, 0), (0, 0, 0), (3, 0, 0), (1, -1, 0)]
    surface = repaired(TriangleMesh(p, [(0, 1, 3), (1, 2, 3), (4, 6, 5)]))[0]
    t = surface.topology
    assert (surface.n_vertices, surface.n_faces, t.n_components, t.edge_is_boundary.sum()) == (6, 5, 1, 5)
    assert t.is_orientable
    assert not t.face_flips.any()


def test_holes_are_no_cracks():
    for shape in (SHAPE, shapes.irregular_torus(800), shapes.irregular_sphere(800)):
        for f in range(0, len(shape.faces), 7):
            mesh = TriangleMesh(shape.vertices, np.delete(shape.faces, f, axis=0))
            assert repaired(mesh)[0] is mesh
    x, y = np.indices((11, 11)).reshape(2, -1)
    i = np.arange(10 * 11).reshape(10, 11)[:, :-1].ravel()
    grid = np.concatenate([np.stack([i, i + 11, i + 12], axis=1), np.stack([i, i + 12, i + 1], axis=1)])
    for stretch in (1.0, 100.0):  # a square hole, and holes of needles
        W = np.stack([x * stretch, y, 0 * x], axis=1)
        for gone in ([44], [44, 144], [44, 45, 144, 145]):
            mesh = TriangleMesh(W, np.delete(grid, gone, axis=0))
            assert repaired(mesh)[0] is mesh


def test_sheets_that_lie_on_each_other_with_other_vertices_are_not_joined():
    square = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]
    other = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]
    mesh = TriangleMesh(square + other, [(0, 1, 2), (0, 2, 3), (4, 5, 8), (5, 6, 7), (5, 7, 8)])
    assert repaired(mesh)[0] is mesh


def test_a_crease_goes_on_through_a_vertex_on_it():
    box = shapes.box(4)
    whole = singular_features((box.vertices, box.faces))
    a, b = whole.crease_edges[5]
    f = np.flatnonzero(np.isin(box.faces, (a, b)).sum(axis=1) == 2)[0]
    turn = next(k for k in range(3) if not np.isin(box.faces[f, (k + 2) % 3], (a, b)))
    G = box.faces.copy()
    G[f] = np.roll(G[f], -turn)
    for caps in (False, True):
        W, H, _ = split_on_one_side(box._replace(faces=G), f, (0.5,), caps=caps)
        found = singular_features((W, H))
        assert len(found.crease_edges) == len(whole.crease_edges) + 1
        assert (found.crease_edges == len(box.vertices)).sum() == 2
        np.testing.assert_array_equal(found.cone_points, whole.cone_points)
        c = surface_curvature((W, H))
        assert c.status[-1] == VertexStatus.BOUNDARY
        np.testing.assert_array_equal(c.gaussian, 0.0)


def test_a_corner_on_an_edge_stays_a_vertex():
    # A step: the vertex 2 lies amid the edge 0 1 of the floor, and the faces behind it bend there.
    p = np.array([(0, 0, 0), (2, 0, 0), (1, 0, 0), (1, -2, 0), (0, 1, 0), (2, 1, 1.5), (1, 1, 0)], float)
    mesh = TriangleMesh(p, [(1, 0, 3), (0, 2, 4), (2, 6, 4), (2, 5, 6), (2, 1, 5)])
    c = surface_curvature(mesh, method="lifted")
    assert not any("left out" in note for note in c.notes)
    assert c.notes[0].startswith("1 crack, where")


@pytest.mark.parametrize("options", [{}, {"method": "intrinsic"}], ids=["auto", "intrinsic"])
def test_numbers_and_orientation_do_not_matter(options):
    W, G, _ = split_on_one_side(SHAPE, 100, (0.5,))
    W2, G2, _ = split_on_one_side(shapes.Shape(W, G, W, W), 700, (0.3, 0.6), caps=True)
    c = surface_curvature((W2, G2), **options)
    rng = np.random.default_rng(5)
    order = rng.permutation(len(W2))
    faces = np.argsort(order)[G2][rng.permutation(len(G2))]
    faces = np.roll(faces, 1, axis=1)
    faces[::3] = faces[::3, ::-1]
    d = surface_curvature((W2[order], faces), **options)
    np.testing.assert_allclose(d.gaussian, c.gaussian[order], rtol=1e-6)
    np.testing.assert_array_equal(d.status, c.status[order])


def test_a_face_without_area_at_the_rim_is_left_out():
    patch = shapes.open_patch(200)
    t = TriangleMesh(patch.vertices, patch.faces).topology
    a, b = t.edges[t.edge_is_boundary][0]
    f = np.flatnonzero(np.isin(patch.faces, (a, b)).sum(axis=1) == 2)[0]
    c = patch.faces[f][~np.isin(patch.faces[f], (a, b))][0]
    t = len(patch.vertices)
    W = np.concatenate([patch.vertices, [patch.vertices[[a, b]].mean(axis=0)]])
    split = np.concatenate([np.delete(patch.faces, f, axis=0), [(a, t, c), (t, b, c)]])
    with_cap = surface_curvature((W, np.concatenate([split, [(a, b, t)]])), method="lifted")
    without = surface_curvature((W, split), method="lifted")
    np.testing.assert_array_equal(with_cap.gaussian, without.gaussian)
    np.testing.assert_array_equal(with_cap.status, without.status)
    assert with_cap.status[t] == VertexStatus.BOUNDARY


def rod(n=12):
    """A prism with a vertex amid each edge of its upper rim, and caps fanned from corners as CAD systems do."""
    turn = 2 * np.pi * np.arange(n) / n
    ring = np.column_stack([np.cos(turn), np.sin(turn)])
    middles = 0.5 * (ring + np.roll(ring, -1, axis=0))
    V = np.vstack(
        [np.column_stack([points, np.full(n, z)]) for points, z in ((ring, 0.0), (ring, 2.0), (middles, 2.0))]
    )
    F = []
    for i in range(n):
        j = (i + 1) % n
        a, b, c, d, m = i, j, n + i, n + j, 2 * n + i
        F += [[a, b, d], [a, d, m], [a, m, c]]
        F += [[0, j, i]] * (0 < i < n - 1)
        F += [[n, c, m], [n, m, d]] if 0 < i < n - 1 else [[n, m, d]] if i == 0 else [[n, c, m]]
    return TriangleMesh(V, np.array(F))


def test_vertices_of_rims_are_kept():
    # They are all that is known of a cylinder: without them one of a CAD part has an eighth of its mean curvature.
    mesh = rod()
    assert mesh.euler_characteristic == 2
    assert redundant_vertices(mesh) == []
