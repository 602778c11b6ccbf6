"""A rule for when a test measures: drafted where a position or a state moves exactly with the probes' range."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from tests.draft.labs import numbers, text
from thermodata.schema.files.load import load_campaign


def cycles(folder: Path, *, state: bool, rail: float | None = 1999.0, shift: int = 0) -> None:
    """A spindle that comes to its probe for 2 of 12 minutes. rail: the probe's reading beyond its range, None: none.
    shift: rows by which the position is late, so that it tells nothing."""
    n = 720
    t = np.arange(n) * 10.0
    at_probe = (np.arange(n) // 12) % 6 == 0
    growth = 40 * (1 - np.exp(-t / 2000)) + np.random.default_rng(1).normal(0, 0.2, n)
    shown = [
        f"{g:.2f}" if here else "" if rail is None else f"{rail:g}" for g, here in zip(growth, at_probe, strict=True)
    ]
    where = np.roll(at_probe, shift)
    position = np.where(where, 210.0, 400 + 150 * np.sin(np.arange(n) / 3))
    columns = [numbers(t, 0), shown, numbers(position, 3), numbers(20 + t / 3000, 2)]
    header = ["t [s]", "Z [um]", "pos Z [mm]", "T nut Z [degC]"]
    if state:
        columns[2] = [f"{int(w)}" for w in where]
        header[2] = "probing active"
    text(folder / "feed_z.csv", header, columns, mark=",")


@pytest.mark.parametrize("rail", [1999.0, None])
def test_a_position_that_goes_with_the_range_is_a_rule(rail: float | None, tmp_path: Path, say: Say) -> None:
    cycles(tmp_path / "lab", state=False, rail=rail)
    say("init", tmp_path / "lab")
    path = tmp_path / "lab" / "campaign.yaml"
    rule = load_campaign(path).tests[0].measuring
    assert isinstance(rule, str)
    assert rule.startswith("abs(pos_Z - 210) < ")
    assert float(rule.rsplit(" ", 1)[1]) < 40  # the axis is never nearer elsewhere
    assert "measuring guess: exactly then the probes are in range" in path.read_text("utf-8")
    store = ("--store", tmp_path / "s")
    say(*store, "ingest", path)
    asked = (
        "select count(*) as n, max(value) as high from sample where channel = 'Z' and flag & 128 = 0 and value < 1000"
    )
    row = json.loads(say(*store, "sql", asked, "--json").out)[0]
    assert row["n"] == 120
    assert row["high"] < 60


@pytest.mark.parametrize(("moves", "ruled"), [(True, True), (False, False)])
def test_a_feed_that_stands_while_the_probe_has_a_reading_is_a_rule(
    moves: bool, ruled: bool, tmp_path: Path, say: Say
) -> None:
    """moves: the axis feeds whenever the probe has none, else half of the time."""
    cycles(tmp_path, state=True)
    path = tmp_path / "feed_z.csv"
    header, *rows = path.read_text("utf-8").splitlines()
    cells = [row.split(",") for row in rows]
    feeds = [0 if row[2] == "1" or (not moves and k % 2) else 8000 for k, row in enumerate(cells)]
    lines = [",".join([*row[:2], str(f), row[3]]) for row, f in zip(cells, feeds, strict=True)]
    path.write_text("\n".join([header.replace("probing active", "feed Z [mm/min]"), *lines, ""]), "utf-8")
    say("init", tmp_path)
    assert load_campaign(tmp_path / "campaign.yaml").tests[0].measuring == ("feed_Z == 0" if ruled else None)


def test_a_state_that_goes_with_the_range_is_a_rule(tmp_path: Path, say: Say) -> None:
    cycles(tmp_path, state=True)
    say("init", tmp_path)
    assert load_campaign(tmp_path / "campaign.yaml").tests[0].measuring == "probing_active == 1"


@pytest.mark.parametrize(
    ("name", "passes", "early", "ruled"),
    [
        ("AtProbe", 0, 0, True),  # a switch by its values alone
        ("AtProbe", 2, 0, True),  # the probe is in range on the way there and back as well
        ("Valve 7", 0, 0, True),
        ("Valve 7", 2, 0, False),
        ("AtProbe", 0, 2, False),  # it says so before the probe is in range
    ],
)
def test_a_switch_by_its_values_or_its_name_is_a_rule(
    name: str, passes: int, early: int, ruled: bool, tmp_path: Path, say: Say
) -> None:
    """passes: rows before and behind a measurement in which the probe is in range; early: rows of out of range in which
    the switch is on."""
    n = 720
    t = np.arange(n) * 10.0
    row = np.arange(n) % 72
    growth = 40 * (1 - np.exp(-t / 2000)) + np.random.default_rng(1).normal(0, 0.2, n)
    shown = [f"{g:.2f}" if 20 - passes <= r < 32 + passes else "500.00" for g, r in zip(growth, row, strict=True)]
    on = [f"{int(20 - early <= r < 32)}" for r in row]
    columns = [numbers(t, 0), shown, on, numbers(20 + t / 3000, 2)]
    text(tmp_path / "work.csv", ["t [s]", "W_Z [um]", name, "T nut Z [degC]"], columns, mark=",")
    say("init", tmp_path)
    rule = f"{name.replace(' ', '_')} == 1"
    assert load_campaign(tmp_path / "campaign.yaml").tests[0].measuring == (rule if ruled else None)
    by_name = "measuring guess: by its name, and no probe is out of range then"
    assert (by_name in (tmp_path / "campaign.yaml").read_text("utf-8")) is (ruled and bool(passes))


def test_a_position_that_goes_its_own_way_is_no_rule(tmp_path: Path, say: Say) -> None:
    cycles(tmp_path, state=False, shift=5)
    say("init", tmp_path)
    assert load_campaign(tmp_path / "campaign.yaml").tests[0].measuring is None


def test_a_machine_at_rest_beside_a_rail_has_its_rule(tmp_path: Path, say: Say) -> None:
    """Growth of 3 um beside a rail of 2500 um: both ends are one reading, the rail the exact one."""
    n = 720
    t = np.arange(n) * 10.0
    here = (np.arange(n) // 6) % 10 == 0
    growth = 3 * np.sin(t / 2000) + np.random.default_rng(2).normal(0, 0.2, n)
    shown = [f"{g:.2f}" if h else "2500.00" for g, h in zip(growth, here, strict=True)]
    where = np.where(here, 0.0, 500.0)
    columns = [numbers(t, 0), shown, numbers(where, 1), numbers(20 + t / 3000, 2)]
    text(tmp_path / "ETVE.csv", ["t [s]", "Z [um]", "pos Z [mm]", "T nut Z [degC]"], columns, mark=",")
    say("init", tmp_path)
    assert str(load_campaign(tmp_path / "campaign.yaml").tests[0].measuring).startswith("abs(pos_Z - 0) < ")


def two_logs(folder: Path, *, late_s: int = 0) -> None:
    """Probes at 10 V with their converter's noise while axes feed or the table turns; a control logs these, an hour
    ahead by its local time. late_s: by which its clock is off besides."""
    rng = np.random.default_rng(6)
    for test, fed in (("X40", "X"), ("mix", "XYB")):
        n = 1440
        cycle = np.arange(n) // 120
        here = np.arange(n) % 120 < 24
        volts = np.where(here, 4.5 + np.arange(n) / 9000 + rng.normal(0, 0.003, n), 10 + rng.normal(0, 0.0008, n))
        times = np.datetime64("2026-03-04T06:25:00") + np.arange(n) * np.timedelta64(5, "s")
        columns = [[f"{t}Z" for t in times], numbers(volts, 4), numbers(21 + np.arange(n) / 900, 2)]
        text(folder / "daq" / f"{test}.csv", ["time", "Probe X1 [V]", "Bed [degC]"], columns, mark=",")
        there = times[::2] + np.timedelta64(3600 + late_s, "s")
        moves = {axis: (~here & (cycle % len(fed) == k))[::2] for k, axis in enumerate(fed)}
        none = np.zeros(n // 2, dtype=bool)
        driven = [numbers(np.where(moves.get(axis, none), 8000, 0), 0) for axis in "XYB"]
        columns = [[str(t).replace("T", " ") for t in there], *driven]
        head = ["time", "feed X [mm/min]", "feed Y [mm/min]", "speed table B [1/min]"]
        text(folder / "nc" / f"{test}.csv", head, columns, mark=",")


@pytest.mark.parametrize(("late_s", "ruled"), [(0, True), (60, False)])
def test_feeds_in_the_log_of_another_source_are_a_rule(late_s: int, ruled: bool, tmp_path: Path, say: Say) -> None:
    """All that move while the probe stands at its end, be it in its converter's noise."""
    two_logs(tmp_path, late_s=late_s)
    say("init", tmp_path)
    campaign = load_campaign(tmp_path / "campaign.yaml")
    rules = {t.id: t.measuring for t in campaign.tests}
    names = [c for c in campaign.channels if c.startswith(("feed", "speed"))]
    expected = {"X40": "feed_X == 0", "mix": " and ".join(f"{n} == 0" for n in names)}
    assert rules == (expected if ruled else dict.fromkeys(expected))


