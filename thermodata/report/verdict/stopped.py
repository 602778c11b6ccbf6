"""What stops the likeliest cause from being claimed, and how the locked tests are asked of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.verdict.refined import named
from thermodata.report.verdict.twins import by_name
from thermodata.report.words.numbers import number
from thermodata.schema.agreed.limits import PLAUSIBLE
from thermodata.schema.words.sentences import in_percent, listed

if TYPE_CHECKING:
    from thermodata.schema.answers.candidate import Candidate, Rung
    from thermodata.schema.answers.diagnosis import Diagnosis

BETTER = 0.9
"""What locked tests leave, as a share, is told where it is no more: a smaller fall says little."""


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


def asks_locked(one: Candidate, found: Diagnosis) -> str:
    """'thermodata confirm d8f6a414 lag:T asks the locked tests of it, where there are some', of what one rule alone
    stops, or any where it is as probable as a claim asks, and that they were not opened for; else ''."""
    rules = [r for r in one.rungs if not r.holds]
    close = is_likely(one) or (len(rules) == 1 and (one.probability or 0.0) >= PLAUSIBLE)
    if not rules or not close or one.locked_tests_asked is not None:
        return ""
    some = "" if any(c.locked_tests_asked for c in found.candidates) else ", where there are some"
    return f"thermodata confirm {found.model[:8]} {one.id} asks the locked tests of it{some}"


def better_with(found: Diagnosis, but: Candidate | None) -> str:
    """'the locked tests were opened for turret_heat (T) and get better with it (2.55 -> 2.00 um ...), but ...' of
    what is no claim all the same; '' where there is none. but: what is told already."""
    for one in found.candidates:
        before, after = one.locked_shape_um_before, one.locked_shape_um_after
        broken = next((r.fails for r in one.rungs if not r.holds and r.fails), None)
        if one is but or one.claimed or one.refinement or not one.locked_tests_asked or broken is None:
            continue
        if before is not None and after is not None and after <= BETTER * before:
            figures = f"{number(before)} -> {number(after)} um about each one's mean"
            name = named(one) + (f"{by_name(one)}," if by_name(one) else "")
            return (
                f"the locked tests were opened for {name} and get better with it ({figures}), but {broken}: thermodata "
                f"confirm {found.model[:8]} {one.id} tells what each says"
            )
    return ""


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
