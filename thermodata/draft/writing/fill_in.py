"""The questions of a campaign file, and their answers in its own lines: comments and order stay as they are."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

from thermodata.draft.probes.which_way import (
    ASKED,
    calibration_for,
    facing_and_way,
    its_name,
    may_be_asked,
    way_of,
    ways,
)
from thermodata.draft.writing.unread import GUESSED, WHAT, come_to_life, quantity_and_unit, unread
from thermodata.draft.writing.write import scalar
from thermodata.errors import UsageError
from thermodata.schema.files.campaign import Role, TestKind
from thermodata.schema.files.load import parse_campaign
from thermodata.schema.strict.lines import Document, Place, parse_document
from thermodata.schema.words.places import PLACES

Kind = Literal["place", "axis", "what", "way", "role", "kind", "start", "zone", "moves", "text"]
ROLES: tuple[str, ...] = get_args(Role)
KINDS: tuple[str, ...] = get_args(TestKind)
AXES = ("X", "Y", "Z", "A", "B", "C")
STARTS = ("balance", "warm")
_CHOICES = {"place": tuple(PLACES), "what": WHAT, "role": ROLES, "kind": KINDS, "axis": AXES, "start": STARTS}
_UNREAD = "unread."
_PLACED = ("temperature", "state", "rotational_speed", "feed", "power", "load", "current", "flow", "position")


@dataclass(frozen=True, slots=True)
class Question:
    """name: how an answer is given back. value: what stands there, '' for nothing. hint: what the file says beside it.
    choices: the words that are known; any other place may be given too. open: whether nothing else answers it."""

    name: str
    about: str
    key: str
    kind: Kind
    value: str
    hint: str
    choices: tuple[str, ...] = ()
    open: bool = True


def questions(text: str) -> list[Question]:
    """What only the lab knows, in the order of the file. SpecError where the text is no campaign file."""
    document = parse_document(text, Path("campaign.yaml"))
    lines = text.splitlines()
    left_out = [
        Question(f"{_UNREAD}{name}", name, "quantity", "what", "", hint, WHAT)
        for name, (_, hint) in unread(lines).items()
    ]
    return [*left_out, *(_question(lines, document, place, key) for place, key in _asked(document, lines))]


def filled_in(text: str, answers: Mapping[str, str]) -> str:
    """The text with the answers in their lines; empty answers change nothing. SpecError where the file would not load
    then; UsageError for an answer to what was not asked, or of several lines."""
    document = parse_document(text, Path("campaign.yaml"))
    lines = text.splitlines()
    known = {_name(place, key): (place, key) for place, key in _asked(document, lines)}
    left_out = unread(lines)
    new: dict[str, str] = {}
    for name, answer in answers.items():
        channel = name.removeprefix(_UNREAD)
        if name not in known and not (name.startswith(_UNREAD) and channel in left_out):
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
            lines[at] = _said(come_to_life(lines[at]), answer, ("channels", channel))
            continue
        place, key = known[name]
        at = document.line[place] - 1
        if answer == _value(document, place, key):
            continue
        if key == "quantity":
            lines[at] = _said(lines[at], answer, place)
        elif key == "sign":
            new |= _turned(lines, document, place, answer, new)
        else:
            lines[at] = set_in_line(lines[at], key, _written(key, answer), place)
        # what is answered is no question any more
        lines[at] = lines[at].replace("# ? ", "# answered: ", 1)
    filled = "\n".join(_with_calibrations(lines, document, new)) + "\n"
    parse_campaign(filled, "campaign.yaml")
    return filled


def _said(line: str, answer: str, place: Place) -> str:
    quantity, unit = quantity_and_unit(answer, str(place[-1]))
    return set_in_line(set_in_line(line, "quantity", quantity, place), "unit", scalar(unit), place)


def _turned(lines: list[str], document: Document, place: Place, answer: str, new: Mapping[str, str]) -> dict[str, str]:
    """The sign of a channel in its calibration's line; {name: mapping} of a calibration that has no line yet."""
    channel, known = document.data["channels"][place[1]], _mapping(document.data, "calibrations")
    facing, way = facing_and_way(answer, _name(place, "sign"), channel.get("axis"))
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


