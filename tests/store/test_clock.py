"""The clocks of a test's sources: aligned by what both logged, cut to the test, relative beside absolute."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from store_fakes import CAMPAIGN, START_NS, daq, times, write_campaign, write_log

from thermodata.errors import SpecError
from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.tidy.clock.lent import dated_sources, lent
from thermodata.store.tidy.clock.source_clock import Clock
from thermodata.view.grid.describe import channel_infos

ALIGNED = CAMPAIGN.replace(
    'files: "raw/{test}.nc.npz"}',
    'files: "raw/{test}.nc.npz", clock: {align_to: daq, by: [{here: speed, there: n_daq}]}}',
).replace("calibrations:", "  n_daq: {source: daq, signal: n, quantity: rotational_speed}\ncalibrations:")


def steps(t_s: np.ndarray) -> np.ndarray:
    """A spindle programme that looks like itself at one offset only."""
    edges = np.array([0, 130, 400, 470, 900, 1310, 1500, 2210, 2600, 3300])
    return np.array([0.0, 4000, 9000, 2000, 6000, 0, 7000, 3000, 9000, 1000])[np.searchsorted(edges, t_s, "right") - 1]


def lab(folder: Path, text: str, *, off_s: float, constant: bool = False, test: str = "one") -> Path:
    path = write_campaign(folder, text, logs=False)
    n = 3600
    log = daq(n)
    log["main"]["n"] = np.zeros(n) if constant else steps(np.arange(n, dtype=float))
    write_log(path.parent / f"raw/{test}_a.npz", log)
    t = np.arange(0, 3500, 2.0)
    write_log(
        path.parent / f"raw/{test}.nc.npz",
        {
            "nc": {
                "t_ns": START_NS + np.rint((t - off_s) * 1e9).astype(np.int64),
                "n": steps(t),
                "msg": np.array(["RUN"] * len(t)),
            }
        },
    )
    return path


def test_a_clock_is_aligned_by_what_both_sources_logged(store: Store, tmp_path: Path) -> None:
    path = lab(tmp_path / "lab", ALIGNED, off_s=7_203.4)
    summary = ingest(store, path)
    with store.reader() as con:
        (offset,) = con.execute("select offset_ns from source where source = 'nc'").fetchone() or (None,)
        (first,) = con.execute("select min(t_s) from driver where channel = 'speed'").fetchone() or (None,)
    assert offset == pytest.approx(7_203.4e9, abs=1.5e9)
    assert first == pytest.approx(0.0, abs=1.5)
    assert any("aligned to 'daq'" in note for note in summary.notes)
    assert not ingest(store, path).changed


def test_a_clock_that_cannot_be_aligned_is_suspect_and_told(store: Store, tmp_path: Path) -> None:
    path = lab(tmp_path / "lab", ALIGNED, off_s=60.0, constant=True)
    summary = ingest(store, path)
    assert any("not aligned" in loss["reason"] for loss in summary.losses)
    with store.reader() as con:
        flags = con.execute("select distinct flag & 64 from driver where channel = 'speed'").fetchall()
        (infos,) = [found for (_, test), found in channel_infos(con, ["shop"]).items() if test == "one"]
    assert flags == [(int(Flag.CLOCK_SUSPECT),)]
    assert {name for name, info in infos.items() if info.clock_doubtful} == {"speed"}


@pytest.mark.parametrize(
    ("off_s", "said", "key"),
    [
        (3600.0, "its log begins 1 h before and ends 1 h 1 min 41 s before that of 'daq'", "clocks: {nc: +61 min}"),
        (-3600.0, "its log begins 1 h behind", "clocks: {nc: -59 min}"),
        (60.0, "its log begins 1 min before", "what has to be added to its times goes into clocks: {nc: ...}"),
        (0.0, "its log begins with and ends 1 min 41 s before", "clocks: {nc: 0 s} of the test says so"),
    ],
)
def test_by_how_much_a_suspect_clock_is_off_is_told_with_the_key_that_puts_it_right(
    store: Store, tmp_path: Path, off_s: float, said: str, key: str
) -> None:
    path = lab(tmp_path / "lab", ALIGNED, off_s=off_s, constant=True)
    (told,) = [x["reason"] for x in ingest(store, path).losses if "not aligned" in x["reason"]]
    with store.reader() as con:
        ((detail,),) = con.execute("select detail from quality_event where flag = 'clock_suspect'").fetchall()
    for text in (told, detail):
        assert said in text
        assert key in text
    if off_s == -3600.0:
        text = path.read_text("utf-8")
        path.write_text(text.replace("{id: one,", "{id: one, clocks: {nc: -59 min},"), encoding="utf-8")
        assert not any("not aligned" in x["reason"] for x in ingest(store, path).losses)
        with store.reader() as con:
            assert con.execute("select count(*) from driver where flag & 64 <> 0").fetchall() == [(0,)]
            (infos,) = [found for (_, test), found in channel_infos(con, ["shop"]).items() if test == "one"]
        assert not any(info.clock_doubtful for info in infos.values())


@pytest.mark.parametrize(("apart_s", "alike"), [(4.0, True), (300.0, False)])
def test_an_idle_test_has_its_clock_by_the_others_where_they_agree(
    store: Store, tmp_path: Path, apart_s: float, alike: bool
) -> None:
    text = ALIGNED + "  - {id: idle, kind: etve, role: none}\n"
    for test, off_s in (("one", 250.0), ("two", 250.0 + apart_s), ("idle", 0.0)):
        path = lab(tmp_path / "lab", text, off_s=off_s, constant=test == "idle", test=test)
    summary = ingest(store, path)
    with store.reader() as con:
        (offset,) = con.execute("select offset_ns from source where source = 'nc' and test = 'idle'").fetchone() or (0,)
        flags = con.execute(
            "select distinct flag & 64 from driver where channel = 'speed' and test = 'idle'"
        ).fetchall()
    assert flags == [(0 if alike else int(Flag.CLOCK_SUSPECT),)]
    assert offset == (pytest.approx(252e9, abs=3e9) if alike else 0)
    assert any("by 2 other tests" in note for note in summary.notes) == alike
    assert any("; by this test alone: clock not aligned to" in note for note in summary.notes) == alike
    assert any("not aligned" in loss["reason"] for loss in summary.losses) != alike
    assert not ingest(store, path).changed


@pytest.mark.parametrize(("events", "moved"), [((), True), (("seen by a person",), False)])
def test_events_that_a_person_declared_are_not_overruled_by_other_tests(events: tuple[str, ...], moved: bool) -> None:
    dated = SimpleNamespace(raws=[SimpleNamespace(clock="absolute", start_ns=None)], is_dated=True)
    dated.spec = SimpleNamespace(clock=SimpleNamespace(events=events))
    plan: Any = SimpleNamespace(sources={"nc": dated})
    told = Clock(250_000_000_000, 0.0, 0, key="k")
    clocks = {"a": {"nc": told}, "b": {"nc": told}, "c": {"nc": Clock(0, 0.0, 0, True, "k", ("they contradict",))}}
    found = lent(clocks, {t: dated_sources(plan) for t in "abc"})["c"]["nc"]
    assert (found.offset_ns, found.suspect) == ((250_000_000_000, False) if moved else (0, True))


def test_clocks_in_a_circle_are_refused(store: Store, tmp_path: Path) -> None:
    text = ALIGNED.replace(
        'files: "raw/{test}_*.npz"}',
        'files: "raw/{test}_*.npz", clock: {align_to: nc, by: [{here: n_daq, there: speed}]}}',
    )
    summary_or_error = lab(tmp_path / "lab", text, off_s=0.0)
    with pytest.raises(SpecError):
        ingest(store, summary_or_error)


def test_the_test_begins_with_the_probes_and_a_shared_logger_is_cut_to_it(store: Store, tmp_path: Path) -> None:
    path = write_campaign(
        tmp_path / "lab",
        CAMPAIGN.replace(
            "channels:",
            """\
  hall: {reader: npz, files: raw/hall.npz}
