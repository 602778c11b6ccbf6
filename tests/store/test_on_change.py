"""A log that is written when something changes: what is commanded stands between its rows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.draft.make import draft_files
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.tidy.rows.on_change import Written, has_no_rate, with_steps, written_by_hand
from thermodata.store.tidy.rows.timeline import given_timeline
from thermodata.view import load_dataset

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  daq: {reader: table, files: "{test}_daq.csv"}
  plc: {reader: table, files: "{test}_plc.csv"}
channels:
  T_b: {source: daq, signal: T, quantity: temperature, unit: degC, at: spindle.bearing.front}
  n: {source: plc, signal: "n [rpm]", quantity: rotational_speed, unit: rpm, at: spindle}
tests:
  - {id: day, kind: spindle, role: calibration}
"""


def times(every_s: list[float]) -> object:
    return given_timeline((np.cumsum([0.0, *every_s]) * 1e9).astype(np.int64))


pytestmark = pytest.mark.usefixtures("installed_readers")


@pytest.mark.parametrize(
    ("every_s", "at_no_rate"),
    [
        ([1800.0, 9000.0], True),
        ([60.0, 1.0, 700.0, 3.0, 2000.0], True),
        ([60.0] * 50, False),
        ([60.0] * 40 + [7200.0] + [60.0] * 40, False),  # a pause is no change
        ([1.0, 1.1, 0.9, 2.0, 1.0, 1.0], False),
        ([3600.0], False),
    ],
)
def test_a_log_has_a_rate_or_none(every_s: list[float], at_no_rate: bool) -> None:
    assert has_no_rate(times(every_s)) is at_no_rate  # type: ignore[arg-type]


def test_a_speed_stands_between_the_rows_of_a_log_that_is_written_on_change(tmp_path: Path) -> None:
    minutes = range(240)
    rows = "".join(f"2026-05-11T{6 + m // 60:02d}:{m % 60:02d}:00Z;{20 + 0.01 * m}\n" for m in minutes)
    (tmp_path / "day_daq.csv").write_text("timestamp;T\n" + rows)
    (tmp_path / "day_plc.csv").write_text(
        "timestamp;n [rpm]\n2026-05-11T06:00:00Z;0\n2026-05-11T06:30:00Z;4000\n2026-05-11T09:00:00Z;0\n"
    )
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    store = Store(tmp_path / "s.store", create=True)
    summary = ingest(store, tmp_path / "campaign.yaml")
    assert [n for n in summary.notes if n.startswith("day, plc: n: rows come at no rate")]
    (test,) = load_dataset(store, "lab", 60.0).tests
    speed = test.values["n"]
    assert set(speed[:30]) == {0.0}
    assert set(speed[30:180]) == {4000.0}


SECOND = 10**9


@pytest.mark.parametrize(
    ("every_min", "values", "beside_s", "told"),
    [
        (60, [0, 2000, 4000, 6000, 0, 0], 30, "on change"),
        (30, [0, 0.5, 3.5, 0], 10, "on change"),
        (60, [0, 4500, 12500, 0], 30, "on change"),
        (60, [0, 5987, 3012, 0], 30, "asked"),  # read off a display, or measured
        (60, [3.47, 3.52, 3.49, 3.51], 30, None),  # a power that hardly changes
        (60, [0, 2000, 4000, 0], 0, None),  # nothing beside it is denser
        (60, [0, 2000, 4000, 0], 600, None),
        (0.5, [0, 2000, 4000, 0], 1, None),  # no person writes so fast
        (10, [0, 6000] + [6000] * 12 + [0], 10, None),  # a slow log at even times
        (10, [6000] * 3, 10, None),
    ],
)
def test_set_values_that_somebody_wrote_down_stand(
    every_min: float, values: list[float], beside_s: int, told: Written | None
) -> None:
    t_ns = (np.arange(len(values)) * every_min * 60 * SECOND).astype(np.int64)
    assert written_by_hand("rotational_speed", t_ns, np.array(values, float), beside_s * SECOND) == told
    assert written_by_hand("temperature", t_ns, np.array(values, float), beside_s * SECOND) is None


