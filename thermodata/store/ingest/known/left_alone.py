"""What an ingest keeps of each test, so that the next one need not look at those whose files were left alone.

All that the summary, the commit and the other tests ask of a test stands here. What depends on other tests too (the
columns of a stream, a clock that is lent, a verdict) is kept as it came out: where it would come out otherwise now,
`OtherwiseError` says so, and every test is looked at.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import Any

from thermodata.calibration.between_tests.levels import Levels
from thermodata.calibration.quality.ends.still import Reading
from thermodata.store.tidy.clock.source_clock import Clock
from thermodata.store.tidy.flags.beside.between import KnownOfTest, Verdict, levels_of

Row = dict[str, Any]
_NO_VERDICT = Verdict()


class OtherwiseError(Exception):
    """What was kept of tests whose files were left alone does not hold beside those that changed."""


@dataclass(slots=True)
class TestNote:
    """Of one test. losses, notes: what was said of it. files: source paths. sources: those with data. lossy: keys of
    raw data with losses of its own, which the first of the tests that have it tells. parts: the store's files and
    their sizes where known. version: of all that a fit depends on; None where nothing was made of the test. tidied:
    whether its streams could be made.

    channels: (source, stream, channel, whether it is text). empty: (source, stream, channel) without any value. clocks,
    lent: those that were estimated, as (offset_ns, drift_ppm, base_ns, suspect, key, notes) before and after the other
    tests were asked. dated: sources with dates of their own. start_s: on the absolute clock. warm: said to have
    started so. courses: (end [s], levels) of each of its tidy files. verdicts: (its channels, verdict) of each stream.
    overruled: which rules of the campaign file found something. heads: channel -> (the unit it was read in, what the
    head of its file says of units), of those whose files say no unit beside.
    """

    __test__ = False
    losses: list[Row] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    samples: int = 0
    flags: dict[str, int] = field(default_factory=dict)
    files: list[str] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)
    lossy: list[str] = field(default_factory=list)
    parts: dict[str, int | None] = field(default_factory=dict)
    version: str | None = None
    tidied: bool = False
    channels: list[list[Any]] = field(default_factory=list)
    empty: list[list[Any]] = field(default_factory=list)
    clocks: dict[str, list[Any]] = field(default_factory=dict)
    lent: dict[str, list[Any]] = field(default_factory=dict)
    dated: list[str] = field(default_factory=list)
    start_s: float | None = None
    warm: bool = False
    quantities: dict[str, str] = field(default_factory=dict)
    powered: list[str] = field(default_factory=list)
    around: list[str] = field(default_factory=list)
    courses: list[list[Any]] = field(default_factory=list)
    verdicts: list[list[Any]] = field(default_factory=list)
    overruled: list[int] = field(default_factory=list)
    heads: dict[str, list[str]] = field(default_factory=dict)

    def to_text(self) -> str:
        """One line."""
        return json.dumps({f.name: getattr(self, f.name) for f in fields(self)})

    @classmethod
    def from_text(cls, line: str) -> TestNote:
        """ValueError for a line of another version: one that lacks a field, or has another."""
        kept = json.loads(line)
        if not isinstance(kept, dict) or kept.keys() != {f.name for f in fields(cls)}:
            raise ValueError("a note of another version")
        return cls(**kept)

    def own_clocks(self) -> dict[str, Clock]:
        """Source -> its clock as the test alone tells it, of those that were estimated."""
        return {name: _clock(kept) for name, kept in self.clocks.items()}

    def levels(self, test: str) -> tuple[Levels, dict[str, Reading]] | None:
        """What its channels were like, for the tests beside it."""
        known = KnownOfTest(test, self.start_s, self.warm, self.quantities, self.powered, self.around)
        return levels_of(known, self.courses)


@dataclass(frozen=True, slots=True)
class LeftAlone:
    """Tests whose files were left alone since they were looked at. before: the others as they were then."""

    tests: Mapping[str, TestNote] = field(default_factory=dict)
    before: Mapping[str, TestNote] = field(default_factory=dict)

    def hold_beside(self, now: Mapping[str, TestNote]) -> None:
        """OtherwiseError where the streams have other columns, or other tests tell of raw data that they share. now:
        the other tests as they are."""
        if not self.tests:
            return
        was, comes = ({**self.tests, **others} for others in (self.before, now))
        if columns_of(n.channels for n in was.values()) != columns_of(n.channels for n in comes.values()):
            raise OtherwiseError("columns")
        shared = {key for others in (self.before, now) for note in others.values() for key in note.lossy}
        if any(shared.intersection(note.lossy) for note in self.tests.values()):
            raise OtherwiseError("losses")

    def stand(self, clocks: Mapping[str, Mapping[str, Clock]], verdicts: Mapping[str, Verdict]) -> None:
        """OtherwiseError where the clocks that tests lend each other, or what they say of each other's channels, are
        not what they were."""
        for name, note in self.tests.items():
            if note.lent != estimated(clocks[name]):
                raise OtherwiseError(f"clocks of {name}")
            verdict = verdicts.get(name, _NO_VERDICT)
            if any(verdict.of(channels).to_json() != kept for channels, kept in note.verdicts):
                raise OtherwiseError(f"verdict on {name}")


def left_alone(lines: Mapping[str, str], looked_at: Collection[str] | None) -> LeftAlone:
    """The tests that need not be looked at. lines: test -> what was noted of it; looked_at: tests with changed files;
    None where all may be other ones."""
    if looked_at is None:
        return LeftAlone()
    try:
        known = {name: TestNote.from_text(line) for name, line in lines.items()}
    except ValueError:  # of another version
        return LeftAlone()
    return LeftAlone(
        {name: note for name, note in known.items() if name not in looked_at},
        {name: note for name, note in known.items() if name in looked_at},
    )


def estimated(clocks: Mapping[str, Clock]) -> dict[str, list[Any]]:
    """Source -> its clock as plain data, of those that are not as declared."""
    return {n: json.loads(json.dumps(list(asdict(c).values()))) for n, c in clocks.items() if c.key or c.notes}


def columns_of(
    channels: Iterable[Iterable[tuple[str, str, str, bool] | list[Any]]],
) -> dict[tuple[str, str], dict[str, bool]]:
    """(source, stream) -> channel -> whether it is text, over all tests. channels: of each test."""
    found: dict[tuple[str, str], dict[str, bool]] = {}
    for of_test in channels:
        for source, stream, name, is_text in of_test:
            found.setdefault((source, stream), {})[name] = is_text
    return found


def _clock(kept: list[Any]) -> Clock:
    offset_ns, drift_ppm, base_ns, suspect, key, notes = kept
    return Clock(offset_ns, drift_ppm, base_ns, suspect, key, tuple(notes))