channels:
  T_hall: {source: hall, signal: T1, quantity: temperature, at: hall.top}""",
        ),
    )
    log = daq(4000, start_s=-20_000.0, step_s=10.0)
    write_log(path.parent / "raw/hall.npz", {"main": {k: log["main"][k] for k in ("t_ns", "T1")}})
    assert ingest(store, path).losses == []
    with store.reader() as con:
        found = con.execute(
            "select test, min(t_s), max(t_s) from sample where channel = 'T_hall' group by 1 order by 1"
        ).fetchall()
        duration = con.execute("select distinct duration_s from test").fetchall()
    assert found == [("one", 0.0, 1190.0), ("two", 0.0, 1190.0)]
    assert duration == [(1199.0,)]


@pytest.mark.parametrize("own", [True, False])
def test_displacements_in_a_file_of_all_tests_are_cut_by_what_has_a_file_of_each(
    store: Store, tmp_path: Path, own: bool
) -> None:
    """A table of all results of a probe, beside the control's log of each test; without that nothing parts it."""
    text = CAMPAIGN.replace('files: "raw/{test}_*.npz"', "files: raw/results.npz")
    if not own:
        text = text.replace('files: "raw/{test}.nc.npz"', "files: raw/control.npz")
    path = write_campaign(tmp_path / "lab", text)
    write_log(path.parent / "raw/results.npz", daq(4000, start_s=-20_000.0, step_s=10.0))
    for i, test in enumerate(("one", "two")):
        log = {"t_ns": times(130, 10.0, 1800.0 * i), "n": np.full(130, 9000.0), "msg": np.full(130, "RUN")}
        write_log(path.parent / f"raw/{test}.nc.npz", {"nc": log})
    write_log(path.parent / "raw/control.npz", {"nc": log})
    summary = ingest(store, path)
    with store.reader() as con:
        asked = "select test, min(t_s), max(t_s) from sample where channel = 'dZ' group by 1 order by 1"
        found = con.execute(asked).fetchall()
        starts = con.execute("select start_ns from test order by test").fetchall()
    if own:
        assert found == [("one", 0.0, 1290.0), ("two", 0.0, 1290.0)]
        assert [s for (s,) in starts] == [START_NS, START_NS + 1_800 * 10**9]
        assert sum("cut where the files of 'nc' begin and end" in note for note in summary.notes) == 2
        assert summary.losses == []
    else:
        assert [b - a for _, a, b in found] == [39_990.0] * 2
        reasons = [loss["reason"] for loss in summary.losses]
        assert sum("nothing says when it was; try: window:" in reason for reason in reasons) == 2


