"""Clocks that may be off and that an answer did not move."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.schema.answers.diagnosis import Artefact, PutRight


def clocks_in_doubt(artefacts: Sequence[Artefact], put_right: PutRight | None) -> list[str]:
    """The tests in which one may be off, each once; 'all tests' for one that is of a campaign."""
    moved = [] if put_right is None else put_right.clocks
    places = {(c.campaign, c.test) for c in moved}
    open_still = [a for a in artefacts if a.kind == "clock_offset"]
    open_still = [a for a in open_still if not places & {(a.campaign, a.test or ""), ("", ""), (a.campaign, "")}]
    return list(dict.fromkeys(a.test or "all tests" for a in open_still))
