"""Files whose local times all lie in the hour that repeats in autumn: another source, a file that goes on, or the
test's start tells in which pass; where nothing does, it is said and asked."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from thermodata.report.words.causes import notes_in_words
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.ingest.summary import IngestSummary

pytestmark = pytest.mark.usefixtures("installed_readers")

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {{id: m1}}
sources:
  nc: {{reader: {reader}, files: "nc_{{test}}*.{ext}", timezone: Europe/Berlin{more}}}
channels:
  T_m: {{source: nc, signal: T_m, quantity: temperature, unit: degC}}
tests:
  - {{id: a, kind: spindle, role: calibration{start}}}
"""
BESIDE = (
    '\n  daq: {reader: table, files: "daq_{test}.csv"}\nchannels:',
    "\n  T_f: {source: daq, signal: T_f, quantity: temperature, unit: degC}\ntests:",
)
LOCAL = datetime(2026, 10, 25, 2, 5)


def written(path: Path, first: datetime, minutes: int, name: str, zone: str = "") -> None:
    rows = [(first + timedelta(minutes=i), 20 + i / 10) for i in range(minutes)]
    if path.suffix == ".parquet":
        pq.write_table(pa.table({"time": pa.array([t for t, _ in rows]), name: [v for _, v in rows]}), path)
    else:
        path.write_text(f"time;{name}\n" + "".join(f"{t:%Y-%m-%d %H:%M:%S}{zone};{v}\n" for t, v in rows))


def made(
    folder: Path, *, reader: str = "table", ext: str = "csv", more: str = "", start: str = "", beside: str = ""
) -> IngestSummary:
    """more, beside: what the sources nc and daq declare besides."""
    text = CAMPAIGN.format(reader=reader, ext=ext, more=more, start=start)
    if any(folder.glob("daq_*")):
        daq = BESIDE[0].replace('.csv"', f'.csv"{beside}')
        text = text.replace("\nchannels:", daq).replace("\ntests:", BESIDE[1])
    (folder / "campaign.yaml").write_text(text)
    return ingest(Store(folder / "s.store", create=True), folder / "campaign.yaml")


def first_of(folder: Path, channel: str) -> datetime:
    with Store(folder / "s.store").reader() as con:
        row = con.execute(f"select epoch_ns(min(t)) from sample where channel = '{channel}'").fetchone()
    assert row is not None
    return datetime(1970, 1, 1) + timedelta(seconds=row[0] / 1e9)


def asked(summary: IngestSummary) -> list[str]:
    return [str(x["reason"]) for x in summary.losses if "nothing says in which pass" in str(x["reason"])]


@pytest.mark.parametrize(("reader", "ext"), [("cnc", "csv"), ("table", "csv"), ("table", "parquet")])
@pytest.mark.parametrize("hour", [0, 1])
def test_a_source_in_utc_tells_the_pass(tmp_path: Path, reader: str, ext: str, hour: int) -> None:
    written(tmp_path / f"nc_a.{ext}", LOCAL, 45, "T_m")
    written(tmp_path / "daq_a.csv", datetime(2026, 10, 25, hour, 5), 45, "T_f", "Z")
    summary = made(tmp_path, reader=reader, ext=ext)
    assert first_of(tmp_path, "T_m") == datetime(2026, 10, 25, hour, 5)
    assert not summary.losses
    assert any(f"{'second' if hour else 'first'} pass" in n and "as 'daq' says" in n for n in summary.notes)


def test_a_longer_source_tells_it_where_both_end_together(tmp_path: Path) -> None:
    written(tmp_path / "nc_a.csv", LOCAL, 45, "T_m")
    written(tmp_path / "daq_a.csv", datetime(2026, 10, 24, 22, 0), 230, "T_f", "Z")  # to 01:49
    assert not made(tmp_path).losses
    assert first_of(tmp_path, "T_m") == datetime(2026, 10, 25, 1, 5)


@pytest.mark.parametrize(("zone", "hour"), [("+02:00", 0), ("+01:00", 1)])
@pytest.mark.parametrize("beside", [False, True])
def test_where_nothing_tells_it_it_is_asked_and_the_start_answers(
    tmp_path: Path, zone: str, hour: int, beside: bool
) -> None:
    """beside: another log begins later in that hour; the start is of both."""
    written(tmp_path / "nc_a.csv", LOCAL, 45, "T_m")
    if beside:
        written(tmp_path / "daq_a.csv", LOCAL + timedelta(minutes=10), 40, "T_f")
    more = ", timezone: Europe/Berlin" if beside else ""
    said = asked(made(tmp_path, beside=more))
    assert len(said) == 1 + beside
    assert all(f"start: 2026-10-25T02:05:00{zone}" in s and "offset" not in s for s in said)
    assert not made(tmp_path, start=f', start: "2026-10-25T02:05:00{zone}"', beside=more).losses
    assert first_of(tmp_path, "T_m") == datetime(2026, 10, 25, hour, 5)
    assert not beside or first_of(tmp_path, "T_f") == datetime(2026, 10, 25, hour, 15)


