"""MCAP files taken apart and put together again, with sizes and checksums that are right: what the formats' modules
share. A mutation is done to the parts, so that it gets past the checks that any flipped bit would fail."""

from __future__ import annotations

import random
import struct
import zlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from io import BytesIO

import lz4.frame
import zstandard
from mcap.writer import CompressionType, IndexType, Writer

from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, flip, insert

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, INDEX, CHUNK_INDEX, ATTACHMENT = range(1, 10)
STATISTICS, METADATA, DATA_END = 11, 12, 15
T0 = 1_772_434_800_000_000_000
BARE = {
    "use_statistics": False,
    "use_summary_offsets": False,
    "repeat_channels": False,
    "repeat_schemas": False,
    "index_types": IndexType.NONE,
}


@dataclass(frozen=True)
class Rec:
    """A record; a chunk's inner records and header apart from its body."""

    op: int
    body: bytes = b""
    inner: tuple[Rec, ...] | None = None
    head: tuple[int, int, int | None, int | None, bytes] = (0, 0, None, None, b"")  # times, size, crc, compression
    length: int | None = None

    def pack(self) -> bytes:
        body = self.body if self.inner is None else self._chunk()
        return struct.pack("<BQ", self.op, len(body) if self.length is None else self.length) + body

    def _chunk(self) -> bytes:
        records = b"".join(r.pack() for r in self.inner or ())
        start, end, size, crc, compression = self.head
        stored = {b"zstd": zstandard.ZstdCompressor().compress, b"lz4": lz4.frame.compress}.get(compression, bytes)(
            records
        )
        return (
            struct.pack(
                "<QQQI", start, end, len(records) if size is None else size, zlib.crc32(records) if crc is None else crc
            )
            + struct.pack("<I", len(compression))
            + compression
            + struct.pack("<Q", len(stored))
            + stored
        )


def records(data: bytes, at: int, stop: int) -> list[Rec]:
    found = []
    while at < stop:
        op, length = struct.unpack_from("<BQ", data, at)
        body = data[at + 9 : at + 9 + length]
        if op == CHUNK:
            start, end, _, _, n = struct.unpack_from("<QQQII", body)
            compression, stored = body[32 : 32 + n], body[40 + n :]
            inner = {b"zstd": lambda b: zstandard.ZstdDecompressor().decompress(b), b"lz4": lz4.frame.decompress}.get(
                compression, bytes
            )(stored)
            found.append(Rec(op, b"", tuple(records(inner, 0, len(inner))), (start, end, None, None, compression)))
        else:
            found.append(Rec(op, body))
        at += 9 + length
    return found


def parsed(data: bytes) -> list[Rec]:
    return records(data, len(MAGIC), len(data) - len(MAGIC))


def packed(recs: Iterable[Rec]) -> bytes:
    """With the footer's offsets and checksum as they must be. (Chunk indexes keep their old offsets.)"""
    out, start = bytearray(MAGIC), 0
    for rec in recs:
        if rec.op == FOOTER and len(rec.body) == 20 and rec.length is None:
            body = struct.pack("<QQ", start, 0)
            foot = struct.pack("<BQ", FOOTER, 20) + body
            crc = zlib.crc32(bytes(out[start:]) + foot) if start else 0
            out += foot + struct.pack("<I", crc)
            continue
        out += rec.pack()
        if rec.op == DATA_END:
            start = len(out)
    return bytes(out + MAGIC)


Add = Callable[[Writer], None]
ZSTD = CompressionType.ZSTD


def written(add: Add, compression: CompressionType = ZSTD, chunk: int = 700, **options: object) -> bytes:
    """A file of the mcap package's writer."""
    out = BytesIO()
    writer = Writer(out, chunk_size=chunk, compression=compression, **options)  # type: ignore[arg-type]
    writer.start(profile="", library="fuzz")
    add(writer)
    writer.finish()
    return packed(parsed(out.getvalue()))


