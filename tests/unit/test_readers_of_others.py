"""What other programs show of the files: the documentation says it, and it is so."""

import json
import subprocess
import sys
from importlib.util import find_spec

import numpy as np
import pytest
import trimesh

import rinow

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.5]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
FIELDS = {"gaussian": np.array([1.5, 2, -3, 1e-9]), "mean": np.array([4.0, 3, 2, 1])}


def test_vtk_reads_all_fields_of_vtp_and_none_of_ply(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    for name in ("a.vtp", "a.ply"):
        rinow.write_mesh(tmp_path / name, (POINTS, FACES), FIELDS, quality="mean")
    vtp, ply = (pyvista.read(tmp_path / name) for name in ("a.vtp", "a.ply"))
    np.testing.assert_array_equal(vtp.points, POINTS)
    np.testing.assert_array_equal(vtp["Gauss_Curvature"], FIELDS["gaussian"])
    np.testing.assert_array_equal(vtp["Mean_Curvature"], FIELDS["mean"])
    np.testing.assert_array_equal(ply.points, POINTS)
    assert list(ply.point_data) == []


def test_meshlab_shows_the_chosen_field_of_ply_as_quality(tmp_path):
    """In a process of its own: pymeshlab brings libraries of threads that numba warns of."""
    if find_spec("pymeshlab") is None:
        pytest.skip("needs pymeshlab")
    rinow.write_mesh(tmp_path / "a.ply", (POINTS, FACES), FIELDS, quality="mean")
    program = (
        "import pymeshlab, sys; meshes = pymeshlab.MeshSet(); meshes.load_new_mesh(sys.argv[1]); "
        "print(meshes.current_mesh().vertex_scalar_array().tolist())"
    )
    command = [sys.executable, "-c", program, str(tmp_path / "a.ply")]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert json.loads(out.splitlines()[-1]) == FIELDS["mean"].tolist()


def test_rinow_is_quiet_beside_libraries_of_threads_of_others():
    """Numba warns of an old TBB, which pymeshlab brings along, and of which rinow makes no use."""
    if find_spec("pymeshlab") is None:
        pytest.skip("needs pymeshlab")
    program = (
        "import pymeshlab, rinow, trimesh; ball = trimesh.creation.icosphere(2); rinow.surface_curvature(ball); "
        "rinow.farthest_point_net(ball, size=3); rinow.geodesic_distances(ball, [0, 1])"
    )
    run = subprocess.run([sys.executable, "-W", "error", "-c", program], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (0, "")


def test_trimesh_reads_all_fields_of_ply(tmp_path):
    rinow.write_mesh(tmp_path / "a.ply", (POINTS, FACES), FIELDS, quality="mean")
    mesh = trimesh.load(tmp_path / "a.ply", process=False)
    np.testing.assert_array_equal(mesh.vertices, POINTS)
    read = mesh.metadata["_ply_raw"]["vertex"]["data"]
    np.testing.assert_array_equal(read["quality"], FIELDS["mean"])
    np.testing.assert_array_equal(read["gaussian"], FIELDS["gaussian"])


def test_meshes_of_nilearn_are_meshes():
    """They have coordinates where others have vertices."""
    surface = pytest.importorskip("nilearn.surface")
    mesh = surface.InMemoryMesh(POINTS, FACES)
    found = rinow.surface_curvature(mesh, method="angle_defect")
    np.testing.assert_array_equal(
        found.gaussian, rinow.surface_curvature((POINTS, FACES), method="angle_defect").gaussian
    )
    assert rinow.geodesic_distances(mesh, 0).shape == (1, 4)


def test_a_scene_is_told_how_to_become_a_mesh():
    scene = trimesh.Scene([trimesh.creation.box()])
    with pytest.raises(rinow.InvalidMeshError, match=r"a scene of trimesh has to_mesh\(\)"):
        rinow.surface_curvature(scene)
    assert len(rinow.surface_curvature(scene.to_mesh(), method="angle_defect").gaussian) == 8
