"""After an edit only the tests with edited files are looked at, and the store is the same as if all had been; what
reaches further is noticed."""

from __future__ import annotations

import os
import shutil
import sys
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermodata.reader.finding import registry
from thermodata.store import Store
from thermodata.store.base.connection import insert
from thermodata.store.ingest import layers, run
from thermodata.store.ingest.run import ingest
from thermodata.store.ingest.summary import IngestSummary

sys.path.insert(0, str(Path(__file__).parents[1] / "hardening"))
import whole

TESTS = 6
CHANNELS = ("front", "rear", "nut", "motor", "hall")


@pytest.fixture(autouse=True)
def installed_readers(npz_reader: None, monkeypatch: pytest.MonkeyPatch) -> None:
    from thermodata.store.ingest.known import unchanged
    from thermodata.store.ingest.reading import campaign_files

    monkeypatch.setattr(campaign_files, "find_reader", registry.reader)
    monkeypatch.setattr(unchanged, "_YOUNG_NS", -(10**15))  # as if the files were written long ago
    monkeypatch.setattr(run, "datetime", Today)


class Today(datetime):
    """A clock that stands still: rows tell when a version of a file was superseded."""

    @classmethod
    def now(cls, tz: Any = None) -> datetime:
        return datetime(2026, 3, 9, 12, tzinfo=tz)


def write_log(path: Path, test: int, rows: int = 60, off_k: float = 0.0, words: str = "") -> None:
    """Five temperatures every 60 s from 06:00 of a day; the nut reads off_k more."""
    rng = np.random.default_rng(test)
    lines = ["Time," + ",".join(f"{c} [degC]" for c in CHANNELS)]
    for row in range(rows):
        warm = 20 + 4 * (1 - np.exp(-row / 30)) + 0.05 * rng.standard_normal(len(CHANNELS))
        warm[2] += off_k
        lines.append(
            f"2026-03-{test + 1:02d} {6 + row // 60:02d}:{row % 60:02d}:00," + ",".join(f"{x:.2f}" for x in warm)
        )
    path.write_text("\n".join(lines) + "\n" + words)


def write_control(path: Path, test: int, rows: int = 60) -> None:
    speeds = "".join(f"{60 * i}.0,{3000 + 100 * test + (i * 7919 % 13)}\n" for i in range(rows))
    path.write_text(f"Time [s],n [rpm]\n{speeds}")


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """A campaign file of six tests of two CSV files; the channel `hall` is overruled where it is stuck."""
    raw = tmp_path / "lab" / "raw"
    raw.mkdir(parents=True)
    for test in range(TESTS):
        write_log(raw / f"t{test}_a.csv", test)
        write_control(raw / f"t{test}_b.csv", test)
    places = {"front": "spindle.bearing.front", "rear": "spindle.bearing.rear", "nut": "axis.z.nut"}
    (tmp_path / "lab" / "campaign.yaml").write_text(
        "schema: thermodata/campaign/1\nid: grown\nmachine: {id: m}\nsources:\n"
        "  a: {reader: table, files: 'raw/{test}_a*.csv', timezone: UTC}\n"
        "  b: {reader: table, files: 'raw/{test}_b.csv'}\n"
        "channels:\n"
        + "".join(
            f"  T_{c}: {{source: a, signal: {c}, quantity: temperature, at: {places.get(c, 'column.front')}}}\n"
            for c in CHANNELS
        )
        + "  speed: {source: b, signal: n, quantity: rotational_speed, at: spindle}\n"
        + "overrule:\n  - {channel: T_hall, flag: spike, because: a door}\n"
        + "tests:\n"
        + "".join(f"  - {{id: t{test}, kind: spindle, role: calibration}}\n" for test in range(TESTS))
    )
    return tmp_path / "lab" / "campaign.yaml"


def said(summary: IngestSummary) -> dict[str, Any]:
    return {k: v for k, v in summary.to_json().items() if k not in ("seconds", "made")}


