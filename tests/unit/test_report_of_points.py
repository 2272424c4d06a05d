"""The page of a cloud of points."""

import json

import numpy as np
import pytest

import rinow
import shapes
from report_pages import Reader, decoded
from rinow.cli.main import main
from rinow.report.discs import squares
from rinow.report.page import surface_page
from rinow.report.scene import surface_scene
from rinow.study.points import study_points


@pytest.fixture(scope="module")
def cloud():
    """The study of a torus of points, with a repeated, a far and a lost one."""
    torus = shapes.irregular_torus(600).vertices
    return study_points(np.vstack([torus, torus[:1], [[60.0, 0, 0], [np.nan, 0, 0]]]), unit="mm")


def test_points_and_their_fields_come_back(cloud):
    scene = surface_scene(cloud)
    arrays, n = decoded(scene.header, scene.data), len(cloud.points)
    assert (scene.header["place"], scene.header["vertices"]) == ("point", n)
    positions = np.array(scene.header["origin"]) + scene.header["step"] * arrays["positions"]
    assert np.abs(positions - cloud.points)[:-1].max() <= (0.5 + 1e-6) * scene.header["step"]
    np.testing.assert_array_equal(arrays["faces"], np.arange(n - 1))
    # the far point is in the data and not in the frame, nor does it count in the histogram more than others
    assert np.max(scene.header["frame"]) * scene.header["step"] < 3
    assert arrays["areas"][-2] <= np.median(arrays["areas"]) and arrays["areas"][-1] == 0.0
    assert arrays["areas"][:-2].sum() == pytest.approx(4 * np.pi**2 * 0.4, rel=0.1)
    np.testing.assert_array_equal(arrays["gaussian"], cloud.curvature.gaussian.astype(np.float32))
    exact = np.cross(cloud.curvature.direction1, cloud.curvature.direction2)[:-2]
    assert np.abs(arrays["normals"][:-2] / 127 - exact).max() <= 0.5 / 127 + 1e-9
    assert "turned" not in arrays and not arrays["normals"][-1].any()


def test_the_page_of_a_cloud_speaks_of_points(cloud):
    page = surface_page(cloud, title="cloud")
    reader = Reader(page)
    text = " ".join(t for tag, _, t in reader.elements if tag in ("h2", "p", "th", "td", "label"))
    assert "Points by status" in text and "no faces" in text and "repeated points" in text
    assert "vertex" not in text.lower() and "vertices" not in text.lower()
    assert reader.by_id("edges")  # hidden by the script: its label says that it needs faces
    assert sum(a.get("data-needs") == "turned" for _, a, _ in reader.elements) == 2


def test_squares_cover_the_points_in_the_frame(cloud):
    vertices, faces, owner = squares(cloud)
    np.testing.assert_array_equal(np.unique(owner), np.arange(len(cloud.points) - 2))
    np.testing.assert_allclose(vertices.reshape(-1, 4, 3).mean(axis=1), cloud.points[:-2], atol=1e-12)
    mesh = rinow.TriangleMesh(vertices, faces)
    np.testing.assert_allclose(mesh.face_areas.reshape(-1, 2).sum(axis=1), 1.8**2 * cloud.areas[:-2], rtol=1e-9)


def test_a_cloud_without_any_value():
    study = study_points(np.vstack([np.eye(3), np.full((1, 3), np.nan)]))
    scene = surface_scene(study)
    assert decoded(scene.header, scene.data)["faces"].shape == (3,)
    Reader(surface_page(study, title="few"))
    Reader(surface_page(study_points(np.full((2, 3), np.nan)), title="nowhere"))


def test_the_command_writes_a_report_and_a_picture_of_points(tmp_path, monkeypatch, capsys, cloud):
    monkeypatch.chdir(tmp_path)
    np.savetxt("in.xyz", cloud.points)
    assert main(["curvature", "in.xyz", "--field", "mean", "--report", "a.html", "--picture", "a.png", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["outputs"] == ["a.png", "a.html"]
    header = json.loads(Reader((tmp_path / "a.html").read_text(encoding="utf-8")).by_id("scene-header")[2])
    assert (header["vertices"], header["field"]) == (len(cloud.points), "mean")
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
