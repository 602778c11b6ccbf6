"""Clocks as labs have them: newest first, without daylight saving, in hours, beside a rising temperature."""

from __future__ import annotations

import io
from datetime import datetime, timedelta
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Source
from thermodata.reader import reader as named
from thermodata.testing.reader import load

from .conftest import Lab

T1 = {"T1": {"signal": "T", "quantity": "temperature", "unit": "degC"}}


def stamps(start: str, step_s: int, n: int) -> list[str]:
    first = datetime.fromisoformat(start)
    return [f"{first + timedelta(seconds=step_s * i):%Y-%m-%d %H:%M:%S}" for i in range(n)]


def rows(times: list[Any], between: str = ";") -> str:
    return "".join(f"{t}{between}{20 + i / 8}\n" for i, t in enumerate(times))


@pytest.mark.parametrize(
    "times",
    [
        stamps("2026-03-02 08:00:00", 10, 200)[::-1],
        list(range(1990, -1, -10)),
        [t[11:] for t in stamps("2026-03-02 23:55:00", 10, 200)][::-1],
    ],
    ids=["dates", "seconds", "times of day over midnight"],
)
def test_a_file_that_stands_newest_first_is_turned_round(lab: Lab, times: list[Any]) -> None:
    lab.write("raw/a.csv", f"{'time' if isinstance(times[0], str) else 'time [s]'};T\n" + rows(times))
    said = lab.ingest(T1)
    assert said.code == 0, said.err
    t_s, values = lab.values("T1")
    np.testing.assert_allclose(t_s - t_s[0], np.arange(200) * 10.0)
    np.testing.assert_array_equal(values, 20 + np.arange(200)[::-1] / 8)
    assert "newest first" in said.out
    assert "newest first" in lab("preview", lab.folder / "raw/a.csv").out
    traced = lab("trace", "odd", "one", "T1", "--at", "0 s", "--verify")
    assert "line 201" in traced.out
    assert traced.code == 0


def test_files_that_stand_newest_first_are_joined_in_order(lab: Lab) -> None:
    all_stamps = stamps("2026-03-02 08:00:00", 10, 200)
    lab.write("raw/a.csv", "time;T\n" + rows(all_stamps[:100][::-1]))
    lab.write("raw/b.csv", "time;T\n" + rows(all_stamps[100:][::-1]))
    assert lab.ingest(T1).code == 0
    t_s, values = lab.values("T1")
    np.testing.assert_allclose(t_s, np.arange(200) * 10.0)
    np.testing.assert_array_equal(values, 20 + np.concatenate([np.arange(100)[::-1], np.arange(100)[::-1]]) / 8)


ZONE = {"timezone": "Europe/Prague"}


@pytest.mark.parametrize(
    ("start", "winter"), [("2026-10-24 22:00:00", "2026-10-24T21:00"), ("2026-03-29 00:00:00", "2026-03-28T23:00")]
)
@pytest.mark.parametrize("step_s", [1, 60, 1800])
def test_a_clock_without_daylight_saving_is_asked_for(lab: Lab, start: str, winter: str, step_s: int) -> None:
    n = 36000 // step_s
    lab.write("raw/a.csv", "time;T\n" + rows(stamps(start, step_s, n)))
    said = lab.ingest(T1, ZONE)
    assert said.code == 3
    assert "keeps one offset" in said.out + said.err
    assert "timezone: Etc/GMT-1" in said.out + said.err
    assert lab.ingest(T1, {"timezone": "Etc/GMT-1"}).code == 0
    t_s, _ = lab.values("T1")
    np.testing.assert_allclose(t_s, np.arange(n) * step_s)
    assert winter in lab("sql", "select min(t) as t from sample", "--csv").out.replace(" ", "T")


@pytest.mark.parametrize("late_s", [0, 300])
@pytest.mark.parametrize(("change", "shift"), [("2026-10-25 03:00:00", -3600), ("2026-03-29 02:00:00", 3600)])
def test_a_clock_that_follows_daylight_saving_at_once_or_late_is_read(
    lab: Lab, change: str, shift: int, late_s: int
) -> None:
    at = datetime.fromisoformat(change) + timedelta(seconds=late_s)
    before = [at - timedelta(seconds=10 * i) for i in range(1500, 0, -1)]
    local = [*before, *(at + timedelta(seconds=shift + 10 * i) for i in range(1500))]
    lab.write("raw/a.csv", "time;T\n" + rows([f"{t:%Y-%m-%d %H:%M:%S}" for t in local]))
    assert lab.ingest(T1, ZONE).code == 0 or late_s
    assert "keeps one offset" not in lab("preview", lab.folder / "raw/a.csv").out
    if not late_s:
        np.testing.assert_allclose(lab.values("T1")[0], np.arange(3000) * 10.0)


