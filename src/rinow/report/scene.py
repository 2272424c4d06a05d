"""What a page knows of a surface: its arrays, packed small, and a header that says how to read them.

An array becomes little-endian integers or floats.  Indices and positions become differences from row to row, which are
small where neighbours follow each other, written as 0, -1, 1, -2 ... -> 0, 1, 2, 3 ...; the bytes are sorted by their
place in the number, which puts the equal ones together; all of it is compressed by gzip and written in base64.
`_assets/scene.js` is the way back.
"""

from __future__ import annotations

import base64
import gzip
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.report.discs import framed, normals
from rinow.report.figures import UNDEFINED_GREY, colour_scale
from rinow.study.features import FeatureStudy
from rinow.study.points import PointStudy
from rinow.study.surface import FIELDS, SIGNED, STATUSES, SurfaceStudy, field_unit

__all__ = ["Scene", "surface_scene"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]

POSITION_STEPS = 2**20 - 1
"""Steps along the longest side of the box of all faces: a hundredth of a pixel on the largest screens."""
MOST_STEPS = 2**32 - 2
DIRECTION_STEPS = 127
MOST_DIRECTIONS = 8_000
"""Vertices at which principal directions are drawn; more lines hide the surface."""
LARGE, BITS_OF_LARGE = 200_000, 12
"""Vertices from which on fields keep that many bits, nearly four digits, which halves the page."""
COMPRESSION = 6
"""Level of gzip; 9 takes three times as long for one percent."""
COLOURS_IN_MAP = 256


@dataclass(frozen=True, slots=True)
class Scene:
    """A surface and its fields as a page holds them.

    Attributes
    ----------
    header : dict
        All that is not an array, ready for JSON: how to read `data`, names, units and colours of the fields.
    data : str
        The arrays, in base64.
    """

    header: dict[str, Any]
    data: str


def surface_scene(
    study: SurfaceStudy | PointStudy, features: FeatureStudy | None = None, *, field: str = "gaussian", up: str = "z"
) -> Scene:
    """Pack a surface or a cloud of points, its curvature and its singular points for a page.

    Parameters
    ----------
    study : SurfaceStudy or PointStudy
        Surface and curvature; a cloud has points for faces, of one corner each, and normals up to sign.
    features : FeatureStudy, optional
        Singular points of the same surface.
    field : str
        Name of the scalar that is shown at first.
    up : {"x", "y", "z"}
        Axis that points up at first.

    Returns
    -------
    scene : Scene
        Positions are rounded to the step that the header names, fields to single precision (double where single
        would overflow or vanish), those of large meshes to `BITS_OF_LARGE`; status, nan and faces are exact.  Faces at
        non-finite positions are left out.
    """
    is_finite: Bools = np.all(np.isfinite(study.positions), axis=1, keepdims=False)
    shape, shown, hidden = _faces(study, is_finite) if isinstance(study, SurfaceStudy) else _points(study, is_finite)
    origin, step = _grid(study.positions[is_finite], study.positions[shown])
    positions = np.rint((np.where(is_finite[:, None], study.positions, origin) - origin) / step)
    in_frame = positions[shown] if shown.any() else np.zeros((1, 3))
    fields, areas = study.fields(field), study.areas
    arrays: dict[str, NDArray[Any]] = {
        "positions": positions.astype(np.uint32),
        **shape,
        "status": study.curvature.status,
        **{name: compact(values) for name, values in {"areas": areas, **fields}.items()},
        **_directions(study, origin, float(areas.sum())),
        **(_lines_and_points(features) if features else {}),
    }
    entries, data = pack(arrays)
    header = {
        "arrays": entries,
        "vertices": len(positions),
        "place": study.place,
        "places": study.places,
        "frame": [in_frame.min(axis=0).tolist(), in_frame.max(axis=0).tolist()],
        "hidden_faces": hidden,
        "precision": 2.0**-BITS_OF_LARGE if len(positions) >= LARGE else 2.0**-24,
        "origin": origin.tolist(),
        "step": step,
        "field": field,
        "up": up,
        "unit": study.unit,
        "undefined": [round(255 * c) for c in UNDEFINED_GREY],
        "statuses": STATUSES,
        "fields": [_field(name, values, areas, study.unit) for name, values in fields.items()],
        "maps": {name: _colour_map(name) for name in ("RdBu_r", "viridis")},
    }
    return Scene(header, data)


def _faces(study: SurfaceStudy, is_finite: Bools) -> tuple[dict[str, NDArray[Any]], Bools, int]:
    """Faces at finite positions, which vertices they have, and how many others there are."""
    mesh = study.mesh
    shown = is_finite[mesh.faces].all(axis=1)
    in_faces = np.zeros(mesh.n_vertices, np.bool_)
    in_faces[mesh.faces[shown].ravel()] = True
    flips = mesh.outward_flips[shown].astype(np.uint8)
    return {"faces": mesh.faces[shown].astype(np.uint32), "turned": flips}, in_faces, int((~shown).sum())


def _points(study: PointStudy, is_finite: Bools) -> tuple[dict[str, NDArray[Any]], Bools, int]:
    """Points at finite positions, their normals, and which of them are in the frame."""
    rounded = np.rint(normals(study) * DIRECTION_STEPS).astype(np.int8)
    shape = {"faces": np.flatnonzero(is_finite).astype(np.uint32), "normals": rounded}
    return shape, framed(study), 0


