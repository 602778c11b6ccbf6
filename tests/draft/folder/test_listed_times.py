"""A list of tests says when they began and ended: a log of another time is told, one without dates has its start, and
one that goes on through all of them is cut."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from thermodata.draft.campaign.parts import Draft
from thermodata.draft.folder.beside.lists_of_tests import times_listed
from thermodata.draft.make import draft_files
from thermodata.schema.files.load import load_campaign
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

DAY = datetime(2026, 5, 6)
LISTED = (("V1", 8.0, 12.0), ("V2", 32.0, 36.0), ("V3", 70.0, 74.0))  # [h] from DAY; the last one over midnight


def plan(folder: Path, names: Sequence[str] = ("V1", "V2", "V3")) -> None:
    lines = ["Test;Datum;Beginn;Ende;Drehzahl [1/min];Rolle"]
    for name, (_, begin, end) in zip(names, LISTED, strict=True):
        a, b = (DAY + timedelta(hours=h) for h in (begin, end))
        lines.append(f"{name};{a:%d.%m.%Y};{a:%H:%M};{b:%H:%M};6000;Kal")
    (folder / "Versuchsplan.csv").write_text("\n".join([*lines, ""]))


def log(
    path: Path, first_h: float | None, hours: float, zone: str = "", columns: str = "T_hall [degC];T_bed [degC]"
) -> None:
    """first_h: from DAY; None without dates."""
    n = round(hours * 60)
    times = [str(60 * k) for k in range(n)]
    if first_h is not None:
        times = [f"{DAY + timedelta(hours=first_h, minutes=k)}{zone}" for k in range(n)]
    rows = [f"{t};{20 + k / 90:.2f};{19 + k % 7 / 10:.2f}" for k, t in enumerate(times)]
    path.write_text("\n".join([f"{'time [s]' if first_h is None else 'time'};{columns}", *rows, ""]))


def doubts(draft: Draft) -> dict[str, str]:
    return {t.id: "; ".join(t.doubts) for t in draft.tests}


@pytest.mark.parametrize(
    ("header", "row", "times"),
    [
        ("Test;Datum;Beginn;Ende;Rolle", "V1;06.05.2026;22:00;04:30;Kal", ("2026-05-06T22:00", "2026-05-07T04:30")),
        ("run;start;stop;remark", "V1;2026-05-06 08:00;2026-05-06 12:30;x", ("2026-05-06T08:00", "2026-05-06T12:30")),
        (
            "试验,开始时间,结束时间,备注",
            "V1,2026/05/06 08:00,2026/05/06 12:30,x",
            ("2026-05-06T08:00", "2026-05-06T12:30"),
        ),
        ("Test;Date;Begin;Duration;Role", "V1;2026-05-06;08:00;04:00;cal", ("2026-05-06T08:00", None)),
        ("Test;Date;Begin;End;Role", "V1;05/06/2026;08:00;12:00;cal", None),
        ("Test;Begin;End;Role", "V1;2026-05-06;2026-05-07;cal", None),
    ],
)
def test_times_of_a_list_are_read_where_its_dates_are_sure(
    tmp_path: Path, header: str, row: str, times: tuple[str, str | None] | None
) -> None:
    (tmp_path / "plan.csv").write_text("\n".join([header, row, row.replace("V1", "V2"), ""]), encoding="utf-8")
    found = times_listed(tmp_path, "plan.csv")
    ns = [
        None if t is None else round((datetime.fromisoformat(t) - datetime(1970, 1, 1)).total_seconds()) * 10**9
        for t in times or ()
    ]
    assert [[t.begin_ns, t.end_ns] for t in found.values()] == ([ns] * 2 if times else [])


@pytest.mark.parametrize(
    ("firsts", "zone", "told"),
    [
        ((8.0, 32.1, 70.0), "", set()),
        ((7.5, 32.1, 70.0), "", {"V1"}),  # half an hour early
        ((8.0, 33.0, 70.0), "", {"V2"}),  # and until half an hour late
        ((32.0, 8.0, 70.0), "", {"V1", "V2"}),  # wrong names
        ((7.0, 31.0, 69.0), "", {"V1", "V2", "V3"}),
        ((6.0, 30.0, 68.0), "Z", set()),  # of two hours ahead, as all are
        ((6.0, 30.0, 64.0), "Z", {"V3"}),
    ],
)
def test_a_log_of_another_time_than_its_test_is_told(
    tmp_path: Path, firsts: tuple[float, ...], zone: str, told: set[str]
) -> None:
    plan(tmp_path)
    for k, first in enumerate(firsts, 1):
        log(tmp_path / f"V{k}.csv", first, 3.5, zone)
    said = doubts(draft_files(tmp_path).draft)
    assert {t for t, d in said.items() if "and Versuchsplan.csv says 2026-05-" in d} == told
    if told == {"V1"}:
        assert (
            "V1.csv runs from 2026-05-06 07:30 to 2026-05-06 10:59, and Versuchsplan.csv says 2026-05-06 08:00 to"
            in said["V1"]
        )


def test_a_test_without_dates_has_its_start_from_the_list(tmp_path: Path) -> None:
    plan(tmp_path)
    for k in (1, 2, 3):
        log(tmp_path / f"V{k}.csv", None, 3.5)
    made = draft_files(tmp_path)
    starts = [t.start for t in load_campaign(made.campaign).tests]
    assert starts == ["2026-05-06 08:00", "2026-05-07 08:00", "2026-05-08 22:00"]
    assert all("start: as Versuchsplan.csv says?" in d for d in doubts(made.draft).values())


def test_one_log_of_all_tests_is_cut_by_the_list(tmp_path: Path) -> None:
    plan(tmp_path)
    log(tmp_path / "log.csv", 7.0, 70.0)
    made = draft_files(tmp_path)
    assert [(t.id, t.window) for t in made.draft.tests] == [
        ("V1", (3600.0, 18000.0)),
        ("V2", (90000.0, 104400.0)),
        ("V3", (226800.0, 241200.0)),
    ]
    assert "window: Versuchsplan.csv says 2026-05-06 08:00 to 2026-05-06 12:00" in doubts(made.draft)["V1"]
    assert made.draft.tests[0].conditions["speed"] == "6000 1/min"
    assert any("log.csv goes on through 3 tests" in n for n in made.draft.notes)


def test_a_draft_that_is_cut_by_a_list_is_ingested_so(tmp_path: Path) -> None:
    plan(tmp_path)
    log(tmp_path / "log.csv", 7.0, 70.0)
    path = draft_files(tmp_path).campaign
    path.write_text(path.read_text().replace("id: unknown  ", "id: m1  "))
    ingest(Store(tmp_path / "s.store", create=True), path)
    with Store(tmp_path / "s.store").reader() as con:
        rows = con.execute("select test, min(t)::text from sample where valid(flag) group by 1 order by 1").fetchall()
    assert [(t, at[:16]) for t, at in rows] == [
        ("V1", "2026-05-06 08:00"),
        ("V2", "2026-05-07 08:00"),
        ("V3", "2026-05-08 22:00"),
    ]


@pytest.mark.parametrize(
    ("names", "first"), [(("V1", "V2", "V3"), 7.0), (("a", "b", "c"), 7.0), (("a", "b", "c"), 9.0)]
)
def test_a_log_is_not_cut_beside_logs_of_the_tests_or_where_it_lacks_a_part(
    tmp_path: Path, names: tuple[str, ...], first: float
) -> None:
    """That of a hall, which ingest cuts to each test by itself."""
    plan(tmp_path)
    log(tmp_path / "hall.csv", first, 70.0, columns="T_hall [degC];T_floor [degC]")
    if first < 8:
        for name, (_, begin, end) in zip(names, LISTED, strict=True):
            log(tmp_path / f"{name}.csv", begin, end - begin, columns="T_bearing [degC];T_motor [degC]")
    assert all(t.window is None for t in draft_files(tmp_path).draft.tests)
