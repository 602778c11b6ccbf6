"""What is said of a body that took the place of several claims on the locked tests, and of these, which warm it."""

from __future__ import annotations

from thermodata.diagnosis.verdict.judged import Judgement, OneBody
from thermodata.diagnosis.weigh.figures import short
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.sentences import listed


def in_place_of_heats(scored: Scored, judgement: Judgement, unit: str) -> str:
    """'; taken by the locked tests in place of ...' of the body; '' of all else."""
    one = judgement.one_body
    if one is None or one.body != scored.candidate.id:
        return ""
    heats = listed([j.scored.candidate.id for j in one.heats])
    return (
        f"; taken by the locked tests in place of {heats}: these warm it, do the same together in the open tests, and "
        f"leave {short(one.left_by_heats)} {unit} of the locked ones, with a free offset a test, where it leaves "
        f"{short(one.left)} {unit}"
    )


def only_warms(scored: Scored, one: OneBody, unit: str) -> str:
    """Why what was claimed with others is no cause of its own."""
    others = listed([j.scored.candidate.id for j in one.heats if j.scored.columns is not scored.columns])
    return (
        f"with {others} it does in the open tests what {one.body} does alone, which leaves {short(one.left)} {unit} of "
        f"the locked ones in place of {short(one.left_by_heats)} {unit}, with a free offset a test: it warms that body"
    )