@pytest.mark.parametrize(("offset", "hour"), [("0 s", 0), ("3600 s", 1)])
def test_a_start_that_is_of_another_log_tells_no_pass_and_is_not_advised(
    tmp_path: Path, offset: str, hour: int
) -> None:
    """It would be refused beside the dates of the log that begins the test."""
    written(tmp_path / "nc_a.csv", LOCAL, 45, "T_m")
    written(tmp_path / "daq_a.csv", datetime(2026, 10, 24, 22, 0), 400, "T_f", "Z")  # before, in and behind both
    for start in ("", ', start: "2026-10-25T00:00:00+02:00"'):
        (said,) = (str(x["reason"]) for x in made(tmp_path, start=start).losses)
        assert "in a test of their own" in said
        assert f"{{offset: {offset}}}" in said
    assert not made(tmp_path, more=f", clock: {{offset: {offset}}}").losses
    assert first_of(tmp_path, "T_m") == datetime(2026, 10, 25, hour, 5)


@pytest.mark.parametrize(("zone", "hour"), [("+02:00", 0), ("+01:00", 1)])
def test_a_part_that_does_not_begin_its_test_is_told_by_the_start_of_one_of_its_own(
    tmp_path: Path, zone: str, hour: int
) -> None:
    own = tmp_path / "own"
    own.mkdir()
    for first, second in ((tmp_path / "nc_a1.csv", tmp_path / "nc_a2.csv"), (own / "nc_a.csv", own / "nc_b.csv")):
        written(first, datetime(2026, 10, 25, 0, 0), 60, "T_m")
        written(second, datetime(2026, 10, 25, 2, 20), 30, "T_m")
    (said,) = asked(made(tmp_path))
    assert "(nc_a2.csv)" in said
    assert f"start: 2026-10-25T02:20:00{zone}" in said
    assert "in a test of their own" in said
    another = f'}}\n  - {{id: b, kind: spindle, role: calibration, start: "2026-10-25T02:20:00{zone}"'
    assert not made(own, start=another).losses
    with Store(own / "s.store").reader() as con:
        row = con.execute("select epoch_ns(min(t)) from sample where test = 'b'").fetchone()
    assert row is not None
    assert row[0] == (datetime(2026, 10, 25, hour, 20) - datetime(1970, 1, 1)) // timedelta(microseconds=1) * 1000


@pytest.mark.parametrize("hour", [0, 1])
def test_a_file_that_goes_on_tells_it(tmp_path: Path, hour: int) -> None:
    written(tmp_path / "nc_a_1.csv", LOCAL, 50, "T_m")
    beside = datetime(2026, 10, 25, 2, 55) + timedelta(minutes=5) if hour else datetime(2026, 10, 25, 1, 0)
    written(tmp_path / "nc_a_2.csv", beside, 60, "T_m")
    summary = made(tmp_path)
    assert not asked(summary)
    assert first_of(tmp_path, "T_m") == (datetime(2026, 10, 25, 1, 5) if hour else datetime(2026, 10, 24, 23, 0))


@pytest.mark.parametrize("resets", [False, True])
def test_the_order_of_the_parts_tells_the_pass_of_each(tmp_path: Path, resets: bool) -> None:
    """Parts of 40 min: one is of the first pass, one turns within, and one is of the second."""
    for part in range(6):
        rows = [datetime(2026, 10, 24, 23, 20) + timedelta(minutes=40 * part + i) for i in range(40)]
        local = [t + timedelta(hours=2 if t < datetime(2026, 10, 25, 1) else 1) for t in rows]
        lines = [f"{t:%Y-%m-%d %H:%M:%S};{20 + part + i / 100}" for i, t in enumerate(local)]
        (tmp_path / f"nc_a{part + 7}.csv").write_text("\n".join(["time;T_m", *lines, ""]))
    summary = made(tmp_path, more=", clock: {resets: allow}" if resets else "")
    assert not summary.losses
    with Store(tmp_path / "s.store").reader() as con:
        found = con.execute("select value, t_s from sample where channel = 'T_m' order by t_s").fetchall()
    assert [round(t) for _, t in found] == [60 * i for i in range(240)]
    assert [v for v, _ in found] == sorted(v for v, _ in found)


