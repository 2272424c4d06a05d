"""Numbers in text, many at a time; the first word that is none is found and named."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from rinow.errors import FileFormatError

__all__ = ["numbers_of_file", "numbers_of_rows", "write_rows"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_BLOCK = 1 << 24
_ROWS = 1 << 16


def numbers_of_file(path: Path, offset: int) -> Floats:
    """All numbers of a text file from a byte on, whatever white space parts them.

    Raises
    ------
    FileFormatError
        If a word is not a number; its line is named.
    """
    blocks: list[Floats] = []
    with path.open("rb") as file:
        line = file.read(offset).count(b"\n") + 1
        while block := file.read(_BLOCK):
            block += file.readline()
            values = _numbers(block)
            if values is None:
                raise _first_fault(block.split(b"\n"), lambda i, first=line: f"line {first + i}")
            blocks.append(values)
            line += block.count(b"\n")
    return np.concatenate(blocks) if blocks else np.empty(0)


def numbers_of_rows(text: bytes, place: Callable[[int], str]) -> tuple[Floats, Indices]:
    """The numbers in lines of text, one line after another, and how many each line has.

    Raises
    ------
    FileFormatError
        If a word is not a number; ``place(i)`` says where line i stands.
    """
    values = _numbers(text)
    if values is None:
        raise _first_fault(text.split(b"\n"), place)
    letters = np.frombuffer(text + b"\n", np.uint8)
    blank = letters <= ord(" ")  # whatever else is not printable is no number either
    starts_word = ~blank
    starts_word[1:] &= blank[:-1]
    ends = np.flatnonzero(letters == ord("\n"))
    counts = np.diff(np.searchsorted(np.flatnonzero(starts_word), ends), prepend=0)
    return values, counts if text else counts[:0]


def _numbers(text: bytes) -> Floats | None:
    """Numbers parted by white space, or None if there is anything else."""
    if not text or text.isspace():
        return np.empty(0)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # numpy < 2.3 warns where it should raise
            return np.fromstring(text, sep=" ")
    except (ValueError, DeprecationWarning):
        return None


def _first_fault(rows: Sequence[bytes], place: Callable[[int], str]) -> FileFormatError:
    """The error for the first word that is not a number."""
    for i, row in enumerate(rows):
        for word in row.split():
            if _numbers(word) is None:
                text = word[:40].decode("utf-8", "replace")
                return FileFormatError(f"{place(i)} has {text!r} where a number belongs; correct it or export again.")
    return FileFormatError("holds a word that is not a number; export it again.")


def write_rows(file: BinaryIO, row_format: str, rows: NDArray[Any]) -> None:
    """Write one line per row; ``%r`` writes the shortest text that reads back as the same float."""
    for start in range(0, len(rows), _ROWS):
        block = rows[start : start + _ROWS]
        file.write((row_format * len(block) % tuple(block.ravel().tolist())).encode("ascii"))
