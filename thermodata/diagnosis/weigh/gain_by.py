"""The model's own effects with a gain for each value of a condition: another tool, machine, preload.

One gain for three tools leaves an error that no channel explains, so that no effect of the library can name it. What
is asked is the term's contribution as it is fitted, a column for each value of a condition of the tests.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import InTest
from thermodata.diagnosis.candidates.of_library import UNNAMED
from thermodata.diagnosis.weigh.changed import TIMES, ChangedEffect, EffectOfModel, is_free
from thermodata.diagnosis.weigh.scored import ACTS, Scored
from thermodata.errors import unknown_name
from thermodata.modelling.model_file.values.said_conditions import refuse_unsaid
from thermodata.modelling.terms.bound import OF_TESTS, group_of
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.versions.candidate import gain_by_id, with_gain_by
from thermodata.plugin import Effect, Gain
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import TestData

MOST_VALUES = 8  # of a condition: more are no groups of tests


@dataclass(frozen=True, slots=True)
class GainOfEach(EffectOfModel):
    """A fitted effect as several: what it does in the tests of each value, in the response's unit."""

    values: tuple[str, ...]

    @property
    def meaning(self) -> str:
        return f"{self.fitted.effect.meaning}, with a gain for each of {', '.join(self.values)}"

    @property
    def gains(self) -> tuple[Gain, ...]:
        """How much more than the one gain, as a share of it."""
        return tuple(Gain(v, "1", TIMES, "any", f"more than the one gain, at {v}") for v in self.values)


@dataclass(frozen=True, slots=True, kw_only=True)
class GainByCondition(ChangedEffect):
    """An effect of the model with a gain for each value of a condition, within each of the values that it has a gain
    for already. by: as `gain_by` of a model file has it. alike: conditions that part the tests in the same way."""

    by: str
    alike: tuple[str, ...] = ()

    @property
    def id(self) -> str:
        return gain_by_id(self.term.id, self.by)

    @property
    def becomes(self) -> tuple[str, ...]:
        return (self.term.id,)

    @property
    def gain_by(self) -> str:
        return self.by

    @property
    def protocol(self) -> str:
        return f"the same work with each value of {self.by}"

    def in_test(self, test: TestData) -> InTest:
        """Zero but for the value that the test has."""
        values, value = [g.name for g in self.effect.gains], _condition_value(self.term, self.by, test)
        columns = np.zeros((len(test.t_s), len(values)))
        fitted = self.term.values(test) if value in values else None
        if value in values and fitted is not None and self.term.bound.covers(test) and self.term.bound.has(test):
            gains = np.array([fitted.gains[g.name] for g in self.term.effect.gains])
            columns[:, values.index(value)] = self.term.columns(test) @ np.where(gains == 0, 1.0, gains)
        return lambda p: columns

    def slack_params(self, p: Mapping[str, float]) -> list[dict[str, float]]:
        """None: that the effect may act faster and slower stands among what is known."""
        return []

    def added_to(self, spec: Model) -> Model:
        return with_gain_by(spec, self.term.id, self.by)

    def in_words(self, scored: Scored) -> str:
        """Without gains: beside effects that may act faster and slower, what an effect does in all is hardly known."""
        return self._gains_in_words([f"{' and '.join(self.alike)} part the tests alike"] if self.alike else [])

    def in_version(self, version: Callable[[], FittedResponse], tests: Sequence[TestData]) -> str | None:
        """'spindle_bearing acts with another gain for each conditions.tool (T1 1, T2 0.6 times)': times the largest."""
        term = next((t for t in version().terms if t.id == self.term.id), None)
        times = {} if term is None else _relative_sizes(term, [g.name for g in self.effect.gains], tests)
        if not times:
            return None
        apart = "; " if self.term.bound.spec.gains_by else ", "  # a value of several conditions has commas
        said = apart.join(f"{value} {share:.2g}" for value, share in times.items())
        alike = [f"{' and '.join(self.alike)} part the tests alike"] if self.alike else []
        return self._gains_in_words([f"{said} times", *alike])

    def _gains_in_words(self, more: Sequence[str]) -> str:
        said = f" ({'; '.join(more)})" if more else ""
        return f"{self.term.id} acts with another gain for each {self.by}{said}"


