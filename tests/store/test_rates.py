"""Feeds derived from the position that an axis logged: `rate(x_pos)`, from the file to the bins of a fit."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from thermodata.errors import UsageError
from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.ingest.summary import IngestSummary
from thermodata.store.tidy.flags.in_windows import windows
from thermodata.store.trace.lineage import trace
from thermodata.store.trace.replan import read_series
from thermodata.view import load_dataset

pytestmark = pytest.mark.usefixtures("installed_readers")

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  plc: {reader: table, files: "{test}_plc*.csv"}
channels:
  x_pos: {source: plc, signal: "x [mm]", quantity: position, unit: mm, at: axis.x}
  T_nut: {source: plc, signal: "T [degC]", quantity: temperature, unit: degC, at: axis.x.nut}
  v: {derive: rate(x_pos), quantity: feed, unit: m/min, at: axis.x}
tests:
  - {id: day, kind: linear_axis, role: calibration}
"""
STROKE_MM, STROKE_S = 400.0, 8


def _write(path: Path, t_s: Sequence[float], x_mm: Sequence[float]) -> None:
    """A log of positions, NaN for an empty cell, beside a temperature."""
    begin = np.datetime64("2026-05-11T06:00:00.000")
    stamps = begin + np.round(np.asarray(t_s) * 1000).astype("timedelta64[ms]")
    cells = ["" if np.isnan(x) else f"{x:.4f}" for x in x_mm]
    rows = [f"{t}Z;{x};{20 + 0.01 * (i % 7):.2f}" for i, (t, x) in enumerate(zip(stamps, cells, strict=True))]
    path.parent.mkdir(exist_ok=True)
    path.write_text("timestamp;x [mm];T [degC]\n" + "\n".join(rows) + "\n")


def _to_and_fro(t_s: np.ndarray) -> np.ndarray:
    """A triangle of strokes: 50 mm/s, 3 m/min."""
    return STROKE_MM * np.abs((t_s / STROKE_S) % 2 - 1)


def _ingest(folder: Path, text: str = CAMPAIGN) -> tuple[Store, IngestSummary]:
    (folder / "campaign.yaml").write_text(text)
    store = Store(folder / "s.store", create=True)
    return store, ingest(store, folder / "campaign.yaml")


def _stored(store: Store, channel: str = "v", test: str = "day") -> dict[str, Any]:
    with store.reader() as con:
        found = con.execute(
            "select t_s, value, flag from sample where channel = ? and test = ? order by t_s", [channel, test]
        ).fetchnumpy()
    return {k: np.ma.filled(x.astype(float), np.nan) if k != "flag" else x for k, x in found.items()}


def test_an_axis_that_goes_to_and_fro_has_its_feed(tmp_path: Path) -> None:
    t_s = np.arange(0, 600.0)
    _write(tmp_path / "day_plc.csv", t_s, _to_and_fro(t_s))
    store, summary = _ingest(tmp_path)
    assert not summary.losses
    assert not [n for n in summary.notes if "too small" in n], "it turns at its samples"
    found = _stored(store)
    np.testing.assert_allclose(np.abs(found["value"]), 3.0, rtol=1e-6)
    np.testing.assert_allclose(found["value"][:8], -3.0)
    assert not found["flag"].any()
    (test,) = load_dataset(store, "lab", 60.0).tests
    np.testing.assert_allclose(test.values["v"], 3.0, rtol=1e-6)  # the mean of its size
    ingest(store, tmp_path / "campaign.yaml")
    assert trace(store, "lab", "day", "v")["derive"] == "rate(x_pos)"


@pytest.mark.parametrize(("late_s", "slow"), [(0.25, 1.0), (0.5, 1.0), (0.5, 5.0)])
def test_what_is_lost_where_an_axis_turns_is_told_of_its_test(tmp_path: Path, late_s: float, slow: float) -> None:
    t_s = np.arange(0, 600.0)
    _write(tmp_path / "day_plc.csv", t_s, _to_and_fro((t_s + late_s) * slow))
    store, summary = _ingest(tmp_path)
    (told,) = [n for n in summary.notes if "too small" in n]
    if slow > STROKE_S / 2:
        assert "nobody can tell" in told
        return
    lost = 1 - np.nanmean(np.abs(_stored(store)["value"])) / (3.0 * slow)
    assert f"in this test {100 * lost:.0f} % too small" in told


def test_a_rate_traces_to_the_two_rows_that_it_is_of(tmp_path: Path) -> None:
    t_s = np.arange(0, 60.0)
    _write(tmp_path / "day_plc.csv", t_s, _to_and_fro(t_s))
    more = CAMPAIGN.replace("tests:", '  heat: {derive: "abs(v) / 1 m/min", quantity: load, at: axis.x}\ntests:')
    store, _ = _ingest(tmp_path, more)
    for channel, at_s, rows in (("v", 20.0, [20, 21]), ("v", 59.0, [58, 59]), ("heat", 0.0, [0, 1])):
        sample = trace(store, "lab", "day", channel, at_s)["sample"]
        assert [(o["channel"], o["row"]) for o in sample["operands"]] == [("x_pos", r) for r in rows]


