"""Answers to the questions of a campaign file, in its own lines: comments and order stay as they are."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path

from thermodata.draft.probes.which_way import calibration_for, facing_and_way, its_name
from thermodata.draft.writing.asked import ticked
from thermodata.draft.writing.in_line import set_in_line
from thermodata.draft.writing.questions import (
    OF_TIME,
    STANDBY,
    UNREAD,
    asked_elsewhere,
    asked_places,
    last_of,
    mapping_of,
    name_of,
    value_of,
)
from thermodata.draft.writing.unread import come_to_life, quantity_and_unit, unread
from thermodata.draft.writing.write import flow, scalar
from thermodata.errors import UsageError
from thermodata.reader.times.time_units import check_unit
from thermodata.schema.files.load import parse_campaign
from thermodata.schema.strict.lines import Document, Place, parse_document
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.quantity import CANONICAL_UNIT

_STANDBY_NOTE = "began on standby: control and hydraulics on, axes still"
_WHOLE = re.compile(r"^([+-]?[1-9]\d*)$")  # whole numbers of no unit are um: no probe goes that many mm


def filled_in(text: str, given: Mapping[str, str]) -> str:
    """The text with the answers in their lines; empty answers change nothing, and what stands there already is no
    question any more where it is given. given: name of a question -> answer. SpecError where the file would not load
    then; UsageError for an answer to what was not asked, or of several lines."""
    document = parse_document(text, Path("campaign.yaml"))
    lines = text.splitlines()
    known = {name_of(place, key): (place, key) for place, key in asked_places(document, lines)}
    left_out = unread(lines)
    new: dict[str, str] = {}
    done: dict[int, list[str]] = {}
    for name, answer in _of_all_alike(given, known, document, lines).items():
        channel = name.removeprefix(UNREAD)
        if name not in known and not (name.startswith(UNREAD) and channel in left_out):
            raise UsageError(
                f"no question '{name}'",
                expected=", ".join(known)[:500],
                hint="the draft was made anew meanwhile: look at what it asks now",
            )
        answer = answer.strip()
        if not answer:
            continue
        if not answer.isprintable() or len(answer) > 2000:
            raise UsageError("an answer is one line", where=name, hint="write it without line breaks")
        if name not in known:
            at = left_out[channel][0]
            lines[at] = _said(come_to_life(lines[at], answer), answer, ("channels", channel))
            continue
        place, key = known[name]
        at = document.line[place] - 1
        if answer != value_of(document, place, key):
            new |= _put(lines, document, (place, key), answer, new)
        done.setdefault(at, []).append(last_of(key))
    for at, keys in done.items():
        lines[at] = ticked(lines[at], keys)
    filled = "\n".join(_with_calibrations(lines, document, new)) + "\n"
    parse_campaign(filled, "campaign.yaml")
    return filled


def _of_all_alike(
    given: Mapping[str, str], known: Mapping[str, tuple[Place, str]], document: Document, lines: list[str]
) -> dict[str, str]:
    """The answers, those of a source for all whose lines refer to its question as well."""
    found = dict(given)
    for name, (place, key) in known.items():
        first = asked_elsewhere(document, lines, place, key)
        asked = name_of(("sources", first), key) if first is not None else ""
        if given.get(asked) and not given.get(name):
            found[name] = given[asked]
    return found


def _put(
    lines: list[str], document: Document, asked: tuple[Place, str], answer: str, new: Mapping[str, str]
) -> dict[str, str]:
    """An answer in its line; {name: mapping} of a calibration that it makes."""
    (place, key), at = asked, document.line[asked[0]] - 1
    if key == "sign":
        return _turned(lines, document, place, answer, new)
    if key == "quantity":
        lines[at] = _said(lines[at], answer, place)
    elif key.startswith(OF_TIME):
        lines[at] = set_in_line(lines[at], "table", _with_time(document, place, last_of(key), answer), place)
    elif key == "start_state" and answer == STANDBY:
        lines[at] = _on_standby(lines[at], document, place)
    else:
        if key == "at" and _is_tools(document, place, answer):
            lines[at] = set_in_line(lines[at], "relative_to", "table", place)
        if key == "unit" and document.data["channels"][place[1]].get("quantity") != "displacement":
            linear_conversion(answer, CANONICAL_UNIT[document.data["channels"][place[1]]["quantity"]])
        lines[at] = set_in_line(lines[at], key, _written(key, answer), place)
    return {}


def _is_tools(document: Document, place: Place, at: str) -> bool:
    """Whether a displacement is said to be the tool's, which a probe reads against the table, as a draft has it."""
    channel = document.data["channels"][place[1]] if place[0] == "channels" else {}
    return at == "tcp" and channel.get("quantity") == "displacement" and "relative_to" not in channel


def _on_standby(line: str, document: Document, place: Place) -> str:
    """The line of a test before which the machine stood with control and hydraulics on: in balance, though not as cold
    as one that was off, which its notes say."""
    line = set_in_line(line, "start_state", "balance", place)
    said = str(document.data["tests"][place[1]].get("notes", ""))
    notes = "; ".join(filter(None, (said, _STANDBY_NOTE)))
    return line if _STANDBY_NOTE in said else set_in_line(line, "notes", json.dumps(notes, ensure_ascii=False), place)


def _with_time(document: Document, place: Place, key: str, answer: str) -> str:
    """The layout of a source's table, as YAML, with one key of its times."""
    table = mapping_of(document.data["sources"][place[1]], "table")
    if key == "unit":
        answer = check_unit(answer, str(place[1]))
    return "{" + flow({**table, "time": {**mapping_of(table, "time"), key: answer}}) + "}"


def _said(line: str, answer: str, place: Place) -> str:
    quantity, unit = quantity_and_unit(answer, str(place[-1]))
    return set_in_line(set_in_line(line, "quantity", quantity, place), "unit", scalar(unit), place)


def _turned(lines: list[str], document: Document, place: Place, answer: str, new: Mapping[str, str]) -> dict[str, str]:
    """The sign of a channel in its calibration's line; {name: mapping} of a calibration that has no line yet."""
    channel, known = document.data["channels"][place[1]], mapping_of(document.data, "calibrations")
    facing, way = facing_and_way(answer, name_of(place, "sign"), channel.get("axis"))
    stands = str(channel.get("calibration", ""))
    if stands in known:
        at = document.line["calibrations", stands] - 1
        for key, value in (("axis", facing[1:]), ("facing", facing), ("increases_with", way)):
            lines[at] = set_in_line(lines[at], key, value, ("calibrations", stands))
        return {}
    at, name = document.line[place] - 1, its_name(str(place[1]), facing, {**known, **new})
    lines[at] = set_in_line(lines[at], "calibration", name, place)
    return {name: calibration_for(facing[1:], facing, way)}


def _with_calibrations(lines: list[str], document: Document, new: Mapping[str, str]) -> list[str]:
    """The lines with further calibrations after the head of that section; before the channels where there is none."""
    if not new:
        return lines
    added = [f"  {name}: {body}" for name, body in new.items()]
    if isinstance(document.data.get("calibrations"), dict):
        at = document.line["calibrations",]
        return [*lines[:at], *added, *lines[at:]]
    at = document.line["channels",] - 1
    return [*lines[:at], "calibrations:", *added, *lines[at:]]


def _written(key: str, answer: str) -> str:
    if key != "moves":
        return scalar(answer)
    parts = (_WHOLE.sub(r"\1 um", part.strip()) for part in answer.strip("[] ").split(","))
    return "[" + ", ".join(scalar(part) for part in parts if part) + "]"