def gains_by_condition(
    fitted: FittedResponse, tests: Sequence[TestData], every: Sequence[TestData]
) -> list[GainByCondition]:
    """Each effect, by each condition that parts the tests in which it acts further than its gains are parted already:
    where it rests, any gain is as good. tests: those that are weighed. every: all of the data, which a model with the
    condition must be able to score; locked ones are read for their conditions only."""
    found = []
    for term in fitted.terms:
        if not is_free(term):
            continue
        mine = _where_it_acts(term, [t for t in tests if term.bound.covers(t)])
        parted: dict[tuple[int, ...], list[str]] = {}
        already = len({term.bound.group(t) for t in mine})
        for by in _conditions([t for t in every if term.bound.covers(t)]):
            groups = [_condition_value(term, by, t) for t in mine]
            values = list(dict.fromkeys(groups))
            if already < len(values) <= MOST_VALUES and len(mine) > len(values):
                parted.setdefault(tuple(values.index(g) for g in groups), []).append(by)
        found += [_candidate(term, by[0], tuple(by[1:]), mine, every) for by in parted.values()]
    return found


def named(fitted: FittedResponse, term: str, by: str, tests: Sequence[TestData]) -> GainByCondition:
    """The one that a user names, whatever its tests say. UsageError: no such effect, or a test without the
    condition."""
    terms = {t.id: t for t in fitted.terms}
    if term not in terms:
        raise unknown_name("effect", term, list(terms), where=f"candidate '{gain_by_id(term, by)}'")
    mine = [t for t in tests if terms[term].bound.covers(t)]
    for name in (*terms[term].bound.spec.gains_by, by):
        refuse_unsaid(name, mine, f"candidate '{gain_by_id(term, by)}'")
    return _candidate(terms[term], by, (), mine, tests)


def _condition_value(term: FittedTerm, by: str, test: TestData) -> str:
    """Of a test, within the values that the term has a gain for already: 'M1, T2'; '' where the test says none."""
    own = term.bound.spec
    if any(group_of(test, name) is None for name in (*own.gains_by, by)):
        return ""
    return replace(term.bound, spec=own.model_copy(update={"gain_by": [*own.gains_by, by]})).group(test)


def _where_it_acts(term: FittedTerm, tests: Sequence[TestData]) -> list[TestData]:
    sizes = [float(np.std(term.contribution(t))) for t in tests]
    return [t for t, size in zip(tests, sizes, strict=True) if size > 0 and size >= ACTS * max(sizes)]


def _conditions(tests: Sequence[TestData]) -> list[str]:
    """Those that every test has: names before numbers, which may act by more than their value; last what only tells
    tests apart."""
    said = {n: isinstance(v, str) for t in tests for n, v in t.conditions.items() if n not in OF_TESTS}
    names = [f"conditions.{n}" for n in sorted(said, key=lambda n: not said[n])]
    return [n for n in (*names, "machine", "campaign") if all(group_of(t, n) not in (None, "") for t in tests)]


def _candidate(
    term: FittedTerm, by: str, alike: tuple[str, ...], tests: Sequence[TestData], every: Sequence[TestData]
) -> GainByCondition:
    groups: dict[str, list[TestData]] = {}
    for test in tests:
        groups.setdefault(_condition_value(term, by, test), []).append(test)
    return GainByCondition(
        cast(Effect, GainOfEach(term, tuple(groups))),
        term.binding,
        term.family,
        log_prior=UNNAMED,
        kin="itself",
        unforetold=_why_unforetold(term, by, groups, every),
        term=term,
        by=by,
        alike=alike,
    )


def _why_unforetold(
    term: FittedTerm, by: str, groups: Mapping[str, Sequence[TestData]], every: Sequence[TestData]
) -> str | None:
    single = {value: some[0] for value, some in groups.items() if len(some) == 1}
    if not single:
        return None
    listed = ", ".join(f"{value} ({test.test})" for value, test in single.items())
    locked = [t.test for t in every if t.role == "locked" and _condition_value(term, by, t) in single]
    ask = f", or ask the locked {' and '.join(locked)} (thermodata confirm)" if locked else ""
    return (
        f"{by} has values that stand in one test only: {listed}; no other test foretells their gain. Run another test "
        f"with each{ask}"
    )


def _relative_sizes(term: FittedTerm, values: Sequence[str], tests: Sequence[TestData]) -> dict[str, float]:
    """What the effect does in the same tests with the gains of each value, by the value with which it does most."""
    known = [t for t in tests if term.bound.covers(t) and term.bound.has(t)]
    does = {}
    for value in values:
        if (own := term.groups.get(value)) is not None and known:
            gains = np.array([own.gains[g.name] for g in term.effect.gains])
            does[value] = np.concatenate([term.bound.columns(t, own.params) @ gains for t in known])
    most = max(does.values(), key=np.linalg.norm, default=np.zeros(0))
    size = float(most @ most)
    return {value: float(one @ most) / size for value, one in does.items()} if size else {}
