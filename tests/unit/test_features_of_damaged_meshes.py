"""Singular features of soups, of turned, repeated and lost faces, and in other units, places and numberings."""

import numpy as np
import pytest

import parts
import rinow
import shapes
from feature_scores import features_of, precision_and_recall


def test_units_and_motions_and_numbering_change_nothing():
    part = parts.noisy(parts.l_shape(0.25), 0.02)
    found = features_of(part)
    rng = np.random.default_rng(6)
    order = rng.permutation(len(part.vertices))
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    Q *= np.sign(np.linalg.det(Q))
    for scale in (1e-140, 1.0, 1e140):
        V = np.empty_like(part.vertices)
        V[order] = scale * (part.vertices @ Q.T + (3, -1, 2))
        moved = rinow.singular_features((V, order[part.faces]))
        assert precision_and_recall(moved.crease_edges, np.sort(order[found.crease_edges], axis=1)) == (1.0, 1.0)
        assert set(moved.corners) == set(order[found.corners])


@pytest.mark.parametrize("exponent", [-900, -532, 0, 532, 900])
def test_cone_points_of_meshes_whose_areas_are_no_numbers(exponent):
    """Powers of two change no digit of a length."""
    part = parts.with_features()["cone"](0.15)
    angles = features_of(part).cone_angles
    scaled = rinow.TriangleMesh(np.ldexp(part.vertices, exponent), part.faces)
    found = rinow.singular_features(scaled)
    assert set(found.cone_points) == set(part.cone_points)
    np.testing.assert_allclose(found.cone_angles, angles, rtol=1e-9)
    areas = rinow.TriangleMesh(part.vertices, part.faces).vertex_areas
    with np.errstate(over="ignore", under="ignore"):
        np.testing.assert_allclose(scaled.vertex_areas, np.ldexp(areas, 2 * exponent), rtol=1e-12)


def test_reversed_faces_and_a_turned_face_change_nothing():
    part = parts.box(0.25)
    found = features_of(part)
    one = part.faces.copy()
    one[5] = one[5, ::-1]
    for F in (part.faces[:, ::-1], one):
        other = rinow.singular_features((part.vertices, F))
        np.testing.assert_array_equal(other.crease_edges, found.crease_edges)
        np.testing.assert_allclose(other.crease_angles, found.crease_angles, atol=1e-9)


def test_soup_is_welded_and_named_by_first_vertices():
    part = parts.box(0.3)
    soup = shapes.soup(shapes.without_curvature(part.vertices, part.faces))
    found = rinow.singular_features((soup.vertices, soup.faces))
    assert len(found.crease_edges) == len(part.creases) and len(found.corners) == 8
    np.testing.assert_array_equal(
        np.unique(soup.vertices[found.corners], axis=0), np.unique(part.vertices[part.corners], axis=0)
    )
    assert any("were taken as one" in note for note in found.notes)


def test_damaged_meshes_do_not_crash():
    part = parts.box(0.3)
    V, F = part.vertices.copy(), part.faces
    V[3] = np.nan
    hole = rinow.singular_features((V, F))
    assert 3 not in hole.crease_edges and np.isfinite(hole.crease_angles).all()
    doubled = rinow.singular_features((part.vertices, np.concatenate([F, F[:3]])))
    assert np.isfinite(doubled.crease_angles).all()
    assert len(rinow.singular_features(([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])).crease_edges) == 0
    bow = shapes.bow_tie()
    assert len(rinow.singular_features((bow.vertices, bow.faces)).crease_edges) == 0


@pytest.mark.parametrize("share_of_faces", [0.05, 1.0])
def test_repeated_faces_change_nothing(share_of_faces):
    part = parts.noisy(parts.l_shape(0.25), 0.01)
    found = features_of(part)
    more = part.faces[: int(share_of_faces * len(part.faces)), [1, 2, 0]]
    other = rinow.singular_features((part.vertices, np.concatenate([part.faces, more])))
    np.testing.assert_array_equal(other.crease_edges, found.crease_edges)
    np.testing.assert_array_equal(other.crease_angles, found.crease_angles)
    np.testing.assert_array_equal(other.corners, found.corners)
    np.testing.assert_array_equal(other.cone_points, found.cone_points)
    assert f"{len(more)} faces have the same vertices as another one, and were left out." in other.notes
    both = part.faces, np.concatenate([part.faces, more])
    one, two = (rinow.singular_features(rinow.TriangleMesh(part.vertices, F).intrinsic()).cone_angles for F in both)
    np.testing.assert_array_equal(two, one)
