"""What else is known of a question: how long a test ran by its name ('5H', '90min'), and what its sibling files say."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group

_SAID = re.compile(
    r"(?<![A-Za-z0-9.,])(\d{1,3}(?:[.,]\d+)?) ?(h|hrs?|hours?|std|stunden|hod|min)(?![A-Za-z])", re.IGNORECASE
)
_UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0, "ms": 1e-3}
_DAY_NS = 86_400 * 10**9
_NEAR = 0.25  # a test that is called 5 h may run for 6


def said_s(text: str) -> float | None:
    """The length of a test [s] that a name states: 'Warmlauf_5H' -> 18000."""
    match = _SAID.search(text.replace("_", " "))
    if match is None:
        return None
    return float(match[1].replace(",", ".")) * (60.0 if match[2].lower() == "min" else 3600.0)


def hinted(ask: str, group: Group, groups: Sequence[Group]) -> str:
    """A question, with what the names of the files say to it where it is for the unit of a time or a period; with what
    other sources say of the same tests where it is for the order of day and month of a start."""
    if ask.startswith("start: dmy or mdy"):
        return ask + _near_others(group, groups)
    if ask.startswith("format") and "two sources" not in ask:
        return ask + _settled_by_others(group)
    if not ask.startswith(("unit of the time", "period")):
        return ask
    fits = Counter(u for f in group.files for u in _fitting(f, ask))
    named = next((f for f in group.files if said_s(f"{f.path} {f.sheet or ''}") and _fitting(f, ask)), None)
    if not fits or named is None:
        return ask
    unit, many = fits.most_common(1)[0]
    return f"{ask}; '{named.sheet or named.path.stem}' fits {unit} ({many} of {len(group.files)} names state a length)"


def _near_others(group: Group, groups: Sequence[Group]) -> str:
    """Which order of day and month puts the starts of a source, which are read as dmy meanwhile, near those of others
    in the same tests, where only one does."""
    fits = fitting_others(group, groups, [f for f in group.files if f.asked])
    return next((f"; {order} fits the dates of '{source}'" for order, source in fits.items() if len(fits) == 1), "")


def fitting_others(group: Group, groups: Sequence[Group], files: Sequence[RawFile]) -> dict[str, str]:
    """Order of day and month -> a source whose dates it fits in the same tests, where only one order does. files: of
    the group, which are read as dmy meanwhile."""
    found: dict[str, str] = {}
    open_files = {id(f) for f in files}
    for other in (g for g in groups if g is not group):
        fits: Counter[str] = Counter()
        for test, own in group.tests.items():
            there = [f.start_ns for f in other.tests.get(test, ()) if f.start_ns is not None and not f.asked]
            for start in (f.start_ns for f in own if id(f) in open_files and f.start_ns is not None):
                near = {
                    order: any(abs(ns - at) < _DAY_NS for at in there)
                    for order, ns in (("dmy", start), ("mdy", swapped(start)))
                }
                if len(set(near.values())) > 1:  # 03/03 fits both ways, and tells nothing
                    fits.update(near)
        best = [order for order, many in fits.items() if many]
        if len(best) == 1:
            found.setdefault(best[0], other.source)
    return found


def swapped(ns: int) -> int:
    """A time whose day and month are taken for each other; the same where they can't be."""
    moment = datetime.fromtimestamp(ns // 10**9, UTC)
    if moment.day > 12:
        return ns
    return round(moment.replace(day=moment.month, month=moment.day).timestamp()) * 10**9


def _settled_by_others(group: Group) -> str:
    """What files of the same source say whose days leave no choice."""
    for file in group.files:
        for order, shown in (("dmy", "DD/MM"), ("mdy", "MM/DD")):
            if not file.asked and any("dates read as" in n and shown in n for n in file.recording.notes):
                return f"; {file.path.name} can only be {order}"
    return ""


def _fitting(file: RawFile, ask: str) -> list[str]:
    """The units (for a period: the period itself) with which a file is as long as its name says."""
    said = said_s(f"{file.path} {file.sheet or ''}")
    first, last = file.sample.first_ns, file.sample.last_ns
    if said is None or first is None or last is None or not file.sample.whole or last <= first:
        return []
    counted = (last - first) / 1e9  # read as seconds meanwhile
    if ask.startswith("period"):
        return [f"about {said / counted:.2g} s"]
    return [u for u, seconds in _UNITS.items() if abs(counted * seconds - said) <= _NEAR * said]
