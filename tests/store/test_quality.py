"""Quality of whole tests in the store: sensors that fail between tests, idle probes, clocks with faults."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from store_fakes import START_NS, write_campaign, write_log

from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

DAYS = (
    """
schema: thermodata/campaign/1
id: days
machine: {id: m}
sources:
  daq: {reader: npz, files: "raw/{test}.npz"}
channels:
"""
    + "".join(f"  T_{i}: {{source: daq, signal: T{i}, quantity: temperature, unit: degC}}\n" for i in range(5))
    + """
tests:
  - {id: day1, kind: spindle}
  - {id: day2, kind: spindle}
  - {id: day3, kind: spindle}
"""
)
# one recording, whose beginning is the history of the second test
IN_TWO = (
    DAYS[: DAYS.index("tests:")]
    + """tests:
  - {id: early, kind: spindle, files: {daq: raw/day.npz}, window: [0 s, 6000 s], history: recording}
  - {id: late, kind: spindle, files: {daq: raw/day.npz}, window: [6000 s, 17990 s], history: recording}
"""
)
N = 600


def day(number: int, **off: float) -> dict[str, dict[str, Any]]:
    rng = np.random.default_rng(number)
    t = START_NS + number * 86_400 * 10**9 + np.arange(N, dtype=np.int64) * 30 * 10**9
    rise = 1 - np.exp(-np.arange(N) / 100)
    return {
        "main": {
            "t_ns": t,
            **{f"T{i}": 22 + 4 * i * rise + rng.normal(0, 0.05, N) + off.get(f"T{i}", 0.0) for i in range(5)},
        }
    }


def flags(store: Store, channel: str) -> list[tuple[str, int]]:
    with store.reader() as con:
        return con.execute(
            "select test, bit_and(flag) from sample where channel = ? group by 1 order by 1", [channel]
        ).fetchall()


def test_what_came_before_a_window_is_told_of_one_test_as_it_is_counted(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab", IN_TWO, logs=False)
    log = day(1)
    for at in (50, 120, 300):
        log["main"]["T1"][at] += 15.0
    write_log(path.parent / "raw/day.npz", log)
    assert ingest(store, path).flags == {"spike": 3}
    with store.reader() as con:
        told = con.execute("select test, flag, sum(n) from quality group by all order by 1").fetchall()
    assert told == [("early", "spike", 2), ("late", "spike", 1)]


def test_a_gap_before_a_window_is_one_of_the_test_in_which_it_is(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab", IN_TWO, logs=False)
    log = day(1)
    kept = np.r_[0:60, 110:N]
    log["main"] = {name: values[kept] for name, values in log["main"].items()}
    write_log(path.parent / "raw/day.npz", log)
    ingest(store, path)
    with store.reader() as con:
        assert con.execute("select distinct test from gap").fetchall() == [("early",)]


def test_a_sensor_that_failed_between_two_days_is_flagged_from_then_on(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab", DAYS, logs=False)
    for number in (1, 2):
        write_log(path.parent / f"raw/day{number}.npz", day(number))
    write_log(path.parent / "raw/day3.npz", day(3, T2=30.0))
    assert ingest(store, path).losses == []
    assert flags(store, "T_2") == [("day1", 0), ("day2", 0), ("day3", Flag.OFFSET)]
    assert flags(store, "T_3") == [("day1", 0), ("day2", 0), ("day3", 0)]
    with store.reader() as con:
        events = con.execute("select test, channel, flag, n, detail from quality").fetchall()
    assert [e[:4] for e in events] == [("day3", "T_2", "offset", N)]
    assert events[0][4].startswith("+30")
    again = ingest(store, path)
    assert (again.changed, again.losses) == (False, [])
    # the sensor was changed for a sound one and the day measured again: nothing of the verdict stays
    write_log(path.parent / "raw/day3.npz", day(3))
    assert ingest(store, path).losses == []
    assert flags(store, "T_2") == [("day1", 0), ("day2", 0), ("day3", 0)]


def test_a_probe_out_of_reach_while_the_axis_moves_is_one_event_that_says_so(store: Store, tmp_path: Path) -> None:
    text = DAYS.replace(
        "channels:\n",
        "channels:\n  pos: {source: daq, signal: pos, quantity: position, unit: mm}\n"
        "  dZ: {source: daq, signal: dZ, quantity: displacement, unit: um, "
        "sensor: {range: [-200 um, 200 um]}}\n",
    )
    text = text.replace("{id: day1, kind: spindle}", '{id: day1, kind: linear_axis, measuring: "pos < 1 mm"}')
    path = write_campaign(tmp_path / "lab", text, logs=False)
    log = day(1)
    moves = np.arange(N) % 60 >= 30
    log["main"]["pos"] = np.where(moves, 400.0, 0.0)
    log["main"]["dZ"] = np.where(moves, 200.0, np.random.default_rng(0).normal(0, 1, N))
    log["main"]["dZ"][10] = 200.0  # and once where it does measure
    write_log(path.parent / "raw/day1.npz", log)
    for number in (2, 3):
        write_log(
            path.parent / f"raw/day{number}.npz",
            log | {"main": log["main"] | {"t_ns": log["main"]["t_ns"] + number * 86_400 * 10**9}},
        )
    ingest(store, path)
    with store.reader() as con:
        events = con.execute(
            "select flag, n, detail from quality where test = 'day1' and channel = 'dZ' order by from_s"
        ).fetchall()
    assert [(flag, n) for flag, n, _ in events if flag == "saturated"] == [("saturated", 1), ("saturated", 300)]
    assert events[-1][2] == "only while not measuring"


def test_faults_of_a_clock_are_flagged_and_listed(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab", DAYS, logs=False)
    stray, server, battery = day(1), day(2), day(3)
    stray["main"]["t_ns"][200] += 10**17
    server["main"]["t_ns"][300:] -= 90 * 10**9
    battery["main"]["t_ns"][:100] -= START_NS
    for name, log in (("day1", stray), ("day2", server), ("day3", battery)):
        write_log(path.parent / f"raw/{name}.npz", log)
    summary = ingest(store, path)
    assert summary.losses == []
    with store.reader() as con:
        events = con.execute("select test, flag, n, detail from quality where flag = 'clock_suspect'").fetchall()
        rows = con.execute(
            "select test, count(*), max(t_s), min(epoch_ns(t)) from sample where channel = 'T_0' group by 1 order by 1"
        ).fetchall()
    assert [(e[0], e[2]) for e in sorted(events)] == [("day1", 1), ("day2", 1), ("day3", 1)]
    assert [(r[1], r[2]) for r in rows] == [(N, (N - 1) * 30.0)] * 3
    assert rows[2][3] == START_NS + 3 * 86_400 * 10**9
    assert "set ahead" in " ".join(summary.notes)
