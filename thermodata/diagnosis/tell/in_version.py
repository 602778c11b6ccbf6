"""How an effect of the model acts otherwise, by the version that would have it: what is told is what `add` makes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from thermodata.diagnosis.tell.together import Refit
from thermodata.diagnosis.verdict.judge import Judged, Judgement
from thermodata.diagnosis.weigh.changed import ChangedEffect
from thermodata.errors import ThermodataError
from thermodata.view.dataset import TestData


def told_by_versions(judgement: Judgement, refit: Refit, tests: Sequence[TestData]) -> Judgement:
    """With the words of each refinement by the version with it and all that is claimed."""
    said = {id(j.scored.columns): words for j in judgement.refinements if (words := _told(j, judgement, refit, tests))}

    def told(some: Sequence[Judged]) -> tuple[Judged, ...]:
        return tuple(replace(j, refines=said.get(id(j.scored.columns), j.refines)) for j in some)

    return replace(judgement, refinements=told(judgement.refinements), judged=told(judgement.judged))


def _told(one: Judged, judgement: Judgement, refit: Refit, tests: Sequence[TestData]) -> str | None:
    candidate = one.scored.candidate
    if not isinstance(candidate, ChangedEffect):
        return None
    try:
        return candidate.in_version(partial(refit, [*(j.scored.candidate for j in judgement.claims), candidate]), tests)
    except ThermodataError:  # no open test has all of their channels
        return None
