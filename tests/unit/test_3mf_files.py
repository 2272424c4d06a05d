"""3MF files: parts, transforms, parts in files of their own, units, and what is damaged."""

import zipfile

import numpy as np
import pytest

import rinow
from rinow.errors import FileFormatError, InvalidMeshError

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.5]])
F = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def tetrahedron(name, faces=F):
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}" />' for x, y, z in V.tolist())
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}" pid="1"/>' for a, b, c in np.asarray(faces).tolist())
    mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"
    return f'<object id="{name}" type="model">{mesh}</object>'


def model(objects, items, unit=' unit="inch"'):
    build = f"<build>{items}</build>"
    return f'<model{unit} xmlns="{CORE}" xmlns:p="{PRODUCTION}"><resources>{objects}</resources>{build}</model>'


def archive(path, **files):
    with zipfile.ZipFile(path, "w") as out:
        for name, text in files.items():
            out.writestr(name.replace("__", "/").replace("_model", ".model"), '<?xml version="1.0"?>' + text)
    return path


def test_parts_stand_in_their_places_in_the_order_of_the_build(tmp_path):
    quarter = 'transform="0 1 0 -1 0 0 0 0 1 10 20 30"'  # x to y, y to -x, then moved
    items = f'<item objectid="2" {quarter}/><item objectid="1"/>'
    file = archive(tmp_path / "a.3mf", **{"3D__3dmodel_model": model(tetrahedron(1) + tetrahedron(2, F[:2]), items)})
    mesh = rinow.read_mesh(file)
    turned = V @ [[0, 1, 0], [-1, 0, 0], [0, 0, 1]] + [10, 20, 30]
    np.testing.assert_array_equal(mesh.vertices, np.concatenate([turned, V]))
    np.testing.assert_array_equal(mesh.faces, np.concatenate([F[:2], F + 4]))
    assert mesh.notes[0] == "the file gives its unit of length as inch."
    assert "the 2 parts were joined" in mesh.notes[1]


def test_components_lie_in_files_of_their_own(tmp_path):
    """As slicers write them; a transform of the whole comes after that of the part."""
    move, double = 'transform="1 0 0 0 1 0 0 0 1 1 0 0"', 'transform="2 0 0 0 2 0 0 0 2 0 0 0"'
    assembly = (
        f'<object id="9"><components><component p:path="/3D/Objects/a.model" objectid="1" {move}/>'
        f'<component objectid="7"/></components></object>{tetrahedron(7)}'
    )
    files = {
        "3D__other_model": model(assembly, f'<item objectid="9" {double}/>', unit=""),
        "3D__Objects__a_model": model(tetrahedron(1), ""),
        "_rels__.rels": '<Relationships xmlns="r"><Relationship Target="/3D/other.model" '
        'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>',
    }
    mesh = rinow.read_mesh(archive(tmp_path / "a.3mf", **files))
    np.testing.assert_array_equal(mesh.vertices, np.concatenate([2 * (V + np.eye(3)[0]), 2 * V]))
    assert mesh.notes[0] == "the file gives its unit of length as millimeter."


def test_without_a_build_all_meshes_are_taken(tmp_path):
    file = archive(tmp_path / "a.3mf", **{"3D__3dmodel_model": model(tetrahedron(1), "")})
    np.testing.assert_array_equal(rinow.read_mesh(file).faces, F)


LOOP = '<object id="1"><components><component objectid="1"/></components></object>'


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (model(tetrahedron(1, F + 1), '<item objectid="1"/>'), r"the object 1 names a vertex outside 0\.\.3"),
        (model(tetrahedron(1), '<item objectid="5"/>'), r"the object 5 of 3D/3dmodel\.model is not there"),
        (model(LOOP, '<item objectid="1"/>'), "contains itself"),
        (model(tetrahedron(1).replace('"1.5"', '"much"'), '<item objectid="1"/>'), "is no intact 3MF file"),
        ("<model>", "is no intact 3MF file"),
        (model(LOOP.replace('objectid="1"', 'p:path="/b.model"'), '<item objectid="1"/>'), "no part b.model, which"),
    ],
)
def test_faults_are_named(tmp_path, text, fault):
    file = archive(tmp_path / "a.3mf", **{"3D__3dmodel_model": text})
    with pytest.raises(FileFormatError, match=rf"a\.3mf.*{fault}"):
        rinow.read_mesh(file)


def test_archives_without_a_model_or_a_triangle(tmp_path):
    with pytest.raises(FileFormatError, match="has no model"):
        rinow.read_mesh(archive(tmp_path / "a.3mf", readme="x"))
    (tmp_path / "b.3mf").write_bytes(b"PK")
    with pytest.raises(FileFormatError, match="no 3MF archive"):
        rinow.read_mesh(tmp_path / "b.3mf")
    for objects in ("", tetrahedron(1, np.empty((0, 3), int))):
        with pytest.raises(InvalidMeshError, match="no part has a triangle"):
            rinow.read_mesh(archive(tmp_path / "a.3mf", **{"3D__3dmodel_model": model(objects, "")}))
    with pytest.raises(FileFormatError, match="3MF cannot hold positions that are not finite"):
        rinow.write_mesh(tmp_path / "c.3mf", (np.full((3, 3), np.nan), [[0, 1, 2]]))
    assert not (tmp_path / "c.3mf").exists()
