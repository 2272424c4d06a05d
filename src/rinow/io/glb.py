"""GLB files (binary glTF), through trimesh."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np

from rinow._printing import counted
from rinow.errors import FileFormatError, InvalidMeshError
from rinow.io.atomic import replacing
from rinow.io.faults import quiet
from rinow.mesh import TriangleMesh

__all__ = ["read_glb", "write_glb"]


def read_glb(path: Path) -> TriangleMesh:
    """Read all triangles of a GLB file as one mesh.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    mesh : TriangleMesh
        The parts of the scene in the order of the file, each moved to its place; vertices are not merged.

    Raises
    ------
    FileFormatError
        If an index has a fault.
    InvalidMeshError
        If the scene has no triangle.
    """
    import trimesh

    with quiet("trimesh"):
        scene: Any = trimesh.load(io.BytesIO(path.read_bytes()), file_type="glb", process=False)
    order = {name: i for i, name in enumerate(scene.geometry)}
    placed = [(order[part], node, part) for node in scene.graph.nodes_geometry for part in [scene.graph[node][1]]]
    vertices, faces, n_vertices, n_other = [], [], 0, 0
    for _, node, name in sorted(placed):
        part, matrix = scene.geometry[name], scene.graph[node][0]
        if not isinstance(part, trimesh.Trimesh):
            n_other += 1
            continue
        F = np.asarray(part.faces)
        if F.size and not (0 <= F.min() and F.max() < len(part.vertices)):
            raise FileFormatError(
                f"the part {name!r} names a vertex outside 0..{len(part.vertices) - 1}; export it again."
            )
        V = np.asarray(part.vertices, np.float64)
        vertices.append(V if np.array_equal(matrix, np.eye(4)) else V @ matrix[:3, :3].T + matrix[:3, 3])
        faces.append(F + n_vertices)
        n_vertices += len(V)
    if not faces:
        raise InvalidMeshError("the scene has no triangle; for a point cloud use point_cloud_curvature.")
    notes: list[str] = []
    if len(faces) > 1:
        notes.append(
            f"the {len(faces)} parts of the scene were joined into one mesh; vertices on their seams were not merged."
        )
    if n_other:
        what = counted(n_other, "part of the scene without triangles was", "parts of the scene without triangles were")
        notes.append(f"{what} left out.")
    return TriangleMesh(np.concatenate(vertices), np.concatenate(faces), notes=tuple(notes))


def write_glb(path: Path, mesh: TriangleMesh) -> tuple[str, ...]:
    """Write the geometry in single precision.

    Raises
    ------
    FileFormatError
        If a position is not finite, which glTF forbids.
    """
    import trimesh

    if not mesh.vertex_is_finite.all():
        raise FileFormatError(f"{path}: GLB cannot hold positions that are not finite; write PLY instead.")
    with quiet("trimesh"):
        data: Any = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).export(
            file_type="glb", include_normals=False
        )
    with replacing(path) as temporary:
        temporary.write_bytes(data)
    return ("GLB holds positions in single precision.",)