@pytest.mark.parametrize("minutes", [30, 20, 25])
@pytest.mark.parametrize("only", [False, True])
def test_parts_shorter_than_the_hour_turn_beside_parts_outside_it(tmp_path: Path, minutes: int, only: bool) -> None:
    """Either pass lies between those outside, but one part begins before the end of the one before. only: no other."""
    at = datetime(2026, 10, 25, 0) if only else datetime(2026, 10, 24, 22)
    count = (120 if only else 300) // minutes
    for part in range(count):
        rows = [at + timedelta(minutes=minutes * part + i) for i in range(minutes)]
        local = [t + timedelta(hours=2 if t < datetime(2026, 10, 25, 1) else 1) for t in rows]
        lines = [f"{t:%Y-%m-%d %H:%M:%S};{20 + part + i / 100}" for i, t in enumerate(local)]
        (tmp_path / f"nc_a{part + 10}.csv").write_text("\n".join(["time;T_m", *lines, ""]))
    summary = made(tmp_path)
    assert not summary.losses
    if (minutes, only) == (20, False):
        said = [n for n in notes_in_words(summary.notes) if "taken as of its" in n]
        assert [n.rpartition("; also in ")[2] for n in said] == ["nc_a17.csv, nc_a18.csv", "nc_a20.csv, nc_a21.csv"]
    with Store(tmp_path / "s.store").reader() as con:
        found = con.execute("select value, t_s from sample where channel = 'T_m' order by t_s").fetchall()
    assert [round(t) for _, t in found] == [60 * i for i in range(minutes * count)]
    assert [v for v, _ in found] == sorted(v for v, _ in found)


def test_two_parts_of_nothing_but_that_hour_turn_between_them(tmp_path: Path) -> None:
    written(tmp_path / "nc_a1.csv", datetime(2026, 10, 25, 2, 10), 50, "T_m")
    written(tmp_path / "nc_a2.csv", datetime(2026, 10, 25, 2, 0), 30, "T_m")
    summary = made(tmp_path)
    assert not summary.losses
    assert first_of(tmp_path, "T_m") == datetime(2026, 10, 25, 0, 10)
    assert any("(nc_a2.csv)" in n and "second pass, at UTC+01:00" in n for n in summary.notes)


def test_a_source_whose_clock_is_declared_asks_nothing(tmp_path: Path) -> None:
    written(tmp_path / "nc_a.csv", LOCAL, 45, "T_m")
    assert not made(tmp_path, more=", clock: {offset: 1 h}").losses
    assert first_of(tmp_path, "T_m") == datetime(2026, 10, 25, 1, 5)


@pytest.mark.parametrize(
    ("first", "zone"),
    [
        (LOCAL, "Z"),  # not local
        (LOCAL - timedelta(hours=1), ""),  # goes on behind the hour, in one pass or two
        (LOCAL - timedelta(days=30), ""),
        (LOCAL - timedelta(hours=2), ""),  # ends before it
    ],
)
def test_the_nearest_others_ask_nothing(tmp_path: Path, first: datetime, zone: str) -> None:
    written(tmp_path / "nc_a.csv", first, 55, "T_m", zone)
    summary = made(tmp_path)
    assert not summary.losses
    assert not any("the hour that repeats" in n or "pass" in n for n in summary.notes)


@pytest.mark.parametrize(("minutes", "told"), [(150, True), (180, False), (90, False)])
def test_a_log_that_ends_an_hour_before_the_other_is_told(tmp_path: Path, minutes: int, told: bool) -> None:
    written(tmp_path / "nc_a.csv", datetime(2026, 10, 25, 1, 30), 90, "T_m")
    written(tmp_path / "daq_a.csv", datetime(2026, 10, 24, 23, 30), minutes, "T_f", "Z")
    assert any("may be of the second pass" in str(x["reason"]) for x in made(tmp_path).losses) is told


def set_back(path: Path, first: datetime, at: int, by_min: int, zone: str = "") -> None:
    """A log of five hours whose clock somebody sets back after some minutes."""
    rows = [first + timedelta(minutes=i - (by_min if i >= at else 0)) for i in range(300)]
    path.write_text("time;T_m\n" + "".join(f"{t:%Y-%m-%d %H:%M:%S}{zone};{20 + i / 10}\n" for i, t in enumerate(rows)))


