"""A start that stands above rows without a date: read where it is one for sure, asked where it may be another thing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.preamble.begin import BY_HALF
from thermodata.reader.text.preamble.head_start import head_start, unread_start

SEVEN = 1772434800 * 10**9  # 2026-03-02 07:00 UTC
NUMBERS = ["Zeit [s];T1 [°C];T2 [°C]", *(f"{60 * i}.0;{20 + i / 10:.1f};2{i % 9}.0" for i in range(40))]
CLOCKS = ["Uhrzeit;T1 [°C];T2 [°C]", *(f"07:{i:02d}:00;{20 + i / 10:.1f};2{i % 9}.0" for i in range(40))]
ELAPSED = ["Time;T1 [°C];T2 [°C]", *(f"00:{i:02d}:00;{20 + i / 10:.1f};2{i % 9}.0" for i in range(40))]


def read(
    folder: Path, head: list[str], rows: list[str], start: str | None = None, zone: str | None = None
) -> tuple[str, int, tuple[str, ...], list[int]]:
    """(clock, start, notes, minutes of the rows since the first)"""
    path = folder / "log.csv"
    path.write_text("\n".join([*head, "", *rows, ""]), "utf-8")
    source = Source(timezone=zone, table=None if start is None else {"time": {"start": start}})
    table = delimited.open_table(path, source)
    said = delimited.describe(table, source)
    times = np.concatenate([b.t_ns for b in delimited.blocks(path, table, source) if isinstance(b, Block)])
    if said.clock == "absolute":
        assert said.start_ns == times[0]
    return said.clock, int(times[0]), said.notes, ((times - times[0]) // (60 * 10**9)).tolist()


@pytest.mark.parametrize(
    "head",
    [
        ["HBM catmanEasy AP, V5.3.1", "T0:\t02.03.2026 07:00:00"],
        ["T0;02.03.2026 07:00:00"],
        ["imc Studio", "Trigger time: 02.03.2026 07:00:00"],
        ["Recorder: X", "Start time: 2026-03-02 07:00:00", "Exported: 2026-04-11 10:00:00"],
        ["# StartTime=2026-03-02T07:00:00Z"],
        ["Start date;2026-03-02", "Start time;07:00:00"],
        ["Date: 2026-03-02", "Start: 07:00"],
        ["Messbeginn;02.03.2026;07:00:00"],
        ["Měření teplotních deformací   stroj MCV 750   začátek 02.03.2026 07:00"],
        ["Prova 3 - inizio 02.03.2026 07:00"],
        ["Inizio misura: 2026/03/02 07:00"],
        ["Début de l'enregistrement : 02.03.2026 07:00:00"],
        ["Fecha de inicio: 2026-03-02", "Hora de inicio: 07:00:00"],
        ["Začátek měření: 2. 3. 2026 7:00:00"],
        ["Acquisition date: 2026-03-02 08:00:00+01:00"],
        ["Start of measurement: 02-Mar-2026 07:00:00"],
        ["開始日時;2026/03/02 07:00:00"],
        ["Storage start;2026/03/02 07:00:00.000"],
    ],
)
@pytest.mark.parametrize("rows", [NUMBERS, ELAPSED])
def test_rows_count_from_the_start_above_them(tmp_path: Path, head: list[str], rows: list[str]) -> None:
    clock, start, notes, minutes = read(tmp_path, head, rows)
    assert (clock, start, minutes) == ("absolute", SEVEN, list(range(40)))
    assert any("count from the start" in n for n in notes)


@pytest.mark.parametrize(
    "line",
    [
        "Start (UTC): 2026-03-02 07:00:00",
        "Start [UTC];2026-03-02 07:00:00",
        "StartTimeUTC: 2026-03-02 07:00:00",
        "start_utc = 2026-03-02T07:00:00",
        "Start (MEZ): 02.03.2026 08:00",
        "Start (UTC+01:00): 02.03.2026 08:00",
        "Start: 2026-03-02 08:00:00 [Europe/Prague]",
        "Start: 02.03.2026 07:00:00 Uhr",
        "Start: 02.03.2026 07:00:00 (local)",
        "%% start: 02.03.2026 07:00:00 local time",
        "Start: 02.03.2026 07:00 Ortszeit",
        "Messbeginn: Mo, 02.03.2026 07:00 h",
        "Start: 2. März 2026, 7.00 Uhr",
        "Start am 02.03.2026 um 7.00 Uhr",
        "Messung gestartet am Montag, 2. Mrz. 2026 um 07:00 Uhr",
        "Début : le 2 mars 2026 à 07h00",
        "Inizio misura: lunedì 2 marzo 2026 alle ore 7.00",
        "Inicio: 2 de marzo de 2026 a las 07:00",
        "Začátek měření: pondělí 2. března 2026 v 7:00",
        "Początek pomiaru: 2 marca 2026, godz. 7:00",
        "Test started on Monday, March 2nd, 2026 at 7:00 AM",
        "開始日時：2026年3月2日(月) 7時00分",
        "开始时间: 2026-03-02 07:00:00 (当地时间)",
    ],
)
def test_a_start_is_read_as_people_write_it(tmp_path: Path, line: str) -> None:
    clock, start, notes, _ = read(tmp_path, [line], NUMBERS)
    assert (clock, start) == ("absolute", SEVEN)
    assert any("count from the start" in n for n in notes)


@pytest.mark.parametrize(
    "line",
    [
        "Start: 2026-03-02 07:00:00 CST",
        "Start: Montag früh, 02.03.2026",
        "Messbeginn: 2.3. 07:00",
        "Start: 02.03.2026 07:00 bis 09:00",
        "Test date: 02.03.2026 07:00, shift 2",
    ],
)
def test_a_start_that_is_not_read_is_told(tmp_path: Path, line: str) -> None:
    clock, _, notes, _ = read(tmp_path, [line], NUMBERS)
    assert clock == "relative"
    assert any("no date with a time of day is read" in n and "{start: none}" in n for n in notes)
    assert not any("is read" in n for n in read(tmp_path, [line], NUMBERS, "none")[2])
    with pytest.raises(FormatError, match="can't be taken"):
        read(tmp_path, [line], NUMBERS, "head")


def test_a_mere_date_beside_other_words_is_told_of_times_of_day_alone(tmp_path: Path) -> None:
    """Seconds from a start don't begin at midnight."""
    head = ["Date: 02.03.2026 / J. Kramer"]
    assert not any("is read" in n for n in read(tmp_path, head, NUMBERS)[2])
    assert any("is read" in n for n in read(tmp_path, head, CLOCKS)[2])


