"""One MTConnectStreams document as a stream: its header and its observations as they stand."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import NamedTuple
from xml.parsers import expat

from thermodata.reader.text.cells.values.number import to_float
from thermodata_reader_cnc.mtconnect.time_series import Report

_MOST_TEXT = 1 << 24  # characters of one value
_DEEP = 256
_DEVICE, _COMPONENT, _GROUP, _OBSERVATION = range(4)  # each within the one before
_CELLS = ("Entry", "Cell")  # of data sets and tables


class Observation(NamedTuple):
    """rate_hz, samples: of a time series."""

    sequence: int
    time: str
    key: str
    value: str
    series: bool = False
    rate_hz: float | None = None
    samples: int | None = None

    def report(self, file: str) -> Report:
        """Of one that is a time series."""
        return Report(
            self.time, self.key, self.rate_hz, self.value, self.sequence, f"{file} sequence", count=self.samples
        )


@dataclass(slots=True)
class Document:
    """instance, first, next: of the agent's header, None where it has none. whole: its end was read."""

    place: str
    instance: int | None = None
    first: int | None = None
    next: int | None = None
    observations: list[Observation] = field(default_factory=list)
    assets: int = 0
    undated: int = 0
    whole: bool = False


@dataclass(slots=True)
class Names:
    """Data item -> signal name: its own name, or its id where it has none or another item has it too. entries: the
    entries of data sets and tables by the item's name."""

    taken: dict[str, str] = field(default_factory=dict)
    properties: dict[str, dict[str, str]] = field(default_factory=dict)
    entries: dict[str, set[str]] = field(default_factory=dict)

    def of(self, device: str, component: str, group: str, tag: str, attributes: dict[str, str]) -> str:
        """The signal name of an observation."""
        item = attributes.get("dataItemId", "").rstrip("=") or tag
        name = attributes.get("name", "").rstrip("=") or item
        owner = f"{device}/{item}"
        for candidate in (name, item, owner):
            if self.taken.setdefault(candidate, owner) == owner:
                if candidate not in self.properties:
                    said = {
                        "dataItemId": item,
                        "device": device,
                        "component": component,
                        "type": tag,
                        "subType": attributes.get("subType", ""),
                        "category": group.rstrip("s").upper(),
                    }
                    self.properties[candidate] = {k: v for k, v in said.items() if v}
                return candidate
        return owner


class EndError(Exception):
    """The root ended."""


class NextError(Exception):
    """Another root inside the document: this one has no end."""


class UntrustedError(Exception):
    """A document type or entities."""


class Parser:
    """One document."""

    def __init__(self, document: Document, names: Names, encoding: str | None) -> None:
        self.document, self.names = document, names
        self.parser = expat.ParserCreate(encoding)
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self.parser.StartDoctypeDeclHandler = self._refuse_declaration
        self.parser.EntityDeclHandler = self._refuse_declaration
        self.depth = self.stop = 0
        self.device = self.component = self.group = ""
        self.at = [0, 0, 0, 0]  # depths of what is open, 0 where none is
        self.tag = ""
        self.attributes: dict[str, str] = {}
        self.words: list[str] = []
        self.size = 0
        self.keys: list[str] = []
        self.cells: list[tuple[str, str]] = []

    def _refuse_declaration(self, *_: object) -> None:
        raise UntrustedError

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self.depth += 1
        if self.depth > _DEEP:
            raise UntrustedError
        tag = name.rsplit(":", 1)[-1]
        if tag == "MTConnectStreams" and self.depth > 1:
            self.stop = self.parser.CurrentByteIndex  # expat itself runs on to the end of the part
            raise NextError
        if self.at[_OBSERVATION]:
            if tag in _CELLS:
                self.keys.append(attributes.get("key", ""))
                self.words, self.size = ["UNAVAILABLE"] if attributes.get("removed") == "true" else [], 0
        elif self.at[_GROUP]:
            self.at[_OBSERVATION], self.tag, self.attributes = self.depth, tag, attributes
            self.words, self.size, self.keys, self.cells = [], 0, [], []
        elif self.at[_COMPONENT]:
            self.at[_GROUP], self.group = self.depth, tag
        elif (opens := _OUTSIDE.get(tag)) is not None:
            opens(self, attributes)

    def _header(self, attributes: dict[str, str]) -> None:
        header = {key: number(value) for key, value in attributes.items()}
        self.document.instance, self.document.first = header.get("instanceId"), header.get("firstSequence")
        self.document.next = header.get("nextSequence")

    def _device(self, attributes: dict[str, str]) -> None:
        self.at[_DEVICE], self.device = self.depth, attributes.get("name", "").rstrip("=")

    def _component(self, attributes: dict[str, str]) -> None:
        self.at[_COMPONENT] = self.depth
        self.component = attributes.get("name", "").rstrip("=") or attributes.get("component", "").rstrip("=")

    def _text(self, text: str) -> None:
        if self.at[_OBSERVATION]:
            self.size += len(text)
            if self.size > _MOST_TEXT:
                raise UntrustedError
            self.words.append(text)

    def _end(self, name: str) -> None:
        if self.depth == self.at[_OBSERVATION]:
            self._observed()
        elif self.at[_OBSERVATION] and self.keys:
            tag = name.rsplit(":", 1)[-1]
            value = "".join(self.words).strip()
            if tag in _CELLS:
                if value or tag == "Cell" or not any(key.startswith(f"[{self.keys[0]}][") for key, _ in self.cells):
                    self.cells.append(("".join(f"[{key}]" for key in self.keys), value))
                self.keys.pop()
            self.words = []
        for k in range(len(self.at)):
            if self.at[k] == self.depth:
                self.at[k] = 0
        self.depth -= 1
        if not self.depth:
            self.document.whole = True
            self.stop = self.parser.CurrentByteIndex
            raise EndError

    def _observed(self) -> None:
        said, document = self.attributes, self.document
        key = self.names.of(self.device, self.component, self.group, self.tag, said)
        sequence, time = number(said.get("sequence")), said.get("timestamp", "").rstrip("=")
        if sequence is None or not time:
            document.undated += 1
            return
        value = "".join(self.words).strip()
        add = document.observations.append
        if self.group == "Condition":
            add(Observation(sequence, time, key, self.tag.upper()))
            text = "; ".join(
                p
                for p in (said.get("nativeCode", ""), said.get("nativeSeverity", ""), said.get("qualifier", ""), value)
                if p
            )
            if text or self.tag == "Normal":
                add(Observation(sequence, time, f"{key}[message]", text or "UNAVAILABLE"))
        elif self.tag.endswith("TimeSeries") or ("sampleRate" in said and len(value.split(None, 1)) > 1):
            rate = said.get("sampleRate", "")
            add(Observation(sequence, time, key, value, True, to_float(rate), number(said.get("sampleCount"))))
        elif self.cells or key in self.names.entries:
            known = self.names.entries.setdefault(key, set())
            known.update(place for place, _ in self.cells)
            cells = self.cells if value != "UNAVAILABLE" else [(place, value) for place in sorted(known)]
            for place, cell in cells:
                add(Observation(sequence, time, f"{key}{place}", cell))
        else:
            document.assets += self.tag.startswith("Asset")
            add(Observation(sequence, time, key, value))


_OUTSIDE = {"Header": Parser._header, "DeviceStream": Parser._device, "ComponentStream": Parser._component}
"""What begins where nothing is observed."""


def number(text: str | None) -> int | None:
    """A whole number of up to 18 digits at the start of a text."""
    digits = re.match(r"\s*(\d{1,18})(?!\d)", text or "", re.ASCII)
    return int(digits[1]) if digits else None
