"""The questions of a campaign file: those that have a field, with what stands there, and those that have none."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

from thermodata.draft.probes.which_way import may_be_asked, way_of, ways
from thermodata.draft.writing.asked import answers, asked_in, refers_to
from thermodata.draft.writing.unread import WHAT, unread
from thermodata.schema.files.campaign import Role, TestKind
from thermodata.schema.strict.lines import Document, Place, parse_document
from thermodata.schema.units.conversion import converts
from thermodata.schema.units.quantity import CANONICAL_UNIT
from thermodata.schema.words.places import PLACES

Kind = Literal[
    "place", "axis", "what", "unit", "way", "role", "kind", "start", "zone", "time", "moves", "moment", "text"
]
ROLES: tuple[str, ...] = get_args(Role)
KINDS: tuple[str, ...] = get_args(TestKind)
AXES = ("X", "Y", "Z", "A", "B", "C")
STANDBY = "on standby"  # control and hydraulics on, axes still: a balance of its own
STARTS = ("balance", "warm", STANDBY)
_CHOICES = {"place": tuple(PLACES), "what": WHAT, "role": ROLES, "kind": KINDS, "axis": AXES, "start": STARTS}
_UNITS = {
    "displacement": ("um", "mm", "m", "V"),
    "temperature": ("degC", "K", "degF"),
    "feed": ("mm/min", "m/min", "mm/s"),
}
# of the times of a table: key -> what is usual; any other value that a campaign file takes may be given too
_OF_TIMES = {
    "unit": ("s", "min", "h", "ms"),
    "format": ("dmy", "mdy", "ymd"),
    "start": ("dmy", "mdy", "ymd", "head", "none"),
    "period": (),
}
OF_TIME = "table.time."
_KIND: dict[str, Kind] = {
    "at": "place",
    "quantity": "what",
    "unit": "unit",
    "role": "role",
    "kind": "kind",
    "axis": "axis",
    "sign": "way",
    "start_state": "start",
    "start": "moment",
    "timezone": "zone",
    "moves": "moves",
}
UNREAD = "unread."
_PLACED = ("temperature", "state", "rotational_speed", "feed", "power", "load", "current", "flow", "position")


@dataclass(frozen=True, slots=True)
class Question:
    """name: how an answer is given back. value: what stands there, '' for nothing. hint: what the file says beside it.
    choices: the words that are known; any other place may be given too. open: whether nothing answers it, or the file
    still asks. asks: whether what stands there is a guess that the file asks about."""

    name: str
    about: str
    key: str
    kind: Kind
    value: str
    hint: str
    choices: tuple[str, ...] = ()
    open: bool = True
    asks: bool = False


@dataclass(frozen=True, slots=True)
class InFile:
    """A question without a field, for its answer is none of one word. line: counted from 1."""

    line: int
    asks: str


def questions(text: str) -> list[Question]:
    """What only the lab knows, in the order of the file. SpecError where the text is no campaign file."""
    document = parse_document(text, Path("campaign.yaml"))
    lines = text.splitlines()
    left_out = [
        Question(f"{UNREAD}{name}", name, "quantity", "what", "", hint, WHAT)
        for name, (_, hint) in unread(lines).items()
    ]
    own = ((p, key) for p, key in asked_places(document, lines) if asked_elsewhere(document, lines, p, key) is None)
    return [*left_out, *(_question(lines, document, place, key) for place, key in own)]


def asked_elsewhere(document: Document, lines: list[str], place: Place, key: str) -> str | None:
    """The source whose line asks what this place leaves open, for all that are alike; None where it asks itself."""
    asked = asked_in(lines[document.line[place] - 1]).open
    own = [q for q in asked if answers(last_of(key), q)]
    return refers_to(own[0]) if len(own) == 1 and place[0] == "sources" else None


def only_in_file(text: str) -> list[InFile]:
    """What the file asks and `questions` does not. SpecError where the text is no campaign file."""
    document = parse_document(text, Path("campaign.yaml"))
    lines = text.splitlines()
    keys: dict[int, list[str]] = {at: ["quantity"] for at, _ in unread(lines).values()}
    for place, key in asked_places(document, lines):
        keys.setdefault(document.line[place] - 1, []).append(last_of(key))
        if place[0] == "tests":  # the head of the section asks for the role of each
            keys.setdefault(document.line["tests",] - 1, []).append("role")
    return [
        InFile(i + 1, asks)
        for i, line in enumerate(lines)
        for asks in asked_in(line).open
        if not any(answers(key, asks) for key in keys.get(i, ()))
    ]


def asked_places(document: Document, lines: list[str]) -> Iterator[tuple[Place, str]]:
    data = document.data
    if isinstance(data.get("machine"), dict) and "id" in data["machine"]:
        yield ("machine", "id"), "id"
    for name, source in mapping_of(data, "sources").items():
        if isinstance(source, dict):
            yield from ((("sources", name), key) for key in _of_source(source, _asks(lines, document, "sources", name)))
    for name, channel in mapping_of(data, "channels").items():
        if isinstance(channel, dict):
            asks = _asks(lines, document, "channels", name)
            yield from ((("channels", name), key) for key in _of_channel(channel, asks, data))
    for name, calibration in mapping_of(data, "calibrations").items():
        if isinstance(calibration, dict) and calibration.get("kind") == "jump":
            yield ("calibrations", name), "moves"
    for i, test in enumerate(data.get("tests") or ()):
        if isinstance(test, dict):
            asks = _asks(lines, document, "tests", i)
            yield from ((("tests", i), key) for key in ("kind", "start", "start_state") if _any(key, asks))
            yield ("tests", i), "role"
    if isinstance(data.get("tests_from"), dict) and isinstance(data["tests_from"].get("set"), dict):
        yield ("tests_from", "set"), "role"


def _of_source(source: Mapping[str, Any], asks: tuple[str, ...]) -> Iterator[str]:
    if _any("timezone", asks) or "timezone" in source:
        yield "timezone"
    if _any("files", asks) and isinstance(source.get("files"), str):
        yield "files"
    time = mapping_of(mapping_of(source, "table"), "time")
    yield from (OF_TIME + key for key in _OF_TIMES if key in time and (time[key] == "unknown" or _any(key, asks)))


def _of_channel(channel: Mapping[str, Any], asks: tuple[str, ...], data: Mapping[str, Any]) -> Iterator[str]:
    if any(q.startswith(("quantity:", "what does it measure?")) for q in asks) and "quantity" in channel:
        yield "quantity"
    elif _any("unit", asks):
        yield "unit"
    probe = channel.get("quantity") == "displacement" and "derive" not in channel
    if _any("axis", asks) or (probe and "axis" not in channel):
        yield "axis"
    if _any("sign", asks) and _is_a_length(channel) and may_be_asked(channel, mapping_of(data, "calibrations")):
        yield "sign"
    if channel.get("quantity") in _PLACED or (probe and (_any("at", asks) or "at" not in channel)):
        yield "at"


def _is_a_length(channel: Mapping[str, Any]) -> bool:
    """Whether a sign turns it: volts want a jump test or a gain, and what has no unit yet is asked for that first."""
    unit = channel.get("unit")
    return channel.get("quantity") == "displacement" and unit is not None and converts(str(unit), "um")


def _asks(lines: list[str], document: Document, *place: str | int) -> tuple[str, ...]:
    """All that the line of a place asks or has asked: an answer can be changed."""
    asked = asked_in(lines[document.line[place] - 1])
    return (*asked.open, *asked.answered)


def _any(key: str, asks: tuple[str, ...]) -> bool:
    return any(answers(key, q) for q in asks)


def last_of(key: str) -> str:
    return key.rpartition(".")[2]


def _question(lines: list[str], document: Document, place: Place, key: str) -> Question:
    value, asked = value_of(document, place, key), asked_in(lines[document.line[place] - 1])
    kind = _KIND.get(key, "time" if key.startswith(OF_TIME) else "text")
    own = [q for q in asked.open if answers(last_of(key), q)]
    comment = lines[document.line[place] - 1].partition("# ")[2].removeprefix("? ")
    hint = "; ".join(own or [q for q in asked.answered if answers(last_of(key), q)]) or ("" if asked.open else comment)
    hint = hint if kind != "way" else ""  # what the draft says there is how to write it by hand
    if key == "role" and place[0] == "tests":  # 'kind spectrum, sure: name and data'
        hint = re.sub(r"^kind (?=sure|guess)", f"kind {document.data['tests'][place[1]].get('kind', '?')}, ", hint)
    about = str(document.data["tests"][place[1]].get("id", place[1])) if place[0] == "tests" else str(place[-1])
    opened = bool(own) or value in ("", "unknown") or (key == "role" and value == "none")
    value = "" if value == "unknown" else value
    choices = _choices(document, place, key, kind)
    return Question(name_of(place, key), about, key, kind, value, hint, choices, opened, bool(own and value))


def _choices(document: Document, place: Place, key: str, kind: Kind) -> tuple[str, ...]:
    if kind == "time":
        return _OF_TIMES[last_of(key)]
    if kind in ("way", "unit"):
        channel = document.data["channels"][place[1]]
        return ways(channel.get("axis")) if kind == "way" else _units(str(channel.get("quantity")))
    return _CHOICES.get(kind, ())


def _units(quantity: str) -> tuple[str, ...]:
    return _UNITS.get(quantity, (CANONICAL_UNIT[quantity],) if quantity in CANONICAL_UNIT else ())


def name_of(place: Place, key: str) -> str:
    return ".".join(str(part) for part in place) + ("" if place[-1] == key else f".{key}")


def value_of(document: Document, place: Place, key: str) -> str:
    found: Any = document.data
    for part in place:
        found = found[part]
    if key == "quantity":
        return f"{found['quantity']} [{found.get('unit', '')}]"
    if key == "sign":
        return way_of(found, mapping_of(document.data, "calibrations"))
    for part in key.split("."):
        found = found.get(part, "") if isinstance(found, dict) else found
    return ", ".join(map(str, found)) if isinstance(found, list) else str(found)


def mapping_of(data: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    found = data.get(key)
    return found if isinstance(found, dict) else {}
