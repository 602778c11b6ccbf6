"""Which chunks of a recording to open for a first look, by what stands beside them."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

from thermodata_reader_mcap.container.data_section import Damage, data_section
from thermodata_reader_mcap.container.records import ATTACHMENT, CHUNK, MESSAGE_INDEX, METADATA, Record, chunk_head

WHOLE = 8 << 20  # uncompressed bytes that are looked at completely
_SEARCHED = 64 << 20  # the same, of a file whose chunks do not say which topics they hold


@dataclass(slots=True)
class Chunks:
    """sizes: uncompressed [bytes]; channels: that each chunk's index names; extras: attachments and metadata."""

    sizes: list[int] = field(default_factory=list)
    channels: list[set[int]] = field(default_factory=list)
    extras: list[Record] = field(default_factory=list)
    damaged: bool = False


def survey(view: memoryview) -> Chunks:
    """Sizes of the chunks and the channels that the indexes behind them name, without opening any."""
    found = Chunks()
    for record in data_section(view):
        if isinstance(record, Damage) or record.cut:
            found.damaged = True
        if isinstance(record, Damage):
            continue
        if record.opcode == CHUNK:
            head = chunk_head(view, record)
            found.sizes.append(head.size if head is not None else 0)
            found.channels.append(set())
        elif record.opcode == MESSAGE_INDEX and found.channels and not record.cut and record.stop - record.start >= 6:
            channel, size = struct.unpack_from("<HI", view, record.start)
            if size:
                found.channels[-1].add(channel)
        elif record.opcode in (ATTACHMENT, METADATA) and not record.cut:
            found.extras.append(record)
    return found


def chosen_of(chunks: Chunks) -> set[int] | None:
    """Which chunks to open; None for all."""
    total, count = sum(chunks.sizes), len(chunks.sizes)
    if total <= WHOLE:
        return None
    if not all(chunks.channels):
        if total <= _SEARCHED:
            return None
        return {0, 1, count - 1, *(count * k // 16 for k in range(16))}
    chosen = {0, count - 1, *(count * k // 6 for k in range(6))}
    places: dict[int, tuple[int, int]] = {}
    for k, inside in enumerate(chunks.channels):
        for channel in inside:
            places[channel] = (places.get(channel, (k, k))[0], k)
    return chosen | {k for pair in places.values() for k in pair}
