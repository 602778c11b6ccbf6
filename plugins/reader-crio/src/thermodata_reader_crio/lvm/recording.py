"""What an LVM file holds: its streams and signals, and when it starts."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Recording, Signal, Source
from thermodata.reader.text.file.lines import sample
from thermodata.reader.text.rows.typed import parse
from thermodata.schema.words.sentences import with_count
from thermodata_reader_crio.lvm.grid import decimal_of, first_rows, grid_of
from thermodata_reader_crio.lvm.header import Header, Packet
from thermodata_reader_crio.lvm.scan import Note, RowPart, has_heading_behind, scan
from thermodata_reader_crio.lvm.starts import starts_of
from thermodata_reader_crio.lvm.streams import Streams, is_time
from thermodata_reader_crio.lvm.times import Times
from thermodata_reader_crio.lvm.units import unit_of

COMMENT = "Comment"
_NOTES = 20


def describe(path: Path, source: Source) -> Recording:
    """Signals, clock and start of a file, by its headings and the first rows of each; FormatError where there is no
    channel over time."""
    first = sample(path, source.encoding)
    encoding, notes = first.encoding, [first.note] if first.note else []
    streams, starts = streams_of(path, encoding), starts_of(path, encoding, source.timezone)
    signals: dict[tuple[str, str], Signal] = {}
    start: int | None = None
    header, packet, fresh = Header(), None, False
    dated = False
    for item in scan(path, encoding):
        if isinstance(item, Note):
            notes.append(item.text)
        elif isinstance(item, Header):
            header = item
        elif isinstance(item, Packet):
            packet, fresh = item, True
            notes += _notes(streams, packet, signals)
            for signal in _signals(streams, packet):
                signals.setdefault((signal.stream, signal.name), signal)
        elif isinstance(item, RowPart) and packet is not None and fresh:
            fresh = False
            last = not has_heading_behind(path, encoding, item)
            _, odd = decimal_of(item.data, header, packet)
            times = Times(header, packet, first_rows(item.data, header, packet), starts)
            for group in streams.groups(packet):
                base = times.base(group[0])
                dated = dated or times.dated(group[0])
                start = base if start is None else min(start, base)
            notes += [odd] if odd else []
            known = {*notes}
            notes += [note for note in times.notes if note not in known]
            if last:
                break
    if not signals:
        raise FormatError(
            "an LVM file without a channel over time",
            where=path.name,
            expected="X_Dimension Time",
            got="spectra, or no channel",
            hint="write the waveforms themselves to a file, and not their spectra",
        )
    if not dated:
        notes.append("no date in the file: times count from its start")
    shown = notes[:_NOTES] + ([f"and {len(notes) - _NOTES} notes more"] if len(notes) > _NOTES else [])
    return Recording(
        tuple(signals.values()),
        "absolute" if dated else "relative",
        (start or 0) if dated else None,
        None,
        tuple(dict.fromkeys(shown)),
    )


def streams_of(path: Path, encoding: str) -> Streams:
    """The streams with their channels, by all headings; where each channel has an X column of its own, by reading
    these."""
    streams = Streams()
    apart: list[Packet] = []  # whose channels are told apart by rows that stand further down
    header, packet, decimal, fresh = Header(), None, None, False
    for item in scan(path, encoding):
        if isinstance(item, Header):
            header = item
        elif isinstance(item, Packet):
            packet, decimal, fresh = item, None, True
            if item.multi or apart:
                apart.append(item)
            else:
                streams.add(item)
        elif isinstance(item, RowPart) and packet is not None:
            if packet.multi:
                decimal = decimal or decimal_of(item.data, header, packet)[0]
                rows = parse(item.data, item.line, grid_of(header, packet, decimal))
                streams.compare(packet, [rows.columns[x].values for x in packet.x if x is not None])
            elif fresh and header.x_columns != "Multi" and not has_heading_behind(path, encoding, item):
                break
            fresh = False
    for heading in apart:
        streams.add(heading)
    return streams


def comment_name(names: Collection[str]) -> str:
    """The name of the free text beside a row: of each stream, for it says something of all channels."""
    return COMMENT if COMMENT not in names else f"{COMMENT} (text)"


def _notes(streams: Streams, packet: Packet, signals: Mapping[tuple[str, str], Signal]) -> Iterator[str]:
    """What is odd about a heading beside those before it. signals: by stream and name, of these."""
    yield from packet.notes
    for i, name in enumerate(packet.names):
        if not is_time(packet, i):
            yield f"{name}: stands over {packet.key('X_Dimension', i)}, not over time; left out"
    for group in streams.groups(packet):
        stream = streams.of(packet, group)
        for change in streams.units.changed(stream, packet, group):
            if streams.units.is_new(stream, change):
                yield f"line {packet.line}: {change.name}: {change}"
        if lacking := [n for n in streams.members[stream] if n not in {packet.names[i] for i in group}]:
            named = with_count([f"'{n}'" for n in lacking], 6)
            yield f"not all headings name the same channels: {named} of {stream} is not measured where one lacks it"
        for i in group:
            known, unit = signals.get((stream, packet.names[i])), unit_of(packet, i)
            if known is not None and known.unit is None and unit is not None:
                yield f"{packet.names[i]}: only line {packet.line} says its unit, '{unit}'"


def _signals(streams: Streams, packet: Packet) -> Iterator[Signal]:
    """The signals of a heading, with the free text beside each stream."""
    for group in streams.groups(packet):
        stream = streams.of(packet, group)
        for i in group:
            yield Signal(packet.names[i], stream, unit_of(packet, i))
        yield Signal(comment_name(streams.members[stream]), stream, None, "str")
