"""The page: nothing in it asks a network, names cannot break out, and the command writes it."""

import base64
import hashlib
import html
import json
import re
from datetime import UTC, datetime

import numpy as np
import pytest

import rinow
from report_pages import Reader, decoded, faulty_mesh, study_of
from rinow.cli.main import main
from rinow.report.page import SCRIPTS, surface_page
from rinow.report.scene import surface_scene
from rinow.study.features import study_features
from rinow.study.surface import STATUSES, study_surface

FETCHED = {"src", "href", "srcset", "data", "action", "formaction", "poster", "background", "ping"}
EVIL = "</script><script>alert(1)</script>\"'&<img src=x onerror=alert(2)>.ply"


@pytest.fixture(scope="module")
def page():
    mesh = faulty_mesh()
    made = datetime(2004, 1, 24, 12, 0, tzinfo=UTC)
    return surface_page(study_of(mesh, unit="mm"), study_features(mesh), title=EVIL, made=made)


def test_the_page_parses_and_names_cannot_break_out(page):
    reader = Reader(page)
    assert reader.texts("h1") == [EVIL]
    assert reader.texts("title")[0].startswith(EVIL)
    assert page.count("<script") == 2 + len(SCRIPTS)
    assert not any(name.startswith("on") for _, attributes, _ in reader.elements for name in attributes)
    labelled = {e[1]["for"] for e in reader.elements if e[0] == "label" and "for" in e[1]}
    for tag, attributes, _ in reader.elements:
        assert tag != "img" or attributes["alt"]
        assert tag != "select" or attributes["id"] in labelled


def test_a_unit_cannot_break_out():
    page = surface_page(study_of(faulty_mesh(), unit="</script><b>"), title="a")
    assert "</script><b>" not in page
    assert json.loads(Reader(page).by_id("scene-header")[2])["unit"] == "</script><b>"


def test_nothing_in_the_page_asks_a_network(page):
    reader = Reader(page)
    for tag, attributes, text in reader.elements:
        for name in FETCHED & set(attributes):
            assert attributes[name].startswith("data:"), (tag, name)
        assert tag not in {"iframe", "object", "embed", "base", "form"}
        if tag == "style":
            assert "url(" not in text
            assert "@import" not in text
    code = [text for tag, attributes, text in reader.elements if tag == "script" and "type" not in attributes]
    own = "".join(code[1:])  # the first is three.js, which fetches nothing unless asked; the policy binds it too
    assert not re.search(r"https?://|\bfetch\(|XMLHttpRequest|WebSocket|sendBeacon|\bimport\b", own)


def test_the_policy_allows_the_scripts_of_the_page_and_nothing_else(page):
    reader = Reader(page)
    policy = next(a["content"] for _, a, _ in reader.elements if a.get("http-equiv") == "Content-Security-Policy")
    rules = dict(rule.split(" ", 1) for rule in policy.split("; "))
    assert rules["default-src"] == "'none'"
    assert rules["img-src"] == "data:"

    def hashes(texts):
        return [f"'sha256-{base64.b64encode(hashlib.sha256(t.encode()).digest()).decode()}'" for t in texts]

    code = [text for tag, a, text in reader.elements if tag == "script" and "type" not in a]
    assert rules["script-src"].split() == hashes(code)
    assert rules["style-src"].split() == hashes(reader.texts("style"))


def test_units_sign_and_status_are_told(page):
    text = html.unescape(page)
    header = json.loads(Reader(page).by_id("scene-header")[2])
    assert {f["name"]: f["unit"] for f in header["fields"]}["gaussian"] == "1/mm²"
    assert header["statuses"] == STATUSES
    for words in ("Convex with outward normal is positive", "one standard error", "NONFINITE", "2πχ", "float32"):
        assert words in text
    assert "2004-01-24 12:00 UTC" in text
    assert rinow.__version__ in text


def test_colours_of_the_page_are_those_of_the_picture(page):
    from matplotlib import colormaps

    from rinow.report.figures import colour_limit

    header = json.loads(Reader(page).by_id("scene-header")[2])
    gaussian = header["fields"][0]
    limit = colour_limit(study_of(faulty_mesh()).curvature.gaussian, faulty_mesh().vertex_areas)
    assert (gaussian["low"], gaussian["high"]) == pytest.approx((-limit, limit))
    table = np.frombuffer(base64.b64decode(header["maps"][gaussian["map"]]), np.uint8).reshape(-1, 3)
    np.testing.assert_array_equal(table[[0, 128, 255]], colormaps["RdBu_r"]([0, 128, 255], bytes=True)[:, :3])
    assert {f["name"] for f in header["fields"] if f["map"] == "viridis"} == {"curvedness", "spread", "radius"}


def test_a_method_that_knows_gaussian_curvature_only():
    mesh = faulty_mesh()
    scene = surface_scene(study_surface(mesh, method="angle_defect"))
    assert {f["name"] for f in scene.header["fields"]} <= {"gaussian", "spread", "radius"}
    assert "direction1" not in [a["name"] for a in scene.header["arrays"]]


def test_a_mesh_without_any_finite_position():
    mesh = rinow.TriangleMesh(np.full((3, 3), np.nan), [[0, 1, 2]])
    study = study_surface(mesh, method="angle_defect")
    scene = surface_scene(study)
    assert decoded(scene.header, scene.data)["faces"].shape == (0, 3)
    Reader(surface_page(study, title="nowhere"))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rinow.write_mesh("in.ply", faulty_mesh())
    return tmp_path


def test_the_command_writes_a_report(folder, capsys):
    assert main(["curvature", "in.ply", "--quality", "fast", "--field", "k1", "--report", "out.html", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["outputs"] == ["out.html"]
    reader = Reader((folder / "out.html").read_text(encoding="utf-8"))
    assert reader.texts("h1") == ["in.ply"]
    header = json.loads(reader.by_id("scene-header")[2])
    assert (header["vertices"], header["field"]) == (faulty_mesh().n_vertices, "k1")
    assert "corners" in [array["name"] for array in header["arrays"]]


@pytest.mark.parametrize("report", ["out.png", "missing/out.html", "in.ply"])
def test_a_bad_report_is_refused_in_one_sentence(folder, capsys, report):
    assert main(["curvature", "in.ply", "--report", report]) == 1
    assert capsys.readouterr().err.count("\n") == 1
    assert [path.name for path in folder.iterdir()] == ["in.ply"]


def test_a_report_that_fails_leaves_the_old_one(folder, monkeypatch):
    (folder / "out.html").write_text("old")

    def full(path, page):
        path.write_text(page[:100])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("rinow.report.page.write_surface_page", full)
    assert main(["curvature", "in.ply", "--method", "angle_defect", "--report", "out.html"]) == 1
    assert (folder / "out.html").read_text() == "old"
    assert sorted(path.name for path in folder.iterdir()) == ["in.ply", "out.html"]
