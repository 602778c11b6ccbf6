"""The channels of a TDMS file: what each is, in which numbers, with which scaling and clock."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Scaling, Signal
from thermodata.reader.text.preamble.scale_words import stated_of
from thermodata_reader_crio.tdms.channels.channel_clock import clock_of
from thermodata_reader_crio.tdms.channels.waveform_clock import Clock
from thermodata_reader_crio.tdms.raw.columns import Column
from thermodata_reader_crio.tdms.raw.places import TEXT
from thermodata_reader_crio.tdms.segments.chunk_layout import BOOL
from thermodata_reader_crio.tdms.segments.index import Index

KNOWN_SCALES = (
    "Linear",
    "Polynomial",
    "RTD",
    "Strain",
    "Table",
    "Thermistor",
    "Thermocouple",
    "Add",
    "Subtract",
    "AdvancedAPI",
)
_SCALE_TYPE = re.compile(r"^NI_Scale\[(\d+)\]_Scale_Type$")
_NONE: Mapping[str, Any] = {}
_PATH = re.compile(r"/'((?:[^']|'')*)'")


@dataclass(frozen=True, eq=False, slots=True)
class Channel:
    """One signal: its columns (several: a DAQmx channel whose scaling joins several raw numbers)."""

    signal: Signal
    short: str
    columns: tuple[Column, ...]
    clock: Clock | None
    joined_by: Scaling | None = None

    def in_stream(self, name: str) -> Channel:
        """The same channel, of a stream."""
        s = self.signal  # not `replace`, which takes its time with 100,000 channels
        signal = Signal(s.name, name, s.unit, s.dtype, s.scaling, s.properties)
        return Channel(signal, self.short, self.columns, self.clock, self.joined_by)

    @property
    def length(self) -> int:
        """Values that are there."""
        return min([c.length for c in self.columns])

    @property
    def planned(self) -> int:
        """Values that the file announced: more than there are where it was cut."""
        return max([c.planned for c in self.columns])

    @property
    def is_timestamp(self) -> bool:
        """Whether its values are points in time."""
        return self.signal.properties.get("kind") == "timestamp"

    @property
    def last_run(self) -> int:
        """Values in its longest chunk."""
        return max((int(c.n.max()) for c in self.columns if c.n.size), default=0)


def names(path: str) -> tuple[str, str]:
    """`/'Eddy'/'Z'` -> ('Eddy', 'Z'); a path of another form is a name without a group."""
    parts = _PATH.findall(path)
    if len(parts) == 2 and sum(len(p) + 3 for p in parts) == len(path):
        return parts[0].replace("''", "'"), parts[1].replace("''", "'")
    return "", path


def scaling(layers: Sequence[Mapping[str, Any]], where: str) -> Scaling | None:
    """The NI scaling that a channel, its group or the file declares. FormatError for a scale of a type that
    nobody here knows: volts must not pass for micrometres."""
    for properties in layers:
        scales = {m[1]: v for k, v in properties.items() if k.startswith("NI_Scale[") and (m := _SCALE_TYPE.match(k))}
        if not scales or properties.get("NI_Number_Of_Scales", 1) == 0:
            continue
        # "scaled": the numbers were written with the scaling already applied
        if properties.get("NI_Scaling_Status", "unscaled") == "scaled":
            return None
        for number, kind in scales.items():
            if kind not in KNOWN_SCALES:
                raise FormatError(
                    f"NI scale {number} has the unknown type '{kind}'",
                    where=where,
                    expected=", ".join(KNOWN_SCALES),
                    got=str(kind),
                    hint=f"options: {{unscaled: ['{where.split(' ', 1)[-1]}']}} takes the raw numbers",
                )
        found = {k: v for k, v in properties.items() if k.startswith("NI_Scal") or k == "NI_Number_Of_Scales"}
        return Scaling("ni", found)
    return None


@dataclass(frozen=True, slots=True)
class Channels:
    """of_group: group -> its channels, in the file's order; notes: on what they are; left_out: a sentence for each that
    is."""

    of_group: Mapping[str, list[Channel]]
    notes: Sequence[str]
    left_out: Sequence[str]


def channels(index: Index, cols: Mapping[str, list[Column]], file: str, unscaled: set[str]) -> Channels:
    """The channels of a file. unscaled: names of those whose raw numbers are wanted."""
    types = {path: found.type for layout in index.layouts for path, found in layout.objects}
    groups: dict[str, list[Channel]] = {}
    left_out: list[str] = []
    maker = _Maker(index, file, unscaled)
    for path, found in cols.items():
        group, name = names(path)
        full = f"{group}/{name}" if group or not name.startswith("/") else name
        if (change := _new_meaning(index, path, group, full in unscaled or name in unscaled)) is not None:
            left_out.append(f"{full} is left out: within the file it changes its {change}; split the file there")
            continue
        if not group and name == path:
            maker.notes.append(f"{path[:80]}: not the path of a channel in a group")
        groups.setdefault(group, []).extend(maker.channels(group, name, full, found, types[path]))
    return Channels(groups, maker.notes, left_out)


def _new_meaning(index: Index, path: str, group: str, unscaled: bool) -> str | None:
    """How a channel's unit or scaling, or those of its group or of the file, change within the file; None: they don't,
    or raw numbers are wanted."""
    if not index.meanings:
        return None
    changes = [index.meanings[p] for p in (path, _path_of(group), "/") if p in index.meanings]
    return next((c for c in changes if not (unscaled and c.startswith("NI_Scal"))), None)


def _path_of(group: str) -> str:
    return "/'" + group.replace("'", "''") + "'"


class _Maker:
    """Makes channels, and notes on them. What equal properties make is made once: a file may have 100,000 channels."""

    def __init__(self, index: Index, file: str, unscaled: set[str]) -> None:
        self._index, self._file, self._unscaled = index, file, unscaled
        self.notes: list[str] = []
        self._clocks: dict[Any, Clock | None] = {}
        self._ended: dict[tuple[int, int], bool] = {}
        self._texts: dict[int, dict[str, str]] = {}
        self._scalings: dict[tuple[int, int, int], Scaling | None] = {}
        self._layers: dict[str, tuple[Mapping[str, Any], Mapping[str, Any]]] = {}
        self._above: dict[str, dict[str, dict[str, str]]] = {}

    def channels(self, group: str, short: str, full: str, found: list[Column], kind: int) -> list[Channel]:
        """The channels of one object of the file: one, or the two parts of complex numbers. FormatError for raw numbers
        that nothing joins."""
        first, own = found[0], self._index.properties.get(found[0].path, _NONE)
        clock = self._clock(full, first, own)
        scale = None if full in self._unscaled or short in self._unscaled else self._scaling(group, full, own)
        stated = self._stated_scale(group, short)
        properties = {**stated, **self._text(own)} if stated else self._text(own)
        signal = Signal(full, "", _unit(own), _dtype(first, kind), scale, properties)
        if first.part in ("re", "im"):
            self.notes.append(f"{full}: complex numbers, delivered as two signals")
            parts = (replace(signal, name=f"{full} ({c.part})", dtype=_dtype(c, kind)) for c in found)
            return [Channel(part, short, (c,), clock) for part, c in zip(parts, found, strict=True)]
        if len(first.kinds) > 1 and len({k.dtype for c in found for k in c.kinds}) > len(found):
            self.notes.append(f"{full}: its type changes within the file; delivered as {first.dtype}")
        if len(found) > 1:
            return [Channel(self._joined_signal(signal, found), short, tuple(found), clock, scale)]
        if first.dtype == "V16":
            stamped = {**properties, "kind": "timestamp"}
            signal = replace(signal, unit=signal.unit or "ns", dtype="int64", scaling=None, properties=stamped)
        return [Channel(signal, short, (first,), clock)]

    def _clock(self, full: str, column: Column, own: Mapping[str, Any]) -> Clock | None:
        """What a channel's own properties say of its time; None where that is beyond any date."""
        clock = clock_of(self._index, column, own, self._clocks)
        if clock is None or _ends(clock, max(column.length, column.planned), self._ended):
            return clock
        self.notes.append(
            f"{full}: its wf_increment of {own['wf_increment']} s ends beyond any date; not used as its time"
        )
        return None

    def _joined_signal(self, signal: Signal, found: Sequence[Column]) -> Signal:
        """A signal that its scaling makes of several raw numbers. FormatError without one."""
        if signal.scaling is None:
            raise FormatError(
                "a DAQmx channel of several raw numbers without a scaling that joins them",
                where=f"{self._file} {signal.name}",
                hint="leave it out, or read its raw numbers with NI's tools",
            )
        self.notes.append(
            f"{signal.name}: its scaling joins {len(found)} raw numbers (a thermocouple and its cold junction, "
            "say), so it is delivered scaled by the file's own formula"
        )
        scaled = {**signal.properties, "scaled_by_reader": f"{len(found)} raw inputs"}
        return replace(signal, dtype="float64", scaling=None, properties=scaled)

    def _text(self, own: Mapping[str, Any]) -> dict[str, str]:
        """Properties as a signal has them. The index keeps what it is asked by, so that its id stays its own."""
        known = self._texts.get(id(own))
        if known is None:
            known = self._texts[id(own)] = {k: str(v) for k, v in own.items()}
        return known

    def _stated_scale(self, group: str, short: str) -> Mapping[str, str]:
        """What its group and the file state of a channel's scale, in properties called after it: 'dZ_gain'."""
        known = self._above.get(group)
        if known is None:
            known = self._above[group] = {}
            for key, value in (pair for layer in self._above_of(group)[::-1] for pair in layer.items()):
                if (found := stated_of(key)) is not None:
                    known.setdefault(found[0].casefold(), {})[key] = str(value)
        return known.get(short.casefold(), _NONE) if known else _NONE

    def _above_of(self, group: str) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """The properties of a group and of the file."""
        above = self._layers.get(group)
        if above is None:
            properties = self._index.properties
            above = properties.get(_path_of(group), _NONE), properties.get("/", _NONE)
            self._layers[group] = above
        return above

    def _scaling(self, group: str, full: str, own: Mapping[str, Any]) -> Scaling | None:
        above = self._above_of(group)
        layers = own, *above
        key = id(own), id(above[0]), id(above[1])
        if key not in self._scalings:
            self._scalings[key] = scaling(layers, f"{self._file} {full}")
        return self._scalings[key]


def _ends(clock: Clock, rows: int, ended: dict[tuple[int, int], bool]) -> bool:
    """Whether all rows have a time that a store can hold. ended: answers for other channels of the same clock; the
    clocks outlive it."""
    key = id(clock), rows
    if key not in ended:
        ended[key] = clock.ends_before(rows)
    return ended[key]


def _unit(own: Mapping[str, Any]) -> str | None:
    unit = own.get("unit_string") or own.get("NI_UnitDescription")
    return str(unit) if unit else None


def _dtype(column: Column, kind: int) -> str:
    """Of the values as they are delivered. kind: as the file has it."""
    if kind == BOOL and column.dtype == "u1":
        return "bool"
    return "str" if column.dtype == TEXT else _name(column.dtype)


@lru_cache(maxsize=64)
def _name(dtype: str) -> str:
    return np.dtype(dtype).name
