"""Logs that neither a date nor a name tells apart: loggers of one test, its parts, or a test each? Asked."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.commands import Say
from tests.draft.labs import workbook
from thermodata.draft.make import draft_files

SHEETS, FILES, JOINED = "a test each here", "a test each, or parts of one?", "was there a pause between them?"


def logged(rows: int) -> list[list[object]]:
    head: list[object] = ["Time [s]", "T_front [degC]", "dZ [um]"]
    return [head, *([10 * i, 20 + 0.01 * i, 0.1 * i] for i in range(rows))]


def asked(folder: Path, about: str) -> list[str]:
    return [q for s in draft_files(folder).draft.sources for q in s.questions if about in q]


@pytest.mark.parametrize(
    ("names", "rows", "questions"),
    [
        (("Sheet1", "Sheet2"), (361, 361), 1),
        (("Tabelle1", "Tabelle2", "Tabelle3"), (361, 200, 300), 1),
        (("Sheet1", "Data2"), (361, 300), 1),
        (("Unit 1", "Unit 2"), (361, 300), 1),
        (("Left", "Right"), (361, 361), 1),  # to the same row
        (("cold", "warm"), (361, 300), 0),
        (("S4000", "S8000"), (361, 361), 0),
        (("Test 1", "Test 2"), (361, 361), 0),
        (("2026-03-02", "2026-03-03"), (361, 361), 0),
    ],
)
def test_sheets_whose_names_say_nothing_are_asked(
    tmp_path: Path, names: tuple[str, ...], rows: tuple[int, ...], questions: int
) -> None:
    workbook(tmp_path / "book.xlsx", dict(zip(names, map(logged, rows), strict=True)))
    found = asked(tmp_path, SHEETS)
    assert len(found) == questions
    assert all(f"'{n}'" in q for q in found for n in names)


def test_sheets_that_a_list_names_are_tests(tmp_path: Path) -> None:
    workbook(tmp_path / "book.xlsx", {n: logged(361) for n in ("Sheet1", "Sheet2", "Sheet3")})
    (tmp_path / "tests.csv").write_text("test,speed [rpm]\nSheet1,3000\nSheet2,6000\nSheet3,9000\n")
    assert not asked(tmp_path, SHEETS)


def write(folder: Path, name: str, head: str = "", begin_s: int = 0, warmer: float = 0.0) -> None:
    rows = [f"{begin_s + 10 * i},{20 + warmer + i / 100:.3f}" for i in range(361)]
    (folder / name).parent.mkdir(exist_ok=True)
    (folder / name).write_text("\n".join([*([head, ""] if head else []), "t [s],T_bed [degC]", *rows, ""]))


@pytest.mark.parametrize(
    ("names", "questions"),
    [
        (("run_1", "run_2"), 1),
        (("log.part1", "log.part2"), 1),
        (("day (1)", "day (2)"), 1),
        (("warm_1", "warm_2", "cold_1"), 1),
        (("warm_1", "warm_2", "cold_1", "cold_2"), 2),
        (("warm", "cold"), 0),
        (("warm_1", "cold_1"), 0),
        (("test_1", "test_2"), 0),
        (("spindle test 1", "spindle test 2"), 0),
        (("V1", "V2"), 0),
        (("spindle_S4000", "spindle_S8000"), 0),
        (("rpm_4000", "rpm_8000"), 0),
    ],
)
def test_files_that_each_count_from_0_and_are_only_counted_are_asked(
    tmp_path: Path, names: tuple[str, ...], questions: int
) -> None:
    for k, name in enumerate(names):
        write(tmp_path, f"{name}.csv", warmer=k)
    draft = draft_files(tmp_path).draft
    assert len(draft.tests) == len(names)
    assert len([q for s in draft.sources for q in s.questions if FILES in q]) == questions


@pytest.mark.parametrize(
    "heads",
    [("Start time: 2026-03-02 08:00:00", "Start time: 2026-03-03 08:00:00"), ("", "Start: 2026-03-03 08:00:00")],
)
def test_files_that_a_date_tells_apart_are_not_asked(tmp_path: Path, heads: tuple[str, str]) -> None:
    for k, head in enumerate(heads, 1):
        write(tmp_path, f"run_{k}.csv", head, warmer=k)
    assert not asked(tmp_path, FILES)


def test_files_whose_tests_another_source_dates_are_not_asked(tmp_path: Path) -> None:
    for k in (1, 2):
        write(tmp_path, f"run_{k}.csv", warmer=k)
        rows = "".join(f"2026-03-0{k} 08:{i // 6:02d}:{i % 6}0Z;{20 + i / 100:.2f}\n" for i in range(360))
        (tmp_path / f"run_{k}_hall.csv").write_text(f"time;Hall air [degC]\n{rows}")
    assert not asked(tmp_path, FILES)


def test_parts_that_are_declared_are_put_end_to_end(tmp_path: Path, say: Say) -> None:
    for k in (1, 2):
        write(tmp_path, f"run_{k}.csv", warmer=3.6 * k)
    [question] = asked(tmp_path, FILES)
    answer = question.split("files: ")[1].split("; they")[0]
    path = tmp_path / "campaign.yaml"
    lines = [line for line in path.read_text().splitlines() if "id: run_2" not in line]
    path.write_text("\n".join(f"  - {{id: run, files: {answer}}}" if "id: run_1" in x else x for x in lines) + "\n")
    store = ("--store", tmp_path / "s")
    said = json.loads(say(*store, "ingest", path, "--json").out)
    assert any("joined end to end in the order of their names" in n for n in said["notes"])
    told = say(*store, "sql", "select count(*) as n, max(t_s) as end_s from sample", "--json").out
    assert json.loads(told) == [{"n": 722, "end_s": 7210.0}]


def test_parts_that_another_source_joins_are_asked_for_their_pause(tmp_path: Path) -> None:
    for test in ("heat", "cool"):
        for k in (1, 2):
            write(tmp_path, f"{test}_{k}.csv", warmer=k)
        rows = "".join(f"{10 * i};{20 + i / 100:.2f}\n" for i in range(720))
        (tmp_path / f"{test}.asc").write_text(f"t [s];Hall air [degC]\n{rows}")
    draft = draft_files(tmp_path).draft
    assert [t.id for t in draft.tests] == ["cool", "heat"]
    assert len([q for s in draft.sources for q in s.questions if JOINED in q]) == 1


@pytest.mark.parametrize("headed", [True, False])
def test_files_whose_heads_may_date_them_are_no_parts(tmp_path: Path, headed: bool) -> None:
    for day, name in ((16, "ETVE_4000"), (17, "ETVE_8000")):
        head = f"Machine: VMC\nTest Date:\t06/{day}/2026\nTest Time:\t09:00:00 AM\n\n" if headed else ""
        rows = "".join(f"{k / 5:.2f}\t{0.1 * k:.1f}\t{20 + k / 90:.2f}\n" for k in range(120))
        (tmp_path / f"{name}.txt").write_text(f"{head}Elapsed (min)\tZ (um)\tT Bed (degC)\n{rows}", "utf-8")
    questions = "; ".join(asked(tmp_path, ""))
    assert ("did its rows begin then?" in questions, FILES in questions) == (headed, not headed)