def of_hours(folder: Path, speeds: list[object], *, every_s: int = 60, held: str = "") -> tuple[list[str], list[float]]:
    """(the notes of its ingest, the speed of each minute) of a speed that was written at every hour."""
    n = len(speeds) * 3600 // every_s
    stamps = [f"2026-05-11T{6 + i * every_s // 3600:02d}:{i * every_s // 60 % 60:02d}:00Z" for i in range(n)]
    (folder / "day_daq.csv").write_text(
        "timestamp;T\n" + "".join(f"{t};{20 + 0.01 * i}\n" for i, t in enumerate(stamps))
    )
    rows = "".join(f"2026-05-11T{6 + i:02d}:00:00Z;{x}\n" for i, x in enumerate(speeds))
    (folder / "day_plc.csv").write_text("timestamp;n [rpm]\n" + rows)
    (folder / "campaign.yaml").write_text(CAMPAIGN.replace("unit: rpm, at: spindle", f"unit: rpm, at: spindle{held}"))
    store = Store(folder / "s.store", create=True)
    notes = [n for n in ingest(store, folder / "campaign.yaml").notes if n.startswith("day, plc: n: ")]
    (test,) = load_dataset(store, "lab", 60.0).tests
    return notes, test.values["n"].tolist()


def test_steps_that_were_typed_at_every_hour_stand(tmp_path: Path) -> None:
    notes, speed = of_hours(tmp_path, [0, 2000, 4000, 0, 0])
    assert "few set values" in notes[0]
    assert (speed[30], speed[90], speed[150], speed[200]) == (0.0, 2000.0, 4000.0, 0.0)


def test_steps_of_no_set_values_are_asked_and_the_answer_counts(tmp_path: Path) -> None:
    notes, speed = of_hours(tmp_path, [0, 1987, 4031, 0, 0])
    assert "held: true" in notes[0]
    assert 993 < speed[30] < 1020
    for word, at_half in (("true", 0.0), ("false", 1010.0)):
        own = tmp_path / word
        own.mkdir()
        notes, speed = of_hours(own, [0, 1987, 4031, 0, 0], held=f", held: {word}")
        assert not notes
        assert speed[30] == pytest.approx(at_half, abs=20)


def test_where_all_is_logged_slowly_nothing_is_held(tmp_path: Path) -> None:
    notes, speed = of_hours(tmp_path, [0, 2000, 4000, 0, 0], every_s=1800)
    assert not notes
    assert 990 < speed[30] < 1040


def test_many_rows_at_even_times_are_a_clocks_and_asked_for() -> None:
    """Three hours of a row a minute; a day of hours, and hours at uneven minutes, somebody may have written."""
    sawtooth = np.arange(180) % 11 * 30.0
    even = np.arange(180, dtype=np.int64) * 60 * SECOND
    assert written_by_hand("position", even, sawtooth, SECOND) == "asked"
    assert written_by_hand("position", even[:24], sawtooth[:24], SECOND) == "on change"
    uneven = even + np.arange(180) % 7 * SECOND
    assert written_by_hand("position", uneven, sawtooth, SECOND) == "on change"


def on_change_beside_a_dense_log(folder: Path, behind_s: float) -> Path:
    """Two hours of a speed every 10 s, and the same on a clock that is behind, a row where something changed: the speed
    or, at no rate, something else."""
    rng = np.random.default_rng(3)
    t = np.arange(0, 7200, 10)
    speeds = np.array([0, 5000, 3000, 8000, 0, 6000, 0])
    edges = np.array([0, 903, 2111, 2987, 4019, 5203, 6307])
    x = speeds[np.searchsorted(edges, t, "right") - 1]
    at = np.unique(np.concatenate([edges, rng.uniform(0, 7000, 40).round(), [7190]]))
    rows = speeds[np.searchsorted(edges, at, "right") - 1]
    day = np.datetime64("2026-03-02T08:00:00.000")
    dense = [f"{day + int(s * 1000)}Z,{v:.3f},{20 + s / 3600:.2f}" for s, v in zip(t, x, strict=True)]
    own = [f"{day + int((s - behind_s) * 1000)}Z,{v:.3f}" for s, v in zip(at, rows, strict=True)]
    folder.mkdir(exist_ok=True)
    (folder / "day_daq.csv").write_text("\n".join(["time,n [rpm],T", *dense, ""]))
    (folder / "day_plc.csv").write_text("\n".join(["time,n [rpm]", *own, ""]))
    return folder