def _grid(finite: Floats, shown: Floats) -> tuple[Floats, float]:
    """Origin and step of the positions: fine for the vertices of faces, and coarse enough to reach all others."""
    if len(finite) == 0:
        return np.zeros(3), 1.0
    origin = finite.min(axis=0)
    reach = float((finite.max(axis=0) - origin).max()) / MOST_STEPS
    extent = float(np.ptp(shown, axis=0).max()) / POSITION_STEPS if len(shown) else 0.0
    return origin, max(extent, reach) or 1.0


def compact(values: Floats) -> NDArray[np.floating[Any]]:
    """The values in single precision, or as they are if some would overflow or vanish in it; fewer bits of many.

    Examples
    --------
    >>> compact(np.array([0.1, np.nan, -3.0]))
    array([ 0.1,  nan, -3. ], dtype=float32)
    >>> compact(np.array([1e-200, 2e-200]))
    array([1.e-200, 2.e-200])
    """
    size = np.abs(values[np.isfinite(values) & (values != 0.0)])
    single = np.finfo(np.float32)
    if len(size) and not (size.max() < single.max and np.median(size) > single.tiny):
        return values
    short = values.astype(np.float32)
    if len(values) >= LARGE:
        dropped = np.uint32(single.nmant + 1 - BITS_OF_LARGE)
        bits = (short.view(np.uint32) + (np.uint32(1) << (dropped - np.uint32(1)))) >> dropped << dropped
        short = np.where(np.isfinite(short), bits.view(np.float32), short)
    return short


def pack(arrays: Mapping[str, NDArray[Any]]) -> tuple[list[dict[str, Any]], str]:
    r"""Entries of the header and the text of all arrays, one after the other.

    Examples
    --------
    >>> entries, text = pack({"status": np.array([0, 1, 0], np.uint8)})
    >>> entries
    [{'name': 'status', 'type': 'uint8', 'rows': 3, 'columns': 1, 'differences': False}]
    >>> gzip.decompress(base64.b64decode(text))
    b'\x00\x01\x00'
    """
    entries: list[dict[str, Any]] = []
    blocks: list[bytes] = []
    for name, array in arrays.items():
        table = array if array.ndim == 2 else array[:, None]
        differences = table.dtype == np.uint32
        entries.append(
            {
                "name": name,
                "type": table.dtype.name,
                "rows": table.shape[0],
                "columns": table.shape[1],
                "differences": differences,
            }
        )
        if differences:
            steps = np.diff(table, axis=0, prepend=np.zeros((1, table.shape[1]), np.uint32)).view(np.int32)
            table = ((steps << 1) ^ (steps >> 31)).view(np.uint32)
        size = table.dtype.itemsize
        little = np.ascontiguousarray(table, table.dtype.newbyteorder("<"))
        blocks.append(little.view(np.uint8).reshape(-1, size).T.tobytes())
    return entries, base64.b64encode(gzip.compress(b"".join(blocks), COMPRESSION, mtime=0)).decode("ascii")


def _directions(study: SurfaceStudy | PointStudy, origin: Floats, area: float) -> dict[str, NDArray[Any]]:
    """Principal directions at vertices all over the surface, rounded; nothing if no vertex has any."""
    both = {name: np.asarray(getattr(study.curvature, name)) for name in ("direction1", "direction2")}
    known = np.flatnonzero(np.isfinite(np.hstack(list(both.values()))).all(axis=1))
    if len(known) == 0:
        return {}
    cell = float(np.sqrt(area / MOST_DIRECTIONS))
    chosen = known
    while len(chosen) > MOST_DIRECTIONS:
        i, j, k = np.floor((study.positions[known] - origin) / cell).astype(np.int64).T
        chosen = known[np.unique((i * 2**21 + j) * 2**21 + k, return_index=True)[1]]
        cell *= 1.2
    vertices = np.sort(chosen)
    rounded = {name: np.rint(d[vertices] * DIRECTION_STEPS).astype(np.int8) for name, d in both.items()}
    return {"direction_vertices": vertices.astype(np.uint32), **rounded}


def _lines_and_points(study: FeatureStudy) -> dict[str, NDArray[Any]]:
    """Creases, corners and cone points."""
    found = study.features
    return {
        "crease_edges": found.crease_edges.astype(np.uint32),
        "crease_angles": found.crease_angles.astype(np.float32),
        "corners": found.corners.astype(np.uint32),
        "cone_points": found.cone_points.astype(np.uint32),
        "cone_angles": found.cone_angles.astype(np.float32),
    }


def _field(name: str, values: Floats, areas: Floats, unit: str) -> dict[str, Any]:
    """Name, unit and colours of a field."""
    scale = colour_scale(values, areas, signed=name in SIGNED)
    return {
        "name": name,
        "title": FIELDS[name][0],
        "unit": field_unit(name, unit),
        "signed": name in SIGNED,
        "low": scale.low,
        "high": scale.high,
        "map": scale.colour_map,
    }


def _colour_map(name: str) -> str:
    """Red, green and blue of the colours of a map, in base64."""
    from matplotlib import colormaps

    colours = colormaps[name].resampled(COLOURS_IN_MAP)(np.arange(COLOURS_IN_MAP), bytes=True)[:, :3]
    return base64.b64encode(np.ascontiguousarray(colours).tobytes()).decode("ascii")