HEADS = ["Zeit in h", "Zeit [h]", "Zeit (h)", "t / h", "time_h", "Time, h", "Zeit h", "Time in hours", "t [Std]"]


@pytest.mark.parametrize("by", ["crio", "table"])
@pytest.mark.parametrize(
    ("head", "seconds"),
    [
        *((head, 3600.0) for head in HEADS),
        ("Zeit [min]", 60.0),
        ("Zeit in min", 60.0),
        ("Zeit (ms)", 1e-3),
        ("time_ms", 1e-3),
        ("time [days]", 86400.0),
        ("time [s]", 1.0),
        ("time_s", 1.0),
    ],
)
def test_the_unit_of_a_time_stands_in_its_header(read: Any, head: str, seconds: float, by: str) -> None:
    data = read(f"{head}\tT1\n" + rows([i / 2 for i in range(50)], "\t"), "a.txt", by)
    np.testing.assert_allclose(next(iter(data.t_ns.values())) / 1e9, np.arange(50) / 2 * seconds)


def test_a_column_that_rises_is_not_the_time_where_rows_come_at_a_declared_period(read: Any) -> None:
    text = "T1\tT2\n" + "".join(f"{20 + i / 8}\t{30 + i / 4}\n" for i in range(50))
    data = read(text, "a.txt", "crio", options={"increment": "60 s"})
    np.testing.assert_array_equal(data.t_ns["data"], np.arange(50) * 60_000_000_000)
    np.testing.assert_array_equal(data.values["data", "T1"], 20 + np.arange(50) / 8)


@pytest.mark.parametrize("head", ["T1\tT2\n", "Pos [mm]\tdX\n", ""])
def test_a_first_column_that_rises_without_being_called_a_time_is_asked_for(read: Any, head: str) -> None:
    text = head + "".join(f"{20 * (1 - 0.9**i):.6f}\t{30 + i / 4}\n" for i in range(50))
    with pytest.raises(QuestionError, match="not called a time") as caught:
        read(text, "a.txt", "crio")
    assert "increment" in str(caught.value.hint)
    once = read(text, "a.txt", "crio", options={"time": 1}).t_ns["data"]
    assert once.size == 50
    minutes = read(text, "a.txt", "crio", table={"time": {"column": 1, "unit": "min"}}).t_ns["data"]
    np.testing.assert_allclose(minutes, once * 60, atol=60)
    assert {**caught.value.declare["time"]} == {"column": 1, "unit": "unknown"}


def test_a_time_that_is_not_the_first_column_is_found_by_its_name(read: Any) -> None:
    text = "T1\ttime [min]\n" + "".join(f"{20 + i / 8}\t{i}\n" for i in range(50))
    for by in ("crio", "table"):
        data = read(text, "a.txt", by)
        np.testing.assert_array_equal(next(iter(data.t_ns.values())), np.arange(50) * 60_000_000_000)


def test_rows_without_a_time_are_asked_for_and_sniff_says_so(lab: Lab, read: Any) -> None:
    text = "T1\tT2\n" + "".join(f"{20 + i % 3}\t{30 + i % 5}\n" for i in range(50))
    with pytest.raises(QuestionError, match="no time column") as caught:
        read(text, "a.txt", "crio")
    assert caught.value.declare == {"time": {"period": "unknown"}}
    assert read(text, "a.txt", "crio", options={"increment": "2 s"}).t_ns["data"][-1] == 98_000_000_000
    for by in ("crio", "table"):
        data = read(text, "a.txt", by, table={"time": {"period": 2.0}})
        np.testing.assert_array_equal(next(iter(data.t_ns.values())), np.arange(50) * 2_000_000_000)
    said = lab("sniff", lab.write("raw/a.txt", text))
    assert "can read it where a source declares it" not in said.out + said.err
    assert "leaves a question: no time column" in said.out


