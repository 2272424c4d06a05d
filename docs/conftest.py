"""The examples of the documentation are tests; the files that they write go to a folder of their own."""

import pytest


@pytest.fixture(autouse=True)
def _folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
