"""Two logs that begin and end together but for one test, or some, where both ends are off by the same: a wrong clock.

A log that was switched on late begins late and ends when it always does; one that lasts as long as ever, and stands
elsewhere, was dated by a clock that was not right.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from itertools import combinations

import numpy as np

from thermodata.plugin import Float2D
from thermodata.schema.words.durations import how_long
from thermodata.schema.words.sentences import listed
from thermodata.store.ingest.told.clocks.ends import LEAST_S, Rows, ends_of, pairs
from thermodata.store.ingest.told.clocks.whole_hours import whole_hours

APART = 10.0  # by so many times what the ends of the other tests differ by both ends are off, and by LEAST_S
OTHERS = 3  # tests in which both stand as they always do
BOTH = 0.1  # by how much, as a share of it, the shifts of both ends may differ


Declared = Mapping[str, Mapping[str, float]]  # test -> source -> what its `clocks` add to the times [s]


@dataclass(frozen=True, slots=True)
class OddClock:
    """Tests in which the source `late` stands shift_s (> 0) later beside `early` than in the others, no fewer ones.
    added: test -> source -> what its clock was given there [s], which `clocks` of that test stands in place of."""

    tests: tuple[str, ...]
    late: str
    early: str
    shift_s: float
    others: int
    added: Declared = field(default_factory=dict)

    def __str__(self) -> str:
        late, early = (_line({source: self.in_place(source)}) for source in (self.late, self.early))
        return (
            f"{self._shift(self.tests)}: was a clock set wrongly? "
            f"try at {_these(self.tests)} {late} or {early}, or at "
            "the source clock: {align_to: ..., by: [...]}, which estimates the offset of each test from what both "
            "logged"
        )

    def in_place(self, source: str) -> float:
        """What `clocks` of one of the tests must say of a source, so that the two agree [s]."""
        added = [self.added.get(test, {}).get(source, 0.0) for test in self.tests]
        return float(np.median(added)) + (-self.shift_s if source == self.late else self.shift_s)

    @property
    def seen(self) -> str:
        """What was seen, without what to try."""
        return self._shift(self.tests)

    def beside(self, declared: Declared) -> list[str]:
        """A sentence for the tests in which no clock of the two is declared, and one for each word of the others."""
        told: dict[tuple[tuple[str, float], ...], list[str]] = {}
        for test in self.tests:
            here = declared.get(test, {})
            told.setdefault(tuple((s, here[s]) for s in (self.late, self.early) if s in here), []).append(test)
        return [said for words, tests in told.items() if (said := self._against(dict(words), tuple(tests)))]

    def _against(self, declared: Mapping[str, float], tests: tuple[str, ...]) -> str:
        """What the ends of the logs say against what was declared; '' where it was said that a clock is right."""
        if not declared:
            return str(replace(self, tests=tests))
        if not any(declared.values()):
            return ""
        line = _line(declared)
        moved_s = declared.get(self.late, 0.0) - declared.get(self.early, 0.0)
        if abs(moved_s - self.shift_s) < max(LEAST_S, BOTH * self.shift_s):
            return (
                f"{self._shift(tests)}. That is what {line} at {_these(tests)} moved: as logged, both ends agree here "
                "too, so the line and the ends of the logs contradict each other. Keep it where samples came late "
                "within a log whose clock was right (a buffer), as what they heat or move says; take it out where a "
                "clock was meant"
            )
        here = replace(self, tests=tests, added={t: {**self.added.get(t, {}), **declared} for t in tests})
        tries = [_line({**declared, source: here.in_place(source)}) for source in (self.late, self.early)]
        return (
            f"{self._shift(tests)}, though {line} is declared at {_these(tests)}: was it not enough, or the other way? "
            f"try in its place {' or '.join(tries)}"
        )

    def _shift(self, tests: tuple[str, ...]) -> str:
        names = listed([f"'{t}'" for t in tests])
        return (
            f"test{'' if len(tests) == 1 else 's'} {names}: source '{self.late}' begins and ends "
            f"{how_long(self.shift_s)} later beside '{self.early}' than in the {self.others} other tests, in which "
            "both ends agree"
        )


def _these(tests: tuple[str, ...]) -> str:
    return "this test" if len(tests) == 1 else "each of these tests"


def _line(clocks: Mapping[str, float]) -> str:
    return f"clocks: {{{', '.join(f'{source}: {by_s:.0f} s' for source, by_s in clocks.items())}}}"


def odd_clocks(rows: Rows) -> list[OddClock]:
    """Each as a sentence by `str`. rows: test -> its rows of the table `source`."""
    found = []
    for one, other, apart in pairs(rows):
        if len(apart) > OTHERS and (odd := _tests_apart(np.array(list(apart.values())))) is not None:
            places, shift_s = odd
            late, early = (one, other) if shift_s > 0 else (other, one)
            names = tuple(list(apart)[i] for i in places)
            found.append(
                OddClock(names, late, early, abs(shift_s), len(apart) - len(names), _declared_offsets_s(rows, names))
            )
    return found


def _declared_offsets_s(rows: Rows, tests: Collection[str]) -> dict[str, dict[str, float]]:
    return {t: {r["source"]: r.get("offset_ns", 0) / 1e9 for r in rows[t]} for t in tests}


def together(rows: Rows, declared: Mapping[str, Collection[str]] | None = None) -> dict[str, frozenset[str]]:
    """Test -> its sources that begin and end with all others of it, as they do in most tests. rows: as above.

    Two logs of another hour do not begin and end together: their clocks agree to within `LEAST_S`. Where they stand
    whole hours apart in all tests, that is what they do in most, and no sign that they agree, unless somebody said so.
    declared: test -> the sources of whose clocks there somebody has said something.
    """
    ends = {test: ends_of(of_test) for test, of_test in rows.items()}
    hours_apart = {frozenset((told.late, told.early)) for told in whole_hours(rows, declared)}
    found = {test: set(of_test) for test, of_test in ends.items() if len(of_test) > 1}
    for one, other in combinations(sorted({s for of_test in ends.values() for s in of_test}), 2):
        tests = [t for t, of_test in ends.items() if one in of_test and other in of_test]
        apart = {
            t: np.array([ends[t][one].first - ends[t][other].first, ends[t][one].last - ends[t][other].last])
            for t in tests
        }
        usual = np.zeros(2)
        if len(tests) > OTHERS and {one, other} not in hours_apart:
            usual = np.median(list(apart.values()), axis=0)
        for test, by in apart.items():
            if np.abs(by).max() > LEAST_S and np.abs(by - usual).max() > LEAST_S:
                found[test] -= {one, other}
    return {test: frozenset(sources) for test, sources in found.items() if sources}


def _tests_apart(apart: Float2D) -> tuple[list[int], float] | None:
    """(which tests, by how much [s]). apart: how much later one log begins and ends than the other, shape (tests, 2).

    The tests are parted where their ends lie furthest apart; the larger part is right, of two alike the first one.
    """
    middle = apart.mean(axis=1)
    order = np.argsort(middle, kind="stable")
    cut = int(np.argmax(np.diff(middle[order]))) + 1
    parts = sorted((order[:cut], order[cut:]), key=lambda part: (len(part), -int(part.min())))
    odd, usual = parts
    if len(usual) < OTHERS:
        return None
    off = apart - np.median(apart[usual], axis=0)
    size = float(np.abs(off[odd]).min())
    alike = bool(np.ptp(off[odd]) <= BOTH * size) and len(set(np.sign(off[odd]).ravel().tolist())) == 1
    far = size >= max(LEAST_S, APART * float(np.abs(off[usual]).max()))
    return (sorted(odd.tolist()), float(off[odd].mean())) if alike and far else None