@pytest.mark.parametrize("by", ["crio", "table"])
@pytest.mark.parametrize("time", [{"column": 1, "unit": "unknown"}, {"period": "unknown"}])
def test_an_open_answer_is_no_time(read: Any, time: dict[str, Any], by: str) -> None:
    text = "T1\tT2\n" + "".join(f"{20 * (1 - 0.9**i):.6f}\t{30 + i / 4}\n" for i in range(50))
    with pytest.raises(FormatError, match="is not answered yet"):
        read(text, "a.txt", by, table={"time": time})


def parquet(**columns: Any) -> bytes:
    buffer = io.BytesIO()
    pq.write_table(pa.table(columns), buffer)
    return buffer.getvalue()


N = np.arange(50)
T0 = np.datetime64("2026-03-02T08:00:00", "ns")


def test_of_two_columns_of_times_the_one_that_is_called_time_counts(read: Any) -> None:
    made, time = (T0 + N * np.timedelta64(s, "s") for s in (1, 10))
    data = read(parquet(created=made, time=time, T1=N / 8), "a.parquet")
    np.testing.assert_array_equal(data.t_ns["table"], time.astype("datetime64[ns]").astype(np.int64))
    numbers = read(parquet(**{"t": 20 + N / 8, "time [s]": N * 10.0, "T1": N / 8}), "b.parquet")
    np.testing.assert_array_equal(numbers.t_ns["table"], N * 10_000_000_000)
    with pytest.raises(FormatError, match="several columns of times") as caught:
        read(parquet(start=made, end=time, T1=N / 8), "c.parquet")
    assert "declare table: {time: {column: start}}" in str(caught.value.hint)


def mat(**variables: Any) -> bytes:
    buffer = io.BytesIO()
    scipy.io.savemat(buffer, variables)
    return buffer.getvalue()


@pytest.mark.parametrize("said", [{"time_unit": "min"}, {"units": {"time": "min"}}, {"unit_time": "min"}])
def test_the_unit_of_a_time_may_stand_beside_it_in_a_mat_file(read: Any, said: dict[str, Any]) -> None:
    data = read(mat(time=N * 1.0, T1=N / 8, **said), "a.mat")
    np.testing.assert_array_equal(next(iter(data.t_ns.values())), N * 60_000_000_000)


@pytest.mark.parametrize("by", ["table", "cnc"])
def test_times_of_day_go_over_midnight(read: Any, by: str) -> None:
    data = read("time;T\n" + rows([t[11:] for t in stamps("2026-03-02 23:55:00", 10, 200)]), by=by)
    np.testing.assert_array_equal(next(iter(data.t_ns.values())), np.arange(200) * 10_000_000_000)


ODD = (
    "%d-%b-%Y %H:%M:%S",  # MATLAB
    "%d. %B %Y %H:%M:%S",
    "%b %d, %Y %I:%M:%S %p",
    "%a %b %d %H:%M:%S %Y",  # ctime
    "%a %d.%m.%Y %H:%M:%S",
    "%Y%m%dT%H%M%S",
    "%Y%m%d%H%M%S",
    "%Y_%m_%d_%H_%M_%S",
    "%d.%m.%Y %H.%M.%S",
)


@pytest.mark.parametrize("between", [";", ","])
@pytest.mark.parametrize("form", [f for f in ODD if "," not in f])
def test_stamps_in_an_odd_spelling_are_drafted_with_their_format(lab: Lab, form: str, between: str) -> None:
    first = datetime(2026, 3, 30, 23, 50)
    stamped = [f"{first + timedelta(minutes=10 * i):{form}}" for i in range(60)]
    lab.write("raw/a.csv", between.join(("time", "T_spindle [degC]")) + "\n" + rows(stamped, between))
    assert lab("init", lab.folder).code == 0
    drafted = (lab.folder / "campaign.yaml").read_text(encoding="utf-8")
    assert form in drafted
    assert f"is '{stamped[0]}' {form}?" in drafted
    assert lab("ingest", lab.folder / "campaign.yaml").code == 0
    t_s, _ = lab.values("T_spindle", "a")
    np.testing.assert_allclose(t_s, np.arange(60) * 600.0)
    assert "2026-03-30 23:50:00" in lab("sql", "select min(t) from sample").out


