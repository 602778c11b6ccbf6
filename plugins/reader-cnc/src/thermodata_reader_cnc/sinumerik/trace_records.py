"""Sinumerik Trace XML as a stream: frames with their headers and signals, and their records in pieces."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

from thermodata.errors import FormatError

FEED = 1 << 19  # bytes that are read at once
_MOST_SIGNALS = 20_000
_ID = re.compile(r"^\d+$")


@dataclass(slots=True)
class Frame:
    """A frame's header, its signals by their records' attribute, and the records since they were taken: time [s],
    attribute -> value, and the byte where each begins. bad: records without a time; odd: values that are no numbers,
    and the first of them."""

    number: int
    header: dict[str, str] = field(default_factory=dict)
    signals: dict[str, dict[str, str]] = field(default_factory=dict)
    times: list[float] = field(default_factory=list)
    cells: list[dict[str, str]] = field(default_factory=list)
    at: list[int] = field(default_factory=list)
    bad: int = 0
    odd: int = 0
    first_odd: str = ""
    started: bool = False  # it has records
    done: bool = False


class TraceParser:
    """frames: those that began since they were taken, and the one that goes on. announced: `dataFrames`."""

    def __init__(self, name: str) -> None:
        self.name, self.frames, self.count = name, list[Frame](), 0
        self.announced: int | None = None
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.StartDoctypeDeclHandler = self._refuse_declaration
        self.parser.EntityDeclHandler = self._refuse_declaration

    def feed(self, data: bytes, final: bool) -> str | None:
        """What is wrong with the XML, or None."""
        try:
            self.parser.Parse(data, final)
        except expat.ExpatError as error:
            return str(error)
        except (LookupError, ValueError) as error:  # an encoding that nobody knows
            return str(error)
        return None

    @property
    def at_byte(self) -> int:
        """Where in the file the XML ends or goes wrong."""
        return max(0, self.parser.ErrorByteIndex)

    def _refuse_declaration(self, *_: Any) -> None:
        raise FormatError(
            "the XML declares a document type or entities",
            where=self.name,
            expected="a trace without them",
            got="<!DOCTYPE or <!ENTITY",
            hint="save the trace from the control: these write none, and a file that does may be made to harm",
        )

    def _frame(self, header: dict[str, str]) -> Frame:
        self.count += 1
        self.frames.append(Frame(self.count, header))
        return self.frames[-1]

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        if tag == "rec":
            frame = self.frames[-1] if self.frames else self._frame({})
            try:
                time = float(attributes.pop("time"))
                if not abs(time) < 1e9:
                    raise ValueError
            except (KeyError, ValueError):
                frame.bad += 1
                return
            frame.times.append(time)
            frame.cells.append(attributes)
            frame.at.append(self.parser.CurrentByteIndex)
            frame.started = True
        elif tag == "frameHeader":
            self._frame(dict(attributes))
        elif tag == "dataSignal":
            frame = self.frames[-1] if self.frames and not self.frames[-1].started else self._frame({})
            key = attributes.get("id", str(len(frame.signals) + 1))
            key = f"f{key}" if _ID.match(key) else key
            if len(frame.signals) >= _MOST_SIGNALS:
                raise FormatError(
                    "too many signals in a frame",
                    where=self.name,
                    expected=f"up to {_MOST_SIGNALS}",
                    got="more",
                    hint="record fewer at once",
                )
            while key in frame.signals:
                key += "'"  # announced twice: no record can be told to be its
            frame.signals[key] = dict(attributes)
        elif tag == "traceData":
            text = attributes.get("dataFrames", "").strip()
            self.announced = int(text) if re.fullmatch(r"\d{1,9}", text, re.ASCII) else None

    def _end(self, tag: str) -> None:
        if tag == "dataFrame" and self.frames:
            self.frames[-1].done = True


def record_number(path: Path, byte: int) -> int:
    """Which <rec> of a file, counted from 1, begins at a byte."""
    parser, count = expat.ParserCreate(), 0

    def start(tag: str, _: dict[str, str]) -> None:
        nonlocal count
        count += tag == "rec" and parser.CurrentByteIndex <= byte

    parser.StartElementHandler = start
    with path.open("rb") as file, suppress(expat.ExpatError, LookupError, ValueError):
        while file.tell() <= byte:
            parser.Parse(file.read(FEED), False)
    return count