def test_nothing_is_drawn_over_gaps_and_empty_cells(tmp_path: Path) -> None:
    t_s = np.concatenate([np.arange(0, 100.0), np.arange(400, 500.0)])
    x = np.clip(_to_and_fro(t_s), 75, 325)  # it rests at both ends
    x[50] = np.nan
    _write(tmp_path / "day_plc.csv", t_s, x)
    found = _stored(_ingest(tmp_path)[0])
    v, flags = found["value"], found["flag"].astype(int)
    with_next = np.append(np.diff(x) * 60 / 1000, np.nan)
    near = [49, 50, 99, 199]
    np.testing.assert_allclose(np.delete(v, near), np.delete(with_next, near), atol=1e-9)
    assert v[49] == pytest.approx((x[51] - x[49]) / 2 * 60 / 1000)  # over the empty cell
    assert np.isnan(v[50])
    assert flags[50] & (Flag.NOT_MEASURING | Flag.OUT_OF_RANGE)
    np.testing.assert_allclose(v[[99, 199]], v[[98, 198]])  # and not over the pause of five minutes


def test_both_samples_of_a_rate_count_by_their_flags(tmp_path: Path) -> None:
    t_s = np.arange(0, 60.0)
    x = np.clip(_to_and_fro(t_s), 75, 325)
    _write(tmp_path / "day_plc.csv", t_s, x)
    ranged = CAMPAIGN.replace("unit: mm, at: axis.x}", "unit: mm, at: axis.x, sensor: {range: [0 mm, 310 mm]}}")
    found = _stored(_ingest(tmp_path, ranged)[0])
    beyond = x > 310.5
    either = beyond | np.append(beyond[1:], beyond[-2])
    np.testing.assert_array_equal((found["flag"].astype(int) & (Flag.OUT_OF_RANGE | Flag.SATURATED)) != 0, either)


def test_a_joint_of_files_and_a_window_within_a_recording_make_no_difference(tmp_path: Path) -> None:
    t_s = np.arange(0, 1200.0)
    x = _to_and_fro(t_s)
    _write(tmp_path / "one/day_plc.csv", t_s, x)
    whole = _stored(_ingest(tmp_path / "one")[0])
    for k, (a, b) in enumerate(((0, 401), (401, 402), (402, 1200))):
        _write(tmp_path / f"many/day_plc_{k}.csv", t_s[a:b], x[a:b])
    np.testing.assert_array_equal(_stored(_ingest(tmp_path / "many")[0])["value"], whole["value"])
    _write(tmp_path / "cut/day_plc.csv", t_s, x)
    cut = CAMPAIGN.replace("role: calibration", "role: calibration, window: [5 min, 15 min], history: recording")
    store = _ingest(tmp_path / "cut", cut)[0]
    found = _stored(store)
    np.testing.assert_array_equal(found["value"][found["t_s"] >= 0], whole["value"][300:900])
    early = found["value"][found["t_s"] < 0]
    np.testing.assert_array_equal(early, whole["value"][300 - len(early) : 300])


