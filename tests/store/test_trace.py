"""Each sample back to its file, hash and row: windows, joined files, disorder, resets, offsets, derived channels."""

from __future__ import annotations

import json
from datetime import UTC
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from store_fakes import daq, times, write_campaign, write_log

from thermodata.cli.app import run
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.trace.lineage import trace


def edit(campaign: Path, old: str, new: str) -> None:
    text = campaign.read_text()
    assert old in text
    campaign.write_text(text.replace(old, new))


def agree(store: Store, campaign: Path, test: str, channel: str, at: list[float]) -> list[dict[str, Any]]:
    """Traces samples; each must be found in its file, by the file's own numbers."""
    found = []
    for t_s in at:
        sample = trace(store, "shop", test, channel, t_s, verify=True)["sample"]
        for raw in [sample["raw"]] if sample["raw"] else [o for o in sample["operands"] if "row" in o]:
            with np.load(campaign.parent / raw["source_path"]) as data:
                own = data[f"{raw['stream']}:{raw['signal']}"][raw["row"]]
            assert raw["raw_value"] == own.item()
            assert raw["again"] == {"file": "unchanged", "value": own.item(), "place": None, "problem": None}
        found.append(sample)
    return found


def test_a_window_and_its_history(store: Store, campaign: Path) -> None:
    edit(
        campaign,
        "- {id: two,",
        "- {id: late, files: {daq: raw/two_a.npz}, window: [10 min, 15 min], "
        "history: recording, phases: {all: [10 min, 12 min]}}\n  - {id: two,",
    )
    ingest(store, campaign)
    found = agree(store, campaign, "late", "T_a", [-600.0, -1.0, 0.0, 299.0])
    assert [s["raw"]["row"] for s in found] == [0, 599, 600, 899]
    assert [s["value"] for s in found] == [s["raw"]["raw_value"] for s in found]


