"""The sheets of a workbook, and the groups of a recording, that are tests: alike, and not of one time."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from itertools import combinations

from thermodata.draft.files.sample import Sample
from thermodata.plugin import Recording, Signal
from thermodata.reader.signals.series import SERIES

_FURTHER_RATE = re.compile(r"@\d+$")
_TOGETHER_NS = 10_000_000_000  # what begins within this began at once
_RATES_APART = 1.5  # rows of one span that are of two rates


def sheets_of(recording: Recording) -> tuple[list[str], list[str]]:
    """(the sheets of a workbook that are tests of one kind, the others): each a stream, and with mostly the same
    signals; or with dates, as many columns, and called alike but for a number, as where somebody named the columns anew
    in each. No sheets where fewer than two are alike, or fewer than three beside one that is unlike them, or where
    streams are the series of one table."""
    homes = [_home(s) for s in recording.signals]
    if any(SERIES in s.properties for s in recording.signals) or None in homes or len(set(homes)) < 2:
        return [], []
    own: dict[str, set[str]] = {}
    for home, s in zip(homes, recording.signals, strict=True):
        if home is not None:
            own.setdefault(home, set()).add(s.name.removeprefix(f"{home}/"))
    streams, dated = list(own), recording.clock == "absolute"

    def like(one: str) -> list[str]:
        named = [n for n in streams if len(own[one] & own[n]) >= 0.5 * max(len(own[one]), len(own[n]))]
        return named if len(named) > 1 or not dated else [n for n in streams if shape(n) == shape(one)]

    def shape(one: str) -> tuple[str, int]:
        return re.sub(r"\d+", "#", one), len(own[one])

    alike = max((like(n) for n in streams), key=len)
    others = [n for n in streams if n not in alike]
    # an overview or notes beside the tests; half of the sheets of another kind are two loggers of the same tests
    enough = len(alike) >= 2 and (not others or len(alike) >= max(3, 2 * len(others)))
    return (alike, others) if enough else ([], [])


def sheet_like(recording: Recording, others: Sequence[Recording]) -> str | None:
    """The one sheet or group that a recording has, with mostly the signals of another recording's sheet; else None."""
    homes = {_home(s) for s in recording.signals}
    home = homes.pop() if len(homes) == 1 else None
    own = {s.name.removeprefix(f"{home}/") for s in recording.signals}
    alike = any(len(own & {s.name for s in o.signals}) * 2 >= min(len(own), len(o.signals)) for o in others)
    return home if home is not None and alike else None


def _home(signal: Signal) -> str | None:
    """The sheet or group of a signal, whose name begins with it; None where it does not. A group of several rates has
    a stream of each: group, group@2."""
    group = _FURTHER_RATE.sub("", signal.stream)
    return next((n for n in (signal.stream, group) if signal.name.startswith(f"{n}/")), None)


def recordings_in(starts: Sequence[int | None], samples: Sequence[Sample]) -> int:
    """How many recordings several sheets or groups are of, where each ran while another did: as loggers or rates of a
    recording, and no tests; 0 where one ran alone. starts: of absolute clocks, None of others, where only equal ends at
    other rates show it."""
    home = list(range(len(samples)))
    for one, other in combinations(range(len(samples)), 2):
        if at_once(starts[one], samples[one], starts[other], samples[other]):
            home = [home[one] if h == home[other] else h for h in home]
    ran = Counter(home)
    return len(ran) if ran and min(ran.values()) > 1 else 0


def at_once(a_start: int | None, a: Sample, b_start: int | None, b: Sample) -> bool:
    """Whether one recording ran while another did."""
    if a_start is None or b_start is None:
        ended = a.whole and b.whole and a.last_ns is not None and a.last_ns == b.last_ns and a.first_ns == b.first_ns
        return ended and max(a.rows, b.rows) >= _RATES_APART * min(a.rows, b.rows)
    return spans_at_once((a_start, a.last_ns or 0), (b_start, b.last_ns or 0))


def spans_at_once(a: tuple[int, int], b: tuple[int, int]) -> bool:
    """Whether half of the shorter of two recordings ran while the other did. a, b: first and last time [ns]."""
    a_end, b_end = (max(last, first + _TOGETHER_NS) for first, last in (a, b))
    both = min(a_end, b_end) - max(a[0], b[0])
    return both >= 0.5 * min(a_end - a[0], b_end - b[0])
