"""The headers of an LVM file: what the file's own says, and the heading of each packet of rows."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from thermodata.errors import FormatError

MARK = "***End_of_Header***"
START_SPECIAL, END_SPECIAL = "***Start_Special***", "***End_Special***"
_FILE_KEYS = {"Writer_Version", "Reader_Version", "Separator", "Multi_Headings", "X_Columns", "Decimal_Separator"}
_PACKET_KEYS = {"Channels", "Samples", "X0", "Delta_X", "X_Dimension", "Y_Unit_Label"}
_SEPARATORS = {"tab": "\t", "comma": ",", "semicolon": ";", "space": " "}


@dataclass(frozen=True)
class Header:
    """What the file's header says. decimal: None until the data shows it; several: each packet has a heading."""

    separator: str = "\t"
    decimal: str | None = None
    x_columns: str = "No"
    several: bool = False
    date: str = ""
    time: str = ""


@dataclass(frozen=True)
class Packet:
    """One heading: its keys (each a list, one value a channel) and the names of its channels.

    columns: where each channel stands in a row; x: where its X value does, None for X_Columns No; width: cells of a
    row without its comment; line: of the names.
    """

    keys: dict[str, list[str]]
    names: tuple[str, ...]
    columns: tuple[int, ...]
    x: tuple[int | None, ...]
    comment: bool
    width: int
    line: int
    notes: tuple[str, ...] = ()

    @property
    def multi(self) -> bool:
        return len(set(self.x)) > 1

    def key(self, name: str, channel: int, default: str = "") -> str:
        """A key's value for a channel: with an X column each, the values stand in every second cell."""
        values = self.keys.get(name, [])
        at = 2 * channel if self.multi and len([v for v in values if v]) <= len(self.names) < len(values) else channel
        return values[at] if at < len(values) else default

    def samples(self, channel: int) -> int | None:
        text = self.key("Samples", channel)
        return int(text) if text.isdecimal() and len(text) < 16 else None

    @property
    def most_samples(self) -> int:
        """Of all channels; 0 where none says how many it has."""
        return max((s for i in range(len(self.names)) if (s := self.samples(i)) is not None), default=0)


def cells(line: str, separator: str) -> list[str]:
    return [c.strip() for c in line.split(separator)]


def is_file_header(lines: list[str]) -> bool:
    """Whether lines before an end mark are a file's header, not the heading of a packet."""
    return any(re.split(r"[\t,; ]", line, maxsplit=1)[0] in _FILE_KEYS for line in lines)


def split_heading(lines: list[str]) -> tuple[list[str], list[str]]:
    """(lines of the file's header, lines of a packet's heading that follow it, for want of an end between)."""
    at = next(
        (i for i, line in enumerate(lines) if re.split(r"[\t,; ]", line, maxsplit=1)[0] in _PACKET_KEYS), len(lines)
    )
    return lines[:at], lines[at:]


def read_header(lines: list[str]) -> tuple[Header, str | None]:
    """(the file's header, a note where it contradicts itself). Its own lines show the separator even where the tag is
    damaged."""
    separator = next(
        (s for s in ("\t", ",", ";") if any(re.match(rf"^(X_Columns|Multi_Headings|Date){s}", line) for line in lines)),
        "\t",
    )
    keys: dict[str, str] = {}
    for line in lines:
        name, _, value = line.partition(separator)
        keys.setdefault(name.strip(), value.strip(" " if name.strip() == "Decimal_Separator" else separator + " "))
    said = keys.get("Separator", "")
    named = _SEPARATORS.get(said.lower(), said if said in ("\t", ",", ";") else None)
    note = None
    if named is not None and named != separator:
        own = "tabs" if separator == "\t" else repr(separator)
        note = f"the header names the separator '{said}', but is itself separated by {own}"
    decimal = keys.get("Decimal_Separator", "")[:1]
    header = Header(
        separator,
        decimal if decimal in (".", ",") else None,
        keys.get("X_Columns", "").strip(),
        keys.get("Multi_Headings", "No").strip() == "Yes",
        keys.get("Date", ""),
        keys.get("Time", ""),
    )
    return header, note