def test_a_start_of_nobody_knows_what_is_asked_and_taken_where_it_is_declared(tmp_path: Path) -> None:
    head = ["Start Messung WZM3: 02.03.2026 07:00:00"]
    assert any("not taken for the start of the rows" in n for n in read(tmp_path, head, NUMBERS)[2])
    assert read(tmp_path, head, NUMBERS, "head")[1] == SEVEN


def test_one_start_in_utc_and_in_the_time_of_the_place_is_one(tmp_path: Path) -> None:
    head = ["Start: 02.03.2026 08:00:00", "Start (UTC): 2026-03-02 07:00:00"]
    assert read(tmp_path, head, NUMBERS)[:2] == ("absolute", SEVEN)


@pytest.mark.parametrize(
    "line",
    [
        "Start speed: 6000 1/min",
        "Start channel: 3",
        "Trigger: 3.5 V",
        "Record: v5.3.1",
        "Log: 192.168.0.10",
        "Recording time: 8 h",
        "Calibration start: 02.03.2026 07:00",
        "Start/Stop: 02.03.2026 07:00",
    ],
)
def test_lines_of_other_things_are_no_start_and_not_told(line: str) -> None:
    assert head_start([[line]]) is None
    assert unread_start([[line]]) is None


@pytest.mark.parametrize("head", [["Datum: 02.03.2026"], ["Start: 02.03.2026 06:58:31"], ["Date;2026-03-02"]])
def test_times_of_day_are_of_the_date_above_them(tmp_path: Path, head: list[str]) -> None:
    assert read(tmp_path, head, CLOCKS)[:2] == ("absolute", SEVEN)


