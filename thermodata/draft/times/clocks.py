"""What the clocks of the sources have to do with each other: when one without dates began, and a quantity that
two of them logged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from thermodata.calibration.clock.estimate import estimate_offset
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import Course
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.times.hours_apart import hours_question
from thermodata.draft.times.on_another_day import on_another_day
from thermodata.draft.times.zones import begin_of
from thermodata.errors import ThermodataError
from thermodata.plugin import Float1D, Int1D
from thermodata.reader.times.step_back import OLDER, SHARED, cause_of, in_words, said
from thermodata.schema.words.sentences import counted
from thermodata.store.ingest.told.clocks.repeated_times import MANY
from thermodata.store.tidy.clock.times_of_day import NEAR_NS, began, begun_together, first_of
from thermodata.store.tidy.rows.on_change import SET, STEPS, come_at_no_rate, with_steps

Named = Mapping[tuple[str, str], tuple[str, str | None, str]]
_HOUR_NS = 3_600_000_000_000
_ALIGNABLE = ("rotational_speed", "position", "feed", "power", "temperature", "load")


@dataclass(frozen=True, slots=True)
class Alignment:
    """`clock: {align_to: there.source, by: [...]}` of a source. offset_s, uncertainty_s: as found in `test`; None where
    it could not be had there, and `why` says why: then it is only a question."""

    source: str
    there: str
    by: tuple[str, str]
    offset_s: float | None
    uncertainty_s: float | None
    test: str
    why: str | None = None


def start_question(group: Group, groups: Sequence[Group]) -> str | None:
    """What to ask about a source without dates beside one that has them; None where none has, or where they last as
    long in every test: then they begin and end together. Of one whose dates are of other days, what it is off by."""
    if not group.files or not all(_undated(f) for f in group.files):
        return on_another_day(group, groups)
    for other in groups:
        if other is group or any(_undated(f) for f in other.files):
            continue
        for test, files in group.tests.items():
            if (asked := _by_its_clock(test, files, other)) is not None:
                return asked
            here, there = _lasts_ns(files), _lasts_ns(other.tests.get(test, ()))
            if there is None or here is None:
                continue
            open_period = any(a.begins_s is not None for f in files for a in f.asked)
            begins = _counts_from(group)
            late = max(map(abs, begins.values()), default=0) > NEAR_NS
            if late or (abs(there - here) > NEAR_NS and not open_period):
                # of rows at an unknown period nobody knows how long they last
                unknown = any(a.ask.startswith("period") for f in files for a in f.asked)
                alike = open_period or unknown or abs(there - here) <= NEAR_NS
                own = "" if alike else f", and lasts {_hours(there)} h in {test} beside {_hours(here)} h of its own"
                from_ = f"; its times begin at {in_words(begins[test])} in {test}" if late and test in begins else ""
                also = " beside that clock" if late else ""
                return (
                    f"when did it begin? it has no dates; '{other.source}' has{own}{from_}; "
                    f"{begun_together(group.source, begins)} if they begin together, or give each test its "
                    f"start{also}: 2026-03-04 08:15"
                )
    return hours_question(group, groups)


def _by_its_clock(test: str, files: Sequence[RawFile], other: Group) -> str | None:
    """What to ask of a log that tells times of day, beside one with dates that begins at another time."""
    of_day_ns, there = first_of([f.recording.of_day_ns for f in files]), begin_of(other.tests.get(test, ()))
    # both are local, or the one with dates may be in UTC: by whole hours it may be the zone
    zone = "UTC" if any(f.local for f in other.files) else None
    at = None if of_day_ns is None or there is None else began(of_day_ns, there, zone)
    return at and (
        f"when did it begin? it tells times of day without a date; beside '{other.source}', {test} began {at} by its "
        f"first row: start: {at} in the test, and so for the others, or clock: {{offset: 0 s}} if they begin together"
    )


def repeats_question(group: Group) -> str | None:
    """What to ask where many rows stand at the time of the row before, which count nowhere; None where few do."""
    for file in group.files:
        said = file.sample.repeats
        if said.rows >= MANY * file.sample.rows > 0 and said.period_s > 0 and not any(s.held for s in file.signals):
            return (
                f"{said.rows} of {file.sample.rows} rows of {file.path.name} stand at the time of the row before, and "
                f"count nowhere; are rows evenly spaced? then table: {{time: {{period: {said.period_s:.4g} s}}}}, and "
                "give each test its start: 2026-03-02 08:00"
            )
    return None


_WAS_SET = (
    "was the clock set back there? then clock: {resets: allow} joins it; if another test begins there, cut the file"
)


_APART = (
    "rows from there on fill other columns than those before, so no clock was set back: they are another list of the "
    "same hours, which resets: allow would put behind them; cut the file there, each part with the header, and give "
    "each a source of its own"
)


def set_back_question(group: Group) -> str | None:
    """What to ask where the clock steps back within a file by more than a time server corrects: ingest loses what
    follows."""
    for file in group.files:
        back = file.sample.set_back
        if back is None or file.block is not None:
            continue
        if back.in_no_order:
            return (
                f"the rows of {file.path.name} stand in no order of their times, and what follows row {back.row - 1} "
                "is lost: sort the file by its time"
            )
        if any("resets: allow" in a.ask for a in file.asked) and not back.apart:
            continue
        absolute = file.recording.clock == "absolute"
        of_day = file.recording.of_day_ns
        cause = cause_of(back.from_ns, back.to_ns, absolute, file.local, of_day, file.recording.notes)
        asked = SHARED if group.shared and absolute else OLDER if back.older and absolute else _WAS_SET
        by = said(back.from_ns, back.to_ns, absolute, file.local, of_day)
        return (
            f"the clock of {file.path.name} goes back by {by} at row {back.row}, and what follows is lost: "
            f"{_APART if back.apart else cause or asked}"
        )
    return None


def mended_clocks(groups: Sequence[Group]) -> list[str]:
    """A note on each thing that an ingest will say it mended of the clocks of a source's files."""
    notes = []
    for group in groups:
        files = {f.path: f for own in group.tests.values() for f in own}
        said: dict[str, list[str]] = {}
        for path, file in files.items():
            for note in file.sample.mended:
                said.setdefault(note, []).append(str(path))
        for note, paths in said.items():
            of = paths[0] if len(paths) == 1 else f"{paths[0]} and {counted(len(paths) - 1, 'more file')}"
            notes.append(f"{of}: {note}")
    return notes


