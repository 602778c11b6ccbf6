"""The start of logs without dates, which their names or a list say, is proposed and asked."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import Say
from thermodata.draft.words.said_by_names import said_by


def drafted(folder: Path, say: Say, names: list[str], listed: str = "") -> list[str]:
    """The lines of the tests."""
    for name in names:
        rows = "".join(f"{10 * k};{k / 50:.2f};{20 + k / 90:.2f}\n" for k in range(120))
        (folder / name).write_text(f"time [s];dX [um];T_bed [degC]\n{rows}", "utf-8")
    if listed:
        (folder / "lista.csv").write_text(listed, "utf-8")
    assert say("init", folder).code == 0
    return [line for line in (folder / "campaign.yaml").read_text("utf-8").splitlines() if line.startswith("  - {id:")]


def test_a_start_by_the_name_is_written_and_asked(tmp_path: Path, say: Say) -> None:
    lines = drafted(tmp_path, say, ["2026-03-02_0800_spindle.csv", "2026-03-03_0930_spindle.csv"])
    assert ['start: "2026-03-02 08:00:00"' in lines[0], 'start: "2026-03-03 09:30:00"' in lines[1]] == [True, True]
    assert all("? start: as the name says?" in line for line in lines)


@pytest.mark.parametrize(
    ("name", "days"),
    [
        ("Prova_02-03-26", ("2026-03-02", "2026-02-03")),
        ("Prova_13-03-26", ("2026-03-13",)),
        ("Prova 13.03.26", ("2026-03-13",)),
        ("26_03_14 test", ("2026-03-14", "2014-03-26")[:1]),
        ("V10-20-30", ()),
        ("SN 12-34-56-78", ()),
    ],
)
def test_a_date_of_two_digits_has_its_readings(name: str, days: tuple[str, ...]) -> None:
    assert said_by([name]).days == days


@pytest.mark.parametrize(
    ("name", "date", "start"),
    [
        ("S6000 31.03.2026 08_10_00 1", "2026-03-31", "2026-03-31 08:10:00"),
        ("S8000 03.03.2026 08_02_11 1", "2026-03-03", "2026-03-03 08:02:11"),
        ("Test 3.12.2026 0810", "2026-12-03", "2026-12-03 08:10:00"),
        ("Test 31.03.2026", "2026-03-31", None),
        ("Run A 5_4_2026 08_10_05 1", None, None),
        ("Run 31-03-2026 08-10", None, None),
        ("S8000 12 2026-03-02 0800", "2026-03-02", "2026-03-02 08:00:00"),
    ],
)
def test_a_year_behind_a_day_and_a_month_begins_no_date(name: str, date: str | None, start: str | None) -> None:
    said = said_by([name])
    assert (said.conditions.get("date"), said.start) == (date, start)


@pytest.mark.parametrize(
    ("names", "asked"),
    [
        (["Prova_02-03-26.txt", "Prova_03-04-26.txt"], "the name says 2026-03-02 or 2026-02-03"),
        (["20260302_S4000.csv", "20260303_S8000.csv"], "the name says 2026-03-02;"),
    ],
)
def test_a_day_without_its_hour_is_asked(tmp_path: Path, say: Say, names: list[str], asked: str) -> None:
    line = drafted(tmp_path, say, names)[0]
    assert "start: '2026-03-02 08:00'?" in line
    assert asked in line
    assert "id: Prova_02-03-26, kind" in line or 'id: "20260302_S4000", kind' in line  # nothing is taken


@pytest.mark.parametrize("header", ["Prova;Data;Ora", "Versuch;Datum;Uhrzeit", "Essai;Date;Heure", "Test;Day;Time"])
def test_a_date_and_a_time_of_a_list_that_say_no_begin_are_the_start(tmp_path: Path, say: Say, header: str) -> None:
    listed = f"{header}\nV1;15/03/2026;08:00\nV2;16/03/2026;09:30\n"
    lines = drafted(tmp_path, say, ["V1.csv", "V2.csv"], listed)
    assert ['start: "2026-03-15 08:00"' in lines[0], 'start: "2026-03-16 09:30"' in lines[1]] == [True, True]
    assert all("start: as lista.csv says?" in line for line in lines)


def test_the_moments_of_a_list_may_stand_under_data(tmp_path: Path, say: Say) -> None:
    listed = "Prova;Data;Note\nV1;15/03/2026 08:00;a\nV2;16/03/2026 09:30;b\n"
    lines = drafted(tmp_path, say, ["V1.csv", "V2.csv"], listed)
    assert 'start: "2026-03-15 08:00"' in lines[0]
