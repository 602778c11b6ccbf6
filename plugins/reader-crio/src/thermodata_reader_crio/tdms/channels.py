"""The channels of a TDMS file: what each is, in which numbers, with which scaling and clock."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Scaling, Signal
from thermodata_reader_crio.tdms.channel_clock import clock_of
from thermodata_reader_crio.tdms.chunk_layout import BOOL
from thermodata_reader_crio.tdms.raw_columns import TEXT, Column
from thermodata_reader_crio.tdms.segment_index import Index
from thermodata_reader_crio.tdms.waveform_clock import Clock

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
_PATH = re.compile(r"/'((?:[^']|'')*)'")


@dataclass(frozen=True, eq=False)
class Channel:
    """One signal: its columns (several: a DAQmx channel whose scaling joins several raw numbers)."""

    signal: Signal
    short: str
    columns: tuple[Column, ...]
    clock: Clock | None
    joined_by: Scaling | None = None

    @property
    def length(self) -> int:
        """Values that are there."""
        return min(c.length for c in self.columns)

    @property
    def planned(self) -> int:
        """Values that the file announced: more than there are where it was cut."""
        return max(c.planned for c in self.columns)

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


def channels(
    index: Index, cols: Mapping[str, list[Column]], file: str, unscaled: set[str], notes: list[str], partly: list[str]
) -> dict[str, list[Channel]]:
    """Group -> its channels, in the file's order. partly: takes a sentence for each that is left out."""
    types = {path: found.type for layout in index.layouts for path, found in layout.objects}
    groups: dict[str, list[Channel]] = {}
    clocks: dict[Any, Clock | None] = {}
    ended: dict[tuple[int, int], bool] = {}
    for path, found in cols.items():
        group, name = names(path)
        full = f"{group}/{name}" if group or not name.startswith("/") else name
        if (change := _new_meaning(index, path, full in unscaled or name in unscaled)) is not None:
            partly.append(f"{full} is left out: within the file it changes its {change}; split the file there")
            continue
        if not group and name == path:
            notes.append(f"{path[:80]}: not the path of a channel in a group")
        made = _made(index, path, found, types[path], file, full, unscaled, notes, clocks, ended)
        groups.setdefault(group, []).extend(made)
    return groups


def _new_meaning(index: Index, path: str, unscaled: bool) -> str | None:
    """How a channel's unit or scaling, or those of its group or of the file, change within the file; None: they don't,
    or raw numbers are wanted."""
    group = "/'" + names(path)[0].replace("'", "''") + "'"
    changes = [index.meanings[p] for p in (path, group, "/") if p in index.meanings]
    return next((c for c in changes if not (unscaled and c.startswith("NI_Scal"))), None)


def _made(
    index: Index,
    path: str,
    found: list[Column],
    kind: int,
    file: str,
    full: str,
    unscaled: set[str],
    notes: list[str],
    clocks: dict[Any, Clock | None],
    ended: dict[tuple[int, int], bool],
) -> list[Channel]:
    own = index.properties.get(path, {})
    clock = clock_of(index, found[0], own, clocks)
    if clock is not None and not _ends(clock, max(found[0].length, found[0].planned), ended):
        notes.append(f"{full}: its wf_increment of {own['wf_increment']} s ends beyond any date; not used as its time")
        clock = None
    unit = own.get("unit_string") or own.get("NI_UnitDescription") or None
    unit = str(unit) if unit else None
    group, short = names(path)
    scale = (
        None
        if full in unscaled or short in unscaled
        else scaling(
            [own, index.properties.get("/'" + group.replace("'", "''") + "'", {}), index.properties.get("/", {})],
            f"{file} {full}",
        )
    )
    properties = {k: str(v) for k, v in own.items()}
    if found[0].part in ("re", "im"):
        notes.append(f"{full}: complex numbers, delivered as two signals")
        return [_channel(f"{full} ({c.part})", short, [c], scale, unit, properties, clock) for c in found]
    if len({k.dtype for c in found for k in c.kinds}) > len(found):
        notes.append(f"{full}: its type changes within the file; delivered as {found[0].dtype}")
    if len(found) > 1:
        if scale is None:
            raise FormatError(
                "a DAQmx channel of several raw numbers without a scaling that joins them",
                where=f"{file} {full}",
                hint="leave it out, or read its raw numbers with NI's tools",
            )
        properties["scaled_by_reader"] = f"{len(found)} raw inputs"
        notes.append(
            f"{full}: its scaling joins {len(found)} raw numbers (a thermocouple and its cold junction, "
            "say), so it is delivered scaled by the file's own formula"
        )
        return [_channel(full, short, found, None, unit, properties, clock, "float64", scale)]
    if found[0].dtype == "V16":
        properties["kind"] = "timestamp"
        return [_channel(full, short, found, None, unit or "ns", properties, clock, "int64")]
    dtype = "bool" if kind == BOOL and found[0].dtype == "u1" else None
    return [_channel(full, short, found, scale, unit, properties, clock, dtype)]


def _ends(clock: Clock, rows: int, ended: dict[tuple[int, int], bool]) -> bool:
    """Whether all rows have a time that a store can hold. ended: answers for other channels of the same clock; the
    clocks outlive it."""
    key = id(clock), rows
    if key not in ended:
        ended[key] = clock.ends_before(rows)
    return ended[key]


def _channel(
    full: str,
    short: str,
    found: list[Column],
    scale: Scaling | None,
    unit: str | None,
    properties: Mapping[str, str],
    clock: Clock | None,
    dtype: str | None = None,
    joined_by: Scaling | None = None,
) -> Channel:
    if dtype is None:
        dtype = "str" if found[0].dtype == TEXT else np.dtype(found[0].dtype).name
    return Channel(Signal(full, "", unit, dtype, scale, properties), short, tuple(found), clock, joined_by)
