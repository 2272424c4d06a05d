"""The scene of a page: what is in it can be read back."""

import numpy as np
import pytest

import rinow
import shapes
from report_pages import Reader, decoded, faulty_mesh, study_of
from rinow.report.page import surface_page
from rinow.report.scene import BITS_OF_LARGE, POSITION_STEPS, compact, surface_scene
from rinow.study.features import study_features
from rinow.study.surface import study_surface


def test_mesh_and_fields_come_back():
    mesh = faulty_mesh()
    study, features = study_of(mesh), study_features(mesh)
    scene = surface_scene(study, features)
    arrays = decoded(scene.header, scene.data)
    finite = mesh.vertex_is_finite
    step, extent = scene.header["step"], np.ptp(mesh.vertices[mesh.topology.vertex_is_used], axis=0).max()
    assert step == pytest.approx(extent / POSITION_STEPS)
    positions = np.array(scene.header["origin"]) + step * arrays["positions"]
    # half a step, and the rounding of the sum
    assert np.abs(positions - mesh.vertices)[finite].max() <= (0.5 + 1e-6) * step
    np.testing.assert_array_equal(arrays["faces"], mesh.faces[:-1])
    assert scene.header["hidden_faces"] == 1
    np.testing.assert_array_equal(arrays["status"], study.curvature.status)
    assert {"NONFINITE", "ISOLATED", "OK"} <= set(study.status_counts())
    for field in scene.header["fields"]:
        exact = getattr(study.curvature, field["name"])
        np.testing.assert_array_equal(arrays[field["name"]], exact.astype(np.float32))
        assert np.isnan(exact[-2:]).all()
    at = arrays["direction_vertices"]
    assert np.abs(arrays["direction1"] / 127 - study.curvature.direction1[at]).max() <= 0.5 / 127 + 1e-12
    np.testing.assert_array_equal(arrays["crease_edges"].reshape(-1, 2), features.features.crease_edges)


def test_a_far_vertex_without_a_face_neither_blurs_the_surface_nor_is_lost():
    mesh = faulty_mesh()
    vertices = mesh.vertices.copy()
    vertices[-1] = [1e9, 0, 0]
    study = study_surface(rinow.TriangleMesh(vertices, mesh.faces), method="angle_defect")
    scene = surface_scene(study)
    positions = decoded(scene.header, scene.data)["positions"]
    assert scene.header["step"] == pytest.approx(1e9 / 2**32, rel=1e-6)  # as far as 32 bits reach
    assert positions[-1, 0] * scene.header["step"] == pytest.approx(1e9, rel=1e-6)


def test_directions_of_large_meshes_are_spread_over_all_of_the_surface(monkeypatch):
    monkeypatch.setattr("rinow.report.scene.MOST_DIRECTIONS", 200)
    torus = shapes.irregular_torus(3000)
    scene = surface_scene(study_of(rinow.TriangleMesh(torus.vertices, torus.faces)))
    at = decoded(scene.header, scene.data)["direction_vertices"].astype(int)
    assert 60 <= len(at) <= 200
    gaps = np.linalg.norm(torus.vertices[:, None] - torus.vertices[at], axis=2).min(axis=1)
    # the diagonal of a cell, whose area is at most some four times that of the surface / 60
    assert gaps.max() < 0.2 * np.ptp(torus.vertices, axis=0).max()


def test_fields_keep_their_range_and_large_ones_their_first_digits(monkeypatch):
    values = np.array([1.0, -1e300, np.nan])
    assert compact(values) is values
    assert compact(np.array([1e-60, -1e-61])).dtype == np.float64
    assert compact(np.array([0.0, np.inf, 1.0])).dtype == np.float32
    monkeypatch.setattr("rinow.report.scene.LARGE", 2)
    x = np.append(np.random.default_rng(7).normal(size=500), [np.nan, np.inf, -np.inf, 0.0])
    short = compact(x)
    np.testing.assert_array_equal(np.isnan(short), np.isnan(x))
    np.testing.assert_array_equal(short[-3:], x[-3:])
    assert np.abs(short[:500] / x[:500] - 1.0).max() <= 2.0**-BITS_OF_LARGE * (1 + 1e-6)


@pytest.mark.parametrize("scale", [1e-100, 1e100])
def test_any_unit_of_length(scale):
    mesh = faulty_mesh()
    study = study_of(rinow.TriangleMesh(scale * mesh.vertices, mesh.faces))
    scene = surface_scene(study)
    gaussian = decoded(scene.header, scene.data)["gaussian"]
    np.testing.assert_array_equal(gaussian, study.curvature.gaussian)
    Reader(surface_page(study, title="far"))