@pytest.mark.parametrize(
    ("began", "clock", "told"),
    [
        (datetime(2026, 10, 26, 5), "", True),  # summer time until the operator sets it on Monday
        (datetime(2026, 10, 26, 5), ", offset: -3600 s", False),
        (datetime(2026, 10, 26, 5), ", offset: 0 s", False),
        (datetime(2026, 10, 26, 6), "", False),  # it was right until somebody set it
        (datetime(2026, 10, 26, 9), "", False),  # another log, which tells nothing
    ],
)
def test_a_clock_that_was_right_once_it_was_set_is_told_by_a_log_that_ran_with_it(
    tmp_path: Path, began: datetime, clock: str, told: bool
) -> None:
    set_back(tmp_path / "nc_a.csv", datetime(2026, 10, 26, 7), 140, 60)
    written(tmp_path / "daq_a.csv", began, 300, "T_f", "Z")
    summary = made(tmp_path, more=f", clock: {{resets: allow{clock}}}")
    said = [str(x["reason"]) for x in summary.losses if "was set back by 60 min" in str(x["reason"])]
    assert bool(said) is told
    assert all("clock: {resets: allow, offset: -3600 s}" in s for s in said)
    assert first_of(tmp_path, "T_m") == datetime(2026, 10, 26, 5 if "-3600" in clock else 6)


@pytest.mark.parametrize(
    ("began", "beside", "told"),
    [
        (datetime(2026, 10, 26, 5), ", clock: {offset: 1 h}", False),  # a log of a slow clock, which ran with it
        (datetime(2026, 10, 26, 6), ", clock: {offset: -1 h}", True),
        (datetime(2026, 10, 26, 5), ", clock: {align_to: nc, by: [{here: T_f, there: T_m}]}", False),  # it follows
    ],
)
def test_a_log_tells_it_by_the_clock_that_is_declared_of_it(
    tmp_path: Path, began: datetime, beside: str, told: bool
) -> None:
    set_back(tmp_path / "nc_a.csv", datetime(2026, 10, 26, 7), 140, 60)
    written(tmp_path / "daq_a.csv", began, 300, "T_f", "Z")
    summary = made(tmp_path, more=", clock: {resets: allow}", beside=beside)
    assert any("was set back by 60 min" in str(x["reason"]) for x in summary.losses) is told


@pytest.mark.parametrize(
    ("name", "head", "second"),
    [
        ("nc_a_MESZ.csv", "", False),
        ("nc_a_MEZ.csv", "", True),
        ("nc_a_Winterzeit.csv", "", True),
        ("nc_a.csv", "# Uhr: CEST\n", False),
        ("nc_a.csv", "# letní čas\n", False),
        ("nc_a.csv", "# clock in standard time\n", True),
        ("nc_a_CET.csv", "# Sommerzeit\n", None),
        ("nc_a_MSK.csv", "", None),
        ("nc_a.csv", "# Sommerzeit: ein\n", None),
        ("nc_a.csv", "# CEST, since 03:00 CET\n", None),
    ],
)
def test_words_in_its_name_or_above_its_rows_say_the_pass(
    tmp_path: Path, name: str, head: str, second: bool | None
) -> None:
    """Unless name and head disagree, or a line says both; a switch of the logger says none."""
    written(tmp_path / name, LOCAL, 45, "T_m")
    (tmp_path / name).write_text(head + (tmp_path / name).read_text(encoding="utf-8"), encoding="utf-8")
    summary = made(tmp_path)
    assert first_of(tmp_path, "T_m") == LOCAL - timedelta(hours=1 if second else 2)
    assert (asked(summary) == []) is (second is not None)


@pytest.mark.parametrize(
    ("line", "hours"),
    [
        ("Start: 25.10.2026 02:05:00 Sommerzeit", 2),
        ("Beginn (Winterzeit): 25.10.2026 02:05:00", 1),
        ("Start: 25.10.2026 02:05:00 heure d'hiver", 1),
    ],
)
def test_a_word_beside_the_start_above_the_rows_says_the_pass(tmp_path: Path, line: str, hours: int) -> None:
    rows = "".join(f"{30 * k};{20 + k / 90:.2f}\n" for k in range(90))
    (tmp_path / "nc_a.csv").write_text(f"{line}\ntime [s];T_m\n{rows}")
    summary = made(tmp_path)
    assert first_of(tmp_path, "T_m") == LOCAL - timedelta(hours=hours)
    assert not asked(summary)


def test_what_is_declared_or_recorded_beside_it_counts_more_than_a_word(tmp_path: Path) -> None:
    written(tmp_path / "nc_a_MEZ.csv", LOCAL, 45, "T_m")
    made(tmp_path, start=', start: "2026-10-25T02:05:00+02:00"')
    assert first_of(tmp_path, "T_m") == LOCAL - timedelta(hours=2)