def dialects(name: str, add: Add, source: Source | None = None) -> list[Seed]:
    """One content in every way in which a file may hold it."""
    ways: dict[str, bytes] = {
        "zstd": written(add),
        "lz4": written(add, CompressionType.LZ4),
        "plain": written(add, CompressionType.NONE),
        "one": written(add, chunk=1 << 20),
        "bare": written(add, **BARE),
        "loose": written(add, use_chunking=False),
        "loosebare": written(add, use_chunking=False, **BARE),
        "plainbare": written(add, CompressionType.NONE, **BARE),
        "crc": written(add, enable_data_crcs=True),
    }
    return [Seed(f"{name}_{way}.mcap", data, source or Source()) for way, data in ways.items()]


@dataclass
class Edit:
    """A file's records while they are changed."""

    recs: list[Rec]
    rng: random.Random
    counted: bool = field(init=False)

    def __post_init__(self) -> None:
        self.counted = any(r.op == STATISTICS for r in self.recs)

    def pick(self, *ops: int) -> int | None:
        places = [k for k, r in enumerate(self.recs) if not ops or r.op in ops]
        return self.rng.choice(places) if places else None

    def inner(self, *ops: int) -> tuple[int, int] | None:
        every = ((k, j, i.op) for k, r in enumerate(self.recs) for j, i in enumerate(r.inner or ()))
        places = [(k, j) for k, j, op in every if not ops or op in ops]
        return self.rng.choice(places) if places else None

    def any(self, *ops: int) -> tuple[int, int | None] | None:
        """A record inside or outside of chunks, in the data section."""
        places: list[tuple[int, int | None]] = []
        for k, r in enumerate(self.recs):
            if r.op == DATA_END:
                break
            places += [(k, None)] if r.op in ops else [(k, j) for j, i in enumerate(r.inner or ()) if i.op in ops]
        return self.rng.choice(places) if places else None

    def get(self, place: tuple[int, int | None]) -> Rec:
        k, j = place
        return self.recs[k] if j is None else (self.recs[k].inner or ())[j]

    def put(self, place: tuple[int, int | None], *new: Rec) -> None:
        k, j = place
        if j is None:
            self.recs[k : k + 1] = new
        else:
            inner = list(self.recs[k].inner or ())
            inner[j : j + 1] = new
            self.recs[k] = replace(self.recs[k], inner=tuple(inner))


WRONG = (0, 1, 2, 8, 255, 65535, 2**31, 2**32 - 1, 2**32, 2**40, 2**63, 2**64 - 1)


def mutate(seed: Seed, rng: random.Random, payload: Callable[[bytes, random.Random], bytes]) -> Mutation:
    """One change of a file's structure. payload: changes a message's data."""
    data = seed.data
    way = rng.randrange(28)
    if way == 0:
        return Mutation(cut(data, rng), "cut", False, False)
    if way == 1:
        return Mutation(flip(data, rng, 8), "flip anywhere", False, True)
    if way == 2:
        return Mutation(insert(data, rng), "junk anywhere", False, True)
    if way == 3:
        return Mutation(data + rng.choice((b"\0" * 64, data, b"x" * 9, MAGIC)), "appended", False, False)
    edit = Edit(parsed(data), rng)
    done = _STEPS[way % len(_STEPS)](edit, payload)
    if done is None:
        return Mutation(cut(data, rng), "cut", False, False)
    kind, well_formed, touched = done
    return Mutation(packed(edit.recs), kind, well_formed, touched)


Done = tuple[str, bool, bool] | None
Payload = Callable[[bytes, random.Random], bytes]
_NAMES = {
    HEADER: "header",
    FOOTER: "footer",
    SCHEMA: "schema",
    CHANNEL: "channel",
    MESSAGE: "message",
    CHUNK: "chunk",
    INDEX: "index",
    DATA_END: "data end",
    STATISTICS: "statistics",
    METADATA: "metadata",
    ATTACHMENT: "attachment",
}


def _name(op: int) -> str:
    return _NAMES.get(op, "summary record")