def _asked(document: Document, lines: list[str]) -> Iterator[tuple[Place, str]]:
    data = document.data
    if isinstance(data.get("machine"), dict) and "id" in data["machine"]:
        yield ("machine", "id"), "id"
    for name in _mapping(data, "sources"):
        if "timezone?" in lines[document.line["sources", name] - 1] or "timezone" in data["sources"][name]:
            yield ("sources", name), "timezone"
    for name, channel in _mapping(data, "channels").items():
        if isinstance(channel, dict) and GUESSED in lines[document.line["channels", name] - 1]:
            yield ("channels", name), "quantity"
        if isinstance(channel, dict) and "axis?" in lines[document.line["channels", name] - 1].partition("#")[2]:
            yield ("channels", name), "axis"
        asks = ASKED in lines[document.line["channels", name] - 1].partition("#")[2]
        if asks and isinstance(channel, dict) and may_be_asked(channel, _mapping(data, "calibrations")):
            yield ("channels", name), "sign"
        if isinstance(channel, dict) and channel.get("quantity") in _PLACED:
            yield ("channels", name), "at"
    for name, calibration in _mapping(data, "calibrations").items():
        if isinstance(calibration, dict) and calibration.get("kind") == "jump":
            yield ("calibrations", name), "moves"
    for i, test in enumerate(data.get("tests") or ()):
        if isinstance(test, dict):
            if "# ? kind" in lines[document.line["tests", i] - 1]:
                yield ("tests", i), "kind"
            if "start_state:" in lines[document.line["tests", i] - 1].partition("#")[2]:
                yield ("tests", i), "start_state"
            yield ("tests", i), "role"
    if isinstance(data.get("tests_from"), dict) and isinstance(data["tests_from"].get("set"), dict):
        yield ("tests_from", "set"), "role"


def _mapping(data: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    found = data.get(key)
    return found if isinstance(found, dict) else {}


def _question(lines: list[str], document: Document, place: Place, key: str) -> Question:
    value, line = _value(document, place, key), lines[document.line[place] - 1]
    hint = line.partition("# ")[2].removeprefix("? ")
    kind: Kind = {
        "at": "place",
        "quantity": "what",
        "role": "role",
        "kind": "kind",
        "axis": "axis",
        "sign": "way",
        "start_state": "start",
        "timezone": "zone",
        "moves": "moves",
    }.get(key, "text")  # type: ignore[assignment]
    choices = ways(document.data["channels"][place[1]].get("axis")) if kind == "way" else _CHOICES.get(kind, ())
    hint = hint if kind != "way" else ""  # what the draft says there is how to write it by hand
    about = str(document.data["tests"][place[1]].get("id", place[1])) if place[0] == "tests" else str(place[-1])
    opened = value in ("", "unknown") or (key == "role" and value == "none")
    return Question(_name(place, key), about, key, kind, "" if value == "unknown" else value, hint, choices, opened)


def _name(place: Place, key: str) -> str:
    return ".".join(str(part) for part in place) + ("" if place[-1] == key else f".{key}")


def _value(document: Document, place: Place, key: str) -> str:
    found: Any = document.data
    for part in place:
        found = found[part]
    if key == "quantity":
        return f"{found['quantity']} [{found.get('unit', '')}]"
    if key == "sign":
        return way_of(found, _mapping(document.data, "calibrations"))
    if isinstance(found, dict):
        found = found.get(key, "")
    return ", ".join(map(str, found)) if isinstance(found, list) else str(found)


def _written(key: str, answer: str) -> str:
    if key != "moves":
        return scalar(answer)
    return "[" + ", ".join(scalar(part.strip()) for part in answer.strip("[] ").split(",") if part.strip()) + "]"


def set_in_line(line: str, key: str, value: str, place: Place) -> str:
    """The line of a place with one key of its flow mapping (or its own plain value) set. value: as YAML."""
    start = line.find("{")
    comment = line.find("#")
    if start < 0 or (0 <= comment < start):
        made = re.sub(
            rf"^(\s*(?:- )?{re.escape(str(place[-1]))}:\s*)[^#]*?(\s*(?:#.*)?)$", lambda m: m[1] + value + m[2], line
        )
    else:
        stop = _closing(line, start)
        entries = [e for e in _entries(line[start + 1 : stop]) if e]
        at = next((i for i, e in enumerate(entries) if re.match(rf"[\"']?{re.escape(key)}[\"']?\s*:", e)), None)
        if at is None:
            entries.append(f"{key}: {value}")
        else:
            entries[at] = f"{key}: {value}"
        made = line[: start + 1] + ", ".join(entries) + line[stop:]
    return made


def _closing(line: str, start: int) -> int:
    depth = 0
    for i, letter in _outside_quotes(line, start):
        depth += (letter in "{[") - (letter in "}]")
        if depth == 0:
            return i
    raise UsageError(
        "this line can't be filled in",
        where=line.strip()[:200],
        expected="a mapping on one line",
        hint="edit the file by hand there",
    )


def _entries(body: str) -> list[str]:
    parts, depth, last = [], 0, 0
    for i, letter in _outside_quotes(body, 0):
        depth += (letter in "{[") - (letter in "}]")
        if letter == "," and depth == 0:
            parts.append(body[last:i].strip())
            last = i + 1
    return [*parts, body[last:].strip()]


def _outside_quotes(text: str, start: int) -> Iterator[tuple[int, str]]:
    quote = ""
    i = start
    while i < len(text):
        letter = text[i]
        if quote:
            if letter == "\\" and quote == '"':
                i += 1
            elif letter == quote:
                quote = ""
        elif letter in "\"'":
            quote = letter
        else:
            yield i, letter
        i += 1
