"""The body of a PLY file: records of numbers and lists, taken as arrays, without a copy where all have one layout."""

from __future__ import annotations

from collections.abc import Container
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import read_only
from rinow.errors import FileFormatError
from rinow.io.ply_header import Element, Header
from rinow.io.polygons import Runs
from rinow.io.text_numbers import numbers_of_file
from rinow.kernels.records import gather_spans, list_spans

__all__ = ["body_bytes", "read_element"]

Indices = NDArray[np.intp]

_NONE = -1
"""Number of no property."""


def body_bytes(path: Path, header: Header) -> NDArray[np.uint8]:
    """The bytes after the header; of a text file the bytes of its numbers as float64.

    Raises
    ------
    FileFormatError
        If the file is too small for what its header promises; nothing is allocated then.
    """
    size = path.stat().st_size - header.size
    promised = sum(element.smallest_size for element in header.elements)
    if header.byte_order is None:
        promised = promised // 4 - 1  # a number of 8 bytes needs a digit and a blank, the last one no blank
    if size < promised:
        raise FileFormatError(
            f"the header promises at least {promised} bytes, but {size} follow; the file is truncated, copy it again."
        )
    if header.byte_order is None:
        return read_only(numbers_of_file(path, header.size).view(np.uint8))
    return np.asarray(np.memmap(path, np.uint8, "r", header.size)) if size else read_only(np.empty(0, np.uint8))


def read_element(
    data: NDArray[np.uint8], position: int, element: Element, wanted: Container[str] = ()
) -> tuple[dict[str, Runs], int]:
    """The wanted properties of an element whose first record is at `position`, and the position after the last one.

    Raises
    ------
    FileFormatError
        If the data end before the element does.
    """
    numbers = [k for k, p in enumerate(element.properties) if p.name in wanted]
    if element.n_rows == 0 or not element.properties:
        return {element.properties[k].name: Runs(np.empty(0, element.properties[k].item), 1) for k in numbers}, position
    layout = _first_layout(data, position, element)
    end = position + element.n_rows * layout.itemsize
    if end <= len(data):
        records = data[position:end].view(layout)
        if all(bool((records[f"n{k}"] == _n_items(layout, k)).all()) for k in _lists(element)):
            return {element.properties[k].name: _regular_runs(records, k) for k in numbers}, end
    elif not _lists(element):
        raise _truncated(element, (len(data) - position) // layout.itemsize)
    columns: dict[str, Runs] = {}
    for k in numbers or [_NONE]:
        column, end = _walk(data, position, element, k)
        if k != _NONE:
            columns[element.properties[k].name] = column
    return columns, end


def _lists(element: Element) -> list[int]:
    """Numbers of the properties that are lists."""
    return [k for k, p in enumerate(element.properties) if p.length]


def _first_layout(data: NDArray[np.uint8], position: int, element: Element) -> np.dtype:
    """Type of the first record: field nk holds the length of list k, field vk the value or the items of property k."""
    fields: list[tuple[Any, ...]] = []
    for k, p in enumerate(element.properties):
        if p.length is None:
            fields.append((f"v{k}", p.item))
            position += p.item.itemsize
            continue
        start = position + p.length.itemsize
        value = data[position:start].view(p.length)[0] if start <= len(data) else np.inf
        if not (0 <= value <= len(data) - start and value == int(value)):
            raise _truncated(element, 0)
        fields += [(f"n{k}", p.length), (f"v{k}", p.item, (int(value),))]
        position = start + int(value) * p.item.itemsize
    return np.dtype(fields)


def _n_items(layout: np.dtype, k: int) -> int:
    """Length of list k in a layout."""
    return layout[f"v{k}"].shape[0]


def _regular_runs(records: NDArray[Any], k: int) -> Runs:
    """Property k of records that share a layout."""
    values = records[f"v{k}"]
    if values.ndim == 1:
        return Runs(values, 1)
    n_rows, n_items = values.shape
    return Runs(values.reshape(-1), n_items or np.zeros(n_rows, np.intp))


def _walk(data: NDArray[np.uint8], position: int, element: Element, wanted: int) -> tuple[Runs, int]:
    """One property of records whose lists differ in length, and the position after the last record."""
    properties = element.properties
    n = 0 if wanted == _NONE else element.n_rows
    starts, counts = np.empty(n, np.intp), np.empty(n, np.intp)
    rows, end = list_spans(
        data, position, element.n_rows,
        np.array([p.length.itemsize if p.length else 0 for p in properties]),
        np.array([p.item.itemsize for p in properties]),
        any(p.length is not None and p.length.str[0] == ">" for p in properties), wanted, starts, counts,
    )  # fmt: skip
    if rows < element.n_rows:
        raise _truncated(element, int(rows))
    item = np.dtype(np.uint8) if wanted == _NONE else properties[wanted].item
    items = np.empty(int(counts.sum()) * item.itemsize, np.uint8)
    gather_spans(data, starts, counts * item.itemsize, items)
    return Runs(items.view(item), counts), int(end)


def _truncated(element: Element, row: int) -> FileFormatError:
    """The error for data that end inside a row."""
    return FileFormatError(
        f"the data end inside {element.name} {row} of the {element.n_rows} that the header promises; "
        "the file is truncated, copy it again."
    )
