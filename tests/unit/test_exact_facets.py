"""Where large flat facets end: perforated plates, and voxels, whose treads are flat too."""

import numpy as np
import pytest

import rinow
from plates import perforated_plate
from rinow.curvature import exact_facets
from rinow.curvature.creases import EdgeTurnings
from rinow.curvature.exact_facets import ends_of_facets
from voxels import squares


def ball_of_voxels(radius):
    """The boundary of all unit cubes of a lattice with centres within a radius."""
    lattice = np.arange(-radius - 1, radius + 2)
    return squares(np.sum(np.stack(np.meshgrid(lattice, lattice, lattice)) ** 2, axis=0) <= radius**2)


def marked(vertices, faces):
    mesh = rinow.TriangleMesh(vertices, faces)
    turnings = EdgeTurnings(mesh)
    return mesh.topology.edges[ends_of_facets(mesh, turnings.turnings, turnings.gains, turnings.halfedges)]


@pytest.mark.parametrize(("sides", "radius"), [(3, 0.3), (4, 0.45), (5, 0.48), (8, 0.45)])
def test_rims_of_coarse_holes_are_creases(sides, radius):
    # Edges turn by 90° at rims and back in the holes: by the stars of their vertices alone the plate is all noise.
    vertices, faces, rims = perforated_plate(8, sides, radius)
    found = rinow.singular_features((vertices, faces)).crease_edges
    found = {tuple(edge) for edge in found.tolist()}
    assert {tuple(sorted(edge)) for edge in rims.tolist()} <= found


@pytest.mark.parametrize("noise", [0.01, 0.03])
def test_no_facet_is_flat_by_chance(noise):
    vertices, faces, _ = perforated_plate(6, 5)
    assert len(marked(vertices, faces)) > 300
    assert len(marked(vertices + np.random.default_rng(2).normal(0, noise, vertices.shape), faces)) == 0


@pytest.mark.parametrize("radius", [5, 12])
def test_treads_of_steps_end_no_facet(radius):
    assert len(marked(*ball_of_voxels(radius))) == 0


@pytest.mark.parametrize("quality", ["best", "fast"])
def test_perforated_plates_have_no_curvature(quality):
    vertices, faces, _ = perforated_plate(8, 6, 0.45)
    result = rinow.surface_curvature((vertices, faces), quality=quality)
    assert np.nanmax(np.abs(result.gaussian)) < 1e-6


def test_ends_do_not_depend_on_how_many_are_looked_at_together(monkeypatch):
    shapes = perforated_plate(6, 5)[:2], ball_of_voxels(5)
    expected = [marked(*shape) for shape in shapes]
    monkeypatch.setattr(exact_facets, "AT_ONCE", 7)
    for shape, edges in zip(shapes, expected, strict=True):
        np.testing.assert_array_equal(marked(*shape), edges)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_vertex_that_is_not_finite_ends_no_facet(value):
    vertices, faces, _ = perforated_plate(5, 5)
    damaged = vertices.copy()
    damaged[7] = value
    found, clean = ({tuple(edge) for edge in marked(v, faces).tolist()} for v in (damaged, vertices))
    assert {edge for edge in clean - found if 7 not in edge} == {edge for edge in clean if lost(edge, faces)}
    assert found < clean


def lost(edge, faces):
    """Whether a face of an edge, which does not end at vertex 7, has that vertex, so that it is none."""
    return 7 not in edge and any(7 in face and set(edge) <= set(face) for face in faces.tolist())
