"""Columns that are called otherwise from some test on: 'probe_x_mm' is 'x' there. What stands at the same place, or
is of the same quantity and axis or place, and never beside the other in one test, may be one channel: asked once."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import takewhile

from thermodata.draft.campaign.parts import DraftChannel, DraftSource
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.signals.guess import NUMBERED
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.naming import parts_of, words
from thermodata.reader.text import split_unit
from thermodata.schema.units.conversion import converts
from thermodata.schema.words.sentences import with_dots

_SHOWN = 4
Pair = tuple[DraftChannel, DraftChannel]  # (of the first test, as it may be called here)


def with_renamed_asked(
    sources: Sequence[DraftSource], groups: Sequence[Group], channels: Sequence[DraftChannel]
) -> tuple[DraftSource, ...]:
    """The sources, those asked whose channels may be those of others, or of other tests, under other names."""
    live = [g for g in groups if g.tests and not g.shared and not any(f.sensor or f.block for f in g.files)]
    asked: dict[str, str] = {}
    for k, group in enumerate(live):
        first = _first_of(group, live[:k], live)
        before = _layout(next(iter(first.tests.values()))[0], first.source, channels)
        pairs = _in_tests(before, {t: _layout(fs[0], group.source, channels) for t, fs in group.tests.items()})
        if pairs:
            asked[group.source] = _question(pairs)
    return tuple(replace(s, questions=(*s.questions, asked[s.name])) if s.name in asked else s for s in sources)


def _in_tests(before: Sequence[DraftChannel], layouts: Mapping[str, Sequence[DraftChannel]]) -> dict[str, list[Pair]]:
    """Test -> its channels that may be others; what one test tells of a channel holds for the others that have it."""
    told: dict[str, dict[str, DraftChannel]] = {}
    for here in layouts.values():
        for a, b in _pairs(before, here):
            told.setdefault(b.name, {})[a.name] = a
    known = {name: next(iter(of.values())) for name, of in told.items() if len(of) == 1}
    order = {c.name: k for k, c in enumerate(before)}
    pairs = {
        t: sorted(((known[b.name], b) for b in here if b.name in known), key=lambda pair: order[pair[0].name])
        for t, here in layouts.items()
    }
    return {t: of for t, of in pairs.items() if of and len({a.name for a, _ in of}) == len(of)}


def _first_of(group: Group, before: Sequence[Group], live: Sequence[Group]) -> Group:
    """The source that one may have been before its columns were called otherwise: of several that no test has beside it
    the one whose files are called most alike, for two loggers may both have changed. Itself where that is none of
    those before it."""
    others = [g for g in live if g is not group and _is_before(g, group)]
    most = max((_likeness(g, group) for g in others), default=0)
    return next((g for g in before if g in others and _likeness(g, group) == most), group)


def _likeness(one: Group, other: Group) -> int:
    """How many letters the paths of two sources have in common at their beginning and end, whatever their numbers."""
    a, b = (re.sub(r"\d+", "0", str(next(iter(g.tests.values()))[0].path)) for g in (one, other))
    if a == b:
        return len(a) + len(b)
    return _begin_alike(a, b) + _begin_alike(a[::-1], b[::-1])


def _begin_alike(a: str, b: str) -> int:
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(a, b, strict=False)))


def _is_before(first: Group, group: Group) -> bool:
    """Whether a source may be what another one was before: no test has both."""
    return first.reader == group.reader and not first.tests.keys() & group.tests.keys()


def _layout(file: RawFile, source: str, channels: Sequence[DraftChannel]) -> list[DraftChannel]:
    """The channels of a file in the order of its columns; texts are none."""
    own = {_bare(c): c for c in channels if c.source == source and c.said.quantity != "label"}
    found = (own.get(s.name) or own.get(split_unit(s.name)[0]) for s in file.signals)
    return [c for c in found if c is not None]


def _bare(channel: DraftChannel) -> str:
    return channel.signal.removeprefix(f"{channel.stream}:")


def _pairs(before: Sequence[DraftChannel], here: Sequence[DraftChannel]) -> list[Pair]:
    """The channels of the first test that this one lacks, each with what may be it: by their places where both have as
    many columns, else by what both are."""
    gone, new = [c for c in before if c not in here], [c for c in here if c not in before]
    if len(before) == len(here):
        at_one_place = [(a, b) for a, b in zip(before, here, strict=True) if a is not b]
        fits = all(a in gone and b in new and not _differ(a, b) for a, b in at_one_place)
        if fits and any(_alike(a, b) or _is_nameless(a) or _is_nameless(b) for a, b in at_one_place):
            return [(a, b) for a, b in at_one_place if a.said.quantity]
    alike = [(a, b) for a in gone for b in new if a.said.quantity and _alike(a, b)]
    return [(a, b) for a, b in alike if sum(x is a or y is b for x, y in alike) == 1]


def _differ(a: DraftChannel, b: DraftChannel) -> bool:
    said = ((a.said.quantity, b.said.quantity), (a.said.axis, b.said.axis), (a.said.at, b.said.at))
    one, other = a.said.unit, b.said.unit
    return any(x and y and x != y for x, y in said) or bool(one and other and not converts(one, other))


def _alike(a: DraftChannel, b: DraftChannel) -> bool:
    """Whether both are of one quantity and one axis or place; a name without a quantity may be that of the axis."""
    if _differ(a, b):
        return False
    if b.said.quantity is None:
        return a.said.axis is not None and axis_of(words(parts_of(_bare(b))[-1])) == a.said.axis.lower()
    return a.said.quantity == b.said.quantity and bool((a.said.axis and b.said.axis) or (a.said.at and b.said.at))


def _is_nameless(channel: DraftChannel) -> bool:
    return NUMBERED.fullmatch(_bare(channel)) is not None


def _question(pairs: dict[str, list[Pair]]) -> str:
    names = ", ".join(dict.fromkeys(f"'{b.name}' and '{a.name}'" for of in pairs.values() for a, b in of))
    tests: dict[str, list[str]] = {}
    for test, of in pairs.items():
        tests.setdefault(", ".join(f"{a.name}: {{{_keys(a, b)}}}" for a, b in of), []).append(test)
    written = "; ".join(f"in {with_dots(own, _SHOWN)}: channels: {{{keys}}}" for keys, own in tests.items())
    return f"one channel each, {names}, under two names? no test has both: then delete the first of each, and {written}"


def _keys(a: DraftChannel, b: DraftChannel) -> str:
    source = f"source: {b.source}, " if b.source != a.source else ""
    unit = f", unit: {_quoted(b.said.unit)}" if b.said.unit and b.said.unit != a.said.unit else ""
    return f"{source}signal: {_quoted(b.signal)}{unit}"


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
