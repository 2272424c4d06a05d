"""Totals of surfaces against Gauss and Bonnet."""

import numpy as np
import pytest

import rinow
import shapes
from rinow.study.totals import surface_totals


def mesh_of(shape):
    return rinow.TriangleMesh(shape.vertices, shape.faces)


@pytest.mark.parametrize("name", shapes.closed_shapes())
def test_defects_and_turning_add_up_to_the_euler_characteristic(name):
    mesh = mesh_of(shapes.closed_shapes()[name])
    totals = surface_totals(mesh, np.zeros(mesh.n_vertices))
    # rounding of a sum of n angles
    assert totals.inner_defects + totals.boundary_turning == pytest.approx(
        2 * np.pi * totals.euler_characteristic, abs=1e-12 * mesh.n_vertices + 1e-9
    )
    assert totals.boundary_curves == 0
    assert totals.boundary_turning == 0.0


def test_the_integral_of_a_sphere_is_its_area_over_the_radius_squared():
    mesh = mesh_of(shapes.icosphere(3, radius=2.0))
    gaussian = np.full(mesh.n_vertices, 0.25)
    gaussian[0] = np.nan
    totals = surface_totals(mesh, gaussian)
    assert totals.gaussian_integral == pytest.approx(totals.area_with_value / 4)
    assert totals.area - totals.area_with_value == pytest.approx(mesh.vertex_areas[0])
    assert totals.area == pytest.approx(16 * np.pi, rel=0.01)  # inscribed: one percent smaller at this size


@pytest.mark.parametrize(
    ("shape", "curves", "components"),
    [(shapes.open_patch(200), 1, 1), (shapes.moebius_strip(), 1, 1), (shapes.two_components(60), 0, 2)],
)
def test_curves_of_the_boundary_are_counted(shape, curves, components):
    mesh = mesh_of(shape)
    totals = surface_totals(mesh, np.zeros(mesh.n_vertices))
    assert (totals.boundary_curves, totals.components) == (curves, components)
    assert totals.inner_defects + totals.boundary_turning == pytest.approx(2 * np.pi * totals.euler_characteristic)


def test_separate_triangles_are_welded():
    joined, apart = mesh_of(shapes.icosphere(2)), mesh_of(shapes.soup(shapes.icosphere(2)))
    expected = surface_totals(joined, np.ones(joined.n_vertices))
    actual = surface_totals(apart, np.ones(apart.n_vertices))
    assert actual.euler_characteristic == 2
    assert actual.boundary_edges == 0
    assert actual.gaussian_integral == pytest.approx(expected.gaussian_integral)
