"""Curvatures of quadruples, curves, spaces and graphs in units in which squares of lengths are no numbers."""

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.spatial.distance import cdist

import rinow
from metric_shapes import sampled
from rinow import SpaceForm
from rinow.errors import InvalidInputError

T = np.linspace(0, 2, 30)
HELIX = np.stack([np.cos(T), np.sin(T), T / 3], axis=1)
LENGTHS = cdist(HELIX, HELIX)
CLOUD = np.random.default_rng(73).random((30, 3))
CAP = sampled(1.0, 30, 71, radius=0.6)
EDGES = np.where(CAP < 0.5, CAP, 0.0)
ROBINSON = [1.0, 2.0, 1.5, 1.0, 0.9, 1.2]
RADII, CHORDS = np.array([1.0, 1.0, 1.2, 1.0]), np.array([1.0, 1.1, 1.2, 1.0])


def bounds(result):
    return [result.lower, result.upper]


QUANTITIES = {  # a function of the unit, and the power of the unit in it
    "menger of triples": (lambda c: rinow.menger_curvature(LENGTHS * c, [[0, 9, 20], [3, 4, 5]]), -1),
    "menger": (lambda c: rinow.curve_curvature(HELIX * c), -1),
    "haantjes": (lambda c: rinow.curve_curvature(HELIX * c, kind="haantjes"), -1),
    "alt": (lambda c: rinow.curve_curvature(HELIX * c, kind="alt"), -1),
    "menger of distances": (lambda c: rinow.curve_curvature(LENGTHS * c), -1),
    "haantjes of distances": (lambda c: rinow.curve_curvature(LENGTHS * c, kind="haantjes"), -1),
    "alt of distances": (lambda c: rinow.alt_curvature(LENGTHS * c, [0, 7]), -1),
    "robinson": (lambda c: rinow.robinson_curvature(np.multiply(ROBINSON, c)).value, -2),
    "robinson's interval": (lambda c: bounds(rinow.robinson_curvature(np.multiply(ROBINSON, c), verify=True)), -2),
    "robinson, third order": (lambda c: rinow.robinson_curvature(np.multiply(ROBINSON, c), order=3).value, -2),
    "star": (lambda c: rinow.star_curvature(RADII * c, CHORDS * c), -2),
    "rinow": (lambda c: bounds(rinow.rinow_curvature(CAP * c)), -2),
    "rinow of points": (lambda c: bounds(rinow.rinow_curvature(CLOUD * c)), -2),
    "regular radius": (lambda c: rinow.regular_radius(CAP * c, 0), 1),
    "fine enough": (lambda c: rinow.epsilon_graph(CAP * c, 0.5 * c).is_fine_enough, 0),
    "wald at nodes": (lambda c: rinow.graph_curvature(csr_array(EDGES * c)).nodes, -2),
    "menger of edges": (lambda c: rinow.graph_curvature(csr_array(EDGES * c), kind="menger").edges, -1),
    "haantjes of edges": (lambda c: rinow.graph_curvature(csr_array(EDGES * c), kind="haantjes").edges, -1),
}


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("exponent", [-700, -490, -300, 300, 490, 700])
def test_units_that_are_powers_of_two_change_no_digit(quantity, exponent):
    of_unit, power = QUANTITIES[quantity]
    with np.errstate(over="ignore"):
        expected = np.ldexp(np.asarray(of_unit(1.0), float), power * exponent)
    np.testing.assert_array_equal(np.asarray(of_unit(2.0**exponent), float), expected)


def test_arcs_beyond_all_numbers_are_infinite():
    assert rinow.arc_length(1e200, 1.0) == np.inf


@pytest.mark.parametrize("unit", [1e-200, 1e200])
def test_angles_need_a_curvature_that_is_a_number(unit):
    with pytest.raises(InvalidInputError, match="their curvature is no number; scale them"):
        rinow.angle_at(CAP * unit, 0, 1, 2)
    flat = rinow.angle_at(CAP, 0, 1, 2, curvature=0.0)
    assert abs(rinow.angle_at(CAP * unit, 0, 1, 2, curvature=0.0) - flat) < 1e-12


def test_rinow_curvature_at_a_point_of_wide_spaces():
    """The square of the radius is no number, nor is the curvature."""
    result = rinow.rinow_point_curvature(CAP * 2.0**700, 0, radius=0.8 * 2.0**700)
    assert result.value == 0.0


def test_a_matrix_may_be_a_tuple_of_rows():
    rows = tuple(map(tuple, CAP))
    for function in (rinow.angle_at, rinow.polar_coordinates):
        np.testing.assert_array_equal(function(rows, 0, 1, 2), function(CAP, 0, 1, 2))
    assert rinow.regular_radius(rows, 0) == rinow.regular_radius(CAP, 0)
    assert bounds(rinow.rinow_curvature(rows)) == bounds(rinow.rinow_curvature(CAP))


def test_robinson_interval_of_short_lengths_holds_the_curvature():
    quadruple = np.multiply(ROBINSON, 1e-90)
    true = rinow.embedding_curvatures(quadruple).values[0]
    result = rinow.robinson_curvature(quadruple)
    assert result.lower <= true <= result.upper


def test_curvature_of_a_sphere_in_tiny_units():
    sphere = SpaceForm(1.0)
    points = sphere.sample(20, 0.5, np.random.default_rng(72))
    D = sphere.distance(points[:, None], points) * 1e-130
    result = rinow.rinow_curvature((D + D.T) / 2)
    assert abs(result.lower / 1e260 - 1.0) < 1e-9
