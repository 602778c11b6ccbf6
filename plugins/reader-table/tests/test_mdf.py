"""MDF 3 and 4: groups, scalings, text, invalid samples, the start, damage; without the library, how to get it."""

from __future__ import annotations

import datetime as dt
import gc
import struct
import sys
from pathlib import Path
from typing import Any

import asammdf
import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Scaling, Source
from thermodata.schema.flag import Flag
from thermodata.testing.reader import Data, load

N = 60
T = np.arange(N) * 0.1
WAVE = np.sin(T)
START = int(np.datetime64("2026-03-01T07:00:00.5", "ns").astype(np.int64))


def write(path: Path, version: str, compression: int = 0, start: dt.datetime | None = None) -> Path:
    invalid = np.zeros(N, bool)
    invalid[5:9] = True
    make: Any = asammdf.Signal
    more = {"invalidation_bits": invalid} if version >= "4" else {}
    signals = [
        make(WAVE * 40, T, name="T1", unit="degC", comment="front"),
        make((WAVE * 100).astype("<i2"), T, name="probe", unit="V", conversion={"a": 0.01, "b": -1.0}, **more),
        make(
            (np.arange(N) % 2).astype("u1"),
            T,
            name="door",
            conversion={"val_0": 0, "text_0": b"open", "val_1": 1, "text_1": b"shut"},
        ),
        make(
            (np.arange(N) % 2).astype("u1"),
            T,
            name="curve",
            unit="mm",
            conversion={"raw_0": 0.0, "phys_0": 10.0, "raw_1": 1.0, "phys_1": 30.0, "interpolation": True},
        ),
    ]
    with asammdf.MDF(version=version) as mdf:
        mdf.start_time = start or dt.datetime(2026, 3, 1, 8, 0, 0, 500_000, dt.timezone(dt.timedelta(hours=1)))
        mdf.append(signals)
        mdf.append([make(np.arange(9, dtype=">u4"), np.arange(9) * 1.0, name="T1", unit="K")])
        mdf.save(path, overwrite=True, compression=compression)
    return path


def read(path: Path, timezone: str | None = "Europe/Prague", **options: Any) -> Data:
    return load(Reader(), path, Source(timezone=timezone, options=options))


@pytest.mark.parametrize(("version", "compression"), [("4.10", 0), ("4.11", 2), ("3.30", 0)])
def test_groups_are_streams_with_raw_values_and_declared_scalings(
    tmp_path: Path, version: str, compression: int
) -> None:
    data = read(write(tmp_path / ("x.mf4" if version >= "4" else "x.mdf"), version, compression))
    assert list(data.t_ns) == ["group 1", "group 2"]
    np.testing.assert_array_equal(data.values["group 1", "T1"], WAVE * 40)
    signals = {(s.stream, s.name): s for s in data.recording.signals}
    probe = signals["group 1", "probe"]
    assert (probe.unit, probe.dtype, probe.scaling) == ("V", "int16", Scaling("linear", {"gain": 0.01, "offset": -1.0}))
    np.testing.assert_array_equal(data.values["group 1", "probe"], (WAVE * 100).astype("<i2"))
    assert list(data.values["group 1", "door"][:3]) == ["open", "shut", "open"]
    np.testing.assert_array_equal(data.values["group 1", "door.raw"][:3], [0, 1, 0])
    np.testing.assert_array_equal(data.values["group 1", "curve"][:2], [10, 30])
    assert any("conversion" in n and "curve" in n for n in data.recording.notes)
    assert signals["group 2", "T1"].dtype == "uint32"
    assert abs(data.recording.start_ns - START) < 1000
    np.testing.assert_array_equal(np.diff(data.t_ns["group 2"]), np.full(8, 1_000_000_000))
    if version >= "4":
        flagged = np.flatnonzero(data.flags["group 1", "probe"])
        assert flagged.tolist() == [5, 6, 7, 8]
        assert data.flags["group 1", "probe"][5] == Flag.NOT_MEASURING
        assert signals["group 1", "T1"].properties["comment"] == "front"


