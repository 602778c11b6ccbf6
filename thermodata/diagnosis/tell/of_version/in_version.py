"""How an effect of the model acts otherwise, by the version that would have it: what is told is what `add` makes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from thermodata.diagnosis.tell.of_version.together import Refit
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.weigh.changed import ChangedEffect
from thermodata.errors import ThermodataError
from thermodata.view.grid.dataset import TestData


def told_by_versions(judgement: Judgement, refit: Refit, tests: Sequence[TestData]) -> Judgement:
    """With the words of each refinement by the version with it and all that is claimed."""
    for one in judgement.refinements:
        if words := _difference_in_version(one, judgement, refit, tests):
            judgement = _with_member(judgement, one, replace(one, refines=words))
    return judgement


def _with_member(judgement: Judgement, old: Judged, new: Judged) -> Judgement:
    """With one member in place of another, wherever it stands."""
    refinements, judged = (
        tuple(new if j is old else j for j in some) for some in (judgement.refinements, judgement.judged)
    )
    return replace(judgement, refinements=refinements, judged=judged)


def _difference_in_version(one: Judged, judgement: Judgement, refit: Refit, tests: Sequence[TestData]) -> str | None:
    candidate = one.scored.candidate
    if not isinstance(candidate, ChangedEffect):
        return None
    try:
        return candidate.in_version(partial(refit, [*(j.scored.candidate for j in judgement.claims), candidate]), tests)
    except ThermodataError:  # no open test has all of their channels
        return None
