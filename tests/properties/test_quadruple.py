"""Embedding curvatures: certificates with many digits, and invariances."""

import math

import mpmath as mp
import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

import rinow

EPS = 2.0**-53
curvatures = st.floats(-4.0, 4.0)


@st.composite
def point_quadruples(draw):
    """Distances of four points of some S_k, at radii up to 0.7 in different directions."""
    k = draw(curvatures)
    r = [draw(st.floats(0.05, 0.7)) for _ in range(4)]
    directions = np.cumsum([draw(st.floats(0.1, 2.0)) for _ in range(4)])
    surface = rinow.SpaceForm(k)
    return [float(surface.side(r[i], r[j], directions[j] - directions[i])) for i in range(4) for j in range(i + 1, 4)]


def embedding_determinant(d, k):
    """det cos(√k d_ij) / k³ with enough digits."""
    with mp.workdps(60 + int(6 * math.sqrt(abs(k)) * max(d))):
        k = mp.mpf(k)
        M = mp.matrix(4, 4)
        for i in range(4):
            M[i, i] = 1
        for (i, j), x in zip(((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)), d, strict=True):
            M[i, j] = M[j, i] = mp.cos(mp.sqrt(k) * mp.mpf(x)).real
        return mp.det(M) / k**3


@given(st.one_of(point_quadruples(), st.lists(st.floats(1.0, 2.0), min_size=6, max_size=6)))
def test_the_embedding_determinant_changes_its_sign_at_every_value(d):
    result = rinow.embedding_curvatures(d)
    for k, kind, condition in zip(result.values, result.kind, result.condition, strict=True):
        if kind in ("planar", "nonplanar") and abs(k) < 1e4 and condition < 1e8:
            # The value is right to a few roundings of each step, all of the size of a rounding of the distances.
            step = 24 * EPS * (condition / max(d) ** 2 + abs(k))
            below, above = embedding_determinant(d, k - step), embedding_determinant(d, k + step)
            assert (below < 0 < above) if kind == "nonplanar" else (above < 0 < below)


@given(point_quadruples(), st.floats(1e-3, 1e3))
def test_scaling_distances_scales_values_by_the_inverse_square(d, factor):
    one, other = rinow.embedding_curvatures(d), rinow.embedding_curvatures(factor * np.array(d))
    assume((one.kind[:1] != "semidependent").all() and (one.count == other.count))
    # Rounding the scaled distances moves each value by condition · eps / diameter².
    allowed = 24 * EPS * (one.condition / max(d) ** 2 + np.abs(one.values))
    assert (np.abs(other.values * factor**2 - one.values) <= allowed)[one.kind != ""].all()


@given(point_quadruples(), st.floats(0.01, 1.0))
def test_between_and_beyond_its_values_a_quadruple_does_not_embed(d, t):
    values = rinow.embedding_curvatures(d).values
    unit = 1 / max(d) ** 2
    for k in (values[0] - t * unit, (1 - t) * values[0] + t * values[1], values[1] + t * unit):
        if np.isfinite(k) and np.abs(values - k).min() > 1e-3 * unit:
            assert np.isnan(rinow.SpaceForm(k).embed(d, rtol=1e-12)).all()


@given(point_quadruples(), st.permutations(range(4)))
def test_labels_do_not_matter(d, order):
    D = np.zeros((4, 4))
    i, j = np.triu_indices(4, 1)
    D[i, j] = D[j, i] = d
    one, other = rinow.embedding_curvatures(d), rinow.embedding_curvatures(D[np.ix_(order, order)][i, j])
    assert one.count == other.count
    assert (one.kind == other.kind).all()
    allowed = 24 * EPS * (one.condition / max(d) ** 2 + np.abs(one.values))
    assert (np.abs(other.values - one.values) <= allowed)[one.kind != ""].all()
