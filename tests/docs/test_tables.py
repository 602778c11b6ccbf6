"""Tables of the documents render on GitHub: as many cells in every row as in the head."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from thermodata.schema.words.markdown import table

ROOT = Path(__file__).parents[2]
PAGES = sorted([*(ROOT / "docs").glob("*.md"), *ROOT.glob("*.md")])


def cells(line: str) -> int:
    return len(re.split(r"(?<!\\)\|", line.strip().strip("|")))


def broken(text: str) -> list[str]:
    """Rows that do not fit their head, and tables that do not begin after an empty line."""
    lines = re.sub(r"```.*?```", "", text, flags=re.DOTALL).split("\n")
    found = []
    for i, line in enumerate(lines):
        if not re.fullmatch(r"\|[\s|:-]+\|", line) or i == 0:
            continue
        if i > 1 and lines[i - 2].strip():
            found.append(lines[i - 1])
        rows = [lines[i - 1], line]
        for row in lines[i + 1 :]:
            if not row.startswith("|"):
                break
            rows.append(row)
        found += [row for row in rows if cells(row) != cells(line)]
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_tables_render(page: Path) -> None:
    assert broken(page.read_text("utf-8")) == []


def test_a_row_with_another_number_of_cells_is_found() -> None:
    assert broken("\n| a | b |\n|---|---|\n| 1 | 2 |\n| 1 | 2 | 3 |\n") == ["| 1 | 2 | 3 |"]
    assert broken("text\n| a | b |\n|---|---|\n") == ["| a | b |"]


def test_bars_and_line_ends_in_cells_do_not_break_a_table() -> None:
    made = table(("a", "b"), [("|v| ** p", "two\nlines")])
    assert made.splitlines()[2] == r"| \|v\| ** p | two lines |"
    assert broken("\n" + made) == []
