"""MTConnect stream documents: one, or a log of many one after another, as an agent answered them.

Observations are ordered by the agent's instance and sequence, not by time; what an agent sends again is dropped, and
sequences that it no longer held when it was asked are a loss.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Source
from thermodata_reader_cnc import events
from thermodata_reader_cnc.events import Event, HeldTable

_END = re.compile(rb"</(?:\w+:)?MTConnectStreams\s*>")
_START = re.compile(rb"<(?:\w+:)?MTConnectStreams[\s>]")
_PART = 1 << 20
_MOST = 256 << 20
_LOOK = 8 << 20


def claims(text: str) -> str | None:
    """The reason for claiming a text, or None."""
    if re.search(r"<(?:\w+:)?MTConnectStreams[\s>]", text[:4096]):
        return "MTConnect: the root is MTConnectStreams"
    return None


@dataclass(frozen=True, slots=True)
class Observation:
    sequence: int
    time: str
    key: str
    value: str


@dataclass(slots=True)
class Document:
    """instance, first, next: of the agent's header, None where it has none."""

    place: str
    instance: int | None
    first: int | None
    next: int | None
    observations: list[Observation]
    series: set[str]


@dataclass(slots=True)
class Names:
    """Data item -> signal name: its own name, or its id where it has none or another item has it too."""

    taken: dict[str, str] = field(default_factory=dict)
    properties: dict[str, dict[str, str]] = field(default_factory=dict)

    def of(self, device: str, component: str, group: str, element: ET.Element) -> str:
        item = element.get("dataItemId", "").rstrip("=") or _tag(element)
        name = element.get("name", "").rstrip("=") or item
        owner = f"{device}/{item}"
        for candidate in (name, item, owner):
            if self.taken.setdefault(candidate, owner) == owner:
                if candidate not in self.properties:
                    said = {"dataItemId": item, "device": device, "component": component, "type": _tag(element),
                            "subType": element.get("subType", ""), "category": group.rstrip("s").upper()}
                    self.properties[candidate] = {k: v for k, v in said.items() if v}
                return candidate
        return owner


def documents(path: Path, names: Names) -> Iterator[Document | Loss]:
    """The documents of a file, one after another; a Loss for what is between or cut."""
    size, number = max(1, path.stat().st_size), 0
    with path.open("rb") as file:
        rest, offset = b"", 0
        while True:
            part = file.read(_PART)
            rest += part
            while (end := _END.search(rest)) is not None:
                text, rest = rest[:end.end()], rest[end.end():]
                number += 1
                yield _document(text, f"{path.name} document {number} (byte {offset})", names, size)
                offset += len(text)
            if len(rest) > _MOST:
                raise FormatError("a document without an end", where=f"{path.name} byte {offset}",
                                  expected="</MTConnectStreams>", got=f"{len(rest)} bytes")
            if not part:
                break
        start = _START.search(rest)
        if start is not None:
            found = _cut(rest[start.start():], f"{path.name} document {number + 1} (byte {offset})", names)
            if found is not None:
                yield found
        if b"<" in rest:
            yield Loss(f"{path.name} byte {offset}", fraction=len(rest) / size,
                       reason="the last document is cut; the observations before the cut are kept")


def _document(text: bytes, place: str, names: Names, size: int) -> Document | Loss:
    start = _START.search(text)
    if start is None:
        return Loss(place, fraction=len(text) / size, reason="an end of a document without a start")
    body = text[start.start():]
    if b"<!DOCTYPE" in body or b"<!ENTITY" in body:
        return Loss(place, fraction=len(text) / size, reason="a document type or entities: not read")
    declaration = re.search(rb"<\?xml[^>]*encoding=[\"']([\w.-]+)", text[:start.start()])
    try:
        parser = ET.XMLParser(encoding=declaration[1].decode() if declaration else "utf-8")
        root = ET.fromstring(body, parser)
    except (ET.ParseError, LookupError, ValueError) as error:
        return Loss(place, fraction=len(text) / size, reason=f"no XML: {error}")
    return _read(root, place, names)


def _cut(body: bytes, place: str, names: Names) -> Document | None:
    """What of a cut document is whole."""
    if b"<!DOCTYPE" in body or b"<!ENTITY" in body:
        return None
    parser: Any = ET.XMLPullParser(events=("start", "end"))
    root: ET.Element | None = None
    whole: set[ET.Element] = set()
    try:
        parser.feed(body)
        for event, element in parser.read_events():
            if event == "start" and root is None:
                root = element
            if event == "end":
                whole.add(element)
    except ET.ParseError:
        pass
    return None if root is None else _read(root, place, names, whole)


