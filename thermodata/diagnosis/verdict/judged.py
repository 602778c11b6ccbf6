"""What a verdict holds: its members as they were judged, what is claimed of them, and why."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from thermodata.diagnosis.weigh.scored import Scored

Verdict = Literal["effect", "refine", "none", "unknown", "not_testable"]


@dataclass(frozen=True, slots=True)
class Judged:
    """A sound member of the selection. scored: beside all others. alone: as it was chosen. refines: what it refines of
    the model, in words; None for a cause of its own. beside: all candidates, ranked without it. in_place_of: the id of
    the member, where `scored` is of one that the open tests can't tell from it. like_a_mode: whether it has no
    name, and the tests can't tell it from another mode of what the model has. warms: id of the effect of the body that
    took its place and that of other claims on the locked tests; None for all else."""

    scored: Scored
    alone: Scored
    refines: str | None
    beside: tuple[Scored, ...]
    in_place_of: str | None = None
    like_a_mode: bool = False
    warms: str | None = None


@dataclass(frozen=True, slots=True)
class OneBody:
    """What took the place of several claims. body: id of the effect of its temperature. heats: what was claimed, and
    warms it. left, left_by_heats: errors on the locked tests with the one and with the others, a free offset a test."""

    body: str
    heats: tuple[Judged, ...]
    left: float
    left_by_heats: float


@dataclass(frozen=True, slots=True)
class Judgement:
    """claims: missing causes, in the order of their choice, what the locked tests made one last. refinements: of
    effects that the model has. judged: all members. likely: what would be claimed if the locked tests spoke for it, the
    likeliest first. refused: what would be claimed, but for the locked tests (`opened`). one_body: what took the place
    of several claims on the locked tests; None where nothing did."""

    verdict: Verdict
    claims: tuple[Judged, ...]
    refinements: tuple[Judged, ...]
    judged: tuple[Judged, ...]
    reason: str
    refused: tuple[Judged, ...] = ()
    likely: tuple[Judged, ...] = ()
    one_body: OneBody | None = None

    @property
    def heats(self) -> tuple[Judged, ...]:
        """What was claimed, and only warms one body."""
        return () if self.one_body is None else self.one_body.heats

    @property
    def chosen(self) -> tuple[Judged, ...]:
        """The members that others were weighed beside: what is only offered for the model as it stands is none."""
        return tuple(j for j in self.judged if not j.scored.as_modelled)
