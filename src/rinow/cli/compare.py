"""`rinow compare`: the distance of two shapes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rinow._version import __version__
from rinow.cli._arguments import Flag, Outputs
from rinow.cli._terminal import print_counts, print_json, print_notes, working
from rinow.comparison.hausdorff import HausdorffDistance
from rinow.comparison.surfaces import check_connected
from rinow.errors import FileFormatError, InvalidInputError, naming
from rinow.io.distance_tables import read_distances
from rinow.io.mesh_files import check_outputs, read_mesh, write_result
from rinow.io.point_files import check_has_faces
from rinow.io.tables import check_tables, read_points, write_columns
from rinow.mesh import TriangleMesh
from rinow.metric_space import MetricSpace
from rinow.study.comparison import ComparisonStudy, Kind, Metric, compare_shapes

__all__ = ["compare"]


def compare(
    a: Path,
    b: Path,
    /,
    *,
    metric: Metric | None = None,
    points: Flag = False,
    distances: Flag = False,
    output: Outputs = (),
    tolerance: float = 1e-4,
    time_limit: float = 60.0,
    rtol: float = 1e-9,
    verify: Flag = False,
    unit: str = "length",
    json: Flag = False,
) -> None:
    """Bound the distance of two meshes, point sets or distance matrices from below and from above.

    Parameters
    ----------
    a
        Mesh file; with --points or --distances a table as CSV, NPY or NPZ.
    b
        What to compare it with, of the same kind.
    metric
        The distance; by default Hausdorff, for distance matrices Gromov-Hausdorff.
    points
        Compare point sets: rows of the tables, or the vertices of mesh files.
    distances
        Compare finite metric spaces: the tables are square matrices of distances.
    output
        Hausdorff: file for the distance of each vertex or point of A, given a second time for those of B; a mesh file
        or a table (.csv, .npz).  Other distances: one table of the pairs or of the map that attains the upper bound.
    tolerance
        Hausdorff distance of surfaces: greatest width of the interval, relative to the diagonal.
    time_limit
        Other distances: seconds after which to stop with the interval reached, counted from when the files are read.
        Lipschitz distance of meshes: where all their geodesic distances would take too long, an error says how long.
    rtol
        Distance matrices: how much the axioms of a metric may be broken, relative to the largest distance.
    verify
        Other distances: check the proof if the lower bound comes from a clause-learning solver.
    unit
        Name of the unit of length of the files, such as mm.
    json
        Print one JSON object instead of a table.
    """
    if points and distances:
        raise InvalidInputError("--points and --distances exclude each other; say what the files hold.")
    kind: Kind = "points" if points else "distances" if distances else "surfaces"
    distance: Metric = metric or ("gromov-hausdorff" if distances else "hausdorff")
    _check_outputs(output, (a, b), kind, distance)
    shapes, labels = list[Any](), list[tuple[str, ...]]()
    for name, path in (("A", a), ("B", b)):
        with working(f"reading {path.name}"):
            with naming(f"{name}: {path}"):
                shape, names = _read(path, kind, distance, rtol)
                shapes.append(shape)
                labels.append(names)
    with working("comparing"):
        study = compare_shapes(
            *shapes,
            metric=distance,
            kind=kind,
            tolerance=tolerance,
            time_limit=time_limit,
            verify=verify,
            unit=unit,
        )
    notes = [note for shape in shapes if isinstance(shape, TriangleMesh) for note in shape.notes]
    notes += _write(output, study, shapes, labels)
    if kind == "surfaces" and distance == "gromov-hausdorff":
        notes.append("distances on the surfaces are lengths of shortest paths along edges.")
    record = {"a": str(a), "b": str(b), **study.record()}
    if json:
        print_json({"rinow": __version__, **record, "outputs": [str(path) for path in output], "notes": notes})
    else:
        _print(record, notes)


def _read(path: Path, kind: Kind, metric: Metric, rtol: float) -> tuple[Any, tuple[str, ...]]:
    """A shape of a kind that has a distance of this kind, and the labels of its points, if any."""
    if kind == "points":
        return read_points(path), ()
    if kind == "distances":
        matrix, labels = read_distances(path)
        return MetricSpace(matrix, rtol=rtol), labels
    check_has_faces(path, "add --points if its rows are points, --distances if it is a matrix of distances")
    mesh = read_mesh(path)
    if metric != "hausdorff":
        check_connected(mesh, every_vertex=metric == "lipschitz")
    return mesh, ()


def _check_outputs(output: tuple[Path, ...], inputs: tuple[Path, Path], kind: Kind, metric: Metric) -> None:
    """Refuse outputs that could not be written later."""
    most = 2 if metric == "hausdorff" else 1
    if len(output) > most:
        raise FileFormatError(f"{output[most]} is one output too many; the {metric} distance has {most}.")
    check_outputs([path for path in output if not _is_table(path, kind, metric)], inputs=inputs)
    check_tables([path for path in output if _is_table(path, kind, metric)], inputs=inputs)


def _is_table(path: Path, kind: Kind, metric: Metric) -> bool:
    """Whether an output is a table; NPZ holds a mesh where distances belong to the vertices of meshes."""
    return path.suffix.lower() == ".csv" or kind != "surfaces" or metric != "hausdorff"


def _write(
    output: tuple[Path, ...], study: ComparisonStudy, shapes: list[Any], labels: list[tuple[str, ...]]
) -> list[str]:
    """What the outputs are for; returns what a format could not carry."""
    result, notes = study.result, list[str]()
    if not isinstance(result, HausdorffDistance):
        for path in output:
            columns: dict[str, Any] = dict(zip("ab", study.pairs().T, strict=True))
            columns |= {f"label_{s}": np.array(n)[columns[s]] for s, n in zip("ab", labels, strict=True) if n}
            write_columns(path, columns, "points of A and B that belong together in the upper bound")
        return notes
    sides = zip(output, shapes, (result.distances_a, result.distances_b), "BA", strict=False)
    for path, shape, values, other in sides:
        meaning = f"distance from {other}, unit {study.unit}"
        with working(f"writing {path.name}"):
            if _is_table(path, study.kind, study.metric):
                write_columns(path, {"distance": values}, meaning)
            else:
                units = {"distance": meaning}
                notes += write_result(path, shape, {"distance": values}, units, "distance")
    return notes


def _print(record: dict[str, Any], notes: list[str]) -> None:
    """A table of the interval, and what proves it."""
    rows = {name: record[name] for name in ("lower", "upper")}
    if "witness_a" in record:
        for side in "ab":
            levels = record[f"percentiles_{side}"]
            rows[f"median distance from {side} to the other set"] = levels["50"]
            rows[f"95 % of the distances from {side} are below"] = levels["95"]
        proof = f"attained between {_place(record['witness_a'])} in a and {_place(record['witness_b'])} in b"
    else:
        checked = {None: "", True: ", its proof checked", False: ", its proof not checked"}[record["proof_checked"]]
        pairs = f"; {len(record['pairs'])} pairs attain the upper one" if record["pairs"] else ""
        proof = f"proved by {record['lower_bound_by']}{checked}{pairs}"
    unit = "" if record["unit"] == "1" else " " + record["unit"]
    print_counts(f"{record['metric']} distance of {record['a']} and {record['b']}, unit {record['unit']}", rows)
    interval = f"{record['lower']:.9g} <= distance <= {record['upper']:.9g}{unit}"
    print_notes((f"{interval}; the lower bound is {proof}; {record['seconds']:.2f} s.", *notes))


def _place(witness: int | list[float]) -> str:
    """A witness in words."""
    return str(witness) if isinstance(witness, int) else "(" + ", ".join(f"{x:.6g}" for x in witness) + ")"
