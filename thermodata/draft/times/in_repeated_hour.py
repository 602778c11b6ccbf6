"""What to ask of files whose local times all lie in the hour that a zone repeats in autumn."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.reader.text.preamble.pass_words import lines_above, pass_said
from thermodata.reader.times.repeated_hour import RepeatedHour, repeated_hour
from thermodata.reader.times.zone import utc_offset_ns
from thermodata.store.ingest.reading.resolve import natural

_SHOWN = 3  # tests of which a question says how they are read


def which_pass(group: Group, groups: Sequence[Group], proposed: str, folder: Path | None = None) -> str:
    """How the question of a zone goes on where tests begin with a file that lies in the hour that the proposed zone
    repeats; of any other file a start tells nothing. folder: where heads of files can be read."""
    named = re.search(r"timezone: ([\w/+-]+)", proposed)
    zone = "" if named is None else named[1]
    read_so, asked = list[str](), list[str]()
    for test, files in group.tests.items() if zone else ():
        first = next((f for f in files if _passes(f, zone)), None)
        passes = None if first is None else _passes(first, zone)
        if first is None or passes is None:
            continue
        others = [f for g in groups for f in g.tests.get(test, ()) if _passes(f, zone) is None]
        began = _local_ns(first, zone) or 0
        if all((at := _local_ns(f, zone)) is None or at >= began for f in others):
            said = f"; all times of {first.path.name} lie in the hour that this zone repeats"
            if (words := _by_words(first, zone, folder)) is not None:
                read = f"are read as of {_its(words[0])}, as '{words[1]}' says"
                read_so.append(f"{said}, and {read}, at {passes[words[0]]}")
            elif (told := _by_order(group, first, zone)) is not None:
                where = f"as {told[1].path.name} {'before' if told[0] else 'behind'} it says"
                asked.append(f"{said}, in {_its(told[0])}, {where}: with it give the test its start: {passes[told[0]]}")
            else:
                asked.append(
                    f"{said}: with it give the test its start: {passes[0]} for the first pass, {passes[1]} for the "
                    "second"
                )
    return "".join((*read_so[:_SHOWN], *asked[:1]))


def _its(second: bool) -> str:
    return f"its {'second' if second else 'first'} pass"


def _by_words(file: RawFile, zone: str, folder: Path | None) -> tuple[bool, str] | None:
    """(whether a file is of the second pass, the word in its name or above its rows that says it); None where none
    does, or both."""
    hour = _hour_at(file.sample.first_ns or 0, zone)
    lines = [] if folder is None else lines_above(folder / file.path)
    return None if hour is None else pass_said([str(file.path), *lines], hour, zone)


def _by_order(group: Group, file: RawFile, zone: str) -> tuple[bool, RawFile] | None:
    """(whether a file is of the second pass, what says so): of the logs of its source one before it, by name, ends in
    the hour later by the local clock than it begins, or one behind it begins there earlier than it ends. None where
    neither is so, or both, or where names tell no order."""
    ordered = sorted(group.files, key=lambda f: natural(f.path.as_posix()))
    if not _count_on(ordered, zone):
        return None
    at = next(i for i, f in enumerate(ordered) if f.path == file.path)
    begin, end = file.sample.first_ns or 0, file.sample.last_ns or 0
    ended = [(f, f.sample.last_ns) for f in ordered[:at] if f.local and f.sample.whole]
    begun = [(f, f.sample.first_ns) for f in ordered[at + 1 :] if f.local]
    second = next((f for f, t in ended if t is not None and t > begin and _hour_at(t, zone)), None)
    first = next((f for f, t in begun if t is not None and t < end and _hour_at(t, zone)), None)
    if (second is None) == (first is None):
        return None
    return (True, second) if second is not None else (False, first) if first is not None else None


def _count_on(ordered: Sequence[RawFile], zone: str) -> bool:
    """Whether names are alike but for their numbers, and all logs with dates begin in their order: by local times that
    go back only within the hour that is repeated, and once."""
    if len({re.sub(r"\d+", "", f.path.as_posix()) for f in ordered}) > 1:
        return False
    began = [t for f in ordered if (t := _local_ns(f, zone)) is not None]
    back = [(a, b) for a, b in pairwise(began) if b < a]
    return len(back) < 2 and all(_hour_at(a, zone) and _hour_at(b, zone) for a, b in back)


def _passes(file: RawFile, zone: str) -> tuple[str, str] | None:
    """When a file began, as of either pass; None where it does not lie in that hour."""
    first, last = file.sample.first_ns, file.sample.last_ns
    if not file.local or first is None or last is None:
        return None
    hour, ahead = _hour_at(first, zone), _ahead(first, zone)
    if hour is None or not hour.in_first(last - ahead):
        return None
    return hour.written(first - ahead, second=False), hour.written(first - ahead, second=True)


def _ahead(local_ns: int, zone: str) -> int:
    """How far local times were ahead of UTC before that night [ns]."""
    return utc_offset_ns(zone, local_ns // 10**9 - 24 * 3600)


def _hour_at(local_ns: int, zone: str) -> RepeatedHour | None:
    """The hour that a zone repeats where a local time, which is read as UTC meanwhile, lies in it."""
    return repeated_hour(zone, local_ns - _ahead(local_ns, zone))


def _local_ns(file: RawFile, zone: str) -> int | None:
    """When a file began, in local times of a zone [ns]; None where it has no date."""
    at = file.start_ns
    return at if at is None or file.local else at + utc_offset_ns(zone, at // 10**9)
