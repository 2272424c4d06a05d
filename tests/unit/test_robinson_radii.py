"""Default radii of `robinson`: four spacings on even meshes, less where balls would hold too many vertices."""

import numpy as np
import pytest

import rinow
import shapes
from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.geodesic_stars import SPACINGS, _default_radii
from rinow.geodesics.exact import ExactGeodesics


def tube(n_around, n_rings, height):
    """A cylinder of radius 1 with very high facets."""
    angle = 2 * np.pi * np.arange(n_around) / n_around
    z = np.linspace(0, height, n_rings)
    vertices = np.stack(
        [np.tile(np.cos(angle), n_rings), np.tile(np.sin(angle), n_rings), np.repeat(z, n_around)], axis=1
    )
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n_rings - 1), np.arange(n_around), indexing="ij"))
    a, b = i * n_around + j, i * n_around + (j + 1) % n_around
    faces = np.concatenate([np.stack([a, b, b + n_around], axis=1), np.stack([a, b + n_around, a + n_around], axis=1)])
    return rinow.TriangleMesh(vertices, faces)


@pytest.mark.parametrize("shape", [shapes.irregular_torus(1500), shapes.irregular_sphere(800), shapes.open_patch(900)])
def test_even_meshes_keep_four_spacings(shape):
    flow = CurvatureFlow(rinow.TriangleMesh(shape.vertices, shape.faces))
    np.testing.assert_allclose(_default_radii(flow), SPACINGS * flow.spacing, rtol=1e-12)


def test_balls_of_uneven_meshes_hold_few_vertices():
    mesh = tube(300, 12, 8.0)
    flow, geodesics, every = CurvatureFlow(mesh), ExactGeodesics(mesh), np.arange(0, mesh.n_vertices, 37)
    few, many = (
        np.diff(geodesics.polar(every, max_distance=radii[every]).offsets).max()
        for radii in (_default_radii(flow), SPACINGS * flow.spacing)
    )
    assert few < 300 < 500 < many  # measured 247 and 543
