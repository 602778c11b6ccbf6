"""Which of two that explain nearly the same is taken: a name over a lag, fewer channels over more, and what makes heat
over what follows it."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.diagnosis.candidates.kin import refines
from thermodata.diagnosis.claims.probability import limit_of, probability
from thermodata.diagnosis.claims.refinement import is_surely_missing
from thermodata.diagnosis.question.present import CONTROL, GENERIC, TIME_UNITS
from thermodata.diagnosis.weigh.ranking import Ranked
from thermodata.diagnosis.weigh.scored import Scored

# a name, or fewer channels, is worth this share of the evidence: what a lag explains as well is not the lag's own
NAMED_SHARE = 0.95
ALIKE_SHARE = 0.8  # the same for a name on another channel, or beside a passive lag, that acts alike (cosine)
ALIKE = 0.8
FEWER_SHARE = 0.8
CAUSE_SHARE = 0.8  # and a cause, beside an effect of the model that acts otherwise: tests differ in much else
AT_ONCE_SHARE = 0.9  # and one that acts at once, on the same channels, where a lag can't be quick enough
UNNAMED = (GENERIC, CONTROL)
# a twin (cosine) that is nearly as likely, and leaves so much less of tests that are left out: a speed and the
# temperature of the body that it heats differ in little else
TWIN, FORETELLS = 0.9, 0.8


def preferred(ranked: Sequence[Scored]) -> Scored | None:
    """The most likely, unless one that shares a channel with it has a name, needs fewer channels, or acts at once where
    the other is as quick as it can be, and is nearly as likely."""
    if not ranked:
        return None
    best = ranked[0]
    own = set(best.candidate.channels)
    for other in (s for s in ranked[1:] if len(s.shape) and not s.candidate.within):
        theirs = set(other.candidate.channels)
        plainer = best.candidate.family in UNNAMED or other.candidate.effect.name in refines(best.candidate.effect)
        fewer = theirs < own and plainer
        named = best.candidate.family in UNNAMED and other.candidate.family not in UNNAMED and own & theirs
        elsewhere = (
            best.candidate.family in UNNAMED
            and other.candidate.family not in UNNAMED
            and (best.candidate.passive or len(other.candidate.channels) == 1)
            and abs(float(best.shape @ other.shape)) > ALIKE
        )
        if (
            (fewer and other.evidence >= FEWER_SHARE * best.evidence)
            or (best.candidate.within and other.evidence >= CAUSE_SHARE * best.evidence)
            or _is_cause_of_mode(best, other)
            or (named and other.evidence >= NAMED_SHARE * best.evidence)
            or (elsewhere and other.evidence >= ALIKE_SHARE * best.evidence)
            or _at_once(best, other)
        ):
            return other if not fewer else preferred([other, *(s for s in ranked if s is not other and s is not best)])
    return best


def _is_cause_of_mode(own: Scored, other: Scored) -> bool:
    """Whether one is another mode of what the model has, and the other, by its channel and more, a cause that is surely
    missing, nearly as likely, and acts alike: the air up there, beside the air down here, is the difference of both."""
    mode, cause = own.candidate, other.candidate
    more = set(mode.channels) < set(cause.channels) and cause.family not in UNNAMED
    apart = mode.kin == "same" and cause.kin in ("near", "related", None)
    likely = other.evidence >= CAUSE_SHARE * own.evidence
    alike = abs(float(own.shape @ other.shape)) > ALIKE
    return apart and more and likely and alike and is_surely_missing(other)


def _at_once(own: Scored, other: Scored) -> bool:
    """Whether the other, on the same channels and nearly as likely, has no time constant, and one's own is the shortest
    that is asked of it: heat takes its time."""
    times = [p.name for p in own.candidate.effect.params if p.unit in TIME_UNITS]
    if not times or any(p.unit in TIME_UNITS for p in other.candidate.effect.params):
        return False
    if set(own.candidate.channels) != set(other.candidate.channels) or other.evidence < AT_ONCE_SHARE * own.evidence:
        return False
    points, point = own.columns.points, own.columns.points[own.weighed.best[0]]
    return all(point[t] <= min(p[t] for p in points) for t in times)


def better_twin(own: Scored, ranked: Sequence[Scored]) -> Scored | None:
    """What acts alike, has a name, nearly as much evidence and no less probability, and foretells left-out tests much
    better; the best of these. The air takes nobody's place: beside what is sharper it may be what that one leaves."""
    kin = (None, own.candidate.kin)
    twins = [
        s
        for s in ranked
        if s.columns is not own.columns
        and len(s.shape)
        and not s.candidate.within
        and s.candidate.family not in UNNAMED
        and s.candidate.kin in kin
        and s.evidence >= NAMED_SHARE * own.evidence
        and abs(float(own.shape @ s.shape)) > TWIN
        and s.error_of_all <= FORETELLS * own.error_of_all
        and probability(s) >= probability(own)
        and (own.candidate.around or not s.candidate.around)
    ]
    return min(twins, key=lambda s: s.error_of_all, default=None)


