"""Triangulations converge to their surface in every distance of Section 2, at the orders that theory gives."""

import numpy as np
import pytest

import rinow
from rinow.comparison.surface_points import insert_points
from rinow.errors import InvalidInputError, InvalidMeshError
from rinow.mesh import TriangleMesh
from rinow.report.convergence import convergence_figure
from rinow.study.convergence import COLUMNS, study_meshes, study_nets
from shapes import box, icosphere, irregular_sphere, two_components

pytestmark = pytest.mark.usefixtures("compiled_searches")


@pytest.fixture(scope="module")
def spheres():
    meshes = [icosphere(k) for k in range(3)]
    limit = icosphere(4)
    return study_meshes(
        [(m.vertices, m.faces) for m in meshes], (limit.vertices, limit.faces), net_size=6, max_points=200, time_limit=4
    )


def test_intervals_are_intervals(spheres):
    for name in COLUMNS:
        lower, upper = getattr(spheres, name).T
        assert (lower >= 0).all()
        assert (lower <= upper).all()
        assert np.isfinite(upper).all()


def test_spheres_converge_in_every_distance(spheres):
    """Inscribed polyhedra with edges h are O(h²) from the sphere, in position and in length."""
    orders = spheres.orders()
    assert orders["hausdorff"] == pytest.approx(2, abs=0.2)
    # the geodesics of the icosahedron itself are not yet in the asymptotic range
    assert orders["net_gromov_hausdorff"] > 1.3
    assert orders["net_lipschitz"] > 1.3
    assert orders["gromov_hausdorff"] > 0.7  # max(r, s), the larger radius of the nets, is O(h)
    for name in COLUMNS:
        assert (np.diff(getattr(spheres, name)[:, 1]) < 0).all()


def test_the_hausdorff_distance_is_that_of_the_sagitta(spheres):
    """The face centres of the icosahedron are at the inradius; the limit mesh is within 0.002 of the sphere."""
    inradius = (3 + 5**0.5) / (12**0.5) / (10 + 2 * 5**0.5) ** 0.5 * 2
    assert spheres.hausdorff[0, 0] <= 1 - inradius
    assert spheres.hausdorff[0, 1] >= 1 - inradius - 0.002


def test_studies_have_a_table_and_a_plot(spheres):
    rows = spheres.table()
    assert [row["n_points"] for row in rows] == [12, 42, 162]
    assert rows[0]["hausdorff_upper"] == spheres.hausdorff[0, 1]
    assert spheres._repr_html_().count("<tr>") == 4
    intervals = {text: getattr(spheres, name) for name, text in COLUMNS.items()}
    figure = convergence_figure(spheres.scale, intervals, label="longest edge")
    assert len(figure.axes[0].get_legend().get_texts()) == 4


def test_a_mesh_is_at_distance_0_from_itself():
    shape = irregular_sphere(60)
    mesh = shape.vertices, shape.faces
    study = study_meshes([mesh], mesh, net_size=5, time_limit=4)
    assert study.hausdorff[0, 1] == 0.0
    assert study.net_gromov_hausdorff[0, 1] == study.net_lipschitz[0, 1] == 0.0
    # all vertices are in the net: only the insides of the faces remain
    assert study.gromov_hausdorff[0, 1] <= 2 * study.scale[0] / 3**0.5 + 1e-12


def sheet(n, side):
    """A flat square of n by n squares."""
    i, j = np.indices((n + 1, n + 1)).reshape(2, -1)
    a = np.flatnonzero((i < n) & (j < n))
    faces = np.concatenate([np.stack([a, a + n + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + 1], 1)])
    return (np.stack([i, j, 0 * i], axis=1) / n - [0.5, 0.5, 0.0]) * side, faces


def test_a_sheet_is_at_half_the_difference_of_the_diameters_from_a_larger_one():
    """x and 1.3 x differ in distance by 0.3 diam at most, and no correspondence does better than the diameters."""
    study = study_meshes([sheet(8, 2.0)], sheet(32, 2.6), net_size=5, time_limit=1)
    lower, upper = study.gromov_hausdorff[0]
    truth = 0.15 * 8**0.5
    assert lower <= truth <= upper
    # Corners of the larger sheet are just as far from those of the smaller one.  Covering radii are bounds, off by less
    # than the longest edge there.  The radius of the smaller sheet, 0.2, would be beyond that.
    assert upper <= truth + 2.6 / 32 * 2**0.5


def test_nets_converge_to_their_space():
    rng = np.random.default_rng(23)
    space = rinow.MetricSpace.from_points(rng.uniform(size=(30, 2)))
    study = study_nets(space, [2, 5, 12, 30], time_limit=1)
    assert (study.hausdorff[:, 0] == study.hausdorff[:, 1]).all()
    assert (study.gromov_hausdorff[:, 1] <= study.hausdorff[:, 1]).all()
    assert study.gromov_hausdorff[-1, 1] == study.net_lipschitz[-1, 1] == 0.0
    assert np.isinf(study.net_lipschitz[:-1]).all()


def test_inserted_points_leave_the_surface_as_it_is():
    cube, rng = box(2), np.random.default_rng(24)
    mesh = TriangleMesh(cube.vertices, cube.faces)
    # inside faces, several in one; on edges; at vertices; beside the surface
    positions = np.concatenate(
        [rng.uniform(size=(30, 3)) * [1, 1, 0], [[0.25, 0, 0], [0.5, 0.5, 0], [0.1, 0.1, -3], [2, 2, 2]]]
    )
    cut, indices = insert_points(mesh, positions)
    assert rinow.hausdorff_distance(cut, mesh, tolerance=1e-10).upper < 1e-9
    np.testing.assert_array_equal(cut.vertices[: mesh.n_vertices], mesh.vertices)
    assert cut.face_areas.sum() == pytest.approx(6.0, rel=1e-12)
    np.testing.assert_allclose(cut.vertices[indices[:30]], positions[:30], atol=1e-12)
    assert cut.vertices[indices[-1]].tolist() == [1, 1, 1]
    assert indices[-1] < mesh.n_vertices
    # one side of the cube is flat: its inner distances are those of the plane
    D = rinow.geodesic_space(cut, indices[:30]).distances
    np.testing.assert_allclose(D, rinow.MetricSpace.from_points(positions[:30]).distances, atol=1e-12)


def test_faults_of_arguments_are_named():
    s = icosphere(0)
    with pytest.raises(InvalidInputError, match="meshes is empty"):
        study_meshes([], (s.vertices, s.faces))
    with pytest.raises(InvalidInputError, match=r"size = 20 is outside 1\.\.12"):
        study_meshes([(s.vertices, s.faces)], (s.vertices, s.faces))
    parts = two_components(20)
    with pytest.raises(InvalidMeshError, match=r"not connected|no geodesic distance"):
        study_meshes([(parts.vertices, parts.faces)], (s.vertices, s.faces), net_size=3)
    with pytest.raises(InvalidInputError, match="sizes is empty"):
        study_nets([[0.0]], [])