def test_times_of_day_go_on_behind_midnight_and_are_local(tmp_path: Path) -> None:
    rows = [CLOCKS[0], *(f"{(23 + i // 30) % 24:02d}:{2 * (i % 30):02d}:00;2{i % 9}.5;20.0" for i in range(60))]
    clock, start, _, minutes = read(tmp_path, ["Datum: 01.03.2026"], rows, zone="Europe/Prague")
    assert (clock, start) == ("absolute", SEVEN - 9 * 3600 * 10**9)
    assert minutes == list(range(0, 120, 2))


def test_a_local_start_is_in_the_zone_of_its_source(tmp_path: Path) -> None:
    assert read(tmp_path, ["T0: 02.03.2026 08:00:00"], NUMBERS, zone="Europe/Prague")[1] == SEVEN


@pytest.mark.parametrize(("start", "month"), [("dmy", 3), ("mdy", 2)])
def test_the_order_of_day_and_month_is_asked_and_answered(tmp_path: Path, start: str, month: int) -> None:
    head = ["Data file: a.dxd", "Start time: 02/03/2026 07:00:00.000", "Sample rate: 0.0167"]
    clock, _, notes, _ = read(tmp_path, head, NUMBERS)
    assert clock == "relative", "what was read before there was such an answer still is"
    assert any("whose day and month may be either way round" in n and "{start: dmy}" in n for n in notes)
    with pytest.raises(FormatError, match="day and month of the start"):
        read(tmp_path, head, NUMBERS, "head")
    with pytest.raises(FormatError, match=r"time\.start"):
        read(tmp_path, head, NUMBERS, "unknown")
    expected = np.datetime64(f"2026-{month:02d}-{5 - month:02d}T07:00", "ns").astype(np.int64)
    assert read(tmp_path, head, NUMBERS, start)[1] == expected
    assert read(tmp_path, head, NUMBERS, "none")[:2] == ("relative", 0)


@pytest.mark.parametrize(
    "head",
    [
        ["Exported: 02.03.2026 07:00:00"],
        ["Report date: 02.03.2026 07:00"],
        ["Storage date: 02.03.2026 07:00"],
        ["Export started: 02.03.2026 07:00"],
        ["Date: 02.03.2026", "Time: 07:00:00"],
        ["Recording date: 02.03.2026", "Recording time: 07:00:00"],  # which may be how long it took
    ],
)
def test_a_date_that_may_be_another_one_is_noted_and_taken_where_it_is_declared(
    tmp_path: Path, head: list[str]
) -> None:
    clock, start, notes, _ = read(tmp_path, head, NUMBERS)
    assert (clock, start) == ("relative", 0)
    assert any("not taken for the start of the rows" in n and "{start: head}" in n for n in notes)
    assert read(tmp_path, head, NUMBERS, "head")[:2] == ("absolute", SEVEN)


@pytest.mark.parametrize(
    "head",
    [
        ["Calibration date: 02.03.2026 07:00:00"],
        ["End time: 02.03.2026 07:00:00"],
        ["Start time: 0.0"],
    ],
)
def test_what_says_no_start_is_none(tmp_path: Path, head: list[str]) -> None:
    clock, _, notes, _ = read(tmp_path, head, NUMBERS)
    assert clock == "relative"
    assert not any("head says" in n for n in notes)
    clock, _, notes, _ = read(tmp_path, head, NUMBERS, "head")
    assert clock == "relative"
    assert any("no start stands above the rows" in n for n in notes)
    clock, _, notes, _ = read(tmp_path, head, NUMBERS, "dmy")
    assert clock == "relative", "an order answers only what is asked"
    assert any("though time.start is 'dmy'" in n for n in notes)


@pytest.mark.parametrize("head", [["Date: 02.03.2026"], ["Start: 2026-03-02 07:00:00", "Trigger: 2026-03-02 07:05:00"]])
def test_a_start_that_is_declared_and_cannot_be_taken_is_refused(tmp_path: Path, head: list[str]) -> None:
    with pytest.raises(FormatError, match="can't be taken"):
        read(tmp_path, head, NUMBERS, "head")


