"""The public surface: every name loads, is documented, and stands in the stub for type checkers."""

import importlib
import inspect
import pkgutil
import re
from pathlib import Path

import pytest

import rinow

STUB = Path(rinow.__file__).with_suffix(".pyi").read_text()


def test_stub_lists_the_same_names():
    names = re.findall(r"^from rinow\.\S+ import (\w+) as (\w+)$", STUB, re.MULTILINE)
    assert all(a == b for a, b in names)
    assert sorted(a for a, _ in names) == sorted(rinow.__all__)


@pytest.mark.parametrize("name", [n for n in rinow.__all__ if n != "__version__"])
def test_every_name_loads_and_is_documented(name):
    thing = getattr(rinow, name)
    assert inspect.getdoc(thing)
    assert name in dir(rinow)
    if inspect.isfunction(thing):
        doc = inspect.getdoc(thing) or ""
        for section in ("Parameters", "Returns", "Examples"):
            assert f"{section}\n{'-' * len(section)}" in doc, f"{name} has no section {section}"


def test_unknown_name_raises():
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = rinow.no_such_name


@pytest.mark.parametrize("name", ("curvature", "comparison", "kernels"))
def test_large_packages_say_where_to_find_each_module(name):
    package = importlib.import_module(f"rinow.{name}")
    named = set(re.findall(r"`(\w+)`", inspect.getdoc(package)))
    assert named == {module.name for module in pkgutil.iter_modules(package.__path__)}
