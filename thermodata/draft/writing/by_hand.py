"""What somebody changed in a campaign file since it was drafted, so that a draft made anew keeps it.

Told by a draft of the same folder that knows nothing of the answers: what the file says otherwise, a person said.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from thermodata.draft.folder.into_sources.sources_before import added_sources, names_in_draft, with_sources_called
from thermodata.draft.signals.told_before import NAME, SAID
from thermodata.draft.writing.asked import asked_in
from thermodata.draft.writing.in_line import parted
from thermodata.errors import ThermodataError
from thermodata.reader.times.open_questions import UNKNOWN
from thermodata.schema.strict.lines import Document, Place, parse_document

SECTIONS = ("channels", "calibrations", "tests")
_OF_THE_DRAFT = ("schema", "sources", "tests_from")  # keys at the top that are no answers, or are kept elsewhere
_BY_JUDGEMENT = ("sure", "guess")


@dataclass(frozen=True, slots=True)
class ByHand:
    """changed: (section, name) -> the keys that somebody gave, with their values; added: entries that the draft does
    not have, whole; top: keys of the file itself, `tests_from.set` among them; spoken: (section, name) ->
    the comment of its line; sources: as the file called some -> as the draft does."""

    changed: Mapping[Place, Mapping[str, Any]] = field(default_factory=dict)
    added: Mapping[Place, Mapping[str, Any]] = field(default_factory=dict)
    top: Mapping[str, Any] = field(default_factory=dict)
    spoken: Mapping[Place, str] = field(default_factory=dict)
    sources: Mapping[str, str] = field(default_factory=dict)

    def signals(self) -> Iterator[tuple[str, str, dict[str, str]]]:
        """(source, signal, what somebody said that it is): of several channels of one signal the first."""
        for (source, signal), ((_, name), keys) in self.of_signals().items():
            own = {k: str(v) for k, v in keys.items() if k in SAID}
            if own or NAME in keys:
                yield source, signal, {**own, NAME: str(keys.get(NAME, name))}

    def of_signals(self) -> dict[tuple[str, str], tuple[Place, Mapping[str, Any]]]:
        """(source, signal) -> its channel and what is kept of it, of several the one that the draft has."""
        found: dict[tuple[str, str], tuple[Place, Mapping[str, Any]]] = {}
        for place, keys in (*self.changed.items(), *self.added.items()):
            if place[0] == "channels" and "signal" in keys:
                found.setdefault((str(keys.get("source")), str(keys["signal"])), (place, keys))
        return found

    def ticks(self, place: Place, question: str) -> bool:
        """Whether somebody took the mark of a question away in the line of a place."""
        comment = self.spoken.get(place)
        if comment is None:
            return False
        asked = asked_in(comment)
        bare = comment.lstrip("# ")
        return question in asked.answered or (
            not asked.open and not bare.startswith(_BY_JUDGEMENT) and (not bare or question in bare)
        )


def by_hand(before: str, drafted: str) -> ByHand | None:
    """before: the campaign file as it stands; drafted: of the same folder. None where the file can't be read."""
    try:
        own, base = parse_document(before, Path("campaign.yaml")), parse_document(drafted, Path("campaign.yaml"))
    except ThermodataError:
        return None
    if not isinstance(own.data, dict) or not str(own.data.get("schema", "")).startswith("thermodata/campaign"):
        return None
    names = names_in_draft(own.data, base.data)
    own = replace(own, data=with_sources_called(own.data, names))
    changed: dict[Place, dict[str, Any]] = {}
    added: dict[Place, Mapping[str, Any]] = {}
    spoken: dict[Place, str] = {}
    lines = before.splitlines()
    for section in SECTIONS:
        known = dict(entries_of(base.data, section))
        entries = dict(entries_of(own.data, section))
        same, twice = _same(section, entries, known), _twice(section, entries)
        for name, entry in entries.items():
            at = same.get(name)
            if at is None:
                added[section, name] = entry
                continue
            keys = {k: v for k, v in entry.items() if v != known[at].get(k) and not _is_open(v)}
            spoken[section, at] = parted(lines[_line(own, section, name) - 1])[1]
            if keys or at != name or (entry.get("source"), entry.get("signal")) in twice:
                of = {k: entry[k] for k in ("source", "signal") if section == "channels" and k in entry}
                changed[section, at] = {**of, **keys, **({NAME: name} if at != name else {})}
    for name, _ in entries_of(own.data, "sources"):
        spoken["sources", names.get(name, name)] = parted(lines[_line(own, "sources", name) - 1])[1]
    added |= {("sources", name): entry for name, entry in added_sources(own.data, base.data, names)}
    return ByHand(changed, added, _at_the_top(own.data, base.data), spoken, names)


def entries_of(data: Mapping[str, Any], section: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """(name, entry) of sources, channels and calibrations; (id, entry) of tests."""
    found = data.get(section)
    if isinstance(found, dict):
        yield from ((str(name), entry) for name, entry in found.items() if isinstance(entry, dict))
    if isinstance(found, list):
        yield from ((str(e["id"]), e) for e in found if isinstance(e, dict) and "id" in e)


def place_in(document: Document, section: str, name: str) -> Place | None:
    """Where an entry stands in a file."""
    found = document.data.get(section)
    if isinstance(found, list):
        at = next((i for i, e in enumerate(found) if isinstance(e, dict) and str(e.get("id")) == name), None)
        return None if at is None else (section, at)
    return (section, name) if isinstance(found, dict) and name in found else None


def _line(document: Document, section: str, name: str) -> int:
    place = place_in(document, section, name)
    assert place is not None
    return document.line[place]


def _same(section: str, own: Mapping[str, Mapping[str, Any]], known: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    """Entry -> what the draft calls it: a channel by its source and signal, anything else by its name. Of several
    channels of one signal one is that of the draft: the one that is called as it, else the first."""
    signals = {(e.get("source"), e["signal"]): n for n, e in known.items() if "signal" in e}
    found = {n: signals.get((e.get("source"), e["signal"])) for n, e in own.items() if "signal" in e}
    if section != "channels":
        return {name: name for name in own if name in known}
    made = {n: at for n, at in found.items() if at == n}
    for name, at in found.items():
        if at is not None and at not in made.values():
            made[name] = at
    return made | {n: n for n, e in own.items() if "signal" not in e and n in known}


def _twice(section: str, own: Mapping[str, Mapping[str, Any]]) -> set[tuple[Any, Any]]:
    """(source, signal) of which there are several channels."""
    every = [(e.get("source"), e.get("signal")) for e in own.values() if section == "channels" and "signal" in e]
    return {of for of in every if every.count(of) > 1}


def _is_open(value: Any) -> bool:
    return isinstance(value, str) and value in (UNKNOWN, "?")


def _at_the_top(own: Mapping[str, Any], base: Mapping[str, Any]) -> dict[str, Any]:
    found = {k: v for k, v in own.items() if k not in (*SECTIONS, *_OF_THE_DRAFT) and v != base.get(k)}
    machine = found.pop("machine", None)
    if isinstance(machine, dict) and (said := {k: v for k, v in machine.items() if not _is_open(v)}):
        found["machine"] = said
    before, after = own.get("tests_from"), base.get("tests_from")
    if isinstance(before, dict) and isinstance(after, dict) and before.get("set") != after.get("set"):
        found["tests_from.set"] = before.get("set")
    elif before is not None and after is None:
        found["tests_from"] = before
    return found