@pytest.mark.parametrize("here", ["plc", "daq"])
def test_a_clock_is_aligned_by_the_steps_of_a_log_on_change(tmp_path: Path, here: str) -> None:
    """Straight from row to row, each step lies half a pause of minutes early."""
    folder = on_change_beside_a_dense_log(tmp_path / "lab", 770.0)
    there, pair = ("daq", "{here: n, there: n_daq}") if here == "plc" else ("plc", "{here: n_daq, there: n}")
    text = CAMPAIGN.replace(
        f'files: "{{test}}_{here}.csv"', f'files: "{{test}}_{here}.csv", clock: {{align_to: {there}, by: [{pair}]}}'
    ).replace("tests:", '  n_daq: {source: daq, signal: "n [rpm]", quantity: rotational_speed, unit: rpm}\ntests:')
    (folder / "campaign.yaml").write_text(text)
    store = Store(tmp_path / "s", create=True)
    ingest(store, folder / "campaign.yaml")
    with store.reader() as con:
        ((offset,),) = con.execute("select offset_ns from source where source = ?", [here]).fetchall()
    assert offset / 1e9 == pytest.approx(770.0 if here == "plc" else -770.0, abs=6.0)  # a step is seen up to 10 s late


def test_a_draft_proposes_the_clock_by_the_same_steps(tmp_path: Path) -> None:
    folder = on_change_beside_a_dense_log(tmp_path / "lab", 770.0)
    for name, head in {
        "daq": "time,Spindle speed [rpm],T_bed [degC]",
        "plc": "Timestamp,S1 actual speed [rpm]",
    }.items():
        rows = (folder / f"day_{name}.csv").read_text().split("\n", 1)[1]
        (folder / f"day_{name}.csv").write_text(f"{head}\n{rows}")
    (found,) = [s.align for s in draft_files(folder).draft.sources if s.align is not None]
    assert found.offset_s is not None
    assert abs(found.offset_s) == pytest.approx(770.0, abs=6.0)


def test_rows_stand_until_just_before_the_next_one() -> None:
    t = np.array([0, 60, 61, 200]) * 10**9
    found, values = with_steps(t, np.array([1.0, 1.0, 2.0, 3.0]))
    assert (found / 1e9).tolist() == [0, 59, 60, 61, 199, 200]
    assert values.tolist() == [1, 1, 1, 2, 2, 3]


def test_a_log_that_is_written_on_change_ends_with_its_last_row(tmp_path: Path) -> None:
    """Its median step says nothing of how long it lasts."""
    minutes = range(240)
    rows = "".join(f"2026-05-11T{6 + m // 60:02d}:{m % 60:02d}:00Z;{20 + 0.01 * m}\n" for m in minutes)
    (tmp_path / "day_daq.csv").write_text("timestamp;dZ [um]\n" + rows)
    changes = [(h, s) for h in (6, 7, 8) for s in range(20)] + [(9, 58 * 60)]  # every second, for a while each hour
    (tmp_path / "day_plc.csv").write_text(
        "timestamp;n [rpm]\n" + "".join(f"2026-05-11T{h:02d}:{s // 60:02d}:{s % 60:02d}Z;{s}\n" for h, s in changes)
    )
    probe = "quantity: displacement, unit: um, axis: Z, at: tcp, relative_to: table"
    (tmp_path / "campaign.yaml").write_text(
        CAMPAIGN.replace(
            "T_b: {source: daq, signal: T, quantity: temperature, unit: degC, at: spindle.bearing.front}",
            f'dZ: {{source: daq, signal: "dZ [um]", {probe}}}',
        )
    )
    notes = ingest(Store(tmp_path / "store", create=True), tmp_path / "campaign.yaml").notes
    assert not [n for n in notes if "long before" in n]
    assert not [n for n in ingest(Store(tmp_path / "store"), tmp_path / "campaign.yaml").notes if "long before" in n]
