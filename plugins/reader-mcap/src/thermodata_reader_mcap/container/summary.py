"""What stands behind the data: definitions again, and how many messages there should be. Never needed, but it
repairs lost definitions and tells that messages are missing."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field

from thermodata_reader_mcap.container.definitions import Channel, Schema, parsed_channel, parsed_schema
from thermodata_reader_mcap.container.records import (
    CHANNEL,
    FOOTER,
    HEAD,
    IN_SUMMARY,
    MAGIC,
    SCHEMA,
    STATISTICS,
    fits,
    octets,
)

_FOOTER = struct.Struct("<QQI")


@dataclass(frozen=True, slots=True)
class Summary:
    """channels: by id. counts: messages by the id of their channel, None where it is not said; total: of all.
    data_crc: checksum of all bytes before `data_end`, 0 where there is none."""

    channels: Mapping[int, Channel] = field(default_factory=dict)
    counts: Mapping[int, int] | None = None
    total: int | None = None
    data_end: int = 0
    data_crc: int = 0
    damaged: bool = False


def summary(view: memoryview) -> Summary:
    """The summary of a file; an empty one where there is none, or where its checksum differs."""
    foot = len(view) - len(MAGIC) - _FOOTER.size - HEAD.size
    if foot < len(MAGIC) or view[-len(MAGIC) :] != MAGIC or HEAD.unpack_from(view, foot) != (FOOTER, _FOOTER.size):
        return Summary()
    start, _, crc = _FOOTER.unpack_from(view, foot + HEAD.size)
    if start and not len(MAGIC) <= start <= foot:
        return Summary(damaged=True)
    data_end, data_crc = _data_end(view, start or foot)
    if not start:
        return Summary(data_end=data_end, data_crc=data_crc)
    if crc and zlib.crc32(view[start : len(view) - len(MAGIC) - 4]) != crc:
        return Summary(damaged=True)
    schemas, bodies = dict[int, Schema](), list[memoryview]()
    counts: dict[int, int] | None = None
    total: int | None = None
    at = start
    while at < foot:
        stop = fits(view, at, IN_SUMMARY)
        if stop is None:
            return Summary(_channels(bodies, schemas), None, None, data_end, data_crc, True)
        body = view[at + HEAD.size : stop]
        if view[at] == SCHEMA:
            number, schema = parsed_schema(body)
            schemas[number] = schema
        elif view[at] == CHANNEL:
            bodies.append(body)
        elif view[at] == STATISTICS:
            (total,) = struct.unpack_from("<Q", body)
            entries = bytes(octets(body, 42, len(body))[0])
            counts = dict(struct.iter_unpack("<HQ", entries)) if entries and len(entries) % 10 == 0 else None
        at = stop
    return Summary(_channels(bodies, schemas), counts, total, data_end, data_crc)


def _channels(bodies: list[memoryview], schemas: dict[int, Schema]) -> dict[int, Channel]:
    found = (parsed_channel(body, schemas) for body in bodies)
    return {channel.number: channel for channel in found}


def _data_end(view: memoryview, stop: int) -> tuple[int, int]:
    """Where the mark of the data's end begins, and the checksum in it."""
    at = stop - HEAD.size - 4
    if at < len(MAGIC) or HEAD.unpack_from(view, at) != (15, 4):
        return 0, 0
    return at, struct.unpack_from("<I", view, at + HEAD.size)[0]
