"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import secrets
from collections.abc import Generator, Iterable
from contextlib import contextmanager
from pathlib import Path

from rinow.errors import FileFormatError

__all__ = ["check_target", "check_targets", "replacing"]


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Generator[Path]:
    """Write a file beside its target and put it in place at the end; after a failure nothing is left behind.

    Parameters
    ----------
    path : path
        The file to make or to replace.  A symbolic link stays, its target is replaced.

    Yields
    ------
    temporary : Path
        A name in the same folder with the same suffixes, to be written inside the ``with`` block.

    Raises
    ------
    FileFormatError
        If the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> with replacing(folder / "a.txt") as temporary:
    ...     _ = temporary.write_text("whole")
    >>> [file.name for file in folder.iterdir()]
    ['a.txt']
    """
    check_target(path)
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f".{secrets.token_hex(4)}.{target.name}")
    try:
        yield temporary
        os.replace(temporary, target)
    except OSError as error:
        raise FileFormatError(f"{path} cannot be written: {error.strerror or error}.") from error
    finally:
        temporary.unlink(missing_ok=True)


def check_targets(paths: Iterable[str | os.PathLike[str]], inputs: Iterable[str | os.PathLike[str]]) -> None:
    """Refuse files of which one is an input, is named twice, or cannot be made or replaced.

    Raises
    ------
    FileFormatError
        If that is so, for the first such file.
    """
    sources, seen = {os.path.realpath(path) for path in inputs}, set[str]()
    for path in paths:
        place = os.path.realpath(path)
        if place in sources:
            raise FileFormatError(f"{path} is the input; choose another name for the output.")
        if place in seen:
            raise FileFormatError(f"{path} is named twice as an output; choose another name.")
        seen.add(place)
        check_target(path)


def check_target(path: str | os.PathLike[str]) -> None:
    """Refuse a file that cannot be made or replaced.

    Raises
    ------
    FileFormatError
        If `path` is a folder, a device or write-protected, or if its folder is missing or write-protected.
    """
    target = Path(os.path.realpath(path))
    folder = target.parent
    if target.is_dir():
        raise FileFormatError(f"{path} is a folder; give the name of a file in it.")
    if target.exists() and not target.is_file():
        raise FileFormatError(f"{path} is not a regular file; choose another name.")
    if not folder.is_dir():
        raise FileFormatError(f"{path} cannot be written: the folder {folder} does not exist; make it first.")
    if not os.access(folder, os.W_OK) or (target.exists() and not os.access(target, os.W_OK)):
        raise FileFormatError(f"{path} cannot be written: no permission; choose another folder.")
