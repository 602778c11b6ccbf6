"""Many lines of one cause become one: how often, and where first."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from thermodata.schema.words.sentences import with_count

T = TypeVar("T")
MOST_PLACES = 3  # named beside the first
MOST_CHANNELS = 8
_QUOTED = re.compile(r"'[^']*'|\"[^\"]*\"")
_PATH = re.compile(r"[^\s,:;()]*[/\\][^\s,:;()]*|[\w.-]+\.[A-Za-z]\w{1,5}\b")
_NUMBER = re.compile(r"[-+]?\d(?:[\d.,:TZ+-]*\d)?(?:[eE][-+]?\d+)?")
# what may differ between lines of one cause: a number comes with its unit
_TOKEN = re.compile(rf"{_QUOTED.pattern}|{_PATH.pattern}|{_NUMBER.pattern}(?: ?(?:°C|[%A-Za-z]{{1,4}})\b)?")
_CHANNEL = re.compile(r"channel '([^']+)': ")
_WORD = re.compile(r"[\w.-]+")
# one row stands, two rows stand: of one cause
_SEVERAL = {"are": "is", "were": "was", "they": "it", "do": "does"}
_ENDS = re.compile(r"(?<=[a-z])e?s\b")


@dataclass(frozen=True, slots=True)
class Cause(Generic[T]):
    """Lines of one cause, in their order. text: the first one's."""

    text: str
    members: tuple[T, ...]

    @property
    def first(self) -> T:
        return self.members[0]


def cause_of(text: str, names: Collection[str]) -> str:
    """A text without what differs from place to place: numbers, what is quoted, paths, and these names."""
    known = set(names)
    text = _WORD.sub(lambda word: "~" if word.group() in known else word.group(), _QUOTED.sub("~", text))
    text = _NUMBER.sub("#", _PATH.sub("~", text))
    text = _ENDS.sub("", _WORD.sub(lambda word: _SEVERAL.get(word.group(), word.group()), text))
    return re.sub(r"~(, ~)+", "~", text)  # lists of names of any length


def by_cause(items: Iterable[T], text: Callable[[T], str], names: Collection[str] = ()) -> list[Cause[T]]:
    """The causes in the order of their first members."""
    groups: dict[str, list[T]] = {}
    for item in items:
        groups.setdefault(cause_of(text(item), names), []).append(item)
    return [Cause(text(some[0]), tuple(some)) for some in groups.values()]


def losses_in_words(losses: Sequence[Mapping[str, Any]], names: Collection[str] = ()) -> list[str]:
    """A line a cause; `names`: of tests, sources and channels."""
    said = []
    for cause in by_cause(losses, lambda x: str(x["reason"]), names):
        line = f"{cause.text}{_place(cause.first)}"
        if len(cause.members) > 1:
            others = dict.fromkeys(
                o
                for x in cause.members[1:]
                if (o := _elsewhere(x, cause.first) if _short(x) else _differing(cause.text, str(x["reason"])))
            )
            line = f"{len(cause.members)} times: {line}{_others(list(others))}{_channels(cause)}"
        said.append(line)
    return said


def _channels(cause: Cause[Mapping[str, Any]]) -> str:
    """The channels that lines are of which begin with one: where they stand does not say of which."""
    begins = [found[1] for x in cause.members if (found := _CHANNEL.match(str(x["reason"])))]
    others = [f"'{name}'" for name in dict.fromkeys(begins)][1:] if any(_short(x) for x in cause.members) else []
    return f"; the same of {with_count(others, MOST_CHANNELS)}" if others else ""


def notes_in_words(notes: Sequence[str], names: Collection[str] = ()) -> list[str]:
    """A line a cause. A note begins with its place: 'day1, daq: ...' or 'raw/day1.csv: ...'; what stands otherwise in
    the others is said with their places."""
    said = []
    for cause in by_cause(notes, str, names):
        line = cause.text
        if len(cause.members) > 1:
            others = dict.fromkeys(_differing(cause.text, m) for m in cause.members[1:])
            line = f"{len(cause.members)} times: {line}{_others([o for o in others if o])}{_span(cause.members)}"
        said.append(line)
    return said


def _differing(first: str, other: str) -> str:
    """What another line of the same cause has in place of the first one's names and figures: its head, where that is a
    place, and in brackets what differs behind it."""
    heads, bodies = zip(*(text.partition(": ")[::2] for text in (first, other)), strict=True)
    if not bodies[0]:
        heads, bodies = ("", ""), (first, other)
    mine, theirs = (_TOKEN.findall(body) for body in bodies)
    if len(mine) == len(theirs):
        differs = [b for a, b in zip(mine, theirs, strict=True) if a != b]
    else:  # lists of names of other lengths
        differs = [b for b in theirs if b not in mine]
    told = ", ".join(differs)
    head = heads[1] if heads[1] != heads[0] else ""
    return f"{head} ({told})" if head and told else head or told


def _span(lines: Sequence[str]) -> str:
    """From where to where the only figure that differs goes, where not every line is shown."""
    if len(lines) <= MOST_PLACES + 1:
        return ""
    rows = [_NUMBER.findall(line.partition(": ")[2] or line) for line in lines]
    if len({len(row) for row in rows}) > 1:
        return ""
    differ = [column for column in zip(*rows, strict=True) if len(set(column)) > 1]
    try:
        values = {float(text): text for text in differ[0]} if len(differ) == 1 else {}
    except ValueError:  # a date
        return ""
    return f" (from {values[min(values)]} to {values[max(values)]})" if values else ""


def said_at_ingest(summary: Mapping[str, Any]) -> dict[str, list[str]]:
    """'losses' and 'notes' of an ingest's summary, a line a cause."""
    names = {str(x[k]) for x in summary["losses"] for k in ("test", "source") if x.get(k)}
    names |= {str(name) for x in summary["losses"] for name in x.get("tests") or ()}
    return {
        "losses": losses_in_words(summary["losses"], names),
        "notes": notes_in_words(summary["notes"], names | _heads(summary["notes"])),
    }


def _heads(notes: Sequence[str]) -> set[str]:
    """Names of tests and sources that notes begin with: 'day1, daq: ...'."""
    heads = [n.partition(": ")[0] for n in notes if ": " in n]
    return {part for head in heads if head.count(",") < 3 for part in head.split(", ") if " " not in part}


def _place(loss: Mapping[str, Any]) -> str:
    sources = ", ".join(loss.get("sources") or [s for s in [loss.get("source")] if s])
    tests = with_count(loss.get("tests") or [t for t in [loss.get("test")] if t], MOST_PLACES)
    told = (tests or None, sources or None, loss.get("file"), loss.get("where"))
    parts = [str(part) for part in told if part is not None]
    share = f", {100 * loss['fraction']:.2g} % of the file" if loss.get("fraction") else ""
    return f" ({', '.join(parts)}{share})" if parts else ""


def _short(loss: Mapping[str, Any]) -> str:
    return str(loss.get("file") or loss.get("test") or loss.get("source") or "")


def _elsewhere(loss: Mapping[str, Any], first: Mapping[str, Any]) -> str:
    """What tells the place of a loss from the first one's; '' where nothing does."""
    return next((str(loss[k]) for k in ("file", "test", "source") if loss.get(k) and loss[k] != first.get(k)), "")


def _others(places: Sequence[str]) -> str:
    return f"; also in {with_count(places, MOST_PLACES)}" if places else ""
