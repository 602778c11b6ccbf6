"""What stops the likeliest cause from being claimed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.words.numbers import number
from thermodata.schema.words.sentences import in_percent, listed

if TYPE_CHECKING:
    from thermodata.schema.answers.candidate import Candidate, Rung


def is_likely(one: Candidate | None) -> bool:
    """Whether it is as probable as a claim asks."""
    sure = None if one is None else _sure(one)
    return sure is not None and sure.holds


def stopped(one: Candidate) -> str:
    """': enough for a claim, which asks 65 %, but it makes 2 of 7 tests ...' of what is as probable as a claim asks,
    by the rule that it breaks or the locked tests; of all else what these say against it, '' where nothing."""
    sure, broken = _sure(one), _broken(one)
    enough = sure is not None and sure.holds
    against = _against(one, decides=enough and all(r.holds for r in one.rungs))
    if sure is None or not sure.holds:
        return f", though {against}" if against else ""
    but = list(filter(None, [broken[0].fails if broken else None, against]))
    return f": enough for a claim, which asks {in_percent(sure.limit)}, but {listed(but)}" if but else ""


def _against(one: Candidate, *, decides: bool) -> str:
    """What the locked tests say against it; '' where they don't, or were not opened for it. decides: whether nothing
    else stops it."""
    before, after = one.locked_shape_um_before, one.locked_shape_um_after
    falls = before is None or after is None or after < before
    if not one.locked_tests_asked or (falls and not decides):
        return ""
    figures = "" if before is None else f" ({number(before)} -> {number(after)} um about each one's mean)"
    return f"the locked tests do not bear it out{figures}"


def _sure(one: Candidate) -> Rung | None:
    return next((r for r in one.rungs if r.name == "probability"), None)


def _broken(one: Candidate) -> list[Rung]:
    """The rules that it breaks beside that of its probability; none of an answer that does not say why."""
    return [r for r in one.rungs if not r.holds and r.fails and r.name != "probability"]
