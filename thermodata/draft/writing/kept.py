"""A draft made anew with what somebody had written into the campaign file before: answers, tests, calibrations."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import yaml

from thermodata.draft.folder.into_sources.sources_before import sources_in, who_reads
from thermodata.draft.signals.told_before import NAME
from thermodata.draft.writing.asked import ticked, ticked_where
from thermodata.draft.writing.by_hand import SECTIONS, ByHand, entries_of, place_in
from thermodata.draft.writing.in_line import set_in_line
from thermodata.draft.writing.write import one_line
from thermodata.schema.files.tests_from import pattern_of
from thermodata.schema.strict.lines import Document, Place, parse_document
from thermodata.schema.words.sentences import with_dots

_SHOWN = 12
_KEPT = "   # as in the campaign file before"
_AS_BEFORE = ("source", "signal", NAME)


def with_answers(text: str, hand: ByHand) -> str:
    """The text of a draft with what somebody wrote by hand; notes say what of it, and what is not kept. SpecError where
    the lines do not load together."""
    lines = _lines_filled(text, hand)
    left: list[str] = []
    # sources first, for what names them; each goes to the head of its section, the last one before the others
    added = [*hand.added.items()][::-1]
    added.sort(key=lambda one: one[0][0] != "sources")
    for place, entry in added:
        lines, why_not = _with_entry(lines, place, entry, hand)
        left += [f"{place[1]} of {place[0]}, {why_not}"] if why_not else []
    lines = _at_the_top(_without_replaced(lines, hand), hand.top)
    gone = {x.partition(",")[0] for x in left}
    said = [*(x for x in _told(hand) if x not in gone), *(str(key) for key in hand.top)]
    notes = [f"# note: kept from the campaign file before: {one_line(with_dots(said, _SHOWN))}"] if said else []
    if hand.sources:
        other = [f"'{was}' is '{now}' now" for was, now in hand.sources.items()]
        notes.append(f"# note: sources are called otherwise than before: {one_line(with_dots(other, _SHOWN))}")
    if left:
        notes.append(f"# note: not kept from the campaign file before: {one_line(with_dots(left[::-1], _SHOWN))}")
    return "\n".join([*lines, *notes]) + "\n"


def _lines_filled(text: str, hand: ByHand) -> list[str]:
    """The lines with the keys that somebody gave, and without the marks of questions that these answer."""
    document, lines = _parsed(text), text.splitlines()
    for section in (*SECTIONS, "sources"):
        for name, entry in entries_of(document.data, section):
            place = place_in(document, section, name)
            before = _before(hand, section, name, entry)
            if place is None or before is None:
                continue
            at = document.line[place] - 1
            given = {k: v for k, v in hand.changed.get(before, {}).items() if k not in _AS_BEFORE}
            given = given or ({} if before in hand.changed else dict(hand.added.get(before, {})))
            for key, value in given.items():
                if entry.get(key) != value:
                    lines[at] = set_in_line(lines[at], key, flow_of(value), place)
            lines[at] = ticked(lines[at], list(given))
            lines[at] = ticked_where(lines[at], partial(hand.ticks, before))
    return lines


def _before(hand: ByHand, section: str, name: str, entry: Mapping[str, Any]) -> Place | None:
    """What somebody changed of an entry of the draft: a channel may have another name since."""
    if section == "channels" and "signal" in entry:
        of = hand.of_signals().get((str(entry.get("source")), str(entry["signal"])))
        if of is not None:
            return of[0]
    for place, keys in (*hand.changed.items(), *hand.added.items()):
        if place == (section, name) and not (section == "channels" and "signal" in keys):
            return place
    return (section, name) if (section, name) in hand.spoken else None


def _with_entry(lines: list[str], place: Place, entry: Mapping[str, Any], hand: ByHand) -> tuple[list[str], str]:
    """The lines with a further entry at the head of its section, which may be new; unless it has it by now. (lines, why
    it is not kept; '' where it is)."""
    section, name = place
    document = _parsed("\n".join(lines))
    if section == "channels" and "signal" in entry:
        of = (str(entry.get("source")), str(entry["signal"]))
        there = any(
            (str(e.get("source")), str(e.get("signal"))) == of for _, e in entries_of(document.data, "channels")
        )
        if there and hand.of_signals()[of][0] == place:
            return lines, ""
        if place_in(document, "channels", str(name)) is not None:
            return lines, f"for that is called so of '{entry['signal']}', which the draft does not have"
    if place_in(document, str(section), str(name)) is not None:
        return lines, ""
    if section == "sources" and (reads := who_reads(entry, document.data)) is not None:
        return lines, f"for '{reads}' has its files now"
    if section != "sources" and (gone := sorted({*sources_in(entry)} - {*document.data["sources"]})):
        return lines, f"for the draft has no source '{gone[0]}'"
    body = flow_of(entry)
    line = f"  - {body}{_KEPT}" if section == "tests" else f"  {name}: {body}{_KEPT}"
    if document.data.get(section):
        at = document.line[str(section),]
        return [*lines[:at], line, *lines[at:]], ""
    empty = document.line.get((str(section),))
    head, rest = (lines[: empty - 1], lines[empty:]) if empty else _before_tests(lines, document)
    return [*head, f"{section}:", line, *rest], ""


def _before_tests(lines: list[str], document: Document) -> tuple[list[str], list[str]]:
    at = next((document.line[key,] - 1 for key in ("tests", "tests_from") if (key,) in document.line), len(lines))
    return lines[:at], lines[at:]


def _without_replaced(lines: list[str], hand: ByHand) -> list[str]:
    """Without tests of the draft whose logs somebody gave to tests of his own, as to parts of a long recording, or to
    tests by a pattern, beside which a line of a test counts more."""
    if "tests_from" in hand.top:
        return _without_section(lines, "tests")
    own = {str(p) for (s, _), e in hand.added.items() if s == "tests" for p in _paths(e.get("files"))}
    if not own:
        return lines
    document = _parsed("\n".join(lines))
    templates = [str(s["files"]) for s in document.data["sources"].values() if isinstance(s.get("files"), str)]
    gone = set[int]()
    for name, entry in entries_of(document.data, "tests"):
        if ("tests", name) in hand.added or ("tests", name) in hand.changed:
            continue
        of = {str(p) for p in _paths(entry.get("files"))} or {t.replace("{test}", name) for t in templates}
        place = place_in(document, "tests", name)
        if place is not None and any(pattern_of(p).fullmatch(path) for p in of for path in own):
            gone.add(document.line[place] - 1)
    return [line for i, line in enumerate(lines) if i not in gone]


def _without_section(lines: list[str], section: str) -> list[str]:
    document = _parsed("\n".join(lines))
    gone = {at - 1 for place, at in document.line.items() if place[:1] == (section,)}
    return [line for i, line in enumerate(lines) if i not in gone]


def _paths(files: Any) -> Iterator[Any]:
    for value in files.values() if isinstance(files, dict) else ():
        yield from value if isinstance(value, list) else [value]


def _at_the_top(lines: list[str], top: Mapping[str, Any]) -> list[str]:
    document, made = _parsed("\n".join(lines)), list(lines)
    added: list[tuple[int, str]] = []
    for key, value in top.items():
        if key == "tests_from.set" and isinstance(document.data.get("tests_from"), dict):
            at = document.line["tests_from", "set"] - 1
            made[at] = f"  set: {flow_of(value)}{_KEPT}"
        elif key == "machine" and isinstance(document.data.get("machine"), dict):
            at = document.line["machine", "id"] - 1
            made[at] = f"  id: {flow_of(value['id'])}{_KEPT}" if "id" in value else made[at]
            added += [(at + 1, f"  {k}: {flow_of(v)}") for k, v in value.items() if k != "id"]
        elif (key,) in document.line:
            at = document.line[key,] - 1
            made[at] = f"{key}: {flow_of(value)}"
        elif key != "tests_from.set":
            added.append((len(made), f"{key}: {flow_of(value)}"))
    for at, line in sorted(added, key=lambda one: one[0], reverse=True):
        made.insert(at, line)
    return made


def _told(hand: ByHand) -> Iterable[str]:
    for (_, name), keys in hand.changed.items():
        given = [str(k) for k in keys if k not in _AS_BEFORE]
        if given or NAME in keys:
            yield f"{name} ({', '.join(given)})" if given else str(keys[NAME])
    yield from (f"{name} of {section}" for section, name in hand.added)


def _parsed(text: str) -> Document:
    return parse_document(text, Path("campaign.yaml"))


class _OneLine(yaml.SafeDumper):
    """Texts of several lines between double quotes, where a break is a letter."""


def _text(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
    style = '"' if len(text.splitlines()) > 1 or text.endswith("\n") else None
    return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=style)


_OneLine.add_representer(str, _text)


def flow_of(value: Any) -> str:
    """A value as YAML on one line."""
    made = yaml.dump(value, Dumper=_OneLine, default_flow_style=True, width=10**9, sort_keys=False, allow_unicode=True)
    return str(made).removesuffix("\n...\n").rstrip("\n")
