"""What is claimed once the lock is open: what the open tests would claim, and what they leave open."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from thermodata.diagnosis.foretold import Looked
from thermodata.diagnosis.judge import Judged, Judgement, equivalents
from thermodata.diagnosis.probability import probability
from thermodata.diagnosis.rules import blunt
from thermodata.diagnosis.scored import Scored

TWINS_TRIED = 4

# of some members, what the locked tests say of each beside the others; None where there are none
Look = Callable[[Sequence[Judged]], Sequence[Looked] | None]


def kept_where_they_hold(
    judgement: Judgement,
    look: Look,
    may_be: Callable[[Scored], bool],
    conclude: Callable[[tuple[Judged, ...]], Judgement],
    unit: str,
) -> Judgement:
    """The claims, and what is likely, that are probable once the lock is open, each beside the others. The least
    probable of those that fall short goes first, what was only likely before any claim; it gives way to a twin that
    does not fall short. Claims that go are kept as refused, and the verdict is "unknown" where nothing else stands;
    where nothing was claimed before, it is concluded again. may_be: whether a twin keeps the rules itself, and is
    likely. conclude: judges members anew. unit: of the response."""
    asked, claims = [*judgement.claims, *judgement.likely], len(judgement.claims)
    told: dict[int, Judged] = {}
    refused: list[Judged] = []
    untried = set(map(_key, asked))
    while asked:
        said = look(asked)
        if said is None:
            return replace(judgement, likely=())
        asked = _with(asked, said)
        told.update({_key(j): j for j in asked})
        short = [j for j in asked if _falls_short(j)]
        if not short:
            break
        likely = [j for j in asked[claims:] if _falls_short(j)]
        worst = min(likely or short, key=_standing)
        place = asked.index(worst)
        if _key(worst) in untried:
            untried.discard(_key(worst))
            if (twin := _best_twin(asked, place, look, may_be)) is not None:
                asked[place] = twin
                continue
        if place < claims:
            refused.append(worst)
            claims -= 1
        asked.pop(place)
    asked_too = [j for j in judgement.likely if not any(j is one for one in judgement.judged)]
    judged = tuple(told.get(_key(j), j) for j in (*judgement.judged, *asked_too))
    refused.sort(key=lambda j: [_key(c) for c in judgement.claims].index(_key(j)))
    found = replace(judgement, judged=judged, likely=(), refused=tuple(refused))
    if asked:
        return replace(found, verdict="effect", claims=tuple(asked), reason="")
    if refused:
        return replace(found, verdict="unknown", claims=(), reason=_why(refused, unit))
    return replace(conclude(judged), likely=())


def _key(j: Judged) -> int:
    """A member stays the same when a twin takes its place."""
    return id(j.alone.columns)


def _with(asked: Sequence[Judged], said: Sequence[Looked]) -> list[Judged]:
    return [replace(j, scored=replace(j.scored, looked=one)) for j, one in zip(asked, said, strict=True)]


def _falls_short(j: Judged) -> bool:
    return _is_refuted(j) or blunt(j.scored) is not None


def _is_refuted(j: Judged) -> bool:
    return j.scored.looked is not None and j.scored.looked.refuted


def _standing(j: Judged) -> tuple[bool, float]:
    """The least first."""
    return not _is_refuted(j), probability(j.scored)


def _best_twin(asked: Sequence[Judged], place: int, look: Look, may_be: Callable[[Scored], bool]) -> Judged | None:
    """What can't be told apart is one claim, and one member that falls short is no reason against the others."""
    standing = []
    for twin in _twins(asked[place], may_be):
        tried = [*asked[:place], twin, *asked[place + 1 :]]
        told = _with(tried, look(tried) or ())[place]
        if not _falls_short(told):
            standing.append(told)
    return max(standing, key=_standing, default=None)


def _twins(claim: Judged, may_be: Callable[[Scored], bool]) -> list[Judged]:
    own = claim.scored
    # a twin of the model's own effects refines them: it is no cause, however it does on the locked tests
    kin = (None, own.candidate.kin)
    alike = [t for t in equivalents(own, claim.beside) if t.candidate.kin in kin]
    # in its place, the same sharper cause stands beside the twin, and other axes say the same
    placed = [replace(t, beaten=own.beaten, also_on=own.also_on) for t in alike]
    return [replace(claim, scored=twin) for twin in placed if may_be(twin)][:TWINS_TRIED]


def _why(refused: Sequence[Judged], unit: str) -> str:
    """With the errors of the look in which it falls least."""
    names = [j.scored.candidate.id for j in refused]
    explain, them = ("explains", "it") if len(names) == 1 else ("explain", "them")
    said = [f for j in refused if j.scored.looked is not None for f in j.scored.looked.saying]
    least = min(said, key=lambda f: f.fall)
    return (
        f"{' with '.join(names)} {explain} the open tests, but the locked ones do not bear {them} out (error there "
        f"{least.before:.2f} -> {least.after:.2f} {unit})"
    )
