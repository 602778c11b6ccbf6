"""A clock that goes back: by how much, in words, and what most likely set it back."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from thermodata.reader.times.zone import REPEATS

# of a part that ends before what stands above it begins: joined behind that, it may be put after what came later
OLDER = (
    "what follows is older than all before it: a ring buffer with a pause? sort the file by its time; another test? "
    "cut the file there; only where the clock was set back, clock: {resets: allow} joins it"
)
# of a log that all tests share: cut there, each part would be looked for in all tests again
SHARED = (
    "all tests share this log, and another recording of it begins there? sort its rows by their time; only where the "
    "clock was set back, clock: {resets: allow} joins them"
)
_S, _MIN, _H = 10**9, 60 * 10**9, 3600 * 10**9
_ROW_NS = 10 * _MIN  # from row to row at most, so that the hour shows at which the clock turned
_REPEATED = re.compile(rf"{REPEATS} (\S+)Z:")
_MONTHS = (3, 4, 9, 10, 11)  # in which summer time ends somewhere: always on a Sunday, by three or so


def in_words(ns: int) -> str:
    """A span of time: '11 h 59 min', '59 min', '43 s', '0.5 s'."""
    rest = abs(ns)
    if rest < _MIN:
        return f"{rest / _S:.3g} s"
    rest = round(rest / _S) * _S
    parts = [(rest // _H, "h"), (rest % _H // _MIN, "min"), (rest % _MIN // _S, "s")]
    return " ".join(f"{n} {unit}" for n, unit in parts if n)


def said(before_ns: int, at_ns: int, absolute: bool, local: bool, of_day_ns: int | None = None) -> str:
    """By how much it went back, and from when to when: on the clock of the file where that is local and names no zone
    (local), else in UTC; of a file without dates by its time of day (of_day_ns: at its start), or from its start."""
    first, then = (moment(ns, absolute, local, of_day_ns) for ns in (before_ns, at_ns))
    return f"{in_words(before_ns - at_ns)} (from {first} to {then})"


def moment(ns: int, absolute: bool, local: bool, of_day_ns: int | None = None) -> str:
    """A time of a file; absolute, local, of_day_ns: as of `said`."""
    if not absolute and of_day_ns is not None:
        return str(np.timedelta64((ns + of_day_ns) // _S % (24 * 3600), "s").astype("datetime64[s]"))[-8:]
    if not absolute:
        return f"{in_words(ns) or '0 s'} {'before' if ns < 0 else 'after'} its start"
    return str(np.datetime64(ns // _S, "s")).replace("T", " ") + ("" if local else " UTC")


def cause_of(
    before_ns: int, at_ns: int, absolute: bool, local: bool, of_day_ns: int | None, notes: Sequence[str] = ()
) -> str | None:
    """The likely cause for a file, by its dates, or by the times of day that it tells without; absolute, local,
    of_day_ns: as of `said`; notes: of the file, which tell the hour that its zone repeats. None where nothing tells."""
    if absolute:
        return _second_pass(at_ns, notes) or likely_cause(before_ns, at_ns, local)
    return None if of_day_ns is None else likely_cause(before_ns + of_day_ns, at_ns + of_day_ns, local=False)


def _second_pass(at_ns: int, notes: Sequence[str]) -> str | None:
    """What to do where it steps back in an hour that its declared zone repeats: joined, the rest stands an hour off."""
    for note in notes:
        match = _REPEATED.match(note)
        if match is not None and abs(at_ns // _S - int(np.datetime64(match[1], "s").astype(np.int64))) <= _H // _S:
            return "its zone repeats that hour, and nothing told its second pass: split the file there"
    return None


def likely_cause(before_ns: int, at_ns: int, local: bool) -> str | None:
    """What set it back by all that shows, and what to do; None where nothing tells. local: it logs local times, and no
    zone is known."""
    by = before_ns - at_ns
    turns = before_ns % _H >= _H - _ROW_NS and at_ns % _H < _ROW_NS  # 12:59, then 1:00; zones differ by whole hours
    if 12 * _H - _ROW_NS <= by < 12 * _H and turns:
        return "a clock of 12 hours without AM and PM? export the times in 24 hours, or with AM and PM"
    at = np.datetime64(at_ns // _S, "s").item()
    autumn = at.weekday() == 6 and at.month in _MONTHS and before_ns % (24 * _H) < 3 * _H + _ROW_NS
    if local and _H - _ROW_NS <= by <= _H and autumn:
        return "the end of summer time? then declare the timezone of the source, e.g. timezone: Europe/Prague"
    return None