def what_warms_it(own: Scored, ranked: Sequence[Scored]) -> Scored | None:
    """Beside what is read at a tool, at what holds the probes, or at a body that makes no heat: the likeliest that acts
    alike, has a name and makes heat, with no less evidence and no less probability. What is warm for it tells of it."""
    if not (own.candidate.of_holder or own.candidate.passive):
        return None
    return next(
        (
            s
            for s in ranked
            if len(s.shape)
            and s.candidate.family not in UNNAMED
            and s.candidate.kin is None
            and not (s.candidate.within or s.candidate.of_holder or s.candidate.passive or s.candidate.around)
            and s.evidence >= own.evidence
            and abs(float(own.shape @ s.shape)) > TWIN
            and probability(s) >= probability(own)
        ),
        None,
    )


def read_alone(own: Scored, ranked: Sequence[Scored]) -> Scored | None:
    """Beside what may not be claimed, for the model reads it already together with others: the likeliest that is the
    same effect by a channel of its own, acts alike, and may be claimed. Of three sensors in one air the gradient of the
    model reads two."""
    if own.candidate.kin != "part" or probability(own) >= limit_of(own):
        return None
    return next(
        (
            s
            for s in ranked
            if len(s.shape)
            and s.candidate.effect.name == own.candidate.effect.name
            and abs(float(own.shape @ s.shape)) > TWIN
            and probability(s) >= limit_of(s)
        ),
        None,
    )


def gives_way(own: Scored, best: Scored, ranking: Ranked) -> bool:
    """Whether a member is swapped for the preferred of those ranked beside the others."""
    better = (_drove_out(own, best, ranking) or _is_clearly_likelier(best, own)) and _foretells_more(best, own)
    return better or is_its_name(own, best) or _at_once(own, best) or _is_cause_of_mode(own, best)


def its_name(own: Scored, ranked: Sequence[Scored]) -> Scored | None:
    """The likeliest effect with a name that a lag stands for, whatever else is preferred to both."""
    return next((s for s in ranked if len(s.shape) and is_its_name(own, s)), None)


def is_its_name(own: Scored, best: Scored) -> bool:
    """Whether a lag stands for an effect with a name that is as likely on the same channels, or nearly so: the same
    equation on two grids of time constants differs by as much."""
    mine, theirs = own.candidate, best.candidate
    lag = mine.family in UNNAMED and not mine.within and theirs.family not in UNNAMED and not theirs.within
    same = set(mine.channels) == set(theirs.channels)
    return lag and same and best.evidence >= NAMED_SHARE * own.evidence and best.drop >= NAMED_SHARE * own.drop


def _drove_out(own: Scored, best: Scored, ranking: Ranked) -> bool:
    """Whether a lag is the likeliest, and a name is preferred to it."""
    lag = own.candidate.family in UNNAMED and not own.candidate.within
    return lag and ranking.ranked[0].columns is own.columns and best.columns is not own.columns


def _foretells_more(best: Scored, own: Scored) -> bool:
    """Left-out tests, or nearly as much where its rival could be no cause."""
    return best.drop > own.drop or (own.candidate.passive and best.drop >= NAMED_SHARE * own.drop)


def _is_clearly_likelier(best: Scored, own: Scored) -> bool:
    return best.columns is not own.columns and own.evidence < NAMED_SHARE * best.evidence
