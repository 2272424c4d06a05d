"""The page: what is in it can be read back, nothing in it asks a network, and names cannot break out."""

import base64
import gzip
import hashlib
import html
import json
import re
from datetime import UTC, datetime
from html.parser import HTMLParser

import numpy as np
import pytest

import rinow
import shapes
from rinow.cli.main import main
from rinow.report.discs import squares
from rinow.report.page import SCRIPTS, surface_page
from rinow.report.scene import BITS_OF_LARGE, POSITION_STEPS, compact, surface_scene
from rinow.study.features import study_features
from rinow.study.points import study_points
from rinow.study.surface import STATUSES, study_surface

VOID = {"meta", "link", "img", "input", "br"}
FETCHED = {"src", "href", "srcset", "data", "action", "formaction", "poster", "background", "ping"}
EVIL = "</script><script>alert(1)</script>\"'&<img src=x onerror=alert(2)>.ply"


class Reader(HTMLParser):
    """Elements with their attributes and the text in them; complains about tags that do not match."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.elements = [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.elements.append([tag, dict(attrs), ""])
        if tag not in VOID:
            self.open.append(self.elements[-1])

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag

    def handle_data(self, data):
        if self.open:
            self.open[-1][2] += data

    def texts(self, tag):
        return [text for name, _, text in self.elements if name == tag]

    def by_id(self, name):
        return next(e for e in self.elements if e[1].get("id") == name)


def faulty_mesh():
    """A torus with an unused vertex, a vertex without position, and a face at it."""
    torus = shapes.irregular_torus(300)
    vertices = np.vstack([torus.vertices, [[np.nan, 0, 0], [9.0, 9, 9]]])
    n = len(torus.vertices)
    return rinow.TriangleMesh(vertices, np.vstack([torus.faces, [[0, 1, n]]]))


def study_of(mesh, **options):
    return study_surface(mesh, method="sectional", quality="fast", **options)


def decoded(header, data):
    """The arrays of a scene by another way than the page's: from the description in `report/scene.py`."""
    raw, arrays, start = gzip.decompress(base64.b64decode(data)), {}, 0
    for entry in header["arrays"]:
        dtype = np.dtype(entry["type"])
        count = entry["rows"] * entry["columns"]
        planes = [raw[start + b * count : start + (b + 1) * count] for b in range(dtype.itemsize)]
        numbers = bytes(byte for number in zip(*planes, strict=True) for byte in number)
        values = np.frombuffer(numbers, dtype.newbyteorder("<")).reshape(entry["rows"], entry["columns"])
        if entry["differences"]:
            steps = np.array([[z // 2 if z % 2 == 0 else -(z + 1) // 2 for z in row] for row in values.tolist()])
            values = np.cumsum(steps.reshape(values.shape), axis=0) % 2**32
        arrays[entry["name"]] = values.reshape(-1) if entry["columns"] == 1 else values
        start += count * dtype.itemsize
    assert start == len(raw)
    return arrays


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


@pytest.mark.parametrize("scale", [1e-100, 1e100])
def test_any_unit_of_length(scale):
    mesh = faulty_mesh()
    study = study_of(rinow.TriangleMesh(scale * mesh.vertices, mesh.faces))
    scene = surface_scene(study)
    gaussian = decoded(scene.header, scene.data)["gaussian"]
    np.testing.assert_array_equal(gaussian, study.curvature.gaussian)
    Reader(surface_page(study, title="far"))


def test_a_mesh_without_any_finite_position():
    mesh = rinow.TriangleMesh(np.full((3, 3), np.nan), [[0, 1, 2]])
    study = study_surface(mesh, method="angle_defect")
    scene = surface_scene(study)
    assert decoded(scene.header, scene.data)["faces"].shape == (0, 3)
    Reader(surface_page(study, title="nowhere"))


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
