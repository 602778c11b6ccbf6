"""What is left of cut and damaged files, and what is said about the rest."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType

T0 = 1_772_434_800_000_000_000
STEP = 10_000_000
REAL = Path(__file__).resolve().parents[5] / "shared" / "data" / "mcap"
COMPRESSIONS = [CompressionType.NONE, CompressionType.LZ4, CompressionType.ZSTD]


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_a_cut_file_keeps_what_is_there(
    tmp_path: Path, compression: CompressionType, write: Any, read: Any, axis: Any
) -> None:
    content = write(tmp_path / "a.mcap", axis(3000), compression=compression, chunk=1 << 16).read_bytes()
    cut = tmp_path / "cut.mcap"
    last = 0
    for share in (0.2, 0.5, 0.8):
        cut.write_bytes(content[: int(share * len(content))])
        recording, times, values, _, losses = read(cut)
        n = times["/axis"].size
        assert recording.complete is False
        assert n > last
        np.testing.assert_array_equal(times["/axis"], T0 + STEP * np.arange(n))
        np.testing.assert_array_equal(values["/axis.pos.x"], np.arange(n) / 8)
        assert "ends" in losses[-1].reason
        assert times["/axis"][-1] <= losses[-1].from_ns <= times["/axis"][-1] + STEP
        last = n


def chunk_places(content: bytes) -> list[tuple[int, int]]:
    at, places = 8, []
    while at + 9 < len(content):
        opcode, length = struct.unpack_from("<BQ", content, at)
        if opcode == 6:
            places.append((at, at + 9 + length))
        if opcode == 0x0F:
            break
        at += 9 + length
    return places


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_a_damaged_chunk_costs_only_itself(
    tmp_path: Path, compression: CompressionType, write: Any, read: Any, axis: Any
) -> None:
    path = write(tmp_path / "a.mcap", axis(3000), compression=compression, chunk=1 << 15)
    whole = read(path)[1]["/axis"]
    content = bytearray(path.read_bytes())
    start, stop = chunk_places(content)[3]
    content[(start + stop) // 2] ^= 0xFF
    path.write_bytes(content)
    _, times, _, _, losses = read(path)
    assert len(losses) == 1
    lost = np.setdiff1d(whole, times["/axis"])
    assert 0 < lost.size < whole.size // 3
    assert (losses[0].from_ns, losses[0].to_ns) == (lost[0], lost[-1])
    assert losses[0].fraction == pytest.approx((stop - start) / len(content), rel=0.01)
    assert "chunk 3" in losses[0].reason


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_a_damaged_length_is_skipped_to_the_next_chunk(
    tmp_path: Path, compression: CompressionType, write: Any, read: Any, axis: Any
) -> None:
    path = write(tmp_path / "a.mcap", axis(3000), compression=compression, chunk=1 << 15)
    content = bytearray(path.read_bytes())
    start, _ = chunk_places(content)[3]
    content[start + 1 : start + 9] = struct.pack("<Q", 2**40)
    path.write_bytes(content)
    _, times, _, _, losses = read(path)
    assert "no record" in losses[0].reason
    assert "bytes" in losses[0].where
    assert times["/axis"].size > 2000
    assert times["/axis"][-1] == T0 + 2999 * STEP


def test_an_index_that_lies_is_not_believed(tmp_path: Path, write: Any, read: Any, axis: Any) -> None:
    path = write(tmp_path / "a.mcap", axis(600), chunk=1 << 13)
    content, at, changed = bytearray(path.read_bytes()), 8, 0
    while content[at] != 0x0F:
        opcode, length = struct.unpack_from("<BQ", content, at)
        if opcode == 7 and length > 40:
            struct.pack_into("<Q", content, at + 9 + 6 + 8 + 16, 17 if changed % 2 else 2**40)
            changed += 1
        at += 9 + length
    path.write_bytes(content)
    assert changed > 3
    _, times, _, _, losses = read(path)
    assert not losses
    np.testing.assert_array_equal(times["/axis"], T0 + STEP * np.arange(600))


def test_messages_outside_of_chunks_are_found_again_behind_damage(
    tmp_path: Path, write: Any, read: Any, axis: Any
) -> None:
    path = write(tmp_path / "a.mcap", axis(300), use_chunking=False)
    content = bytearray(path.read_bytes())
    at = content.index(b"MPF1") - 200
    content[at : at + 300] = b"\xff" * 300
    path.write_bytes(content)
    recording, times, values, _, losses = read(path)
    assert recording.complete is False
    assert "no record" in losses[-1].reason
    assert 290 < times["/axis"].size < 300
    np.testing.assert_array_equal(np.array(values["/axis.pos.x"]) * 8 * STEP, times["/axis"] - T0)


def test_channels_whose_definition_is_lost_are_known_from_the_summary(
    tmp_path: Path, write: Any, read: Any, axis: Any
) -> None:
    path = write(tmp_path / "a.mcap", axis(3000), chunk=1 << 15)
    content = bytearray(path.read_bytes())
    start, stop = chunk_places(content)[0]
    content[(start + stop) // 2] ^= 0xFF
    path.write_bytes(content)
    _, times, values, _, losses = read(path)
    assert len(losses) == 1
    assert times["/axis"].size > 2000
    assert values["/axis.pos.z"][-1] == -2999


def test_messages_that_the_statistics_count_and_the_file_lacks_are_lost_by_name(
    tmp_path: Path, write: Any, read: Any, axis: Any
) -> None:
    path = write(tmp_path / "a.mcap", axis(3000), chunk=1 << 15)
    content = path.read_bytes()
    start, stop = chunk_places(content)[3]
    while content[stop] == 7:
        stop += 9 + struct.unpack_from("<Q", content, stop + 1)[0]
    moved = len(content) - (stop - start)
    shorter = bytearray(content[:start] + content[stop:])
    (summary,) = struct.unpack_from("<Q", shorter, moved - 8 - 20)
    struct.pack_into("<QQI", shorter, moved - 8 - 20, summary - (stop - start), 0, 0)
    path.write_bytes(shorter)
    _, times, _, _, losses = read(path)
    gone = 3000 - times["/axis"].size
    assert gone > 100
    assert [(loss.where, loss.reason, loss.fraction) for loss in losses] == [
        ("a.mcap topic '/axis'", f"{gone} of its 3000 messages are not in the file", gone / 3000)
    ]


def test_a_changed_value_is_told_by_the_checksum_of_the_whole_file(
    tmp_path: Path, write: Any, read: Any, axis: Any
) -> None:
    path = write(tmp_path / "a.mcap", axis(50), use_chunking=False, enable_data_crcs=True)
    assert read(path)[4] == []
    path.write_bytes(path.read_bytes().replace(b'"x": 1.5', b'"x": 1.6'))
    _, _, values, _, losses = read(path)
    assert 1.6 in values["/axis.pos.x"]
    assert ["checksum" in loss.reason for loss in losses] == [True]


@pytest.mark.parametrize("claimed", [0, 100, 1 << 26, 1 << 34, 2**64 - 1])
def test_a_decompression_bomb_is_bounded(tmp_path: Path, write: Any, read: Any, axis: Any, claimed: int) -> None:
    import resource

    import zstandard

    content = write(tmp_path / "a.mcap", axis(50)).read_bytes()
    stored = zstandard.ZstdCompressor().compress(bytes(1 << 26)) * 3
    body = struct.pack("<QQQI", 0, 0, claimed, 0) + b"\4\0\0\0zstd" + struct.pack("<Q", len(stored)) + stored
    start, _ = chunk_places(content)[0]
    (tmp_path / "b.mcap").write_bytes(content[:start] + struct.pack("<BQ", 6, len(body)) + body + content[start:])
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    _, times, _, _, losses = read(tmp_path / "b.mcap")
    assert times["/axis"].size == 50
    assert len(losses) == 1
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 400 * 1024


def test_records_in_a_chunk_that_its_checksum_does_not_cover_are_found_again(
    tmp_path: Path, write: Any, read: Any, axis: Any
) -> None:
    path = write(tmp_path / "a.mcap", axis(300), compression=CompressionType.NONE, chunk=1 << 20, enable_crcs=False)
    content = bytearray(path.read_bytes())
    at = content.index(b"MPF1") - 100
    content[at : at + 150] = b"\xff" * 150
    path.write_bytes(content)
    _, times, _, _, losses = read(path)
    assert 290 < times["/axis"].size < 300
    assert "are no records" in losses[0].reason


def test_short_and_foreign_records_are_named(tmp_path: Path, write: Any, read: Any, axis: Any) -> None:
    content = write(tmp_path / "a.mcap", axis(20), use_chunking=False).read_bytes()
    first = content.index(b"\x05", content.index(b"/axis") + 20) - 0
    while content[first] != 5 or struct.unpack_from("<Q", content, first + 1)[0] > 200:
        first += 1
    for number, extra in enumerate((struct.pack("<BQ", 5, 3) + b"abc", struct.pack("<BQ", 0x81, 5) + b"hello")):
        path = tmp_path / f"{number}.mcap"
        path.write_bytes(content[:first] + extra + content[first:])
        _, times, _, _, losses = read(path)
        assert times["/axis"].size == 20
        assert any(word in losses[0].reason for word in ("no record", "0x81")), losses


def test_a_footer_that_points_nowhere_is_not_followed(tmp_path: Path, write: Any, read: Any, axis: Any) -> None:
    content = bytearray(write(tmp_path / "a.mcap", axis(20)).read_bytes())
    for start in (1, 10**6, 2**63):
        struct.pack_into("<Q", content, len(content) - 28, start)
        (tmp_path / "b.mcap").write_bytes(content)
        recording, times, _, _, _ = read(tmp_path / "b.mcap")
        assert times["/axis"].size == 20
        assert any("summary" in note for note in recording.notes)


def test_an_end_in_the_middle_does_not_end_the_file(tmp_path: Path, write: Any, read: Any, axis: Any) -> None:
    content = write(tmp_path / "a.mcap", axis(600), chunk=1 << 12).read_bytes()
    start, _ = chunk_places(content)[3]
    for end in (struct.pack("<BQI", 15, 4, 0), struct.pack("<BQQQI", 2, 20, 0, 0, 0)):
        (tmp_path / "b.mcap").write_bytes(content[:start] + end + content[start:])
        recording, times, _, _, losses = read(tmp_path / "b.mcap")
        assert times["/axis"].size == 600
        assert losses
        assert recording.complete is False
