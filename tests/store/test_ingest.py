"""Ingest: what comes out of it, what the same again and an edit do, and what is lost without harm."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from store_fakes import CAMPAIGN, START_NS, NpzReader, daq, times, write_campaign, write_log

from thermodata.errors import CalibrationError, SpecError, UsageError
from thermodata.plugin import Loss
from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.ingest.told.losses import loss_row, told_once


def rows(store: Store, query: str, *params: Any) -> list[tuple[Any, ...]]:
    with store.reader() as con:
        return con.execute(query, list(params)).fetchall()


def column(store: Store, test: str, channel: str) -> Any:
    with store.reader() as con:
        found = con.execute(
            "select t_s, value, flag from signal('shop', ?, ?) order by t_s", [test, channel]
        ).fetchnumpy()
    return found


def edit(campaign: Path, old: str, new: str) -> None:
    text = campaign.read_text()
    assert old in text
    campaign.write_text(text.replace(old, new))


def test_values_are_calibrated_into_canonical_units(store: Store, campaign: Path) -> None:
    summary = ingest(store, campaign)
    assert (summary.tests, summary.files, summary.losses, summary.changed) == (2, 4, [], True)
    assert summary.samples == 2 * (3 * 1200 + 2 * 130)
    raw = daq(seed=1)["main"]
    found = column(store, "two", "dZ")
    np.testing.assert_allclose(found["value"], -10 * raw["Z"])  # faces -Z, volts rise with the gap
    np.testing.assert_array_equal(found["t_s"], np.arange(1200.0))
    np.testing.assert_array_equal(column(store, "two", "T_b")["value"], raw["T2"].astype(float))
    assert rows(store, "select unit, sign, signal, calibration from channel where channel = 'dZ' and test = 'one'") == [
        ("um", "+", "Z", "lvdt")
    ]
    assert rows(
        store,
        "select epoch_ns(start), duration_s, json_extract_string(conditions, '$.speed') from test where test = 'one'",
    ) == [(START_NS, 1199.0, "9000.0")]


def test_labels_stay_text(filled: Store, campaign: Path) -> None:
    store = filled
    assert rows(store, "select message, count(*) from wide_shop_nc where test = 'one' group by 1 order by 1") == [
        ("RUN", 60),
        ("STOP", 70),
    ]


def test_the_raw_layer_keeps_the_files_own_types(filled: Store, campaign: Path) -> None:
    store = filled
    path = rows(store, "select path from file where layer = 'raw' and test = 'one' and source = 'daq'")[0][0]
    import pyarrow.parquet as pq

    table = pq.read_table(store.path / path)
    assert [str(f.type) for f in table.schema] == ["int64", "double", "double", "int16"]
    assert table.column_names == ["t_ns", "Z", "T1", "T2"]


def test_the_same_again_changes_nothing(store: Store, campaign: Path) -> None:
    first = ingest(store, campaign)
    files = sorted((p, p.read_bytes()) for p in store.path.rglob("*.parquet"))
    before = store.generation
    NpzReader.reads = 0
    second = ingest(store, campaign)
    assert not second.changed
    assert NpzReader.reads == 0
    assert any("nothing changed" in note for note in second.notes)
    assert (second.samples, second.flags, second.files) == (first.samples, first.flags, first.files)
    assert store.generation == before
    assert sorted((p, p.read_bytes()) for p in store.path.rglob("*.parquet")) == files


def test_an_edit_makes_anew_only_what_it_touches_without_the_source_files(filled: Store, campaign: Path) -> None:
    store = filled
    for path in (campaign.parent / "raw").iterdir():
        path.unlink()
    old = {r[0]: r[1] for r in rows(store, "select source || test, key from file where layer = 'tidy'")}
    edit(campaign, "gain: 10 um/V", "gain: 20 um/V")
    summary = ingest(store, campaign)
    new = {r[0]: r[1] for r in rows(store, "select source || test, key from file where layer = 'tidy'")}
    assert summary.changed
    assert summary.made == 2
    assert (new["daqone"] != old["daqone"], new["ncone"] == old["ncone"]) == (True, True)
    np.testing.assert_allclose(column(store, "one", "dZ")["value"], -20 * daq(seed=0)["main"]["Z"])
    assert any("raw copy" in note for note in summary.notes)


def test_words_are_no_reason_to_make_anything_anew(filled: Store, campaign: Path) -> None:
    store = filled
    edit(campaign, "at: spindle}\n  T_b", "at: spindle.motor, notes: warm}\n  T_b")
    summary = ingest(store, campaign)
    assert (summary.changed, summary.made) == (True, 0)
    assert rows(store, "select distinct \"at\" from channel where channel = 'T_a'") == [("spindle.motor",)]


def test_a_changed_file_supersedes_its_rows(filled: Store, campaign: Path) -> None:
    store = filled
    write_log(campaign.parent / "raw/one_a.npz", daq(n=700, seed=9))
    ingest(store, campaign)
    assert len(column(store, "one", "dZ")["value"]) == 700
    assert rows(store, "select layer from file where test = 'one' and source = 'daq' order by 1") == [
        ("raw",),
        ("superseded",),
        ("tidy",),
    ]


def test_one_bad_file_is_a_loss_and_the_others_stay(store: Store, campaign: Path) -> None:
    (campaign.parent / "raw/one_a.npz").write_bytes(b"PK\x03\x04 cut off")
    summary = ingest(store, campaign)
    assert [(loss["test"], loss["file"]) for loss in summary.losses] == [("one", "raw/one_a.npz")]
    assert rows(store, "select distinct test from displacement") == [("two",)]
    assert rows(store, "select distinct test from driver order by 1") == [("one",), ("two",)]


def test_losses_inside_a_file_are_told_again(store: Store, campaign: Path) -> None:
    write_log(campaign.parent / "raw/one_a.npz", daq(), lost="power cut")
    for _ in range(2):
        summary = ingest(store, campaign)
        assert [loss["reason"] for loss in summary.losses] == ["power cut"]
    assert rows(store, "select complete from source where test = 'one' and source = 'daq'") == [(False,)]


def test_flags_of_the_reader_come_through_even_from_mid_file(store: Store, campaign: Path) -> None:
    write_log(campaign.parent / "raw/one_a.npz", daq(), flagged="T1")
    ingest(store, campaign)
    flags = column(store, "one", "T_a")["flag"]
    assert not (flags[:500] & Flag.SATURATED).any()
    assert (flags[500:] & Flag.SATURATED).all()


def test_several_files_are_joined_in_the_order_of_time(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab", logs=False)
    write_log(path.parent / "raw/one_b.npz", daq(300, start_s=0.0))
    write_log(path.parent / "raw/one_a.npz", daq(300, start_s=400.0))
    ingest(store, path)
    found = column(store, "one", "dZ")
    assert len(found["t_s"]) == 600
    assert found["t_s"][[0, 299, 300, 599]].tolist() == [0.0, 299.0, 400.0, 699.0]


def test_a_window_cuts_a_recording_and_keeps_its_history(store: Store, campaign: Path) -> None:
    edit(
        campaign,
        "- {id: two,",
        "- {id: late, files: {daq: raw/two_a.npz}, window: [10 min, 15 min], "
        "history: recording, phases: {all: [10 min, 12 min]}}\n  - {id: two,",
    )
    ingest(store, campaign)
    found = column(store, "late", "dZ")
    assert found["t_s"].tolist() == list(np.arange(300.0))
    np.testing.assert_allclose(found["value"], -10 * daq(seed=1)["main"]["Z"][600:900])
    path = rows(store, "select path from file where test = 'late' and part = 'history' and source = 'daq'")[0][0]
    import pyarrow.parquet as pq

    history = pq.read_table(store.path / path)["t_s"].to_numpy()
    assert history.tolist() == list(np.arange(-600.0, 0.0))
    assert json.loads(rows(store, "select phases from test where test = 'late'")[0][0]) == {"all": [0.0, 120.0]}
    assert rows(store, "select duration_s, window_s from test where test = 'late'") == [(299.0, [600.0, 900.0])]


def test_an_offset_moves_a_sources_clock(store: Store, campaign: Path) -> None:
    edit(campaign, 'files: "raw/{test}.nc.npz"}', 'files: "raw/{test}.nc.npz", clock: {offset: -3.5 s}}')
    ingest(store, campaign)
    assert column(store, "one", "speed")["t_s"][:2].tolist() == [-3.5, 6.5]
    assert rows(store, "select distinct offset_ns from source where source = 'nc'") == [(-3_500_000_000,)]


def test_rows_out_of_order_are_sorted_and_flagged(store: Store, campaign: Path) -> None:
    log = daq(100)
    log["main"]["t_ns"][50] -= 1_500_000_000
    write_log(campaign.parent / "raw/one_a.npz", log)
    ingest(store, campaign)
    found = column(store, "one", "dZ")
    assert (np.diff(found["t_s"]) >= 0).all()
    assert np.flatnonzero(found["flag"] & Flag.CLOCK_SUSPECT).tolist() == [49]


def test_a_clock_reset_is_a_loss_unless_allowed(store: Store, campaign: Path) -> None:
    log = daq(100)
    log["main"]["t_ns"][60:] -= 3_600_000_000_000
    write_log(campaign.parent / "raw/one_a.npz", log)
    summary = ingest(store, campaign)
    assert [loss["test"] for loss in summary.losses] == ["one"]
    assert "resets: allow" in summary.losses[0]["reason"]
    assert len(column(store, "one", "dZ")["value"]) == 60
    edit(campaign, 'files: "raw/{test}_*.npz"}', 'files: "raw/{test}_*.npz", clock: {resets: allow}}')
    assert ingest(store, campaign).losses == []
    assert column(store, "one", "dZ")["t_s"].tolist() == list(np.arange(100.0))


def test_derived_and_scheduled_channels(store: Store, campaign: Path) -> None:
    edit(
        campaign,
        "calibrations:",
        """\
  dT: {derive: "T_a - T_b", quantity: temperature_difference}
  plan: {schedule: [[0 h, conditions.speed], [10 min, 0 rpm]], quantity: rotational_speed}
