"""Orders of Robinson's approximations as a quadruple of S_k shrinks to a point."""

import math

import numpy as np
import pytest

import rinow


@pytest.mark.parametrize("k", [-1.0, 1.0])
@pytest.mark.parametrize(("order", "rate"), [(1, 2), (2, 4), (3, 6)])
def test_errors_fall_with_the_diameter(k, order, rate):
    surface = rinow.SpaceForm(k)
    errors = []
    for h in 0.5 ** np.arange(4):
        a, c, b, alpha = 0.5 * h, 0.4 * h, 0.6 * h, 1.0
        e, f = surface.side(a, b, alpha), surface.side(c, b, math.pi - alpha)
        errors.append(abs(rinow.robinson_curvature([a, a + c, e, c, b, f], order=order).value - k))
    # The next order is two higher, so the last halving is within 1 % of its rate; rounding is below 1e-3 of the error.
    assert math.log2(errors[-2] / errors[-1]) == pytest.approx(rate, abs=0.1)
    assert errors[-1] < errors[0]
