"""Detail told from noise: the residuals of stars at neighbouring vertices."""

import numpy as np

import rinow
import shapes
from rinow.curvature.sectional import sectional
from rinow.curvature.unresolved import with_detail


def test_independent_noise_is_no_detail():
    V, F = shapes.noisy(shapes.irregular_torus(2000), 0.05)[:2]
    mesh = rinow.TriangleMesh(V, F)
    estimate = sectional(mesh)
    np.testing.assert_array_equal(with_detail(mesh, estimate).gaussian, estimate.gaussian)


def test_smooth_surfaces_without_noise_are_left_alone():
    V, F = shapes.irregular_torus(2000)[:2]
    mesh = rinow.TriangleMesh(V, F)
    estimate = sectional(mesh)
    assert with_detail(mesh, estimate) is estimate


def test_folds_near_the_spacing_are_detail():
    # A sphere with radial folds of some five spacings, whose mean curvature is far above that of the sphere.
    V, F = shapes.irregular_sphere(3000)[:2]
    folds = np.prod(np.sin(20.0 * V), axis=1)
    mesh = rinow.TriangleMesh(V * (1.0 + 0.03 * folds)[:, None], F)
    fit, star = sectional(mesh), rinow.surface_curvature(mesh, method="lifted")
    found = with_detail(mesh, fit)
    assert found.mean is not None and fit.mean is not None
    assert np.nanmedian(np.abs(found.mean - star.mean)) < 0.8 * np.nanmedian(np.abs(fit.mean - star.mean))
