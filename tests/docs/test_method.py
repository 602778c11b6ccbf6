"""A number that a page names by its constant is one of the code that it tells of."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
# the folders of the package that hold them: of a verdict, and of what the words of its answers have in common with it
VERDICT = ("diagnosis", "schema/agreed")
PAGES = {
    "method.md": VERDICT,
    "missing_heat.md": VERDICT,
    "artefacts.md": (".",),
    "derivations.md": (".",),
    "model.md": (".",),
}
NAME = re.compile(r"`([A-Z][A-Z_]{3,})`")


def named(text: str) -> set[str]:
    """Constants that a text names in backticks."""
    return set(NAME.findall(text))


@cache
def constants(*rooms: str) -> set[str]:
    """Of all modules of some folders of the package."""
    modules = (p for room in rooms for p in (ROOT / "thermodata" / room).rglob("*.py"))
    trees = (ast.parse(p.read_text("utf-8")) for p in modules)
    assigned = (node for tree in trees for node in tree.body if isinstance(node, ast.Assign))
    return {n.id for one in assigned for target in one.targets for n in ast.walk(target) if isinstance(n, ast.Name)}


@pytest.mark.parametrize("page", PAGES)
def test_every_constant_of_the_page_is_in_the_code(page: str) -> None:
    found = named((ROOT / "docs" / page).read_text("utf-8"))
    assert len(found) > 10
    assert found - constants(*PAGES[page]) == set()


def test_a_constant_that_is_not_there_is_found() -> None:
    assert named("the fall (`DROP_LIMITS`, 15 %)") - constants(*VERDICT) == {"DROP_LIMITS"}


# sizes of caches and pieces, digits of figures, and numbers that stand for a word: no rule of a verdict hangs on them
_TECHNICAL = {
    *("KEPT_BYTES", "NEAR", "PIECE", "WIDE", "SPACES", "AT_ONCE", "DIGITS", "_QUANTILES", "TOLERANCE"),
    *("SELECTED", "ALL_MODES", "_SHOWN", "_PROTOCOL"),
}


def numbers_of_the_diagnosis() -> set[str]:
    """Names of the constants of its modules whose values hold a number."""
    found: set[str] = set()
    for module in (ROOT / "thermodata" / "diagnosis").rglob("*.py"):
        for node in ast.parse(module.read_text("utf-8")).body:
            if not isinstance(node, ast.Assign) or not re.search(r"\d", ast.unparse(node.value)):
                continue
            named_ = [n.id for target in node.targets for n in ast.walk(target) if isinstance(n, ast.Name)]
            found |= {name for name in named_ if re.fullmatch(r"_?[A-Z][A-Z0-9_]*", name)}
    return found


def test_every_number_of_the_diagnosis_has_its_line_on_a_page() -> None:
    """What it is for, and what it was set by; also where that is judgement."""
    pages = "".join(page.read_text("utf-8") for page in (ROOT / "docs").glob("*.md"))
    told = set(re.findall(r"`(_?[A-Z][A-Z0-9_]*)`", pages))
    assert numbers_of_the_diagnosis() - told - _TECHNICAL == set()
    assert numbers_of_the_diagnosis() >= _TECHNICAL