def by_one_speed(folder: Path, *, late_s: int, logged: tuple[str, ...], passes: bool = False) -> None:
    """Probes at 500 um between visits of 40 s to them, and a control by a clock of its own that logs the same spindle.
    logged: its columns beside; passes: each axis stands at its own point at other times too, no two of them at once."""
    rng = np.random.default_rng(8)
    n = 2880
    row = np.arange(n) % 60
    here = row < 4
    starts = np.searchsorted([300, 470, 900, 1020, 1500, 1730, 2300, 2420], np.arange(n), side="right")
    speed = np.array([0, 3000, 0, 5200, 0, 4100, 0, 6000, 0])[starts]
    shown = np.where(here, 20 + np.arange(n) / 300 + rng.normal(0, 0.2, n), 500.0)
    times = np.datetime64("2026-03-04T06:25:00") + np.arange(n) * np.timedelta64(10, "s")
    columns = [[f"{t}Z" for t in times], numbers(shown, 3), numbers(speed + rng.normal(0, 1, n), 0)]
    text(folder / "daq" / "work.csv", ["time", "Probe Z [um]", "tacho [1/min]"], columns, mark=",")
    away = {axis: ~here & ~(passes & (row // 12 == k + 1)) for k, axis in enumerate("XYZ")}
    course = {f"pos {axis} [mm]": np.where(away[axis], 300 + 40 * np.sin(np.arange(n) / 3), 200) for axis in "XYZ"}
    course |= {"feed X [mm/min]": np.where(here, 0, 8000)}
    clock = [str(t + np.timedelta64(late_s, "s")).replace("T", " ") for t in times]
    columns = [clock, numbers(speed, 0), *(numbers(course[name], 2) for name in logged)]
    text(folder / "nc" / "work.csv", ["time", "spindle speed [1/min]", *logged], columns, mark=",")


@pytest.mark.parametrize(
    ("logged", "passes", "parts"),
    [
        (("feed X [mm/min]",), False, ("feed_X == 0",)),
        (("pos X [mm]",), False, ("abs(pos_X - 200) < ",)),
        (("pos X [mm]", "pos Y [mm]"), True, ("abs(pos_X - 200) < ", "abs(pos_Y - 200) < ")),
        (("pos X [mm]",), True, ()),
    ],
)
@pytest.mark.parametrize("late_s", [0, -468, 3600 + 293])
def test_a_control_whose_clock_is_guessed_has_a_rule(
    logged: tuple[str, ...], passes: bool, parts: tuple[str, ...], late_s: int, tmp_path: Path, say: Say
) -> None:
    by_one_speed(tmp_path, late_s=late_s, logged=logged, passes=passes)
    say("init", tmp_path)
    rule = load_campaign(tmp_path / "campaign.yaml").tests[0].measuring
    found = str(rule).split(" and ") if rule else []
    assert len(found) == len(parts)
    assert all(one.startswith(part) for one, part in zip(found, parts, strict=True))