def test_a_test_of_its_own_begins_with_its_displacements_however_their_file_is_called(
    store: Store, tmp_path: Path
) -> None:
    text = CAMPAIGN.replace('files: "raw/{test}_*.npz"', "files: raw/results.npz")
    text = "".join(line for line in text.splitlines(keepends=True) if "id: two" not in line)
    path = write_campaign(tmp_path / "lab", text)
    write_log(path.parent / "raw/results.npz", daq(400, start_s=-500.0, step_s=10.0))
    assert ingest(store, path).losses == []
    with store.reader() as con:
        asked = "select min(t_s), max(t_s) from sample where channel = 'dZ'"
        assert con.execute(asked).fetchall() == [(0.0, 3990.0)]


@pytest.mark.parametrize("said", [{}, {"start_ns": "0"}])
def test_a_relative_clock_beside_an_absolute_one_starts_with_the_test(
    store: Store, tmp_path: Path, said: dict[str, str]
) -> None:
    """Also where its reader says that it starts at 0, which is no date."""
    path = write_campaign(tmp_path / "lab")
    write_log(
        path.parent / "raw/one.nc.npz",
        {"nc": {"t_ns": times(50, 10.0, start_ns=0), "n": np.arange(50.0), "msg": np.array(["A"] * 50)}},
        clock="relative",
        **said,
    )
    summary = ingest(store, path)
    assert any("relative clock" in note for note in summary.notes)
    with store.reader() as con:
        found = con.execute(
            "select min(t_s), max(t_s), min(epoch_ns(t)) from sample where channel = 'speed' and test = 'one'"
        ).fetchone()
    assert found == (0.0, 490.0, START_NS)


def test_a_clock_is_aligned_by_declared_events(store: Store, tmp_path: Path) -> None:
    text = ALIGNED.replace("by: [{here: speed, there: n_daq}]", "events: [{here: 130 s, there: 190.5 s}]")
    path = lab(tmp_path / "lab", text, off_s=0.0, constant=True)
    summary = ingest(store, path)
    with store.reader() as con:
        (offset,) = con.execute("select offset_ns from source where source = 'nc'").fetchone() or (None,)
    assert offset == 60.5e9
    assert any("declared events" in note for note in summary.notes)


@pytest.mark.parametrize(
    ("events", "said"),
    [
        ("[{here: 0 s, there: 0 s}, {here: 3000 s, there: 3200 s}]", "contradict"),
        ("[{here: 2026-03-02 10:00:00, there: 10 furlongs}]", "furlongs"),
    ],
)
def test_declared_events_that_make_no_sense_are_told(store: Store, tmp_path: Path, events: str, said: str) -> None:
    text = ALIGNED.replace("by: [{here: speed, there: n_daq}]", f"events: {events}")
    path = lab(tmp_path / "lab", text, off_s=0.0)
    reasons = " ".join(loss["reason"] for loss in ingest(store, path).losses)
    assert said in reasons
