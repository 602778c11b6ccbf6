"""A workbook of long logs with a list of its tests: the logs are drafted, whatever its sheets leave open."""

from __future__ import annotations

import json
from pathlib import Path

from tests.commands import Say
from tests.draft.labs import workbook

Rows = list[list[object]]
TESTS = ("warm3000", "warm9000", "night")
PROTOCOL: Rows = [
    ["Versuch", "Datum", "Drehzahl [U/min]"],
    *([t, f"2026-01-1{i} 07:00", i] for i, t in enumerate(TESTS)),
]


def log(first: float, n: int = 300, comment: bool = True) -> Rows:
    head: Rows = [
        ["Zeitstempel", "Spindel", "", "Temperaturen", ""],
        ["", "Drehzahl", "Auslastung", "Spindelmotor", "Rücklauf"],
        ["", "U/min", "%", "°C", "°C"],
        ["Kommentar", "aus NCU", "", "Pt1000 Klixon", ""],
    ]
    return head[: 4 if comment else 3] + [[first + i / 2880, 3000, 12.5, 23 + i / 100, 19.5] for i in range(n)]


def text(folder: Path, test: str) -> None:
    rows = "".join(f"{10 * i};{20 + i / 100}\n" for i in range(300))
    (folder / f"{test}.csv").write_text(f"Zeit [s];T_Lager [°C]\n{rows}")


def test_the_sheets_are_logs_and_the_list_says_their_conditions(tmp_path: Path, say: Say) -> None:
    for test in TESTS:
        text(tmp_path, test)
    logs = {t: log(46034.25 + i) for i, t in enumerate(TESTS)}
    workbook(tmp_path / "Steuerung.xlsx", {"Protokoll": PROTOCOL, **logs})
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    drafted = path.read_text()
    (source,) = [line for line in drafted.splitlines() if "Steuerung.xlsx" in line and "reader" in line]
    assert "time: {unit: unknown}" in source
    assert "? sheet 'warm3000': unit of the time: excel" in source
    assert "conditions from Steuerung.xlsx, column 'Versuch'" in drafted
    assert "Spindelmotor: {" in drafted
    path.write_text(drafted.replace("unit: unknown", "unit: excel"))
    store = ("--store", tmp_path / "s")
    told = json.loads(say(*store, "ingest", path, "--json").out)["losses"]
    assert not [loss for loss in told if loss["file"]]
    asked = "select count(*) as n from sample where channel = 'Spindelmotor'"
    assert json.loads(say(*store, "sql", asked, "--json").out) == [{"n": 900}]


def test_a_workbook_with_a_long_sheet_is_a_log_though_another_lists_the_tests(tmp_path: Path, say: Say) -> None:
    for test in TESTS:
        text(tmp_path, test)
    rows: Rows = [
        ["Zeit", "T_Halle [°C]"],
        *([f"2026-01-12 {i // 60:02}:{i % 60:02}:00", 20 + i / 100] for i in range(400)),
    ]
    workbook(tmp_path / "Halle.xlsx", {"Protokoll": PROTOCOL, "Klima": rows})
    assert say("init", tmp_path).code == 0
    assert "T_Halle: {" in (tmp_path / "campaign.yaml").read_text()


def test_sheets_that_cannot_be_read_beside_a_list_of_tests_are_said(tmp_path: Path, say: Say) -> None:
    for test in TESTS:
        text(tmp_path, test)
    rows: Rows = [["no", "T"], *(["on", 20 + i / 100] for i in range(400))]
    workbook(tmp_path / "Plan.xlsx", {"Protokoll": PROTOCOL, "Klima": rows})
    assert say("init", tmp_path).code == 0
    drafted = (tmp_path / "campaign.yaml").read_text()
    assert "conditions from Plan.xlsx" in drafted
    assert "Plan.xlsx: its sheet 'Klima' is not read as a table" in drafted
