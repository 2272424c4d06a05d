"""Metric geometry of surfaces and finite metric spaces: distances in, curvature and shape distance out.

Every public name is listed here and loaded on first use.
"""

from __future__ import annotations

import importlib
from typing import Any

from rinow._version import __version__

_HOME = {
    "ConvergenceError": "errors",
    "FileFormatError": "errors",
    "IntrinsicMesh": "mesh",
    "InvalidInputError": "errors",
    "InvalidMeshError": "errors",
    "MissingDependencyError": "errors",
    "NotAMetricError": "errors",
    "RinowError": "errors",
    "TriangleMesh": "mesh",
}

__all__ = ["__version__", *sorted(_HOME)]  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name in _HOME:
        value = getattr(importlib.import_module(f"rinow.{_HOME[name]}"), name)
    elif name == "errors":
        value = importlib.import_module("rinow.errors")
    else:
        raise AttributeError(f"module 'rinow' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
