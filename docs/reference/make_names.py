"""Write names.md: every public name with its parameters or fields, what it is for, and its home.

Run it after a change of a public name, a parameter, or the first line of a docstring.
"""

from __future__ import annotations

import dataclasses
import inspect
from functools import cached_property
from pathlib import Path
from types import FunctionType
from typing import Any

import rinow

PAGE = Path(__file__).with_name("names.md")
GROUPS = {
    "Files, meshes and spaces": ("io", "mesh", "metric_space"),
    "Curvature": ("curvature",),
    "Quadruples, simplices and surfaces of constant curvature": ("embedding",),
    "Geodesics, nets and length spaces": ("geodesics", "nets"),
    "Distances between spaces": ("comparison",),
    "Errors": ("errors",),
}
"""Headings, and the packages of what stands below them."""

METHODS = (FunctionType, classmethod)
MEMBERS = (*METHODS, property, cached_property)

HEAD = """# Public names

Everything that `import rinow` gives. Each name links to its file, whose docstring has shapes, units, degenerate cases,
errors, formula, source and an example; `help(rinow.NAME)` prints it. Parameters after `*` are given by name. Units and
signs stand in [quantities.md](quantities.md). Made by `docs/reference/make_names.py`.
"""


def page() -> str:
    """The whole page."""
    names = [name for name in rinow.__all__ if name != "__version__"]
    parts = [HEAD]
    for title, packages in GROUPS.items():
        things = {name: getattr(rinow, name) for name in names}
        here = {name: thing for name, thing in things.items() if _home(thing).split(".")[1] in packages}
        functions = {name: thing for name, thing in here.items() if inspect.isfunction(thing)}
        classes = {name: thing for name, thing in here.items() if inspect.isclass(thing)}
        parts.append(f"## {title}\n")
        if functions:
            parts.append(_table("call", {name: _call(name, thing) for name, thing in functions.items()}))
        if classes:
            parts.append(_table("class, and what it holds", {name: _fields(thing) for name, thing in classes.items()}))
    return "\n".join(parts)


def _table(title: str, cells: dict[str, str]) -> str:
    rows = [f"| {title} | |", "|---|---|"]
    for name, cell in cells.items():
        thing = getattr(rinow, name)
        home = f"../../src/{_home(thing).replace('.', '/')}.py"
        summary = " ".join((inspect.getdoc(thing) or "").split("\n\n")[0].split())
        rows.append(f"| [`{name}`]({home}){cell} | {summary} |")
    return "\n".join(rows) + "\n"


def _home(thing: Any) -> str:
    return str(thing.__module__)


def _call(name: str, function: Any) -> str:
    bare = [p.replace(annotation=p.empty) for p in inspect.signature(function).parameters.values()]
    return f"`{inspect.Signature(bare)}`"


def _fields(kind: Any) -> str:
    """Fields of a dataclass, then its own properties and methods; members of an enumeration."""
    if issubclass(kind, Exception):
        return ""
    if hasattr(kind, "__members__"):
        held = [f"{name} {int(value)}" for name, value in kind.__members__.items()]
    else:
        held = [field.name for field in dataclasses.fields(kind)] + [
            f"{name}()" if isinstance(value, METHODS) else name
            for name, value in inspect.getmembers_static(kind)
            if not name.startswith("_") and isinstance(value, MEMBERS) and name not in kind.__dataclass_fields__
        ]
    return ": " + ", ".join(f"`{name}`" for name in held)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
