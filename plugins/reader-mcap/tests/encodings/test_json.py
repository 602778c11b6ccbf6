"""JSON through Arrow: the same as one by one by the standard library, whatever stands in the messages."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from thermodata_reader_mcap.encodings.columns import Columns
from thermodata_reader_mcap.encodings.decoded_messages import columns as one_by_one
from thermodata_reader_mcap.encodings.json import arrow
from thermodata_reader_mcap.encodings.json.decoder import JsonDecoder
from thermodata_reader_mcap.encodings.json.text import loads
from thermodata_reader_mcap.signals.survey.field_survey import Survey
from thermodata_reader_mcap.signals.survey.topic_discovery import discover

from thermodata.plugin import Source

T0 = 1_772_434_800_000_000_000
numbers = st.one_of(st.integers(-5, 5), st.floats(), st.sampled_from([2**53 + 1, -(2**60) - 1, 2**63, 10**20, 1e300]))
scalars = st.one_of(numbers, st.booleans(), st.none(), st.text(max_size=4))
keys = st.sampled_from(["a", "b", "x y", ""])
trees = st.recursive(
    scalars,
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(keys, inner, max_size=3)),
    max_leaves=6,
)
objects = st.dictionaries(st.sampled_from(["a", "b", "c", "t"]), trees, max_size=4)
payloads = st.one_of(
    objects.map(lambda m: json.dumps(m).encode()),
    objects.map(lambda m: json.dumps(m, indent=1).encode()),
    st.sampled_from(
        [
            b"",
            b"{}",
            b'{"a": 1} {"a": 2}',
            b'{"a": 1,}',
            b'{"a": 1',
            b'"a": 1}',
            b"[1]",
            b" {} ",
            b"{}\n",
            b'{"a": "\xff"}',
            b'{"a": "\\ud800"}',
            b'{"a": 1, "a": 2}',
            b'{"a": 1e999}',
            b'{"a": 01}',
            b"\xef\xbb\xbf{}",
            b'{"a": "x\ny"}',
            b"}\n{",
        ]
    ),
)


def joined(parts: list[Columns]) -> dict[str, Any]:
    values: dict[str, list[Any]] = {}
    for part in parts:
        for name, column in part.values.items():
            none = np.zeros(part.kept.size, np.uint16)
            values.setdefault(name, []).extend(zip(column.tolist(), part.flags.get(name, none).tolist(), strict=True))
    return values


def shown(values: dict[str, list[Any]]) -> dict[str, list[str]]:
    return {name: [repr(v) for v in column] for name, column in values.items()}


@settings(deadline=None)
@given(
    st.lists(payloads, min_size=1, max_size=5), st.lists(st.integers(0, 4), min_size=1, max_size=150), st.integers(1, 3)
)
def test_columns_are_those_of_the_standard_library(kinds: list[bytes], order: list[int], step: int) -> None:
    messages = [kinds[k % len(kinds)] for k in order]
    topic = discover("/m", {"c": JsonDecoder(None)}, {"c": messages[::step]}, False, 1 << 20)[0]
    if topic is None:
        return
    parts = list(arrow.columns(topic, messages, 0))
    alone = one_by_one(topic, loads, messages, 0)
    assert np.concatenate([p.kept for p in parts]).tolist() == alone.kept.tolist()
    assert shown(joined(parts)) == shown(joined([alone]))
    named = {(w.message, w.name, w.expected) for p in parts for w in p.wrong if w.expected is not None}
    assert named == {(w.message, w.name, w.expected) for w in alone.wrong if w.expected is not None}
    fields = {w.name.replace("[1]", "[0]").replace("[2]", "[0]") for w in alone.wrong if w.expected is None}
    assert fields == {
        w.name.replace("[1]", "[0]").replace("[2]", "[0]") for p in parts for w in p.wrong if w.expected is None
    }


@settings(deadline=None)
@given(st.lists(objects, min_size=17, max_size=40))
def test_signals_are_the_same_however_the_sample_was_parsed(messages: list[dict[str, Any]]) -> None:
    from thermodata_reader_mcap.signals.survey.topic_discovery import _by_arrow

    quick, slow = Survey(), Survey()
    if not _by_arrow([json.dumps(m).encode() for m in messages], quick):
        assert quick.total == 0
        return
    for message in messages:
        slow.add(message)
    for path, each in slow.seen.items():
        if each.scalars:
            other = quick.seen[path]
            assert (other.bools, other.integers + other.floats, other.texts) == (
                each.bools,
                each.integers + each.floats,
                each.texts,
            )
            assert other.floats >= each.floats


def test_what_json_has_not_and_writers_write(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [b'{"v": NaN}', b'{"v": Infinity}', b'{"v": -Infinity}', b'{"v": 1}', b'{"v": 1.5}'] * 30
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", [("/m", T0 + k, m) for k, m in enumerate(messages)]))
    assert not losses
    np.testing.assert_array_equal(values["/m.v"], [np.nan, np.inf, -np.inf, 1, 1.5] * 30)


def test_integers_that_a_float_rounds_are_said(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [("/m", T0 + k, {"v": 0.5 if k != 50 else 2**53 + 1}) for k in range(100)]
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert values["/m.v"][50] == 2.0**53
    assert [(loss.from_ns, "rounded" in loss.reason) for loss in losses] == [(T0 + 50, True)]


def test_a_key_that_comes_twice_is_no_message(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [("/m", T0 + k, b'{"v": 1.5, "v": 2.5}' if k == 50 else b'{"v": 1.5}') for k in range(100)]
    _, times, _, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert times["/m"].size == 99
    assert ["'v' comes twice" in loss.reason for loss in losses] == [True]


@pytest.mark.parametrize("encoding", [None, "cp1250"])
def test_text_that_is_not_utf8_is_read_with_a_note(tmp_path: Path, write: Any, read: Any, encoding: str | None) -> None:
    messages = [("/m", T0 + k, '{"unit": "µm °C", "v": 1.5}'.encode("cp1252")) for k in range(50)]
    recording, _, values, _, losses = read(write(tmp_path / "a.mcap", messages), Source(encoding=encoding))
    assert not losses
    assert values["/m.unit"][0] == "µm °C"
    assert any(f"read as {encoding or 'cp1252'}" in note for note in recording.notes)


def test_a_schema_gives_units(tmp_path: Path, write: Any, read: Any) -> None:
    schema = {
        "type": "object",
        "properties": {
            "T": {"type": "number", "unit": "degC", "description": "front bearing"},
            "pos": {"type": "array", "items": {"type": "number", "units": "mm"}},
        },
    }
    recording, *_ = read(write(tmp_path / "a.mcap", [("/m", T0, {"T": 20, "pos": [1]})], schema=schema))
    assert {s.name: s.unit for s in recording.signals} == {"/m.T": "degC", "/m.pos[0]": "mm"}
    assert recording.signals[0].properties == {"description": "front bearing", "schema": "s"}


def test_arrays_of_more_elements_than_are_read(tmp_path: Path, write: Any, read: Any) -> None:
    recording, _, values, _, losses = read(
        write(tmp_path / "a.mcap", [("/m", T0 + k, {"a": list(range(300)), "b": list(range(256))}) for k in range(40)])
    )
    assert not losses
    assert recording.notes == ("/m.a holds arrays of up to 300 elements; the first 256 are read",)
    assert len(values) == 512
    assert values["/m.b[255]"] == [255] * 40


def test_keys_that_are_data_stay_bounded(tmp_path: Path, write: Any, read: Any) -> None:
    messages = [("/m", T0 + k, {f"k{k}_{j}": j for j in range(50)}) for k in range(150)]
    recording, times, _, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert times["/m"].size == 150
    assert len(recording.signals) == 5000
    assert any("has 7500 fields" in note for note in recording.notes)
    assert not losses
