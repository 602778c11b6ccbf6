"""How two logs of a test begin and end beside each other, as ingest knows it.

Logs that stand elsewhere in some tests than in most were dated by a clock that was not right, or were switched on late
and last as long as ever: by how much is exact, and where heat bears it out the one that the response is not in is
moved. Logs that begin and end together have clocks that agree; those that stand whole hours apart in all tests are
told.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from thermodata.diagnosis.clocks.heat_balance import UNMOVED_S
from thermodata.schema.answers.diagnosis import Artefact, ClockMoved

if TYPE_CHECKING:
    from duckdb import DuckDBPyConnection

    from thermodata.modelling.run import Loaded
    from thermodata.store import Store
    from thermodata.store.ingest.told.clocks.beside_each_other import OddClock
    from thermodata.store.ingest.told.clocks.whole_hours import HoursApart

Key = tuple[str, str]


@dataclass(frozen=True, slots=True)
class OddEnds:
    """In a test the source `late` stands shift_s (> 0) later beside `early` than in most. said: of all such tests,
    with what to try; seen: the same without that. in_place: source -> what `clocks` of the test must say of it, so that
    the two agree [s], where that is more than the shift. stays: a clock of the two is declared for all tests."""

    campaign: str
    test: str
    late: str
    early: str
    shift_s: float
    said: str
    seen: str = ""
    in_place: Mapping[str, float] = field(default_factory=dict)
    stays: bool = False

    @property
    def key(self) -> Key:
        """Campaign and test."""
        return self.campaign, self.test

    def move(self, home: str | None) -> ClockMoved | None:
        """What makes the two agree; None where the response is in neither, and nobody can tell which is off.
        home: the source of the response."""
        if home == self.early:
            return self._clock_moved(self.late, -self.shift_s)
        return self._clock_moved(self.early, self.shift_s) if home == self.late else None

    def _clock_moved(self, source: str, by_s: float) -> ClockMoved:
        return ClockMoved(source=source, campaign=self.campaign, test=self.test, moved_s=by_s)


@dataclass(frozen=True, slots=True)
class Ends:
    """odd: by campaign and test. together: test -> sources whose clocks agree there with all others. hours: campaign ->
    two logs each that stand whole hours apart in all tests."""

    odd: tuple[OddEnds, ...] = ()
    together: Mapping[Key, frozenset[str]] = field(default_factory=dict)
    hours: Mapping[str, Sequence[HoursApart]] = field(default_factory=dict)

    def agree(self, tests: Iterable[Key], sources: Collection[str]) -> bool:
        """Whether the clocks of some sources agree in one of the tests, so that no heat can say that they don't."""
        return any(self.together.get(key, frozenset()).issuperset(sources) for key in tests)

    def is_met(self, clocks: Sequence[ClockMoved]) -> bool:
        """Whether clocks were moved in single tests nearly as some ends say, and not by them."""
        said = [one for home in {s for o in self.odd for s in (o.late, o.early)} for one in self.moves(home)]
        return any(meets(some, clocks) and not any(m in some for m in clocks) for some in said)

    def moves(self, home: str | None) -> list[list[ClockMoved]]:
        """What makes logs agree with that of the response: in some tests one source, by one shift, and so on; but for
        clocks that somebody declared."""
        found: dict[tuple[str, str], list[ClockMoved]] = {}
        for odd in self.odd:
            if not odd.stays and (one := odd.move(home)) is not None:
                found.setdefault((one.source, odd.said), []).append(one)
        return list(found.values())

    def artefacts(self, home: str | None, moved: Sequence[ClockMoved]) -> list[Artefact]:
        """moved: what was. A pair of logs that agrees once another one is moved is not told beside it."""
        by_s = {(m.campaign, m.test, m.source): m.moved_s for m in moved}
        found = []
        for odd in self.odd:
            move = odd.move(home)
            late, early = (by_s.get((*odd.key, source), 0.0) for source in (odd.late, odd.early))
            if move is None and abs(odd.shift_s + late - early) < abs(odd.shift_s) / 2:
                continue
            # what to try is told once, and here it is known which log to move
            said = odd.said if move is None else odd.seen or odd.said
            why = _IN_NEITHER if move is None else _STAYS if odd.stays else _BY_NO_HEAT
            then = f"Nothing was moved for it here, for {why}"
            if move is not None:
                line = f"clocks: {{{move.source}: {odd.in_place.get(move.source, move.moved_s):.0f} s}}"
                then += (
                    f". To try it, write {line} into the line of test '{odd.test}' in the campaign file, then "
                    "thermodata ingest, fit and diagnose again: the smaller error on left-out tests is right"
                )
            if move is not None and move in moved:
                by = f"{move.moved_s / 60:+.3g} min"
                then = f"The choice is made with '{move.source}' moved by {by} there, for {_BY_HEAT}. "
                then += (
                    f"To mend the log too, declare at this test {line}; if the log's own clock was right, "
                    f"clocks: {{{move.source}: 0 s}}, and it is not asked again"
                )
            found.append(_as_artefact(odd.campaign, odd.test, f"{said}. {then}"))
        known = {m.source for m in moved if not m.test}
        return found + [
            _as_artefact(campaign, "", f"{one}. Nothing was moved for it here, for {_BY_NO_HEAT_AT_ALL}")
            for campaign, some in self.hours.items()
            for one in some
            if known.isdisjoint((one.late, one.early))
        ]


