"""Clocks of TDMS files that do not count in seconds: a waveform's own unit of x, channels of text that hold dates."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_crio import Reader

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.contract.guard import described, guarded
from thermodata.reader.finding.registry import reader

nptdms = pytest.importorskip("nptdms")
T0 = np.datetime64("2026-03-12T07:00:00", "ns").astype(np.int64)
BEGAN = datetime(2026, 3, 12, 8)


def written(path: Path, channels: dict[str, Any], **properties: Any) -> Path:
    with nptdms.TdmsWriter(str(path)) as writer:
        own = {name: {} if name in ("Timestamp", "Note") else properties for name in channels}
        writer.write_segment([nptdms.ChannelObject("Log", n, np.array(v), own[n]) for n, v in channels.items()])
    return path


def times(path: Path, source: Source) -> list[int]:
    own = Reader()
    recording = described(own, path, source)
    return [int(t) for b in guarded(own, path, source, recording) if isinstance(b, Block) for t in b.t_ns]


@pytest.mark.parametrize(
    ("unit", "step_s"),
    [("min", 60), ("h", 3600), ("ms", 1e-3), ("s", 1), ("", 1), ("Sekunden", 1), ("Time", 1), (" Min ", 60)],
)
def test_a_waveform_counts_in_its_unit_of_x(tmp_path: Path, unit: str, step_s: float) -> None:
    start = {"wf_start_time": np.datetime64("2026-03-12T07:00:00"), "wf_increment": 1.0, "wf_start_offset": 2.0}
    more = {"wf_xunit_string": unit} if unit else {}
    path = written(tmp_path / "a.tdms", {"T": np.arange(5.0)}, **start, **more)
    assert times(path, Source()) == [T0 + (2 + k) * round(step_s * 1e9) for k in range(5)]


@pytest.mark.parametrize("over", [{"wf_xunit_string": "Hz"}, {"wf_xunit_string": "mm"}, {"wf_xname": "Frequency"}])
def test_a_waveform_over_no_time_has_none(tmp_path: Path, over: dict[str, str]) -> None:
    start = {"wf_start_time": np.datetime64("2026-03-12T07:00:00"), "wf_increment": 2.0}
    path = tmp_path / "a.tdms"
    with nptdms.TdmsWriter(str(path)) as writer:
        spectrum = nptdms.ChannelObject("Log", "FFT", np.arange(9.0), {**start, **over})
        writer.write_segment([nptdms.ChannelObject("Log", "T", np.arange(5.0), start), spectrum])
    recording = described(Reader(), path, Source())
    assert [s.name for s in recording.signals] == ["Log/T"]
    said = next(iter(over.values()))
    assert f"Log/FFT: stands over {said}, not over time; left out" in recording.notes
    assert times(path, Source()) == [T0 + 2 * k * 10**9 for k in range(5)]
    counted = described(Reader(), path, Source(options={"increment": "0.5 s"}))
    assert {s.name for s in counted.signals} == {"Log/T", "Log/FFT"}
    alone = written(tmp_path / "b.tdms", {"FFT": np.arange(9.0)}, **start, **over)
    with pytest.raises(FormatError, match="not over time"):
        described(Reader(), alone, Source())


def test_a_path_beside_a_channel_of_times_has_these(tmp_path: Path) -> None:
    path = written(tmp_path / "a.tdms", {"Timestamp": stamps("%Y-%m-%d %H:%M:%S"), "T": np.arange(30.0)}, **OVER_MM)
    assert times(path, Source(timezone="Europe/Berlin")) == [T0 + k * 60 * 10**9 for k in range(30)]


OVER_MM = {"wf_increment": 1.0, "wf_xunit_string": "mm"}


def test_a_counter_that_is_full_is_counted_on_and_one_that_was_set_back_is_not(tmp_path: Path) -> None:
    true = 60_000 + 1000 * np.arange(3000)
    for name, counts, read in (("on", true % (1 << 16), true), ("back", true % 2_000_000, true % 2_000_000)):
        path = written(tmp_path / f"{name}.tdms", {"Time": counts, "T": np.arange(3000.0)}, unit_string="ms")
        since = np.array(times(path, Source(options={"block_rows": 450})))
        assert (since // 10**6).tolist() == read.tolist()
        notes = Reader().describe(path, Source()).notes
        assert any("begins anew at 65536" in n for n in notes) is (name == "on")


def stamps(form: str, n: int = 30) -> list[str]:
    return [(BEGAN + timedelta(minutes=k)).strftime(form) for k in range(n)]


@pytest.mark.parametrize("options", [{}, {"time": "Timestamp"}])
@pytest.mark.parametrize("form", ["%d.%m.%Y %H:%M:%S", "%Y-%m-%dT%H:%M:%S", "%Y/%m/%d %H:%M:%S.000"])
def test_a_channel_of_texts_is_the_time(tmp_path: Path, options: dict[str, Any], form: str) -> None:
    path = written(tmp_path / "a.tdms", {"Timestamp": stamps(form), "T": np.arange(30.0)})
    source = Source(timezone="Europe/Berlin", options={**options, "block_rows": 7})
    assert times(path, source) == [T0 + k * 60 * 10**9 for k in range(30)]
    assert [s.name for s in described(Reader(), path, source).signals] == ["Log/T"]
    assert any("no time zone" in n for n in described(Reader(), path, Source(options=options)).notes)


def test_texts_whose_day_and_month_are_open_are_asked(tmp_path: Path) -> None:
    cells = [s.replace("12/03", "03/04") for s in stamps("%d/%m/%Y %H:%M:%S")]
    path = written(tmp_path / "a.tdms", {"Timestamp": cells, "T": np.arange(30.0)})
    with pytest.raises(QuestionError):
        times(path, Source())
    april = times(path, Source(table={"time": {"format": "dmy"}}))
    assert april[0] == np.datetime64("2026-04-03T08:00:00", "ns").astype(np.int64)


def test_other_texts_are_no_time(tmp_path: Path) -> None:
    path = written(
        tmp_path / "a.tdms", {"Note": stamps("%Y-%m-%d %H:%M:%S"), "Timestamp": ["x"] * 30, "T": np.arange(30.0)}
    )
    recording = described(Reader(), path, Source())
    assert recording.clock == "relative"
    assert [s.name for s in recording.signals] == ["Log/Note", "Log/Timestamp", "Log/T"]


def test_a_declared_time_of_other_texts_is_refused_in_words(tmp_path: Path) -> None:
    path = written(tmp_path / "a.tdms", {"Timestamp": ["x"] * 30, "T": np.arange(30.0)})
    with pytest.raises(Exception, match="time") as refused:
        times(path, Source(options={"time": "Timestamp"}))
    assert "ValueError" not in str(refused.value)


GPS = (np.datetime64("2026-03-14T23:55:00") - np.datetime64("1980-01-06")).astype(float) + 18  # the week ends within
COUNTS = GPS + 30.0 * np.arange(40)
IN_UTC = [int(np.datetime64("2026-03-14T23:55:00", "ns").astype(np.int64)) + 30 * k * 10**9 for k in range(40)]


@pytest.mark.parametrize(
    ("week", "of_week", "scale", "roll"),
    [("gps_week", "gps_seconds", 1, 0), ("GPS Week", "TOW [s]", 1, 0), ("week", "iTOW", 1000, 0), ("WN", "tow", 1, 2)],
)
def test_weeks_of_gps_and_the_times_in_them_are_asked_together(
    tmp_path: Path, week: str, of_week: str, scale: int, roll: int
) -> None:
    weeks = np.floor(COUNTS / 604_800).astype(np.int32) - 1024 * roll
    seconds = COUNTS % 604_800 * scale
    path = written(tmp_path / "a.tdms", {week: weeks, of_week: seconds, "T": np.linspace(20, 25, 40)})
    with pytest.raises(QuestionError) as asked:
        times(path, Source())
    assert "2026-03-14 23:55:00 UTC" in asked.value.ask
    declared = Source(table=dict(asked.value.declare))
    assert declared.table["time"]["column"] == [week, of_week]
    assert ("+2048" in declared.table["time"]["format"]) == bool(roll)
    assert times(path, declared) == IN_UTC
    assert [s.name for s in described(Reader(), path, declared).signals] == ["Log/T"]


def test_rows_whose_week_is_none_are_lost_and_told(tmp_path: Path) -> None:
    weeks = np.floor(COUNTS / 604_800)
    weeks[7] = np.nan
    path = written(tmp_path / "a.tdms", {"gps_week": weeks, "tow": COUNTS % 604_800, "T": np.linspace(20, 25, 40)})
    source = Source(table={"time": {"column": ["gps_week", "tow"], "format": "gps_week gps_s"}})
    items = list(guarded(Reader(), path, source, described(Reader(), path, source)))
    assert sum(b.t_ns.size for b in items if isinstance(b, Block)) == 39
    assert ["1 row whose time channel" in x.reason for x in items if not isinstance(x, Block)] == [True]


@pytest.mark.parametrize(("week", "of_week"), [("week", "seconds"), ("Kalenderwoche", "tow"), ("week", "tow_force")])
def test_other_weeks_are_signals(tmp_path: Path, week: str, of_week: str) -> None:
    path = written(tmp_path / "a.tdms", {week: np.full(40, 11.0), of_week: np.arange(40.0), "T": np.arange(40.0)})
    assert {s.name for s in described(Reader(), path, Source()).signals} >= {f"Log/{week}", "Log/T"}


def test_weeks_beside_waveforms_are_signals(tmp_path: Path) -> None:
    start = {"wf_start_time": np.datetime64("2026-03-12T07:00:00"), "wf_increment": 1.0}
    weeks = {"gps_week": np.floor(COUNTS / 604_800), "tow": COUNTS % 604_800}
    path = written(tmp_path / "a.tdms", {**weeks, "T": np.arange(40.0)}, **start)
    assert len(described(Reader(), path, Source()).signals) == 3


@pytest.mark.parametrize(
    ("day", "time", "names"),
    [
        ("%d.%m.%Y", "%H:%M:%S", ("Date", "Time")),
        ("%Y-%m-%d", "%H:%M:%S.000", ("Datum", "Uhrzeit")),
        ("%Y/%m/%d", "%H:%M", ("Tag", "Zeit")),
    ],
)
def test_dates_and_times_of_day_in_two_channels_are_the_time(
    tmp_path: Path, day: str, time: str, names: tuple[str, str]
) -> None:
    texts = {names[0]: stamps(day), names[1]: stamps(time)}
    path = written(tmp_path / "a.tdms", {**texts, "T": np.arange(30.0)})
    source = Source(timezone="Europe/Berlin", options={"block_rows": 7})
    assert times(path, source) == [T0 + k * 60 * 10**9 for k in range(30)]
    recording = described(Reader(), path, source)
    assert recording.clock == "absolute"
    assert [s.name for s in recording.signals] == ["Log/T"]
    assert any("no time zone" in n for n in described(Reader(), path, Source()).notes)
    declared = Source(timezone="Europe/Berlin", table={"time": {"column": list(names)}})
    assert times(path, declared) == times(path, source)


def test_dates_whose_day_and_month_are_open_are_asked_beside_times_too(tmp_path: Path) -> None:
    texts = {"Date": ["03/04/2026"] * 30, "Time": stamps("%H:%M:%S")}
    path = written(tmp_path / "a.tdms", {**texts, "T": np.arange(30.0)})
    with pytest.raises(QuestionError) as asked:
        times(path, Source())
    assert "dmy or mdy?" in asked.value.ask
    april = times(path, Source(table={"time": {"format": "dmy"}}))
    assert april[0] == np.datetime64("2026-04-03T08:00:00", "ns").astype(np.int64)


@pytest.mark.parametrize(
    "texts",
    [
        {"Calibrated": ["2025-11-02"] * 30, "Shift begins": stamps("%H:%M:%S")},  # no name says time
        {"Date": stamps("%Y-%m-%d"), "Operator": ["Novak"] * 30},
        {"Date": ["a"] * 30, "Time": stamps("%H:%M:%S")},
    ],
)
def test_other_pairs_of_texts_are_no_time(tmp_path: Path, texts: dict[str, list[str]]) -> None:
    path = written(tmp_path / "a.tdms", {**texts, "T": np.arange(30.0)})
    assert {"Log/T", *(f"Log/{n}" for n in texts if n not in ("Date", "Time"))} <= {
        s.name for s in described(Reader(), path, Source()).signals
    }
    assert len(times(path, Source())) == 30


def test_a_date_and_a_time_beside_a_whole_timestamp_or_a_waveform_are_signals(tmp_path: Path) -> None:
    texts = {"Date": stamps("%Y-%m-%d"), "Time": stamps("%H:%M:%S")}
    both = written(tmp_path / "a.tdms", {"Timestamp": stamps("%Y-%m-%d %H:%M:%S"), **texts, "T": np.arange(30.0)})
    assert {s.name for s in described(Reader(), both, Source()).signals} >= {"Log/Time", "Log/T"}
    start = {"wf_start_time": np.datetime64("2026-03-12T07:00:00"), "wf_increment": 1.0}
    path = written(tmp_path / "b.tdms", {**texts, "T": np.arange(30.0)}, **start)
    assert T0 in times(path, Source())


OVER_MIDNIGHT = [datetime(2026, 3, 2, 23, 58) + timedelta(seconds=10 * k) for k in range(30)]
ITS_DATE = ["02.03.2026"] * 30  # of the day on which the file began
LATE = [f"{t:%H:%M:%S}" for t in OVER_MIDNIGHT]


@pytest.mark.parametrize(
    ("days", "clocks"),
    [
        (ITS_DATE, LATE),
        ([f"{t:%d.%m.%Y}" for t in OVER_MIDNIGHT], LATE),
        (["03/02/2026"] * 30, [f"{t:%I:%M:%S %p}" for t in OVER_MIDNIGHT]),
        ([*ITS_DATE[:13], *[f"{t:%d.%m.%Y}" for t in OVER_MIDNIGHT[13:]]], [*LATE[:12], "24:00:00", *LATE[13:]]),
        (ITS_DATE, [*LATE[:12], "23:59:60", *LATE[13:]]),
        ([*ITS_DATE[:5], "", *ITS_DATE[6:]], [*LATE[:5], "", *LATE[6:]]),
    ],
    ids=["stands still", "changes", "am and pm", "24:00:00", "second 60", "an empty row"],
)
def test_two_channels_are_read_as_the_same_two_columns_of_a_text(
    tmp_path: Path, days: list[str], clocks: list[str]
) -> None:
    path = written(tmp_path / "a.tdms", {"Date": days, "Time": clocks, "T": np.arange(30.0)})
    rows = (";".join(row) for row in zip(days, clocks, map(str, range(30)), strict=True))
    (tmp_path / "a.csv").write_text("\n".join(["Date;Time;T", *rows, ""]))
    asked = {"timezone": "UTC", **({"table": {"time": {"format": "mdy"}}} if "/" in days[0] else {})}
    table, source = reader("table"), Source(**asked)
    recording = described(table, tmp_path / "a.csv", source)
    blocks = guarded(table, tmp_path / "a.csv", source, recording)
    of_text = [int(t) for b in blocks if isinstance(b, Block) for t in b.t_ns]
    assert times(path, source) == of_text
    began = int(np.datetime64(OVER_MIDNIGHT[0], "ns").astype(np.int64))
    assert of_text == [began + 10**10 * k for k in range(30) if days[k]]
    still = [n for n in described(Reader(), path, source).notes if "midnights are counted" in n]
    assert still == [n for n in recording.notes if "midnights are counted" in n]
    assert bool(still) is (len(set(days)) == 1)


def test_times_of_day_with_their_offset_beside_dates_are_of_it(tmp_path: Path) -> None:
    texts = {"Date": stamps("%Y-%m-%d"), "Time": stamps("%H:%M:%S+01:00")}
    path = written(tmp_path / "a.tdms", {**texts, "T": np.arange(30.0)})
    assert times(path, Source()) == [T0 + k * 60 * 10**9 for k in range(30)]
