"""Signals of JSON messages: nested fields, arrays, types, and values that do not fit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType, IndexType
from thermodata_reader_mcap import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.contract.guard import described

T0 = 1_772_434_800_000_000_000
STEP = 10_000_000
REAL = Path(__file__).resolve().parents[5] / "shared" / "data" / "mcap"
COMPRESSIONS = [CompressionType.NONE, CompressionType.LZ4, CompressionType.ZSTD]


@pytest.mark.parametrize("compression", COMPRESSIONS)
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"use_chunking": False},
        {
            "use_summary_offsets": False,
            "use_statistics": False,
            "repeat_channels": False,
            "repeat_schemas": False,
            "index_types": IndexType.NONE,
        },
    ],
)
def test_nested_fields_arrays_and_types(
    tmp_path: Path, compression: CompressionType, options: dict[str, bool], write: Any, read: Any, axis: Any
) -> None:
    path = write(tmp_path / "a.mcap", axis(500), compression=compression, **options)
    recording, times, values, flags, losses = read(path)
    assert losses == []
    assert {s.name: s.dtype for s in recording.signals} == {
        "/axis.pos.x": "float64",
        "/axis.pos.z": "int64",
        "/axis.t[0]": "float64",
        "/axis.t[1]": "float64",
        "/axis.on": "bool",
        "/axis.prog": "str",
    }
    assert (recording.clock, recording.start_ns, recording.complete) == ("absolute", T0, True)
    np.testing.assert_array_equal(times["/axis"], T0 + STEP * np.arange(500))
    np.testing.assert_array_equal(values["/axis.pos.x"], np.arange(500) / 8)
    assert values["/axis.pos.z"] == [-k for k in range(500)]
    np.testing.assert_array_equal(values["/axis.t[0]"], 20 + np.arange(500) / 4)
    assert values["/axis.on"] == [k % 2 == 0 for k in range(500)]
    assert values["/axis.prog"] == [f"MPF{k // 100}" for k in range(500)]
    assert not any(any(f) for f in flags.values())


def test_topics_are_streams_and_can_be_chosen(tmp_path: Path, write: Any, read: Any) -> None:
    path = write(
        tmp_path / "a.mcap",
        [
            m
            for k in range(20)
            for m in (
                ("/t", T0 + k * STEP, {"v": k}),
                ("/u", T0 + k * STEP + 1, {"v": 0.5}),
                ("odd", T0 + k * STEP, {"v": "x"}),
            )
        ],
    )
    recording, times, _, _, _ = read(path)
    assert {s.stream for s in recording.signals} == set(times) == {"/t", "/u", "odd"}
    assert [s.name for s in read(path, Source(topics=("/u",)))[0].signals] == ["/u.v"]
    assert [s.name for s in read(path, Source(topics=("/*",)))[0].signals] == ["/t.v", "/u.v"]
    with pytest.raises(FormatError, match="no topic '/missing'"):
        described(Reader(), path, Source(topics=("/missing",)))


def test_integers_beyond_a_float_stay_exact_with_and_without_gaps(tmp_path: Path, write: Any, read: Any) -> None:
    big = 2**53 + 1
    path = write(
        tmp_path / "a.mcap",
        [("/c", T0 + k, {"n": big + k, "u": 2**63 + k} if k != 7 else {"n": None}) for k in range(20)],
    )
    recording, _, values, flags, losses = read(path)
    assert not losses
    assert {s.name: s.dtype for s in recording.signals} == {"/c.n": "int64", "/c.u": "uint64"}
    assert values["/c.n"] == [big + k if k != 7 else 0 for k in range(20)]
    assert values["/c.u"] == [2**63 + k if k != 7 else 0 for k in range(20)]
    assert flags["/c.n"] == flags["/c.u"] == [128 * (k == 7) for k in range(20)]


def test_missing_and_null_fields_are_nan(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [{"a": 1.5, "s": "x", "o": {"b": 2}}, {"a": None}, {"o": None}, {"a": 2, "s": None, "o": {"b": 3.5}}]
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", [("/m", T0 + k, m) for k, m in enumerate(messages)]))
    assert not losses
    np.testing.assert_array_equal(values["/m.a"], [1.5, np.nan, np.nan, 2])
    np.testing.assert_array_equal(values["/m.o.b"], [2, np.nan, np.nan, 3.5])
    assert values["/m.s"] == ["x", None, None, None]


def test_arrays_that_grow_and_arrays_of_objects(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [{"p": [{"T": 20.5, "id": "a"}]}, {"p": [{"T": 21, "id": "a"}, {"T": 30.5, "id": "b"}]}, {"p": []}]
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", [("/m", T0 + k, m) for k, m in enumerate(messages)]))
    assert not losses
    np.testing.assert_array_equal(values["/m.p.a.T"], [20.5, 21, np.nan])
    np.testing.assert_array_equal(values["/m.p.b.T"], [np.nan, 30.5, np.nan])


def test_messages_that_are_no_objects(tmp_path: Path, write: Any, read: Any) -> None:
    path = write(tmp_path / "a.mcap", [m for k in range(40) for m in (("/n", T0 + k, k / 2), ("/l", T0 + k, [k, 0.5]))])
    _, _, values, _, losses = read(path)
    assert not losses
    assert values["/n"] == [k / 2 for k in range(40)]
    assert values["/l[0]"] == list(range(40))


def test_a_schema_decides_what_the_first_messages_leave_open(tmp_path: Path, write: Any, read: Any) -> None:
    kinds = {"f": "number", "n": "integer", "s": "string"}
    schema = {"type": "object", "properties": {name: {"type": kind} for name, kind in kinds.items()}}
    path = write(tmp_path / "a.mcap", [("/m", T0 + k, {"f": k, "n": k, "s": None}) for k in range(5)], schema=schema)
    assert {s.name: s.dtype for s in read(path)[0].signals} == {"/m.f": "float64", "/m.n": "int64", "/m.s": "str"}


def test_words_among_numbers_are_lost_by_name_and_a_mixture_is_text(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [{"T": 20.5 + k if k != 50 else "ERROR", "x": k if k % 2 else f"P{k}"} for k in range(100)]
    path = write(tmp_path / "a.mcap", [("/m", T0 + k, m) for k, m in enumerate(messages)])
    recording, _, values, _, losses = read(path)
    assert {s.name: s.dtype for s in recording.signals} == {"/m.T": "float64", "/m.x": "str"}
    assert [(loss.where, loss.reason, loss.from_ns) for loss in losses] == [
        ("a.mcap topic '/m' field '/m.T'", "expected float64, got 'ERROR'", T0 + 50)
    ]
    assert np.flatnonzero(np.isnan(values["/m.T"])).tolist() == [50]
    assert values["/m.x"][:4] == ["P0", "1", "P2", "3"]


def test_a_message_that_does_not_parse_is_one_loss(tmp_path: Path, write: Any, read: Any, axis: Any) -> None:
    messages = axis(300)
    messages[100] = ("/axis", messages[100][1], b'{"pos": {"x": 1.0')
    messages[200] = ("/axis", messages[200][1], b"\xff\xfe")
    _, times, _, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert times["/axis"].size == 298
    assert [loss.from_ns for loss in losses] == [T0 + 100 * STEP, T0 + 200 * STEP]


def test_a_field_that_comes_late_is_named_once(tmp_path: Path, write: Any, read: Any) -> None:
    text = "x" * 2000
    messages = [
        ("/m", T0 + k, {"a": k / 2, "pad": text, **({"late": 1, "o": {"p": 2}} if 3400 < k < 3500 else {})})
        for k in range(6000)
    ]
    _, times, values, _, losses = read(write(tmp_path / "a.mcap", messages, chunk=1 << 18))
    assert times["/m"].size == len(values["/m.a"]) == 6000
    assert sorted(loss.where for loss in losses) == [
        "a.mcap topic '/m' field '/m.late'",
        "a.mcap topic '/m' field '/m.o.p'",
    ]
    assert losses[0].from_ns == T0 + 3401
