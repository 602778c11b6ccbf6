"""MCAP recordings: signals, types, filters, other encodings, and what is left of damaged files."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType, IndexType, Writer
from thermodata_reader_mcap import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Head, Loss, Recording, Source
from thermodata.reader.guard import described, guarded
from thermodata.testing.reader import reader_checks

T0 = 1_772_434_800_000_000_000
STEP = 10_000_000
REAL = Path(__file__).resolve().parents[4] / "shared" / "data" / "mcap"
Message = tuple[str, int, Any]


def write(path: Path, messages: Iterable[Message], *, compression: CompressionType = CompressionType.ZSTD,
          schema: Mapping[str, Any] | None = None, publish: Callable[[int], int] = lambda t: t, chunk: int = 4096,
          encoding: str = "json", **options: Any) -> Path:
    with path.open("wb") as file:
        writer = Writer(file, compression=compression, chunk_size=chunk, **options)
        writer.start()
        number = 0 if schema is None else writer.register_schema("s", "jsonschema", json.dumps(schema).encode())
        channels: dict[str, int] = {}
        for topic, t_ns, message in messages:
            if topic not in channels:
                channels[topic] = writer.register_channel(topic, encoding, number)
            data = message if isinstance(message, bytes) else json.dumps(message).encode()
            writer.add_message(channels[topic], t_ns, data, publish(t_ns))
        writer.finish()
    return path


def read(path: Path, source: Source = Source()) -> tuple[Recording, dict[str, np.ndarray], dict[str, list[Any]],  # noqa: B008
                                                        dict[str, list[int]], list[Loss]]:
    recording = described(Reader(), path, source)
    times: dict[str, list[np.ndarray]] = {}
    values: dict[str, list[Any]] = {s.name: [] for s in recording.signals}
    flags: dict[str, list[int]] = {s.name: [] for s in recording.signals}
    losses = []
    for item in guarded(Reader(), path, source, recording):
        if isinstance(item, Loss):
            losses.append(item)
            continue
        times.setdefault(item.stream, []).append(item.t_ns)
        for name, part in item.values.items():
            values[name] += part.tolist()
            flags[name] += (item.flags or {}).get(name, np.zeros(part.size, np.uint16)).tolist()
    return recording, {k: np.concatenate(v) for k, v in times.items()}, values, flags, losses


def axis(n: int) -> list[Message]:
    return [("/axis", T0 + k * STEP, {"pos": {"x": k / 8, "z": -k}, "t": [20 + k / 4, 21.5], "on": k % 2 == 0,
                                      "prog": f"MPF{k // 100}"}) for k in range(n)]


COMPRESSIONS = [CompressionType.NONE, CompressionType.LZ4, CompressionType.ZSTD]


@pytest.mark.parametrize("compression", COMPRESSIONS)
@pytest.mark.parametrize("options", [
    {}, {"use_chunking": False},
    {"use_summary_offsets": False, "use_statistics": False, "repeat_channels": False, "repeat_schemas": False,
     "index_types": IndexType.NONE}])
def test_nested_fields_arrays_and_types(tmp_path: Path, compression: CompressionType, options: dict[str, bool]) -> None:
    path = write(tmp_path / "a.mcap", axis(500), compression=compression, **options)
    recording, times, values, flags, losses = read(path)
    assert losses == []
    assert {s.name: s.dtype for s in recording.signals} == {
        "/axis.pos.x": "float64", "/axis.pos.z": "int64", "/axis.t[0]": "float64", "/axis.t[1]": "float64",
        "/axis.on": "bool", "/axis.prog": "str"}
    assert (recording.clock, recording.start_ns, recording.complete) == ("absolute", T0, True)
    np.testing.assert_array_equal(times["/axis"], T0 + STEP * np.arange(500))
    np.testing.assert_array_equal(values["/axis.pos.x"], np.arange(500) / 8)
    assert values["/axis.pos.z"] == [-k for k in range(500)]
    np.testing.assert_array_equal(values["/axis.t[0]"], 20 + np.arange(500) / 4)
    assert values["/axis.on"] == [k % 2 == 0 for k in range(500)]
    assert values["/axis.prog"] == [f"MPF{k // 100}" for k in range(500)]
    assert not any(any(f) for f in flags.values())


def test_topics_are_streams_and_can_be_chosen(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", [m for k in range(20) for m in (
        ("/t", T0 + k * STEP, {"v": k}), ("/u", T0 + k * STEP + 1, {"v": 0.5}), ("odd", T0 + k * STEP, {"v": "x"}))])
    recording, times, _, _, _ = read(path)
    assert {s.stream for s in recording.signals} == set(times) == {"/t", "/u", "odd"}
    assert [s.name for s in read(path, Source(topics=("/u",)))[0].signals] == ["/u.v"]
    assert [s.name for s in read(path, Source(topics=("/*",)))[0].signals] == ["/t.v", "/u.v"]
    with pytest.raises(FormatError, match="no topic '/missing'"):
        described(Reader(), path, Source(topics=("/missing",)))


def test_integers_beyond_a_float_stay_exact_with_and_without_gaps(tmp_path: Path) -> None:
    big = 2**53 + 1
    path = write(tmp_path / "a.mcap", [("/c", T0 + k, {"n": big + k, "u": 2**63 + k} if k != 7 else {"n": None})
                                       for k in range(20)])
    recording, _, values, flags, losses = read(path)
    assert not losses
    assert {s.name: s.dtype for s in recording.signals} == {"/c.n": "int64", "/c.u": "uint64"}
    assert values["/c.n"] == [big + k if k != 7 else 0 for k in range(20)]
    assert values["/c.u"] == [2**63 + k if k != 7 else 0 for k in range(20)]
    assert flags["/c.n"] == flags["/c.u"] == [128 * (k == 7) for k in range(20)]


def test_missing_and_null_fields_are_nan(tmp_path: Path) -> None:
    messages = [{"a": 1.5, "s": "x", "o": {"b": 2}}, {"a": None}, {"o": None}, {"a": 2, "s": None, "o": {"b": 3.5}}]
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", [("/m", T0 + k, m) for k, m in enumerate(messages)]))
    assert not losses
    np.testing.assert_array_equal(values["/m.a"], [1.5, np.nan, np.nan, 2])
    np.testing.assert_array_equal(values["/m.o.b"], [2, np.nan, np.nan, 3.5])
    assert values["/m.s"] == ["x", None, None, None]


def test_arrays_that_grow_and_arrays_of_objects(tmp_path: Path) -> None:
    messages = [{"p": [{"T": 20.5, "id": "a"}]}, {"p": [{"T": 21, "id": "a"}, {"T": 30.5, "id": "b"}]}, {"p": []}]
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", [("/m", T0 + k, m) for k, m in enumerate(messages)]))
    assert not losses
    np.testing.assert_array_equal(values["/m.p[0].T"], [20.5, 21, np.nan])
    np.testing.assert_array_equal(values["/m.p[1].T"], [np.nan, 30.5, np.nan])
    assert values["/m.p[1].id"] == [None, "b", None]


def test_messages_that_are_no_objects(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", [m for k in range(40) for m in (("/n", T0 + k, k / 2), ("/l", T0 + k, [k, 0.5]))])
    _, _, values, _, losses = read(path)
    assert not losses
    assert values["/n"] == [k / 2 for k in range(40)]
    assert values["/l[0]"] == list(range(40))


def test_a_schema_decides_what_the_first_messages_leave_open(tmp_path: Path) -> None:
    kinds = {"f": "number", "n": "integer", "s": "string"}
    schema = {"type": "object", "properties": {name: {"type": kind} for name, kind in kinds.items()}}
    path = write(tmp_path / "a.mcap", [("/m", T0 + k, {"f": k, "n": k, "s": None}) for k in range(5)], schema=schema)
    assert {s.name: s.dtype for s in read(path)[0].signals} == {"/m.f": "float64", "/m.n": "int64", "/m.s": "str"}


def test_words_among_numbers_are_lost_by_name_and_a_mixture_is_text(tmp_path: Path) -> None:
    messages = [{"T": 20.5 + k if k != 50 else "ERROR", "x": k if k % 2 else f"P{k}"} for k in range(100)]
    path = write(tmp_path / "a.mcap", [("/m", T0 + k, m) for k, m in enumerate(messages)])
    recording, _, values, _, losses = read(path)
    assert {s.name: s.dtype for s in recording.signals} == {"/m.T": "float64", "/m.x": "str"}
    assert [(loss.where, loss.reason, loss.from_ns) for loss in losses] == [
        ("a.mcap topic '/m' field '/m.T'", "expected float64, got 'ERROR'", T0 + 50)]
    assert np.flatnonzero(np.isnan(values["/m.T"])).tolist() == [50]
    assert values["/m.x"][:4] == ["P0", "1", "P2", "3"]


def test_a_message_that_does_not_parse_is_one_loss(tmp_path: Path) -> None:
    messages: list[Message] = axis(300)
    messages[100] = ("/axis", messages[100][1], b'{"pos": {"x": 1.0')
    messages[200] = ("/axis", messages[200][1], b"\xff\xfe")
    _, times, _, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert times["/axis"].size == 298
    assert [loss.from_ns for loss in losses] == [T0 + 100 * STEP, T0 + 200 * STEP]


def test_a_field_that_comes_late_is_named_once(tmp_path: Path) -> None:
    text = "x" * 2000
    messages = [("/m", T0 + k, {"a": k / 2, "pad": text, **({"late": 1, "o": {"p": 2}} if 3400 < k < 3500 else {})})
                for k in range(6000)]
    _, times, values, _, losses = read(write(tmp_path / "a.mcap", messages, chunk=1 << 18))
    assert times["/m"].size == len(values["/m.a"]) == 6000
    assert sorted(loss.where for loss in losses) == [
        "a.mcap topic '/m' field '/m.late'", "a.mcap topic '/m' field '/m.o.p'"]
    assert losses[0].from_ns == T0 + 3401


def test_publish_times_are_kept_where_they_differ(tmp_path: Path) -> None:
    same = write(tmp_path / "a.mcap", axis(5))
    other = write(tmp_path / "b.mcap", axis(5), publish=lambda t: t - 250)
    assert "/axis.publish_time" not in read(same)[2]
    assert read(other)[2]["/axis.publish_time"] == [T0 + k * STEP - 250 for k in range(5)]


def test_order_of_the_recording_is_kept(tmp_path: Path) -> None:
    order = [3, 1, 2, 0, 4]
    path = write(tmp_path / "a.mcap", [("/m", T0 + k, {"k": k}) for k in order])
    assert read(path)[1]["/m"].tolist() == [T0 + k for k in order]
    assert read(path)[2]["/m.k"] == order


def test_log_times_from_zero_are_a_relative_clock(tmp_path: Path) -> None:
    recording, times, _, _, _ = read(write(tmp_path / "a.mcap", [("/m", k * STEP, {"k": k}) for k in range(5)]))
    assert (recording.clock, recording.start_ns) == ("relative", 0)
    assert times["/m"][-1] == 4 * STEP


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_a_cut_file_keeps_what_is_there(tmp_path: Path, compression: CompressionType) -> None:
    content = write(tmp_path / "a.mcap", axis(3000), compression=compression, chunk=1 << 16).read_bytes()
    cut = tmp_path / "cut.mcap"
    last = 0
    for share in (0.2, 0.5, 0.8):
        cut.write_bytes(content[:int(share * len(content))])
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
def test_a_damaged_chunk_costs_only_itself(tmp_path: Path, compression: CompressionType) -> None:
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


@pytest.mark.parametrize("compression", COMPRESSIONS[1:])
def test_a_damaged_length_is_skipped_to_the_next_chunk(tmp_path: Path, compression: CompressionType) -> None:
    path = write(tmp_path / "a.mcap", axis(3000), compression=compression, chunk=1 << 15)
    content = bytearray(path.read_bytes())
    start, _ = chunk_places(content)[3]
    content[start + 1:start + 9] = struct.pack("<Q", 2**40)
    path.write_bytes(content)
    _, times, _, _, losses = read(path)
    assert len(losses) == 1
    assert "no record" in losses[0].reason
    assert times["/axis"].size > 2000
    assert times["/axis"][-1] == T0 + 2999 * STEP


def test_an_index_that_lies_is_not_believed(tmp_path: Path) -> None:
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


def test_a_long_file_without_chunks_is_read_by_its_head(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from thermodata_reader_mcap import plan

    monkeypatch.setattr(plan, "WHOLE", 2000)
    recording, times, values, _, losses = read(write(tmp_path / "a.mcap", axis(500), use_chunking=False))
    assert not losses
    assert times["/axis"].size == 500
    assert {s.name: s.dtype for s in recording.signals}["/axis.pos.z"] == "float64"
    assert values["/axis.pos.z"] == [-k for k in range(500)]


def test_an_encoding_that_nothing_reads_is_refused_by_name(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", [("/x", T0, b"\x00\x01")], encoding="cbor")
    with pytest.raises(FormatError, match=r"'/x' is not read: encoding 'cbor' .* is not supported"):
        described(Reader(), path, Source())


def test_one_unreadable_topic_does_not_hide_the_others(tmp_path: Path) -> None:
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


def test_ros2_messages_are_read(tmp_path: Path) -> None:
    pytest.importorskip("mcap_ros2", reason="mcap-ros2-support is not installed")
    if not REAL.exists():
        pytest.skip("shared/data/mcap is not here")
    _, times, values, _, losses = read(REAL / "talker.mcap")
    assert not losses
    assert times["/topic"].size == 10
    assert values["/topic.data"][0] == "Hello, world! 0"
    assert values["/rosout.stamp.sec"][0] * 10**9 + values["/rosout.stamp.nanosec"][0] == pytest.approx(
        int(times["/rosout"][0]), abs=10_000_000)
    _, _, arrays, _, _ = read(REAL / "cdr_test_0.mcap")
    assert arrays["/test_topic.int32_value"] == [123, 123, 123]
    recording, times, _, _, _ = read(REAL / "wbag_0.mcap")
    assert recording.clock == "relative"
    assert sum(t.size for t in times.values()) == 1246


def test_nothing_else_is_claimed() -> None:
    assert Reader().sniff(Head("x.mcap", 8, b"\x89PNG\r\n\x1a\n")) is None
    assert Reader().sniff(Head("x.bin", 100, b"\x89MCAP0\r\n\x01")) is not None


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("kit") / "sample.mcap", axis(120), chunk=2048)


@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x.mcap"), Source())]))))
def test_it_keeps_the_rules_of_readers(sample: Path, number: int) -> None:
    reader_checks(Reader, [(sample, Source())], claims=["MCAP"])[number]()
