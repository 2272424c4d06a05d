"""The reference keeps up with the code: names, links between pages, and the modules and tests that pages cite."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DEPARTURES = (ROOT / "docs/explanation/departures.md").read_text(encoding="utf-8")
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])


def test_every_public_name_stands_on_its_page():
    spec = importlib.util.spec_from_file_location("make_names", ROOT / "docs/reference/make_names.py")
    make_names = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(make_names)
    assert make_names.PAGE.read_text(encoding="utf-8") == make_names.page(), "run docs/reference/make_names.py"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text(encoding="utf-8")):
        assert target.startswith("https://") or (page.parent / target).exists(), f"{page.name} links to {target}"


def test_departures_cite_modules_and_tests_that_exist():
    rows = re.findall(r"^\|.*\| ([^|]*) \|$", DEPARTURES, re.MULTILINE)
    cited = [name for row in rows for name in re.findall(r"`([^`]+)`", row)]
    assert len(cited) > 80
    for name in cited:
        path = ROOT / "tests" / name if name.endswith(".py") else ROOT / "src/rinow" / f"{name}.py"
        assert path.exists(), f"departures.md cites {name}"


def test_every_page_is_in_the_table_of_contents():
    contents = (ROOT / "docs/README.md").read_text(encoding="utf-8")
    for page in PAGES:
        place = page.relative_to(ROOT)
        if place.parts[0] == "docs" and page.name != "README.md" and place.parts[1] != "decisions":
            assert f"({place.relative_to('docs')})" in contents, f"docs/README.md does not list {place}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_table_has_a_heading(page):
    """Rows after a blank line are no table without one of their own: they would be shown as text."""
    for table in re.findall(r"(?:^\|.*\n)+", page.read_text(encoding="utf-8"), re.MULTILINE):
        assert re.fullmatch(r"[-:| ]+", table.splitlines()[1]), f"{page.name}: {table.splitlines()[0]}"
