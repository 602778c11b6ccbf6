"""What is claimed once the lock is open: what the open tests would claim, and what they leave open."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from thermodata.diagnosis.claims.probability import limit_of, probability
from thermodata.diagnosis.claims.rules_together import blunt
from thermodata.diagnosis.verdict.judge import causes, equivalents
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.verdict.preference import UNNAMED, is_its_name
from thermodata.diagnosis.weigh.figures import from_to
from thermodata.diagnosis.weigh.foretold import Looked
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.sentences import apart, beside

TWINS_TRIED = 4

# of some members, what the locked tests say of the one at a place beside the others; None where there are none
Look = Callable[[Sequence[Judged], int], Looked | None]


def kept_where_they_hold(
    judgement: Judgement,
    look: Look,
    may_be: Callable[[Scored], bool],
    conclude: Callable[[tuple[Judged, ...]], Judgement],
    unit: str,
) -> Judgement:
    """The claims, and what is likely, that are probable once the lock is open, each beside the others. The least
    probable of those that fall short goes first, what was only likely before any claim; it gives way to a twin that
    does not fall short. What refines the model by the open tests is a claim where nothing of the model can do what it
    does there (`Looked.of_its_own`). Claims that go are kept as refused, and the verdict is "unknown" where nothing
    else stands; where nothing was claimed before, it is concluded again. may_be: whether a twin keeps the rules itself,
    and is likely. conclude: judges members anew. unit: of the response."""
    asked, claims = [*judgement.claims, *judgement.likely], len(judgement.claims)
    unsound = {_member_key(j) for j in judgement.likely} - {_member_key(j) for j in judgement.judged}
    told = {_member_key(j): j for j in judgement.judged}  # as it was looked at last, no twin in its place
    untried = set(map(_member_key, asked))
    refused: list[int] = []
    while asked:
        said = [look(asked, place) for place in range(len(asked))]
        asked = [_with_look(j, one) for j, one in zip(asked, said, strict=True)]
        if any(one is None for one in said):
            return replace(judgement, likely=())
        told.update({_member_key(j): j for j in asked if j.in_place_of is None})
        short = [place for place, j in enumerate(asked) if _falls_short(j, unsound)]
        if not short:
            break
        worst = min([place for place in short if place >= claims] or short, key=lambda place: _standing(asked[place]))
        key = _member_key(asked[worst])
        if key in untried and asked[worst].refines is None:
            untried.discard(key)
            if (twin := _best_twin(asked, worst, look, may_be)) is not None:
                asked[worst] = twin
                continue
        if worst < claims:
            refused.append(key)
            claims -= 1
        asked.pop(worst)
    standing = causes(asked)
    told.update({_member_key(j): j for j in standing})
    judged = tuple(told.values())
    gone = tuple(told[_member_key(c)] for c in judgement.claims if _member_key(c) in refused)
    found = replace(judgement, judged=judged, likely=(), refused=gone)
    if standing:
        told_now = {_member_key(j) for j in standing}
        kept = tuple(j for j in judgement.refinements if _member_key(j) not in told_now)
        return replace(found, verdict="effect", claims=standing, refinements=kept, reason="")
    if gone:
        return replace(found, verdict="unknown", claims=(), reason=_why_refused(gone, unit))
    anew = conclude(tuple(told[_member_key(j)] for j in judgement.judged))
    return replace(anew, judged=judged, likely=())


def _member_key(j: Judged) -> int:
    """A member stays the same when a twin takes its place."""
    return id(j.alone.columns)


def _with_look(j: Judged, said: Looked | None) -> Judged:
    return replace(j, scored=replace(j.scored, looked=said))


def _falls_short(j: Judged, unsound: set[int]) -> bool:
    """unsound: keys of what breaks a rule on the open tests: the locked ones must speak for it."""
    looked = j.scored.looked
    silent = looked is None or not looked.saying or not looked.bears_out
    if j.refines is not None and (looked is None or not looked.of_its_own):
        return True
    return _is_refuted(j) or blunt(j.scored) is not None or (_member_key(j) in unsound and silent)


def _is_refuted(j: Judged) -> bool:
    return j.scored.looked is not None and j.scored.looked.refuted


def _standing(j: Judged) -> tuple[bool, float]:
    """The least first."""
    return not _is_refuted(j), probability(j.scored)


def _best_twin(asked: Sequence[Judged], place: int, look: Look, may_be: Callable[[Scored], bool]) -> Judged | None:
    """What can't be told apart is one claim, and one member that falls short is no reason against the others. A lag
    gives way to its name."""
    names = {j.scored.candidate.id for j in asked}
    found = []
    for twin in _twins(asked[place], may_be, names):
        told = _with_look(twin, look([*asked[:place], twin, *asked[place + 1 :]], place))
        if not _falls_short(told, set()):
            found.append(told)
    best = max(found, key=_standing, default=None)
    return best and next((j for j in found if is_its_name(best.scored, j.scored)), best)


def _twins(claim: Judged, may_be: Callable[[Scored], bool], names: set[str]) -> list[Judged]:
    """Of the same cause: another's heat is another claim, which the open tests would have to make; the locked ones are
    few, and by their errors alone it is mostly chance. names: what is asked already."""
    own = claim.scored
    # a twin of the model's own effects refines them: it is no cause, however it does on the locked tests
    kin, families = (None, own.candidate.kin), _families(own, claim.beside)
    alike = [
        t
        for t in equivalents(own, claim.beside)
        if t.candidate.kin in kin and t.candidate.id not in names and families & _families(t, claim.beside)
    ]
    # in its place, the same sharper cause stands beside the twin, and other axes say the same
    placed = [replace(t, beaten=own.beaten, also_on=own.also_on) for t in alike]
    return [replace(claim, scored=twin, in_place_of=own.candidate.id) for twin in placed if may_be(twin)][:TWINS_TRIED]


def _families(one: Scored, ranked: Sequence[Scored]) -> set[str]:
    """Of a plain function those that have a name by its channels, and the channels themselves."""
    own = one.candidate
    if own.family not in UNNAMED:
        return {own.family, *own.channels}
    named = (s.candidate for s in ranked if set(s.candidate.channels) == set(own.channels))
    return {*(c.family for c in named if c.family not in UNNAMED), *own.channels}


def _why_refused(refused: Sequence[Judged], unit: str) -> str:
    """With the errors of the look in which it falls least."""
    names = [j.scored.candidate.id for j in refused]
    explain, them = ("explains", "it") if len(names) == 1 else ("explain", "them")
    looks = [j.scored.looked for j in refused if j.scored.looked is not None]
    said = [one.least for one in [one for one in looks if one.spoils] or looks]
    least = min((f for f in said if f is not None), key=lambda f: f.fall, default=None)
    there = (
        ""
        if least is None
        else f" (error there, with a free offset a test, {from_to(least.before, least.after, unit)})"
    )
    if len(refused) == 1 and looks and all(f.holds for f in looks[0].saying) and not looks[0].spoils:
        sure, limit = probability(refused[0].scored), limit_of(refused[0].scored)
        return (
            f"{names[0]} explains the open tests, and the locked ones as far as what it does there can{there}, but "
            f"they make it {apart(sure, limit)} probable only ({beside(sure, limit)})"
        )
    return f"{' with '.join(names)} {explain} the open tests, but the locked ones do not bear {them} out{there}"
