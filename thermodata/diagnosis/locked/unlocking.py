"""The lock is opened for what the open tests claim: what the locked tests bear out of it, and what is asked again.

The answer is asked anew without locked tests in which a probe is turned; without what was refused, where that is all
that was claimed, for it may have stood in the place of what is there; and without several heats of one body.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from thermodata.diagnosis.claims.rules_together import may_be_claimed
from thermodata.diagnosis.locked.confirm import Fits
from thermodata.diagnosis.locked.one_body import one_body
from thermodata.diagnosis.locked.opened import kept_where_they_hold
from thermodata.diagnosis.locked.turned_locked import as_artefacts, turned_locked
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.verdict.judged import Judged, Judgement, OneBody
from thermodata.diagnosis.weigh.foretold import Foretold, Looked
from thermodata.errors import ThermodataError
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.view.grid.dataset import TestData


class Asks(Protocol):
    """Investigates the open tests beside some locked ones."""

    def __call__(
        self, locked: Sequence[TestData], faults: Sequence[Artefact], refused: frozenset[str] = frozenset()
    ) -> Investigation: ...


@dataclass(frozen=True, slots=True)
class Look:
    """tests: that were opened. asked: the ids of what they were opened for."""

    tests: tuple[TestData, ...]
    asked: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Unlocked:
    """judgement: once the lock is open. locked: the tests that were asked, in none of which a probe is turned; turned:
    the keys of those. looks: each time that the lock was opened; none where it stayed shut."""

    investigation: Investigation
    judgement: Judgement
    locked: tuple[TestData, ...]
    turned: tuple[tuple[str, str], ...]
    looks: tuple[Look, ...]


def unlocked(asks: Asks, fits_of: Callable[[Sequence[TestData]], Fits], locked: Sequence[TestData]) -> Unlocked:
    """fits_of: models fitted to the open tests, for some locked ones."""
    faults: list[Artefact] = []
    looks: list[Look] = []

    def opened(refused: frozenset[str] = frozenset()) -> tuple[Investigation, Fits, Judgement]:
        fits, found = fits_of(locked), asks(locked, faults, refused)
        asked = dict.fromkeys(found.looked_for)
        judgement = _judgement_unlocked(found, fits, locked, asked)
        if asked:
            looks.append(Look(tuple(locked), tuple(asked)))
        return found, fits, judgement

    found, fits, judgement = opened()
    turned = _turned_tests(judgement, found, fits, locked)
    if turned:
        locked = [t for t in locked if t.key not in turned]
        faults = as_artefacts(turned, found.problem.response)
        found, fits, judgement = opened()
    if judgement.refused and not judgement.claims:
        second, _, anew = opened(frozenset(c for j in judgement.refused for c in j.scored.candidate.channels))
        if anew.claims and all(j.scored.looked is not None and j.scored.looked.at_second_look for j in anew.claims):
            found, judgement = second, replace(anew, refused=(*judgement.refused, *anew.refused))
    elif (one := _one_body(judgement, found, fits)) is not None:
        second, _, anew = opened(_of_heats(one, judgement))
        if _stands(one.body, anew):
            found, judgement = second, replace(anew, one_body=one, refused=(*judgement.refused, *anew.refused))
    return Unlocked(found, judgement, tuple(locked), tuple(sorted(turned)), tuple(looks))


def _judgement_unlocked(
    found: Investigation, fits: Fits, locked: Sequence[TestData], looked_for: dict[str, None]
) -> Judgement:
    """Where something is claimed or likely. looked_for: takes the ids of what the lock was opened for."""
    judgement, unit = found.on_open, found.problem.unit
    if not judgement.claims and not (locked and judgement.likely):
        return judgement

    def look(some: Sequence[Judged], place: int) -> Looked | None:
        one, others = some[place], [*some[:place], *some[place + 1 :]]
        foretold = found.borne_out(one, others)
        if foretold is None:
            return None
        looked_for.setdefault(one.scored.candidate.id)
        added = fits.foretold([o.scored.candidate for o in others], one.scored.candidate, foretold.tests)
        if added is not None:
            added = replace(added, white=foretold.white)
        return Looked(
            foretold, added, found.measure.said, unit, spoilt(fits, some, place, found.measure.floor_of_samples)
        )

    return kept_where_they_hold(
        judgement, look, lambda twin: may_be_claimed(twin, found.measure, unit), found.conclude, unit
    )


def _one_body(judgement: Judgement, found: Investigation, fits: Fits) -> OneBody | None:
    return None if found.selection is None else one_body(judgement.claims, found.selection.first.ranked, fits)


def _of_heats(one: OneBody, judgement: Judgement) -> frozenset[str]:
    """The channels that the heats of a body read, and what the locked tests have refused already; but for those that
    another claim reads."""
    kept = [j for j in judgement.claims if not any(j.scored is heat.scored for heat in one.heats)]
    gone = {c for j in (*one.heats, *judgement.refused) for c in j.scored.candidate.channels}
    return frozenset(gone.difference(*(j.scored.candidate.channels for j in kept)))


def _stands(body: str, judgement: Judgement) -> bool:
    """Whether it was selected, and not refused by the locked tests."""
    chosen, refused = ({j.scored.candidate.id for j in some} for some in (judgement.chosen, judgement.refused))
    return body in chosen - refused


def spoilt(fits: Fits, some: Sequence[Judged], place: int, floor: float) -> Foretold | None:
    """What all locked tests say of some members together; where they become much worse, of the one at the place alone,
    if any one alone makes them so: what is sound does not go for its neighbour."""
    together = fits.together([j.scored.candidate for j in some])
    if together is None or not together.spoils(floor) or len(some) == 1:
        return together
    each = [fits.together([j.scored.candidate]) for j in some]
    return each[place] if any(one is not None and one.spoils(floor) for one in each) else together


def _turned_tests(
    judgement: Judgement, found: Investigation, fits: Fits, locked: Sequence[TestData]
) -> dict[tuple[str, str], float]:
    """The locked tests that do not bear out what the open ones claim because a probe is turned in them."""
    asked = (*judgement.claims, *judgement.refused)
    if all(j.scored.looked is None or j.scored.looked.bears_out for j in asked):
        return {}
    try:
        claimed = fits.of([j.scored.candidate for j in asked])
    except ThermodataError:  # no open test has all of their channels
        return {}
    return turned_locked(claimed, locked, found.measure.floor_of_samples)