def read_packet(lines: list[str], names_line: str, header: Header, path: Path, number: int) -> Packet:
    """A packet's heading. The line of names decides how many X columns there are, for it stands over the data. number:
    of that line in the file. FormatError where it names no channels, or X columns in another order."""
    keys: dict[str, list[str]] = {}
    twice: list[str] = []
    for line in lines:
        name, *values = cells(line, header.separator)
        if name in keys and name != "Notes":
            twice.append(f"the key {name} stands twice in one heading")
        if name:
            keys.setdefault(name, values)
    row = cells(names_line, header.separator)
    comment = row[-1] == "Comment"
    width = len(row) - 1 if comment else _without_empty_ends(row)
    multi = _alternate(row[:width], names_line, f"{path.name} line {number}")
    columns = tuple(range(1, width, 2 if multi else 1))
    notes = [*twice, *_against_names(header, keys, multi, len(columns)), *_lacking(keys, len(columns))]
    return Packet(
        keys=keys,
        names=_unique_names([row[c] or f"column {c + 1}" for c in columns]),
        columns=columns,
        x=tuple(c - 1 if multi else 0 if header.x_columns != "No" else None for c in columns),
        comment=comment,
        width=width,
        line=number,
        notes=tuple(f"line {number}: {note}" for note in notes),
    )


def _without_empty_ends(row: list[str]) -> int:
    """How many cells a line of names has without the empty ones at its end; one at least."""
    width = len(row)
    while width > 1 and not row[width - 1]:
        width -= 1
    return width


def _alternate(row: list[str], names_line: str, where: str) -> bool:
    """Whether each channel has an X column of its own in front of it, else there is one for all. FormatError where
    neither is so. row: the cells of the line of names."""
    xs = [i for i, name in enumerate(row) if name == "X_Value"]
    if not xs or xs[0] != 0 or len(row) < 2:
        raise FormatError(
            "LVM heading without channels",
            where=where,
            expected="X_Value and the names of channels",
            got=names_line[:80],
            hint="write it anew from LabVIEW with its column headings, or as TDMS",
        )
    multi = len(xs) > 1 and xs == list(range(0, len(row), 2))
    if len(xs) > 1 and not multi:
        raise FormatError(
            "LVM heading whose X columns do not alternate with its channels",
            where=where,
            got=names_line[:80],
            hint="write it anew with one X column, or one for each channel, or as TDMS",
        )
    return multi


def _against_names(header: Header, keys: Mapping[str, list[str]], multi: bool, channels: int) -> Iterator[str]:
    """What the headers say otherwise than the line of names. channels: how many it names."""
    said = header.x_columns
    if said not in ("No", "One", "Multi") or ((said == "Multi") != multi and channels > 1):
        yield (
            f"X_Columns is '{said}', but the names have {'an X column for each channel' if multi else 'one X column'}"
        )
    count = next(iter(keys.get("Channels", [])), "")
    if count != str(channels):
        yield f"the heading announces {count or 'no number of'} channels and names {channels}"


def _lacking(keys: Mapping[str, list[str]], channels: int) -> Iterator[str]:
    """What the heading lacks of the keys by which rows are counted and timed."""
    wanted = ("Samples", "Date", "Time", "X0", "Delta_X")
    yield from (f"the heading has no {key}" for key in wanted if key not in keys)
    for key in wanted:
        told = sum(map(bool, keys.get(key, ())))
        if 0 < told < channels:
            yield f"{key} stands for {told} of {channels} channels"


def _unique_names(names: list[str]) -> tuple[str, ...]:
    """Names of which each stands once: 'T', 'T#2', and more '#' where a channel is called so already."""
    found: list[str] = []
    seen: dict[str, int] = {}
    taken = set(names)
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        made = name if seen[name] == 1 else f"{name}#{seen[name]}"
        while made in found or (seen[name] > 1 and made in taken):
            made += "#"
        found.append(made)
    return tuple(found)
