"""Effects that are identified before the others: on tests of their own, or on another response.

What was found on tests of its own is refined together with all other effects afterwards, those tests included: an
idle test in which the spindle was still warm gives the hall what the spindle did.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.modelling.fit.joint import FitSettings, fit_jointly
from thermodata.modelling.inputs.roles import Key
from thermodata.modelling.terms.bound import PLACE, BoundResponse
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.terms.usable import usable_tests
from thermodata.schema.answers.result import Check
from thermodata.schema.words.sentences import in_percent
from thermodata.view.grid.dataset import Dataset, TestData

MOVED = 0.2  # of what the effect itself does in its own tests


@dataclass(frozen=True)
class Stage:
    """bound: the response that the members are identified on, with all terms; members: places of terms."""

    bound: BoundResponse
    members: tuple[int, ...]
    tests: tuple[TestData, ...]


def stages_of(bound: BoundResponse, tests: Sequence[TestData], data: Dataset | None) -> list[Stage]:
    """In the order of the file; effects with the same tests and response are identified together. All phases of a
    stage's tests count: an idle test has no heating. data: where tests are that are not among `tests`."""
    pool = tests if data is None else data.tests
    members: dict[tuple[frozenset[Key] | None, tuple[tuple[str, str], ...] | None], list[int]] = {}
    for i, term in enumerate(bound.terms):
        if term.calibrate is not None or term.seen_at is not None:
            seen = None if term.seen_at is None else tuple(term.seen_at.items())
            members.setdefault((term.calibrate, seen), []).append(i)
    stages = []
    for (own, seen), places in members.items():
        where = bound
        if seen is not None:
            where = replace(bound, name=seen[0][1], unit=bound.units.get(seen[0][1], bound.unit), channels=dict(seen))
        keys = {t.key for t in tests} if own is None else own
        stages.append(Stage(where, tuple(places), tuple(t for t in pool if t.key in keys)))
    return stages


def refined(
    bound: BoundResponse,
    fitted: Mapping[int, FittedTerm],
    tests: Sequence[TestData],
    stages: Sequence[Stage],
    how: FitSettings,
) -> dict[int, FittedTerm]:
    """All terms together, from where each was found. Held stay effects seen on another response, effects whose own
    tests lack a driver of another term, and all where the model counts some phases only (an idle test has none)."""
    own = [s for s in stages if s.bound.name == bound.name]
    joined = {_at_its_place(t): t for t in tests}
    free = {i for i in fitted if not any(i in s.members for s in stages)}
    for stage in own:
        usable, lacking = usable_tests(bound, stage.tests)
        if usable and not lacking and how.wanted is None:
            joined |= {_at_its_place(t): t for t in usable}
            free |= set(stage.members)
    parts = [set(s.members) & free for s in own] + [free - {i for s in own for i in s.members}]
    if not any(parts[:-1]) or sum(bool(part) for part in parts) < 2:
        return dict(fitted)
    held = {i: term for i, term in fitted.items() if i not in free}
    found = fit_jointly(bound, sorted(free), held, list(joined.values()), replace(how, near=fitted))
    alone = {i: fitted[i].groups for s in own for i in s.members if i in free}
    return {**held, **{i: replace(term, alone=alone.get(i)) for i, term in found.items()}}


def _at_its_place(test: TestData) -> tuple[Key, object]:
    """A test stands once for each response, where several are fitted together."""
    return test.key, test.conditions.get(PLACE)


def moved_as_well(response: FittedResponse, stages: Sequence[Stage]) -> Iterator[Check]:
    """What else acted in the tests that an effect was identified on by itself, by the model as fitted."""
    for stage in stages:
        for i in stage.members:
            term = response.terms[i]
            mine = _size(term, stage.tests)
            for k, other in enumerate(response.terms):
                size = 0.0 if k in stage.members else _size(other, stage.tests)
                if mine > 0 and size > MOVED * mine:
                    yield _row(term, other, size / mine, stage)


def _row(term: FittedTerm, other: FittedTerm, ratio: float, stage: Stage) -> Check:
    drivers = ", ".join(other.binding.values()) or other.id
    names = ", ".join(t.test for t in stage.tests)
    then = "it is held as found there: name tests in which only its own driver moves"
    if term.alone is not None:
        gain = next(iter(term.effect.gains)).name
        first = next(iter(term.alone.values())).gains[gain]
        then = f"refined with all effects together, {gain} went from {first:.4g} to {term.gains[gain]:.4g}"
    return Check(
        name=f"moved_as_well:{term.id}:{other.id}",
        value=ratio,
        threshold=MOVED,
        passed=False,
        advice=f"{drivers} moved as well in {names}, where {term.id} was identified by itself: {other.id} did "
        f"{in_percent(ratio)} of what {term.id} did; {then}",
    )


def _size(term: FittedTerm, tests: Sequence[TestData]) -> float:
    """rms of a term's contribution about its mean in each test."""
    squares = [np.var(term.contribution(t)[t.in_window]) for t in tests if term.bound.covers(t) and term.can_predict(t)]
    return float(np.sqrt(np.mean(squares))) if squares else 0.0
