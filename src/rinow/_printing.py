"""How results and meshes print: one line, numbers as they are, long arrays by their shape; counts in words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, cast

import numpy as np

__all__ = ["OneLine", "counted"]

MOST_NUMBERS = 6
"""Longer arrays are printed by their shape."""


class OneLine:
    """Base of frozen dataclasses whose `repr` is one line that says what there is, whatever the size of the input."""

    __slots__ = ()

    def __repr__(self) -> str:
        parts = (f"{field.name}={_brief(getattr(self, field.name))}" for field in fields(cast(Any, self)))
        return f"{type(self).__name__}({', '.join(parts)})"


def _brief(value: Any) -> str:
    """Numbers and short arrays as they are, a longer array by its type and shape."""
    if isinstance(value, np.generic):
        return repr(value.item())
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{name!r}: {_brief(item)}' for name, item in value.items())}}}"
    shape = getattr(value, "shape", None)
    if shape is None:
        return repr(value)
    if isinstance(value, np.ndarray) and value.ndim <= 1 and value.size <= MOST_NUMBERS:
        return repr(value.tolist())
    kind = value.dtype.type.__name__.rstrip("_") if isinstance(value, np.ndarray) else type(value).__name__
    return f"<{kind} {' x '.join(map(str, shape))}>"


def counted(n: int, one: str, many: str) -> str:
    """A number, and what it counts: the words for one, or those for any other number."""
    return f"{n} {one if n == 1 else many}"
