"""Whole files: the rules of readers, real recordings, definitions, and encodings that nothing reads."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer
from thermodata_reader_mcap import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Head, Source
from thermodata.reader.contract.guard import described
from thermodata.testing.reader import reader_checks

T0 = 1_772_434_800_000_000_000
STEP = 10_000_000
REAL = Path(__file__).resolve().parents[5] / "shared" / "data" / "mcap"
COMPRESSIONS = [CompressionType.NONE, CompressionType.LZ4, CompressionType.ZSTD]


def test_a_long_file_without_chunks_is_read_by_its_head(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, write: Any, read: Any, axis: Any
) -> None:
    from thermodata_reader_mcap.container import messages
    from thermodata_reader_mcap.signals import plan

    monkeypatch.setattr(plan, "WHOLE", 2000)
    monkeypatch.setattr(messages, "_LOOSE", 10)
    recording, times, values, _, losses = read(write(tmp_path / "a.mcap", axis(500), use_chunking=False))
    assert not losses
    assert times["/axis"].size == 500
    assert {s.name: s.dtype for s in recording.signals}["/axis.pos.z"] == "float64"
    assert values["/axis.pos.z"] == [-k for k in range(500)]


def test_an_encoding_that_nothing_reads_is_refused_by_name(tmp_path: Path, write: Any) -> None:
    path = write(tmp_path / "a.mcap", [("/x", T0, b"\x00\x01")], encoding="cbor")
    with pytest.raises(FormatError, match=r"'/x' is not read: encoding 'cbor' .* is not supported"):
        described(Reader(), path, Source())


def test_one_unreadable_topic_does_not_hide_the_others(tmp_path: Path, read: Any) -> None:
    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        good, bad = writer.register_channel("/good", "json", 0), writer.register_channel("/bad", "flatbuffer", 0)
        for k in range(10):
            writer.add_message(good, T0 + k, b'{"v": 1.5}', T0 + k)
            writer.add_message(bad, T0 + k, b"\1\2\3", T0 + k)
        writer.finish()
    recording, times, _, _, losses = read(path)
    assert times["/good"].size == 10
    assert any("/bad" in note and "flatbuffer" in note for note in recording.notes)
    assert [loss.where for loss in losses] == ["a.mcap topic '/bad'"]


def test_ros2_messages_are_read(tmp_path: Path, read: Any) -> None:
    if not REAL.exists():
        pytest.skip("shared/data/mcap is not here")
    _, times, values, _, losses = read(REAL / "talker.mcap")
    assert not losses
    assert times["/topic"].size == 10
    assert values["/topic.data"][0] == "Hello, world! 0"
    assert values["/rosout.stamp.sec"][0] * 10**9 + values["/rosout.stamp.nanosec"][0] == pytest.approx(
        int(times["/rosout"][0]), abs=10_000_000
    )
    _, _, arrays, _, _ = read(REAL / "cdr_test_0.mcap")
    assert arrays["/test_topic.int32_value"] == [123, 123, 123]
    recording, times, _, _, _ = read(REAL / "wbag_0.mcap")
    assert recording.clock == "relative"
    assert sum(t.size for t in times.values()) == 1246


def test_an_id_that_gets_another_meaning_keeps_the_old_one_for_what_came_before(tmp_path: Path, read: Any) -> None:
    """Two recordings joined into one file, whose channel 1 are different topics."""
    parts = []
    for topic in ("/first", "/second"):
        with (tmp_path / "part.mcap").open("wb") as file:
            writer = Writer(file)
            writer.start()
            channel = writer.register_channel(topic, "json", 0)
            for k in range(10):
                writer.add_message(channel, T0 + k, b'{"v": %d.5}' % k, T0 + k)
            writer.finish()
        parts.append((tmp_path / "part.mcap").read_bytes())
    path = tmp_path / "joined.mcap"
    path.write_bytes(b"".join(parts))
    _, times, values, _, losses = read(path)
    assert not losses
    assert {topic: t.size for topic, t in times.items()} == {"/first": 10, "/second": 10}
    assert values["/first.v"] == values["/second.v"] == [k + 0.5 for k in range(10)]


def test_an_id_may_change_its_meaning_inside_a_chunk(tmp_path: Path, read: Any) -> None:
    with (tmp_path / "a.mcap").open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE, enable_crcs=False)
        writer.start()
        first = writer.register_channel("/aaaaa", "json", 0)
        for k in range(10):
            writer.add_message(first, T0 + k, b'{"v": %d.5}' % k, T0 + k)
        second = writer.register_channel("/bbbbb", "json", 0)
        writer.add_message(second, T0 + 10, b'{"v": 99.5}', T0 + 10)
        writer.finish()
    content = bytearray((tmp_path / "a.mcap").read_bytes())
    at = content.index(b"/bbbbb") - 8
    struct.pack_into("<H", content, at, first)  # both channels have the first one's id
    message = content.index(b'{"v": 99.5}') - 22
    struct.pack_into("<H", content, message, first)
    (tmp_path / "b.mcap").write_bytes(content)
    _, _, values, _, losses = read(tmp_path / "b.mcap")
    assert values["/aaaaa.v"] + values["/bbbbb.v"] == [*(k + 0.5 for k in range(10)), 99.5]
    assert all("messages are not in the file" in loss.reason for loss in losses)


def test_several_channels_of_one_topic_stay_in_order(tmp_path: Path, read: Any) -> None:
    with (tmp_path / "a.mcap").open("wb") as file:
        writer = Writer(file, chunk_size=500)
        writer.start()
        schema = writer.register_schema("s", "jsonschema", b'{"type": "object"}')
        channels = [writer.register_channel("/t", "json", number) for number in (0, schema, 0)]
        for k in range(90):
            writer.add_message(channels[k % 3], T0 + k, b'{"v": %d}' % k, T0 + k)
        writer.finish()
    _, times, values, _, _ = read(tmp_path / "a.mcap")
    np.testing.assert_array_equal(times["/t"], T0 + np.arange(90))
    assert values["/t.v"] == list(range(90))


def test_metadata_and_attachments_are_notes(tmp_path: Path, read: Any) -> None:
    with (tmp_path / "a.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel("/t", "json", 0)
        writer.add_message(channel, T0, b'{"v": 1.5}', T0)
        writer.add_metadata("machine", {"serial": "4711", "spindle": "SP1"})
        writer.add_attachment(T0, T0, "photo.png", "image/png", b"1234")
        writer.finish()
    assert read(tmp_path / "a.mcap")[0].notes == (
        "metadata 'machine': serial: 4711, spindle: SP1",
        "attachment 'photo.png' (image/png, 4 bytes) is not read",
    )


def test_a_file_without_messages_holds_nothing(tmp_path: Path, write: Any, read: Any) -> None:
    for options in ({}, {"use_chunking": False}):
        recording, times, _, _, losses = read(write(tmp_path / "a.mcap", [], **options))
        assert (recording.signals, recording.complete, times, losses) == ((), True, {}, [])


def test_bare_lz4_blocks_and_several_frames_are_read(tmp_path: Path, write: Any, read: Any, axis: Any) -> None:
    import lz4.block
    import zstandard

    content = write(tmp_path / "a.mcap", axis(100), compression=CompressionType.NONE, chunk=1 << 20).read_bytes()
    at = 8 + 9 + struct.unpack_from("<Q", content, 9)[0]
    (length,) = struct.unpack_from("<Q", content, at + 1)
    fixed, inner = content[at + 9 : at + 9 + 28], content[at + 9 + 40 : at + 9 + length]
    half = len(inner) // 2
    frames = zstandard.ZstdCompressor().compress(inner[:half]) + zstandard.ZstdCompressor().compress(inner[half:])
    for name, stored in ((b"lz4", lz4.block.compress(inner, store_size=False)), (b"zstd", frames)):
        body = fixed + struct.pack("<I", len(name)) + name + struct.pack("<Q", len(stored)) + stored
        path = tmp_path / "b.mcap"
        path.write_bytes(content[:at] + struct.pack("<BQ", 6, len(body)) + body + content[at + 9 + length :])
        _, times, _, _, losses = read(path)
        assert times["/axis"].size == 100
        assert not losses


def test_nothing_else_is_claimed() -> None:
    assert Reader().sniff(Head("x.mcap", 8, b"\x89PNG\r\n\x1a\n")) is None
    assert Reader().sniff(Head("x.bin", 100, b"\x89MCAP0\r\n\x01")) is not None


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory, write: Any, axis: Any) -> Path:
    return write(tmp_path_factory.mktemp("kit") / "sample.mcap", axis(120), chunk=2048)


@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x.mcap"), Source())]))))
def test_it_keeps_the_rules_of_readers(sample: Path, number: int) -> None:
    reader_checks(Reader, [(sample, Source())], claims=["MCAP"])[number]()
