"""The page as a browser shows it: scripts run, data come back, no fault is reported; skipped without Chromium."""

import math
import re
import shutil
import subprocess

import numpy as np
import pytest

import rinow
import shapes
from rinow.report.page import surface_page
from rinow.study.features import study_features
from rinow.study.points import study_points
from rinow.study.surface import study_surface

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
WEBGL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
NO_WEBGL = ["--disable-gpu", "--disable-3d-apis"]

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")


def shown(path, address="", flags=WEBGL):
    """The document after its scripts have run, and what the console said."""
    command = [
        CHROMIUM, "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--enable-logging=stderr", "--v=0",
        f"--user-data-dir={path.parent / 'profile'}", "--virtual-time-budget=20000", *flags, "--dump-dom",
        path.as_uri() + address,
    ]  # fmt: skip
    run = subprocess.run(command, capture_output=True, text=True, timeout=300, check=True)
    return run.stdout, [line for line in run.stderr.splitlines() if "CONSOLE" in line]


def readout(document):
    """The lines about one vertex: name -> value."""
    (block,) = re.findall(r'<dl id="readout".*?</dl>', document, re.DOTALL)
    lines = re.findall(r"<dt>(.*?)</dt><dd[^>]*>(.*?)</dd>", block, re.DOTALL)
    return {name: re.sub(r"<[^>]*>", "", value).replace("−", "-") for name, value in lines}


@pytest.fixture(scope="module")
def mesh_page(tmp_path_factory):
    torus = shapes.irregular_torus(300)
    mesh = rinow.TriangleMesh(torus.vertices, torus.faces)
    study = study_surface(mesh, method="sectional", quality="fast")
    path = tmp_path_factory.mktemp("mesh") / "torus.html"
    path.write_text(surface_page(study, title="torus", features=study_features(mesh)), encoding="utf-8")
    return study, path


def test_a_vertex_in_the_address_is_read_out(mesh_page):
    study, path = mesh_page
    document, faults = shown(path, "#vertex=7&field=mean&directions=1&features=1&edges=1")
    assert 'data-ready="1"' in document
    assert faults == []
    lines = readout(document)
    assert lines["vertex"] == "7 (counted from 0)"
    curvature = study.curvature
    assert float(lines["H"]) == pytest.approx(curvature.mean[7], rel=1e-3)
    second_digit = 1 - math.floor(math.log10(curvature.spread[7]))
    assert float(lines["K"]) == pytest.approx(round(curvature.gaussian[7], second_digit), abs=1e-12)
    np.testing.assert_allclose(
        [float(x) for x in lines["x, y, z"].split(" length")[0].split(", ")], study.mesh.vertices[7], atol=1e-3
    )


def test_without_webgl_the_picture_stays_and_values_are_read(mesh_page):
    _, path = mesh_page
    document, _ = shown(path, "#vertex=3", NO_WEBGL)
    assert 'data-ready="1"' in document
    assert "The picture is still: this browser has no WebGL 2." in document
    assert readout(document)["vertex"] == "3 (counted from 0)"


def test_points_without_faces(tmp_path):
    study = study_points(shapes.irregular_torus(300).vertices)
    path = tmp_path / "points.html"
    path.write_text(surface_page(study, title="points"), encoding="utf-8")
    document, faults = shown(path, "#vertex=5")
    assert 'data-ready="1"' in document
    assert faults == []
    assert float(readout(document)["K"]) == pytest.approx(study.curvature.gaussian[5], abs=study.curvature.spread[5])