def _undated(file: RawFile) -> bool:
    return file.recording.is_undated


def _counts_from(group: Group) -> dict[str, int]:
    """Test -> the first time of its logs without dates [ns]; 0 where none tells it."""
    return {
        test: min((ns for f in files if (ns := f.counts_from_ns) is not None), default=0)
        for test, files in group.tests.items()
    }


def _lasts_ns(files: Sequence[RawFile]) -> int | None:
    """From the first to the last row; None where a file's end was not looked at."""
    ends = [(f.sample.first_ns, f.sample.last_ns) for f in files if f.sample.whole]
    known = [(a, b) for a, b in ends if a is not None and b is not None]
    if not files or len(known) < len(files):
        return None
    return max(b for _, b in known) - min(a for a, _ in known)


def _hours(ns: int) -> str:
    return f"{ns / _HOUR_NS:.3g}"


def alignments(groups: Sequence[Group], channels: Mapping[str, Named]) -> list[Alignment]:
    """For each source but the first, the pair of channels by which its clock can be had from another's.

    channels: source -> (stream, signal) -> (quantity, place, channel name). Only pairs whose courses fit in a test.
    """
    found: list[Alignment] = []
    aligned: set[str] = set()
    # what has UTC stays: local times of a zone that nobody says are moved to it
    utc = any(f.start_ns is not None and not f.local for g in groups for f in g.files)
    order = sorted(
        (g for g in groups if g.files),
        key=lambda g: (
            utc and any(f.local for f in g.files),
            -sum(s.unit in ("V", "um", "µm") for s, _ in g.signals),
        ),
    )
    for i, there in enumerate(order):
        for here in order[i + 1 :]:
            if here.source in aligned:
                continue
            made = _alignment(here, there, channels)
            if made is not None:
                found.append(made)
                aligned.add(here.source)
    return found


def _steps(course: Course, quantity: str, signal: tuple[str, str], group: Group) -> tuple[Int1D, Float1D]:
    """Times and values of a course, shape (n,); of what is set in a log written on change, with its steps."""
    held = any(s.held for s, _ in group.signals if (s.stream, s.name) == signal)
    if quantity in STEPS and (held or (quantity in SET and come_at_no_rate(course.t_ns))):
        return with_steps(course.t_ns, course.values)
    return course.t_ns, course.values


def _alignment(here: Group, there: Group, channels: Mapping[str, Named]) -> Alignment | None:
    pairs = [
        (a, b, name_a, name_b)
        for a, (quantity, place, name_a) in channels[here.source].items()
        for b, (other, where, name_b) in channels[there.source].items()
        if quantity == other and quantity in _ALIGNABLE and place == where and place is not None
    ]
    refused: Alignment | None = None
    pairs.sort(key=lambda p: _ALIGNABLE.index(channels[here.source][p[0]][0]))
    for test in [t for t in here.tests if t in there.tests][:6]:
        for a, b, name_a, name_b in pairs[:6]:
            one = next((c for f in here.tests[test] if (c := f.sample.courses.get(a)) is not None), None)
            two = next((c for f in there.tests[test] if (c := f.sample.courses.get(b)) is not None), None)
            if one is None or two is None:
                continue
            try:
                quantity = channels[here.source][a][0]
                said = estimate_offset(*_steps(one, quantity, a, here), *_steps(two, quantity, b, there))
            except ThermodataError as error:
                refused = refused or Alignment(
                    here.source, there.source, (name_a, name_b), None, None, test, error.what
                )
                continue
            return Alignment(
                here.source, there.source, (name_a, name_b), said.offset_ns / 1e9, said.uncertainty_ns / 1e9, test
            )
    return refused