@pytest.mark.parametrize(
    "form", ["%Y-%m-%d %H-%M-%S CEST", "%d. Monat %Y %H:%M:%S", "%Y-%j %H:%M:%S", "%d/%m/%y %H-%M-%S"]
)
def test_a_format_that_is_not_sure_is_asked_for(lab: Lab, form: str) -> None:
    """A zone by its letters, a word that is no month, a day of the year, day and month either way round."""
    first = datetime(2026, 3, 2, 8)
    lab.write("raw/a.csv", "time;T\n" + rows([f"{first + timedelta(seconds=10 * i):{form}}" for i in range(60)]))
    assert lab("init", lab.folder).code == 0
    assert "format: unknown" in (lab.folder / "campaign.yaml").read_text(encoding="utf-8")
    said = lab("ingest", lab.folder / "campaign.yaml")
    assert said.code == 3
    assert "'time.format' of the table is not answered yet" in said.out


@pytest.mark.parametrize("form", ["%d.%m. %H:%M:%S", "%Y %H:%M:%S", "%d %b %H:%M"])
def test_a_declared_format_without_a_year_or_a_month_is_refused(read: Any, form: str) -> None:
    with pytest.raises(FormatError, match="cannot be used"):
        read("time;T\n" + rows(["02.03. 08:00:00"] * 20), by="table", table={"time": {"column": 1, "format": form}})


def test_a_date_that_is_one_number_dates_the_times_of_day_beside_it(lab: Lab) -> None:
    first = datetime(2026, 3, 2, 8)
    moments = [first + timedelta(hours=5 * i) for i in range(40)]  # whole days pass without a row at midnight
    lab.write("raw/a.csv", "date;time;T_spindle [degC]\n" + rows([f"{m:%Y%m%d;%H:%M:%S}" for m in moments]))
    assert lab("init", lab.folder).code == 0
    assert lab("ingest", lab.folder / "campaign.yaml").code == 0
    np.testing.assert_allclose(lab.values("T_spindle", "a")[0], np.arange(40) * 5 * 3600.0)
    assert "2026-03-02 08:00:00" in lab("sql", "select min(t) from sample").out


@pytest.mark.parametrize("start_h", [0, 30, 99])
def test_durations_go_on_behind_a_day(read: Any, start_h: int) -> None:
    seconds = [start_h * 3600 + 600 * i for i in range(300)]
    data = read("time,T\n" + rows([f"{s // 3600:02d}:{s // 60 % 60:02d}:{s % 60:02d}" for s in seconds], ","))
    assert not data.losses
    (t_ns,) = data.t_ns.values()
    np.testing.assert_array_equal(t_ns, np.arange(300) * 600 * 10**9)


def test_a_damaged_time_of_day_is_no_duration(read: Any) -> None:
    times = [s[11:] for s in stamps("2026-03-02 08:00:00", 10, 200)]
    times[50] = "28" + times[50][2:]
    data = read("time,T\n" + rows(times, ","))
    assert [loss.where for loss in data.losses] == ["a.csv line 52"]
    (t_ns,) = data.t_ns.values()
    np.testing.assert_array_equal(t_ns, np.delete(np.arange(200), 50) * 10 * 10**9)


def test_days_since_1900_under_a_word_for_time_are_asked_for(lab: Lab) -> None:
    lab.write("raw/a.csv", "time,T_spindle [degC]\n" + rows([f"{46083.25 + i / 1440:.8f}" for i in range(60)], ","))
    assert lab("init", lab.folder).code == 0
    drafted = lab.folder / "campaign.yaml"
    text = drafted.read_text(encoding="utf-8")
    assert "excel (days since 1900: 2026-03-02) or s?" in text
    assert lab("ingest", drafted).code == 3
    drafted.write_text(text.replace("unit: unknown", "unit: excel"), encoding="utf-8")
    assert lab("ingest", drafted).code == 0
    np.testing.assert_allclose(lab.values("T_spindle", "a")[0], np.arange(60) * 60.0, atol=1e-3)