def _top_dropped(e: Edit, _: Payload) -> Done:
    k = e.pick()
    if k is None:
        return None
    rec = e.recs.pop(k)
    defines = rec.op in (SCHEMA, CHANNEL) or any(r.op in (SCHEMA, CHANNEL) for r in rec.inner or ())
    honest = not defines and not (e.counted and rec.op in (MESSAGE, CHUNK))
    return f"{_name(rec.op)} dropped", honest, False


def _top_doubled(e: Edit, _: Payload) -> Done:
    k = e.pick()
    if k is None:
        return None
    e.recs.insert(e.rng.randrange(len(e.recs)), e.recs[k])
    return f"{_name(e.recs[k].op)} doubled", False, False


def _top_swapped(e: Edit, _: Payload) -> Done:
    a, b = e.pick(), e.pick()
    if a is None or b is None:
        return None
    e.recs[a], e.recs[b] = e.recs[b], e.recs[a]
    return "records swapped", False, False


def _length(e: Edit, _: Payload) -> Done:
    place = e.any(SCHEMA, CHANNEL, MESSAGE) if e.rng.random() < 0.5 else None
    if place is None:
        k = e.pick()
        if k is None:
            return None
        place = (k, None)
    rec = e.get(place)
    real = len(rec.pack()) - 9
    length = e.rng.choice((*WRONG, real + 1, real - 1, real + 9, real + 40, 2 * real))
    e.put(place, replace(rec, length=max(0, length)))
    return f"{_name(rec.op)} length", False, False


def _opcode(e: Edit, _: Payload) -> Done:
    place = e.any(SCHEMA, CHANNEL, MESSAGE) if e.rng.random() < 0.5 else (e.pick() or 0, None)
    if place is None:
        return None
    rec = e.get(place)
    e.put(place, Rec(e.rng.choice((*range(17), 0x7F, 0x80, 0xFF)), rec.pack()[9:]))
    return f"{_name(rec.op)} opcode", False, e.counted is False


def _junk(e: Edit, _: Payload) -> Done:
    place = e.any(SCHEMA, CHANNEL, MESSAGE) if e.rng.random() < 0.5 else (e.pick() or 0, None)
    if place is None:
        return None
    k, j = place
    rec = e.get(place)
    junk = insert(b"", e.rng)
    if j is None:
        raw = [r.pack() for r in e.recs[k:]]
        whole = junk + b"".join(raw)
        op, rest = whole[0], whole[9:]
        # a raw stretch of bytes passes as one record that claims what the junk says
        claimed = struct.unpack("<Q", whole[1:9])[0] if len(whole) >= 9 else 0
        e.recs[k:] = [Rec(op, rest, length=claimed)]
    else:
        e.put(place, Rec(junk[0], junk[9:], length=struct.unpack("<Q", (junk[1:9] + b"\0" * 8)[:8])[0]), rec)
    return "junk between records", False, False


def _chunk_field(e: Edit, _: Payload) -> Done:
    k = e.pick(CHUNK)
    if k is None:
        return None
    rec = e.recs[k]
    start, end, size, crc, compression = rec.head
    real = sum(len(r.pack()) for r in rec.inner or ())
    what = e.rng.choice(("size", "crc", "no crc", "compression", "times", "stored"))
    if what == "size":
        size = e.rng.choice((*WRONG, real - 1, real + 1))
    elif what == "crc":
        crc = e.rng.randrange(1, 2**32)
    elif what == "no crc":
        crc = 0
    elif what == "times":
        start, end = e.rng.choice(WRONG), e.rng.choice(WRONG)
    elif what == "stored":
        body = bytearray(rec.pack()[9:])
        struct.pack_into("<Q", body, 32 + len(compression), e.rng.choice((*WRONG, 100)))
        e.recs[k] = Rec(CHUNK, bytes(body))
        return "chunk stored size", False, False
    else:
        body = bytearray(rec.pack()[9:])
        name = e.rng.choice((b"", b"zstd", b"lz4", b"gzip", b"\xff" * 200))
        e.recs[k] = Rec(
            CHUNK, bytes(body[:28]) + struct.pack("<I", len(name)) + name + bytes(body[32 + len(compression) :])
        )
        return "chunk compression", False, False
    e.recs[k] = replace(rec, head=(start, end, size, crc, compression))
    return f"chunk {what}", what in ("no crc", "times"), False


