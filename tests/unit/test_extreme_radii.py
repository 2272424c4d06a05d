"""Radii of nothing and of everything: numbers or a status, and no error of arithmetic (warnings are errors here)."""

import numpy as np
import pytest

import shapes
from rinow import VertexStatus, geodesic_space, surface_curvature, wald_curvature

SPHERE = shapes.icosphere(2)[:2]


@pytest.mark.parametrize("radius", [1e-300, 1e-160, 1e160, 1e300])
@pytest.mark.parametrize("method", ["auto", "sectional", "intrinsic", "wald", "robinson"])
def test_surfaces(method, radius):
    c = surface_curvature(SPHERE, method=method, radius=radius)
    is_ok = c.status == VertexStatus.OK
    assert np.all(is_ok | (c.status == VertexStatus.UNRESOLVED))
    assert np.abs(c.gaussian[is_ok] - 1).max(initial=0.0) < 0.2
    assert np.isnan(c.gaussian[~is_ok]).all()


def test_a_ball_larger_than_the_space_is_the_space():
    space = geodesic_space(SPHERE)
    whole, larger = (wald_curvature(space, 0, radius=radius) for radius in (5.0, 1e300))
    assert larger.value == whole.value
    assert not larger.exists
