"""TDMS files that are rare, or that only the format's own rules allow."""

from __future__ import annotations

import shutil
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_crio import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.schema.flag import Flag
from thermodata.testing.reader import Data, load

START = np.datetime64("2026-03-01T08:00:00", "ns").astype(np.int64).item()
S = 1_000_000_000


def read(tmp_path: Path, *segments: bytes, **options: Any) -> Data:
    path = tmp_path / "x.tdms"
    path.write_bytes(b"".join(segments))
    return load(Reader(), path, Source(options=options))


def index(b: Any, code: int, n: int) -> bytes:
    return b.pack("IIIQ", 20, code, 1, n)


def test_segments_of_both_byte_orders_in_one_file(tmp_path: Path, tdms_in) -> None:  # type: ignore[no-untyped-def]
    parts = []
    for order in "<>":
        b = tdms_in(order)
        raw = np.arange(3.0).astype(order + "f8").tobytes()
        parts.append(b.segment([b.channel("G", "a", "float64", 3, b.wave())], raw))
    np.testing.assert_array_equal(read(tmp_path, *parts).values["G", "G/a"], [0, 1, 2, 0, 1, 2])


def test_a_type_that_changes_is_delivered_in_the_one_that_holds_both(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    parts = [
        tdms.segment([tdms.channel("G", "a", kind, 2, tdms.wave())], np.array([1, -2], dtype).tobytes())
        for kind, dtype in (("int16", "<i2"), ("float64", "<f8"))
    ]
    data = read(tmp_path, *parts)
    assert data.values["G", "G/a"].dtype == np.float64
    np.testing.assert_array_equal(data.values["G", "G/a"], [1, -2, 1, -2])
    assert "type changes" in " ".join(data.recording.notes)


def test_complex_numbers_are_two_signals(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    objects = [
        tdms.channel("G", "c", None, 2, tdms.wave(), index(tdms, 0x10000D, 2)),
        tdms.channel("G", "x", "float64", 2, tdms.wave()),
    ]
    data = read(tmp_path, tdms.segment(objects, np.array([1 + 2j, 3 - 4j]).tobytes() + np.array([5.0, 6]).tobytes()))
    np.testing.assert_array_equal(data.values["G", "G/c (im)"], [2, -4])
    np.testing.assert_array_equal(data.values["G", "G/x"], [5, 6])


def test_extended_floats_are_refused_by_name(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    objects = [tdms.channel("G", "ext", None, 2, tdms.wave(), index(tdms, 0x0B, 2))]
    with pytest.raises(FormatError, match="extended floating point"):
        read(tmp_path, tdms.segment(objects, bytes(32)))


def test_seconds_since_1904_in_a_channel_are_dates(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    t = START / S + 2_082_844_800 + np.array([0.0, 0.25, np.nan, 1.0])
    objects = [tdms.channel("G", "Time", "float64", 4), tdms.channel("G", "T", "float64", 4)]
    data = read(tmp_path, tdms.segment(objects, t.tobytes() + np.arange(4.0).tobytes()))
    np.testing.assert_array_equal(data.t_ns["G"], START + np.array([0, S // 4, S]))
    np.testing.assert_array_equal(data.values["G", "G/T"], [0, 1, 3])
    assert "1 row whose time channel holds no time" in data.losses[0].reason


def test_text_whose_offsets_cannot_be_is_flagged(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    raw = np.array([2, 900, 4], "<u4").tobytes() + b"abcd"
    item = tdms.pack("IIIQQ", 28, 0x20, 1, 3, len(raw))
    data = read(tmp_path, tdms.segment([tdms.channel("G", "s", None, 3, tdms.wave(), item)], raw))
    assert list(data.values["G", "G/s"]) == ["ab", "", ""]
    np.testing.assert_array_equal(data.flags["G", "G/s"], [0, Flag.NOT_MEASURING, Flag.NOT_MEASURING])


def test_groups_whose_streams_would_share_a_name(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    objects = [
        tdms.channel("G", "a", "float64", 2, tdms.wave(step=0.1)),
        tdms.channel("G", "b", "float64", 2, tdms.wave(step=1.0)),
        tdms.channel("g@2", "c", "float64", 2, tdms.wave(step=0.1)),
        tdms.channel("", "d", "float64", 2),
    ]
    data = read(tmp_path, tdms.segment(objects, bytes(64)))
    assert sorted(data.t_ns) == ["G", "G@2", "data", "g@2@2"]


def test_an_increment_beyond_any_date_is_not_used(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    objects = [tdms.channel("G", "a", "float64", 20, tdms.wave(step=9e8))]
    data = read(tmp_path, tdms.segment(objects, bytes(160)))
    assert "beyond any date" in data.recording.notes[0]
    assert data.t_ns["G"][-1] == 19 * S


def test_padding_behind_metadata_is_stepped_over_and_other_bytes_are_noted(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    meta = tdms.pack("I", 1) + tdms.channel("G", "a", "float64", 2, tdms.wave())
    for pad, said in ((bytes(100), False), (b"\0\0\0\7" * 25, True)):
        raw = np.array([1.0, 2]).tobytes()
        lead = b"TDSm" + tdms.pack("IIQQ", 14, 4713, len(meta) + 100 + 16, len(meta) + 100)
        data = read(tmp_path, lead + meta + pad + raw)
        np.testing.assert_array_equal(data.values["G", "G/a"], [1, 2])
        assert any("belong to no object" in note for note in data.recording.notes) == said


def test_a_short_last_chunk_is_noted(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    objects = [tdms.channel("G", name, "float64", 4, tdms.wave()) for name in "ab"]
    data = read(tmp_path, tdms.segment(objects, np.arange(12.0).tobytes()))
    np.testing.assert_array_equal(data.values["G", "G/a"], [0, 1, 2, 3, 8, 9])
    assert "written shorter" in data.recording.notes[0]


SCALE = {"NI_Number_Of_Scales": 2, "NI_Scale[1]_Scale_Type": "Linear", "NI_Scale[1]_Linear_Y_Intercept": 0.0}


@pytest.mark.parametrize(
    "segments",
    [
        ({"unit_string": "V"}, {"unit_string": "mV"}),
        ({**SCALE, "NI_Scale[1]_Linear_Slope": 1.0}, {**SCALE, "NI_Scale[1]_Linear_Slope": 1000.0}),
    ],
    ids=["unit", "slope"],
)
def test_a_channel_that_changes_its_meaning_within_the_file_is_left_out(  # type: ignore[no-untyped-def]
    tmp_path: Path, tdms, segments: tuple[dict[str, object], ...]
) -> None:
    def made(name: str, *segments: dict[str, object]) -> Data:
        parts = []
        for properties in segments:
            z = tdms.channel("Eddy", "Z", "float64", 4, tdms.wave(**properties))
            y = tdms.channel("Eddy", "Y", "float64", 4, tdms.wave(unit_string="V"))
            parts.append(tdms.segment([z, y], np.arange(8.0).tobytes()))
        (tmp_path / name).write_bytes(b"".join(parts))
        return load(Reader(), tmp_path / name, Source())

    data = made("a.tdms", *segments)
    assert [s.name for s in data.recording.signals] == ["Eddy/Y"]
    assert any("Eddy/Z is left out" in x.reason and "split the file there" in x.reason for x in data.losses)
    same = made("b.tdms", segments[0], segments[0])
    assert [s.name for s in same.recording.signals] == ["Eddy/Z", "Eddy/Y"]
    assert same.losses == ()


def test_channels_that_begin_alike_part_where_one_is_written_anew(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    # equal properties are parsed once and shared: what is said anew of one must not be said of the others
    waves = [tdms.channel("g", f"c{i}", "float64", 2, tdms.wave(unit_string="V", note="same")) for i in range(5)]
    waves[3] = tdms.channel("g", "c3", "float64", 2, tdms.wave(unit_string="degC", note="same"))
    anew = [tdms.channel("g", "c1", "float64", 2, {"note": "other"})]
    path = tmp_path / "x.tdms"
    path.write_bytes(
        tdms.segment(waves, np.arange(10.0).tobytes()) + tdms.segment(anew, np.arange(2.0).tobytes(), new_list=True)
    )
    said = {s.name: s for s in Reader().describe(path, Source()).signals}
    assert [said[f"g/c{i}"].unit for i in range(5)] == ["V", "V", "V", "degC", "V"]
    assert [said[f"g/c{i}"].properties["note"] for i in range(5)] == ["same", "other", "same", "same", "same"]
    values = load(Reader(), path, Source()).values
    assert [values[said[f"g/c{i}"].stream, f"g/c{i}"].size for i in range(2)] == [2, 4]


def test_a_property_that_is_named_twice_counts_as_it_stands_last(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    twice = tdms.channel("g", "a", "float64", 1, {"note": "1", "nota": "2"})
    path = tmp_path / "x.tdms"
    path.write_bytes(
        tdms.segment([twice.replace(b"nota", b"note"), tdms.channel("g", "b", "float64", 1, {"note": "1"})], bytes(16))
    )
    assert [s.properties["note"] for s in Reader().describe(path, Source()).signals] == ["2", "1"]


def test_many_channels_take_little_memory_each(tmp_path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    n = 3000
    wave = {"wf_start_time": np.datetime64("2026-03-02T06:00:00", "us"), "wf_increment": 1.0, "unit_string": "degC"}
    with TdmsWriter(str(tmp_path / "wide.tdms")) as writer:
        writer.write_segment([ChannelObject(f"g{i // 1000}", f"c{i}", np.arange(3.0) + i, wave) for i in range(n)])
    Reader().describe(Path(shutil.copy(tmp_path / "wide.tdms", tmp_path / "other.tdms")), Source())  # imports
    tracemalloc.start()
    try:
        said = Reader().describe(tmp_path / "wide.tdms", Source())
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert len(said.signals) == n
    assert most / n < 1800  # bytes
    data = load(Reader(), tmp_path / "wide.tdms", Source())
    assert all(data.values[s.stream, s.name][2] == 2 + i for i, s in enumerate(said.signals))