def _recompressed(e: Edit, _: Payload) -> Done:
    for k, rec in enumerate(e.recs):
        if rec.op == CHUNK:
            e.recs[k] = replace(rec, head=(*rec.head[:4], e.rng.choice((b"", b"zstd", b"lz4"))))
    return "chunks compressed otherwise", False, False


def _stored_flip(e: Edit, _: Payload) -> Done:
    k = e.pick(CHUNK)
    if k is None:
        return None
    body = e.recs[k].pack()[9:]
    e.recs[k] = Rec(CHUNK, flip(body, e.rng, 32))
    return "chunk stored bytes", False, False


def _inner_dropped(e: Edit, _: Payload) -> Done:
    place = e.inner()
    if place is None:
        return None
    op = e.get(place).op
    e.put(place)
    return f"{_name(op)} in chunk dropped", op == MESSAGE and not e.counted, False


def _inner_doubled(e: Edit, _: Payload) -> Done:
    place = e.inner()
    if place is None:
        return None
    rec = e.get(place)
    e.put(place, rec, rec)
    return f"{_name(rec.op)} in chunk doubled", False, False


def _inner_swapped(e: Edit, _: Payload) -> Done:
    a, b = e.inner(), e.inner()
    if a is None or b is None:
        return None
    first, second = e.get(a), e.get(b)
    e.put(a, second)
    e.put(b, first)
    return "records in chunks swapped", False, False


def _text_at(body: bytes, at: int) -> tuple[bytes, int]:
    n = struct.unpack_from("<I", body, at)[0]
    return body[at + 4 : at + 4 + n], at + 4 + n


def _channel(e: Edit, _: Payload) -> Done:
    place = e.any(CHANNEL)
    if place is None:
        return None
    body = e.get(place).body
    number, schema = struct.unpack_from("<HH", body)
    topic, at = _text_at(body, 4)
    encoding, at = _text_at(body, at)
    what = e.rng.choice(("topic", "encoding", "schema", "id", "metadata"))
    if what == "topic":
        topic = e.rng.choice((b"", b"/other", b'"; DROP', b"\xff\xfe", b"x" * 3000, "/č中".encode()))
    elif what == "encoding":
        encoding = e.rng.choice((b"", b"json", b"cdr", b"protobuf", b"ros1", b"cbor", b"\xff"))
    elif what == "schema":
        schema = e.rng.choice((0, 1, 2, 3, 9, 65535))
    elif what == "id":
        number = e.rng.choice((0, 1, 2, 3, 65535))
    tail = body[at:] if what != "metadata" else e.rng.choice((b"", b"\xff\xff\xff\xff", b"\4\0\0\0\0\0\0\0"))
    new = struct.pack("<HHI", number, schema, len(topic)) + topic + struct.pack("<I", len(encoding)) + encoding + tail
    e.put(place, Rec(CHANNEL, new))
    return f"channel {what}", what == "topic", what != "topic"


def _reused(e: Edit, _: Payload) -> Done:
    channel, message = e.any(CHANNEL), e.any(MESSAGE)
    if channel is None or message is None:
        return None
    body = e.get(channel).body
    topic, at = _text_at(body, 4)
    other = topic + b"/again"
    new = Rec(CHANNEL, body[:4] + struct.pack("<I", len(other)) + other + body[at:])
    e.put(message, new, e.get(message))
    return "channel id used again", True, False


def _schema(e: Edit, _: Payload) -> Done:
    place = e.any(SCHEMA)
    if place is None:
        return None
    body = e.get(place).body
    changed = e.rng.choice((flip(body, e.rng), cut(body, e.rng), insert(body, e.rng), body[:2] + b"\0" * 12))
    e.put(place, Rec(SCHEMA, changed))
    return "schema content", False, True