calibrations:""",
    )
    edit(campaign, "role: verification, ", "role: verification, conditions: {speed: 6000 rpm}, ")
    summary = ingest(store, campaign)
    assert summary.losses == []
    raw = daq(seed=0)["main"]
    np.testing.assert_allclose(column(store, "one", "dT")["value"], raw["T1"] - raw["T2"])
    plan = column(store, "two", "plan")
    assert set(plan["value"][plan["t_s"] < 600]) == {6000.0}
    assert set(plan["value"][plan["t_s"] >= 600]) == {0.0}
    assert plan["t_s"][-1] == 1199.0


def test_measuring_marks_what_does_not_count(store: Store, campaign: Path) -> None:
    edit(campaign, "conditions: {speed: 9000 rpm}}", "conditions: {speed: 9000 rpm}, measuring: speed == 0}")
    ingest(store, campaign)
    flags = column(store, "one", "dZ")["flag"]
    marked = (flags & Flag.NOT_MEASURING) != 0
    assert marked[:590].all()
    assert not marked[601:].any()
    assert not (column(store, "one", "T_a")["flag"] & Flag.NOT_MEASURING).any()


def test_a_misspelled_signal_is_told_with_the_nearest_name(store: Store, campaign: Path) -> None:
    edit(campaign, "signal: T1,", "signal: T11,")
    summary = ingest(store, campaign)
    assert len(summary.losses) == 2
    assert "did you mean 'T1'" in summary.losses[0]["reason"]
    assert rows(store, "select count(*) from displacement") == [(2400,)]


def test_a_channel_that_cannot_be_calibrated_is_a_loss_told_each_time(store: Store, campaign: Path) -> None:
    edit(campaign, ", calibration: lvdt}", "}")
    for _ in range(2):
        summary = ingest(store, campaign)
        assert [loss["test"] for loss in summary.losses] == ["one", "two"]
        assert "dZ" in summary.losses[0]["reason"]
    assert rows(store, "select count(*) from temperature") == [(4800,)]


JUMP = (
    "  jump: {kind: jump, axis: Z, source: daq, file: raw/jump.npz, signal: Z, moves: [100 um, -100 um], "
    "dwell: 10 s%s}\ntests:"
)


def write_jump(folder: Path) -> None:
    t = np.arange(400) * 0.1
    volts = 5 - 0.1 * ((t >= 12) & (t < 26)) * 100 / 1.0 / 10  # 1 V a 100 um, falling as the axis moves up
    rng = np.random.default_rng(5)
    volts += 1e-4 * rng.standard_normal(400)
    write_log(folder / "raw/jump.npz", {"main": {"t_ns": times(400, 0.1), "Z": volts}})


def test_a_jump_test_gives_the_signed_gain(store: Store, campaign: Path) -> None:
    write_jump(campaign.parent)
    edit(campaign, "tests:", JUMP % "")
    edit(campaign, "calibration: lvdt}", "calibration: jump}")
    summary = ingest(store, campaign)
    gain, sign = rows(store, "select gain, sign from calibration where calibration = 'jump'")[0]
    assert gain == pytest.approx(-100.0, rel=0.01)
    assert sign == "-"
    assert {c["name"] for c in summary.calibrations} == {"lvdt", "jump"}
    (campaign.parent / "raw/jump.npz").unlink()
    edit(campaign, "dwell: 10 s", "dwell: 9 s")
    assert ingest(store, campaign).losses == []


def test_a_contradictory_calibration_is_refused_and_nothing_is_stored(store: Store, campaign: Path) -> None:
    write_jump(campaign.parent)
    edit(campaign, "tests:", JUMP % ", facing: +Z, increases_with: gap")
    before = store.generation
    with pytest.raises(CalibrationError):
        ingest(store, campaign)
    assert store.generation == before
    assert rows(store, "select count(*) from campaign") == [(0,)]


def test_a_jump_test_on_its_rail_costs_the_channels_that_use_it_and_no_others(store: Store, campaign: Path) -> None:
    write_log(campaign.parent / "raw/jump.npz", {"main": {"t_ns": times(400, 0.1), "Z": np.full(400, 9.99)}})
    edit(campaign, "tests:", JUMP % "")
    edit(campaign, "calibration: lvdt}", "calibration: jump}")
    summary = ingest(store, campaign)
    said = "\n".join(str(loss["reason"]) for loss in summary.losses)
    assert "9.99 V in 100 % of the record" in said
    assert "stands at its end of range" in said
    assert "calibration 'jump' is not available" in said
    assert rows(store, "select count(*) from calibration where calibration = 'jump'") == [(0,)]
    assert rows(store, "select count(*) from temperature") == [(4800,)]


@pytest.mark.parametrize("path", ["../other/*.npz", "/etc/*", "raw/../../x.npz"])
def test_a_pattern_may_not_leave_the_campaigns_folder(store: Store, campaign: Path, path: str) -> None:
    edit(campaign, "raw/{test}_*.npz", path)
    with pytest.raises(SpecError, match="leaves"):
        ingest(store, campaign)


def test_a_link_out_of_the_folder_is_refused(store: Store, campaign: Path, tmp_path: Path) -> None:
    secret = write_log(tmp_path / "elsewhere/x.npz", daq())
    (campaign.parent / "raw/one_z.npz").symlink_to(secret)
    summary = ingest(store, campaign)
    assert [(loss["file"], "outside" in loss["reason"]) for loss in summary.losses] == [("raw/one_z.npz", True)]
    assert len(column(store, "one", "dZ")["value"]) == 1200


def test_a_test_taken_out_of_the_campaign_file_is_gone(filled: Store, campaign: Path) -> None:
    store = filled
    campaign.write_text("\n".join(line for line in campaign.read_text().splitlines() if "id: two" not in line))
    ingest(store, campaign)
    assert rows(store, "select distinct test from sample") == [("one",)]
    assert rows(store, "select distinct test from file") == [("one",)]


def test_two_campaigns_share_a_store_and_equal_files(filled: Store, campaign: Path, tmp_path: Path) -> None:
    store = filled
    other = write_campaign(tmp_path / "lab2", CAMPAIGN.replace("id: shop", "id: shop2"))
    NpzReader.reads = 0
    ingest(store, other)
    assert NpzReader.reads == 0
    assert rows(store, "select campaign, count(*) from displacement group by 1 order by 1") == [
        ("shop", 2400),
        ("shop2", 2400),
    ]


def test_relative_clocks_that_overlap_are_joined_end_to_end(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab", logs=False)
    for i, name in enumerate(("one_2", "one_10")):
        log = daq(100, seed=i)
        log["main"]["t_ns"] = times(100, start_ns=0)
        write_log(path.parent / f"raw/{name}.npz", log, clock="relative")
    ingest(store, path)
    found = column(store, "one", "T_a")
    assert found["t_s"].tolist() == list(np.arange(200.0))
    np.testing.assert_allclose(found["value"][:100], daq(100, seed=0)["main"]["T1"])
    assert rows(store, "select clock, start from test where test = 'one'") == [("relative", None)]


def test_tests_stand_in_the_order_of_the_campaign_file(filled: Store, campaign: Path) -> None:
    edit(campaign, "- {id: two,", "- {id: a, kind: other}\n  - {id: two,")
    write_log(campaign.parent / "raw/a_a.npz", daq(100, seed=7))
    ingest(filled, campaign)
    assert rows(filled, "select test from test order by rowid") == [("one",), ("a",), ("two",)]


def test_a_long_stream_goes_piece_by_piece_with_the_same_values(
    store: Store, campaign: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import pyarrow.parquet as pq

    from thermodata.store.base import encoder
    from thermodata.store.raw import writer
    from thermodata.store.tidy.flags.in_windows import windows

    whole = Store(tmp_path / "whole", create=True)
    ingest(whole, campaign)
    monkeypatch.setattr(windows, "WINDOW_VALUES", 1)
    monkeypatch.setattr(windows, "MARGIN_ROWS", 50)
    monkeypatch.setattr(writer, "GROUP_ROWS", 100)
    assert encoder.COMPRESSION
    write_log(campaign.parent / "raw/one_a.npz", daq(9000))
    ingest(store, campaign)
    ingest(whole, campaign)
    for channel in ("dZ", "T_a", "T_b"):
        for key, values in column(whole, "one", channel).items():
            np.testing.assert_array_equal(column(store, "one", channel)[key], values, err_msg=f"{channel} {key}")
    (path,) = rows(store, "select path from file where layer = 'tidy' and test = 'one' and source = 'daq'")[0]
    groups = pq.ParquetFile(store.path / path).metadata
    assert max(groups.row_group(i).num_rows for i in range(groups.num_row_groups)) <= 100


def test_a_channel_may_be_overridden_or_absent_in_one_test(store: Store, campaign: Path) -> None:
    edit(campaign, "- {id: two, ", "- {id: two, channels: {T_b: {absent: true}, T_a: {signal: T2, at: ram}}, ")
    assert ingest(store, campaign).losses == []
    np.testing.assert_array_equal(column(store, "two", "T_a")["value"], daq(seed=1)["main"]["T2"].astype(float))
    assert rows(store, "select test from channel where channel = 'T_b'") == [("one",)]
    counted = rows(store, "select test, count(T_b) from wide_shop_daq group by 1 order by 1")
    assert counted == [("one", 1200), ("two", 0)]


def test_a_unit_in_brackets_may_be_left_out_and_is_the_unit(store: Store, campaign: Path) -> None:
    log = daq(100)
    log["main"]["Temp(degF)"] = log["main"].pop("T1")
    write_log(campaign.parent / "raw/one_a.npz", log)
    edit(campaign, "signal: T1,", "signal: Temp,")
    ingest(store, campaign)
    np.testing.assert_allclose(column(store, "one", "T_a")["value"], (daq(100)["main"]["T1"] - 32) / 1.8)


def test_a_reader_that_is_not_there_is_refused_before_the_store_changes(
    filled: Store, campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.ingest.reading import campaign_files

    def missing(name: str) -> Any:
        raise UsageError(f"no reader '{name}'", hint="did you mean 'npz'?")

    monkeypatch.setattr(campaign_files, "find_reader", missing)
    before = filled.generation
    edit(campaign, "id: one,", "id: one, notes: again,")
    with pytest.raises(UsageError, match=r"sources\.daq\.reader"):
        ingest(filled, campaign)
    assert filled.generation == before
    assert rows(filled, "select count(*) from sample")[0][0] > 0


def test_a_source_without_a_file_in_any_test_is_a_loss(store: Store, campaign: Path) -> None:
    edit(campaign, "{test}.nc.npz", "{test}.ncc.npz")
    summary = ingest(store, campaign)
    assert [(row["source"], row["test"]) for row in summary.losses] == [("nc", None)]
    assert "{test}.ncc" in summary.losses[0]["reason"]


def test_a_source_without_a_file_in_one_test_is_a_note(store: Store, campaign: Path) -> None:
    next((campaign.parent / "raw").glob("two.nc*")).unlink()
    summary = ingest(store, campaign)
    assert summary.losses == []
    assert any("no file of source 'nc'" in note for note in summary.notes)


def test_a_loss_of_a_file_is_told_of_all_tests_that_any_of_its_sources_tells_it_of() -> None:
    loss = Loss("a.csv line 3", None, None, 0.1, "odd")
    rows = [loss_row("odd", test=test, source=s, file="a.csv", loss=loss) for test, s in (("A", "nc"), ("C", "daq"))]
    rows[0]["tests"].append("B")
    rows[1]["tests"].append("D")
    (told,) = told_once(rows)
    assert (told["tests"], told["sources"]) == (["A", "B", "C", "D"], ["nc", "daq"])
