"""The header of a TNCscope recording: blocks `%[NAME]` of `%KEY=value` that a lone `%` ends, one a curve."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Scaling, Source
from thermodata.reader.text.cells.time_forms import time_pattern
from thermodata.reader.text.cells.values.number import is_empty, of_either_mark, to_float
from thermodata.reader.text.times.local_clock import LocalClock
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.times.zone import NAT

_BLOCK = re.compile(r"^%\[([A-Za-z]+)[\s_]*(\d*)\]")
_KEY = re.compile(r"^%\s*([A-Za-z_ ]+?)\s*=\s*(.*)$")


@dataclass(frozen=True, slots=True)
class Curve:
    """count: rows that the header announces, None where it does not."""

    column: int
    name: str
    stream: str
    unit: str | None
    count: int | None
    cycle_ns: int
    scaling: Scaling | None
    properties: dict[str, str]


@dataclass(frozen=True, slots=True)
class Header:
    """width: cells of a row, a blank one behind a last ';' too. step: by how much the first column grows from row to
    row, None where it counts nothing."""

    curves: tuple[Curve, ...]
    start_ns: int | None
    first_row: int
    width: int
    decimal: str
    step: float | None


def read_header(lines: Sequence[str], where: str, source: Source) -> Header:
    """Curves and start; FormatError for a header that cannot be used."""
    blocks, first = _blocks(lines)
    found = [keys for name, keys in blocks if name == "CURVE"]
    if first is None or not found:
        raise FormatError(
            "no curves or no data",
            where=where,
            expected="%[CURVE...] blocks, then %[DATA]",
            got=", ".join(name for name, _ in blocks) or "nothing",
            hint="save the recording of the oscilloscope again, with its values",
        )
    data = [line.rstrip() for line in lines[first : first + 500] if line.strip() and not line.startswith("%")]
    width = Counter(line.count(";") + 1 for line in data).most_common(1)[0][0] if data else len(found)
    ends_blank = data and sum(line.endswith(";") for line in data) > 0.9 * len(data) and width > len(found)
    cells = width - 1 if ends_blank else width
    index = cells - len(found)
    if index not in (0, 1):
        raise FormatError(
            "columns do not fit the curves",
            where=f"{where} line {first + 1}",
            expected=f"{len(found)} columns, or one more for an index",
            got=str(cells),
            hint="save the recording again: head and rows are of two recordings, or one was edited",
        )
    taken: dict[str, int] = {}
    curves = tuple(_curve(keys, k, index, taken, where) for k, keys in enumerate(found))
    shared = next((keys for name, keys in blocks if name == "GLOBAL"), {})
    decimal = "," if any("," in line for line in data) else "."
    step = _step([line.split(";")[0] for line in data], decimal) if index else None
    return Header(curves, _start(shared, source), first, width, decimal, step)


def _blocks(lines: Sequence[str]) -> tuple[list[tuple[str, dict[str, str]]], int | None]:
    """(each block of the header: its name and keys; the line behind the head of the data, None where there is none)."""
    blocks: list[tuple[str, dict[str, str]]] = []
    for number, line in enumerate(lines):
        if match := _BLOCK.match(line):
            if match[1].upper() == "DATA":
                return blocks, number + 1
            blocks.append((match[1].upper(), {}))
        elif blocks and (match := _KEY.match(line)):
            blocks[-1][1][match[1].strip().upper()] = match[2].strip().strip('"')
    return blocks, None


def _curve(keys: dict[str, str], k: int, index: int, taken: dict[str, int], where: str) -> Curve:
    """The k-th curve. index: columns before the first one; taken: how many curves have each name so far."""
    cycle = _number(keys.get("CYCLETIME"), where)
    if not cycle or not 1e-3 <= cycle <= 1e12:
        raise FormatError(
            "a curve without a cycle time",
            where=f"{where} curve {k + 1}",
            expected="%CYCLETIME= in us",
            got=keys.get("CYCLETIME", "nothing"),
            hint="save the recording again; if the cycle is known, write it into the head of the curve",
        )
    kind = " ".join(filter(None, (keys.get("CHANNELTYPE"), keys.get("AXISTYPE"))))
    name = keys.get("NAME") or kind or f"curve {k + 1}"
    taken[name] = taken.get(name, 0) + 1
    name += f"#{taken[name]}" if taken[name] > 1 else ""
    count = _number(keys.get("COUNT"), where)
    if count is not None and not 0 <= count < 1e15:
        raise FormatError(
            "a curve with an impossible count",
            where=f"{where} curve {k + 1}",
            expected="%COUNT= of values",
            got=keys["COUNT"][:40],
            hint="save the recording again: its head is damaged",
        )
    return Curve(
        k + index,
        name,
        f"scope_{cycle:g}us",
        keys.get("DIMENSION") or None,
        None if count is None else int(count),
        round(cycle * 1000),
        _scaling(keys, where),
        keys,
    )


def _step(cells: Sequence[str], decimal: str) -> float | None:
    """By how much the first column grows from row to row; None where it does not do so evenly."""
    values = np.array([np.nan if (value := to_float(cell, decimal)) is None else value for cell in cells])
    if values.size < 3 or not np.isfinite(values).all():
        return None
    step = float(np.median(np.diff(values)))
    return step if step > 0 and np.mean(np.abs(np.diff(values) / step - 1) < 0.01) > 0.5 else None


def _number(text: str | None, where: str) -> float | None:
    if not text:
        return None
    value = of_either_mark(text)
    if value is None and not is_empty(text):
        raise FormatError(
            "a header value is no number",
            where=where,
            expected="a number",
            got=text[:40],
            hint="save the recording again: its head is damaged, or was edited",
        )
    return value if value is not None and np.isfinite(value) else None


def _scaling(keys: dict[str, str], where: str) -> Scaling | None:
    gain, offset = _number(keys.get("FACTOR") or keys.get("SCALE"), where), _number(keys.get("OFFSET"), where)
    if gain in (None, 1.0) and not offset:
        return None
    return Scaling("linear", {"gain": 1.0 if gain is None else gain, "offset": offset or 0.0})


def _start(shared: dict[str, str], source: Source) -> int | None:
    """UTC start by the global block's date and time; None where it has none that reads."""
    for order in ("dmy", "ymd"):
        day = timestamp.parse_one(shared.get("DATE", ""), time_pattern.DATE[order])
        clock = timestamp.parse_one(shared.get("TIME", ""), time_pattern.TIME_OF_DAY)
        if NAT not in (day, clock):
            return int(LocalClock(source.timezone).utc(np.array([day + clock]))[0])
    return None
