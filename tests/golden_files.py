"""The files of `tests/golden`."""

import json
from pathlib import Path


def golden(name):
    """The content of a file of golden values."""
    return json.loads((Path(__file__).parent / "golden" / f"{name}.json").read_text())
