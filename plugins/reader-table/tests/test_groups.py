"""Columns with times of their own: found where header and values say so, asked or kept as signals where they don't."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

S = 1_000_000_000


def read(tmp_path: Path, text: str, **table: Any) -> Data:
    """By what is declared; without it, times that name no unit are seconds."""
    path = tmp_path / "x.csv"
    path.write_text(text, encoding="utf-8")
    return load(Reader(), path, Source(timezone="UTC", table=table or {"time": {"unit": "s"}}))


def rows(*columns: list[Any], delimiter: str = ";") -> str:
    """Columns of different lengths side by side, empty cells below the shorter."""
    n = max(map(len, columns))
    return "".join(delimiter.join(str(c[i]) if i < len(c) else "" for c in columns) + "\n" for i in range(n))


A, B = [i * 0.5 for i in range(12)], [i * 0.75 for i in range(8)]
VA, VB = [20 + i / 4 for i in range(12)], [100 - i for i in range(8)]


def held(data: Data, stream: str, name: str, t: list[float], values: list[Any]) -> None:
    assert next(s.stream for s in data.recording.signals if s.name == name) == stream
    np.testing.assert_array_equal(data.t_ns[stream], (np.array(t) * S).astype(np.int64))
    np.testing.assert_array_equal(data.values[stream, name], values)


@pytest.mark.parametrize(
    ("header", "streams", "names"),
    [
        ("t1;T1;t2;T2;T3", ("t1", "t2"), ("T1", "T2")),
        ("Time;CH1;Time;CH2;n", ("Time", "Time#2"), ("CH1", "CH2")),
        ("Time.0 [s];CH1;Time.1 [s];CH2;n", ("Time.0 [s]", "Time.1 [s]"), ("CH1", "CH2")),
        ("Time [s];a;Time [s];b;c", ("Time [s]", "Time [s]#2"), ("a", "b")),
        ("CH1 time;CH1;CH2 time;CH2;n", ("CH1 time", "CH2 time"), ("CH1", "CH2")),
        ("Zeit 1 [s];a;Zeit 2 [s];b;c", ("Zeit 1 [s]", "Zeit 2 [s]"), ("a", "b")),
        (
            "Zeit  1 - Standard [s];a;Zeit  2 - Fast [s];b;c",
            ("Zeit  1 - Standard [s]", "Zeit  2 - Fast [s]"),
            ("a", "b"),
        ),
        ("x [s];a;x [s];b;c", ("x [s]", "x [s]#2"), ("a", "b")),
        ("x1 [s];a;x2 [s];b;c", ("x1 [s]", "x2 [s]"), ("a", "b")),
        ("x;a;x;b;c\ns;V;s;V;V", ("x", "x#2"), ("a", "b")),
        ("CH1;;CH2;;\nTime;Value;Time;Value;n", ("CH1/Time", "CH2/Time"), ("CH1/Value", "CH2/Value")),
    ],
)
def test_each_group_is_a_stream_of_its_own_length(
    tmp_path: Path, header: str, streams: tuple[str, str], names: tuple[str, str]
) -> None:
    data = read(tmp_path, header + "\n" + rows(A, VA, B, VB, VB))
    held(data, streams[0], names[0], A, VA)
    held(data, streams[1], names[1], B, VB)
    assert not data.losses
    assert data.recording.notes[0].startswith("2 time columns, each with the columns behind it")


def test_a_time_that_another_one_repeats_in_its_own_unit_is_of_its_columns(tmp_path: Path) -> None:
    data = read(tmp_path, "x [s];a;x [min];b\n" + rows(A, VA, [t / 60 for t in B], VB), time={})
    held(data, "x [s]", "a", A, VA)
    held(data, "x [min]", "b", B, VB)


@pytest.mark.parametrize("header", ["x [s];a;x [um];b", "x [s];a;y [s];b"])
def test_a_position_and_a_span_are_no_times_of_other_columns(tmp_path: Path, header: str) -> None:
    assert len(read(tmp_path, header + "\n" + rows(A, A, A, A), time={"unit": "s"}).t_ns) == 1


def test_times_behind_their_columns_are_no_times_of_others(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no time column found"):
        read(tmp_path, "a;x [s];b;x [s]\n" + rows(A, A, A, A), time={"unit": "s"})


def test_groups_of_dates_have_lengths_of_their_own(tmp_path: Path) -> None:
    path = tmp_path / "x.csv"
    dates = [f"2026-03-01 08:00:{i:02}" for i in range(12)]
    path.write_text("Date,CH1,Date,CH2,mode\n" + rows(dates, VA, dates[:8], VB, ["on"] * 8, delimiter=","))
    data = load(Reader(), path, Source(timezone="Europe/Prague"))
    assert [t.size for t in data.t_ns.values()] == [12, 8]
    assert not data.losses


@pytest.mark.parametrize(
    ("header", "names"),
    [
        ("Timestamp,T_front (DEG F),Timestamp,SPEED (RPM)", ("T_front (DEG F)", "SPEED (RPM)")),
        ("T_front,,SPEED,\nTimestamp,Value,Timestamp,Value", ("T_front/Value", "SPEED/Value")),
    ],
)
@pytest.mark.parametrize(("first", "second"), [(2000, 40), (40, 2000)])
def test_dates_of_a_group_that_ended_long_before_the_other_are_still_dates(
    tmp_path: Path, header: str, names: tuple[str, str], first: int, second: int
) -> None:
    dates = [f"04/20/2026 {8 + i // 360:02}:{i // 6 % 60:02}:{i % 6 * 10:02}" for i in range(2000)]
    values = [75 + i / 1000 for i in range(2000)]
    path = tmp_path / "x.csv"
    body = rows(dates[:first], values[:first], dates[:second], values[:second], delimiter=",")
    path.write_text(f"{header}\n{body}")
    data = load(Reader(), path, Source(timezone="America/Chicago"))
    assert [t.size for t in data.t_ns.values()] == [first, second]
    assert tuple(s.name for s in data.recording.signals) == names
    assert all(s.dtype == "float64" for s in data.recording.signals)
    assert not data.losses


def test_a_unit_in_the_head_over_a_time_and_its_values_is_that_of_the_values(tmp_path: Path) -> None:
    header = "MC07:T_FRONT (DEG F),,MC07:SPEED (RPM),\nTimestamp,Value,Timestamp,Value\n"
    dates = [f"4/20/2026 8:{i:02}:00 AM" for i in range(40)]
    path = tmp_path / "x.csv"
    path.write_text(header + rows(dates, [75.5] * 40, dates[:30], [3000.5] * 30, delimiter=","))
    signals = load(Reader(), path, Source(timezone="UTC")).recording.signals
    assert {s.name: s.unit for s in signals} == {
        "MC07:T_FRONT (DEG F)/Value": "DEG F",
        "MC07:SPEED (RPM)/Value": "RPM",
    }


def test_dates_and_times_of_day_a_group(tmp_path: Path) -> None:
    clock = [f"08:00:{i:02}" for i in range(8)]
    text = "Datum;Uhrzeit;T1;Datum;Uhrzeit;T2\n" + rows(["1.3.2026"] * 8, clock, VB, ["2.3.2026"] * 8, clock, VB)
    data = read(tmp_path, text, delimiter=";")
    starts = [np.datetime64(int(t[0]), "ns").astype("datetime64[D]").item().day for t in data.t_ns.values()]
    assert starts == [1, 2]


def test_a_value_without_its_time_is_a_loss_and_an_ended_group_is_none(tmp_path: Path) -> None:
    text = rows(A, VA, B, VB).splitlines(keepends=True)
    text[9] = text[9].replace(";;", ";;99.5")
    data = read(tmp_path, "t1;T1;t2;T2\n" + "".join(text))
    assert data.losses[0].reason == "expected a time as a number [s], got ''"
    assert 99.5 not in data.values["t2", "T2"]


def test_lines_that_end_with_their_group_are_whole_and_others_short(tmp_path: Path) -> None:
    text = "t1;T1;t2;T2\n" + rows([*A, 6, 7], [*VA, 1, 2], A[:-1], VA[:-1]).replace(";;\n", "\n")
    assert not read(tmp_path, text).losses
    lines = text.splitlines(keepends=True)
    lines[4] = ";".join(lines[4].split(";")[:2]) + "\n"
    assert "fewer cells" in read(tmp_path, "".join(lines)).losses[0].reason


@pytest.mark.parametrize(
    "header",
    [
        "time [s];t1;t2;t3",
        "time [s];t1 [degC];T1;t2 [degC]",
        "Time;Elapsed;CH1;CH2",
        "time [s];t1;CH1;t2",
        "Time;CH1;Operating time;CH2",
    ],
)
def test_temperatures_and_second_clocks_stay_signals(tmp_path: Path, header: str) -> None:
    data = read(tmp_path, header + "\n" + rows(A, A, A, A))
    assert list(data.t_ns) == ["table"]
    assert len(data.recording.signals) == 3


def test_two_words_for_time_that_run_apart_are_asked(tmp_path: Path) -> None:
    text = "time [s];CH1;Zeit [s];CH2\n" + rows(A, VA, [i * 2 for i in range(12)], VA)
    with pytest.raises(FormatError, match="run apart") as error:
        read(tmp_path, text)
    assert "time: [{column: 1" in str(error.value)
    assert list(read(tmp_path, text, time={"column": 1}).t_ns) == ["table"]
    data = read(tmp_path, text, time=[{"column": 1}, {"column": "Zeit"}])
    held(data, "Zeit [s]", "CH2", [i * 2.0 for i in range(12)], VA)


def test_times_behind_their_columns_are_asked_and_can_be_declared(tmp_path: Path) -> None:
    text = "T1;time;T2;time\n" + rows(VB, B, VA, A)
    with pytest.raises(FormatError, match="behind its columns or before"):
        read(tmp_path, text)
    data = read(
        tmp_path,
        text,
        time=[{"column": 2, "signals": ["T1"], "unit": "min"}, {"column": 4, "signals": [3], "unit": "s"}],
    )
    held(data, "time", "T1", [b * 60 for b in B], VB)
    held(data, "time#2", "T2", A, VA)


def test_a_column_declared_twice_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="declared twice"):
        read(
            tmp_path,
            "t1;T1;t2;T2\n" + rows(A, VA, B, VB),
            time=[{"column": 1, "signals": [2], "unit": "s"}, {"column": 3, "signals": [2], "unit": "s"}],
        )


def test_dates_beside_seconds_of_their_own_are_asked(tmp_path: Path) -> None:
    dates = [f"2026-03-01 08:00:{i:02}" for i in range(12)]
    with pytest.raises(FormatError, match="some times are dates"):
        read(tmp_path, "Date;CH1;t;CH2\n" + rows(dates, VA, B, VB), time=[{"column": 1}, {"column": 3, "unit": "s"}])


@pytest.mark.parametrize("line", ["9;9;9;9;9;9", "Datum;Temp", "1.3.2026 8:00;x"])
@pytest.mark.parametrize("units", ["", ";°C;rpm;bar\n"])
def test_a_line_below_the_header_that_is_no_header_is_told(tmp_path: Path, line: str, units: str) -> None:
    text = "time;T;n;p\n" + units
    data = read(tmp_path, text + line + "\n" + rows(A, VA, VA, VA))
    assert [s.name for s in data.recording.signals] == ["T", "n", "p"]
    told = (*data.recording.notes, *(loss.reason for loss in data.losses))
    assert any("between header and data is not read" in x or x.startswith("expected 4 cells, got") for x in told)


def test_a_second_time_of_another_pace_is_asked_and_one_that_goes_along_is_a_signal(tmp_path: Path) -> None:
    head = "Slow time [s];T1;Fast time [s];dZ\n"
    with pytest.raises(FormatError, match="two time columns that run apart"):
        read(tmp_path, head + rows([10.0 * a for a in A], VA, A, VA))
    data = read(tmp_path, head + rows(A, VA, [a + 0.001 for a in A], VA))
    assert {n for _, n in data.values} == {"T1", "Fast time [s]", "dZ"}


DATES = [f"2026-03-01 08:{i:02}:00" for i in range(12)]
LATER = [f"2026-03-01 08:{i:02}:07" for i in range(12)]


@pytest.mark.parametrize(
    ("header", "order"),
    [
        ("CH1_VALUE;CH1_TIMESTAMP;CH1_QUALITY;CH2_VALUE;CH2_TIMESTAMP;CH2_QUALITY", "vtqvtq"),
        ("CH1.Time;CH1.Value;CH1.Quality;CH2.Value;CH2.Quality;CH2.Time", "tvqvqt"),
        ("CH1 Date Time;CH2 Date Time;CH1;CH2", "ttvv"),
        ("Timestamp_CH1;Timestamp_CH2;Value_CH1;Value_CH2", "ttvv"),
        ("CH1;;CH2;\nValue;Time;Value;Time", "vtvt"),
    ],
)
def test_a_name_that_they_share_tells_which_time_columns_have(tmp_path: Path, header: str, order: str) -> None:
    columns = {"t": [DATES, LATER], "v": [VA, VA[::-1]], "q": [[192] * 12, [192, 0] * 6]}
    text = header + "\n" + rows(*(columns[kind].pop(0) for kind in order))
    data = read(tmp_path, text, delimiter=";")
    assert "each with the columns that share its name" in data.recording.notes[0]
    values = {s.name: s.stream for s in data.recording.signals if "qual" not in s.name.casefold()}
    assert [int(data.t_ns[stream][0]) // S % 60 for stream in values.values()] == [0, 7]
    for (name, stream), own in zip(values.items(), (VA, VA[::-1]), strict=True):
        np.testing.assert_array_equal(data.values[stream, name], own)
    if "q" in order:
        told = {s.name: s.properties for s in data.recording.signals if "quality_of" in s.properties}
        assert [p["quality_of"] for p in told.values()] == list(values)


def test_a_number_of_a_row_goes_with_the_first_time_and_what_shares_no_name_is_asked(tmp_path: Path) -> None:
    head = "NUMERICID;CH1_VALUE;CH1_TIMESTAMP;CH2_VALUE;CH2_TIMESTAMP"
    body = (range(1, 13), VA, DATES, VA, LATER)
    data = read(tmp_path, head + "\n" + rows(*map(list, body)), delimiter=";")
    assert ("CH1_TIMESTAMP", "NUMERICID") in data.values
    with pytest.raises(FormatError, match="share their name with none") as error:
        read(tmp_path, head + ";pressure\n" + rows(*map(list, body), VA), delimiter=";")
    assert "'pressure'" in str(error.value)


def test_a_tag_that_others_begin_with_takes_none_of_theirs(tmp_path: Path) -> None:
    head = "T_VALUE;T_TIMESTAMP;T_2_VALUE;T_2_TIMESTAMP\n"
    data = read(tmp_path, head + rows(VA, DATES, VA, LATER), delimiter=";")
    assert {(stream, name) for stream, name in data.values} == {
        ("T_TIMESTAMP", "T_VALUE"),
        ("T_2_TIMESTAMP", "T_2_VALUE"),
    }


@pytest.mark.parametrize("second", [DATES, [str(k) for k in range(12)]])
def test_times_of_one_clock_are_one_time_though_names_are_shared_with_some_columns(
    tmp_path: Path, second: list[str]
) -> None:
    head = "PC time;CNC time;CNC load;PC load;T1\n"
    data = read(tmp_path, head + rows(DATES, second, VA, VA, VA), delimiter=";")
    assert len({stream for stream, _ in data.values}) == 1
    assert {"CNC load", "PC load", "T1"} <= {name for _, name in data.values}
