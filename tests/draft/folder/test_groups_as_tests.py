"""Groups of one TDMS file: tests where they were recorded one after the other, rates of one recording otherwise."""

from __future__ import annotations

import json
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from tests.draft.labs import tdms, workbook
from thermodata.draft.files.sample import Sample
from thermodata.draft.files.sheets import recordings_in
from thermodata.schema.files.load import load_campaign

BEGAN = datetime(2026, 3, 2, 8, tzinfo=UTC)
S = 1_000_000_000


def one_file(path: Path, groups: dict[str, tuple[datetime, float, float]]) -> None:
    """Group -> its start, seconds from row to row, and first temperature."""
    from nptdms import TdmsFile, TdmsWriter

    parts = []
    for group, (began, step_s, first) in groups.items():
        part = path.with_name("part.tdms")
        rows = int(3600 / step_s)
        tdms(part, {group: {"T_front": (first + np.arange(rows) * step_s / 3600, "degC")}}, began, step_s)
        parts += [c for g in TdmsFile.read(part).groups() for c in g.channels()]
        part.unlink()
    with TdmsWriter(str(path)) as writer:
        writer.write_segment(parts)


def test_groups_of_three_days_are_three_tests_with_one_channel(tmp_path: Path, say: Say) -> None:
    days = {f"S{n}": (BEGAN + timedelta(days=k), 10.0, 20.0 + 5 * k) for k, n in enumerate((4000, 8000, 12000))}
    one_file(tmp_path / "all.tdms", days)
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    campaign = load_campaign(path)
    assert [t.id for t in campaign.tests] == list(days)
    assert [(n, c.signal) for n, c in campaign.channels.items()] == [("T_front", "T_front")]
    store = ("--store", tmp_path / "s")
    assert say(*store, "ingest", path).code == 0
    asked = "select test, min(value) as t, count(*) as n from sample group by test order by t"
    assert json.loads(say(*store, "sql", asked, "--json").out) == [
        {"test": test, "t": first, "n": 360} for test, (_, _, first) in days.items()
    ]


@pytest.mark.parametrize("late", [0, 600])
def test_groups_that_ran_at_once_are_rates_of_one_test(tmp_path: Path, say: Say, late: int) -> None:
    one_file(tmp_path / "all.tdms", {"Slow": (BEGAN, 10.0, 20.0), "Fast": (BEGAN + timedelta(seconds=late), 1.0, 20.0)})
    assert say("init", tmp_path).code == 0
    campaign = load_campaign(tmp_path / "campaign.yaml")
    assert [t.id for t in campaign.tests] == ["all"]
    assert {c.signal for c in campaign.channels.values()} == {"Slow/T_front", "Fast/T_front"}
    assert campaign.sources["daq"].table is None


def days_of_groups(folder: Path) -> None:
    """A recording a day with a group a test, of which one day has one; a control's file a day; a jump test."""
    from nptdms import TdmsFile, TdmsWriter

    tests = {"heat": (0, 0), "cool": (0, 2), "axes": (1, 0), "idle": (2, 0), "mixed": (2, 2)}
    for day in range(3):
        parts = []
        for test, (of, hours) in tests.items():
            if of != day:
                continue
            began = BEGAN + timedelta(days=day, hours=hours)
            signals = {"T_front": (20 + np.arange(360) / 100, "degC"), "EC_Z": (np.arange(360) / 1000, "V")}
            tdms(folder / "part.tdms", {test: signals}, began, 10.0)
            parts += [c for g in TdmsFile.read(folder / "part.tdms").groups() for c in g.channels()]
        with TdmsWriter(str(folder / f"rig_2026030{2 + day}.tdms")) as writer:
            writer.write_segment(parts)
        began = BEGAN + timedelta(days=day, hours=1)  # of Prague
        rows = [
            f"{began + timedelta(seconds=30 * k):%Y-%m-%d %H:%M:%S},{4000 * (day == 0 and k < 130)}" for k in range(400)
        ]
        (folder / f"nc_2026030{2 + day}.csv").write_text("\n".join(["Time,S1 [rpm]", *rows, ""]), encoding="utf-8")
    (folder / "part.tdms").unlink()
    steps = np.repeat([1.0, 2.0, 1.0, 0.0, 1.0], 200) + np.random.default_rng(1).normal(0, 1e-3, 1000)
    tdms(folder / "jump_Z.tdms", {"jump": {"EC_Z": (steps, "V")}}, BEGAN - timedelta(hours=1), 0.1)


