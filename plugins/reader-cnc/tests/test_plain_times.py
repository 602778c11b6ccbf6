"""Times of plain CSV exports: as controls write them, without a zone, over a change of the clocks."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.registry import head
from thermodata.testing.reader import load

from .test_plain import ASIAN, HEADER, PRAGUE, ns, read, rows, write


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        ("02.03.2026 08:00:00", "2026-03-02T07:00:00"),
        ("2.3.2026 8:00:00", "2026-03-02T07:00:00"),
        ("02.03.26 08:00:00,250", "2026-03-02T07:00:00.250"),
        ("2026-03-02 08:00:00.5", "2026-03-02T07:00:00.5"),
        ("2026-03-02T08:00:00,123456", "2026-03-02T07:00:00.123456"),
        ("2026/03/02 08:00:00:042", "2026-03-02T07:00:00.042"),
        ("2026-03-02T08:00:00Z", "2026-03-02T08:00:00"),
        ("2026-03-02T08:00:00+05:30", "2026-03-02T02:30:00"),
        ("03/25/2026 08:00:00", "2026-03-25T07:00:00"),
        ("25/03/2026 08:00", "2026-03-25T07:00:00"),
        ("3/25/2026 1:05:00 PM", "2026-03-25T12:05:00"),
        ("3/4/2026 12:05:00 AM", "2026-03-03T23:05:00"),
    ],
)
def test_times_as_controls_write_them(tmp_path: Path, cells: str, expected: str) -> None:
    path = write(tmp_path, "Zeitstempel\tF\n" + f"{cells}\t1.5\n" * 3)
    recording, t_ns, _, losses = read(path)
    assert not losses
    assert recording.start_ns == ns(expected)
    assert t_ns.tolist() == [ns(expected)] * 3
    assert Reader().sniff(head(path)) is not None


def test_day_and_month_that_nothing_tells_apart_are_an_error_and_can_be_declared(tmp_path: Path) -> None:
    path = write(tmp_path, "Date;F\n03/04/2026 08:00:00;1\n03/04/2026 09:00:00;1\n")
    assert Reader().sniff(head(path)) is not None
    with pytest.raises(FormatError, match="day and month"):
        described(Reader(), path, PRAGUE)
    declared = Source(timezone="UTC", table={"time": {"column": "Date", "format": "%d/%m/%Y %H:%M:%S"}})
    assert read(path, declared)[1][0] == ns("2026-04-03T08:00:00")


def test_a_number_above_12_late_in_the_file_tells_day_from_month(tmp_path: Path) -> None:
    text = "Date;F\n" + "03/04/2026 08:00:00;1\n" * 50_000 + "13/04/2026 08:00:00;1\n" * 50_000
    path = write(tmp_path, text)
    assert read(path, Source(timezone="UTC"))[1][[0, -1]].tolist() == [
        ns("2026-04-03T08:00:00"),
        ns("2026-04-13T08:00:00"),
    ]


def test_times_without_a_zone_are_utc_with_a_note(tmp_path: Path) -> None:
    recording, t_ns, _, _ = read(write(tmp_path, HEADER + "\n".join(rows(3)) + "\n"), Source())
    assert t_ns[0] == ns("2026-03-02T08:00:00")
    assert any("UTC" in note for note in recording.notes)


def local_rows(first: str, last: str, zone: str, step_s: int) -> list[str]:
    from zoneinfo import ZoneInfo

    a, b = (datetime.fromisoformat(t).replace(tzinfo=UTC).timestamp() for t in (first, last))
    stamps = [datetime.fromtimestamp(s, ZoneInfo(zone)) for s in np.arange(a, b, step_s)]
    return [f"{s:%d.%m.%Y;%H:%M:%S};{k}" for k, s in enumerate(stamps)]


@pytest.mark.parametrize(
    ("first", "last"), [("2026-10-24T20:00:00", "2026-10-25T06:00:00"), ("2026-03-28T20:00:00", "2026-03-29T06:00:00")]
)
@pytest.mark.parametrize("chunk", [1 << 20, 700])
def test_daylight_saving_is_resolved_across_chunks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, first: str, last: str, chunk: int
) -> None:
    from thermodata.reader.text.file import lines

    monkeypatch.setattr(lines.chunks, "__defaults__", (chunk,))
    path = write(tmp_path, "Datum;Uhrzeit;k\n" + "\n".join(local_rows(first, last, "Europe/Prague", 30)) + "\n")
    recording, t_ns, values, losses = read(path)
    assert not losses
    assert values["k"] == list(range(1200))
    np.testing.assert_array_equal(t_ns, ns(first) + np.arange(1200) * 30_000_000_000)
    assert any("daylight" in note for note in recording.notes)


def test_separate_milliseconds_belong_to_the_time(tmp_path: Path) -> None:
    path = write(tmp_path, "Datum;Zeit;ms;T\n" + "".join(f"02.03.2026;08:00:00;{k * 100};1\n" for k in range(5)))
    recording, t_ns, _, _ = read(path)
    assert [s.name for s in recording.signals] == ["T"]
    assert np.diff(t_ns).tolist() == [100_000_000] * 4


def test_relative_time_is_read_when_the_column_says_so(tmp_path: Path) -> None:
    path = write(tmp_path, "Zeit [s];T\n0,0;20,5\n0,1;20,6\n0,2;20,7\n")
    recording, t_ns, values, _ = read(path)
    assert recording.clock == "relative"
    assert t_ns.tolist() == [0, 100_000_000, 200_000_000]
    assert values["T"] == [20.5, 20.6, 20.7]
    assert Reader().sniff(head(path)) is None


def test_dates_of_the_east_and_utf8_names(tmp_path: Path) -> None:
    path = tmp_path / "nc.csv"
    path.write_text(ASIAN.replace("2026-03-02 ", "2026年3月2日 "), "utf-8")
    data = load(Reader(), path, Source(timezone="Asia/Shanghai"))
    assert data.recording.start_ns == np.datetime64("2026-03-02T00:00:00", "ns").astype(np.int64)
    assert [s.unit for s in data.recording.signals] == ["rpm", "°C"]


def test_a_repeated_header_does_not_hide_the_milliseconds(tmp_path: Path) -> None:
    path = tmp_path / "nc.csv"
    rows = [f"2026-03-02T08:00:{k:02d}Z;{k * 7};{k}.5\n" for k in range(20)]
    path.write_text("time;ms;a\n" + "".join(rows[:10]) + "time;ms;a\n" + "".join(rows[10:]))
    data = load(Reader(), path, Source())
    assert [s.name for s in data.recording.signals] == ["a"]
    assert (np.diff(data.t_ns["nc"]) == 1_007_000_000).all()
