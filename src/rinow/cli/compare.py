"""`rinow compare`: the distance of two shapes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import Parameter

from rinow._version import __version__
from rinow.cli._terminal import print_counts, print_json, print_notes, working
from rinow.errors import FileFormatError, InvalidInputError
from rinow.io.mesh_files import check_outputs, read_mesh, write_mesh
from rinow.io.tables import check_table, read_distances, read_points, write_columns
from rinow.mesh import TriangleMesh
from rinow.study.comparison import ComparisonStudy, Kind, compare_shapes

__all__ = ["compare"]


def compare(
    a: Path,
    b: Path,
    /,
    *,
    metric: Literal["hausdorff", "gromov-hausdorff", "lipschitz"] | None = None,
    points: bool = False,
    distances: bool = False,
    output: Annotated[tuple[Path, ...], Parameter(name=["--output", "-o"])] = (),
    tolerance: float = 1e-4,
    time_limit: float = 60.0,
    unit: str = "length",
    json: bool = False,
) -> None:
    """Bound the distance of two meshes, point sets or distance matrices from below and from above.

    Parameters
    ----------
    a, b
        Two mesh files; with --points or --distances tables as CSV, NPY or NPZ.
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
        Other distances: seconds after which to stop with the interval reached.
    unit
        Name of the unit of length of the files, such as mm.
    json
        Print one JSON object instead of a table.
    """
    if points and distances:
        raise InvalidInputError("--points and --distances exclude each other; say what the files hold.")
    kind: Kind = "points" if points else "distances" if distances else "surfaces"
    _check_outputs(output, (a, b), kind)
    shapes: list[Any] = []
    for path in (a, b):
        with working(f"reading {path.name}"):
            shapes.append(_read(path, kind))
    with working("comparing"):
        study = compare_shapes(
            *shapes,
            metric=metric or ("gromov-hausdorff" if distances else "hausdorff"),
            kind=kind,
            tolerance=tolerance,
            time_limit=time_limit,
            unit=unit,
        )
    notes = [note for shape in shapes if isinstance(shape, TriangleMesh) for note in shape.notes]
    notes += _write(output, study, shapes)
    record = {"a": str(a), "b": str(b), **study.record()}
    if json:
        print_json({"rinow": __version__, **record, "outputs": [str(path) for path in output], "notes": notes})
    else:
        _print(record, notes)


def _read(path: Path, kind: Kind) -> Any:
    if kind == "surfaces":
        return read_mesh(path)
    return read_points(path) if kind == "points" else read_distances(path)


def _is_table(path: Path, kind: Kind) -> bool:
    """Whether an output is a table; NPZ holds a mesh when meshes are compared."""
    return path.suffix.lower() == ".csv" or kind != "surfaces"


def _check_outputs(output: tuple[Path, ...], inputs: tuple[Path, Path], kind: Kind) -> None:
    """Refuse outputs that could not be written later."""
    if len(output) > 2:
        raise FileFormatError(f"{output[2]} is a third output; there are two sets, A and B.")
    check_outputs([path for path in output if not _is_table(path, kind)], inputs=inputs)
    for path in output:
        if _is_table(path, kind):
            check_table(path, inputs=inputs)
    for i, path in enumerate(output):
        if path.resolve() in {other.resolve() for other in output[:i]}:
            raise FileFormatError(f"{path} is named twice as an output; choose another name.")


def _write(output: tuple[Path, ...], study: ComparisonStudy, shapes: list[Any]) -> list[str]:
    """The distances of the vertices or points; returns what a format could not carry."""
    notes: list[str] = []
    for path, shape, values, other in zip(
        output, shapes, (study.result.distances_a, study.result.distances_b), "BA", strict=False
    ):
        meaning = f"distance from {other}, unit {study.unit}"
        with working(f"writing {path.name}"):
            if _is_table(path, study.kind):
                write_columns(path, {"distance": values}, meaning)
            else:
                units = {"distance": meaning}
                notes += write_mesh(path, shape, {"distance": values}, units=units, quality="distance")
    return notes


def _print(record: dict[str, Any], notes: list[str]) -> None:
    """A table of the interval, and what it means."""
    rows = {name: record[name] for name in ("lower", "upper")}
    for side in "ab":
        levels = record[f"percentiles_{side}"]
        rows[f"median distance from {side} to the other set"] = levels["50"]
        rows[f"95 % of the distances from {side} are below"] = levels["95"]
    print_counts(f"{record['metric']} distance of {record['a']} and {record['b']}, in {record['unit']}", rows)
    witnesses = [record[f"witness_{side}"] for side in "ab"]
    text = [str(w) if isinstance(w, int) else "(" + ", ".join(f"{x:.6g}" for x in w) + ")" for w in witnesses]
    print_notes(
        (
            f"{record['lower']:.9g} <= distance <= {record['upper']:.9g} {record['unit']}; "
            f"the lower bound is attained between {text[0]} in a and {text[1]} in b; {record['seconds']:.2f} s.",
            *notes,
        )
    )