def test_joined_files_that_are_out_of_order(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab", logs=False)
    write_log(path.parent / "raw/one_b.npz", daq(300, seed=1, start_s=0.0))
    late = daq(300, seed=2, start_s=400.0)
    late["main"]["t_ns"][100] -= 500_000_000  # a row that came half a second late
    late["main"]["t_ns"][[50, 51]] = late["main"]["t_ns"][[51, 50]]
    write_log(path.parent / "raw/one_a.npz", late)
    ingest(store, path)
    found = agree(store, path, "one", "T_a", [0.0, 299.0, 400.0, 450.0, 451.0, 499.5])
    assert [(s["raw"]["source_path"][8], s["raw"]["row"]) for s in found] == [
        ("b", 0),
        ("b", 299),
        ("a", 0),
        ("a", 51),
        ("a", 50),
        ("a", 100),
    ]


def test_relative_files_joined_end_to_end_and_a_clock_that_was_reset(store: Store, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab", logs=False)
    for i, name in enumerate(("one_2", "one_10")):
        log = daq(100, seed=i)
        log["main"]["t_ns"] = times(100, start_ns=0)
        write_log(path.parent / f"raw/{name}.npz", log, clock="relative")
    reset = daq(100, seed=5)
    reset["main"]["t_ns"][60:] -= 3_600_000_000_000
    write_log(path.parent / "raw/two_a.npz", reset)
    edit(path, 'files: "raw/{test}_*.npz"}', 'files: "raw/{test}_*.npz", clock: {resets: allow}}')
    ingest(store, path)
    assert [(s["raw"]["source_path"], s["raw"]["row"]) for s in agree(store, path, "one", "T_a", [99.0, 100.0])] == [
        ("raw/one_2.npz", 99),
        ("raw/one_10.npz", 0),
    ]
    assert [s["raw"]["row"] for s in agree(store, path, "two", "T_a", [59.0, 60.0, 99.0])] == [59, 60, 99]


def test_another_clock_with_offset_and_drift_and_labels(store: Store, campaign: Path) -> None:
    edit(campaign, 'files: "raw/{test}.nc.npz"}', 'files: "raw/{test}.nc.npz", clock: {offset: -3.5 s, drift_ppm: 50}}')
    ingest(store, campaign)
    assert [s["raw"]["row"] for s in agree(store, campaign, "one", "speed", [-3.5, 596.5, 1300.0])] == [0, 60, 129]
    (label,) = agree(store, campaign, "one", "message", [-3.5])
    assert label["value"] == label["raw"]["raw_value"] == "RUN"


def test_a_derived_channel_names_the_rows_of_its_operands(store: Store, campaign: Path) -> None:
    edit(
        campaign,
        "calibrations:",
        """\
  dT: {derive: "T_a - T_b", quantity: temperature_difference}
  mix: {derive: "T_a + 0 * 1 degC", quantity: temperature}
calibrations:""",
    )
    edit(campaign, 'files: "raw/{test}.nc.npz"}', 'files: "raw/{test}.nc.npz", clock: {offset: 3 s}}')
    ingest(store, campaign)
    (sample,) = agree(store, campaign, "one", "dT", [77.0])
    assert [(o["channel"], o["row"]) for o in sample["operands"]] == [("T_a", 77), ("T_b", 77)]
    assert sample["value"] == pytest.approx(sample["operands"][0]["raw_value"] - sample["operands"][1]["raw_value"])
    whole = trace(store, "shop", "one", "dT")
    assert whole["derive"] == "T_a - T_b"
    assert [o["files"][0]["source_path"] for o in whole["operands"]] == ["raw/one_a.npz"] * 2


def test_a_trace_stays_right_when_the_calibration_changes(filled: Store, campaign: Path) -> None:
    (before,) = agree(filled, campaign, "one", "dZ", [500.0])
    edit(campaign, "10 um/V", "20 um/V")
    ingest(filled, campaign)
    (after,) = agree(filled, campaign, "one", "dZ", [500.0])
    assert after["raw"] == before["raw"]
    assert after["value"] == pytest.approx(2 * before["value"])


def test_a_source_file_that_changed_since_is_told(store: Store, campaign: Path) -> None:
    ingest(store, campaign)
    write_log(campaign.parent / "raw/one_a.npz", daq(900, seed=8))
    (campaign.parent / "raw/two_a.npz").unlink()
    one = trace(store, "shop", "one", "T_a", 5.0, verify=True)
    assert one["files"][0]["now"] == "changed since: its hash differs"
    assert one["sample"]["raw"]["again"]["value"] is None
    assert trace(store, "shop", "two", verify=True)["files"][0]["now"] == "not there any more"


def test_the_text_is_what_an_auditor_reads(filled: Store, campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    store = ["--store", str(filled.path)]
    assert run([*store, "trace", "shop", "one", "dZ", "--at", "2 min", "--verify"]) == 0
    said = capsys.readouterr().out
    for words in (
        "raw/one_a.npz, stream main, row 121 of 1200",
        "the same",
        "unchanged",
        "lvdt (scale), gain -10",
        "SHA-256",
        "npz 1",
        "sign",
    ):
        assert words in said, words
    assert run([*store, "trace", "shop", "one", "dZ", "--at", "2 min", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["sample"]["raw"]["row"] == 120
    assert run([*store, "trace", "shop", "one", "--at", "2 min"]) == 2
    capsys.readouterr()
    assert run([*store, "check"]) == 0
    next((filled.path / "tidy").glob("*.parquet")).unlink()
    assert run([*store, "check", "--json"]) == 4
    assert json.loads(capsys.readouterr().out.split("none\n")[-1])["damaged"][0]["problem"] == "gone"


def test_a_sample_is_asked_by_date_and_time(filled: Store, capsys: pytest.CaptureFixture[str]) -> None:
    from datetime import datetime, timedelta, timezone

    start = trace(filled, "shop", "one", "T_a", 0.0)["sample"]
    first = datetime.fromisoformat(start["t"][:19]) + timedelta(seconds=60.0 - start["t_s"])
    wanted = trace(filled, "shop", "one", "T_a", 60.0)["sample"]["t_s"]
    local = first.replace(tzinfo=UTC).astimezone(timezone(timedelta(hours=2)))
    for text in (f"{first.isoformat(' ')}", f"{first.isoformat()}Z", local.isoformat()):
        assert run(["--store", str(filled.path), "trace", "shop", "one", "T_a", "--at", text, "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["sample"]["t_s"] == pytest.approx(wanted, abs=1.0)
        assert run(["--store", str(filled.path), "trace", "shop", "one", "T_a", "--at", text]) == 0
        assert ("taken as UTC" in capsys.readouterr().err) is (" " in text)
    assert run(["--store", str(filled.path), "trace", "shop", "one", "T_a", "--at", "2026-13-01 10:30"]) == 2
    assert "2026-03-30T08:30Z" in capsys.readouterr().err
