"""Versions of a model on the tests that all of them predict: an error over other tests is another error."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from thermodata.schema.answers.result import Check, LostTest, Score

Course = tuple[str, str, str]
"""(campaign, test, response)."""


def predicted(scores: Iterable[Score]) -> dict[Course, str]:
    """What has an error over the whole test -> its role."""
    return {
        (s.campaign, s.test, s.response): s.role for s in scores if s.phase == "all" and s.rmse_um is not None and s.n
    }


def on_common(versions: Sequence[Sequence[Score]]) -> list[list[Score]]:
    """Each version's scores of the tests that are predicted by all versions which have that response at all."""
    known = [predicted(scores) for scores in versions]
    names = [{s.response for s in scores} for scores in versions]
    every = {key for each in known for key in each}
    common = {key for key in every if all(key in each for each, has in zip(known, names, strict=True) if key[2] in has)}
    return [[s for s in scores if (s.campaign, s.test, s.response) in common] for scores in versions]


def lost_tests(before: Iterable[Score], after: Iterable[Score], checks: Iterable[Check] = ()) -> list[LostTest]:
    """What was predicted before, and is no more. checks: of the fit after, for they say why."""
    from thermodata.schema.answers.result import LostTest

    left = predicted(after)
    why = {c.name.partition(":")[2]: c.advice for c in checks if c.name.startswith(("skipped:", "not_predicted:"))}
    return [
        LostTest(
            campaign=campaign,
            test=test,
            response=response,
            why=why.get(f"{campaign}/{test}", "").removeprefix(f"{campaign}/{test}: ") or None,
        )
        for campaign, test, response in predicted(before)
        if (campaign, test, response) not in left
    ]
