"""What the clocks of the sources have to do with each other: a zone that a log does not name, and a quantity that two
of them logged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from zoneinfo import ZoneInfo

from thermodata.calibration.clock.estimate import estimate_offset
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.sources import Group
from thermodata.draft.times.in_repeated_hour import which_pass
from thermodata.draft.times.zone_of_names import named_zone, zone_in
from thermodata.errors import ThermodataError
from thermodata.reader.text.tables.zone_named import OPEN, SAYS
from thermodata.reader.times.step_back import in_words, likely_cause, said
from thermodata.schema.words.sentences import counted
from thermodata.store.ingest.told.repeated_times import MANY
from thermodata.store.tidy.times_of_day import NEAR_NS, began, begun_together, first_of

Named = Mapping[tuple[str, str], tuple[str, str | None, str]]
_HOUR_NS = 3_600_000_000_000
_ZONES = (
    "UTC",
    "Europe/Prague",
    "Europe/Berlin",
    "Europe/London",
    "Europe/Helsinki",
    "Europe/Moscow",
    "Asia/Shanghai",
    "Asia/Tokyo",
    "Asia/Kolkata",
    "America/New_York",
    "America/Chicago",
    "America/Los_Angeles",
    "America/Sao_Paulo",
)
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


def zone_question(group: Group, groups: Sequence[Group]) -> str | None:
    """What to ask about the zone of a source that logs local times; None where it names its zone or has no dates."""
    if not any(f.local for f in group.files):
        return None
    head = next((n for f in group.files for n in f.recording.notes if OPEN in n or n.startswith(SAYS)), None)
    said, likely = "" if head is None else f"; {head}", named_zone(head, [f.path for f in group.files])
    pairs = [
        (f.start_ns, begin)
        for g in groups
        if g is not group and not any(f.local for f in g.files)
        for test, files in group.tests.items()
        if test in g.tests
        for f in files[:1]
        if f.start_ns is not None and (begin := _begin(g.tests[test])) is not None
    ]
    whole = [(round(h), b) for a, b in pairs if abs((h := (a - b) / _HOUR_NS) - round(h)) < 0.25]
    if not pairs or len(whole) < 0.6 * len(pairs) or max(abs(h) for h, _ in whole) > 14:
        asked = "timezone? it logs local times without a zone; taken as UTC. " + likely + said
        return asked + which_pass(group.files, likely)
    asked = f"timezone? local times, {_shown({h for h, _ in whole})} from the other sources' UTC"
    return f"{asked}{_zones_of(whole, likely, group)}{said}"


def _shown(hours: set[int]) -> str:
    return "/".join(f"{h:+d} h" for h in sorted(hours))


def _is_set_otherwise(file: RawFile) -> bool:
    """Whether a file's clock is set back by more than summer time that ends."""
    back = file.sample.set_back
    return back is not None and not back.in_no_order and likely_cause(back.from_ns, back.to_ns, file.local) is None


def _zones_of(ahead: Sequence[tuple[int, int]], likely: str, group: Group) -> str:
    """What local times tell of their zone: whether it is the one that the file names, and else which ones are so far
    ahead, for no offset tells one of them. ahead: (hours, the beginning in UTC [ns]) of each test."""
    if any(_is_set_otherwise(f) for f in group.files):
        return " where the file begins, and its clock is set back later, so that they tell no zone"
    if (named := zone_in(likely)) is not None:
        own = [_offset(named, begin) for _, begin in ahead]
        if own == [h for h, _ in ahead]:
            return f", as those of {named} are: {likely}"
        hours = _shown({h for h in own if h is not None})
        return f"; those of {named} were {hours} ahead then: was the clock set otherwise? {likely}"
    fitting = [z for z in _ZONES if all(_offset(z, begin) == h for h, begin in ahead)]
    if not fitting:
        return ": of what zone, or is the clock wrong by whole hours?"
    return f": so are {', '.join(fitting[:3])} and others, and a clock that was set otherwise"


def start_question(group: Group, groups: Sequence[Group]) -> str | None:
    """What to ask about a source without dates beside one that has them; None where none has, or where they last as
    long in every test: then they begin and end together."""
    if not group.files or not all(_undated(f) for f in group.files):
        return None
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
                own = (
                    "" if open_period else f", and lasts {_hours(there)} h in {test} beside {_hours(here)} h of its own"
                )
                from_ = f"; its times begin at {in_words(begins[test])} in {test}" if late and test in begins else ""
                also = " beside that clock" if late else ""
                return (
                    f"when did it begin? it has no dates; '{other.source}' has{own}{from_}; "
                    f"{begun_together(group.source, begins)} if they begin together, or give each test its "
                    f"start{also}: 2026-03-04 08:15"
                )
    return None


def _by_its_clock(test: str, files: Sequence[RawFile], other: Group) -> str | None:
    """What to ask of a log that tells times of day, beside one with dates that begins at another time."""
    of_day_ns, there = first_of([f.recording.of_day_ns for f in files]), _begin(other.tests.get(test, ()))
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
        if any("resets: allow" in a.ask for a in file.asked):
            continue
        absolute = file.recording.clock == "absolute"
        cause = likely_cause(back.from_ns, back.to_ns, file.local) if absolute else None
        asked = (
            "was the clock set back there? then clock: {resets: allow} joins it; if another test begins there, cut the "
            "file"
        )
        by = said(back.from_ns, back.to_ns, absolute, file.local)
        return (
            f"the clock of {file.path.name} goes back by {by} at row {back.row}, and what follows is lost: "
            f"{cause or asked}"
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
    return file.recording.clock == "relative" and file.recording.start_ns is None


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


def _begin(files: Sequence[RawFile]) -> int | None:
    return min((f.start_ns for f in files if f.start_ns is not None), default=None)


def _offset(name: str, at_ns: int) -> int | None:
    shift = datetime.fromtimestamp(at_ns / 1e9, UTC).astimezone(ZoneInfo(name)).utcoffset()
    return None if shift is None else round(shift.total_seconds() / 3600)


def alignments(groups: Sequence[Group], channels: Mapping[str, Named]) -> list[Alignment]:
    """For each source but the first, the pair of channels by which its clock can be had from another's.

    channels: source -> (stream, signal) -> (quantity, place, channel name). Only pairs whose courses fit in a test.
    """
    found: list[Alignment] = []
    aligned: set[str] = set()
    order = sorted(
        (g for g in groups if g.files), key=lambda g: -sum(s.unit in ("V", "um", "µm") for s, _ in g.signals)
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
                said = estimate_offset(one.t_ns, one.values, two.t_ns, two.values)
            except ThermodataError as error:
                refused = refused or Alignment(
                    here.source, there.source, (name_a, name_b), None, None, test, error.what
                )
                continue
            return Alignment(
                here.source, there.source, (name_a, name_b), said.offset_ns / 1e9, said.uncertainty_ns / 1e9, test
            )
    return refused
