"""docs/papers.md: tables of printed figures beside ours, held to what the tests measure.

THERMODATA_WRITE_PAPERS=1 writes the tables anew, for someone to look at before they are kept.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "papers.md"
Cell = str | float | int | None
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def hold_table(name: str, head: Sequence[str], rows: Sequence[Sequence[Cell]]) -> None:
    """The table below `<!-- NAME -->` says what was measured: words as they are, numbers to one in their last place."""
    table = _written(head, rows)
    page = PAGE.read_text(encoding="utf-8")
    place = re.compile(rf"(<!-- {re.escape(name)} -->\n\n)((?:\|.*\n)*)")
    found = place.search(page)
    assert found, f"{PAGE.name} has no table <!-- {name} -->"
    if os.environ.get("THERMODATA_WRITE_PAPERS"):
        rest = page[found.end() :]
        apart = "" if rest.startswith("\n") else "\n"
        PAGE.write_text(f"{page[: found.start(2)]}{table}{apart}{rest}", encoding="utf-8")
        return
    old, new = found[2].splitlines(), table.splitlines()
    assert len(old) == len(new), f"{name}: {len(new)} lines were measured"
    for stands, measured in zip(old, new, strict=True):
        assert _NUMBER.sub("#", stands) == _NUMBER.sub("#", measured), f"{name}: measured {measured}"
        for a, b in zip(_NUMBER.findall(stands), _NUMBER.findall(measured), strict=True):
            last = 10.0 ** -len(a.partition(".")[2])
            assert float(a) == pytest.approx(float(b), abs=1.01 * last), f"{name}: measured {measured}"


def _written(head: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
    lines = [list(head), ["---" if k == 0 else "---:" for k in range(len(head))]]
    lines += [[_cell(c) for c in row] for row in rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def _cell(value: Cell) -> str:
    if value is None:
        return "-"
    if isinstance(value, str):
        return value
    return f"{value:.0f}" if abs(value) >= 10 else f"{value:.2f}"
