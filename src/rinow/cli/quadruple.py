"""`rinow quadruple`: everything about the embedding of four points known by their six distances."""

from __future__ import annotations

from typing import Any

import numpy as np
from rich.table import Table

from rinow.cli._arguments import Flag
from rinow.cli._terminal import console, print_json, print_notes
from rinow.embedding.cayley_menger import circumradius, is_euclidean_simplex, simplex_volume
from rinow.embedding.quadruple import EmbeddingCurvatures, embedding_curvatures
from rinow.embedding.semidependent import robinson_curvature, semidependent_order
from rinow.embedding.spaceform import SpaceForm
from rinow.errors import InvalidInputError, NotAMetricError

__all__ = ["quadruple"]

LEAST, GREATEST = 1e-150, 1e150
NAMES = ("d12", "d13", "d14", "d23", "d24", "d34")
PAIRS = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
REASONS = {
    -1: "the points lie on a line, or two of them coincide: every curvature up to (pi / largest distance)^2 will do.",
    0: "two triples of the points lie on lines that branch off at a common middle point; no surface has that.",
    1: "a triple lies on a line, or the quadruple is like a tree.",
    2: "",
}


def quadruple(d12: float, d13: float, d14: float, d23: float, d24: float, d34: float, /, *, json: Flag = False) -> None:
    """Print all surfaces of constant curvature in which four points have the given distances.

    Parameters
    ----------
    d12
        Distance of the points 1 and 2, in any unit of length.
    d13
        Of 1 and 3.
    d14
        Of 1 and 4.
    d23
        Of 2 and 3.
    d24
        Of 2 and 4.
    d34
        Of 3 and 4.
    json
        Print one JSON object instead of a table.
    """
    d = np.array([d12, d13, d14, d23, d24, d34])
    result = embedding_curvatures(d)
    if result.count == -2:
        raise NotAMetricError(_fault(d))
    _check_range(d)
    record = _record(d, result)
    if json:
        print_json(record)
    else:
        _print(record)


def _fault(d: np.ndarray) -> str:
    """Which distance or triangle keeps six numbers from being a metric."""
    for name, value in zip(NAMES, d, strict=True):
        if not (np.isfinite(value) and value >= 0.0):
            return f"{name} = {value:g} is not a distance; give numbers that are finite and not negative."
    D = _matrix(d)
    excess = D[:, None, :] - D[:, :, None] - D[None, :, :]  # d_ik - d_ij - d_jk at [i, j, k]
    i, j, k = (int(x) for x in np.unravel_index(np.argmax(excess), excess.shape))
    names = [f"d{min(p, q) + 1}{max(p, q) + 1}" for p, q in ((i, k), (i, j), (j, k))]
    return f"{names[0]} = {D[i, k]:g} exceeds {names[1]} + {names[2]} = {D[i, j] + D[j, k]:g}; no metric has that."


def _check_range(d: np.ndarray) -> None:
    """Refuse distances whose squares, or the curvatures that go with them, are no numbers of full precision."""
    largest = float(d.max())
    if largest > 0.0 and not LEAST <= largest <= GREATEST:
        raise InvalidInputError(
            f"distances up to {largest:g} have curvatures out of the range of numbers; "
            "give them in a unit in which they are near 1."
        )


def _matrix(d: np.ndarray) -> np.ndarray:
    D = np.zeros((4, 4))
    for (i, j), value in zip(PAIRS, d, strict=True):
        D[i, j] = D[j, i] = value
    return D


def _record(d: np.ndarray, result: EmbeddingCurvatures) -> dict[str, Any]:
    """All results in plain types."""
    count = int(result.count)
    values = [
        {
            "curvature": float(result.values[i]),
            "kind": str(result.kind[i]),
            "condition": float(result.condition[i]),
            "coordinates": SpaceForm(float(result.values[i])).embed(d).tolist(),
        }
        for i in range(max(count, 0))
    ]
    D = _matrix(d)
    euclidean = bool(is_euclidean_simplex(D))
    return {
        "distances": dict(zip(NAMES, d.tolist(), strict=True)),
        "count": count,
        "reason": REASONS[count],
        "values": values,
        "robinson": _robinson(d),
        "euclidean_tetrahedron": euclidean,
        "volume": float(simplex_volume(D)) if euclidean else None,
        "circumradius": float(circumradius(D)) if euclidean else None,
        "unit": "curvature in 1/length², in the unit of the distances",
    }


def _robinson(d: np.ndarray) -> dict[str, Any] | None:
    """Robinson's value and interval in his order of the points, where one lies between two others."""
    order = semidependent_order(d)
    if order[0] < 0:
        return None
    D = _matrix(d)
    ordered = [D[order[i], order[j]] for i, j in PAIRS]
    formula, certificate = robinson_curvature(ordered), robinson_curvature(ordered, verify=True)
    if np.isnan(formula.value):
        return None
    return {
        "order": (order + 1).tolist(),
        "value": float(formula.value),
        "lower": float(certificate.lower),
        "upper": float(certificate.upper),
    }


def _print(record: dict[str, Any]) -> None:
    """A row for each embedding curvature; below it why there are so many, and what else is known."""
    table = Table("curvature", "kind", "condition", "coordinates in the model of that curvature")
    for value in record["values"]:
        points = "\n".join("(" + ", ".join(f"{x:.6g}" for x in point) + ")" for point in value["coordinates"])
        table.add_row(f"{value['curvature']:.15g}", value["kind"], f"{value['condition']:.3g}", points)
    if record["values"]:
        console().print(table)
    notes = [record["unit"]]
    if record["reason"]:
        found = len(record["values"])
        notes.append(f"{('no single value', 'only one value', 'two values')[found]}: {record['reason']}")
    if (robinson := record["robinson"]) is not None:
        notes.append(
            f"Robinson's formula in the order {robinson['order']}: {robinson['value']:.15g}, "
            f"certified: {robinson['lower']:.15g} <= curvature <= {robinson['upper']:.15g}."
        )
    if record["euclidean_tetrahedron"]:
        notes.append(
            f"Euclidean tetrahedron of volume {record['volume']:.9g}, circumradius {record['circumradius']:.9g}."
        )
    else:
        notes.append("no Euclidean tetrahedron has these edges.")
    print_notes(tuple(notes))
