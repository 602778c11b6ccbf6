"""Lines of SHDR as events, with the special forms of the MTConnect agent's adapter protocol.

`time|item|value|item|value...`; `time@duration|...`; `time|item|value|unit` of other loggers;
conditions `time|item|level|code|severity|qualifier|text`; messages `time|item|code|text`;
time series `time|item|count|rate|values`; `@ASSET@` lines, also of several lines;
commands `* ...`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from thermodata.plugin import Loss
from thermodata.reader.text.cells.time_forms.time_pattern import OFFSET_MS, TimeFormat
from thermodata.reader.text.cells.values.number import to_float
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.times.zone import NAT
from thermodata.schema.flag import Flag
from thermodata_reader_cnc.events import GONE, ISO, Event
from thermodata_reader_cnc.mtconnect.time_series import Report
from thermodata_reader_cnc.opcua.row_units import in_unit_of

LEVELS = frozenset({"NORMAL", "WARNING", "FAULT", GONE})
_FIELD = re.compile(r'"((?:\\.|[^"\\])*)"(?=\||$)|([^|]*)')
_NAME = re.compile(r"^[^\W\d][\w.:\- ]*$")
_UNDATED = int(Flag.CLOCK_SUSPECT)


def is_time(text: str) -> bool:
    """Whether a first field is a date and time, with or without a duration."""
    return timestamp.parse_one(text.partition("@")[0], ISO) != NAT


def is_offset(text: str, form: TimeFormat = OFFSET_MS) -> bool:
    """Whether a first field is a time in numbers; without a form, milliseconds from the adapter's start."""
    return timestamp.parse_one(text.partition("@")[0], form) != NAT


def fields(text: str) -> list[str]:
    """The fields of a line; one in quotes may hold pipes (escaped)."""
    if '"' not in text and "\\" not in text:
        return text.split("|")
    cells, at = [], 0
    while at <= len(text):
        match = _FIELD.match(text, at)
        assert match is not None  # the second form matches anything, nothing too
        cells.append(match[1].replace("\\|", "|").replace('\\"', '"') if match[1] is not None else match[2])
        at = match.end() + 1
    return cells


def looks_like_items(parts: list[str]) -> bool:
    """Whether the fields behind a time are pairs of an item's name and a value."""
    return len(parts) >= 3 and all(_NAME.match(name) or name.startswith("@") for name in parts[1::2][:2])


class Lines:
    """Lines to events, in order. Commands, comments and assets are no data. A line without a time takes that of the
    line before it, flagged. form: of times that are numbers; units: of the items whose fourth field is a unit."""

    def __init__(self, name: str, form: TimeFormat = OFFSET_MS, units: Mapping[str, str] | None = None) -> None:
        self.part, self.form, self.units = f"{name} line", form, units or {}
        self.until: str | None = None
        self.opened = 0
        self.time = ""

    def events(self, line: str, number: int) -> Iterator[Event | Report | Loss]:
        """The events of a line. number: 0-based in the file."""
        if self.until is not None:
            if line.strip() == self.until:
                self.until = None
            return
        text = line.rstrip("\r")
        at = number + 1
        if not text.strip() or text.startswith("*"):
            if "\0" in text:
                yield self._loss(at, f"{text.count(chr(0))} NUL bytes")
            return
        parts = fields(text)
        flag = 0
        if len(parts) < 2 or (parts[0].strip() and not is_time(parts[0]) and not is_offset(parts[0], self.form)):
            yield self._loss(at, f"expected time|item|value, got '{text[:80]}'")
            return
        time = parts[0].partition("@")[0].strip()
        if not time:
            if not self.time:
                yield self._loss(at, f"no time, and none before it: '{text[:80]}'")
                return
            time, flag = self.time, _UNDATED
        self.time = time
        if parts[1].startswith("@"):
            if parts[-1].startswith("--multiline--"):
                self.until, self.opened = parts[-1].strip(), number
            return
        yield from self._values(time, parts, flag, at, text)

    def _values(self, time: str, parts: list[str], flag: int, at: int, text: str) -> Iterator[Event | Report | Loss]:
        key, count = parts[1].strip(), len(parts)
        if not key and count in (4, 5, 6, 7) and count % 2 == 0:
            yield self._loss(at, f"a report without an item: '{text[:80]}'")
            return
        if key and count in (6, 7) and parts[2].upper() in LEVELS:
            yield Event(time, key, parts[2].upper(), at, self.part, flag)
            if (message := "; ".join(p.strip() for p in parts[3:] if p.strip())) or parts[2].upper() == "NORMAL":
                yield Event(time, f"{key}[message]", message or GONE, at, self.part, flag)
            return
        if key and count == 5 and parts[2].isdigit() and len(words := parts[4].split()) == int(parts[2][:9]) and words:
            rate = to_float(parts[3])
            if (rate is not None and rate >= 0) or not parts[3].strip():
                yield Report(time, key, rate or None, parts[4], at, self.part)
                return
        if count == 4 and key in self.units:
            value, wrong = in_unit_of(key, parts[2], parts[3].strip(), self.units)
            yield (
                self._loss(at, f"'{key}': a value {wrong}")
                if wrong
                else Event(time, key, value.strip() or GONE, at, self.part, flag)
            )
            return
        if count == 4:  # a message: item, native code, text
            yield Event(time, key, parts[3], at, self.part, flag)
            if parts[2].strip():
                yield Event(time, f"{key}[code]", parts[2], at, self.part, flag)
            return
        if count % 2 == 0:
            yield self._loss(at, f"expected pairs of item and value, got '{text[:80]}'")
        for name, value in zip(parts[1::2], parts[2::2], strict=False):
            if name.strip():
                yield Event(time, name, value, at, self.part, flag)
            elif value:
                yield self._loss(at, f"a value without an item: '{value[:40]}'")

    def end(self) -> Iterator[Loss]:
        """What is missing at the end of the log."""
        if self.until is not None:
            yield self._loss(self.opened + 1, f"an asset without its end ({self.until}): what follows it is not read")

    def _loss(self, at: int, reason: str) -> Loss:
        return Loss(f"{self.part} {at}", reason=reason)
