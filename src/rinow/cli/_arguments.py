"""Kinds of arguments that several commands have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

__all__ = ["Flag", "Outputs"]

Flag = Annotated[bool, Parameter(show_default=False)]
"""Off unless named."""
Outputs = Annotated[tuple[Path, ...], Parameter(name=["--output", "-o"], show_default=False)]
"""Files to write, each after an -o of its own."""
