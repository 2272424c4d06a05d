"""Meshes and points in units in which squares of lengths vanish or overflow: powers of two change no digit."""

import re

import numpy as np
import pytest

import rinow
import shapes
from rinow import TriangleMesh, VertexStatus, surface_curvature
from rinow.errors import InvalidInputError
from shapes import icosphere

SPHERE, FACES = icosphere(1).vertices * [1.0, 1.0, 0.8], icosphere(1).faces
OTHER = SPHERE * [1.1, 1.0, 1.0]
EXPONENTS = [-980, -500, -200, 200, 500, 980]


def spaces(unit):
    return [rinow.MetricSpace.from_points(V[:8] * unit) for V in (SPHERE, OTHER)]


LENGTHS = {
    "edges": lambda u: rinow.TriangleMesh(SPHERE * u, FACES).edge_lengths,
    "diagonal": lambda u: rinow.TriangleMesh(SPHERE * u, FACES).diagonal,
    "points": lambda u: rinow.MetricSpace.from_points(SPHERE * u).distances,
    "geodesics": lambda u: rinow.geodesic_distances((SPHERE * u, FACES), [0, 5]),
    "net": lambda u: rinow.farthest_point_net((SPHERE * u, FACES), size=7).surface_radius,
    "Hausdorff": lambda u: rinow.hausdorff_distance((SPHERE * u, FACES), (OTHER * u, FACES)).upper,
    "Hausdorff of points": lambda u: rinow.hausdorff_distance(SPHERE * u, OTHER * u).upper,
    "Gromov-Hausdorff": lambda u: rinow.gromov_hausdorff(*spaces(u)).upper,
    "Gromov-Hausdorff of meshes": lambda u: (
        rinow.gromov_hausdorff((SPHERE * u, FACES), (OTHER * u, FACES), time_limit=0).upper
    ),
}
NUMBERS = {
    "defects": lambda u: rinow.TriangleMesh(SPHERE * u, FACES).vertex_angle_defects,
    "normals": lambda u: rinow.TriangleMesh(SPHERE * u, FACES[:, ::-1]).vertex_normals,
    "degenerate faces": lambda u: rinow.TriangleMesh(SPHERE * u, FACES).face_is_degenerate,
    "Lipschitz": lambda u: rinow.lipschitz_distance(*spaces(u)).upper,
}


@pytest.mark.parametrize("name", LENGTHS)
def test_lengths_have_the_same_digits_in_all_units(name):
    expected = LENGTHS[name](1.0)
    for exponent in EXPONENTS:
        actual = np.ldexp(LENGTHS[name](2.0**exponent), -exponent)
        np.testing.assert_allclose(actual, expected, rtol=1e-12)  # a shift of the frame is rounded


@pytest.mark.parametrize("name", NUMBERS)
def test_numbers_do_not_depend_on_the_unit(name):
    expected = NUMBERS[name](1.0)
    for exponent in EXPONENTS:
        np.testing.assert_allclose(NUMBERS[name](2.0**exponent), expected, rtol=1e-12)


@pytest.mark.parametrize("exponent", [-480, -200, 200, 480])
def test_curvature_is_right_as_long_as_it_is_a_number(exponent):
    expected = rinow.surface_curvature((SPHERE, FACES))
    actual = rinow.surface_curvature((SPHERE * 2.0**exponent, FACES))
    np.testing.assert_allclose(actual.gaussian, np.ldexp(expected.gaussian, -2 * exponent), rtol=1e-9)
    assert (actual.status == expected.status).all()


REFUSALS = [
    (lambda: rinow.surface_curvature((SPHERE * 1e-160, FACES)), "mesh has edges of length 6.18e-161, and"),
    (lambda: rinow.surface_curvature((SPHERE * 1e160, FACES)), "mesh has edges of length"),
    (lambda: rinow.point_cloud_curvature(SPHERE * 1e-160), "points extend over 2e-160, and their curvature"),
    (lambda: rinow.MetricSpace.from_points(SPHERE * 1.5e308), "points reach 1.5e+308, and their distances no number"),
    (lambda: rinow.hausdorff_distance(SPHERE * 1.5e308, SPHERE), "points lie 1.5e+308 from their middle"),
    (
        lambda: rinow.gromov_hausdorff((SPHERE * 1e308, FACES), (SPHERE, FACES)),
        "X: mesh has distances of inf, and some are no number; scale it.",
    ),
]


@pytest.mark.parametrize(("action", "message"), REFUSALS)
def test_what_is_no_number_is_refused(action, message):
    with pytest.raises(InvalidInputError, match=f"^{re.escape(message)}"):
        action()


@pytest.mark.parametrize("quality", ["best", "fast"])
def test_single_precision_far_from_the_origin_makes_no_facets(quality):
    shape = shapes.irregular_ellipsoid(2000)
    step = TriangleMesh(shape.vertices, shape.faces).mean_edge_length
    far = (shape.vertices + 8e6 * step).astype(np.float32)  # steps of half to a whole edge
    c = surface_curvature((far, shape.faces), quality=quality)
    ok = c.status == VertexStatus.OK
    error = np.abs(c.gaussian - shape.gaussian)[ok]
    assert (c.gaussian[ok] == 0.0).sum() == 0
    assert np.mean(error > np.maximum(4 * c.spread[ok], 0.1 * np.sqrt(np.mean(shape.gaussian**2)))) < 0.01
    assert any(note.startswith("The coordinates are rounded by up to") for note in c.notes)
    near = surface_curvature((shape.vertices.astype(np.float32), shape.faces), quality=quality)
    assert near.notes == ()
