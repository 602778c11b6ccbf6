"""The list of tests: what is found, in which order, and what stands beside each."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import duckdb
import numpy as np
import pytest

from thermodata.errors import StoreError, UsageError
from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.view.curves import window as of_windows
from thermodata.view.curves.predictions import predictions, residual_strips
from thermodata.view.curves.window import channels_of, read_window
from thermodata.view.lists.models import model_rows
from thermodata.view.lists.overview import WantedTests, find_tests

T_S = np.arange(600) * 10.0


@pytest.fixture(scope="module")
def store(build_once: Callable[[], Any]) -> Store:
    """Three tests; a model with a residual of +2 um in the first half of heat1; saturation in day1."""
    b = build_once()
    for test, kind, role, conditions in (
        ("heat1", "spindle", "calibration", '{"speed": "9000 rpm"}'),
        ("day1", "linear_axis", "verification", "{}"),
        ("day2", "mixed", "locked", '{"hall": "warm"}'),
    ):
        b.test("lab", test, kind=kind, role=role, conditions=conditions, duration_s=5990.0)
        b.channel("lab", test, "dZ")
        b.channel("lab", test, "T_nut", "temperature")
        flag = np.zeros(600)
        flag[:60] = 4 if test == "day1" else 0
        z = np.sin(T_S / 300)
        z[300] = 50.0
        b.tidy("lab", test, T_S, {"dZ": (z, flag), "T_nut": 20 + T_S / 3600})
        b.rows["file"][-1]["columns"] = (
            '{"samples": 1200, "flags": ' + ('{"saturated": 60}' if test == "day1" else "{}") + "}"
        )
    b.model("m1", "baseline", campaigns=["lab"], response="dZ", spec='{"effects": [{"effect": "lag"}]}')
    residual = np.where(T_S < 3000, 2.0, 0.0)
    data = {"t_s": T_S, "measured": residual, "predicted": 0 * residual, "residual": residual}
    valid = T_S < 4500
    b.prediction("lab", "heat1", "m1", "dZ", {**data, "valid": valid, "c__lag": residual / 2})
    b.add(
        "score_row",
        campaign="lab",
        test="heat1",
        model="m1",
        role="calibration",
        response="dZ",
        phase="all",
        fit=50.0,
        rmse_um=1.41,
        n=600,
    )
    made: Store = b.store()
    return made


@pytest.mark.parametrize(
    ("asked", "tests"),
    [
        (WantedTests(), ["heat1", "day1", "day2"]),
        (WantedTests(find="day"), ["day1", "day2"]),
        (WantedTests(find="DAY warm"), ["day2"]),
        (WantedTests(find="9000 rpm"), ["heat1"]),
        (WantedTests(find="linear axis"), ["day1"]),
        (WantedTests(find="%"), []),
        (WantedTests(find="' or true --"), []),
        (WantedTests(role="locked"), ["day2"]),
        (WantedTests(kind="spindle", find="heat"), ["heat1"]),
        (WantedTests(sort="test"), ["day1", "day2", "heat1"]),
        (WantedTests(sort="valid"), ["day1", "heat1", "day2"]),
        (WantedTests(sort="error", models={"lab": "m1"}), ["heat1", "day1", "day2"]),
        (WantedTests(per_page=2, page=2), ["day2"]),
        (WantedTests(per_page=2, page=99), ["day2"]),
    ],
)
def test_what_is_asked_for_is_found_in_its_order(store: Store, asked: WantedTests, tests: list[str]) -> None:
    assert [r.test for r in find_tests(store, asked).rows] == tests


def test_a_test_says_what_counts_and_what_the_model_leaves(store: Store) -> None:
    found = find_tests(store, WantedTests(models={"lab": "m1"}))
    heat, day, locked = found.rows
    assert (heat.valid, day.valid, heat.rmse_um, locked.rmse_um) == (1.0, 0.95, 1.41, None)
    assert heat.conditions == {"speed": "9000 rpm"}
    assert (found.total, found.all_tests, found.pages) == (3, 3, 1)
    assert found.roles == {"calibration": 1, "verification": 1, "locked": 1}


def test_wrong_names_are_refused_with_the_right_ones(store: Store) -> None:
    with pytest.raises(UsageError, match="did you mean 'lab'"):
        find_tests(store, WantedTests(campaign="lap"))
    with pytest.raises(UsageError, match="no order"):
        find_tests(store, WantedTests(sort="colour"))  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="no test"):
        channels_of(store, "lab", "heat")


def test_strips_show_the_residual_where_it_is_and_nothing_where_nothing_was_measured(store: Store) -> None:
    strips = residual_strips(store, "m1", [("lab", "heat1"), ("lab", "day2")], bins=10)
    assert list(strips) == [("lab", "heat1")]
    strip = strips["lab", "heat1"]
    assert strip[:5] == pytest.approx([2.0] * 5)
    assert strip[5:7] == pytest.approx([0.0] * 2, abs=0.1)
    assert np.isnan(strip[8:]).all()


def test_a_strip_of_more_stretches_than_samples_has_each_sample_until_half_way_to_the_next(store: Store) -> None:
    samples = len(T_S)
    strip = residual_strips(store, "m1", [("lab", "heat1")], bins=3 * samples)["lab", "heat1"]
    assert strip[: int(1.4 * samples)] == pytest.approx(np.full(int(1.4 * samples), 2.0)), "measured, so never hatched"
    assert np.isnan(strip[int(2.4 * samples) :]).all(), "what does not count stays hatched"


def test_a_prediction_is_as_it_was_stored(store: Store) -> None:
    (found,) = predictions(store, "m1", "lab", "heat1")
    assert list(found.contributions) == ["lag"]
    assert found.residual == pytest.approx(np.where(T_S < 3000, 2.0, 0.0))
    assert found.valid.sum() == 450
    assert predictions(store, "m1", "lab", "day2") == []


def test_a_wide_window_keeps_its_extremes_and_a_narrow_one_every_sample(store: Store) -> None:
    channels = channels_of(store, "lab", "heat1")
    assert [c.name for c in channels] == ["dZ", "T_nut"]
    (wide,) = read_window(store, "lab", "heat1", channels, most=100)
    assert not wide.each
    assert len(wide.t_s) == 100
    assert np.all(np.diff(wide.t_s) > 0)
    assert np.nanmax(wide.values["dZ"]) == 50.0
    (narrow,) = read_window(store, "lab", "heat1", channels, (100.0, 200.0), most=100)
    assert narrow.each
    assert narrow.t_s == pytest.approx(np.arange(100.0, 201.0, 10.0))
    assert narrow.values["dZ"] == pytest.approx(np.sin(narrow.t_s / 300))


def test_samples_that_do_not_count_are_shown_on_request_only(store: Store) -> None:
    channels = channels_of(store, "lab", "day1")[:1]
    for most in (100, 10_000):
        (window,) = read_window(store, "lab", "day1", channels, most=most)
        assert np.isnan(window.values["dZ"][window.t_s < 590]).all()
        (window,) = read_window(store, "lab", "day1", channels, flagged=True, most=most)
        assert np.isfinite(window.values["dZ"]).all()


def test_a_window_beside_the_test_is_empty(store: Store) -> None:
    (window,) = read_window(store, "lab", "heat1", channels_of(store, "lab", "heat1"), (9e5, 9e6))
    assert len(window.t_s) == 0


def test_a_window_of_a_logger_that_became_slow_is_its_samples(build: Callable[[], Any]) -> None:
    """1 h at 10 Hz, 2 h of nothing, then 6 h at one a minute: a share of the whole would promise 18,000 in 5 h."""
    t_s = np.concatenate([np.arange(36_000) / 10, 10_800 + np.arange(360) * 60.0])
    b = build()
    b.test("lab", "slow")
    b.channel("lab", "slow", "dZ")
    b.tidy("lab", "slow", t_s, {"dZ": np.sin(t_s / 3000)})
    store = b.store()
    channels = channels_of(store, "lab", "slow")
    (late,) = read_window(store, "lab", "slow", channels, (14_400.0, 40_000.0))
    assert late.each
    assert late.t_s.tolist() == t_s[t_s >= 14_400].tolist()
    assert late.values["dZ"] == pytest.approx(np.sin(late.t_s / 3000))
    (none,) = read_window(store, "lab", "slow", channels, (3_600.0, 10_799.0))
    assert none.each
    assert len(none.t_s) == len(none.values["dZ"]) == 0
    (early,) = read_window(store, "lab", "slow", channels, (0.0, 3_600.0))
    assert not early.each
    assert np.isfinite(early.values["dZ"]).all()


def test_a_window_outlives_what_another_thread_forgets(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    class Cleared(dict[Any, Any]):
        """Emptied by another thread after each look and each entry."""

        def __contains__(self, key: object) -> bool:
            return True

        def __setitem__(self, key: object, value: object) -> None:
            """Gone before it is read again."""

    monkeypatch.setattr(of_windows, "_FACTS", Cleared())
    (window,) = read_window(store, "lab", "heat1", channels_of(store, "lab", "heat1"))
    assert len(window.t_s) == len(T_S)


def _half(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def _without_schema(path: Path) -> None:
    data = bytearray(path.read_bytes())
    footer = len(data) - 8 - int.from_bytes(data[-8:-4], "little")
    data[footer : footer + 60] = b"\xff" * 60
    path.write_bytes(data)


def _without_pages(path: Path) -> None:
    data = bytearray(path.read_bytes())
    footer = len(data) - 8 - int.from_bytes(data[-8:-4], "little")
    data[4:footer] = b"\xff" * (footer - 4)
    path.write_bytes(data)


@pytest.mark.parametrize("spoil", [Path.unlink, _half, _without_schema, _without_pages])
@pytest.mark.parametrize("looked", [False, True])
def test_a_file_that_is_gone_cut_or_altered_is_the_stores_own_error(
    build: Callable[[], Any], spoil: Callable[[Path], None], looked: bool
) -> None:
    b = build()
    b.test("lab", "a")
    for channel in ("dZ", "dY"):
        b.channel("lab", "a", channel)
    path = b.tidy("lab", "a", T_S, {"dZ": T_S, "dY": T_S})
    store = b.store()
    channels = channels_of(store, "lab", "a")
    if looked:
        (window,) = read_window(store, "lab", "a", channels)
        assert len(window.t_s) == len(T_S)
    spoil(path)
    with pytest.raises(StoreError, match="a file of the store is damaged") as told:
        read_window(store, "lab", "a", channels)
    assert told.value.where == str(path)
    assert "check" in str(told.value.hint)


@pytest.mark.parametrize("spoil", [Path.unlink, _half, _without_pages])
def test_whoever_reads_a_damaged_file_of_the_store_is_told_so(
    build: Callable[[], Any], spoil: Callable[[Path], None]
) -> None:
    b = build()
    b.test("lab", "a")
    b.channel("lab", "a", "dZ")
    path = b.tidy("lab", "a", T_S, {"dZ": T_S})
    store, query = b.store(), f"select sum(dZ), sum(t_s) from read_parquet('{path}')"
    with store.reader() as con:
        assert con.execute(query).fetchall()
    spoil(path)
    with pytest.raises(StoreError, match="a file of the store is damaged") as told, store.reader() as con:
        con.execute(query).fetchall()
    assert told.value.got == "a header within a Parquet file can't be read" or path.name in str(told.value.got)
    with pytest.raises(duckdb.Error, match="no_such_table"), store.reader() as con:
        con.execute("select * from no_such_table")


def test_models_come_with_their_effects_and_units(store: Store) -> None:
    (model,) = model_rows(store)
    assert (model.label, model.unit, model.effects, model.responses) == ("baseline 1", "um", ("lag",), ("dZ",))


def test_a_thousand_tests_are_searched_in_a_moment(build: Callable[..., Any]) -> None:
    b = build()
    for i in range(1000):
        b.test("big", f"t{i:04}", conditions=f'{{"speed": "{i} rpm"}}')
        b.add(
            "file",
            campaign="big",
            test=f"t{i:04}",
            source="daq",
            stream="daq",
            layer="tidy",
            part="test",
            key=f"k{i}",
            path=f"tidy/{i}.parquet",
            columns='{"samples": 100, "flags": {"spike": 1}}',
            added_at="2026-03-01",
        )
    store = b.store()
    find_tests(store, WantedTests())
    began = time.monotonic()
    found = find_tests(store, WantedTests(find="777"))
    assert [r.test for r in found.rows] == ["t0777"]
    assert found.rows[0].valid == pytest.approx(0.99)
    assert time.monotonic() - began < 2.0


def test_a_sample_with_two_flags_counts_once(tmp_path: Path) -> None:
    """A probe stands at its end for 100 rows, half of which the test does not measure."""
    rows = [f"{k};{10.0 if 100 <= k < 200 else 3 + k % 5};{20 + k % 3};{int(k >= 150)}" for k in range(300)]
    (tmp_path / "t.csv").write_text("t [s];dZ [V];T [degC];on\n" + "\n".join(rows) + "\n")
    (tmp_path / "campaign.yaml").write_text(
        """schema: thermodata/campaign/1
