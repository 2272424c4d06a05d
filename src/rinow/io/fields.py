"""Fields at the vertices as files hold them: their checks, names and types."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow.errors import InvalidInputError

__all__ = ["VTK_NAMES", "Fields", "Units", "checked_fields", "in_type_of", "renamed", "units_text"]

Field = NDArray[Any]
Fields = Mapping[str, Field]
Units = Mapping[str, str]

VTK_NAMES: Mapping[str, str] = {
    "gaussian": "Gauss_Curvature",
    "mean": "Mean_Curvature",
    "k1": "Maximum_Curvature",
    "k2": "Minimum_Curvature",
}
"""Names that `vtkCurvatures` gives to its arrays, and that VTK's users look for."""


def checked_fields(vertex_data: Mapping[str, ArrayLike], n_vertices: int) -> dict[str, Field]:
    """Fields as arrays of real numbers with one row per vertex.

    Raises
    ------
    InvalidInputError
        If a field is no array of real numbers, or has another length.
    """
    fields: dict[str, Field] = {}
    for name, values in vertex_data.items():
        array = np.asarray(values)
        if not name or array.dtype.kind not in "biuf" or array.shape[:1] != (n_vertices,):
            raise InvalidInputError(
                f"vertex_data[{name!r}] has type {array.dtype} and shape {array.shape}; "
                f"give a name and {n_vertices} rows of real numbers, one per vertex."
            )
        fields[name] = array
    return fields


def renamed(fields: Mapping[str, Any], names: Mapping[str, str]) -> dict[str, Any]:
    """The same mapping with some keys replaced, in the same order.

    Raises
    ------
    InvalidInputError
        If two keys become one.

    Examples
    --------
    >>> renamed({"gaussian": 1, "mean": 2}, {"gaussian": "quality"})
    {'quality': 1, 'mean': 2}
    """
    result = {names.get(name, name): values for name, values in fields.items()}
    if len(result) < len(fields):
        twins = [name for name in fields if names.get(name, name) != name and names[name] in fields]
        raise InvalidInputError(f"the fields {twins[0]!r} and {names[twins[0]]!r} get the same name; rename one.")
    return result


def in_type_of(values: Field, types: Iterable[str]) -> Field:
    """The values in their type if it is one of some types, else as 4-byte integers if they are such, else as float64.

    Examples
    --------
    >>> in_type_of(np.array([True, False]), ("u1", "i4")).dtype
    dtype('uint8')
    >>> in_type_of(np.array([-1, 2**40]), ("u1", "i4")).dtype
    dtype('float64')
    """
    allowed = [np.dtype(t) for t in types]
    if values.dtype in allowed:
        return values
    if values.dtype.kind == "b":
        return values.astype(np.uint8)
    if values.dtype.kind in "iu":
        low, high = (int(values.min()), int(values.max())) if values.size else (0, 0)
        for t in allowed:
            if t.kind in "iu" and t.itemsize == 4 and np.iinfo(t).min <= low and high <= np.iinfo(t).max:
                return values.astype(t)
    return values.astype(np.float64)


def units_text(units: Mapping[str, str]) -> str:
    """Name, unit and sign of each field as one line of JSON in plain ASCII."""
    return json.dumps(dict(units))
