"""What goes wrong with a file, as one sentence that names it."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from rinow.errors import FileFormatError, InvalidInputError, InvalidMeshError, MissingDependencyError, RinowError

__all__ = ["quiet", "reading", "writing"]


@contextmanager
def reading(path: Path, format_name: str) -> Generator[None]:
    """Turn whatever goes wrong inside into a `RinowError` that names the file.

    Readers raise `FileFormatError` with the fault only ("ends inside face 7 of 12"); the name is put before it here.

    Raises
    ------
    FileFormatError
        If the file is missing, empty, no regular file, or has a fault.
    InvalidMeshError
        If its content is no mesh.
    """
    try:
        _check_exists(path)
        with np.errstate(invalid="ignore"):  # a signalling nan in a file is a nan
            yield
    except MissingDependencyError:
        raise
    except InvalidMeshError as error:
        raise InvalidMeshError(f"{path}: {error}") from error
    except (FileFormatError, InvalidInputError) as error:
        raise FileFormatError(f"{path}: {error}") from error
    except MemoryError as error:
        raise FileFormatError(f"{path} needs more memory than this machine has; simplify the mesh.") from error
    except OSError as error:
        raise FileFormatError(f"{path} cannot be read: {error.strerror or error}.") from error
    except Exception as error:  # a library stumbled over the content: its traceback helps nobody
        raise FileFormatError(f"{path} is no intact {format_name} file ({_reason(error)}); export it again.") from error


@contextmanager
def writing(path: Path, format_name: str) -> Generator[None]:
    """Turn whatever a library does wrong inside into a `FileFormatError` that names the file."""
    try:
        yield
    except RinowError:
        raise
    except MemoryError as error:
        raise FileFormatError(f"{path} needs more memory than this machine has; simplify the mesh.") from error
    except Exception as error:
        raise FileFormatError(f"{path} cannot be written as {format_name} ({_reason(error)}).") from error


@contextmanager
def quiet(logger: str = "rinow") -> Generator[None]:
    """Silence the warnings of a library, and its log where it keeps one."""
    log = logging.getLogger(logger)
    before = log.disabled
    log.disabled = True
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        log.disabled = before


def _reason(error: Exception) -> str:
    """What a library says, on one line of moderate length."""
    return " ".join(str(error).split())[:120] or type(error).__name__


def _check_exists(path: Path) -> None:
    """Refuse what is not a file with content."""
    if not path.exists():
        raise FileFormatError("there is no such file; check the name and the folder.")
    if path.is_dir():
        raise FileFormatError("this is a folder; give the name of a file in it.")
    if not path.is_file():
        raise FileFormatError("this is not a regular file; save the mesh to disk first.")
    if path.stat().st_size == 0:
        raise FileFormatError("the file is empty; export it again.")