def test_a_declared_format_finds_its_column_by_the_name(read: Any) -> None:
    first = datetime(2026, 3, 2, 8)
    odd = [f"{first + timedelta(seconds=10 * i):%d-%b-%Y %H:%M:%S}" for i in range(60)]
    lines = "".join(f"{i};{t};{20 + i / 8}\n" for i, t in enumerate(odd))
    data = read("no;time;T\n" + lines, by="table", table={"time": {"format": "%d-%b-%Y %H:%M:%S"}})
    (t_ns,) = data.t_ns.values()
    np.testing.assert_array_equal(t_ns - t_ns[0], np.arange(60) * 10 * 10**9)


def test_a_column_that_is_called_by_a_unit_of_time_is_asked_for_in_that_unit(lab: Lab) -> None:
    lab.write("raw/a.csv", "hours;T;X\n" + "".join(f"{i / 360:.5f};{20 + i / 8};{i}.5\n" for i in range(60)))
    assert lab("init", lab.folder).code == 0
    assert "is 'hours' the time? then time: {column: 1, unit: hours}" in (lab.folder / "campaign.yaml").read_text()


def test_parquet_without_a_time_is_asked_for_its_period_and_read_by_it(lab: Lab) -> None:
    lab.write("raw/a.parquet", parquet(A=np.sin(N), T_spindle=20 + N / 8))
    assert lab("init", lab.folder).code == 0
    drafted = lab.folder / "campaign.yaml"
    text = drafted.read_text(encoding="utf-8")
    assert "period: unknown" in text
    assert lab("ingest", drafted).code == 3
    drafted.write_text(text.replace("period: unknown", "period: 10 s"), encoding="utf-8")
    assert lab("ingest", drafted).code == 0
    t_s, values = lab.values("T_spindle", "a")
    np.testing.assert_allclose(t_s, N * 10.0)
    np.testing.assert_array_equal(values, 20 + N / 8)
    traced = lab("trace", "odd" if "id: odd" in text else "lab", "a", "T_spindle", "--at", "30 s", "--verify")
    assert traced.code == 0, traced.err
    assert "row 4 of the file" in traced.out


def test_times_in_an_odd_spelling_are_asked_for_in_parquet_too(lab: Lab) -> None:
    first = datetime(2026, 3, 2, 8)
    odd = [f"{first + timedelta(seconds=10 * int(i)):%d-%b-%Y %H:%M:%S}" for i in N]
    lab.write("raw/a.parquet", parquet(time=odd, T_spindle=20 + N / 8))
    assert lab("init", lab.folder).code == 0
    assert lab("ingest", lab.folder / "campaign.yaml").code == 0
    np.testing.assert_allclose(lab.values("T_spindle", "a")[0], N * 10.0)


def test_a_year_of_two_digits_at_either_end_is_asked_for(lab: Lab) -> None:
    """What is 26/03/14 to a recorder of East Asia would be 12 years older with its year at the end."""
    this = np.datetime64("now").item().year
    short, old = f"{this % 100:02d}", f"{(this - 12) % 100:02d}"
    rows = "".join(f"{short}/03/{old},08:00:{i:02d},20.5\n" for i in range(40))
    lab.write("raw/a.csv", f"Date,Time,T1 [degC]\n{rows}")
    said = lab.ingest({"T1": {"signal": "T1", "quantity": "temperature"}})
    assert "two digits" in said.out + said.err
    for declared, year in (("%y/%m/%d", this), ("dmy", this - 12)):
        found = load(named("table"), lab.folder / "raw/a.csv", Source(table={"time": {"format": declared}}))
        assert np.datetime64(int(found.t_ns["table"][0]), "ns").astype("datetime64[Y]").item().year == year


def test_a_year_of_two_digits_behind_a_day_is_read_as_ever(lab: Lab) -> None:
    this = np.datetime64("now").item().year
    rows = "".join(f"01/03/{this % 100:02d},08:00:{i:02d},20.5\n" for i in range(40))
    path = lab.write("raw/a.csv", f"Date,Time,T1 [degC]\n{rows}")
    found = load(named("table"), path, Source(table={"time": {"format": "dmy"}}))
    assert np.datetime64(int(found.t_ns["table"][0]), "ns").astype("datetime64[Y]").item().year == this
    path = lab.write("raw/b.csv", f"Date,Time,T1 [degC]\n{rows.replace('01/03/', '31/03/')}")
    assert load(named("table"), path, Source()).recording.clock == "absolute"
