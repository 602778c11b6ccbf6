"""An open TDMS file: its index, its streams, and what was noted; kept from the description to the reading."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from threading import Lock

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata_reader_crio.tdms.channels.channel import channels
from thermodata_reader_crio.tdms.channels.one_group import columns_of, without_its_name
from thermodata_reader_crio.tdms.raw.columns import columns
from thermodata_reader_crio.tdms.segments.index import Index
from thermodata_reader_crio.tdms.segments.read_index import read_index
from thermodata_reader_crio.tdms.streams import Stream, StreamMaker

_KEPT: dict[tuple[object, ...], File] = {}
_LOCK = Lock()


@dataclass(frozen=True)
class File:
    """What a file holds, without the bulk: its segments, its streams, and what to say of them."""

    index: Index
    streams: tuple[Stream, ...]
    notes: tuple[str, ...]
    partly: tuple[str, ...]  # what was left out of channels, as sentences


def open_file(path: Path, source: Source, *, keep: bool = False) -> File:
    """A TDMS file as it was just described, or opened anew. keep: for the reading that follows the description, so
    that a file of 100,000 channels is walked once."""
    status = path.stat()
    with path.open("rb") as file:
        ends = [file.read(4096)]
        file.seek(max(0, status.st_size - 4096))
        ends.append(file.read(4096))
    sheet = (source.table or {}).get("sheet")
    key = str(path.absolute()), status.st_size, status.st_mtime_ns, status.st_ino, repr(source), *ends
    with _LOCK:
        found = _KEPT.pop(key, None)
    if found is None:
        found = _open_uncached(path, source, sheet)
    if keep:
        with _LOCK:
            _KEPT.clear()
            _KEPT[key] = found
    return found


def _open_uncached(path: Path, source: Source, sheet: int | str | None) -> File:
    """Index, streams and notes of a TDMS file, or of one group of it; reads no bulk (but the start of channels that
    hold a time)."""
    index = read_index(path)
    cols, partly = columns(index)
    if sheet is not None:
        cols = columns_of(cols, sheet, path.name)
    made = channels(index, cols, path.name, set(source.options.get("unscaled", ())))
    partly += made.left_out
    found: list[Stream] = []
    with path.open("rb") as file:
        maker = StreamMaker(index, source, file)
        for group, members in made.of_group.items():
            if sheet is not None:
                group, members = "", without_its_name(group, members)
            found += maker.streams(group, members)
    notes = [*index.notes, *made.notes, *maker.notes]
    if not found:
        raise FormatError(
            "a TDMS file without values",
            where=path.name,
            expected="channels with raw data",
            got=f"{index.segments} segments, {len(index.properties)} objects",
            hint=index.damage or next(iter([*partly, *notes]), None),
        )
    return File(index, tuple(found), tuple(notes), tuple(partly))