def _message(e: Edit, payload: Payload) -> Done:
    place = e.any(MESSAGE)
    if place is None:
        return None
    body = bytearray(e.get(place).body)
    what = e.rng.choice(("payload", "payload", "payload", "channel", "log time", "publish time", "short"))
    if what == "payload":
        body[22:] = payload(bytes(body[22:]), e.rng)
    elif what == "channel":
        struct.pack_into("<H", body, 0, e.rng.choice((0, 1, 2, 3, 65535)))
    elif what == "short":
        body = body[: e.rng.randrange(22)]
        e.put(place, Rec(MESSAGE, bytes(body)))
        return "message short", False, False
    else:
        struct.pack_into("<Q", body, 6 if what == "log time" else 14, e.rng.choice((*WRONG, T0)))
    e.put(place, Rec(MESSAGE, bytes(body)))
    return f"message {what}", False, True


def _index(e: Edit, _: Payload) -> Done:
    k = e.pick(INDEX)
    if k is None:
        return None
    body = e.recs[k].body
    e.recs[k] = Rec(
        INDEX,
        e.rng.choice(
            (
                flip(body, e.rng, 6),
                body[:6],
                body[:6] + body[6:][::-1],
                struct.pack("<HI", 1, 16) + struct.pack("<QQ", 0, e.rng.choice(WRONG)),
            )
        ),
    )
    return "index content", False, False


def _summary_away(e: Edit, _: Payload) -> Done:
    end = next((k for k, r in enumerate(e.recs) if r.op == DATA_END), None)
    if end is None:
        return None
    e.recs[end + 1 :] = [Rec(FOOTER, b"\0" * 20)] if e.rng.random() < 0.8 else []
    if e.recs[-1].op == FOOTER:
        e.recs[-1] = Rec(FOOTER, b"\0" * 20, length=20)
    return "summary away", False, False


def _statistics(e: Edit, _: Payload) -> Done:
    k = e.pick(STATISTICS)
    if k is None:
        return None
    e.recs[k] = Rec(STATISTICS, flip(e.recs[k].body, e.rng))
    return "statistics content", True, False


def _end_early(e: Edit, _: Payload) -> Done:
    end = e.rng.choice((Rec(DATA_END, b"\0" * 4), Rec(FOOTER, b"\0" * 20, length=20)))
    e.recs.insert(e.rng.randrange(len(e.recs)), end)
    return "end in the middle", False, False


def _empty_chunk(e: Edit, _: Payload) -> Done:
    k = e.pick(CHUNK)
    if k is None:
        return None
    inner = e.rng.choice((tuple[Rec, ...](), tuple(Rec(0x90) for _ in range(2000)), (Rec(0x81, b"x" * 50),)))
    e.recs.insert(k, Rec(CHUNK, b"", inner, (0, 0, None, None, e.rng.choice((b"", b"zstd", b"lz4")))))
    return "chunk without messages", False, False


def _bomb(e: Edit, _: Payload) -> Done:
    k = e.pick(CHUNK)
    if k is None:
        return None
    stored = zstandard.ZstdCompressor(level=1).compress(b"\0" * (1 << 26))
    size = e.rng.choice((1 << 26, 1 << 34, 100, 2**64 - 1))
    body = struct.pack("<QQQI", 0, 0, size, 0) + b"\4\0\0\0zstd" + struct.pack("<Q", len(stored)) + stored
    e.recs.insert(k, Rec(CHUNK, body))
    return "bomb", False, False


_STEPS: tuple[Callable[[Edit, Payload], Done], ...] = (
    _top_dropped,
    _top_doubled,
    _top_swapped,
    _length,
    _opcode,
    _junk,
    _chunk_field,
    _recompressed,
    _stored_flip,
    _inner_dropped,
    _inner_doubled,
    _inner_swapped,
    _channel,
    _reused,
    _schema,
    _message,
    _index,
    _summary_away,
    _statistics,
    _end_early,
    _empty_chunk,
    _message,
    _length,
    _bomb,
)
