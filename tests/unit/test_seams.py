"""Seams of exported files: values and features of the closed surface, in the order of the file."""

import json

import numpy as np
import pytest

import rinow
import shapes
from rinow.cli.main import main
from rinow.study.features import study_features
from rinow.study.surface import study_surface


def split(vertices, faces, part):
    """The mesh with vertices of its own for each part of its faces, and for each vertex the one it was."""
    V, F, origin = [], [], []
    for name in np.unique(part):
        used, local = np.unique(faces[part == name], return_inverse=True)
        F.append(local.reshape(-1, 3) + sum(map(len, origin)))
        V.append(vertices[used])
        origin.append(used)
    return rinow.TriangleMesh(np.concatenate(V), np.concatenate(F)), np.concatenate(origin)


@pytest.fixture(scope="module")
def ball():
    """A sphere in two halves."""
    sphere = shapes.icosphere(3)
    upper = sphere.vertices[sphere.faces].mean(axis=1)[:, 2] > 0
    return sphere, *split(sphere.vertices, sphere.faces, upper)


def test_curvature_is_that_of_the_closed_surface(ball):
    sphere, mesh, origin = ball
    study = study_surface(mesh)
    whole = rinow.surface_curvature((sphere.vertices, sphere.faces))
    assert study.mesh is mesh
    assert (study.curvature.status == rinow.VertexStatus.OK).all()
    np.testing.assert_allclose(study.curvature.gaussian, whole.gaussian[origin], rtol=1e-9)


def test_creases_at_seams_are_found_and_marked_on_both_sides():
    V, F = shapes.box(4)[:2]
    normals = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    mesh, origin = split(V, F, np.abs(normals).argmax(axis=1) + 3 * (normals.sum(axis=1) > 0))
    found, whole = study_features(mesh), rinow.singular_features((V, F))
    np.testing.assert_array_equal(np.sort(origin[found.features.corners]), np.sort(whole.corners))
    assert len(found.features.crease_edges) == len(whole.crease_edges)
    kinds = np.zeros(len(V))
    kinds[whole.crease_edges] = 1
    kinds[whole.corners] = 2
    np.testing.assert_array_equal(found.vertex_data()["feature"], kinds[origin])


def test_seams_of_files_are_closed_on_the_command_line(ball, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    _, mesh, origin = ball
    rinow.write_mesh("seam.glb", mesh)
    assert main(["curvature", "seam.glb", "-o", "out.npz", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["status"] == {"OK": len(origin)}
    assert rinow.read_mesh("out.npz").n_vertices == len(origin)
    assert main(["features", "seam.glb", "--json"]) == 0