def test_a_day_of_one_group_is_a_test_beside_days_of_several(tmp_path: Path, say: Say) -> None:
    days_of_groups(tmp_path)
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    campaign, text = load_campaign(path), path.read_text()
    assert [t.id for t in campaign.tests] == ["heat", "cool", "axes", "idle", "mixed"]
    assert {c.signal for c in campaign.channels.values()} == {"T_front", "EC_Z", "S1 [rpm]"}
    assert list(campaign.sources) == ["daq", "nc", "jump"]
    assert "not used: jump_Z.tdms" not in text
    lines = {t.id: next(line for line in text.splitlines() if f"id: {t.id}," in line) for t in campaign.tests}
    assert all(
        f"nc: nc_2026030{2 + d}.csv" in lines[t] for t, d in (("heat", 0), ("cool", 0), ("axes", 1), ("mixed", 2))
    )
    assert "speed: 4000 rpm" in lines["heat"]
    assert "4000 rpm" not in lines["cool"]  # the control's day began with it
    path.write_text(text.replace("moves: unknown", "moves: [50 um, -50 um, -50 um, 50 um]"))
    store = ("--store", tmp_path / "s")
    assert say(*store, "ingest", path).code == 0
    asked = "select test, count(*) as n from sample where channel = 'EC_Z' group by test order by test"
    assert json.loads(say(*store, "sql", asked, "--json").out) == [
        {"test": t, "n": 360} for t in sorted(t.id for t in campaign.tests)
    ]


def ran(first_s: int, last_s: int, rows: int) -> Sample:
    return Sample(whole=True, first_ns=first_s * S, last_ns=last_s * S, rows=rows)


@pytest.mark.parametrize(
    ("spans", "recordings"),
    [
        (((0, 3600), (0, 3600)), 1),
        (((0, 3600), (1000, 4600)), 1),
        (((0, 3600), (3500, 7100)), 0),  # they overlap by little: clocks are not that good
        (((0, 3600), (3600, 7200)), 0),
        (((0, 3600), (5, 3600), (90_000, 93_600)), 0),  # a copied date makes no recording of all
        (((0, 3600), (5, 3600), (90_000, 93_600), (90_000, 93_600)), 2),
    ],
)
def test_each_must_have_run_while_another_did(spans: tuple[tuple[int, int], ...], recordings: int) -> None:
    samples = [ran(a, b, 100) for a, b in spans]
    assert recordings_in([a * S for a, _ in spans], samples) == recordings


def test_two_days_of_two_rates_are_asked(tmp_path: Path, say: Say) -> None:
    late = BEGAN + timedelta(days=1)
    days = {
        "Slow1": (BEGAN, 10.0, 20.0),
        "Fast1": (BEGAN, 1.0, 20.0),
        "Slow2": (late, 10.0, 20.0),
        "Fast2": (late, 1.0, 20.0),
    }
    one_file(tmp_path / "all.tdms", days)
    assert say("init", tmp_path).code == 0
    assert (
        "? it holds 2 recordings of several loggers or rates: a test each?" in (tmp_path / "campaign.yaml").read_text()
    )


@pytest.mark.parametrize(("rows", "last", "one"), [(300, 3600, True), (101, 3600, False), (300, 3500, False)])
def test_without_dates_equal_ends_at_other_rates_tell(rows: int, last: int, one: bool) -> None:
    assert bool(recordings_in([None, None], [ran(0, 3600, 100), ran(0, last, rows)])) is one


def logged(step_s: int, rows: int) -> list[list[object]]:
    head: list[object] = ["Time [s]", "T_front [degC]", "n [rpm]", "dZ [um]"]
    return [head, *([i * step_s, 20 + 0.01 * i, 4000 if i > 5 else 0, 0.1 * i] for i in range(rows))]


@pytest.mark.parametrize(
    ("names", "tests"),
    [
        (["S4000", "S8000", "S6000"], True),
        (["Test 1", "Test 2", "Test 3"], True),
        (["2026-03-02", "2026-03-03", "2026-03-04"], True),
        (["Slow", "Fast", "Middle"], False),
        (["Logger1", "Logger2", "Logger3"], False),
    ],
)
def test_sheets_of_seconds_that_end_alike_are_told_apart_by_name_or_asked(
    tmp_path: Path, say: Say, names: list[str], tests: bool
) -> None:
    rows = [logged(10, 361), logged(30, 121), logged(10, 361)]
    workbook(tmp_path / "book.xlsx", dict(zip(names, rows, strict=True)))
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    assert len(load_campaign(path).tests) == (3 if tests else 1)
    assert ("loggers or rates of one test, or a test each?" in path.read_text()) is not tests


@pytest.mark.parametrize(
    ("names", "tests"), [(("Left", "Right"), ["cold", "warm"]), (("S4000", "S8000"), ["S4000", "S8000"])]
)
def test_undated_groups_that_are_in_every_file_are_no_tests(
    tmp_path: Path, say: Say, names: tuple[str, str], tests: list[str]
) -> None:
    for test in ("warm", "cold"):
        workbook(tmp_path / f"{test}.xlsx", dict(zip(names, [logged(10, 361), logged(10, 361)], strict=True)))
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    assert sorted(t.id for t in load_campaign(path).tests) == tests
    assert ("'Left', 'Right' are in every file, and have no dates" in path.read_text()) is ("Left" in names)
