"""A log with dates that runs on no day of its tests: the clock of a control that nobody set, years off."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.times.zones import begin_of
from thermodata.reader.times.step_back import in_words
from thermodata.schema.words.sentences import with_count
from thermodata.store.tidy.clock.times_of_day import NEAR_NS

_DAY_NS = 86_400 * 10**9  # zones, summer time and a clock of twelve hours take less
_SHOWN = 3


class _Span(NamedTuple):
    first: int
    last: int


def on_another_day(group: Group, groups: Sequence[Group]) -> str | None:
    """What to ask of a source that in none of its tests ran within a day of the one with the probes; None of all
    others, and where an order of day and month is open, which is off by months itself."""
    there = max(groups, key=_probes)
    if there is group or group.shared or there.shared or _is_open(group) or _is_open(there):
        return None
    later = {
        test: other.first - own.first
        for test, files in group.tests.items()
        if (own := _span(files)) is not None
        and (other := _span(there.tests.get(test, ()))) is not None
        and max(other.first - own.last, own.first - other.last) > _DAY_NS
    }
    known = [t for t, files in group.tests.items() if _span(files) and _span(there.tests.get(t, ()))]
    if not later or len(later) < len(known):
        return None
    (test, by_ns), *_ = later.items()
    if max(later.values()) - min(later.values()) <= NEAR_NS:
        line = f"clock: {{offset: {_signed(by_ns)}}}"
    else:
        line = with_count([f"clocks: {{{group.source}: {_signed(ns)}}} in {t}" for t, ns in later.items()], _SHOWN)
    return (
        f"was its clock right? in {test} it begins {in_words(by_ns)} {'before' if by_ns > 0 else 'after'} "
        f"'{there.source}', and has no sample in the test: {line} if they began together"
    )


def _signed(ns: int) -> str:
    return f"{'-' if ns < 0 else ''}{in_words(ns)}"


def _probes(group: Group) -> int:
    """How many signals of a source are in units of probes."""
    return sum(s.unit in ("V", "um", "µm") for s, _ in group.signals)


def _is_open(group: Group) -> bool:
    return any("mdy" in ask for ask in group.asks)


def _span(files: Sequence[RawFile]) -> _Span | None:
    """From the first to the last time in a test; None without dates."""
    begin = begin_of(files)
    if begin is None:
        return None
    ends = [f.start_ns + (f.sample.last_ns or 0) - (f.sample.first_ns or 0) for f in files if f.start_ns is not None]
    return _Span(begin, max(ends))