def _read(root: ET.Element, place: str, names: Names, whole: set[ET.Element] | None = None) -> Document:
    header: dict[str, int | None] = {}
    found, series = [], set[str]()
    for element in root:
        if _tag(element) == "Header":
            header = {k: _number(v) for k, v in element.attrib.items()}
    for device in _all(root, "DeviceStream"):
        for component in _all(device, "ComponentStream"):
            label = component.get("name", "").rstrip("=") or component.get("component", "").rstrip("=")
            for group in component:
                for element in group:
                    if whole is not None and element not in whole:
                        continue
                    name = names.of(device.get("name", "").rstrip("="), label, _tag(group), element)
                    text = (element.text or "").strip()
                    value = _tag(element).upper() if _tag(group) == "Condition" else text
                    sequence, time = _number(element.get("sequence")), element.get("timestamp", "").rstrip("=")
                    if element.get("sampleRate") is not None:
                        series.add(name)
                    elif sequence is not None and time:
                        found.append(Observation(sequence, time, name, value))
    return Document(place, header.get("instanceId"), header.get("firstSequence"), header.get("nextSequence"), found,
                    series)


def _all(parent: ET.Element, tag: str) -> Iterator[ET.Element]:
    return (e for e in parent.iter() if _tag(e) == tag)


def _tag(element: ET.Element) -> str:
    return element.tag.rsplit("}", 1)[-1]


def _number(text: str | None) -> int | None:
    digits = re.match(r"\s*(\d+)", text or "")
    return int(digits[1]) if digits else None


class Order:
    """Puts the observations of documents in the agent's order, each once."""

    def __init__(self) -> None:
        self.instance: int | None = None
        self.next: int | None = None
        self.seen: dict[str, int] = {}
        self.times: dict[str, str] = {}
        self.refused: set[str] = set()

    def of(self, document: Document) -> Iterator[Event | Loss]:
        """The new observations of a document as events."""
        if document.instance != self.instance:
            self.instance, self.next, self.seen = document.instance, None, {}
        if self.next is not None and document.first is not None and document.first > self.next:
            yield Loss(document.place, reason=f"sequences {self.next} to {document.first - 1} are lost: the agent's "
                                              "buffer no longer held them when it was asked")
        for name in document.series - self.refused:
            self.refused.add(name)
            yield Loss(document.place, reason=f"'{name}' is a time series with its own rate; it is not read")
        for each in sorted(document.observations, key=lambda o: o.sequence):
            if each.sequence <= self.seen.get(each.key, -1):
                continue
            again = each.key not in self.seen and self.times.get(each.key, "") >= each.time
            self.seen[each.key] = each.sequence
            if again:
                continue                                 # a restarted agent sends what it had
            self.times[each.key] = max(each.time, self.times.get(each.key, ""))
            yield Event(each.time, each.key, each.value, f"{document.place} sequence {each.sequence}")
        if document.next is not None:
            self.next = max(self.next or 0, document.next)


def _events(path: Path, names: Names, limit: int | None = None) -> Iterator[Event | Loss]:
    order, count = Order(), 0
    for document in documents(path, names):
        if isinstance(document, Loss):
            yield document
            continue
        yield from order.of(document)
        count += len(document.observations)
        if limit is not None and count > limit:
            return


def _plan(path: Path) -> tuple[events.Plan, str | None, Names]:
    names = Names()
    limit = None if path.stat().st_size <= _LOOK else 20_000
    found, first = events.plan(_events(path, names, limit),
                               lambda key: names.properties.get(key, {}).get("category") == "SAMPLE")
    return found, first, names


def describe(path: Path, source: Source) -> Recording:
    """Items and the first time of a log, by its first documents."""
    found, first, names = _plan(path)
    if not found:
        raise FormatError("no observations", where=path.name, expected="MTConnectStreams with observations",
                          got="none")
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - 4096))
        behind = _END.split(file.read())
        # a log may end behind any document, so a whole last one proves nothing
        complete = len(behind) > 1 and b"<" not in behind[-1]
    return events.recording(found, first, source, names.properties, None if complete else False)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """Rows of held values in the agent's order, and what is missing."""
    found, _, names = _plan(path)
    told: set[str] = set()

    def complain(event: Event, reason: str) -> Iterator[Loss]:
        if event.key not in told:
            told.add(event.key)
            yield Loss(event.at, reason=f"'{event.key}': {reason}")

    table = HeldTable(found, source, complain)
    for event in _events(path, names):
        if isinstance(event, Loss):
            yield event
        else:
            yield from table.add(event)
    yield from table.flush()