id: c
machine: {id: m}
sources:
  log: {reader: table, files: "{test}.csv", table: {delimiter: ";", decimal: ".", time: {column: 1, unit: s}}}
channels:
  dZ: {source: log, signal: dZ, quantity: displacement, unit: V, axis: Z, calibration: z, sensor: {range: [0 V, 10 V]}}
  T_bed: {source: log, signal: T, quantity: temperature, unit: degC, at: bed}
  on: {source: log, signal: "on", quantity: state, at: table}
calibrations:
  z: {kind: scale, axis: Z, gain: 100 um/V, facing: -Z, increases_with: gap}
tests:
  - {id: t, kind: spindle, role: calibration, measuring: "on == 0"}
"""
    )
    store = Store(tmp_path / "store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    with store.reader() as con:
        counts = con.execute("select channel, count(*) filter (not valid(flag)) from sample group by 1").fetchall()
        both = f"flag & {int(Flag.SATURATED)} <> 0 and flag & {int(Flag.NOT_MEASURING)} <> 0"
        assert con.execute(f"select count(*) from sample where channel = 'dZ' and {both}").fetchall() == [(50,)]
    (found,) = find_tests(store, WantedTests()).rows
    assert found.valid == pytest.approx(1 - sum(n for _, n in counts) / 900)
    of_the_probe = 1 - dict(counts)["dZ"] / 300
    assert of_the_probe < found.valid, "the bed and the state count throughout"
    assert (found.measured_least, found.measured_most) == (pytest.approx(of_the_probe), pytest.approx(of_the_probe))
