"""Of which candidates an answer states a probability, and which of them heads the list."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.probability import probability
from thermodata.diagnosis.claims.rules_together import failed_rules
from thermodata.diagnosis.verdict.judged import Judged
from thermodata.diagnosis.verdict.preference import NAMED_SHARE, UNNAMED
from thermodata.diagnosis.weigh.scored import Scored

Row = tuple[Scored, Judged | None]
"""A candidate, and how it was judged; None where it was not selected."""


def stated(rows: Sequence[Row], measure: Measure, unit: str, *, chosen: bool) -> list[Scored]:
    """Those that keep every rule but that of the probability, and are causes of their own; without what a name among
    them says of the same channels. unit: of the response. chosen: whether anything was."""
    judged = [(s, m) for s, m in causes(rows) if len(s.rows) and is_judged_beside(s, m, chosen=chosen)]
    sound = [(s, m) for s, m in judged if not failed_rules(s, measure, unit)]
    return [s for s, m in sound if m is not None or goes_by_name(s, [t for t, _ in sound]) is None]


def likeliest(rows: Sequence[Row], measure: Measure, unit: str, *, chosen: bool) -> Scored | None:
    """The head of what is not claimed: of what would give most and of all of which a probability is stated; where none
    was judged beside what was chosen, what would give most. rows: by what they would give."""
    told = stated(rows, measure, unit, chosen=chosen)
    own = [(s, m) for s, m in causes(rows) if goes_by_name(s, told) is None]
    most = [s for s, m in own if is_judged_beside(s, m, chosen=chosen)][:1]
    return max([*most, *told], key=probability, default=next((s for s, _ in own), None))


def is_judged_beside(scored: Scored, member: Judged | None, *, chosen: bool) -> bool:
    """Whether it was weighed beside what was chosen, if anything was: what the others of the ranking are beside that
    nobody asked (docs/method.md#probability)."""
    return member is not None or not chosen or bool(scored.others)


def causes(rows: Sequence[Row]) -> list[Row]:
    """Those that refine nothing, nor are a lag of what does."""
    modes = [s for s, m in rows if m is not None and m.refines is not None]
    return [(s, m) for s, m in rows if is_a_cause(s, m) and (m is not None or reads_as(s, modes) is None)]


def is_a_cause(scored: Scored, member: Judged | None) -> bool:
    """Whether it is none that refines the model, nor only warms a body that is one. Of what was not selected nobody
    asked that, so that a mode of what the model has, by its kin, is none."""
    if scored.candidate.within:
        return False
    return scored.candidate.kin not in ("same", "heat") if member is None else not (member.refines or member.warms)


def goes_by_name(scored: Scored, sound: Sequence[Scored]) -> Scored | None:
    """The sound effect with a name that says of the same channels what a lag of them does, and is as evident."""
    return reads_as(scored, [t for t in sound if t.evidence >= NAMED_SHARE * scored.evidence])


def reads_as(scored: Scored, among: Sequence[Scored]) -> Scored | None:
    """The effect with a name of the same channels, where a candidate is a lag or a difference of them."""
    if scored.candidate.family not in UNNAMED:
        return None
    own = set(scored.candidate.channels)
    named = (t for t in among if t.candidate.family not in UNNAMED)
    return next((t for t in named if set(t.candidate.channels) == own), None)


def among(member: Judged | None, some: Sequence[Judged]) -> bool:
    """Whether a member is one of some; what was not selected is none."""
    return any(member is one for one in some)
