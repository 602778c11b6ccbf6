"""Lists of tests with dates are no logs, in whatever language; means over times are no list."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.draft.labs import numbers, text
from thermodata.draft.folder.beside.lists_of_tests import listed_tests
from thermodata.draft.make import draft_files


@pytest.mark.parametrize(
    ("name", "header", "keys", "is_list"),
    [
        ("测试记录", "编号,日期,开始时间,结束时间,转速(rpm),用途,备注", ("T1", "T2"), True),
        ("試験一覧", "番号,日付,開始,終了,回転数,備考", ("A1", "A2"), True),
        ("Versuchsplan", "Test,Datum,Beginn,Ende,Drehzahl [1/min],Rolle,Bemerkung", ("V1", "V2"), True),
        ("essais", "Essai,Date,Début,Fin,Vitesse,Remarque", ("E1", "E2"), True),
        ("proeven", "Proef,Datum,Begin,Einde,Toerental,Opmerking", ("P1", "P2"), True),
        ("runs", "No,Date,Start,End,Speed,Remark", ("1", "2"), True),
        ("Mittelwerte", "Nr,Datum,Beginn,Ende,T_Lager [°C],n [1/min]", ("1", "2"), False),
        ("log", "Date,Time,T_bearing,Speed,Comment", ("2026-05-06", "2026-05-07"), False),
        ("log", "No,Date,Time,T_bearing,Note", ("1", "2"), False),
    ],
)
def test_a_list_of_tests_is_told_from_a_log(
    tmp_path: Path, name: str, header: str, keys: tuple[str, ...], is_list: bool
) -> None:
    more = ",".join(["2026-05-06", "08:00", "12:00", "6000", "x", "y"][: header.count(",")])
    lines = [header, *(f"{key},{more}" for key in keys)]
    (tmp_path / f"{name}.csv").write_text("\n".join([*lines, ""]), encoding="utf-8")
    assert listed_tests(tmp_path, f"{name}.csv") == (list(keys) if is_list else [])


def timed(k: int) -> str:
    return f"2026-05-06 {8 + k // 60:02d}:{k % 60:02d}:00"


@pytest.mark.parametrize(
    ("name", "header"),
    [
        ("Messprotokoll", "Nr;Zeit;T_spindel [°C];dZ [µm];Bemerkung"),
        ("温度记录", "序号;时间;温度 [℃];位移Z [µm];备注"),
        ("test_03", "No.;Time;T_spindle [degC];dZ [um];Note"),
        ("Versuche_uebersicht", "Lauf;Start;Ende;T_spindel;Bemerkung"),
        ("test_plan_run1", "No.;Begin;T [degC];dZ [um];Comment"),
    ],
)
@pytest.mark.parametrize("step", [1, 7])
def test_a_short_log_of_numbered_rows_is_no_list(tmp_path: Path, name: str, header: str, step: int) -> None:
    rows = [
        f"{k + 1};{timed(k * step)};{timed(k * step + step) if 'Ende' in header else round(20 + k / 7, 2)};{k / 9:.2f};"
        for k in range(45)
    ]
    (tmp_path / f"{name}.csv").write_text("\n".join([header, *rows, ""]), encoding="utf-8")
    assert listed_tests(tmp_path, f"{name}.csv") == []


def test_decimals_under_a_unit_are_a_log_and_tests_a_day_apart_a_list(tmp_path: Path) -> None:
    rows = [f"{k + 1};{timed(k * k)};{20 + k / 8:.3f};x" for k in range(30)]
    (tmp_path / "test_4.csv").write_text("\n".join(["No.;Time;T [degC];Note", *rows, ""]), encoding="utf-8")
    assert listed_tests(tmp_path, "test_4.csv") == []
    rows = [f"V{k + 1};2026-05-{6 + k:02d} 08:00;2026-05-{6 + k:02d} 12:30;{20 + k / 8:.2f};Kal" for k in range(9)]
    plan = ["Test;Beginn;Ende;T_Halle [°C];Rolle", *rows, ""]
    (tmp_path / "Plan.csv").write_text("\n".join(plan), encoding="utf-8")
    assert listed_tests(tmp_path, "Plan.csv") == [f"V{k + 1}" for k in range(9)]


@pytest.mark.parametrize(("beginning", "joined"), [("V", True), ("Q", False)])
def test_a_list_gives_conditions_to_tests_whose_names_begin_so_and_is_no_source(
    tmp_path: Path, beginning: str, joined: bool
) -> None:
    t = np.arange(600) * 10.0
    for k in (1, 2):
        text(tmp_path / f"V{k}_laser.csv", ["t [s]", "T_hall"], [numbers(t, 0), numbers(22 + t / 1000, 3)], mark=",")
    rows = [f"{beginning}{k},06.05.2026,0{7 + k}:00,1{k}:00,{6000 * k},Kal" for k in (1, 2)]
    lines = ["Test,Datum,Beginn,Ende,Drehzahl [1/min],Rolle", *rows, ""]
    (tmp_path / "Versuchsplan.csv").write_text("\n".join(lines), encoding="utf-8")
    draft = draft_files(tmp_path).draft
    assert [t.id for t in draft.tests] == ["V1_laser", "V2_laser"]
    assert len(draft.sources) == 1
    speeds = [t.conditions.get("speed") for t in draft.tests]
    assert speeds == (["6000 1/min", "12000 1/min"] if joined else [None, None])
    assert any("a list of tests ('Q1', 'Q2'), and no log" in why for _, why in draft.not_used) != joined
