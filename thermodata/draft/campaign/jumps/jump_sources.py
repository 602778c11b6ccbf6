"""Jump tests beside a workbook whose sheets are tests: its source names the sheet of a test, so they need another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from thermodata.draft.campaign.parts import DraftJump, DraftSource

_TEST = "{test}"


def with_their_sources(
    jumps: Sequence[DraftJump], sources: Sequence[DraftSource]
) -> tuple[list[DraftJump], list[DraftSource]]:
    """(the jump tests, the sources and those that the jump tests need): a source whose table is the sheet of a test
    finds no sheet in a jump test."""
    made, known = list[DraftJump](), list(sources)
    for jump in jumps:
        home = next((s for s in sources if s.name == jump.source), None)
        if home is None or home.table.get("sheet") != _TEST:
            made.append(jump)
            continue
        table = {k: v for k, v in home.table.items() if k != "sheet"} | ({"sheet": jump.sheet} if jump.sheet else {})
        own = next((s for s in known[len(sources) :] if s.reader == home.reader and s.table == table), None)
        if own is None:
            own = DraftSource(_name({s.name.lower() for s in known}), home.reader, None, table=table)
            known.append(own)
        made.append(replace(jump, source=own.name))
    return made, known


def _name(taken: set[str]) -> str:
    return next(n for k in range(1, len(taken) + 2) if (n := "jump" if k == 1 else f"jump{k}") not in taken)
