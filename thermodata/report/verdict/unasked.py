"""Which locked tests could not be asked, why, and what to do, or that there is none: their silence is no evidence."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.schema.words.sentences import counted, listed, with_count

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.schema.answers.candidate import Candidate
    from thermodata.schema.answers.diagnosis import Diagnosis

_MOST = 3  # tests of one reason
_LOCK_ONE = (
    "measure one more and give it role: locked, or keep one of these back by that, then ingest, fit and diagnose again"
)
_DO = (
    "see the losses that thermodata quality tells, mend these logs or lock a test that has them, then ingest, fit and "
    "diagnose again"
)


def unasked(found: Diagnosis) -> str:
    """'no locked test bears it out, for none could be asked (09_work: no driver for sun (T_hall)): see ...' of a claim,
    or 'for none is locked: measure ...'; '1 locked test could not be asked (...): see ...' beside others, and of what
    is no claim; '' where all could."""
    claims = [c for c in found.candidates if c.claimed]
    if claims and found.locked_tests == 0:
        return f"no locked test bears {_it(claims)} out, for none is locked: {_LOCK_ONE}"
    if not found.locked_unasked:
        return ""
    which = f"could be asked ({_by_reason(found)}): {_DO}"
    if not claims or claims[0].locked_rmse_um_before is not None:
        return f"{counted(len(found.locked_unasked), 'locked test')} {which.replace('could', 'could not', 1)}"
    return f"no locked test bears {_it(claims)} out, for none {which}"


def _it(claims: Sequence[Candidate]) -> str:
    return "it" if len(claims) == 1 else "them"


def _by_reason(found: Diagnosis) -> str:
    """'09_work and 10_mixed: no driver for ambient_frame (T_hall)'."""
    several = len({one.campaign for one in found.locked_unasked}) > 1
    tests: dict[str, list[str]] = {}
    for one in found.locked_unasked:
        tests.setdefault(one.why, []).append(f"{one.campaign}/{one.test}" if several else one.test)
    return "; ".join(f"{_some(names)}: {why}" for why, names in tests.items())


def _some(names: list[str]) -> str:
    return listed(names) if len(names) <= _MOST else with_count(names, _MOST)
