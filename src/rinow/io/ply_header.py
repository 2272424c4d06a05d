"""The header of a PLY file: which elements follow, in what number, with which properties."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rinow.errors import FileFormatError

__all__ = ["Element", "Header", "Property", "read_header"]

TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float": "f4", "double": "f8", "float32": "f4", "float64": "f8",
}  # fmt: skip
"""Types by their names in the description of 1994 and by those with a size."""

_BYTE_ORDERS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}
_LARGEST_HEADER = 1 << 24


@dataclass(frozen=True, slots=True)
class Property:
    """A property of an element: a number, or a list led by its length.

    Attributes
    ----------
    name : str
        Its name.
    declared : dtype
        Type in the header, in native byte order.
    item, length : dtype
        Types as stored; `length` is None for a number.  Text is taken as float64 throughout.
    """

    name: str
    declared: np.dtype
    item: np.dtype
    length: np.dtype | None = None

    @property
    def smallest_size(self) -> int:
        """Bytes of the number, or of an empty list."""
        return self.item.itemsize if self.length is None else self.length.itemsize


@dataclass(frozen=True, slots=True)
class Element:
    """A block of `n_rows` records with the same properties."""

    name: str
    n_rows: int
    properties: tuple[Property, ...] = ()

    @property
    def smallest_size(self) -> int:
        """Bytes of the block when all lists are empty."""
        return self.n_rows * sum(p.smallest_size for p in self.properties)

    def find(self, *names: str) -> Property | None:
        """The first property with one of these names."""
        return next((p for p in self.properties if p.name in names), None)


@dataclass(frozen=True, slots=True)
class Header:
    """All a header says; `size` is its length in bytes, `byte_order` None for text."""

    byte_order: str | None
    elements: tuple[Element, ...]
    size: int


def read_header(path: Path) -> Header:
    """Read the header of a PLY file.

    Raises
    ------
    FileFormatError
        If the file does not start with a PLY header, or a line of it has a fault.
    """
    text, size = _header_text(path)
    lines = [line.decode("utf-8", "replace").split() for line in re.split(rb"\r\n|\n|\r", text)]
    orders = [words[1] for words in lines if words[:1] == ["format"] and len(words) == 3]
    if len(orders) != 1 or orders[0] not in _BYTE_ORDERS:
        raise FileFormatError(f"the PLY header needs one format line with one of {', '.join(_BYTE_ORDERS)}.")
    order = _BYTE_ORDERS[orders[0]]
    blocks: list[tuple[str, int, list[Property]]] = []
    for number, words in enumerate(lines, 1):
        match words:
            case [] | ["ply" | "format" | "comment" | "obj_info", *_]:
                continue
            case ["element", name, count] if count.isdecimal() and len(count) < 19:
                blocks.append((name, int(count), []))
            case ["property", *declaration] if blocks and (found := _property(declaration, order)):
                blocks[-1][2].append(found)
            case _:
                raise FileFormatError(
                    f"line {number} of the PLY header, {' '.join(words)!r}, has no meaning; correct it."
                )
    _refuse_twins([name for name, _, _ in blocks], "element")
    for name, _, properties in blocks:
        _refuse_twins([p.name for p in properties], f"property of {name}")
    return Header(order, tuple(Element(name, count, tuple(properties)) for name, count, properties in blocks), size)


def _header_text(path: Path) -> tuple[bytes, int]:
    """The lines between the first and the last of the header, and its size with both."""
    with path.open("rb") as file:
        data = file.read(1 << 16)
        first = re.match(rb"ply[ \t]*(\r\n|\n|\r)", data)
        if not first:
            raise FileFormatError("the file does not start with the line 'ply', so it is no PLY file.")
        # A lone \r may end the header before a body that starts with the byte \n: the first line decides.
        end = re.compile(rb"[\r\n]end_header[ \t]*(?:" + first[1] + rb"|\r\n|\n|\r|\Z)")
        while not (last := end.search(data)) and len(data) < _LARGEST_HEADER and (more := file.read(len(data))):
            data += more
    if not last:
        raise FileFormatError("the PLY header has no line 'end_header'; the file is truncated or of another format.")
    return data[: last.start()], last.end()


def _property(declaration: list[str], order: str | None) -> Property | None:
    """The property declared by the words after ``property``, or None if they make none."""

    def stored(kind: str) -> np.dtype:
        return np.dtype("f8" if order is None else order + TYPES[kind])

    match declaration:
        case ["list", length, item, name] if length in TYPES and item in TYPES and TYPES[length][0] in "iu":
            return Property(name, np.dtype(TYPES[item]), stored(item), stored(length))
        case [item, name] if item in TYPES:
            return Property(name, np.dtype(TYPES[item]), stored(item))
        case _:
            return None


def _refuse_twins(names: list[str], kind: str) -> None:
    """Raise if a name occurs twice."""
    name, count = max(Counter(names).items(), key=lambda item: item[1], default=("", 0))
    if count > 1:
        raise FileFormatError(f"the PLY header declares the {kind} {name!r} twice; remove one.")
