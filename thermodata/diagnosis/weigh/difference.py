"""Differences of two temperatures, as a body that bends, with what each of them does by itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.question.present import GENERIC
from thermodata.diagnosis.weigh.evidence import Columns

LAG = "lag"


def with_sides(pool: Sequence[Columns]) -> list[Columns]:
    """The same, each difference with the lags of its two temperatures, where both are candidates, too."""
    lags = {c.candidate.channels: c for c in pool if c.candidate.effect.name == LAG}

    def told(one: Columns) -> Columns:
        sides = [lags[(n,)] for n in one.candidate.channels if (n,) in lags]
        return replace(one, sides=tuple(sides)) if is_difference(one.candidate) and len(sides) == 2 else one

    return [told(one) for one in pool]


def is_difference(one: CandidateEffect) -> bool:
    """Whether it reads two temperatures and nothing else: its gain is one, so it is of what they differ by."""
    needs = one.effect.needs
    alone = len(needs) == 2 and all(need.quantity == "temperature" for need in needs)
    return alone and one.effect.family != GENERIC and not one.within