def _as_artefact(campaign: str, test: str, why: str) -> Artefact:
    return Artefact(kind="clock_offset", campaign=campaign, test=test, at_s=None, size_um=None, why=why)


UNKNOWN = Ends()
_BY_HEAT = "what the commands of one log warm, by the other one, comes at the right time so"
_BY_NO_HEAT = (
    "what the commands of one log warm, by the other one, does not come at a clearly better time so: too little warms "
    "in the test, or a log was switched on late"
)
_STAYS = (
    "the campaign file declares one of the two clocks for all tests, and what it says of a clock is never overridden: "
    "the line of one test stands in place of that"
)
_BY_NO_HEAT_AT_ALL = (
    "no heat tells which of the two is off: it takes two temperatures of one log that follow the commands of the other"
)
_IN_NEITHER = "the response is in neither log, and nothing tells which of them is off"


def meets(some: Sequence[ClockMoved], clocks: Sequence[ClockMoved]) -> bool:
    """Whether one of the clocks was moved in one of these tests as these say, to within what heat tells a shift by."""
    return any(
        (a.source, a.campaign, a.test) == (b.source, b.campaign, b.test) and abs(a.moved_s - b.moved_s) <= UNMOVED_S
        for a in some
        for b in clocks
    )


def is_alike(some: Sequence[ClockMoved], others: Sequence[ClockMoved]) -> bool:
    """Whether two logs stand elsewhere in the same tests by the same: then it is the response's own that does."""
    tests = [{(m.campaign, m.test) for m in each} for each in (some, others)]
    return tests[0] == tests[1] and abs(some[0].moved_s - others[0].moved_s) <= UNMOVED_S


def ends_of_logs(store: Store, model: Loaded) -> Ends:
    """Of the tests of a model, beside all of their campaigns; but for clocks that somebody declared in that test: what
    is said of all tests says nothing of one that stands elsewhere."""
    from thermodata.store.ingest.told.clocks.beside_each_other import odd_clocks, together
    from thermodata.store.ingest.told.clocks.whole_hours import whole_hours
    from thermodata.view.grid.describe import declared_clocks

    here = {(t.campaign, t.test) for t in model.data.tests}
    with store.reader() as con:
        word = declared_clocks(con, sorted({c for c, _ in here}))
    declared = {
        (t.campaign, t.test, c.source) for t in model.data.tests for c in t.channels.values() if c.clock_declared
    }
    odd: list[OddEnds] = []
    agree: dict[Key, frozenset[str]] = {}
    hours: dict[str, list[HoursApart]] = {}
    for campaign in sorted({c for c, _ in here}):
        rows = _sources_by_test(store, campaign)
        said = {test: {s for c, t, s in declared if (c, t) == (campaign, test) and s} for test in rows}
        agree |= {(campaign, test): sources for test, sources in together(rows, said).items()}
        hours[campaign] = whole_hours(rows, said)
        odd += [
            _as_told(one, campaign, test, word)
            for one in odd_clocks(rows)
            for test in one.tests
            if (campaign, test) in here and word.isdisjoint((campaign, test, s) for s in (one.late, one.early))
        ]
    return Ends(tuple(odd), agree, hours)


def _as_told(one: OddClock, campaign: str, test: str, word: Collection[tuple[str, str, str]]) -> OddEnds:
    """word: the clocks that somebody declared, (campaign, test, source); test '': in all of them."""
    both = (one.late, one.early)
    stays = any((campaign, "", source) in word for source in both)
    in_place = {source: one.in_place(source) for source in both}
    return OddEnds(campaign, test, *both, one.shift_s, str(one), one.seen, in_place, stays)


def _sources_by_test(store: Store, campaign: str) -> dict[str, list[dict[str, Any]]]:
    """Test -> its rows of the table `source`, each with its pauses and how long its files last, as ingest has them."""
    from thermodata.store.ingest.told.clocks.ends import with_lengths, with_pauses

    with store.reader() as con:
        sources, events, files = (
            _by_test(con, f"select * from {what} order by rowid", campaign)
            for what in (
                "source where campaign = ?",
                "quality_event where campaign = ? and flag = 'gap'",
                "file where campaign = ?",
            )
        )
    return with_lengths(with_pauses(sources, events), files)


def _by_test(con: DuckDBPyConnection, asked: str, campaign: str) -> dict[str, list[dict[str, Any]]]:
    from thermodata.store.base.connection import fetch

    found: dict[str, list[dict[str, Any]]] = {}
    for row in fetch(con, asked, [campaign]):
        found.setdefault(row["test"], []).append(row)
    return found