def test_small_blocks_change_nothing(tmp_path: Path) -> None:
    path = write(tmp_path / "x.mf4", "4.10")
    whole, small = read(path), read(path, block_rows=7)
    for key, values in whole.values.items():
        np.testing.assert_array_equal(small.values[key], values)


def test_one_group_by_its_number(tmp_path: Path) -> None:
    data = load(Reader(), write(tmp_path / "x.mf4", "4.10"), Source(table={"sheet": 2}))
    assert [s.unit for s in data.recording.signals] == ["K"]


def test_a_start_without_a_zone_takes_that_of_the_source(tmp_path: Path) -> None:
    path = write(tmp_path / "x.mf4", "4.10")
    data = bytearray(path.read_bytes())
    data[64 + 24 + 48 + 12] |= 1  # hd_time_flags: local time
    path.write_bytes(bytes(data))
    # what the header holds is 7:00 now, local
    assert abs(read(path).recording.start_ns - (START - 3_600_000_000_000)) < 1000


def test_a_cut_file_says_what_is_gone(tmp_path: Path) -> None:
    path = write(tmp_path / "x.mf4", "4.10")
    data = bytearray(path.read_bytes())
    at = data.find(b"##DT")
    struct.pack_into("<Q", data, at + 8, struct.unpack_from("<Q", data, at + 8)[0] + 10_000_000)
    path.write_bytes(bytes(data))
    try:
        found = read(path)
    except FormatError:
        return
    assert found.recording.complete is False
    assert found.losses


@pytest.mark.parametrize(("kind", "offset"), [(b"##CG", 24), (b"##CN", 24), (b"##DG", 32)])
def test_links_in_a_circle_or_out_of_the_file_are_refused(tmp_path: Path, kind: bytes, offset: int) -> None:
    path = write(tmp_path / "x.mf4", "4.10")
    data = path.read_bytes()
    at = data.find(kind)
    for target in (at, len(data) + 8, 3):
        path.write_bytes(data[: at + offset] + struct.pack("<Q", target) + data[at + offset + 8 :])
        with pytest.raises(FormatError, match=r"circle|out of the file|no block|another kind"):
            read(path)


def test_what_the_library_leaves_of_a_file_that_it_gives_up_is_no_word_on_stderr(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path / "x.mf4", "4.10")

    def gives_up(*_: Any, **__: Any) -> None:
        raise ValueError("a block of another kind")

    monkeypatch.setattr("asammdf.blocks.mdf_v4.MDF4._read", gives_up)
    told: list[Any] = []
    monkeypatch.setattr(sys, "unraisablehook", told.append)
    with pytest.raises(FormatError, match="a damaged MDF file"):
        read(path)
    gc.collect()
    assert told == []


def test_a_channel_outside_its_record_is_refused_before_the_library_reads_there(tmp_path: Path) -> None:
    path = write(tmp_path / "x.mf4", "4.10")
    data = bytearray(path.read_bytes())
    at = data.find(b"##CN")
    links = struct.unpack_from("<Q", data, at + 16)[0]
    struct.pack_into("<I", data, at + 24 + 8 * links + 4, 2**31)
    path.write_bytes(bytes(data))
    with pytest.raises(FormatError, match="does not fit its record"):
        read(path)


def test_without_asammdf_the_error_names_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path / "x.mf4", "4.10")
    monkeypatch.setitem(sys.modules, "asammdf", None)
    with pytest.raises(FormatError, match=r"pip install 'thermodata-reader-table\[mdf\]'"):
        read(path)


@pytest.mark.parametrize("version", ["3.30", "4.10"])
def test_a_local_start_without_any_zone_is_noted(tmp_path: Path, version: str) -> None:
    path = write(tmp_path / f"a.{'mf4' if version >= '4' else 'mdf'}", version, start=dt.datetime(2026, 3, 1, 8, 0))
    data = read(path, None)
    assert data.recording.start_ns == int(np.datetime64("2026-03-01T08:00:00", "ns").astype(np.int64))
    assert any("UTC" in note for note in data.recording.notes)