class Looked:
    """Which tests an ingest looks at."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.tests: list[str] = []
        right = layers.bind
        monkeypatch.setattr(layers, "bind", lambda plan: self.tests.append(plan.test.id) or right(plan))

    def __call__(self, store: Store, lab: Path) -> tuple[list[str], IngestSummary]:
        self.tests.clear()
        summary = ingest(store, lab)
        return list(self.tests), summary


@pytest.fixture
def looked(monkeypatch: pytest.MonkeyPatch) -> Looked:
    return Looked(monkeypatch)


def both_ways(store: Store, lab: Path, looked: Looked, tmp_path: Path) -> tuple[list[str], IngestSummary]:
    """An ingest, which is held against that of a copy of the store without notes."""
    copy = tmp_path / "copy"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(store.path, copy)
    shutil.rmtree(copy / "known")
    tests, summary = looked(store, lab)
    every, long = looked(Store(copy), lab)
    assert every[-TESTS:] == [f"t{test}" for test in range(TESTS)]
    assert said(summary) == said(long)
    assert whole.content(store.path) == whole.content(copy)
    whole.check(store.path)
    assert not ingest(store, lab).changed
    return tests, summary


def longer(raw: Path) -> None:
    write_log(raw / "t3_a.csv", 3, rows=90)


def other_values(raw: Path) -> None:
    write_control(raw / "t2_b.csv", 8)


def in_place(raw: Path) -> None:
    """Another digit, and length and time as they were."""
    path = raw / "t4_a.csv"
    status, text = path.stat(), path.read_text()
    path.write_text(text[:-2] + ("9" if text[-2] != "9" else "8") + text[-1:])
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))


def damaged(raw: Path) -> None:
    write_log(raw / "t5_a.csv", 5, words="broken\n2026-03-06 08:00:00,1,2,3,4,5\n")


def unreadable(raw: Path) -> None:
    (raw / "t1_b.csv").write_bytes(b"\x00\x01" * 40)


def without_a_channel(raw: Path) -> None:
    path = raw / "t2_a.csv"
    path.write_text("\n".join(line.rpartition(",")[0] for line in path.read_text().splitlines()) + "\n")


def touched_only(raw: Path) -> None:
    os.utime(raw / "t0_a.csv")


def as_another(raw: Path) -> None:
    """The bytes that another test has too."""
    shutil.copyfile(raw / "t2_b.csv", raw / "t1_b.csv")


@pytest.mark.parametrize(
    ("change", "test"),
    [
        (longer, "t3"),
        (other_values, "t2"),
        (in_place, "t4"),
        (damaged, "t5"),
        (unreadable, "t1"),
        (without_a_channel, "t2"),
        (touched_only, "t0"),
        (as_another, "t1"),
    ],
)
def test_only_the_test_of_an_edited_file_is_looked_at_and_the_store_is_the_same(
    store: Store, lab: Path, looked: Looked, tmp_path: Path, change: Any, test: str
) -> None:
    ingest(store, lab)
    change(lab.parent / "raw")
    tests, summary = both_ways(store, lab, looked, tmp_path)
    assert tests == [test]
    assert summary.tests == TESTS
    # what can't be read leaves the earlier version in use, and is tried again: nothing is noted
    assert summary.changed == (change not in (touched_only, unreadable))
    if change is unreadable:
        return
    # and back, and another one, from the notes of notes
    write_log(lab.parent / "raw" / "t0_a.csv", 0, rows=70)
    tests, _ = both_ways(store, lab, looked, tmp_path)
    assert tests == ["t0"]


def test_a_sensor_that_fails_from_an_edited_test_on_is_flagged_in_the_tests_left_alone(
    store: Store, lab: Path, looked: Looked, tmp_path: Path
) -> None:
    raw = lab.parent / "raw"
    for test in (3, 4):
        write_log(raw / f"t{test}_a.csv", test, off_k=30.0)
    ingest(store, lab)
    events = "select distinct test from quality_event where flag = 'offset' order by all"
    with store.reader() as con:
        assert con.execute(events).fetchall() == []  # t5 reads right again: nothing failed for good
    write_log(raw / "t5_a.csv", 5, off_k=30.0)
    tests, _ = both_ways(store, lab, looked, tmp_path)
    assert tests == ["t5", *(f"t{test}" for test in range(TESTS))]  # the others are looked at after all
    with store.reader() as con:
        assert con.execute(events).fetchall() == [("t3",), ("t4",), ("t5",)]


def test_a_new_column_reaches_the_files_of_all_tests(store: Store, lab: Path, looked: Looked, tmp_path: Path) -> None:
    raw = lab.parent / "raw"
    for test in range(TESTS):
        path = raw / f"t{test}_a.csv"
        path.write_text(path.read_text().replace("hall", "door"))
    ingest(store, lab)
    path = raw / "t3_a.csv"
    path.write_text(path.read_text().replace("door", "hall"))
    tests, _ = both_ways(store, lab, looked, tmp_path)
    assert tests == ["t3", *(f"t{test}" for test in range(TESTS))]
    with store.reader() as con:
        found = con.execute("select columns->>'$.channels' from file where layer = 'tidy' and source = 'a'").fetchall()
    assert len(set(found)) == 1


def test_losses_of_bytes_that_two_tests_have_are_told_by_one_of_them(
    store: Store, lab: Path, looked: Looked, tmp_path: Path
) -> None:
    raw = lab.parent / "raw"
    for test in (1, 4):
        (raw / f"t{test}_b.csv").write_text("Time [s],n [rpm]\n0.0,7\nbroken\n10.0,8\n")
    first = ingest(store, lab)
    assert [row["test"] for row in first.losses if row["file"]] == ["t1"]
    write_control(raw / "t1_b.csv", 1)
    _, summary = both_ways(store, lab, looked, tmp_path)
    assert [row["test"] for row in summary.losses if row["file"]] == ["t4"]


def test_a_jump_test_that_changes_concerns_every_test(store: Store, lab: Path, looked: Looked, tmp_path: Path) -> None:
    raw = lab.parent / "raw"

    def jump(gain: float) -> None:
        steps = np.repeat([0.0, 0.1, 0.0], 40)
        rows = "".join(f"{0.25 * i:.2f},{1 + gain * x + 0.0001 * (i % 3):.5f}\n" for i, x in enumerate(steps))
        (raw / "jump.csv").write_text(f"Time [s],probe [V]\n{rows}")

    jump(3.0)
    for test in range(TESTS):
        path = raw / f"t{test}_b.csv"
        lines = path.read_text().splitlines()
        path.write_text(
            "\n".join([f"{lines[0]},probe [V]", *(f"{x},1.{i:02d}" for i, x in enumerate(lines[1:]))]) + "\n"
        )
    text = lab.read_text().replace(
        "overrule:",
        "  dZ: {source: b, signal: probe, quantity: displacement, unit: V, axis: Z, at: tcp, calibration: j}\n"
        "calibrations:\n  j: {kind: jump, axis: Z, source: b, file: raw/jump.csv, signal: probe, "
        "moves: [100 um, -100 um], dwell: 10 s}\noverrule:",
    )
    lab.write_text(text)
    assert ingest(store, lab).losses == []
    write_control(raw / "t2_b.csv", 2)
    tests, _ = both_ways(store, lab, looked, tmp_path)
    assert tests[:1] == ["t2"]
    jump(4.0)
    tests, summary = both_ways(store, lab, looked, tmp_path)
    assert tests == [f"t{test}" for test in range(TESTS)]
    assert summary.made == TESTS - 1  # all that has the probe


def test_a_clock_that_tests_lend_each_other_is_asked_of_all(
    store: Store, lab: Path, looked: Looked, tmp_path: Path
) -> None:
    """The control's clock is estimated in tests whose spindle turned; where it stood the others tell it."""
    raw = lab.parent / "raw"

    def logs(test: int, shift_s: int, turns: bool) -> None:
        at = np.datetime64(f"2026-03-{test + 1:02d}T06:00:00")
        t_s = np.arange(0, 3600, 5)
        levels = np.random.default_rng(test).integers(0, 9, 60) * 1000.0
        n = levels[t_s // 70] if turns else 0 * t_s
        for name, moved in (("a", 0), ("b", shift_s)):
            rows = "".join(
                f"{str(at + np.timedelta64(int(t + moved), 's')).replace('T', ' ')},{x:.0f},{20 + t / 3600:.3f}\n"
                for t, x in zip(t_s, n, strict=True)
            )
            (raw / f"t{test}_{name}.csv").write_text(f"Time,n [rpm],x [degC]\n{rows}")

    for test in range(TESTS):
        logs(test, 30, turns=test != 5)
    lab.write_text(
        "schema: thermodata/campaign/1\nid: grown\nmachine: {id: m}\nsources:\n"
        "  a: {reader: table, files: 'raw/{test}_a.csv', timezone: UTC}\n"
        "  b: {reader: table, files: 'raw/{test}_b.csv', timezone: UTC, clock: {align_to: a, by: "
        "[{here: speed, there: speed_a}]}}\n"
        "channels:\n"
        "  speed_a: {source: a, signal: n, quantity: rotational_speed, at: spindle}\n"
        "  T_a: {source: a, signal: x, quantity: temperature, at: column.front}\n"
        "  speed: {source: b, signal: n, quantity: rotational_speed, at: spindle}\n"
        "tests:\n" + "".join(f"  - {{id: t{test}, kind: spindle, role: calibration}}\n" for test in range(TESTS))
    )
    first = ingest(store, lab)
    assert any("clock by 5 other tests" in n and "-30.000 s" in n for n in first.notes), first.notes
    logs(1, 30, turns=True)
    path = raw / "t1_a.csv"
    path.write_text(path.read_text().replace(",21.0", ",21.1"))  # the clocks stay
    tests, _ = both_ways(store, lab, looked, tmp_path)
    assert tests == ["t1"]
    logs(1, 42, turns=True)  # and now one moves: the clock lent to t5 does too
    tests, summary = both_ways(store, lab, looked, tmp_path)
    assert tests == ["t1", *(f"t{test}" for test in range(TESTS))]
    assert any("12 s apart" in n for n in summary.notes)


@pytest.mark.parametrize("what", ["line of another version", "torn", "gone"])
def test_without_the_notes_of_the_tests_all_are_looked_at(
    store: Store, lab: Path, looked: Looked, tmp_path: Path, what: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.ingest.known import left_alone

    ingest(store, lab)
    (notes,) = (store.path / "known").glob("*.tests")
    if what == "gone":
        notes.unlink()
    elif what == "torn":
        notes.write_text(notes.read_text().replace("spindle", "spindel", 1)[:-40])
    else:
        right = left_alone.TestNote.from_text
        monkeypatch.setattr(left_alone.TestNote, "from_text", lambda line: right(line.replace("samples", "values")))
    longer(lab.parent / "raw")
    tests, _ = both_ways(store, lab, looked, tmp_path)
    assert tests == [f"t{test}" for test in range(TESTS)]


def add_test(store: Store, lab: Path) -> None:
    write_log(lab.parent / "raw" / "t6_a.csv", 6)
    lab.write_text(lab.read_text() + "  - {id: t6, kind: spindle, role: calibration}\n")


def change_place(store: Store, lab: Path) -> None:
    lab.write_text(lab.read_text().replace("at: axis.z.nut", "at: axis.y.nut"))


def remove_tidy_file(store: Store, lab: Path) -> None:
    next((store.path / "tidy").glob("*.parquet")).unlink()


def cut_raw_file(store: Store, lab: Path) -> None:
    path = next((store.path / "raw").glob("*.parquet"))
    path.write_bytes(path.read_bytes()[:-20])


def other_commit(store: Store, lab: Path) -> None:
    with store.write() as con:
        con.execute("select 1")


def by_hand(store: Store, lab: Path) -> None:
    import duckdb

    with duckdb.connect(str(store.path / "catalog.duckdb")) as con:
        con.execute("delete from channel where test = 't1'")


@pytest.mark.parametrize("other", [add_test, change_place, remove_tidy_file, cut_raw_file, other_commit, by_hand])
def test_whatever_else_differs_all_tests_are_looked_at(
    store: Store, lab: Path, looked: Looked, tmp_path: Path, other: Any
) -> None:
    ingest(store, lab)
    other(store, lab)
    longer(lab.parent / "raw")
    tests, summary = looked(store, lab)
    assert tests == [f"t{test}" for test in range(TESTS + (other is add_test))]
    assert summary.changed
    fresh = Store(tmp_path / "fresh", create=True)
    ingest(fresh, lab)
    with store.reader() as one, fresh.reader() as two:
        for query in ("select * from sample order by all", 'select test, channel, "at" from channel order by all'):
            assert one.execute(query).fetchall() == two.execute(query).fetchall()


def test_another_version_of_the_reader_or_of_this_program_is_seen_with_an_edit(
    store: Store, lab: Path, looked: Looked, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.ingest.reading import campaign_files

    ingest(store, lab)
    longer(lab.parent / "raw")
    monkeypatch.setattr(campaign_files, "__version__", "999.0")
    assert len(looked(store, lab)[0]) == TESTS
    write_log(lab.parent / "raw" / "t0_a.csv", 0, rows=70)
    monkeypatch.setattr(type(registry.reader("table")), "version", "999.0", raising=False)
    tests, summary = looked(store, lab)
    assert (len(tests), summary.read) == (TESTS, 2 * TESTS)


def test_a_commit_that_comes_between_is_noticed(
    store: Store, lab: Path, looked: Looked, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Somebody forgets a test while this ingest looks at another one."""
    from thermodata.store.keep.forget import forget

    ingest(store, lab)
    longer(lab.parent / "raw")
    right, times = run.difference, []

    def difference(*words: Any) -> Any:
        times.append(1)
        if len(times) == 1:
            forget(Store(store.path), "grown", "t1")
        return right(*words)

    monkeypatch.setattr(run, "difference", difference)
    tests, _ = looked(store, lab)
    assert tests == ["t3", *(f"t{test}" for test in range(TESTS))]
    with store.reader() as con:
        assert con.execute("select count(*) from test").fetchone() == (TESTS,)
    whole.check(store.path)


def test_models_of_the_edited_test_only_go_stale(store: Store, lab: Path, looked: Looked) -> None:
    ingest(store, lab)
    empty_of = {"VARCHAR": "{}", "JSON": "{}", "TIMESTAMP": "2026-03-09"}
    with store.write() as con:
        for model, test in (("of_t3", "t3"), ("of_t1", "t1")):
            row = {"model": model, "campaigns": ["grown"], "stale": False, "campaign": "grown", "test": test}
            for table in ("model", "score_row"):
                types = {r[1]: (r[2], r[3]) for r in con.execute(f"pragma table_info('{table}')").fetchall()}
                empty = {c: row.get(c, empty_of.get(kind, 0)) for c, (kind, need) in types.items() if need or c in row}
                insert(con, table, [empty])
    ingest(store, lab)
    longer(lab.parent / "raw")
    tests, summary = looked(store, lab)
    assert tests == ["t3"]
    assert summary.stale == ["of_t3"]


def test_a_note_that_lacks_a_field_is_of_another_version() -> None:
    from thermodata.store.ingest.known.left_alone import TestNote

    line = TestNote(samples=3).to_text()
    assert TestNote.from_text(line).samples == 3
    for other in (line.replace('"samples": 3, ', ""), line.replace("{", '{"more": 1, ', 1), "[]"):
        assert other != line
        with pytest.raises(ValueError, match="another version"):
            TestNote.from_text(other)


@pytest.mark.parametrize("raised", ["VVO", "OVV", "VOV", "VVV", "OVVV"])
def test_looking_at_every_test_is_no_attempt(
    store: Store, lab: Path, raised: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.errors import StoreError
    from thermodata.store.ingest.commit import VanishedError
    from thermodata.store.ingest.known.left_alone import OtherwiseError

    left, whole = list(raised), run._ingest

    def other_program(*args: Any) -> Any:
        if left:
            raise {"V": VanishedError, "O": OtherwiseError}[left.pop(0)]("x")
        return whole(*args)

    monkeypatch.setattr(run, "_ingest", other_program)
    if raised.count("V") == 3:
        with pytest.raises(StoreError, match="vanish"):
            ingest(store, lab)
    else:
        assert ingest(store, lab).tests == TESTS
    assert not left


def test_a_clock_set_back_and_an_open_scale_are_told_of_tests_that_are_left_alone_too(tmp_path: Path) -> None:
    def write(test: int, off_k: float = 0.0) -> None:
        lines = ["Gain;1;0.05", "time;T [degC];Z [mm]"]
        for k in range(200):
            minute = 480 + k - 60 * (k >= 20)  # set back by an hour while it ran
            lines.append(
                f"2026-03-{test:02d} {minute // 60:02d}:{minute % 60:02d}:00;{20 + k / 100 + off_k};{100 + 3 * k}"
            )
        (tmp_path / f"t{test}_a.csv").write_text("\n".join([*lines, ""]))
        other = [
            f"2026-03-{test:02d} {(420 + k) // 60:02d}:{(420 + k) % 60:02d}:00;{1000 * (k > 50)}" for k in range(200)
        ]
        (tmp_path / f"t{test}_b.csv").write_text("\n".join(["time;n [rpm]", *other, ""]))

    for test in (1, 2):
        write(test)
    campaign = tmp_path / "campaign.yaml"
    campaign.write_text("""schema: thermodata/campaign/1
id: c
sources:
  a: {reader: table, files: "{test}_a.csv", timezone: UTC, clock: {resets: allow}}
  b: {reader: table, files: "{test}_b.csv", timezone: UTC}
channels:
  T_bed: {source: a, signal: T, quantity: temperature, unit: degC, at: bed}
  pos_Z: {source: a, signal: Z, quantity: position, unit: mm, at: axis.z}
  speed: {source: b, signal: n, quantity: rotational_speed, unit: rpm, at: spindle}
tests: [{id: t1, kind: spindle, role: calibration}, {id: t2, kind: spindle, role: calibration}]
""")
    store = Store(tmp_path / "store", create=True)

    def told() -> list[tuple[str | None, bool, bool]]:
        losses = ingest(store, campaign).losses
        return [
            (x["test"], "was set back by" in x["reason"], "campaign file leaves open" in x["reason"]) for x in losses
        ]

    every = [(test, *kind) for test in ("t1", "t2") for kind in ((True, False), (False, True))]
    assert told() == every
    assert told() == every
    write(2, off_k=1.0)
    assert told() == every
    assert told() == every
