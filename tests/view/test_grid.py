"""`binned` and `aligned`: means of valid samples, held states, honest holes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import duckdb
import numpy as np
import pytest

from thermodata.schema.flag import INVALID, Flag
from thermodata.store import Store
from thermodata.view import StoreView, load_dataset

Build = Callable[..., Any]


def columns(store: Store, query: str, *params: object) -> dict[str, np.ndarray]:
    with store.reader() as con:
        got = (con.execute(query, list(params)) if params else con.execute(query)).fetchnumpy()
    return {
        n: np.ma.filled(np.ma.asarray(a).astype(float), np.nan) if a.dtype.kind in "fiu" else a for n, a in got.items()
    }


@pytest.fixture(scope="module")
def mixed(build_once: Build) -> Store:
    """A fast source, one slower than the step, one with states and text; the fast one starts later."""
    b = build_once()
    b.test("c", "a")
    fast = np.arange(5.0, 600.0, 1.0)
    flags = np.where((fast >= 100) & (fast < 160), int(Flag.SPIKE), 0)
    flags[fast == 200] = int(Flag.GAP)
    b.tidy("c", "a", fast, {"dZ": (fast * 2, flags)})
    slow = np.arange(0.0, 600.0, 60.0)
    slow = slow[(slow < 241) | (slow > 479)]
    b.channel("c", "a", "T1", "temperature", source="pt")
    b.tidy("c", "a", slow, {"T1": 20 + slow / 60}, source="pt")
    b.channel("c", "a", "door", "state", source="plc")
    b.channel("c", "a", "program", "label", source="plc")
    b.tidy(
        "c", "a", [10.0, 95.0, 300.0], {"door": ([0.0, 1.0, 0.0], [0, 0, 0]), "program": ["A", "B", "C"]}, source="plc"
    )
    b.channel("c", "a", "n_table", "rotational_speed", source="schedule")
    b.tidy("c", "a", [0.0, 60.0, 120.0], {"n_table": [0.0, 100.0, 50.0]}, source="schedule")
    return b.store()


@pytest.mark.parametrize("step", ["'30 s'", "30", "'30'", "interval '30 s'", "30.0", "'0.5 min'", "interval 30 second"])
@pytest.mark.parametrize("macro", ["binned", "aligned"])
def test_a_step_is_an_interval_a_text_or_seconds(mixed: Store, macro: str, step: str) -> None:
    got = columns(mixed, f"select t_s from {macro}('c', 'a', {step})")
    assert got["t_s"].tolist() == list(np.arange(0.0, 600.0, 30.0))


@pytest.mark.parametrize("step", ["'soon'", "0", "-30", "null", "'-1 s'", "'1,5 min'", "'inf'", "'nan'"])
@pytest.mark.parametrize("macro", ["binned", "aligned"])
def test_a_step_that_is_none_is_refused(mixed: Store, macro: str, step: str) -> None:
    with pytest.raises(duckdb.Error, match="a step is positive: '30 s', '1 min'"):
        columns(mixed, f"select * from {macro}('c', 'a', {step})")


def test_columns_and_types(mixed: Store) -> None:
    head = ["campaign", "test", "t", "t_s"]
    with mixed.reader() as con:
        binned, aligned = con.sql("from binned('c', 'a')"), con.sql("from aligned('c', 'a', step := 60)")
        names, more = binned.columns, aligned.columns
        types = [str(kind) for kind in binned.types]
    assert names[:4] == more[:4] == head
    assert set(names[4:]) == {"dZ", "T1", "door", "program", "n_table"}
    assert set(more[4:]) == {n + s for n in names[4:] for s in ("", "__flag")}
    assert types[:4] == ["VARCHAR", "VARCHAR", "TIMESTAMP_NS", "DOUBLE"]


def test_bins_are_means_of_valid_samples(mixed: Store) -> None:
    got = columns(mixed, "select t_s, dZ, epoch_ns(t) as ns from binned('c', 'a', '30 s')")
    fast = np.arange(5.0, 600.0, 1.0)
    good = (fast < 100) | (fast >= 160)
    for t, value in zip(got["t_s"], got["dZ"], strict=True):
        inside = good & (fast >= t) & (fast < t + 30)
        assert (np.isnan(value) and not inside.any()) or value == pytest.approx(2 * fast[inside].mean())
    assert np.isnan(got["dZ"]).sum() == 1  # 120 s to 150 s; a fast source's hole is never filled
    assert got["ns"][2] == 1_772_000_060_000_000_000


def test_which_flags_count(build: Build) -> None:
    b = build()
    for flag in Flag:
        b.test("c", str(flag.name))
        b.tidy("c", str(flag.name), [0.0, 1.0], {"dZ": ([1.0, 3.0], [0, int(flag)])})
    store = b.store()
    for flag in Flag:
        got = columns(store, "select dZ from binned('c', ?, '2 s')", str(flag.name))
        assert got["dZ"].tolist() == [1.0 if flag & INVALID else 2.0]


def test_missing_numbers_are_no_samples(build: Build) -> None:
    b = build()
    b.test("c", "a")
    b.tidy("c", "a", [0.0, 1.0, 2.0], {"dZ": [1.0, float("nan"), None]})
    assert columns(b.store(), "select dZ from binned('c', 'a', '5 s')")["dZ"].tolist() == [1.0]


def test_a_source_slower_than_the_step_is_interpolated_but_not_over_long_holes(mixed: Store) -> None:
    got = columns(mixed, "select t_s, T1 from binned('c', 'a', '30 s')")
    t, value = got["t_s"], got["T1"]
    inside = (t > 240) & (t < 480)  # 4 periods without a sample
    after = t > 540
    assert np.isnan(value[inside | after]).all()
    assert value[~inside & ~after] == pytest.approx(20 + t[~inside & ~after] / 60)


def test_states_labels_and_schedules_are_held(mixed: Store) -> None:
    got = columns(mixed, "select t_s, door, program, n_table from binned('c', 'a', '30 s')")
    assert got["door"].tolist() == [0.0] * 3 + [1.0] * 7 + [0.0] * 10
    assert list(got["program"]) == ["A"] * 3 + ["B"] * 7 + ["C"] * 10
    assert got["n_table"].tolist() == [0.0] * 2 + [100.0] * 2 + [50.0] * 16


def test_invalid_states_are_not_held(build: Build) -> None:
    b = build()
    b.test("c", "a")
    b.channel("c", "a", "door", "state")
    b.tidy("c", "a", [0.0, 10.0, 20.0], {"door": ([1.0, 7.0, 0.0], [0, int(Flag.SPIKE), 0])})
    assert columns(b.store(), "select door from binned('c', 'a', '10 s')")["door"].tolist() == [1.0, 1.0, 0.0]


def test_aligned_shows_the_last_sample_and_its_flag(mixed: Store) -> None:
    got = columns(mixed, "select t_s, dZ, dZ__flag, T1, door from aligned('c', 'a', '30 s')")
    t = got["t_s"]
    assert np.isnan(got["dZ"][0])  # before its first sample
    assert got["dZ"][1:].tolist() == (2 * t[1:]).tolist()
    assert got["dZ__flag"][(t >= 100) & (t < 160)].tolist() == [int(Flag.SPIKE)] * 2
    assert got["T1"][3] == 21.0
    assert np.isnan(got["T1"][t == 450]).all()  # 3.5 periods after the last one
    assert got["door"].tolist()[:5] == [np.nan, 0.0, 0.0, 0.0, 1.0] or np.isnan(got["door"][0])
    assert got["door"][-1] == 0.0


def test_jitter_does_not_empty_bins(build: Build) -> None:
    b = build()
    b.test("c", "a")
    t = np.arange(0.0, 300.0, 10.0)
    b.tidy("c", "a", t + np.where(np.arange(t.size) % 2, -1e-9, 1e-9) * (t > 0), {"dZ": t})
    assert columns(b.store(), "select dZ from binned('c', 'a', '10 s')")["dZ"].tolist() == t.tolist()


def test_tests_stay_apart_and_unknown_ones_are_named(build: Build) -> None:
    b = build()
    for k, test in enumerate(("a", "b", "bare")):
        b.test("c", test)
        if test != "bare":
            b.tidy("c", test, [0.0, 10.0], {"dZ": [float(k), float(k)]})
    b.tidy("c", "a", [0.0], {"T1": [20.0]}, source="pt")
    store = b.store()
    got = columns(store, "select * from binned('c', 'b', 10)")
    assert got["dZ"].tolist() == [1.0, 1.0]
    assert np.isnan(got["T1"]).all()
    for macro in ("binned", "aligned"):
        assert columns(store, f"select t_s from {macro}('c', 'bare', 10)")["t_s"].size == 0
        with pytest.raises(duckdb.Error, match="no test 'x' in campaign 'c'; there is: a, b, bare"):
            columns(store, f"select * from {macro}(?, ?, 10)", "c", "x")


def test_a_step_too_small_for_the_test_is_refused(build: Build) -> None:
    b = build()
    b.test("c", "a")
    b.tidy("c", "a", [0.0, 1e6], {"dZ": [0.0, 1.0]})
    with pytest.raises(duckdb.Error, match="step is too small"):
        columns(b.store(), "select * from binned('c', 'a', '1 ms')")


def test_a_schedule_has_no_log_whose_clock_could_be_off(mixed: Store) -> None:
    channels = load_dataset(mixed, "c", 60.0).channels
    assert channels["n_table"].source is None
    assert {c.source for n, c in channels.items() if n != "n_table"} != {None}


@pytest.mark.parametrize("macro", ["binned", "aligned"])
def test_several_tests_stand_in_one_table(build: Build, macro: str) -> None:
    b = build()
    for i, name in enumerate(["b", "a", "it's, [c]"]):
        b.test("c", name)
        b.tidy("c", name, np.arange(0.0, 90.0 + 30.0 * i), {"dZ": np.full(90 + 30 * i, float(i))})
    b.test("c", "without_files")
    store = b.store()

    def rows(test: str) -> list[tuple[Any, ...]]:
        with store.reader() as con:
            return con.execute(f"select test, t_s, dZ from {macro}('c', {test}, '30 s')").fetchall()

    each = [rows(test) for test in ("'b'", "'a'", "'it''s, [c]'")]
    assert [len(r) for r in each] == [3, 4, 5]
    assert rows("null") == [*each[1], *each[0], *each[2]], "in the order of their names"
    assert rows("['a', 'b']") == rows("['b', 'a', 'b']") == [*each[1], *each[0]], "each once, by name"
    assert rows("['it''s, [c]']") == each[2]
    assert rows("['without_files']") == []
    with pytest.raises(duckdb.Error, match="no test is named"):
        rows("[]")
    with pytest.raises(duckdb.Error, match="no test 'x' in campaign 'c'; there is: a, b"):
        rows("['a', 'x']")
    view = StoreView(store.path)
    made = getattr(view, macro)
    assert made("c", step=30).fetchall() == made("c", None).fetchall()
    assert len(made("c", ["a", "b"]).fetchall()) == 7