@pytest.mark.parametrize("first", ["00:00:00,5", "00:00:01,0", "00:00:30,0"])
def test_durations_below_a_date_stay_durations(tmp_path: Path, first: str) -> None:
    rows = ["Laufzeit;T1;T2", f"{first};20,5;21,0", *(f"00:{i:02d}:00,5;20,{i % 9};21,0" for i in range(1, 40))]
    assert read(tmp_path, ["Datum: 02.03.2026"], rows)[0] == "relative"


@pytest.mark.parametrize(
    "line", ["Test: 02-Mar-2026 - 03-Mar-2026", "Test date: Mon 02-Mar-2026 (Mon)", "Date: 02-Mar-2026 / 03-Mar-2026"]
)
def test_two_names_of_months_on_a_line_are_no_start(tmp_path: Path, line: str) -> None:
    assert read(tmp_path, [line], NUMBERS)[0] == "relative"


@pytest.mark.parametrize(
    "line", ["Start: 2026-03-01" + " " * 100_000 + "x", "Start" + " " * 50_000 + ":" + " " * 50_000]
)
def test_a_long_line_takes_no_time(line: str) -> None:
    """A pattern that tries every part of it would take minutes."""
    assert head_start([[line]]) is None


def test_columns_on_two_kinds_of_clocks_take_no_start(tmp_path: Path) -> None:
    rows = ["Time;T1;Time [s];T2", *(f"08:{i:02d}:00;20.{i % 9};{60 * i}.0;21.0" for i in range(40))]
    clock, _, notes, _ = read(tmp_path, ["Start: 2026-03-02 08:00:00"], rows)
    assert clock == "relative"
    assert any("others tell times of day" in n for n in notes)


def test_two_starts_and_rows_that_begin_late_are_noted(tmp_path: Path) -> None:
    two = ["Start: 2026-03-02 07:00:00", "Trigger: 2026-03-02 07:05:00"]
    late = [NUMBERS[0], *(f"{7200 + 60 * i}.0;20.{i % 9};21.0" for i in range(40))]
    for head, rows in ((two, NUMBERS), (two[:1], late)):
        clock, _, notes, _ = read(tmp_path, head, rows)
        assert clock == "relative"
        assert any("not taken for the start of the rows" in n for n in notes)
    assert read(tmp_path, two[:1], late, "head")[1] == SEVEN + 7200 * 10**9


def test_rows_with_dates_of_their_own_keep_them(tmp_path: Path) -> None:
    rows = ["Time;T1 [°C]", *(f"2026-03-02 07:{i:02d}:00;2{i % 9}.5" for i in range(40))]
    assert read(tmp_path, ["Start time: 03/04/2026 07:00:00"], rows)[:2] == ("absolute", SEVEN)


@pytest.mark.parametrize("head", [["Date;26/03/02", "Time;07:00:00"], ["Start: 26/03/02 07:00:00"]])
def test_a_year_of_two_digits_may_stand_first_where_it_is_declared(tmp_path: Path, head: list[str]) -> None:
    assert read(tmp_path, head, NUMBERS, "ymd")[:2] == ("absolute", SEVEN)
    with pytest.raises(FormatError, match="either way round") as refused:
        read(tmp_path, head, NUMBERS, "head")
    assert "ymd" in (refused.value.hint or "")


@pytest.mark.parametrize("zone", ["(UTC+01:00)", "(+01:00)", "UTC+01:00", "(GMT+1)"])
def test_a_start_with_its_offset_in_brackets_counts(zone: str) -> None:
    said = head_start([["Start time:", f"2026-03-02 08:00:00 {zone}"]])
    assert said is not None
    assert said.zoned
    assert said.clock_ns == 7 * 3600 * 10**9


@pytest.mark.parametrize("zone", ["(UTC+01:00", "(Channel 1)", "(UTC+01:00) Berlin"])
def test_what_stands_behind_a_start_and_is_no_offset_does_not(zone: str) -> None:
    said = head_start([["Start time:", f"2026-03-02 08:00:00 {zone}"]])
    assert said is None or not said.zoned


def test_a_start_that_is_month_first_for_its_half_of_the_day_says_so(tmp_path: Path) -> None:
    said = [read(tmp_path, [f"Start Time;{day} 08:00:00 AM"], NUMBERS)[2] for day in ("03/06/2026", "03/16/2026")]
    assert [any(BY_HALF in n for n in notes) for notes in said] == [True, False]
