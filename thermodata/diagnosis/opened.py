"""What is kept of the claims once the lock is open."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from thermodata.diagnosis.judge import Judged, Judgement, equivalents
from thermodata.diagnosis.locked import Foretold, Looked
from thermodata.diagnosis.rules import blunt
from thermodata.diagnosis.scored import Scored

TWINS_TRIED = 4


def kept_where_they_hold(
    judgement: Judgement,
    look: Callable[[Sequence[Judged]], Looked | None],
    claimable: Callable[[Scored], bool],
    unit: str,
) -> Judgement:
    """The claims that are probable together once the lock is open, or with a twin in the place of the largest, with the
    fewest doubts; else without the smallest; "unknown" where none is. What goes is kept as refused. look: what the
    locked tests say of some claims; None where there are none. claimable: whether a twin keeps the rules of a claim
    itself. unit: of the response."""
    claims = judgement.claims
    first: Foretold | None = None
    refused: tuple[Judged, ...] = ()
    while claims:
        standing: list[tuple[Judged, ...]] = []
        for tried in (claims, *_with_twins(claims, claimable)):
            found = look(tried)
            if found is None or not found.doubts:
                return replace(judgement, claims=tried, refused=refused[len(tried) :])
            told = tuple(replace(c, scored=replace(c.scored, doubts=found.doubts)) for c in tried)
            if not found.refuted and all(blunt(c.scored) is None for c in told):
                standing.append(told)
            first, refused = first or found.doubting[0], refused or told
        if standing:
            kept = min(standing, key=lambda told: told[0].scored.doubts)
            return replace(judgement, claims=kept, refused=refused[len(kept) :])
        claims = claims[:-1]
    assert first is not None
    names = [c.scored.candidate.id for c in refused]
    explain, it_adds = ("explains", "it adds") if len(names) == 1 else ("explain", "they add")
    reason = (
        f"{' with '.join(names)} {explain} the open tests, but on the locked ones the error does not fall by half of "
        f"what {it_adds} ({first.before:.2f} -> {first.after:.2f} {unit})"
    )
    return replace(judgement, verdict="unknown", claims=(), refused=refused, reason=reason)


def _with_twins(claims: Sequence[Judged], claimable: Callable[[Scored], bool]) -> list[tuple[Judged, ...]]:
    """What can't be told apart is one claim, and one member that does not hold is no reason against the others."""
    largest = claims[0]
    # a twin of the model's own effects refines them: it is no cause, however it does on the locked tests
    kin = (None, largest.scored.candidate.kin)
    alike = equivalents(largest.scored, largest.beside)
    # in its place, the same sharper cause stands beside the twin, and other axes say the same
    own = largest.scored
    placed = [replace(t, beaten=own.beaten, also_on=own.also_on) for t in alike if t.candidate.kin in kin]
    twins = [t for t in placed if claimable(t)]
    return [(replace(largest, scored=twin), *claims[1:]) for twin in twins[:TWINS_TRIED]]