def test_a_log_that_is_written_in_windows_has_the_same_rates(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    t_s = np.arange(0, 3000.0) + 0.3 * np.sin(np.arange(3000))
    _write(tmp_path / "one/day_plc.csv", t_s, _to_and_fro(t_s))
    _write(tmp_path / "cut/day_plc.csv", t_s, _to_and_fro(t_s))
    whole = _stored(_ingest(tmp_path / "one")[0])
    monkeypatch.setattr(windows, "WINDOW_ROWS", 100)
    monkeypatch.setattr(windows, "MARGIN_ROWS", 7)
    monkeypatch.setattr("thermodata.store.tidy.writer.group_rows", lambda columns: 37)
    cut = _stored(_ingest(tmp_path / "cut")[0])
    np.testing.assert_array_equal(cut["value"], whole["value"])


@pytest.fixture(scope="module")
def uneven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log with gaps, empty cells, rows at one time and rows out of order, and one written on change."""
    folder = tmp_path_factory.mktemp("uneven")
    rng = np.random.default_rng(3)
    steps = rng.choice([0.0, 0.5, 1.0, 1.0, 1.0, 30.0], 400)
    t_s, x = np.cumsum(steps), np.round(rng.uniform(0, 300, 400), 1)
    x[rng.choice(400, 40, replace=False)] = np.nan
    t_s[[100, 101]] = t_s[[101, 100]]
    _write(folder / "day_plc.csv", t_s, x)
    return folder


@pytest.fixture(scope="module")
def series_of(uneven: Path) -> Any:
    """Opens the series of the log, once as it is and once as written on change."""
    from thermodata.reader.finding import registry
    from thermodata.store.ingest.reading import campaign_files

    made = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(campaign_files, "find_reader", registry.reader)
        for held in ("false", "true"):
            folder = uneven / held
            folder.mkdir()
            (folder / "day_plc.csv").write_text((uneven / "day_plc.csv").read_text())
            store, _ = _ingest(folder, CAMPAIGN.replace("unit: mm, at", f"unit: mm, held: {held}, at"))
            with store.reader() as con:
                made[held] = read_series(con, store.path, "lab", "day")
    return made


@given(cuts=st.sets(st.integers(1, 399)), held=st.sampled_from(["false", "true"]))
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_it_makes_no_difference_where_a_stream_is_cut(series_of: Any, cuts: set[int], held: str) -> None:
    series = series_of[held]
    bound = series.plan.bound["v"]
    rows = series.timeline((bound.source, bound.stream)).rows
    whole, marks = series.values(bound, 0, rows)
    ends = [0, *sorted(c for c in cuts if c < rows), rows]
    parts = [series.values(bound, a, b) for a, b in pairwise(ends)]
    np.testing.assert_array_equal(np.concatenate([v for v, _ in parts]), whole)
    np.testing.assert_array_equal(np.concatenate([f for _, f in parts]), marks)
    assert 0 < np.isnan(whole).sum() < rows / 2


def test_positions_written_on_change_stand_in_between(tmp_path: Path) -> None:
    # by 0.2 s while the axis moves, one stroke of 4 s every minute, and nothing while it stands
    moving = np.arange(0, 4.01, 0.2)
    t_s = np.concatenate([60 * k + moving for k in range(20)])
    x = np.concatenate([(200 * moving / 4)[:: 1 if k % 2 == 0 else -1] for k in range(20)])
    _write(tmp_path / "day_plc.csv", t_s, x)
    store, summary = _ingest(tmp_path)
    v = _stored(store)["value"].reshape(20, -1)
    np.testing.assert_allclose(np.abs(v[:, :-1]), 3.0, rtol=1e-6)
    np.testing.assert_array_equal(v[:, -1], 0.0)
    (test,) = load_dataset(store, "lab", 60.0).tests
    np.testing.assert_allclose(np.abs(test.values["v"][:19]), 3.0 * 4 / 60, rtol=1e-3)
    assert any("v: the rate of what was written on change" in n for n in summary.notes)


def test_positions_that_somebody_wrote_down_move_nothing(tmp_path: Path) -> None:
    t_s = 1200.0 * np.arange(12)
    _write(tmp_path / "day_plc.csv", t_s, np.where(np.arange(12) % 2, 300.0, 0.0))
    store, _ = _ingest(tmp_path, CAMPAIGN.replace("unit: mm, at", "unit: mm, held: true, at"))
    np.testing.assert_array_equal(_stored(store)["value"], 0.0)


@pytest.mark.parametrize(
    ("channel", "said"),
    [
        ("w: {derive: rate(T_nut), quantity: temperature_difference}", "is of a temperature"),
        ("w: {derive: rate(v), quantity: feed}", "is of no logged channel"),
        ("w: {derive: rate(rate(x_pos)), quantity: feed}", "a rate is of one channel"),
        ("w: {derive: rate(x_posn), quantity: feed}", "no channel 'x_posn'"),
        (
            "w: {schedule: [[0 h, 1]], quantity: position, unit: mm}\n  u: {derive: rate(w), quantity: feed}",
            "scheduled",
        ),
    ],
)
def test_what_is_no_movement_is_refused(tmp_path: Path, channel: str, said: str) -> None:
    t_s = np.arange(0, 60.0)
    _write(tmp_path / "day_plc.csv", t_s, _to_and_fro(t_s))
    with pytest.raises(UsageError, match=said):
        _ingest(tmp_path, CAMPAIGN.replace("tests:", f"  {channel}\ntests:"))


def test_a_rule_over_samples_has_no_rates(tmp_path: Path) -> None:
    t_s = np.arange(0, 60.0)
    _write(tmp_path / "day_plc.csv", t_s, _to_and_fro(t_s))
    rule = CAMPAIGN.replace("role: calibration", 'role: calibration, measuring: "abs(rate(x_pos)) < 1"')
    with pytest.raises(UsageError, match="only 'derive' has") as refused:
        _ingest(tmp_path, rule)
    assert "tests[0].measuring" in str(refused.value)


def test_rates_of_two_logs_are_no_one_expression(tmp_path: Path) -> None:
    t_s = np.arange(0, 60.0)
    _write(tmp_path / "day_plc.csv", t_s, _to_and_fro(t_s))
    _write(tmp_path / "day_log.csv", t_s, _to_and_fro(t_s))
    two = CAMPAIGN.replace("channels:", '  log: {reader: table, files: "{test}_log.csv"}\nchannels:').replace(
        "tests:",
        '  y_pos: {source: log, signal: "x [mm]", quantity: position, unit: mm, at: axis.y}\n'
        '  both: {derive: "abs(rate(x_pos)) + abs(rate(y_pos))", quantity: feed, at: axis.x}\n'
        "  v_y: {derive: rate(y_pos), quantity: feed, at: axis.y}\n"
        '  sum: {derive: "abs(v) + abs(v_y)", quantity: feed, at: axis.x}\ntests:',
    )
    store, summary = _ingest(tmp_path, two)
    assert len(summary.losses) == 1
    assert "derive rate(y_pos) as a channel of its own" in str(summary.losses[0])
    np.testing.assert_allclose(_stored(store, "sum")["value"], 6.0)
