"""Numbers that count from a date which the file states: in a line above the rows, or in the name of the column; what is
only hinted at is asked."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io

from tests.draft.labs import workbook
from thermodata.draft.make import draft_files
from thermodata.errors import QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.contract.guard import described, guarded
from thermodata.reader.finding.registry import readers

AT = datetime(2026, 3, 12, 7, tzinfo=UTC)


def since(year: int, month: int = 1, day: int = 1, hours: float = 0) -> float:
    """Seconds from a midnight in UTC, or so many hours before it, to AT."""
    return (AT - datetime(year, month, day, tzinfo=UTC)).total_seconds() + 3600 * hours


def written(folder: Path, head: str, name: str, first: float, step: float = 60, ext: str = "csv") -> Path:
    path = folder / f"run.{ext}"
    rows = [(first + step * i, 20 + i / 10) for i in range(40)]
    if ext == "xlsx":
        workbook(path, {"log": [[head], [name, "T [degC]"], *map(list, rows)]})
    else:
        lines = [*([head] if head else []), f"{name};T [degC]", *(f"{t:.12g};{v}" for t, v in rows), ""]
        path.write_text("\n".join(lines))
    return path


def first_time(path: Path, timezone: str | None = None, **time: object) -> datetime | None:
    """When the first row was measured; None where it counts from a start."""
    source = Source(timezone=timezone, table={"time": time} if time else None)
    reader = readers()["crio" if path.suffix == ".tdms" else "table"]
    recording = described(reader, path, source)
    if recording.clock == "relative":
        return None
    block = next(b for b in guarded(reader, path, source, recording) if isinstance(b, Block))
    return datetime.fromtimestamp(round(int(block.t_ns[0]) / 1e9), UTC)


HEADS = [
    ("# time: seconds since 2000-01-01 00:00:00 UTC", "time_s", since(2000), 60, None),
    ("# epoch: 2001-01-01T00:00:00Z", "Time [s]", since(2001), 60, None),
    ("Time base: seconds since 01.01.2000 00:00", "Zeit", since(2000, hours=1), 60, "Europe/Berlin"),
    ("# Zeit in Sekunden seit 01.01.1904", "Zeit [s]", since(1904), 60, "Europe/Berlin"),
    ("# clock: days since 2026-01-00 (day of year)", "DOY", since(2025, 12, 31) / 86400, 1 / 1440, None),
    ("# time: days since 1899-12-30 00:00 UTC", "t [d]", since(1899, 12, 30) / 86400, 1 / 1440, None),
    ("# time: ms since 1970-01-01", "time_ms", since(1970) * 1e3, 6e4, None),
    ("# time: minutes since 2026-03-12T08:00:00+01:00", "t [min]", 0, 1, None),
    ("# time: minutes since 2026-03-12T08:00:00.000+01:00", "t [min]", 0, 1, None),
    ("# time: seconds since 2026-03-12T06:59:57.25Z", "t [s]", 2.75, 60, None),
    ("# time base: GPS", "time_s", since(1980, 1, 6) + 18, 60, None),
    ("# Time scale: TAI", "time_s", since(1970) + 37, 60, None),
    ("# timestamps: PTP (TAI), s since 1970-01-01", "timestamp_s", since(1970) + 37, 60, None),
    ("# clock: TAI, ms since 1970-01-01", "time_ms", (since(1970) + 37) * 1e3, 6e4, None),
    ("# GPS time, seconds since 1980-01-06", "time_s", since(1980, 1, 6) + 18, 60, None),
    ("# PTP clock, seconds since 1970-01-01 UTC", "time_s", since(1970), 60, None),
    ("# GPS receiver, seconds since 1970-01-01", "time_s", since(1970), 60, None),
]


@pytest.mark.parametrize(("head", "name", "first", "step", "timezone"), HEADS)
@pytest.mark.parametrize("ext", ["csv", "xlsx"])
def test_a_line_above_the_rows_states_it(
    tmp_path: Path, head: str, name: str, first: float, step: float, timezone: str | None, ext: str
) -> None:
    path = written(tmp_path, head, name, first, step, ext)
    assert first_time(path, timezone) == AT
    notes = described(readers()["table"], path, Source(timezone=timezone)).notes
    assert any("count from a date by a line above the rows" in n and head.strip("# ")[:20] in n for n in notes)
    (source,) = draft_files(tmp_path).draft.sources
    assert not [q for q in source.questions if not q.startswith("timezone?")]


@pytest.mark.parametrize("ext", ["csv", "xlsx"])
@pytest.mark.parametrize("head", ["# timestamps: PTP, s since 1970-01-01", "# PTP clock, seconds since 1970-01-01"])
def test_a_clock_by_ptp_may_count_leap_seconds_or_none_and_is_asked(tmp_path: Path, head: str, ext: str) -> None:
    path = written(tmp_path, head, "timestamp_s", since(1970) + 37, 60, ext)
    with pytest.raises(QuestionError) as asked:
        first_time(path)
    assert asked.value.declare["time"]["unit"] == "tai"
    assert "2026-03-12 07:00:00 UTC" in asked.value.ask
    assert first_time(path, unit="tai") == AT
    assert first_time(path, unit="unix") != AT


@pytest.mark.parametrize(
    ("name", "first", "step"),
    [
        ("time [s since 1900-01-01]", since(1900), 60),
        ("Seconds since 1904-01-01", since(1904), 60),
        ("t (min since 2026-01-01 00:00 UTC)", since(2026) / 60, 1),
        ("days since 1 January 2000 UTC", since(2000) / 86400, 1 / 1440),
        ("Time [gps]", since(1980, 1, 6) + 18, 60),
        ("Time [tai_ns]", (since(1970) + 37) * 1e9, 6e10),
        ("time [GPS, s since 1980-01-06]", since(1980, 1, 6) + 18, 60),
        ("TAI, ms since 1970-01-01", (since(1970) + 37) * 1e3, 6e4),
        ("GPS clock: s since 1970-01-01 UTC", since(1970), 60),
        ("seconds_since_1904", since(1904), 60),
        ("time_min_since_2026_01_01", since(2026) / 60, 1),
    ],
)
def test_a_name_states_it(tmp_path: Path, name: str, first: float, step: float) -> None:
    assert first_time(written(tmp_path, "", name, first, step)) == AT


def test_a_name_that_says_ptp_is_asked_as_a_head_is(tmp_path: Path) -> None:
    path = written(tmp_path, "", "time [PTP, s since 1970-01-01]", since(1970) + 37)
    with pytest.raises(QuestionError) as asked:
        first_time(path)
    assert asked.value.declare["time"]["unit"] == "tai"
    assert first_time(path, unit="tai") == AT


def test_a_label_and_its_scale_may_stand_in_two_cells(tmp_path: Path) -> None:
    rows = [["time_base", "GPS"], ["time [s]", "T [degC]"]]
    rows += [[since(1980, 1, 6) + 18 + 60 * k, 20 + k / 10] for k in range(40)]
    workbook(tmp_path / "run.xlsx", {"log": rows})
    assert first_time(tmp_path / "run.xlsx") == AT


@pytest.mark.parametrize(
    ("name", "first", "step", "unit"),
    [
        ("gps_time_s", since(1980, 1, 6) + 18, 60, "gps"),
        ("GPS time [s]", since(1980, 1, 6) + 18, 60, "gps"),
        ("Time GPS", since(1980, 1, 6) + 18, 60, "gps"),
        ("ptp_tai_ns", (since(1970) + 37) * 1e9, 6e10, "tai_ns"),
        ("ntp_time", since(1900), 60, "ntp"),
    ],
)
def test_a_scale_that_a_name_hints_at_is_asked(tmp_path: Path, name: str, first: float, step: float, unit: str) -> None:
    path = written(tmp_path, "", name, first, step)
    with pytest.raises(QuestionError) as asked:
        first_time(path)
    said = asked.value.declare["time"]
    assert said["unit"] == unit
    assert "2026-03-12 07:00:00 UTC" in asked.value.ask
    assert first_time(path, **{"column": 1, **said}) == AT


@pytest.mark.parametrize(("year", "name"), [(2000, "time_s"), (2001, "Time [s]"), (1904, "t_s"), (1900, "time [sec]")])
def test_seconds_that_no_recording_reaches_are_asked(tmp_path: Path, year: int, name: str) -> None:
    path = written(tmp_path, "", name, since(year))
    (source,) = draft_files(tmp_path).draft.sources
    assert source.table == {"time": {"unit": "unknown"}}
    assert any(f"'s since {year}-01-01 UTC' (2026-03-12 07:00:00)" in q for q in source.questions)
    assert first_time(path, unit=f"s since {year}-01-01 UTC") == AT
    assert first_time(path, unit="s") is None


@pytest.mark.parametrize(
    ("head", "name", "first"),
    [
        ("", "time [s]", 0),
        ("", "time_s", 3e7),  # up for a year
        ("# machine: 35 days since 2026-01-01 without a stop", "time [s]", 0),
        ("# calibrated after 2026-01-01", "time [s]", 0),
        ("# reference date: 2025-01-01", "time [s]", 86_400),
        ("# epoch: 3", "time [s]", 0),
        ("# time scale: 1 s", "time [s]", 0),
        ("# scale;2000", "time [s]", 0),
        ("", "gps_distance", 0),
        ("# seconds since 2026-01-01 UTC", "time;T_2", 0),  # whose times are dates
    ],
)
def test_the_nearest_others_ask_nothing_new(tmp_path: Path, head: str, name: str, first: float) -> None:
    path = written(tmp_path, head, name, first)
    if name == "time;T_2":
        rows = "".join(f"2026-03-12 07:{i:02}:00;{i};{i}\n" for i in range(40))
        path.write_text(f"{head}\ntime;T_2;T [degC]\n{rows}")
        assert first_time(path) == AT
    elif name == "gps_distance":
        with pytest.raises(QuestionError, match="no time column found"):
            first_time(path)
    else:
        assert first_time(path) is None


def test_an_epoch_of_no_year_that_is_logged_is_not_used_and_said(tmp_path: Path) -> None:
    path = written(tmp_path, "# time: seconds since 1970-01-01", "time [s]", 0)
    assert first_time(path) is None
    assert any("not used" in n for n in described(readers()["table"], path, Source()).notes)


@pytest.mark.parametrize("kind", ["parquet", "mat"])
@pytest.mark.parametrize(
    ("name", "first", "asks"),
    [("time_s", since(2000), "s since 2000-01-01 UTC"), ("time_gps", since(1980, 1, 6) + 18, ""), ("time_s", 3e7, "")],
)
def test_arrays_of_such_seconds_are_asked_too(tmp_path: Path, kind: str, name: str, first: float, asks: str) -> None:
    path, times = tmp_path / f"run.{kind}", first + 60.0 * np.arange(40)
    if kind == "parquet":
        pq.write_table(pa.table({name: times, "T": np.linspace(20, 25, 40)}), path)
    else:
        scipy.io.savemat(path, {name: times, "T": np.linspace(20, 25, 40)})
    if asks:
        with pytest.raises(QuestionError) as asked:
            first_time(path)
        assert f"'{asks}'" in asked.value.ask
        assert first_time(path, unit=asks) == AT
    elif kind == "parquet" and name == "time_gps":
        with pytest.raises(QuestionError, match="GPS"):
            first_time(path)
    else:
        assert first_time(path) == (AT if name == "time_gps" else None)


GPS, TAI = since(1980, 1, 6) + 18, since(1970) + 37
STATED = [
    ({"unit": "s since 2000-01-01"}, {}, since(2000)),
    ({"unit": "GPS time, s since 1980-01-06"}, {}, GPS),
    ({"unit": "s", "description": "seconds since 1900-01-01"}, {}, since(1900)),
    ({"unit": "s", "epoch": "2001-01-01T00:00:00Z"}, {}, since(2001)),
    ({"epoch": "2001-01-01T00:00:00Z"}, {}, since(2001)),
    ({"unit": "s"}, {"time_base": "GPS"}, GPS),
    ({"unit": "s"}, {"clock": "PTP (TAI), s since 1970-01-01"}, TAI),
]


def array_file(
    folder: Path,
    kind: str,
    of_time: dict[str, str],
    of_file: dict[str, str],
    first: float,
    step: float = 60,
    n: int = 40,
) -> Path:
    """Times in seconds, with what the file says of them, and of itself."""
    path, times, values = folder / f"run.{kind}", first + step * np.arange(n, dtype=float), np.linspace(20, 25, n)
    if kind == "parquet":
        fields = [pa.field("time", pa.float64(), metadata=of_time), pa.field("T", pa.float64())]
        pq.write_table(pa.table([times, values], schema=pa.schema(fields, metadata=of_file)), path)
    elif kind == "mat":
        beside = {f"time_{key}": text for key, text in of_time.items()}
        scipy.io.savemat(path, {"time": times, "T": values, **beside, **of_file})
    else:
        nptdms = pytest.importorskip("nptdms")
        own = {("unit_string" if key == "unit" else key): text for key, text in of_time.items()}
        made = [nptdms.ChannelObject("Log", "Time", times, own), nptdms.ChannelObject("Log", "T", values)]
        with nptdms.TdmsWriter(str(path)) as writer:
            writer.write_segment([nptdms.RootObject(of_file), *made])
    return path


@pytest.mark.parametrize("kind", ["parquet", "mat", "tdms"])
@pytest.mark.parametrize(("of_time", "of_file", "first"), STATED)
def test_what_stands_beside_an_array_states_it(
    tmp_path: Path, kind: str, of_time: dict[str, str], of_file: dict[str, str], first: float
) -> None:
    assert first_time(array_file(tmp_path, kind, of_time, of_file, first)) == AT
    (source,) = draft_files(tmp_path).draft.sources
    assert not [q for q in source.questions if not q.startswith("timezone?")]


def test_the_unit_of_an_array_that_counts_from_its_start_is_asked(tmp_path: Path) -> None:
    """0 to 360 of what, of 2026 in each."""
    path = array_file(tmp_path, "parquet", {}, {"epoch": "2026-03-12T07:00:00Z"}, 0, 1, 361)
    with pytest.raises(QuestionError, match="unit"):
        first_time(path)
    assert first_time(path, unit="s since 2026-03-12T07:00:00Z") == AT
    assert first_time(path, unit="min since 2026-03-12T07:00:00Z") == AT


@pytest.mark.parametrize("kind", ["parquet", "mat", "tdms"])
def test_counts_since_1970_are_of_no_other_epoch(tmp_path: Path, kind: str) -> None:
    path = array_file(tmp_path, kind, {}, {"origin": "2000-01-01"}, since(1970))
    assert first_time(path) == AT
    notes = described(readers()["crio" if kind == "tdms" else "table"], path, Source()).notes
    assert any("the file says 'origin: 2000-01-01'" in n and "not used" in n for n in notes)


@pytest.mark.parametrize("kind", ["parquet", "mat", "tdms"])
def test_a_clock_by_ptp_of_an_array_is_asked(tmp_path: Path, kind: str) -> None:
    path = array_file(tmp_path, kind, {"unit": "s"}, {"clock": "PTP, s since 1970-01-01"}, TAI)
    with pytest.raises(QuestionError) as asked:
        first_time(path)
    assert asked.value.declare["time"]["unit"] == "tai"
    assert first_time(path, unit="tai") == AT


@pytest.mark.parametrize("kind", ["parquet", "mat", "tdms"])
@pytest.mark.parametrize(
    "of_file",
    [
        {"note": "calibrated after 2026-01-01"},
        {"base": "2000"},
        {"scale": "0.1"},
        {"machine": "35 days since 2026-01-01 without a stop"},
        {"reference_date": "2025-01-01"},
    ],
)
def test_other_words_beside_an_array_of_seconds_say_nothing_of_them(
    tmp_path: Path, kind: str, of_file: dict[str, str]
) -> None:
    path = array_file(tmp_path, kind, {"unit": "s"}, of_file, 0)
    assert first_time(path) is None
    assert not described(readers()["crio" if kind == "tdms" else "table"], path, Source()).notes


@pytest.mark.parametrize(
    ("name", "first", "unit"), [("gps_time", GPS, "gps"), ("t_tai", TAI, "tai"), ("ntpTime", since(1900), "ntp")]
)
def test_a_tdms_channel_whose_name_hints_at_a_scale_is_asked(
    tmp_path: Path, name: str, first: float, unit: str
) -> None:
    nptdms = pytest.importorskip("nptdms")
    times = nptdms.ChannelObject("Log", name, first + 60.0 * np.arange(40))
    path = tmp_path / "run.tdms"
    with nptdms.TdmsWriter(str(path)) as writer:
        writer.write_segment([times, nptdms.ChannelObject("Log", "T", np.linspace(20, 25, 40))])
    (source,) = draft_files(tmp_path).draft.sources
    assert source.table == {"time": {"unit": unit}}
    assert any("2026-03-12 07:00:00 UTC" in q for q in source.questions)
    assert first_time(path, unit=unit) == AT


def test_attributes_of_an_array_in_hdf5_state_it(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "run.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("time", since(2000) + 60.0 * np.arange(40)), ("T", np.linspace(20, 25, 40))):
            file.create_dataset(name, data=values[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
        file["time"].attrs["units"] = "s since 2000-01-01"
        file["T"].attrs["unit"] = "degC"
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, HDF5 schema 1.00 .".ljust(124) + b"\0\2IM"
    path.write_bytes(head + path.read_bytes()[len(head) :])
    assert first_time(path) == AT
    (signal,) = described(readers()["table"], path, Source()).signals
    assert signal.unit == "degC"
