"""surface_curvature as an interface: methods, qualities, faults of options, progress, and the result."""

import pickle
from types import SimpleNamespace

import numpy as np
import pytest

import shapes
from rinow import IntrinsicMesh, InvalidInputError, InvalidMeshError, TriangleMesh, surface_curvature
from surface_methods import METHODS, SPHERE, WITH_POSITIONS, curvature


def test_auto_takes_the_best_method_the_data_allow():
    mesh = TriangleMesh(SPHERE.vertices, SPHERE.faces)
    assert surface_curvature(mesh).method == "auto"
    assert surface_curvature(mesh, quality="fast").method == "auto"
    assert surface_curvature(mesh.intrinsic()).method == "intrinsic"
    assert surface_curvature(mesh.intrinsic(), quality="fast").method == "intrinsic"


def test_meshes_of_other_libraries():
    other = SimpleNamespace(vertices=SPHERE.vertices, faces=SPHERE.faces)
    np.testing.assert_array_equal(surface_curvature(other).gaussian, curvature(SPHERE).gaussian)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": "gauss"}, "method = 'gauss' is unknown; choose from auto, sectional"),
        ({"quality": "good"}, "quality = 'good' is unknown; choose from best, fast"),
        ({"method": "sectional", "radius": 0.0}, "radius = 0.0 is not a positive length"),
        ({"method": "sectional", "radius": float("nan")}, "radius = nan is not a positive length"),
        ({"method": "sectional", "radius": [1.0, 2.0]}, "is not a positive length"),
        ({"method": "sectional", "radius": "big"}, "radius has type"),
        ({"method": "lifted", "radius": 1.0}, "radius = 1.0 is not for method 'lifted'"),
    ],
)
def test_faults_of_options_are_named(options, message):
    with pytest.raises(InvalidInputError, match=message):
        curvature(SPHERE, **options)


@pytest.mark.parametrize("method", ["lifted", "intrinsic", "wald", "robinson", "angle_defect"])
def test_quality_changes_nothing_with_methods_that_have_one(method):
    best, fast = (curvature(SPHERE, method=method, quality=quality) for quality in ("best", "fast"))
    np.testing.assert_array_equal(fast.gaussian, best.gaussian)
    assert fast.notes == (*best.notes, f"quality 'fast' changes nothing: method {method!r} has only one.")


@pytest.mark.parametrize("method", WITH_POSITIONS)
def test_methods_that_need_positions_say_so(method):
    mesh = TriangleMesh(SPHERE.vertices, SPHERE.faces).intrinsic()
    assert isinstance(mesh, IntrinsicMesh)
    with pytest.raises(InvalidMeshError, match="positions are needed"):
        surface_curvature(mesh, method=method)


def test_progress_ends_with_all_vertices():
    for method in METHODS:
        calls = []
        curvature(SPHERE, method=method, progress=lambda *x, calls=calls: calls.append(x))
        assert calls[-1] == (1000, 1000)


def test_result_is_frozen_pickles_and_shows_itself():
    c = curvature(shapes.open_patch(100))
    with pytest.raises(AttributeError):
        c.gaussian = c.mean
    copy = pickle.loads(pickle.dumps(c))
    np.testing.assert_array_equal(copy.gaussian, c.gaussian)
    html = c._repr_html_()
    assert "<caption>Curvature by auto: 64 OK, 36 BOUNDARY</caption>" in html
    assert f"{np.median(c.gaussian):.4g}" in html
