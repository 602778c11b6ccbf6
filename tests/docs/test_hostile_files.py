"""What `docs/hostile_files.md` says is held by a test: each that it names is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "hostile_files.md"
NAMED = sorted(set(re.findall(r"`((?:tests|plugins)/[\w/.-]+\.py)::(\w+)`", PAGE.read_text("utf-8"))))


def test_every_point_names_a_test() -> None:
    points = [x for x in PAGE.read_text("utf-8").split("## How it grows")[0].splitlines() if x.startswith("| ")]
    without = [x for x in points if "::test_" not in x and not re.fullmatch(r"\| \w+ \| answer \| test \|", x)]
    assert without == []
    assert len(NAMED) > 60


@pytest.mark.parametrize(("file", "name"), NAMED)
def test_a_test_that_is_named_is_there(file: str, name: str) -> None:
    assert re.search(rf"^\s*def {name}\(", (ROOT / file).read_text("utf-8"), re.MULTILINE)
